//! Polygons with holes, given as paths that are filled by the even-odd rule.

use super::chain::{complement, doubled_area, formula, turn};
use super::{Outline, Part, Region, partition};
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::float::simplify::SimplifyShape;
use std::collections::BTreeMap;

/// Outlines with more edges get a formula that is local.
const MOST_EDGES: usize = 60;

/// A vertex of the resolved outline this close to a given one, in sizes of the polygon, is it.
const SAME: f64 = 1e-12;

impl Region {
    /// The disc about the origin.
    pub(super) fn disc(radius: f64) -> Self {
        Self {
            parts: vec![Part::Side(super::Curve::disc(radius))],
            outline: Outline::Circle(radius),
        }
    }

    /// The points that the closed paths enclose an odd number of times; `None` if there are none.
    ///
    /// Paths may cross and touch themselves and each other. Crossings are new vertices; all
    /// other edges keep their lines exactly.
    pub(super) fn polygon(paths: &[Vec<DVec2>]) -> Option<Self> {
        let given: Vec<DVec2> = paths.iter().flatten().copied().collect();
        let source: Vec<Vec<[f64; 2]>> = paths
            .iter()
            .map(|path| path.iter().map(|p| [p.x, p.y]).collect())
            .collect();
        let shapes = source.simplify_shape_as::<i64>(FillRule::EvenOdd);
        let known = Known::new(&given);
        let mut parts = vec![Part::Open { union: true }];
        let mut corners = Vec::new();
        let mut loops: Vec<Vec<DVec2>> = Vec::new();
        let mut convex = shapes.len() == 1;
        for shape in &shapes {
            // A contour that touches itself is several loops; filled ones turn counter-clockwise.
            let (mut filled, mut holes, mut islands) = (Vec::new(), Vec::new(), Vec::new());
            for (at, contour) in shape.iter().enumerate() {
                let resolved = contour
                    .iter()
                    .map(|&[x, y]| known.nearest(DVec2::new(x, y)));
                for mut simple in split_at_touching(resolved) {
                    drop_collinear(&mut simple);
                    if simple.len() < 3 {
                        continue;
                    }
                    let list = if doubled_area(&simple) < 0.0 {
                        simple.reverse();
                        &mut holes
                    } else if at == 0 {
                        &mut filled
                    } else {
                        &mut islands
                    };
                    list.push(simple);
                }
            }
            convex &= filled.len() == 1 && holes.is_empty() && islands.is_empty();
            parts.push(Part::Open { union: false });
            parts.push(Part::Open { union: true });
            for outline in &filled {
                convex &= formula(outline, &mut parts);
            }
            parts.push(Part::Close);
            for hole in &holes {
                let start = parts.len();
                formula(hole, &mut parts);
                complement(parts.get_mut(start..).unwrap_or_default());
            }
            parts.push(Part::Close);
            for island in &islands {
                formula(island, &mut parts);
            }
            corners.extend(filled.iter().chain(&islands).flatten().copied());
            for hole in &mut holes {
                hole.reverse();
            }
            loops.extend(filled.into_iter().chain(islands).chain(holes));
        }
        parts.push(Part::Close);
        if loops.iter().map(Vec::len).sum::<usize>() > MOST_EDGES {
            parts = vec![Part::Open { union: true }];
            partition::formula(&loops, &mut parts);
            parts.push(Part::Close);
        }
        (!corners.is_empty()).then_some(Self {
            parts,
            outline: Outline::Corners {
                at: corners,
                loops,
                convex,
            },
        })
    }
}

/// The vertices that were given, by x.
pub(super) struct Known {
    sorted: Vec<DVec2>,
    near: f64,
}

impl Known {
    pub(super) fn new(points: &[DVec2]) -> Self {
        let mut sorted = points.to_vec();
        sorted.sort_by(|a, b| a.x.total_cmp(&b.x));
        let size = points
            .iter()
            .fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
        Self {
            sorted,
            near: SAME * size,
        }
    }

    /// The given vertex that a resolved one stands for, or itself.
    pub(super) fn nearest(&self, point: DVec2) -> DVec2 {
        let from = self.sorted.partition_point(|p| p.x < point.x - self.near);
        let close = self.sorted.iter().skip(from);
        let close = close.take_while(|p| p.x <= point.x + self.near);
        let best = close.min_by(|a, b| {
            a.distance_squared(point)
                .total_cmp(&b.distance_squared(point))
        });
        match best {
            Some(best) if best.distance(point) <= self.near => *best,
            _ => point,
        }
    }
}

/// Splits a loop that passes through a point twice into loops that do not.
fn split_at_touching(loop_: impl Iterator<Item = DVec2>) -> Vec<Vec<DVec2>> {
    let mut simple = Vec::new();
    let mut chain: Vec<DVec2> = Vec::new();
    let mut place: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    // Adding 0 turns −0 into 0.
    let key = |p: DVec2| [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()];
    for point in loop_ {
        if let Some(&at) = place.get(&key(point)) {
            let closed = chain.split_off(at);
            for p in &closed {
                place.remove(&key(*p));
            }
            simple.push(closed);
        }
        place.insert(key(point), chain.len());
        chain.push(point);
    }
    simple.push(chain);
    simple
}

/// Removes vertices in the line of their neighbours, spikes among them.
fn drop_collinear(loop_: &mut Vec<DVec2>) {
    let mut kept: Vec<DVec2> = Vec::with_capacity(loop_.len());
    for &point in loop_.iter() {
        while let [.., a, b] = kept[..]
            && turn(a, b, point) == 0.0
        {
            kept.pop();
        }
        kept.push(point);
    }
    // The ends meet.
    while let [first, second, .., before, last] = kept[..] {
        if turn(before, last, first) == 0.0 {
            kept.pop();
        } else if turn(last, first, second) == 0.0 {
            kept.remove(0);
        } else {
            break;
        }
    }
    *loop_ = kept;
}
