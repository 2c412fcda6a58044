use crate::topology::{Brep, HalfEdgeKey, VertexKey};
use glam::DVec3;

/// Two half-edges from one vertex to one other, each properly paired: two sheets that touch along
/// an edge and name the same ends.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the edge from {from} to {to} occurs more than once")]
pub struct RepeatedEdge {
    /// One of the half-edges.
    pub first: HalfEdgeKey,
    /// Another one with the same ends.
    pub second: HalfEdgeKey,
    /// Where they start.
    pub from: DVec3,
    /// Where they end.
    pub to: DVec3,
}

impl RepeatedEdge {
    /// All of them, once for each direction. Vertex links must be cycles.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let mut found = Vec::new();
        let mut targets: Vec<(VertexKey, HalfEdgeKey)> = Vec::new();
        for vertex in brep.vertices() {
            targets.clear();
            targets.extend(
                vertex
                    .ring()
                    .map(|half_edge| (half_edge.target().key(), half_edge.key())),
            );
            targets.sort_unstable();
            for pair in targets.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
                found.push(Self {
                    first: pair[0].1,
                    second: pair[1].1,
                    from: vertex.position(),
                    to: brep.vertex(pair[0].0).position(),
                });
            }
        }
        found
    }
}
