//! Planar faces triangulated from their edges: nothing but the number of facets changes.

mod stages;

use brep::{Brep, Groups, Properties, Retriangulated, Shells, Valid};
use csg::PrimitiveId;
use std::fs;
use subdiv::Rule;

/// A solid before and after.
struct BeforeAndAfter {
    leaves: Valid<Brep>,
    merged: Valid<Brep>,
    counts: Retriangulated,
    planes: Vec<bool>,
}

fn merge(file: &str, tolerance: f64) -> BeforeAndAfter {
    let path = format!("{}/fixtures/{file}", env!("CARGO_MANIFEST_DIR"));
    merge_text(&fs::read_to_string(path).expect("a fixture"), tolerance)
}

fn merge_text(text: &str, tolerance: f64) -> BeforeAndAfter {
    let model = stages::read(text);
    let converted = stages::convert_model(&model, Rule::Tolerance(tolerance));
    let primitives = converted.solid.primitives.iter();
    let planes: Vec<bool> = primitives.map(|p| p.polynomial.degree() == 1).collect();
    let (leaves, _) = brep::simplify::remove_degenerate(converted.brep).expect("valid");
    let (merged, counts) = brep::retriangulate(leaves.clone(), |p| is_plane(&planes, p));
    BeforeAndAfter {
        leaves,
        merged,
        counts,
        planes,
    }
}

fn is_plane(planes: &[bool], PrimitiveId(at): PrimitiveId) -> bool {
    planes[at as usize]
}

fn assert_same_solid(of: &BeforeAndAfter) {
    let [before, after] = [&of.leaves, &of.merged].map(|brep| {
        let (groups, shells) = (Groups::of(brep), Shells::of(brep));
        let counts = [
            groups.faces.len(),
            groups.edges.len(),
            groups.vertices.len(),
            shells.shells.len(),
            shells.solids.len(),
        ];
        (counts, shells.genus())
    });
    assert_eq!(before, after);
    let [before, after] = [&of.leaves, &of.merged].map(Properties::of);
    assert!((before.volume - after.volume).abs() <= 1e-12 * before.volume);
}

#[test]
fn a_plate_with_64_holes_has_vertices_on_its_rims_only() {
    let plate = merge("solids/S6_plate64.csg", 0.05);
    assert_same_solid(&plate);
    assert_eq!((plate.counts.faces, plate.counts.kept), (6, 0));
    let groups = Groups::of(&plate.merged);
    for vertex in plate.merged.vertices() {
        if is_plane(&plate.planes, vertex.outgoing().facet().primitive()) {
            assert!(vertex.ring().any(|h| groups.is_crease(h)));
        }
    }
}

/// Everything is planar here, so only the B-Rep's vertices remain; its edges touch each other in
/// many places. Leaves that crowd there fold facets over each other, which merging undoes.
#[test]
fn a_sponge_has_no_vertices_but_its_corners() {
    let sponge = merge("third_party/openscad/example024.csg", 0.5);
    assert_same_solid(&sponge);
    assert_eq!(sponge.counts.kept, 0);
    let corners = Groups::of(&sponge.merged).vertices.len();
    assert_eq!(sponge.merged.vertex_count(), corners);
    assert!(sponge.merged.facet_count() < sponge.leaves.facet_count());
}

/// Area of all facets of each material, in order of their numbers.
fn areas(brep: &Brep) -> Vec<f64> {
    let mut areas = Vec::new();
    for facet in brep.facets() {
        let at = facet.material().0 as usize;
        areas.resize(areas.len().max(at + 1), 0.0);
        areas[at] += facet.area_vector().length() / 2.0;
    }
    areas
}

#[test]
fn materials_on_one_plane_keep_their_border() {
    // A bar in a plate, flush above and below: the plate's own top is 2 by 2, the bar's 2 by 1.
    let straight = merge_text(
        "color([1,0,0,1]) { cube(size = [2, 2, 1]); } \
         multmatrix([[1,0,0,1],[0,1,0,0.5],[0,0,1,0],[0,0,0,1]]) { \
           color([0,0,1,1]) { cube(size = [3, 1, 1]); } }",
        0.1,
    );
    assert_same_solid(&straight);
    assert_eq!(straight.counts.kept, 0);
    // 8 corners of the plate, 8 of the bar, none in the middle of the borders.
    let counts = (
        straight.merged.vertex_count(),
        straight.merged.facet_count(),
    );
    assert_eq!(counts, (16, 28));
    let found = areas(&straight.merged);
    let plate = 2.0 * 4.0 + 3.0 * 2.0 + 2.0 * 0.5;
    let bar = 2.0 * 2.0 + 2.0 * 2.0 + 1.0;
    for (found, expected) in [(found[1], plate), (found[2], bar)] {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }

    // A peg in a plate, flush with its top: the border is a circle.
    let round = merge_text(
        "color([1,0,0,1]) { difference() { cube(size = [4, 4, 1], center = true); \
           cylinder(h = 2, r1 = 1, r2 = 1, center = true, $fn = 0); } } \
         color([0,0,1,1]) { cylinder(h = 1, r1 = 1, r2 = 1, center = true, $fn = 0); }",
        0.01,
    );
    assert_same_solid(&round);
    let [before, after] = [&round.leaves, &round.merged].map(|brep| areas(brep));
    for (before, after) in before.iter().zip(&after) {
        assert!((before - after).abs() < 1e-12 * 32.0, "{before} {after}");
    }
    // Two disks within 0.01 of the circle.
    let disks = 2.0 * std::f64::consts::PI;
    assert!(
        (after[2] - disks).abs() < 4.0 * std::f64::consts::PI * 0.01,
        "{after:?}"
    );
    let groups = Groups::of(&round.merged);
    for vertex in round.merged.vertices() {
        assert!(
            vertex.ring().any(|h| groups.is_crease(h)),
            "an inner vertex"
        );
    }
}
