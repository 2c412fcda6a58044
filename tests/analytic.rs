//! Volumes that have a formula.
//!
//! A mesh whose every point is within the tolerance t of the true boundary, and the other way
//! round, differs in volume by at most area · t + O(t²); the area is the formula's own.

mod stages;

use stages::{Converted, convert};
use std::f64::consts::PI;

/// Converts, and compares with the formula's volume, area, number of solids and genus.
fn check(source: &str, volume: f64, area: f64, solids: usize, genus: u64) -> Converted {
    for tolerance in [0.02, 0.003] {
        let converted = convert(source, tolerance);
        assert_eq!(converted.shells.solids.len(), solids, "{source}");
        assert_eq!(converted.shells.genus(), genus, "{source}");
        assert_eq!(converted.report.uncertified_leaves, 0, "{source}");
        let difference = (converted.properties.volume - volume).abs();
        let bound = area * tolerance * 1.05;
        assert!(difference <= bound, "{source}: {difference} > {bound}");
        if tolerance < 0.01 {
            return converted;
        }
    }
    unreachable!("the last tolerance returns")
}

#[test]
fn sphere() {
    check("sphere(r=1);", 4.0 / 3.0 * PI, 4.0 * PI, 1, 0);
}

#[test]
fn box_minus_cylinder() {
    let volume = 8.0 - 2.0 * PI * 0.36;
    let area = 24.0 - 2.0 * PI * 0.36 + 2.0 * 2.0 * PI * 0.6;
    let source = "difference() { cube(2, center=true); cylinder(r=0.6, h=3, center=true); }";
    check(source, volume, area, 1, 1);
}

/// Two equal cylinders at right angles: 16 r³/3, area 16 r². They are tangent in two points, where
/// the certificate needs their common normal.
#[test]
fn steinmetz_of_two_cylinders() {
    let source = "intersection() { cylinder(r=1, h=4, center=true);
        multmatrix([[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]) cylinder(r=1, h=4, center=true); }";
    check(source, 16.0 / 3.0, 16.0, 1, 0);
}

/// Three of them: 8 (2 − √2) r³, area 24 (2 − √2) r².
#[test]
fn steinmetz_of_three_cylinders() {
    let source = "intersection() { cylinder(r=1, h=4, center=true);
        multmatrix([[1,0,0,0],[0,0,-1,0],[0,1,0,0],[0,0,0,1]]) cylinder(r=1, h=4, center=true);
        multmatrix([[0,0,1,0],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]) cylinder(r=1, h=4, center=true); }";
    let root = 2.0 - 2f64.sqrt();
    check(source, 8.0 * root, 24.0 * root, 1, 0);
}

/// 2π²·R·r², area 4π²·R·r.
#[test]
fn torus() {
    let volume = 2.0 * PI * PI * 0.09;
    let area = 4.0 * PI * PI * 0.3;
    check("torus(r1=1, r2=0.3);", volume, area, 1, 1);
}

/// πh/3·(R² + Rr + r²).
#[test]
fn frustum() {
    let volume = PI * 2.0 / 3.0 * (1.0 + 0.5 + 0.25);
    let slant = (4.0f64 + 0.25).sqrt();
    let area = PI * (1.0 + 0.25 + 1.5 * slant);
    check("cylinder(h=2, r1=1, r2=0.5);", volume, area, 1, 0);
}

/// A block of 1 × 2 × 3 under a shear keeps its volume; planes are exact at any tolerance.
#[test]
fn sheared_block_is_exact() {
    let source = "multmatrix([[1,0.3,0.2,5],[0,1,0.4,-7],[0,0,1,11],[0,0,0,1]]) cube([1,2,3]);";
    let converted = convert(source, 0.5);
    assert!((converted.properties.volume - 6.0).abs() <= 6e-13);
    assert_eq!(converted.groups.faces.len(), 6);
    assert_eq!(converted.groups.edges.len(), 12);
    assert_eq!(converted.groups.vertices.len(), 8);
}

/// A negative determinant mirrors the point set; it does not turn the solid inside out.
#[test]
fn mirrored_solid_keeps_its_sign() {
    let source = "multmatrix([[-1,0,0,3],[0,2,0,0],[0,0,1,0],[0,0,0,1]]) sphere(r=1);";
    let converted = convert(source, 0.003);
    assert!((converted.properties.volume - 8.0 / 3.0 * PI).abs() < 0.1);
}

#[test]
fn cubes_that_share_a_face_are_one_box() {
    let source = "cube(1); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1],[0,0,0,1]]) cube(1);";
    let converted = convert(source, 0.1);
    assert!((converted.properties.volume - 2.0).abs() <= 1e-12);
    assert!((converted.properties.area - 10.0).abs() <= 1e-12);
    assert_eq!(converted.groups.faces.len(), 6);
    assert_eq!(converted.groups.vertices.len(), 8);
    let inner = converted.brep.facets().filter(|facet| {
        let z = facet.vertices().map(|v| v.position().z);
        z.iter().all(|z| (z - 1.0).abs() < 1e-9)
    });
    assert_eq!(inner.count(), 0);
}

/// The same, described differently: the shared plane comes from a scaled and a mirrored cube.
#[test]
fn coincidence_survives_different_descriptions() {
    let source = "
        multmatrix([[3,0,0,0],[0,3,0,0],[0,0,3,0],[0,0,0,1]]) cube(1);
        multmatrix([[0,-1,0,3],[1,0,0,0],[0,0,-1,6],[0,0,0,1]]) cube(3, center=false);";
    let converted = convert(source, 0.5);
    assert!((converted.properties.volume - 54.0).abs() <= 1e-11);
    assert_eq!(converted.shells.solids.len(), 1);
}

#[test]
fn a_minus_a_is_empty() {
    let source = "difference() { torus(r1=1, r2=0.3); torus(r1=1, r2=0.3); }";
    let converted = convert(source, 0.1);
    assert_eq!(converted.brep.facet_count(), 0);
}

/// Walls between different primitives survive at any thickness: a shell of 1e-7 of the size.
#[test]
fn a_thin_shell_stays_whole() {
    let converted = convert("difference() { sphere(r=1); sphere(r=0.9999999); }", 0.01);
    assert_eq!(converted.shells.shells.len(), 2);
    assert_eq!(converted.shells.solids.len(), 1);
    assert_eq!(converted.shells.solids[0].voids.len(), 1);
    assert_eq!(converted.shells.genus(), 0);
}
