//! Triangles over named vertices become half-edges: a twin is the edge with swapped names.

#![expect(
    clippy::cast_possible_truncation,
    reason = "the number of half-edges is checked to fit 32 bits"
)]

use crate::Error;
use crate::edges::{Faults, following, for_each_edge, previous};
use crate::topology::{Brep, Facet, FacetKey, HalfEdge, HalfEdgeKey, Vertex, VertexKey};
use glam::DVec3;
use slotmap::{Key, SlotMap};
use subdiv::Fragments;

/// Joins triangles along their common edges.
///
/// Two triangles share an edge exactly when they name the same two vertices; no coordinate is
/// compared. Vertices that no triangle uses are left out. Vertices and facets keep their order.
///
/// Cost: O(n log d) for n triangles and d the largest number of triangles around a vertex,
/// without hashing.
///
/// # Errors
/// The first edge that is open or used twice in one direction, or the first malformed triangle.
pub fn stitch(fragments: &Fragments) -> Result<Brep, Error> {
    let twins = pair_half_edges(&fragments.positions, fragments.triangles.len(), |t| {
        fragments.triangles[t].vertices
    })?;
    Ok(build(fragments, &twins))
}

/// Says whether plain triangles over `vertex_count` vertices form a closed, oriented 2-manifold.
///
/// # Errors
/// As [`stitch`], and [`Error::PinchedVertex`]; positions in them are not numbers.
pub fn check_manifold(vertex_count: usize, triangles: &[[u32; 3]]) -> Result<(), Error> {
    let positions = vec![DVec3::NAN; vertex_count];
    let twins = pair_half_edges(&positions, triangles.len(), |t| triangles[t])?;
    let mut degree = vec![0_u32; vertex_count];
    let mut outgoing = vec![0_u32; vertex_count];
    for (t, corners) in triangles.iter().enumerate() {
        for (k, &corner) in corners.iter().enumerate() {
            degree[corner as usize] += 1;
            outgoing[corner as usize] = (3 * t + k) as u32;
        }
    }
    for (vertex, (&degree, &first)) in degree.iter().zip(&outgoing).enumerate() {
        let mut half_edge = first;
        for _ in 0..degree.saturating_sub(1) {
            half_edge = twins[previous(half_edge) as usize];
            if half_edge == first {
                return Err(Error::PinchedVertex { vertex });
            }
        }
    }
    Ok(())
}

/// The twin of each half-edge; half-edge 3t + k starts at corner k of triangle t.
fn pair_half_edges(
    positions: &[DVec3],
    triangle_count: usize,
    triangle: impl Fn(usize) -> [u32; 3],
) -> Result<Vec<u32>, Error> {
    let origin = |half_edge: u32| triangle(half_edge as usize / 3)[half_edge as usize % 3];
    let mut twins = vec![0_u32; triangle_count.saturating_mul(3)];
    let mut faults = Faults::default();
    for_each_edge(
        positions.len(),
        triangle_count,
        &triangle,
        |edge| match edge.len() {
            2 if origin(edge.get(0)) != origin(edge.get(1)) => {
                twins[edge.get(0) as usize] = edge.get(1);
                twins[edge.get(1) as usize] = edge.get(0);
            }
            _ => faults.add(edge, &origin),
        },
    )?;
    faults.into_result(positions, &origin)?;
    Ok(twins)
}

fn build(fragments: &Fragments, twins: &[u32]) -> Brep {
    let mut brep = Brep {
        vertices: SlotMap::with_capacity_and_key(fragments.positions.len()),
        half_edges: SlotMap::with_capacity_and_key(twins.len()),
        facets: SlotMap::with_capacity_and_key(fragments.triangles.len()),
    };
    // Keys first: half-edges refer to each other in all directions.
    let blank = HalfEdge {
        twin: HalfEdgeKey::null(),
        next: HalfEdgeKey::null(),
        origin: VertexKey::null(),
        facet: FacetKey::null(),
    };
    let keys: Vec<HalfEdgeKey> = twins
        .iter()
        .map(|_| brep.half_edges.insert(blank))
        .collect();
    let mut outgoing = vec![HalfEdgeKey::null(); fragments.positions.len()];
    for (triangle, keys) in fragments.triangles.iter().zip(keys.chunks_exact(3)) {
        for (&v, &key) in triangle.vertices.iter().zip(keys) {
            outgoing[v as usize] = key;
        }
    }
    let mut vertices = vec![VertexKey::null(); fragments.positions.len()];
    for (v, &outgoing) in outgoing.iter().enumerate() {
        if !outgoing.is_null() {
            let position = fragments.positions[v];
            vertices[v] = brep.vertices.insert(Vertex { position, outgoing });
        }
    }
    for (triangle, keys) in fragments.triangles.iter().zip(keys.chunks_exact(3)) {
        brep.facets.insert(Facet {
            half_edge: keys[0],
            primitive: triangle.primitive,
            sense: triangle.sense,
            material: triangle.material,
        });
    }
    let facets: Vec<FacetKey> = brep.facets.keys().collect();
    for (half_edge, slot) in (0_u32..).zip(brep.half_edges.values_mut()) {
        let (t, k) = (half_edge as usize / 3, half_edge as usize % 3);
        *slot = HalfEdge {
            twin: keys[twins[half_edge as usize] as usize],
            next: keys[following(half_edge) as usize],
            origin: vertices[fragments.triangles[t].vertices[k] as usize],
            facet: facets[t],
        };
    }
    brep
}

#[cfg(test)]
mod tests;
