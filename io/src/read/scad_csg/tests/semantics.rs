//! What models mean, against the format's description and OpenSCAD's documented behaviour.

use super::*;

#[test]
fn cubes_stand_in_the_first_octant_unless_centred() {
    let points = [[0.9, 1.9, 2.9], [-0.1, 1.0, 1.0], [0.4, 0.9, 1.4]];
    assert_eq!(
        inside("cube(size = [1, 2, 3], center = false);", &points),
        [true, false, true]
    );
    assert_eq!(
        inside("cube([1, 2, 3], true);", &points),
        [false, true, true]
    );
    assert_eq!(inside("cube(2);", &[[1.9; 3], [2.1; 3]]), [true, false]);
    assert_eq!(inside("cube();", &[[0.9; 3], [1.1; 3]]), [true, false]);
}

#[test]
fn cylinders_taper_linearly() {
    let text = "cylinder($fn = 0, $fa = 12, $fs = 2, h = 4, r1 = 2, r2 = 1, center = true);";
    let points = [
        [1.9, 0.0, -1.9],
        [1.9, 0.0, -1.0],
        [1.4, 0.0, 0.0],
        [0.0, 1.1, 1.9],
    ];
    assert_eq!(inside(text, &points), [true, false, true, false]);
    assert_eq!(
        inside(
            "cylinder(h = 1, d = 4);",
            &[[1.9, 0.0, 0.5], [2.1, 0.0, 0.5]]
        ),
        [true, false]
    );
    assert!(matches!(
        model("cylinder(h = 2, r1 = 3, r2 = 3);").nodes()[0],
        Node::Shape(Shape::Cylinder(_))
    ));
}

#[test]
fn few_facets_are_meant_and_many_are_not() {
    // A hexagon's first vertex lies on +x, so it reaches 1 there and cos 30° = 0.866 along y.
    let points = [[0.99, 0.0, 0.5], [0.0, 0.87, 0.5], [0.0, 0.86, 0.5]];
    assert_eq!(
        inside("cylinder($fn = 6, h = 1, r = 1);", &points),
        [true, false, true]
    );
    assert_eq!(
        inside("cylinder($fn = 17, h = 1, r = 1);", &points),
        [true, true, true]
    );
    // Fewer than three become three; the opposite side of a triangle is at −½.
    let triangle = "cylinder($fn = 0.1, h = 1, r = 1);";
    assert_eq!(
        inside(triangle, &[[-0.49, 0.0, 0.5], [-0.51, 0.0, 0.5]]),
        [true, false]
    );
    let options = ReadOptions {
        facet_limit: 0,
        ..ReadOptions::default()
    };
    let round = read("cylinder($fn = 6, h = 1, r = 1);", "", &options).unwrap();
    assert!(matches!(
        round.model.nodes()[0],
        Node::Shape(Shape::Cylinder(_))
    ));
    // Infinite $fn means round, too; in OpenSCAD it happens to be a triangle.
    assert!(matches!(
        model("cylinder($fn = inf, h = 1, r = 1);").nodes()[0],
        Node::Shape(Shape::Cylinder(_))
    ));
}

#[test]
fn faceted_spheres_have_flat_poles() {
    // $fn = 5: rings at 30°, 90°, 150°; caps at ±cos 30° and vertices at radius 1 on the equator.
    let points = [
        [0.0, 0.0, 0.86],
        [0.0, 0.0, 0.87],
        [0.999, 0.0, 0.0],
        [-0.80, 0.0, 0.0],
        [-0.82, 0.0, 0.0],
    ];
    assert_eq!(
        inside("sphere($fn = 5, r = 1);", &points),
        [true, false, true, true, false]
    );
    let once = warnings("sphere($fn = 5, r = 1); sphere($fn = 5, r = 2); sphere($fn = 8, r = 2);");
    assert_eq!(
        once,
        [
            "t.csg:1:1: a sphere with $fn = 5 is taken as the polyhedron that OpenSCAD makes of it, \
          here and 2 times more (true spheres have $fn = 0 or above the facet limit of 16)"
        ]
    );
    for sides in 1..=16 {
        assert_eq!(warnings(&format!("sphere($fn = {sides}, r = 1);")).len(), 1);
    }
}

#[test]
fn the_first_operand_of_a_difference_is_the_first_that_is_not_removed() {
    let points = [[0.5; 3], [1.5; 3]];
    let cut = "difference() { *cube(9); %cube(9); cube(2); cube(1); }";
    assert_eq!(inside(cut, &points), [false, true]);
    assert!(is_empty(&model("difference() { group(); cube(2); }")));
    assert_eq!(
        inside("difference() { cube(2); group(); }", &points),
        [true, true]
    );
    assert!(is_empty(&model(
        "difference() { group() { group() {} } cube(2); }"
    )));
    assert!(is_empty(&model("difference();")));
    // An operand that OpenSCAD drops is an empty operand.
    assert!(is_empty(&model("difference() { cube(0); cube(2); }")));
}

