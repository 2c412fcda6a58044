//! Knots: places of no size in which the surface is tangled.
//!
//! Planes that meet in one point but for rounding, as those around a vertex of an imported mesh,
//! are arranged exactly as they are rounded. The arrangement may have handles and bubbles 10⁻¹⁴ of
//! the size wide, which no collapse of an edge removes, since it would change topology. What
//! enters such a place is known, and one loop of facets around it says that a disc was meant.

use super::shortest;
use crate::topology::{Brep, FacetKey, HalfEdgeKey, HalfEdgeView, VertexKey, VertexView};
use crate::validate::{Defects, Valid};
use slotmap::SecondaryMap;
use std::collections::BTreeSet;

/// How far a knot may extend, in lengths of edges without length.
const WIDEST: f64 = 64.0;

/// Replaces what lies within a point but for rounding, and is entered by the surface through one
/// loop, by that point; what lies there alone is removed. Returns how many there were.
///
/// Two vertices are in one knot when a chain of edges without length joins them, in the sense of
/// [`remove_degenerate`](super::remove_degenerate), which is to be called before. Where several
/// sheets enter, surfaces touch, and everything stays. Cost: linear.
///
/// # Errors
/// Never for meshes within the guarantees; the result is validated again all the same.
pub fn contract_knots(brep: Valid<Brep>) -> Result<(Valid<Brep>, usize), Defects> {
    let mut brep = brep.into_inner();
    let reach = shortest(&brep);
    let mut contracted = 0;
    for knot in find(&brep, reach) {
        let Some(plan) = Plan::of(&brep, &knot) else {
            continue;
        };
        plan.carry_out(&mut brep);
        contracted += 1;
    }
    if contracted == 0 {
        return Ok((Valid::untouched(brep), 0));
    }
    Ok((brep.validate()?, contracted))
}

fn is_short(half_edge: HalfEdgeView<'_>, reach: f64) -> bool {
    let [from, to] = [half_edge.origin(), half_edge.target()].map(VertexView::position);
    from.distance(to) <= reach
}

/// The vertices that chains of short edges join, if they are near each other.
fn find(brep: &Brep, reach: f64) -> Vec<BTreeSet<VertexKey>> {
    let mut knots = Vec::new();
    let mut done: SecondaryMap<VertexKey, ()> = SecondaryMap::new();
    for seed in brep.half_edges().filter(|h| is_short(*h, reach)) {
        let start = seed.origin().key();
        if done.contains_key(start) {
            continue;
        }
        let mut knot = BTreeSet::new();
        let mut waiting = vec![start];
        while let Some(key) = waiting.pop() {
            if done.insert(key, ()).is_some() {
                continue;
            }
            knot.insert(key);
            let spokes = brep.vertex(key).ring().filter(|h| is_short(*h, reach));
            waiting.extend(spokes.map(|spoke| spoke.target().key()));
        }
        let middle = seed.origin().position();
        let is_small = |key: &VertexKey| {
            let position = brep.vertex(*key).position();
            position.distance(middle) <= WIDEST * reach
        };
        if knot.iter().all(is_small) {
            knots.push(knot);
        }
    }
    knots
}

/// What becomes of a knot.
struct Plan {
    /// Facets that go: those with two corners or three in the knot.
    removed: BTreeSet<FacetKey>,
    /// Vertices that go.
    vertices: Vec<VertexKey>,
    /// The vertex that stays and the half-edges that leave it, in order around it; none for a
    /// knot that nothing enters.
    fan: Option<(VertexKey, Vec<HalfEdgeKey>)>,
}

impl Plan {
    /// `None` if the knot has to stay.
    fn of(brep: &Brep, knot: &BTreeSet<VertexKey>) -> Option<Self> {
        let inside = |facet: FacetKey| {
            let corners = brep.facet(facet).vertices();
            corners.iter().filter(|v| knot.contains(&v.key())).count()
        };
        let around: BTreeSet<FacetKey> = knot
            .iter()
            .flat_map(|key| brep.vertex(*key).ring().map(|spoke| spoke.facet().key()))
            .collect();
        let (mut removed, mut kept): (BTreeSet<FacetKey>, BTreeSet<FacetKey>) =
            around.into_iter().partition(|facet| inside(*facet) > 1);
        // A vertex outside whose facets would all go is the end of something long.
        let outside = removed
            .iter()
            .flat_map(|facet| brep.facet(*facet).vertices());
        let mut outside = outside.filter(|v| !knot.contains(&v.key()));
        let is_lost = |v: VertexView<'_>| v.ring().all(|h| removed.contains(&h.facet().key()));
        if outside.any(is_lost) {
            return None;
        }
        let mut vertices: Vec<VertexKey> = knot.iter().copied().collect();
        loop {
            let Some(&first) = kept.first() else {
                let fan = None;
                return Some(Self {
                    removed,
                    vertices,
                    fan,
                });
            };
            let spokes = walk(brep, knot, first, &removed)?;
            if spokes.len() != kept.len() {
                return None;
            }
            if let Some((tip, facets)) = flap(brep, &spokes, &removed) {
                vertices.push(tip);
                for facet in facets {
                    kept.remove(&facet);
                    removed.insert(facet);
                }
                continue;
            }
            let target = |spoke: &HalfEdgeKey| brep.half_edge(*spoke).target().key();
            let targets: BTreeSet<VertexKey> = spokes.iter().map(target).collect();
            if targets.len() != spokes.len() || spokes.len() < 3 {
                return None;
            }
            let stays = brep.half_edge(*spokes.first()?).origin().key();
            vertices.retain(|key| *key != stays);
            return Some(Self {
                removed,
                vertices,
                fan: Some((stays, spokes)),
            });
        }
    }

