//! Faces that only the approximation has.
//!
//! Where a curved surface touches a plane that goes on inside the solid, as in rounded solids, its
//! facets lie below it, and strips of the plane show above them: faces of their own, narrower than
//! the tolerance, that the true boundary does not have. The formula knows: on both sides of such
//! a strip there is solid.

use crate::group::{FaceId, Groups};
use crate::topology::{Brep, FacetKey, FacetView, VertexView};
use crate::validate::Valid;
use csg::{PrimitiveId, Solid};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Distance from a surface at which the solid is asked for, times the domain's size, over the square
/// of the face's width: between surfaces that touch, strips are as shallow as a circle's segments.
const BESIDE: f64 = 0.02;

/// The least such distance, over the domain's size: more than what rounding moves a surface.
const LEAST: f64 = 1e-13;

/// Faces whose rim is shorter than this, in tolerances, are specks: near where surfaces touch,
/// rounding hides on which side of them the solid lies.
const SPECK: f64 = 0.01;

/// Facets of a face that are looked at, at most: its largest.
const LOOKED_AT: usize = 16;

/// Newton steps from a facet to its surface, which is less than the tolerance away.
const STEPS: usize = 4;

/// Gives faces narrower than `tolerance`, in model units, that are not on the true boundary to
/// curved faces beside them; returns how many there were.
///
/// A face is not on the boundary if on both sides of most of its surface there is solid, or on
/// both sides nothing, or if its rim is shorter than a hundredth of the tolerance. Only labels
/// change: the mesh keeps its shape, and the facets are as near to the boundary as before. A true
/// face narrower than the tolerance keeps its name if its facets lie in front of it. Cost: linear,
/// and few evaluations of the formula for each narrow face.
pub fn dissolve_ghosts(brep: Valid<Brep>, solid: &Solid, tolerance: f64) -> (Valid<Brep>, usize) {
    let is_curved = |PrimitiveId(at): PrimitiveId| {
        let primitive = solid.primitives.get(at as usize);
        primitive.is_some_and(|primitive| primitive.polynomial.degree() > 1)
    };
    if !solid.primitives.iter().any(|p| p.polynomial.degree() > 1) {
        return (brep, 0);
    }
    let groups = Groups::of(&brep);
    let ghosts = ghosts(&brep, &groups, solid, tolerance);
    if ghosts.is_empty() {
        return (brep, 0);
    }
    let heirs = heirs(&brep, &groups, &ghosts, is_curved);
    let inherited: Vec<(FacetKey, FaceId)> = (brep.facets())
        .filter_map(|facet| {
            let heir = heirs.get(&groups.face_of[facet.key()])?;
            Some((facet.key(), *heir))
        })
        .collect();
    let mut inner = brep.into_inner();
    for (key, FaceId(heir)) in inherited {
        let heir = groups.faces[heir as usize];
        let facet = &mut inner.facets[key];
        facet.primitive = heir.primitive;
        facet.sense = heir.sense;
        facet.material = heir.material;
    }
    // Labels are no part of what is validated.
    (Valid::untouched(inner), heirs.len())
}

