//! Triangles over named vertices become half-edges: a twin is the edge with swapped names.

#![expect(
    clippy::cast_possible_truncation,
    reason = "the number of half-edges is checked to fit 32 bits"
)]

use crate::Error;
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

fn following(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 {
        half_edge - 2
    } else {
        half_edge + 1
    }
}

fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) {
        half_edge + 2
    } else {
        half_edge - 1
    }
}

/// The twin of each half-edge; half-edge 3t + k starts at corner k of triangle t.
///
/// Every half-edge is dropped into the bucket of its smaller vertex, and each (short) bucket is
/// sorted by the larger one.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the number of half-edges is checked to fit 32 bits"
)]
fn pair_half_edges(
    positions: &[DVec3],
    triangle_count: usize,
    triangle: impl Fn(usize) -> [u32; 3],
) -> Result<Vec<u32>, Error> {
    let half_edge_count = triangle_count.saturating_mul(3);
    if u32::try_from(half_edge_count).is_err() {
        let triangles = triangle_count;
        return Err(Error::TooManyTriangles { triangles });
    }
    let vertex_count = positions.len();
    // Start of each vertex' bucket, shifted by one while filling.
    let mut start = vec![0_u32; vertex_count + 2];
    for t in 0..triangle_count {
        let [a, b, c] = triangle(t);
        if [a, b, c].iter().any(|&v| v as usize >= vertex_count) {
            return Err(Error::VertexOutOfRange { triangle: t });
        }
        if a == b || b == c || c == a {
            return Err(Error::RepeatedVertex { triangle: t });
        }
        for smaller in [a.min(b), b.min(c), c.min(a)] {
            start[smaller as usize + 2] += 1;
        }
    }
    for v in 2..start.len() {
        start[v] += start[v - 1];
    }
    // (larger vertex, half-edge), packed so that it sorts as one number.
    let mut buckets = vec![0_u64; half_edge_count];
    for t in 0..triangle_count {
        let [a, b, c] = triangle(t);
        for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let at = &mut start[from.min(to) as usize + 1];
            buckets[*at as usize] = u64::from(from.max(to)) << 32 | (3 * t + k) as u64;
            *at += 1;
        }
    }
    let origin = |half_edge: u32| triangle(half_edge as usize / 3)[half_edge as usize % 3];
    let mut twins = vec![0_u32; half_edge_count];
    let mut faults = Faults::default();
    for v in 0..vertex_count {
        let bucket = &mut buckets[start[v] as usize..start[v + 1] as usize];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|x, y| x >> 32 == y >> 32) {
            // The lower half of the packed number.
            let half_edge = |at: usize| edge[at] as u32;
            match edge.len() {
                2 if origin(half_edge(0)) != origin(half_edge(1)) => {
                    twins[half_edge(0) as usize] = half_edge(1);
                    twins[half_edge(1) as usize] = half_edge(0);
                }
                _ => faults.add(edge, &origin),
            }
        }
    }
    faults.into_result(positions, &origin)?;
    Ok(twins)
}

/// Edges that are not used exactly once in each direction.
#[derive(Default)]
struct Faults {
    total: usize,
    /// The half-edge with the smallest index at fault, and whether its edge is overused.
    first: Option<(u32, bool)>,
}

impl Faults {
    fn add(&mut self, edge: &[u64], origin: &impl Fn(u32) -> u32) {
        self.total += 1;
        // A half-edge that repeats an earlier one's direction, else the lonely one itself.
        let start = origin(edge[0] as u32);
        let mut seen = [false; 2];
        let repeated = edge.iter().position(|&packed| {
            let direction = usize::from(origin(packed as u32) == start);
            std::mem::replace(&mut seen[direction], true)
        });
        let found = (edge[repeated.unwrap_or(0)] as u32, repeated.is_some());
        if self.first.is_none_or(|first| found < first) {
            self.first = Some(found);
        }
    }

    fn into_result(self, positions: &[DVec3], origin: &impl Fn(u32) -> u32) -> Result<(), Error> {
        let Some((half_edge, overused)) = self.first else {
            return Ok(());
        };
        let triangle = half_edge as usize / 3;
        let from = positions[origin(half_edge) as usize];
        let to = positions[origin(following(half_edge)) as usize];
        let total = self.total;
        Err(if overused {
            Error::OverusedEdge {
                triangle,
                from,
                to,
                total,
            }
        } else {
            Error::OpenEdge {
                triangle,
                from,
                to,
                total,
            }
        })
    }
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
