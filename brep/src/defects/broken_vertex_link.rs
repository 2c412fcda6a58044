use crate::topology::{Brep, VertexKey};
use glam::DVec3;
use slotmap::SecondaryMap;

/// A vertex around which the facets do not form exactly one cycle, like the waist of a bow-tie.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the facets around the vertex at {position} form more than one cycle, or none")]
pub struct BrokenVertexLink {
    /// The vertex.
    pub vertex: VertexKey,
    /// Where it is.
    pub position: DVec3,
    /// Facets that have the vertex.
    pub facets: u32,
    /// Facets in the cycle that begins at the vertex' outgoing half-edge; 0 when that half-edge
    /// starts elsewhere.
    pub in_cycle: u32,
}

impl BrokenVertexLink {
    /// All of them. Twins must be paired and facets be triangles.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let mut degree: SecondaryMap<VertexKey, u32> =
            brep.vertices.keys().map(|key| (key, 0)).collect();
        for half_edge in brep.half_edges.values() {
            if let Some(degree) = degree.get_mut(half_edge.origin) {
                *degree += 1;
            }
        }
        degree
            .iter()
            .filter_map(|(key, &facets)| {
                let vertex = brep.vertices[key];
                let outgoing = brep.half_edges.get(vertex.outgoing);
                let starts_here = outgoing.is_some_and(|half_edge| half_edge.origin == key);
                let in_cycle = if starts_here {
                    let ring = brep.half_edge(vertex.outgoing).ring();
                    (0..)
                        .zip(ring.take(facets as usize))
                        .last()
                        .map_or(0, |(at, _)| at + 1)
                } else {
                    0
                };
                (in_cycle != facets || facets == 0).then_some(Self {
                    vertex: key,
                    position: vertex.position,
                    facets,
                    in_cycle,
                })
            })
            .collect()
    }
}
