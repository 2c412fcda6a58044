//! OpenSCAD's extrusions, polyhedra, hulls and sums against volumes that have a formula.

mod stages;

use stages::{Converted, convert};
use std::f64::consts::PI;

/// Converts and compares with the formula's volume; `curved`: area of the curved faces, whose
/// facets may be off by the tolerance.
fn check(source: &str, volume: f64, curved: f64) -> Converted {
    let tolerance = 0.01;
    let converted = convert(source, tolerance);
    let difference = (converted.properties.volume - volume).abs();
    let bound = curved * tolerance * 1.05 + 1e-9 * volume;
    assert!(difference <= bound, "{source}: {difference} > {bound}");
    converted
}

#[test]
fn extruded_polygons_are_exact() {
    let found = check(
        "linear_extrude(height = 2) polygon(points = [[0,0],[4,0],[4,3],[2,1],[0,3]]);",
        16.0,
        0.0,
    );
    assert_eq!(found.groups.faces.len(), 7);
    let frame =
        "points = [[0,0],[4,0],[4,4],[0,4],[1,1],[1,3],[3,3],[3,1]], paths = [[0,1,2,3],[4,5,6,7]]";
    let frame_found = check(
        &format!("linear_extrude(height = 2) polygon({frame});"),
        24.0,
        0.0,
    );
    assert_eq!(frame_found.shells.genus(), 1);
    // A pyramid: a third.
    check(
        &format!("linear_extrude(height = 2, scale = 0) polygon({frame});"),
        8.0,
        0.0,
    );
    let bow_tie = "linear_extrude(height = 1) polygon(points = [[0,0],[2,2],[2,0],[0,2]]);";
    assert_eq!(check(bow_tie, 2.0, 0.0).shells.solids.len(), 2);
}

/// ∫ (1 + (a − 1)t)(1 + (b − 1)t) dt over \[0, 1\] = (2ab + a + b + 2)/6.
#[test]
fn tapered_extrusions_have_their_integral() {
    for (a, b) in [(0.5, 0.5), (0.5, 2.0), (0.0, 1.0), (2.0, 3.0)] {
        let factor = (2.0 * a * b + a + b + 2.0) / 6.0;
        let source = format!("linear_extrude(height = 3, scale = [{a}, {b}]) circle(r = 1);");
        let area: f64 = 2.0 * PI * 3.0 * 3.5;
        check(&source, 3.0 * PI * factor, area);
        let source = format!(
            "linear_extrude(height = 3, scale = [{a}, {b}]) rotate(30) square(2, center = true);"
        );
        check(&source, 12.0 * factor, 3.0 * 8.0 * 3.5);
    }
}

/// Pappus: area times the way of the centroid.
#[test]
fn swept_profiles_obey_pappus() {
    let profile = "translate([3, 0]) polygon(points = [[0,0],[4,0],[4,3],[2,1],[0,3]]);";
    for angle in [360.0, 270.0, 180.0, 45.0, -90.0_f64] {
        let way = 5.0 * angle.abs().to_radians();
        let source = format!("rotate_extrude(angle = {angle}) {profile}");
        check(&source, 8.0 * way, way / 5.0 * 7.0 * 20.0);
    }
    let way = 2.0 * PI * 5.0;
    check(
        "rotate_extrude() translate([5, 1]) circle(r = 2);",
        4.0 * PI * way,
        4.0 * PI * way,
    );
    check(
        "rotate_extrude() translate([5, 1]) rotate(30) scale([2, 1]) circle(r = 1);",
        2.0 * PI * way,
        10.0 * way,
    );
    // A regular hexagon's area is 3√3/2 r².
    check(
        "rotate_extrude($fn = 6) translate([2, 0]) square([1, 2]);",
        1.5 * 3.0_f64.sqrt() * (9.0 - 4.0) * 2.0,
        0.0,
    );
}

/// Two discs of radius 1 at distance 4: π + 8.
#[test]
fn the_hull_of_discs_is_a_stadium() {
    let source =
        "linear_extrude(height = 1) hull() { circle(r = 1); translate([4, 0]) circle(r = 1); }";
    let found = check(source, PI + 8.0, 2.0 * PI);
    assert_eq!(found.shells.solids.len(), 1);
}