#[test]
fn an_intersection_with_an_empty_operand_is_empty() {
    assert!(is_empty(&model("intersection() { cube(2); group(); }")));
    assert!(is_empty(&model(
        "intersection() { cube(2); sphere(r = -1); }"
    )));
    assert!(is_empty(&model("intersection();")));
    assert!(!is_empty(&model("intersection() { cube(2); *group(); }")));
    let both = "intersection() { cube(2); cube(3, center = true); }";
    assert_eq!(
        inside(both, &[[1.0; 3], [1.7; 3], [-1.0; 3]]),
        [true, false, false]
    );
}

#[test]
fn a_root_modifier_drops_everything_else_even_transforms() {
    let text =
        "cube(9); multmatrix([[1,0,0,50],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { !group() { cube(1); } }";
    assert_eq!(
        inside(text, &[[0.5; 3], [2.0; 3], [50.5, 0.5, 0.5]]),
        [true, false, false]
    );
    assert_eq!(
        warnings("!cube(1); !cube(2);"),
        ["t.csg:1:12: a second root modifier `!` is ignored"]
    );
    // In a disabled subtree it does not count, and errors beside the root do not matter.
    assert_eq!(
        inside("*group() { !cube(9); } cube(1);", &[[2.0; 3]]),
        [false]
    );
    assert!(try_read("hull() {} !cube(1);").is_ok());
}

#[test]
fn highlighted_parts_count_and_background_ones_do_not() {
    assert_eq!(
        inside("#cube(1); %cube(2);", &[[0.5; 3], [1.5; 3]]),
        [true, false]
    );
    assert!(try_read("*hull(); %text(\"a\"); cube(1);").is_ok());
}

#[test]
fn matrices_are_for_column_vectors() {
    // A quarter turn about z, then (5, 0, 0).
    let text = "multmatrix([[0,-1,0,5],[1,0,0,0],[0,0,1,0],[0,0,0,1]]) cube([3, 1, 1]);";
    assert_eq!(
        inside(text, &[[4.5, 2.5, 0.5], [5.5, 0.5, 0.5]]),
        [true, false]
    );
    // Nested ones: the inner one moves first.
    let nested =
        "multmatrix([[2,0,0,0],[0,2,0,0],[0,0,2,0],[0,0,0,1]]) translate([1, 0, 0]) cube(1);";
    assert_eq!(
        inside(nested, &[[3.9, 1.9, 1.9], [1.9, 0.1, 0.1]]),
        [true, false]
    );
    // A mirror image stays a solid.
    let mirror = "multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }";
    assert_eq!(
        inside(mirror, &[[-0.5, 0.5, 0.5], [0.5, 0.5, 0.5]]),
        [true, false]
    );
    // Identities leave no trace.
    let identity = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,-0],[0,0,0,1]]) { cube(1); }";
    assert_eq!(model(identity).nodes().len(), 1);
}

#[test]
fn motions_of_hand_written_files_work() {
    assert_eq!(
        inside(
            "rotate([0, 90, 0]) cylinder(h = 9, r = 1);",
            &[[8.0, 0.0, 0.0]]
        ),
        [true]
    );
    assert_eq!(
        inside("rotate(90) cube([5, 1, 1]);", &[[-0.5, 4.5, 0.5]]),
        [true]
    );
    assert_eq!(
        inside(
            "rotate(a = 90, v = [1, 0, 0]) cube([1, 5, 1]);",
            &[[0.5, -0.5, 4.5]]
        ),
        [true]
    );
    assert_eq!(
        inside(
            "scale([2, 3]) cube(1);",
            &[[1.9, 2.9, 0.9], [0.5, 0.5, 1.1]]
        ),
        [true, false]
    );
    assert_eq!(
        inside("mirror([1, 0, 0]) cube(1);", &[[-0.5, 0.5, 0.5]]),
        [true]
    );
}

#[test]
fn what_openscad_drops_is_dropped_with_a_warning_that_names_the_line() {
    for (text, expected) in [
        (
            "\ncube(size = [1, 0, 1]);",
            "t.csg:2:1: a cube of size [1, 0, 1] has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "\ncube(size = [inf, inf, inf]);",
            "t.csg:2:1: a cube of size [inf, inf, inf] has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "sphere(r = -2);",
            "t.csg:1:1: a sphere of radius -2 has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "sphere(r = nan);",
            "t.csg:1:1: a sphere of radius NaN has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "cylinder(h = -inf, r1 = 1, r2 = 1);",
            "t.csg:1:1: a cylinder of height -inf and radii 1, 1 has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "cylinder(h = 1, r1 = 1, r2 = -1);",
            "t.csg:1:1: a cylinder of height 1 and radii 1, -1 has no volume; it is left out, as in OpenSCAD",
        ),
        (
            "multmatrix([[1,0,0,0],[0,0,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }",
            "t.csg:1:1: the matrix is singular: it flattens everything; the children are left out, as in OpenSCAD",
        ),
        (
            "scale(0) cube(1);",
            "t.csg:1:1: the matrix is singular: it flattens everything; the children are left out, as in OpenSCAD",
        ),
        (
            "multmatrix([[1,0,0,nan],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(1); }",
            "t.csg:1:1: the matrix holds a number that is not finite; the children are left out, as in OpenSCAD",
        ),
        ("", "t.csg:1:1: the file holds no nodes; the model is empty"),
    ] {
        let reading = try_read(text).unwrap();
        assert_eq!(lines(&reading.warnings), [expected]);
        assert!(is_empty(&reading.model), "{text}");
    }
}

