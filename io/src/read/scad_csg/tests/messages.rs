//! Every kind of bad input: what is said, and where.

use super::*;

fn only_error(text: &str) -> String {
    let mut all = errors(text);
    assert_eq!(all.len(), 1, "{all:#?}");
    all.remove(0)
}

#[test]
fn unknown_and_unsupported_nodes_are_named() {
    for (text, expected) in [
        (
            "union() {\n  cyllinder(h = 1);\n}",
            "t.csg:2:3: unknown node `cyllinder` (did you mean `cylinder`?)",
        ),
        ("wheel_hub(3);", "t.csg:1:1: unknown node `wheel_hub`"),
        (
            "cube(1);\nroof() { square(1); }",
            "t.csg:2:1: `roof` is not supported (let OpenSCAD make a mesh of this part, as in openscad -o part.off part.scad, and write import(\"part.off\") in its place)",
        ),
        (
            "surface(file = \"a.dat\"); surface(file = \"b.dat\");",
            "t.csg:1:1: cannot read \"a.dat\": no other files are read here, here and once more (give the model as a file, beside the files that it names)",
        ),
        (
            "text(\"a\");",
            "t.csg:1:1: `text` needs a font: no fonts are read here (convert the model with the program csg2brep)",
        ),
        (
            "circle(r = 1);",
            "t.csg:1:1: the model is 2-D only: `circle` has no volume (make a solid of it with linear_extrude or rotate_extrude)",
        ),
    ] {
        assert_eq!(only_error(text), expected);
    }
}

#[test]
fn several_errors_are_told_at_once() {
    let text = "union() {\n\tcube(size = \"a\");\n\tcubee();\n\troof();\n\tsphere(r = [1]);\n}";
    assert_eq!(
        errors(text),
        [
            "t.csg:2:14: `size` must be a list of 3 numbers, found `\"a\"`",
            "t.csg:3:2: unknown node `cubee` (did you mean `cube`?)",
            "t.csg:4:2: `roof` is not supported (let OpenSCAD make a mesh of this part, as in openscad -o part.off part.scad, and write import(\"part.off\") in its place)",
            "t.csg:5:13: `r` must be a number, found `[1]`",
        ]
    );
    let syntax = "cube(size = ;\nsphere r = 1);\nunion() { cube([1, 2 3]); }\n@";
    assert_eq!(
        errors(syntax),
        [
            "t.csg:1:13: expected a value, found `;`",
            "t.csg:2:8: expected `(` after `sphere`, found `r`",
            "t.csg:3:22: expected `,` or `]`, found `3`",
            "t.csg:4:1: expected a node such as `union() {`, found `@`",
        ]
    );
    assert_eq!(errors(&"cubee() ?;".repeat(50)).len(), 20);
    assert_eq!(errors(&"cube(\"a\");".repeat(50)).len(), 20);
}

#[test]
fn damaged_and_truncated_files_are_told() {
    for (text, expected) in [
        (
            "union() {\n cube(1);\n difference() {",
            "t.csg:3:16: the file ends inside `difference` of line 3: 2 closing `}` are missing (it seems to be cut off: write or copy it again)",
        ),
        (
            "union() { cube(1);",
            "t.csg:1:19: the file ends inside `union` of line 1: 1 closing `}` is missing (it seems to be cut off: write or copy it again)",
        ),
        (
            "cube(size = [1, 2",
            "t.csg:1:18: the file ends where `,` or `]` was expected (it seems to be cut off: write or copy it again)",
        ),
        (
            "multmatrix([[1,0,0,0]])",
            "t.csg:1:24: the file ends where `;` or `{` after `multmatrix(...)` was expected (it seems to be cut off: write or copy it again)",
        ),
        (
            "translate([1, 2, 3]) ",
            "t.csg:1:22: the file ends where `;` or `{` after `translate(...)` was expected (it seems to be cut off: write or copy it again)",
        ),
        (
            "cube(1); }",
            "t.csg:1:10: this `}` closes nothing (remove it, or add the missing `{`)",
        ),
        (
            "cube(1);\n\0\0\0",
            "t.csg:2:1: expected a node such as `union() {`, found a NUL byte (the file is damaged or not text: write or copy it again)",
        ),
        (
            "cube(1); /* no end",
            "t.csg:1:10: the comment that begins here has no end (add the closing */)",
        ),
        (
            "text(\"no end);",
            "t.csg:1:6: the string that begins here has no end (add the closing \")",
        ),
        (
            "cube(é);",
            "t.csg:1:6: expected a value, found the character `é`",
        ),
        (
            "cube(1)",
            "t.csg:1:8: the file ends where `;` or `{` after `cube(...)` was expected (it seems to be cut off: write or copy it again)",
        ),
        (
            "cube(center = ture);",
            "t.csg:1:15: unknown value `ture` (did you mean `true`?)",
        ),
    ] {
        assert_eq!(only_error(text), expected);
    }
}