/// The hull of a body and its copy is its Minkowski sum with a segment: of the unit cube and
/// (t, t, t), 1 + 3t.
#[test]
fn hulls_of_boxes_are_exact() {
    for t in [0.25, 1.0, 3.0] {
        let source =
            format!("hull() {{ cube(1); translate([{t}, {t}, {t}]) color(\"red\") cube(1); }}");
        let found = check(&source, 1.0 + 3.0 * t, 0.0);
        assert_eq!(found.groups.faces.len(), 12);
    }
    let flush = check(
        "hull() { cube(1); translate([2, 0, 0]) cube(1); }",
        3.0,
        0.0,
    );
    assert_eq!(flush.groups.faces.len(), 6);
    // Two pyramids over a square of diagonal 2.
    let octahedron = "hull() { cylinder(h = 1, r1 = 1, r2 = 0, $fn = 4); mirror([0, 0, 1]) cylinder(h = 1, r1 = 1, r2 = 0, $fn = 4); }";
    assert_eq!(check(octahedron, 4.0 / 3.0, 0.0).groups.faces.len(), 8);
}

/// Volumes of the meshes that OpenSCAD 2021.01 makes of the same text.
#[test]
fn twisted_extrusions_have_openscads_layers() {
    let figure =
        "difference() { square(10, center = true); translate([1, 0]) square(4, center = true); }";
    for twist in [90, -90] {
        let source = format!("linear_extrude(height = 10, twist = {twist}, slices = 10) {figure}");
        // Its STL has six digits: 5e-6 of the size, on 600 of area.
        let found = check(&source, 880.354_77, 0.3);
        assert_eq!(found.shells.genus(), 1);
    }
}

/// Steiner's formula for a box of sides a, b, c: its volume, slabs, edges and corners.
#[test]
fn rounded_boxes_obey_steiner() {
    let [a, b, c, r] = [4.0, 3.0, 2.0, 0.5_f64];
    let volume = a * b * c
        + 2.0 * r * (a * b + b * c + c * a)
        + PI * r * r * (a + b + c)
        + 4.0 / 3.0 * PI * r.powi(3);
    let curved = 2.0 * PI * r * (a + b + c) + 4.0 * PI * r * r;
    let sum = format!("minkowski() {{ cube([{a}, {b}, {c}]); sphere(r = {r}); }}");
    let found = check(&sum, volume, curved);
    assert_eq!((found.shells.solids.len(), found.shells.genus()), (1, 0));
    let corners: Vec<String> = (0..8)
        .map(|at: u32| {
            let pick = |bit: u32, side: f64| if at >> bit & 1 == 1 { side } else { 0.0 };
            let [x, y, z] = [pick(0, a), pick(1, b), pick(2, c)];
            format!("translate([{x}, {y}, {z}]) sphere(r = {r});")
        })
        .collect();
    let corners = corners.concat();
    let found = check(&format!("hull() {{ {corners} }}"), volume, curved);
    assert_eq!((found.shells.solids.len(), found.shells.genus()), (1, 0));
}

/// Two balls and the frustum between the circles in which their common cone touches them.
#[test]
fn the_hull_of_two_balls_has_a_cone() {
    let [big, small, gap] = [2.0, 1.0, 4.0_f64];
    let sine: f64 = (big - small) / gap;
    let cosine = (1.0 - sine * sine).sqrt();
    let cap = |r: f64, height: f64| PI * height * height * (r - height / 3.0);
    let frustum = |p: f64, q: f64, h: f64| PI * h / 3.0 * (p * p + p * q + q * q);
    let volume = cap(big, big * (1.0 + sine))
        + cap(small, small * (1.0 - sine))
        + frustum(big * cosine, small * cosine, gap - (big - small) * sine);
    let source =
        format!("hull() {{ sphere(r = {big}); translate([{gap}, 0, 0]) sphere(r = {small}); }}");
    let found = check(&source, volume, 100.0);
    assert_eq!((found.shells.solids.len(), found.shells.genus()), (1, 0));
}

/// A rounded cylinder by Steiner: V + r·A + r²·M + 4/3·π·r³ with the mean curvature integral
/// M = π·h + π²·R of a cylinder.
#[test]
fn rounded_cylinders_end_in_tori() {
    let [radius, h, r] = [2.0, 3.0, 0.5_f64];
    let volume = PI * radius * radius * h
        + r * (2.0 * PI * radius * h + 2.0 * PI * radius * radius)
        + r * r * (PI * h + PI * PI * radius)
        + 4.0 / 3.0 * PI * r.powi(3);
    let source = format!("minkowski() {{ cylinder(h = {h}, r = {radius}); sphere(r = {r}); }}");
    check(&source, volume, 80.0);
}

/// A square frame, grown by a cylinder: the frame's outline grows by r, its hole shrinks.
#[test]
fn sums_with_dented_bodies_are_exact() {
    let frame = "difference() { cube([10, 10, 5]); translate([2, 2, -1]) cube([6, 6, 9]); }";
    let r = 1.0_f64;
    let area = 100.0 + 40.0 * r + PI * r * r - (6.0 - 2.0 * r).powi(2);
    let source = format!("minkowski() {{ {frame} cylinder(h = 2, r = {r}); }}");
    let found = check(&source, area * 7.0, 2.0 * PI * 7.0);
    assert_eq!(found.shells.genus(), 1);
    let source = format!("minkowski() {{ {frame} cube([1, 2, 3]); }}");
    check(&source, (11.0 * 12.0 - 5.0 * 4.0) * 8.0, 0.0);
}

