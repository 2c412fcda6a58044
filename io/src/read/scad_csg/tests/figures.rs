//! Extrusions and polyhedra against the definition of what they hold, point by point.

use super::*;
use glam::DVec2;
use std::fmt::Write as _;

/// Whether closed paths enclose a point an odd number of times, and its distance from them.
fn even_odd(paths: &[Vec<DVec2>], point: DVec2) -> (bool, f64) {
    let (mut inside, mut distance) = (false, f64::INFINITY);
    for path in paths {
        for (at, &a) in path.iter().enumerate() {
            let b = path[(at + 1) % path.len()];
            if (a.y > point.y) != (b.y > point.y) {
                let x = a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x);
                inside ^= point.x < x;
            }
            let along = b - a;
            let t = (point - a).dot(along) / along.length_squared().max(1e-300);
            distance = distance.min(point.distance(a + along * t.clamp(0.0, 1.0)));
        }
    }
    (inside, distance)
}

fn polygon(paths: &[Vec<DVec2>]) -> String {
    let points: Vec<[f64; 2]> = paths.iter().flatten().map(DVec2::to_array).collect();
    let mut next = 0;
    let lists = paths.iter().map(|path| {
        next += path.len();
        (next - path.len()..next).collect::<Vec<_>>()
    });
    let lists: Vec<Vec<usize>> = lists.collect();
    format!("polygon(points = {points:?}, paths = {lists:?}, convexity = 4);")
}

fn path(most: usize) -> impl Strategy<Value = Vec<DVec2>> {
    // A coarse grid makes touching, coincident and crossing edges common.
    let point = (0..9_i32, 0..9_i32).prop_map(|(x, y)| DVec2::new(f64::from(x), f64::from(y)));
    prop::collection::vec(point, 3..most)
}

