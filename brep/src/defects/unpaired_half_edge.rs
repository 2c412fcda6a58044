use crate::topology::{Brep, HalfEdgeKey};
use glam::DVec3;

/// A half-edge whose twin is missing, or is not the same edge in the other direction.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("the edge from {from} to {to} has no partner in the other direction")]
pub struct UnpairedHalfEdge {
    /// The half-edge.
    pub half_edge: HalfEdgeKey,
    /// Where it starts.
    pub from: DVec3,
    /// Where it ends; not a number when nothing follows it.
    pub to: DVec3,
}

impl UnpairedHalfEdge {
    /// All of them.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let position = |vertex| brep.vertices.get(vertex).map_or(DVec3::NAN, |v| v.position);
        brep.half_edges
            .iter()
            .filter_map(|(key, half_edge)| {
                let next = brep.half_edges.get(half_edge.next);
                let twin = brep.half_edges.get(half_edge.twin);
                let after_twin = twin.and_then(|twin| brep.half_edges.get(twin.next));
                let paired = half_edge.twin != key
                    && twin.is_some_and(|twin| twin.twin == key)
                    && twin.map(|twin| twin.origin) == next.map(|next| next.origin)
                    && after_twin.map(|after| after.origin) == Some(half_edge.origin);
                (!paired).then(|| Self {
                    half_edge: key,
                    from: position(half_edge.origin),
                    to: next.map_or(DVec3::NAN, |next| position(next.origin)),
                })
            })
            .collect()
    }
}