#[test]
fn plane_figures_among_solids_are_left_out() {
    assert_eq!(
        warnings("difference() { cube(2); circle(r = 1); }"),
        ["t.csg:1:25: `circle` is 2-D among 3-D nodes; it is left out, as in OpenSCAD"]
    );
    let flat = errors("group() { square([1, 1]); cube(1); }");
    assert_eq!(
        flat,
        [
            "t.csg:1:11: the model is 2-D only: `square` has no volume (make a solid of it with \
          linear_extrude or rotate_extrude)"
        ]
    );
}

#[test]
fn colours_become_materials() {
    let colour = |text: &str| match model(text).materials() {
        [_] => None,
        [_, Material { color }] => *color,
        more => panic!("{more:?}"),
    };
    assert_eq!(
        colour("color([1, 0.5, 0, 0.25]) { cube(1); }"),
        Some([1.0, 0.5, 0.0, 0.25])
    );
    assert_eq!(colour("color([-1, -1, -1, 1]) { cube(1); }"), None);
    assert_eq!(
        colour("color(\"red\", 0.5) { cube(1); }"),
        Some([1.0, 0.0, 0.0, 0.5])
    );
    assert_eq!(
        colour("color(c = \"#00ff00\") { cube(1); }"),
        Some([0.0, 1.0, 0.0, 1.0])
    );
    assert_eq!(warnings("color(\"nocolour\") { cube(1); }").len(), 1);
}

#[test]
fn the_added_shapes_mean_what_they_say() {
    let ring = "torus(r1 = 3, r2 = 1);";
    assert_eq!(
        inside(ring, &[[3.0, 0.0, 0.9], [0.0; 3], [4.1, 0.0, 0.0]]),
        [true, false, false]
    );
    let half = "halfspace(n = [0, 0, 2], d = 4);";
    assert_eq!(
        inside(half, &[[9.0, 9.0, 1.9], [0.0, 0.0, 2.1]]),
        [true, false]
    );
    let ball = "quadric([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,-4]]);";
    assert_eq!(
        inside(ball, &[[1.9, 0.0, 0.0], [1.5, 1.5, 0.0]]),
        [true, false]
    );
    // An upper triangular matrix means the same form: 2xy ≤ 1.
    let upper = "quadric([[0,2,0,0],[0,0,0,0],[0,0,0,0],[0,0,0,-1]]);";
    assert_eq!(
        inside(upper, &[[0.7, 0.7, 5.0], [0.8, 0.8, 5.0]]),
        [true, false]
    );
    let tube = "polynomial(\"x^2 + y^2 - 1e0\");";
    assert_eq!(
        inside(tube, &[[0.9, 0.0, 7.0], [0.9, 0.9, 7.0]]),
        [true, false]
    );
    assert!(matches!(
        model("helicoid();").nodes()[0],
        Node::Shape(Shape::Helicoid(_))
    ));
    assert!(is_empty(&model("polynomial(\"1\");")));
    assert_eq!(inside("polynomial(\"-1\");", &[[1e9; 3]]), [true]);
}

#[test]
fn convex_polyhedra_are_read() {
    let text = "polyhedron(points = [[0,0,0],[4,0,0],[0,4,0],[0,0,4]], \
                faces = [[0,1,2],[0,3,1],[0,2,3],[1,3,2]], convexity = 1);";
    assert_eq!(inside(text, &[[1.0; 3], [2.0; 3]]), [true, false]);
}

#[test]
fn other_writers_spacing_is_accepted() {
    // As FreeCAD writes.
    let text = "\u{feff}// CSG file generated from FreeCAD\r\n\
                group () {\r\n multmatrix ([[1.000000,0.0,0.0,1.0],[0.0,1.0,0.0,0.0],[0.0,0.0,1.0,0.0],[0.0,0.0,0.0,1.0]]) {\r\n\
                cube (size = [12.000000,1.0,1.0], center=false);\r\n}\r\n};;";
    assert_eq!(inside(text, &[[12.5, 0.5, 0.5], [0.5; 3]]), [true, false]);
    assert!(warnings(text).is_empty());
}

#[test]
fn any_depth_is_read_without_recursion() {
    let n = 100_000;
    for open in [
        "union() {",
        "difference() {",
        "multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {",
        "color([1,0,0,1]) { cube(1);",
    ] {
        let text = format!("{}cube(1);{}", open.repeat(n), "}".repeat(n));
        drop(model(&text));
    }
    drop(model(&format!(
        "{}cube(1);",
        "translate([1, 0, 0])".repeat(n)
    )));
    let lists = format!("cube(size = {}{});", "[".repeat(n), "]".repeat(n));
    assert_eq!(errors(&lists).len(), 1);
    let parentheses = format!("polynomial(\"{}x{}\");", "(".repeat(n), ")".repeat(n));
    drop(model(&parentheses));
}
