//! Collapsing edges whose ends are one point.

use crate::topology::{Brep, HalfEdgeKey, HalfEdgeView, VertexKey};

/// What was collapsed.
pub(super) struct Collapsed {
    pub(super) count: usize,
    /// Length of the longest one.
    pub(super) longest: f64,
    /// Edges that must stay.
    pub(super) remaining: usize,
}

/// Collapses edges no longer than `reach`.
pub(super) fn collapse_short_edges(brep: &mut Brep, reach: f64) -> Collapsed {
    let length = |brep: &Brep, key: HalfEdgeKey| {
        let half_edge = brep.half_edge(key);
        let [from, to] = [half_edge.origin(), half_edge.target()];
        from.position().distance(to.position())
    };
    let zero = |brep: &Brep, key: HalfEdgeKey| length(brep, key) <= reach;
    // Both directions: of a collapsed triangle one half-edge of each remaining edge survives.
    let mut pending: Vec<HalfEdgeKey> = brep
        .half_edges
        .keys()
        .filter(|&key| zero(brep, key))
        .collect();
    let mut collapsed = 0;
    let mut longest = 0.0_f64;
    let mut neighbours = Vec::new();
    loop {
        let before = collapsed;
        // A collapse elsewhere may have satisfied the link condition: try again what failed.
        pending.retain(|&key| {
            if !brep.half_edges.contains_key(key) {
                return false;
            }
            let possible = link_condition(brep, key, &mut neighbours);
            if possible {
                longest = longest.max(length(brep, key));
                collapse(brep, key);
                collapsed += 1;
            }
            !possible
        });
        if collapsed == before {
            return Collapsed {
                count: collapsed,
                longest,
                remaining: pending.len() / 2,
            };
        }
    }
}

/// Whether collapsing keeps the surface what it is: the ends have no common neighbours but the
/// two opposite corners, and the shell is no tetrahedron. Source: Dey, Edelsbrunner, Guha,
/// Nekhayev, *Topology preserving edge contraction*, 1999.
fn link_condition(brep: &Brep, key: HalfEdgeKey, neighbours: &mut Vec<VertexKey>) -> bool {
    let half_edge = brep.half_edge(key);
    let [left, right] = [half_edge, half_edge.twin()].map(|side| side.prev().origin());
    neighbours.clear();
    neighbours.extend(half_edge.ring().map(|spoke| spoke.target().key()));
    neighbours.sort_unstable();
    let is_common = |vertex: VertexKey| neighbours.binary_search(&vertex).is_ok();
    let common = half_edge
        .twin()
        .ring()
        .filter(|spoke| is_common(spoke.target().key()))
        .count();
    let degree_over_three = left.ring().nth(3).is_some();
    left.key() != right.key() && common == 2 && degree_over_three
}

/// Merges the half-edge's origin into its target.
///
/// ```text
///        left                      left
///       ╱  |  ╲                     |
///      ╱   |   ╲         →          |
///   from ──h──> to                  to
///      ╲   |   ╱                    |
///        right                     right
/// ```
fn collapse(brep: &mut Brep, key: HalfEdgeKey) {
    let half_edge = brep.half_edge(key);
    let (from, to) = (half_edge.origin().key(), half_edge.target().key());
    let spokes: Vec<HalfEdgeKey> = half_edge.ring().map(HalfEdgeView::key).collect();
    let sides = [half_edge, half_edge.twin()];
    let facets = sides.map(|side| side.facet().key());
    let removed = sides.map(|side| [side, side.next(), side.prev()].map(HalfEdgeView::key));
    let seams = sides.map(|side| [side.next().twin().key(), side.prev().twin().key()]);
    for spoke in spokes {
        brep.half_edges[spoke].origin = to;
    }
    for [first, second] in seams {
        brep.half_edges[first].twin = second;
        brep.half_edges[second].twin = first;
        for half_edge in [first, second] {
            let origin = brep.half_edges[half_edge].origin;
            brep.vertices[origin].outgoing = half_edge;
        }
    }
    for key in removed.into_iter().flatten() {
        brep.half_edges.remove(key);
    }
    for key in facets {
        brep.facets.remove(key);
    }
    brep.vertices.remove(from);
}