/// A grid of points that no line through points of the coarse grid comes near often.
fn samples() -> impl Iterator<Item = DVec2> {
    (0..400_u32).map(|i| {
        let at = f64::from(i);
        DVec2::new((0.618_034 * at).fract(), (0.754_878 * at).fract()) * 10.0 - 0.5
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn polygons_fill_what_their_paths_enclose_an_odd_number_of_times(
        paths in prop::collection::vec(path(14), 1..4),
    ) {
        let text = format!("linear_extrude(height = 2, center = true) {}", polygon(&paths));
        let model = model(&text);
        for point in samples() {
            let (expected, distance) = even_odd(&paths, point);
            if distance > 1e-6 {
                let found = contains(&model, model.root(), point.extend(0.3));
                prop_assert_eq!(found, expected, "{} {}", point, text);
            }
        }
    }

    #[test]
    fn sweeps_hold_the_points_whose_section_the_profile_holds(
        outline in path(10),
        angle in prop::sample::select(vec![360.0, 90.0, 180.0, 200.0, 300.0, -100.0]),
        mirrored in any::<bool>(),
    ) {
        // Right or left of the axis, by 1.
        let sign = if mirrored { -1.0 } else { 1.0 };
        let moved: Vec<DVec2> = outline.iter().map(|p| (*p + DVec2::X) * DVec2::new(sign, 1.0)).collect();
        let paths = [moved];
        let text = format!("rotate_extrude(angle = {angle}) {}", polygon(&paths));
        let model = model(&text);
        for (at, point) in samples().enumerate() {
            let profile = DVec2::new((point.x + 1.0).abs(), point.y);
            let (expected, distance) = even_odd(&paths, profile * DVec2::new(sign, 1.0));
            if distance < 1e-6 {
                continue;
            }
            let azimuth = at as f64 * 7.3 % 360.0;
            let swept = if angle < 0.0 { azimuth > 360.0 + angle } else { azimuth < angle };
            let (sine, cosine) = azimuth.to_radians().sin_cos();
            let flat = DVec2::new(cosine, sine) * profile.x * sign;
            let found = contains(&model, model.root(), DVec3::new(flat.x, flat.y, profile.y));
            prop_assert_eq!(found, expected && swept, "{} at {}° {}", profile, azimuth, text);
        }
    }

    #[test]
    fn tapered_sections_are_scaled(outline in path(10), sx in 0.0..3.0, sy in 0.0..3.0, t in 0.01..0.99) {
        let paths = [outline];
        let text = format!("linear_extrude(height = 4, scale = [{sx}, {sy}]) {}", polygon(&paths));
        let model = model(&text);
        let scale = DVec2::new(1.0 + (sx - 1.0) * t, 1.0 + (sy - 1.0) * t);
        for point in samples() {
            let (expected, distance) = even_odd(&paths, point);
            if distance > 1e-6 {
                let found = contains(&model, model.root(), (point * scale).extend(4.0 * t));
                prop_assert_eq!(found, expected, "{} {}", point, text);
            }
        }
    }
}

/// A prism of a star as one polyhedron: non-convex, with non-convex faces.
fn star_prism() -> (String, Vec<DVec2>) {
    let vertex = |i: u32| {
        let radius = if i.is_multiple_of(2) { 4.0 } else { 1.5 };
        DVec2::from_angle(f64::from(i) * std::f64::consts::PI / 5.0) * radius
    };
    let outline: Vec<DVec2> = (0..10).map(vertex).collect();
    let mut text = String::from("polyhedron(points = [");
    for z in [0.0, 2.0] {
        for p in &outline {
            write!(text, "[{}, {}, {z}], ", p.x, p.y).unwrap();
        }
    }
    text.push_str("], faces = [[0,1,2,3,4,5,6,7,8,9], [19,18,17,16,15,14,13,12,11,10]");
    for i in 0..10 {
        let j = (i + 1) % 10;
        write!(text, ", [{i}, {}, {}, {j}]", i + 10, j + 10).unwrap();
    }
    text.push_str("]);");
    (text.replace(", ]", "]"), outline)
}

#[test]
fn dented_polyhedra_hold_what_their_faces_enclose() {
    let (text, outline) = star_prism();
    let model = model(&text);
    let paths = [outline];
    for point in samples().map(|p| p - DVec2::splat(4.5)) {
        let (expected, distance) = even_odd(&paths, point);
        if distance > 1e-4 {
            for (z, between) in [(-0.1, false), (0.1, true), (1.9, true), (2.1, false)] {
                let found = contains(&model, model.root(), point.extend(z));
                assert_eq!(found, expected && between, "{point} {z}");
            }
        }
    }
}

#[test]
fn a_pyramid_may_have_its_base_pushed_in() {
    let dented = "polyhedron(points = [[1,1,0],[-1,1,0],[-1,-1,0],[1,-1,0],[0,0,3],[0,0,1]], faces = \
                  [[0,1,4],[1,2,4],[2,3,4],[3,0,4],[1,0,5],[2,1,5],[3,2,5],[0,3,5]]);";
    let points = [
        [0.0, 0.0, 0.9],
        [0.0, 0.0, 1.1],
        [0.0, 0.0, 2.9],
        [0.9, 0.0, 0.2],
        [0.9, 0.0, 0.05],
    ];
    assert_eq!(inside(dented, &points), [false, true, true, true, false]);
}

#[test]
fn unsound_polyhedra_are_refused_with_the_reason() {
    let (star, _) = star_prism();
    let open = star.replace(", [9, 19, 10, 0]", "");
    assert!(errors(&open)[0].contains("open, or its faces turn different ways"));
    let turned = star.replace("[0, 10, 11, 1]", "[1, 11, 10, 0]");
    assert!(errors(&turned)[0].contains("turn different ways"));
    // The hub pulled through the rim.
    let crossing = star.replace("[4, 0, 0]", "[-4, 0, 0]");
    assert!(
        errors(&crossing)[0].contains("cross or cover each other"),
        "{:?}",
        errors(&crossing)
    );
}

#[test]
fn circles_become_cylinders_cones_tori_and_prisms() {
    let shape = |text: &str| {
        let nodes = model(text);
        let shapes = nodes.nodes().iter().filter_map(|n| match n {
            Node::Shape(shape) => Some(shape.clone()),
            _ => None,
        });
        shapes.collect::<Vec<_>>()
    };
    assert!(matches!(
        shape("linear_extrude(height = 2) circle(r = 3);")[..],
        [Shape::Cylinder(_)]
    ));
    assert!(matches!(
        shape("linear_extrude(height = 2) circle(r = 3, $fn = 6);")[..],
        [.., Shape::HalfSpace(_)]
    ));
    let ring = "rotate_extrude() translate([5, 1]) circle(r = 2);";
    assert!(matches!(shape(ring)[0], Shape::Torus(_)));
    let degree = |text: &str| {
        let all = shape(text);
        all.iter()
            .flat_map(|s| s.half_spaces().unwrap())
            .flatten()
            .map(|p| p.degree())
            .max()
            .unwrap()
    };
    assert_eq!(
        degree("linear_extrude(height = 2, scale = 0.5) circle(r = 3);"),
        2
    );
    assert_eq!(
        degree("linear_extrude(height = 2, scale = [1, 2]) circle(r = 3);"),
        4
    );
    assert_eq!(
        degree("linear_extrude(height = 2, scale = [1, 2]) square(3);"),
        1
    );
    assert_eq!(
        degree("linear_extrude(height = 2, scale = [1, 2]) rotate(45) square(3);"),
        2
    );
    assert_eq!(degree("rotate_extrude() translate([2, 0]) square(3);"), 2);
}

#[test]
fn tangents_close_the_hull_of_circles() {
    let text =
        "linear_extrude(height = 1) hull() { circle(r = 2); translate([6, 0]) circle(r = 1); }";
    // The upper tangent touches at (r cos a, r sin a) with cos a = 1/6.
    let model = model(text);
    let normal = DVec2::new(1.0 / 6.0, (35.0_f64).sqrt() / 6.0);
    for t in [0.1, 0.5, 0.9] {
        let on = normal * 2.0 + (DVec2::new(6.0, 0.0) - normal) * t;
        for (step, expected) in [(-1e-6, true), (1e-6, false)] {
            let point = (on + normal * step).extend(0.5);
            assert_eq!(
                contains(&model, model.root(), point),
                expected,
                "{t} {step}"
            );
        }
    }
    assert_eq!(
        inside(
            text,
            &[
                [-1.99, 0.0, 0.5],
                [-2.01, 0.0, 0.5],
                [6.99, 0.0, 0.5],
                [7.01, 0.0, 0.5]
            ]
        ),
        [true, false, true, false]
    );
}

/// What has no closed form is made of plane pieces, and the reader says so.
#[test]
fn approximations_are_told() {
    for (text, is_exact) in [
        ("hull() { sphere(1); cube(1); }", true),
        (
            "hull() { sphere(1); translate([3, 0, 0]) sphere(2); }",
            true,
        ),
        (
            "hull() { cylinder(h = 1); translate([3, 0, 0]) cylinder(h = 1); }",
            true,
        ),
        (
            "hull() { cylinder(h = 1); translate([0, 0, 3]) sphere(2); }",
            true,
        ),
        (
            "hull() { cylinder(h = 1); translate([3, 0, 0]) cylinder(h = 2); }",
            false,
        ),
        (
            "hull() { sphere(1); translate([3, 0, 0]) cylinder(h = 1); }",
            false,
        ),
        ("hull() difference() { cube(2); cube(1); }", true),
        ("minkowski() { cube(1); sphere(1); }", true),
        ("minkowski() { cylinder(h = 2); sphere(1); }", true),
        ("minkowski() { cube(1); cylinder(h = 1); }", true),
        (
            "minkowski() { cube(1); rotate([30, 0, 0]) cylinder(h = 1); }",
            false,
        ),
        ("linear_extrude(height = 1) offset(r = 1) square(1);", true),
        (
            "linear_extrude(height = 1) offset(r = -1) circle(r = 3);",
            true,
        ),
        (
            "linear_extrude(height = 1) offset(delta = 1) square(1);",
            true,
        ),
        (
            "linear_extrude(height = 1) hull() scale([1, 2]) circle(r = 1);",
            false,
        ),
        (
            "linear_extrude(height = 1) hull() difference() { square(2); square(1); }",
            true,
        ),
        (
            "linear_extrude(height = 1) projection(cut = true) sphere(1);",
            true,
        ),
        (
            "linear_extrude(height = 1) projection() torus(3, 1);",
            false,
        ),
    ] {
        let told = warnings(text);
        assert_eq!(told.is_empty(), is_exact, "{text}: {told:?}");
        assert!(
            is_exact || told[0].contains("has no closed form here"),
            "{told:?}"
        );
    }
    assert!(is_empty(&model("hull();")));
    assert!(is_empty(&model("minkowski();")));
    assert!(errors("hull() halfspace(n = [0, 0, 1], d = 0);")[0].contains("is unbounded"));
}

#[test]
fn figures_combine_before_they_are_extruded() {
    let text = "linear_extrude(height = 1) difference() {
        union() { square(4); translate([4, 0]) square(2); }
        intersection() { circle(r = 3); square([1, 9]); } }";
    assert_eq!(
        inside(
            text,
            &[
                [0.5, 1.0, 0.5],
                [0.5, 3.5, 0.5],
                [2.0, 2.0, 0.5],
                [5.0, 1.0, 0.5],
                [5.0, 3.0, 0.5]
            ]
        ),
        [false, true, true, true, false]
    );
    // Nothing, and nothing left of an intersection with nothing.
    assert!(is_empty(&model("linear_extrude(height = 1);")));
    assert!(is_empty(&model(
        "linear_extrude(height = 1) intersection() { square(1); group(); }"
    )));
    assert!(is_empty(&model("linear_extrude(height = 0) square(1);")));
}

#[test]
fn sweeps_about_the_axis_stay_on_one_side() {
    let across = errors("rotate_extrude() square(2, center = true);");
    assert_eq!(
        across,
        [
            "t.csg:1:18: what rotate_extrude turns must lie on one side of the y axis, and this lies on both (cut it at x = 0)"
        ]
    );
    // Cut at the axis: boxes alone would not tell.
    let half =
        "rotate_extrude() difference() { circle(r = 2); translate([-4, -4]) square([4, 8]); }";
    assert_eq!(
        inside(half, &[[1.9, 0.0, 0.0], [0.0, -1.9, 0.0], [1.5, 1.5, 0.0]]),
        [true, true, false]
    );
    // Six flat sides instead of a round one.
    let hexagon = "rotate_extrude($fn = 6, start = 0) translate([1, 0]) square(1);";
    assert_eq!(
        inside(
            hexagon,
            &[[1.99, 0.0, 0.5], [0.0, 1.74, 0.5], [0.0, 1.72, 0.5]]
        ),
        [true, false, true]
    );
}

#[test]
fn extreme_figures_end_in_messages_or_solids_at_once() {
    for text in [
        "linear_extrude(height = 1) circle(r = 1, $fn = 1e9);",
        "linear_extrude(height = 1) polygon(points = [[0, 0], [1, 0]]);",
        "linear_extrude(height = 1) polygon(points = [[0, 0], [1, 0], [2, 0]]);",
        "linear_extrude(height = 1) polygon(points = [[0, 0], [1, nan], [2, 0]]);",
        "linear_extrude(height = inf) square(1);",
        "linear_extrude(height = 1e300) square(1e300);",
        "linear_extrude(height = 1) polygon(points = [[0, 0], [1, 0], [0, 1]], paths = [[0, 1, 7]]);",
        "linear_extrude(height = 1, twist = 90) square(1);",
        "rotate_extrude(angle = 0) square(1);",
        "rotate_extrude(angle = nan) square(1);",
        "rotate_extrude(file = \"a.dxf\");",
    ] {
        match try_read(text) {
            Ok(reading) => assert!(
                !is_empty(&reading.model) || !reading.warnings.is_empty(),
                "{text}"
            ),
            Err(found) => assert!(!found.as_slice().is_empty(), "{text}"),
        }
    }
    // A comb of 10,000 corners, and 20,000 nested nodes.
    let comb: Vec<[f64; 2]> = (0..10_000)
        .map(|i| {
            let angle = f64::from(i) * std::f64::consts::TAU / 10_000.0;
            let radius = if i % 2 == 0 { 10.0 } else { 7.0 };
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let comb = format!("linear_extrude(height = 1) polygon(points = {comb:?});");
    assert_eq!(
        inside(&comb, &[[6.9, 0.0, 0.5], [10.1, 0.0, 0.5]]),
        [true, false]
    );
    let depth = 20_000;
    let nested = format!(
        "linear_extrude(height = 1) {}square(1);{}",
        "translate([0.001, 0]) {".repeat(depth),
        "}".repeat(depth)
    );
    assert!(!is_empty(&model(&nested)));
}