#[test]
fn programs_are_recognised_and_the_command_is_told() {
    for (text, place, found) in [
        ("// hole\nw = 3;\ncube(w);", "2:1", "an assignment to `w`"),
        ("$fn = 50;", "1:1", "an assignment to `$fn`"),
        (
            "module hole() { cube(1); }",
            "1:1",
            "the statement `module`",
        ),
        (
            "union() { for (i = [0:3]) cube(i); }",
            "1:11",
            "the statement `for`",
        ),
        ("use <lib/gears.scad>", "1:1", "the statement `use`"),
        ("include <a.scad>;", "1:1", "the statement `include`"),
        ("if (true) cube(1);", "1:1", "the statement `if`"),
        (
            "cube(width);",
            "1:6",
            "the variable `width` instead of a value",
        ),
        (
            "cube([1, w, 2]);",
            "1:10",
            "the variable `w` instead of a value",
        ),
        ("cube(-w);", "1:7", "the variable `w` instead of a value"),
        ("cube(size = 2 * 3);", "1:15", "an expression with `*`"),
        ("cube([1 + 1, 2, 3]);", "1:9", "an expression with `+`"),
        ("cube((1));", "1:6", "an expression with `(`"),
        (
            "rotate([0, 0, sin(30)]) cube(1);",
            "1:15",
            "a call of the function `sin`",
        ),
        ("scale([0:2]) cube(1);", "1:9", "an expression with `:`"),
    ] {
        let expected = format!(
            "t.csg:{place}: this is an OpenSCAD program, not a flat CSG dump: found {found} \
             (let OpenSCAD evaluate it: openscad -o t.csg t.scad)"
        );
        assert_eq!(only_error(text), expected);
    }
    let named = read("w = 1;", "dir/part.scad", &ReadOptions::default()).unwrap_err();
    assert!(
        named
            .to_string()
            .ends_with("openscad -o part.csg dir/part.scad)")
    );
}

