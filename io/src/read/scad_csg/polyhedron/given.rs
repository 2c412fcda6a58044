//! The mesh of a polyhedron as it was given, for solids that are nothing else.

use super::faces::{Faces, edges};
use csg::{FacetOnPlane, Facets, MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use std::collections::BTreeMap;
use subdiv::Triangle;

/// Distance by which rounding may make triangles pass through each other, in sizes.
const DEPTH: f64 = 1e-12;

/// The faces as a 2-manifold whose triangles do not pass through each other; `None` if they are
/// not one.
pub(super) fn facets(faces: &Faces) -> Option<Facets> {
    let mut corners: Vec<[DVec3; 3]> = Vec::with_capacity(faces.triangles.len());
    let mut labels: Vec<(usize, bool)> = Vec::with_capacity(faces.triangles.len());
    for triangle in &faces.triangles {
        corners.push(triangle.corners);
        labels.push((triangle.plane, triangle.along));
    }
    adopt(&faces.needles, &mut corners, &mut labels);
    let label = |at: usize| {
        let (plane, along) = labels.get(at).copied().unwrap_or_default();
        Triangle {
            vertices: [0; 3],
            primitive: PrimitiveId(u32::try_from(plane).unwrap_or(u32::MAX)),
            sense: if along { Sense::Inside } else { Sense::Outside },
            material: MaterialId(0),
        }
    };
    let welded = brep::weld(&corners, label).ok()?;
    let sound = brep::stitch(&welded).ok()?.validate().ok()?;
    if sound.is_empty() || brep::passes_through_itself(&sound, DEPTH * faces.size) {
        return None;
    }
    let triangles = welded.triangles.iter().map(|t| FacetOnPlane {
        vertices: t.vertices,
        plane: t.primitive.0,
        sense: t.sense,
    });
    Some(Facets {
        triangles: triangles.collect(),
        positions: welded.positions,
        planes: faces.planes.iter().map(|p| (p.normal, p.offset)).collect(),
    })
}

/// Gives triangles without area to the planes of triangles across their edges.
fn adopt(needles: &[[DVec3; 3]], corners: &mut Vec<[DVec3; 3]>, labels: &mut Vec<(usize, bool)>) {
    if needles.is_empty() {
        return;
    }
    let mut at_edge = BTreeMap::new();
    for (triangle, label) in corners.iter().zip(labels.iter()) {
        at_edge.extend(edges(triangle).map(|edge| (edge, *label)));
    }
    let mut left: Vec<[DVec3; 3]> = needles.to_vec();
    loop {
        let before = left.len();
        left.retain(|needle| {
            let beside = edges(needle);
            let Some(label) = beside.iter().find_map(|edge| at_edge.get(edge)).copied() else {
                return true;
            };
            for edge in beside {
                at_edge.entry(edge).or_insert(label);
            }
            corners.push(*needle);
            labels.push(label);
            false
        });
        if left.len() == before {
            return;
        }
    }
}
