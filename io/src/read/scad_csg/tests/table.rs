//! The column "Exact?" of the table in `docs/openscad.md`, against what is said about examples.

use super::files::{TETRAHEDRON, read};

/// What a reading says about a model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Verdict {
    Exact,
    Approximate,
    Refused,
}

fn verdict(model: &str) -> Verdict {
    let files = vec![
        ("t.off", TETRAHEDRON.as_bytes().to_vec()),
        ("t.dat", b"0 1\n2 0\n".to_vec()),
    ];
    match read(model, files) {
        Err(_) => Verdict::Refused,
        Ok(reading) => {
            let mut told = reading.warnings.iter().map(ToString::to_string);
            if told.any(|warning| warning.contains("it is taken as a")) {
                Verdict::Approximate
            } else {
                Verdict::Exact
            }
        }
    }
}

/// Models of nodes that are exact always, or refused.
fn plain(node: &str) -> Vec<String> {
    let solids = "{ cube(2); sphere(r = 1.2); }";
    let figure = |figure: &str| format!("linear_extrude(height = 1) {figure}");
    let half_disc = "intersection() { circle(r = 2); square(4); }";
    match node {
        "union" | "group" | "render" | "intersection" | "difference" => {
            vec![format!("{node}() {solids}")]
        }
        "color" => vec![format!("color([1, 0, 0]) {solids}")],
        "multmatrix" => {
            let matrix = "[[1, 0.5, 0, 1], [0, 2, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]";
            vec![format!("multmatrix({matrix}) {solids}")]
        }
        "translate" | "rotate" | "scale" | "mirror" => {
            vec![format!("{node}([1, 2, 3]) {solids}")]
        }
        "cube" => vec!["cube([1, 2, 3]);".into()],
        "sphere" => vec!["sphere(r = 1);".into(), "sphere(r = 1, $fn = 8);".into()],
        "cylinder" => vec![
            "cylinder(h = 1, r1 = 1, r2 = 0);".into(),
            "cylinder(h = 1, r = 1, $fn = 6);".into(),
        ],
        "polyhedron" => {
            let points = "[[0,0,0],[4,0,0],[4,4,0],[0,4,0],[2,2,1],[2,2,4]]";
            let faces = "[[0,4,1],[1,4,2],[2,4,3],[3,4,0],[0,1,5],[1,2,5],[2,3,5],[3,0,5]]";
            let dented = format!("polyhedron(points = {points}, faces = {faces});");
            vec![dented]
        }
        "square" => vec![figure("square([1, 2]);")],
        "polygon" => vec![figure("polygon([[0, 0], [3, 0], [1, 1], [0, 3]]);")],
        "circle" => vec![
            figure("circle(r = 2);"),
            figure("scale([2, 1]) circle(r = 2);"),
        ],
        "linear_extrude" => vec![
            "linear_extrude(height = 3, scale = [0.5, 2]) circle(r = 1);".into(),
            "linear_extrude(height = 3, twist = 30, slices = 4) square(2);".into(),
        ],
        "rotate_extrude" => vec![format!(
            "rotate_extrude(angle = 90) translate([3, 0]) {half_disc}"
        )],
        "text" => vec![figure("text(\"AVTo\");")],
        "fill" => vec![figure("fill() square(2);")],
        "resize" => vec![format!("resize([4, 0, 0], auto = true) {solids}")],
        "torus" => vec!["torus(r1 = 3, r2 = 1);".into()],
        "halfspace" => vec!["halfspace(n = [0, 0, 1], d = 2);".into()],
        "quadric" => vec!["quadric(m = [[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,-1]]);".into()],
        "polynomial" => vec!["polynomial(p = \"x^4 + y^4 + z^4 - 1\");".into()],
        "helicoid" => vec!["helicoid();".into()],
        "import" | "import_stl" | "import_off" => {
            vec![format!("{node}(file = \"t.off\");")]
        }
        "surface" => vec!["surface(file = \"t.dat\");".into()],
        refused => vec![format!("{refused}(file = \"x\", text = \"x\") square(1);")],
    }
}

/// For each node models that it is exact in, and such as it is not.
fn examples(node: &str) -> (Vec<String>, Vec<String>) {
    let figure = |figure: &str| format!("linear_extrude(height = 1) {figure}");
    let tilted = "rotate([0, 30, 0]) cylinder(h = 3, r = 1);";
    let half_disc = "intersection() { circle(r = 2); square(4); }";
    match node {
        "hull" => (
            vec![
                "hull() { cube(1); translate([3, 0, 0]) sphere(r = 1); }".into(),
                "hull() { cylinder(h = 2, r = 1); translate([0, 0, 5]) sphere(r = 2); }".into(),
            ],
            vec![format!("hull() {{ cube(1); {tilted} }}")],
        ),
        "minkowski" => (
            vec![
                "minkowski() { cube(1); sphere(r = 1); }".into(),
                "minkowski() { cylinder(h = 2, r = 1); sphere(r = 1); }".into(),
            ],
            vec![format!(
                "minkowski() {{ cylinder(h = 1, r = 2); {tilted} }}"
            )],
        ),
        "offset" => (
            vec![
                figure("offset(r = 1) square(2);"),
                figure("offset(r = 1) circle(r = 2);"),
                figure("offset(delta = 1, chamfer = true) square(2);"),
            ],
            vec![figure(&format!("offset(r = 1) {half_disc}"))],
        ),
        "projection" => (
            vec![
                figure("projection(cut = true) sphere(r = 2);"),
                figure("projection() rotate([30, 20, 0]) cube(1);"),
            ],
            vec![figure(&format!("projection() {tilted}"))],
        ),
        _ => (plain(node), vec![]),
    }
}

#[test]
fn the_documentation_says_what_is_exact() {
    let text = include_str!("../../../../../docs/openscad.md");
    let mut count = 0;
    for row in text.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = row.split('|').map(str::trim).collect();
        let [_, names, becomes, is_exact, ..] = cells[..] else {
            panic!("{row}");
        };
        for node in names.split('`').skip(1).step_by(2) {
            count += 1;
            let (exact, approximate) = examples(node);
            let expected = if becomes.starts_with("refused") {
                Verdict::Refused
            } else {
                Verdict::Exact
            };
            for model in &exact {
                assert_eq!(verdict(model), expected, "{model}");
            }
            for model in &approximate {
                assert_eq!(verdict(model), Verdict::Approximate, "{model}");
            }
            let warns = is_exact.contains("warning") || is_exact == "as `hull`";
            assert_eq!(warns, !approximate.is_empty(), "{node}: {is_exact}");
        }
    }
    assert!(count > 40, "{count}");
}