#[test]
fn the_added_shapes_are_strict() {
    for (text, expected) in [
        (
            "torus(r1 = 3, r2 = nan);",
            "t.csg:1:20: the tube radius r2 must be finite, found NaN",
        ),
        (
            "torus(r1 = -3, r2 = 1);",
            "t.csg:1:12: the ring radius r1 must be positive, found -3 (write r1 = 3, or remove the torus)",
        ),
        (
            "torus(r1 = 3, r2 = 0);",
            "t.csg:1:20: the tube radius r2 must be positive, found 0 (remove the torus)",
        ),
        (
            "torus(r1 = 3);",
            "t.csg:1:1: `torus` needs `r2` (write torus(r1 = 3, r2 = 1))",
        ),
        (
            "halfspace(n = [0, 0, 0], d = 1);",
            "t.csg:1:15: the normal of a half-space must not be zero (write the direction that points out of it, such as n = [0, 0, 1])",
        ),
        (
            "halfspace(n = [0, inf, 0], d = 1);",
            "t.csg:1:15: the normal of a half-space must be finite",
        ),
        (
            "halfspace(n = [0, 1, 0], d = -inf);",
            "t.csg:1:30: the offset of a half-space must be finite",
        ),
        (
            "halfspace(n = [0, 1, 0]);",
            "t.csg:1:1: `halfspace` needs `d` (write halfspace(n = [0, 0, 1], d = 2))",
        ),
        (
            "quadric([[1,0,0,0],[0,nan,0,0],[0,0,1,0],[0,0,0,1]]);",
            "t.csg:1:9: the matrix of a quadric must be finite",
        ),
        (
            "quadric([[0,1,0,0],[-1,0,0,0],[0,0,0,0],[0,0,0,0]]);",
            "t.csg:1:9: this is 0 everywhere and bounds nothing (remove the shape)",
        ),
        (
            "quadric([1, 2]);",
            "t.csg:1:9: `m` must be a list of 4 rows, found `[1, 2]`",
        ),
        (
            "polynomial();",
            "t.csg:1:1: `polynomial` needs `p` (write polynomial(\"x^2 + y^2 - 1\"))",
        ),
        (
            "polynomial(\"x - x\");",
            "t.csg:1:13: this is 0 everywhere and bounds nothing (remove the shape)",
        ),
        (
            "\n polynomial(\"x^2 + 3q\");",
            "t.csg:2:21: expected an operator, found `q`",
        ),
        (
            "polynomial(\"x^65\");",
            "t.csg:1:14: degree 65 is above the limit of 64 (split the solid into set operations on polynomials of lower degree)",
        ),
        (
            "polynomial(\"(x^2+y)^60\");",
            "t.csg:1:20: degree 120 is above the limit of 64 (split the solid into set operations on polynomials of lower degree)",
        ),
        (
            "polynomial(\"x + inf\");",
            "t.csg:1:17: unknown name `inf` (variables are x, y and z; functions have no place in a polynomial)",
        ),
        (
            "polynomial(\"x * 1e400\");",
            "t.csg:1:17: the coefficients become too large for a number (scale the expression)",
        ),
        (
            "polynomial(7);",
            "t.csg:1:12: `p` must be a string, found `7`",
        ),
    ] {
        assert_eq!(only_error(text), expected);
    }
}

#[test]
fn matrices_and_sizes_out_of_range_are_refused() {
    assert_eq!(
        only_error("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0.5,1]]) { cube(1); }"),
        "t.csg:1:12: the last row of a matrix must be [0, 0, 0, 1], found [0, 0, 0.5, 1] \
         (projective maps have no place in an OpenSCAD model)"
    );
    assert!(only_error("sphere(r = 1e90);").contains("1e90 is too large a size"));
    assert!(only_error("multmatrix([[1,0],[0,1]]) { cube(1); }").contains("a list of 4 rows"));
}

#[test]
fn polyhedra_that_name_no_vertices_are_refused() {
    assert!(
        only_error("polyhedron(points = [[0,0,0]], faces = [[0,1.5,2]]);")
            .contains("must list indices")
    );
    assert!(
        only_error("polyhedron(points = [[0,0,0]], faces = [[0,1,2],[0,1,2],[0,1,2],[0,1,2]]);")
            .contains("names vertex 1")
    );
}

#[test]
fn arguments_that_do_not_exist_are_warned_about_except_known_harmless_ones() {
    assert_eq!(
        warnings("sphere(raduis = 3, $fe = 1, convexity = 2); cube(1, true, 5); union(x = 1);"),
        [
            "t.csg:1:8: `sphere` knows no argument `raduis`; it is ignored (it knows r, d)",
            "t.csg:1:59: `cube` takes no more arguments; this one is ignored",
            "t.csg:1:69: `union` knows no argument `x`; it is ignored",
        ]
    );
    assert_eq!(
        warnings("cube(size = 1, size = 2);"),
        ["t.csg:1:16: `size` is given twice; the last one counts"]
    );
    assert_eq!(
        warnings("cube(1) { sphere(1); }"),
        ["t.csg:1:1: `cube` has no children; they are ignored"]
    );
    assert_eq!(
        warnings("cube(sise = 1);")[0]
            .split('(')
            .next_back()
            .unwrap(),
        "did you mean `size`?)"
    );
}

#[test]
fn a_flood_of_warnings_is_counted() {
    let flood = warnings(&"cube(0);".repeat(1000));
    assert_eq!(flood.len(), 51);
    assert_eq!(
        flood[50],
        "t.csg:1:401: 950 more warnings from here on are not listed"
    );
}