#[test]
fn outlines_move_as_their_formulas_say() {
    for (figure, area, arcs) in [
        ("offset(r = 1) square(4)", 16.0 + 16.0 + PI, 2.0 * PI),
        ("offset(r = -1) square(4)", 4.0, 0.0),
        ("offset(delta = 1) square(4)", 36.0, 0.0),
        ("offset(delta = -1) square(4)", 4.0, 0.0),
        // Corners are cut off at distance 1: at each, a triangle of height √2 − 1 is missing.
        (
            "offset(delta = 1, chamfer = true) square(4)",
            36.0 - 4.0 * (2.0_f64.sqrt() - 1.0).powi(2),
            0.0,
        ),
        ("offset(r = 1) circle(r = 2)", 9.0 * PI, 6.0 * PI),
        // An L of three unit squares; at its dent the strips overlap.
        (
            "offset(r = 0.5) polygon(points = [[0,0],[2,0],[2,1],[1,1],[1,2],[0,2]])",
            3.0 + 4.0 - 0.25 + 1.25 * PI * 0.25,
            1.25 * PI,
        ),
        (
            "offset(r = 1) offset(r = -1) square(4)",
            12.0 + PI,
            2.0 * PI,
        ),
        ("minkowski() { square(4); square(2); }", 36.0, 0.0),
        (
            "minkowski() { square(4); circle(r = 1); }",
            32.0 + PI,
            2.0 * PI,
        ),
        (
            "fill() difference() { square(4); translate([1, 1]) square(1); }",
            16.0,
            0.0,
        ),
        ("resize([8, 0], auto = true) square([4, 2])", 32.0, 0.0),
        (
            "projection(cut = true) translate([0, 0, 3]) sphere(r = 5)",
            16.0 * PI,
            8.0 * PI,
        ),
        (
            "projection() rotate([45, 0, 0]) cube(1)",
            2.0_f64.sqrt(),
            0.0,
        ),
        (
            "projection() difference() { cube(3); translate([1, 1, -1]) cube([1, 1, 5]); }",
            8.0,
            0.0,
        ),
        (
            "projection(cut = true) difference() { cube(3, center = true); cube(1, center = true); }",
            8.0,
            0.0,
        ),
    ] {
        let source = format!("linear_extrude(height = 1) {figure};");
        check(&source, area, arcs);
    }
    check(
        "resize([4, 0, 2], auto = [false, true, false]) cube([2, 3, 5]);",
        48.0,
        0.0,
    );
}

/// Tori of flat triangles, smooth and bumpy, against the divergence theorem's sum over them.
#[test]
fn dented_polyhedra_have_the_volume_of_their_mesh() {
    dented_torus(12, 8, 0.0);
    dented_torus(60, 20, 0.1);
}

/// With coordinates of six decimals, as OpenSCAD writes them.
fn dented_torus(rings: usize, sides: usize, bumps: f64) {
    let six = |x: f64| (x * 1e6).round() / 1e6;
    let mut points = Vec::new();
    for i in 0..rings {
        for j in 0..sides {
            let a = 2.0 * PI * i as f64 / rings as f64;
            let b = 2.0 * PI * j as f64 / sides as f64;
            let tube = 1.0 + bumps * (7.0 * a + 3.0 * b).sin();
            let radius = 3.0 + bumps * (5.0 * a).cos() + tube * b.cos();
            let point = [radius * a.cos(), radius * a.sin(), tube * b.sin()];
            points.push(point.map(six));
        }
    }
    let mut faces = Vec::new();
    for i in 0..rings {
        for j in 0..sides {
            let (k, l) = ((i + 1) % rings, (j + 1) % sides);
            let corner = |i: usize, j: usize| i * sides + j;
            faces.push([corner(i, j), corner(k, j), corner(k, l)]);
            faces.push([corner(i, j), corner(k, l), corner(i, l)]);
        }
    }
    let tetrahedra = faces.iter().map(|f| {
        let [a, b, c] = f.map(|v| glam::DVec3::from(points[v]));
        a.dot(b.cross(c)) / 6.0
    });
    let volume: f64 = tetrahedra.sum();
    let found = check(
        &format!("polyhedron(points = {points:?}, faces = {faces:?});"),
        volume,
        0.0,
    );
    assert_eq!(found.shells.genus(), 1);
}
