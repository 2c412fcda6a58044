//! Faces of rounded solids, counted: where planes and curved surfaces touch, strips that only the
//! approximation has are no faces.

mod stages;

use stages::convert;

/// Faces and genus at several tolerances.
fn has_faces(source: &str, tolerances: &[f64], faces: usize) {
    for &tolerance in tolerances {
        let found = convert(source, tolerance);
        let counted = (found.groups.faces.len(), found.shells.genus());
        assert_eq!(counted, (faces, 0), "{source} at {tolerance}");
    }
}

fn balls(balls: &[([f64; 3], f64)]) -> String {
    let balls = balls
        .iter()
        .map(|(center, radius)| format!("translate({center:?}) sphere(r = {radius});"));
    format!("hull() {{ {} }}", balls.collect::<String>())
}

/// A box has 6 faces, 12 edges and 8 corners: planes, cylinders and balls.
#[test]
fn a_rounded_box_has_26_faces() {
    let tolerances = [0.05, 0.02];
    let sum = "minkowski() { cube([6, 5, 4]); sphere(r = 1); }";
    has_faces(sum, &tolerances, 26);
    let corners: Vec<([f64; 3], f64)> = (0..8)
        .map(|at: u32| {
            let pick = |bit: u32, side: f64| if at >> bit & 1 == 1 { side } else { 0.0 };
            ([pick(0, 5.0), pick(1, 7.0), pick(2, 10.0)], 1.0)
        })
        .collect();
    has_faces(&balls(&corners), &tolerances, 26);
}

/// Of four balls in general position: 4 planes, 6 cones, 4 balls.
#[test]
fn hulls_of_balls_have_planes_cones_and_balls() {
    let four = [
        ([0.0, 0.0, 0.0], 3.0),
        ([10.0, 0.0, 0.0], 2.0),
        ([3.0, 8.0, 1.0], 1.0),
        ([3.0, 3.0, 8.0], 1.5),
    ];
    has_faces(&balls(&four), &[0.05, 0.01], 14);
    has_faces(&balls(&four[..2]), &[0.05, 0.01], 3);
}

/// Two discs, a cylinder and two quarters of tori.
#[test]
fn a_rounded_cylinder_has_5_faces() {
    let sum = "minkowski() { cylinder(h = 10, r = 5); sphere(r = 1.5); }";
    has_faces(sum, &[0.05, 0.02], 5);
}

/// A groove narrower than the tolerance, with plane sides and a round bottom, keeps its faces:
/// the cylinder's two parts, its ends, and the groove's three.
#[test]
fn true_faces_stay_however_narrow() {
    let groove = "difference() { cylinder(h = 10, r = 5); translate([0, 0, 4]) \
                  difference() { cylinder(h = 0.04, r = 6); cylinder(h = 0.04, r = 4.5); } }";
    has_faces(groove, &[0.2, 0.05], 7);
}