/// The narrow faces off the true boundary.
fn ghosts(brep: &Brep, groups: &Groups, solid: &Solid, tolerance: f64) -> BTreeSet<FaceId> {
    let mut areas = vec![0.0; groups.faces.len()];
    let mut rims = vec![0.0; groups.faces.len()];
    for facet in brep.facets() {
        let FaceId(face) = groups.face_of[facet.key()];
        areas[face as usize] += area(facet);
        for half_edge in facet.half_edges() {
            if groups.is_crease(half_edge) {
                let [from, to] = [half_edge.origin(), half_edge.target()].map(VertexView::position);
                rims[face as usize] += from.distance(to);
            }
        }
    }
    let width = |face: u32| 2.0 * areas[face as usize] / rims[face as usize];
    let mut narrow: BTreeMap<FaceId, Vec<FacetView<'_>>> = BTreeMap::new();
    for facet in brep.facets() {
        let FaceId(face) = groups.face_of[facet.key()];
        if rims[face as usize] > 0.0 && width(face) <= tolerance {
            narrow.entry(FaceId(face)).or_default().push(facet);
        }
    }
    let is_ghost = |FaceId(face): FaceId, facets: &mut Vec<FacetView<'_>>| {
        facets.sort_by(|a, b| area(*b).total_cmp(&area(*a)));
        let primitive = groups.faces[face as usize].primitive;
        let size = solid.domain.size();
        let step = (BESIDE * width(face).powi(2) / size).max(LEAST * size);
        if rims[face as usize] < SPECK * tolerance {
            return true;
        }
        let (mut on, mut all) = (0.0, 0.0);
        for facet in facets.iter().take(LOOKED_AT) {
            let middle = facet.positions().iter().sum::<DVec3>() / 3.0;
            let weight = area(*facet);
            all += weight;
            if is_on_boundary(solid, primitive, middle, step, tolerance) {
                on += weight;
            }
        }
        2.0 * on < all
    };
    (narrow.into_iter())
        .filter_map(|(face, mut facets)| is_ghost(face, &mut facets).then_some(face))
        .collect()
}

fn area(facet: FacetView<'_>) -> f64 {
    0.5 * facet.area_vector().length()
}

/// Whether the solid changes at the point of a surface nearest to `near`; true where none is found
/// within the tolerance.
fn is_on_boundary(
    solid: &Solid,
    PrimitiveId(primitive): PrimitiveId,
    near: DVec3,
    step: f64,
    tolerance: f64,
) -> bool {
    let Some(primitive) = solid.primitives.get(primitive as usize) else {
        return true;
    };
    let polynomial = &primitive.polynomial;
    let mut at = solid.domain.to_centered(near);
    for _ in 0..STEPS {
        let slope = polynomial.gradient(at);
        at -= slope * (polynomial.evaluate(at) / slope.length_squared());
    }
    let normal = polynomial.gradient(at).normalize_or_zero();
    let point = solid.domain.from_centered(at);
    let is_found = point.is_finite() && point.distance(near) <= tolerance && normal != DVec3::ZERO;
    !is_found || solid.contains(point - step * normal) != solid.contains(point + step * normal)
}

/// For each ghost the curved face with the longest border, through other ghosts where it has none.
fn heirs(
    brep: &Brep,
    groups: &Groups,
    ghosts: &BTreeSet<FaceId>,
    is_curved: impl Fn(PrimitiveId) -> bool,
) -> BTreeMap<FaceId, FaceId> {
    let mut borders: BTreeMap<FaceId, BTreeMap<FaceId, f64>> = BTreeMap::new();
    for half_edge in brep.half_edges() {
        let face = groups.face_of[half_edge.facet().key()];
        let other = groups.face_of[half_edge.twin().facet().key()];
        if face != other && ghosts.contains(&face) {
            let [from, to] = [half_edge.origin(), half_edge.target()].map(VertexView::position);
            let beside = borders.entry(face).or_default();
            *beside.entry(other).or_default() += from.distance(to);
        }
    }
    let mut heirs = BTreeMap::new();
    loop {
        let mut found: BTreeMap<FaceId, FaceId> = BTreeMap::new();
        for (&ghost, beside) in &borders {
            if heirs.contains_key(&ghost) {
                continue;
            }
            let mut lengths: BTreeMap<FaceId, f64> = BTreeMap::new();
            for (&other, &length) in beside {
                let heir = if ghosts.contains(&other) {
                    heirs.get(&other).copied()
                } else {
                    let FaceId(at) = other;
                    is_curved(groups.faces[at as usize].primitive).then_some(other)
                };
                if let Some(heir) = heir {
                    *lengths.entry(heir).or_default() += length;
                }
            }
            let longest = lengths.into_iter().max_by(|a, b| a.1.total_cmp(&b.1));
            found.extend(longest.map(|(heir, _)| (ghost, heir)));
        }
        if found.is_empty() {
            return heirs;
        }
        heirs.extend(found);
    }
}