    fn carry_out(&self, brep: &mut Brep) {
        if let Some((center, spokes)) = &self.fan {
            let following = spokes.iter().cycle().skip(1);
            for (&spoke, &next) in spokes.iter().zip(following) {
                let entering = brep.half_edge(spoke).prev();
                let (entering, far) = (entering.key(), entering.origin().key());
                brep.half_edges[spoke].origin = *center;
                brep.half_edges[entering].twin = next;
                brep.half_edges[next].twin = entering;
                brep.vertices[far].outgoing = entering;
                brep.vertices[*center].outgoing = spoke;
            }
        }
        for &facet in &self.removed {
            let half_edges = brep.facet(facet).half_edges().map(HalfEdgeView::key);
            for key in half_edges {
                brep.half_edges.remove(key);
            }
            brep.facets.remove(facet);
        }
        for &key in &self.vertices {
            brep.vertices.remove(key);
        }
    }
}

/// The half-edges that leave a knot into the facets around it, in order, from one facet on.
fn walk(
    brep: &Brep,
    knot: &BTreeSet<VertexKey>,
    first: FacetKey,
    removed: &BTreeSet<FacetKey>,
) -> Option<Vec<HalfEdgeKey>> {
    let all = brep.facet(first).half_edges();
    let start = all.into_iter().find(|h| knot.contains(&h.origin().key()))?;
    let mut spokes = Vec::new();
    let mut spoke = start;
    loop {
        spokes.push(spoke.key());
        // Over what goes: around the far end of the entering half-edge.
        let mut crossing = spoke.prev().twin();
        while removed.contains(&crossing.facet().key()) {
            crossing = crossing.next().twin();
        }
        spoke = crossing;
        if spoke.key() == start.key() {
            return Some(spokes);
        }
    }
}

/// Two facets that would lie on each other once the knot is a point, and their tip.
///
/// ```text
///   tip ──── x
///     ╲╲   ╱        the facets (knot, x, tip) and (knot, tip, x), and no others at the tip
///       knot
/// ```
fn flap(
    brep: &Brep,
    spokes: &[HalfEdgeKey],
    removed: &BTreeSet<FacetKey>,
) -> Option<(VertexKey, [FacetKey; 2])> {
    let following = spokes.iter().cycle().skip(1);
    spokes.iter().zip(following).find_map(|(&one, &other)| {
        let [one, other] = [one, other].map(|spoke| brep.half_edge(spoke));
        let tip = other.target();
        let facets = [one, other].map(|spoke| spoke.facet().key());
        let mut ring = tip.ring().map(|spoke| spoke.facet().key());
        let is_flap = one.target().key() == other.prev().origin().key()
            && facets[0] != facets[1]
            && ring.all(|facet| removed.contains(&facet) || facets.contains(&facet));
        is_flap.then(|| (tip.key(), facets))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, together, torus};
    use crate::{Properties, Shells, stitch};
    use glam::DVec3;
    use subdiv::{Fragments, Triangle};

    fn contracted(fragments: &Fragments) -> (Valid<Brep>, usize) {
        let brep = stitch(fragments).expect("closed").validate();
        contract_knots(brep.expect("valid")).expect("stays valid")
    }

    /// A facet of `big` is cut out, and what is left of a torus without a facet, no larger than a
    /// point, put in its place.
    fn with_a_handle(big: &Fragments) -> Fragments {
        let mut all = together(&[big.clone(), torus(2.0, 1.0, 8, 6)]);
        let count = big.positions.len();
        for position in &mut all.positions[count..] {
            *position = big.positions[0] + *position * 1e-15;
        }
        let outer = big.triangles.len() - 1;
        let inner = all.triangles.len() - 1;
        let (Triangle { vertices: p, .. }, Triangle { vertices: q, .. }) =
            (all.triangles[outer], all.triangles[inner]);
        let sample = all.triangles[0];
        all.triangles.remove(inner);
        all.triangles.remove(outer);
        // A tube between the two holes, which turn opposite ways.
        let q = [q[0], q[2], q[1]];
        for i in 0..3 {
            let j = (i + 1) % 3;
            for vertices in [[p[i], p[j], q[j]], [p[i], q[j], q[i]]] {
                all.triangles.push(Triangle { vertices, ..sample });
            }
        }
        all
    }

    #[test]
    fn a_handle_of_no_size_goes() {
        let tangled = with_a_handle(&cube([0.0; 3], 1.0));
        let before = stitch(&tangled).expect("closed").validate().expect("valid");
        assert_eq!(Shells::of(&before).genus(), 1);
        let volume = Properties::of(&before).volume;
        let (brep, count) = contracted(&tangled);
        assert_eq!((count, Shells::of(&brep).genus()), (1, 0));
        assert!((Properties::of(&brep).volume - volume).abs() < 1e-12);
    }

    #[test]
    fn a_speck_goes() {
        let mut speck = cube([0.0; 3], 1.0);
        for position in &mut speck.positions {
            *position = DVec3::X + *position * 1e-15;
        }
        let (brep, count) = contracted(&together(&[cube([0.0; 3], 1.0), speck]));
        assert_eq!((count, brep.facet_count()), (1, 12));
    }

    /// A torus pulled together around its tube touches itself: two sheets enter that point.
    #[test]
    fn where_surfaces_touch_everything_stays() {
        let mut pinched = torus(2.0, 1.0, 6, 3);
        for at in 0..3 {
            pinched.positions[at] = DVec3::X;
        }
        let (brep, count) = contracted(&pinched);
        assert_eq!((count, Shells::of(&brep).genus()), (0, 1));
    }
}
