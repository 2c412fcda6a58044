//! Flipping the long edge of facets without area.

use crate::topology::{Brep, FacetKey, FacetView, HalfEdgeKey, HalfEdgeView};
use glam::DVec3;
use robust::{Coord, orient2d};

/// Removes facets no higher than this over their longest edge – of none at all, if their corners
/// are three different points of one line – by giving the space across that edge the middle corner;
/// returns how many, and how many flat ones stay.
pub(super) fn flip_flat_facets(brep: &mut Brep, height: f64) -> (usize, usize) {
    let mut pending: Vec<FacetKey> = brep
        .facets()
        .filter(|facet| is_flat(facet.positions(), height))
        .map(FacetView::key)
        .collect();
    let mut flipped = 0;
    loop {
        let before = flipped;
        pending.retain(|&key| {
            // Another flip may have changed it.
            if !is_flat(brep.facet(key).positions(), height) {
                return false;
            }
            let Some(long) = long_edge(brep, key) else {
                return true;
            };
            let possible = may_flip(brep.half_edge(long), height);
            if possible {
                flip(brep, long);
                flipped += 1;
            }
            !possible
        });
        // Each flip leaves one flat facet less, so this ends.
        if flipped == before {
            return (flipped, pending.len());
        }
    }
}

/// The edge of a flat facet whose opposite corner lies strictly between its ends.
fn long_edge(brep: &Brep, facet: FacetKey) -> Option<HalfEdgeKey> {
    brep.facet(facet)
        .half_edges()
        .into_iter()
        .find(|half_edge| {
            let middle = half_edge.prev().origin().position();
            let to_ends = [half_edge.origin(), half_edge.target()].map(|v| v.position() - middle);
            to_ends[0].dot(to_ends[1]) < 0.0
        })
        .map(HalfEdgeView::key)
}

fn may_flip(long: HalfEdgeView<'_>, height: f64) -> bool {
    let [a, b] = [long.origin(), long.target()];
    let middle = long.prev().origin();
    let apex = long.twin().prev().origin();
    let degrees_stay = [a, b].iter().all(|vertex| vertex.ring().nth(3).is_some());
    let joined = middle
        .ring()
        .any(|spoke| spoke.target().key() == apex.key());
    let flat_after = [a, b]
        .iter()
        .any(|end| is_flat([middle.position(), end.position(), apex.position()], height));
    degrees_stay && middle.key() != apex.key() && !joined && !flat_after
}

/// Replaces the edge a–b by middle–apex; both new facets belong to the surface of the old facet
/// that has an area.
///
/// ```text
///        apex                 apex
///       ╱     ╲              ╱ | ╲
///      a ───── b     →      a  |  b
///       ╲     ╱              ╲ | ╱
///       middle               middle
/// ```
fn flip(brep: &mut Brep, long: HalfEdgeKey) {
    let half_edge = brep.half_edge(long);
    let twin = half_edge.twin();
    let [a, b] = [half_edge, twin].map(|h| h.origin().key());
    let [middle, apex] = [half_edge, twin].map(|h| h.prev().origin().key());
    let [from_b, to_a] = [half_edge.next().key(), half_edge.prev().key()];
    let [from_a, to_b] = [twin.next().key(), twin.prev().key()];
    let [flat, full] = [half_edge, twin].map(|h| h.facet().key());
    let twin = twin.key();

    let full_facet = brep.facets[full];
    // (middle, a, apex) and (apex, b, middle); `long` and its twin turn into the new diagonal.
    let rings = [(flat, [to_a, from_a, long]), (full, [to_b, from_b, twin])];
    for (facet, ring) in rings {
        brep.facets[facet] = full_facet;
        brep.facets[facet].half_edge = ring[0];
        for at in 0..3 {
            brep.half_edges[ring[at]].next = ring[(at + 1) % 3];
            brep.half_edges[ring[at]].facet = facet;
        }
    }
    brep.half_edges[long].origin = apex;
    brep.half_edges[twin].origin = middle;
    brep.vertices[a].outgoing = from_a;
    brep.vertices[b].outgoing = from_b;
}

/// Whether a triangle is no higher than this over its longest side.
fn is_flat(corners: [DVec3; 3], height: f64) -> bool {
    if height == 0.0 {
        return are_collinear(corners);
    }
    let [a, b, c] = corners;
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    (b - a).cross(c - a).length() <= height * longest
}

/// Whether three points lie on one line, exactly: their projections along all axes do.
fn are_collinear([a, b, c]: [DVec3; 3]) -> bool {
    let projections: [fn(DVec3) -> Coord<f64>; 3] = [
        |p| Coord { x: p.x, y: p.y },
        |p| Coord { x: p.y, y: p.z },
        |p| Coord { x: p.z, y: p.x },
    ];
    projections
        .into_iter()
        .all(|flat| orient2d(flat(a), flat(b), flat(c)) == 0.0)
}
