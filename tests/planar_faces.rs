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
    let model = stages::read(&fs::read_to_string(path).expect("a fixture"));
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
