//! Boxes around halves of halves of a mesh's triangles.

use glam::DVec3;
use std::ops::Range;

/// Triangles in a leaf of the hierarchy, at most.
const LEAF: usize = 4;

/// A box along the axes: its lowest and its highest corner.
#[derive(Clone, Copy)]
pub(crate) struct Bounds(pub(crate) [DVec3; 2]);

impl Bounds {
    fn around(self, Self([low, high]): Self) -> Self {
        Self([self.0[0].min(low), self.0[1].max(high)])
    }

    fn overlaps(self, Self([low, high]): Self) -> bool {
        !(self.0[0].cmpgt(high) | low.cmpgt(self.0[1])).any()
    }
}

/// Boxes around halves of halves of all triangles: node n has the children 2n + 1 and 2n + 2,
/// and all leaves are on one level.
pub(crate) struct Hierarchy {
    nodes: Vec<(Bounds, Range<usize>)>,
    /// The triangles that the nodes' ranges mean, with their boxes.
    order: Vec<(usize, Bounds)>,
}

impl Hierarchy {
    pub(crate) fn of(positions: &[DVec3], triangles: &[[u32; 3]]) -> Self {
        let mut order: Vec<(usize, Bounds)> = (triangles.iter())
            .map(|corners| {
                let [a, b, c] = corners.map(|v| positions[v as usize]);
                Bounds([a.min(b).min(c), a.max(b).max(c)])
            })
            .enumerate()
            .collect();
        let mut nodes = Vec::new();
        let mut level = Vec::from([Range {
            start: 0,
            end: order.len(),
        }]);
        loop {
            let is_last = level.iter().all(|range| range.len() <= LEAF);
            let mut below = Vec::with_capacity(2 * level.len());
            for range in level {
                let part = &mut order[range.clone()];
                let none = Bounds([DVec3::INFINITY, DVec3::NEG_INFINITY]);
                let bounds = part.iter().fold(none, |all, (_, one)| all.around(*one));
                if !is_last {
                    let axis = (bounds.0[1] - bounds.0[0]).max_position();
                    let place = |(_, Bounds([low, high])): &(usize, Bounds)| low[axis] + high[axis];
                    let half = part.len() / 2;
                    part.select_nth_unstable_by(half, |one, other| {
                        place(one)
                            .total_cmp(&place(other))
                            .then(one.0.cmp(&other.0))
                    });
                    let middle = range.start + half;
                    below.extend([range.start..middle, middle..range.end]);
                }
                nodes.push((bounds, range));
            }
            if is_last {
                return Self { nodes, order };
            }
            level = below;
        }
    }

    /// The box of a node, its children, and if it has none the numbers of its triangles. The first
    /// node is 0.
    pub(crate) fn node(
        &self,
        at: usize,
    ) -> (Bounds, Option<[usize; 2]>, impl Iterator<Item = usize>) {
        let (bounds, range) = &self.nodes[at];
        let children = [2 * at + 1, 2 * at + 2];
        let has_children = children[0] < self.nodes.len();
        let of_leaf = if has_children { 0..0 } else { range.clone() };
        let triangles = self.order[of_leaf].iter().map(|(triangle, _)| *triangle);
        (*bounds, has_children.then_some(children), triangles)
    }

    /// Calls `visit` for each pair of triangles whose boxes overlap.
    pub(crate) fn for_each_overlap(&self, mut visit: impl FnMut(usize, usize)) {
        let mut open = vec![[0, 0]];
        while let Some([m, n]) = open.pop() {
            let [(one, of_one), (other, of_other)] = [m, n].map(|node| &self.nodes[node]);
            if !one.overlaps(*other) {
                continue;
            }
            let [[a, b], [c, d]] = [m, n].map(|node| [2 * node + 1, 2 * node + 2]);
            if a < self.nodes.len() {
                open.extend([[a, c], [a, d], [b, d]]);
                if m != n {
                    open.push([b, c]);
                }
                continue;
            }
            for (at, (s, low)) in (of_one.start..).zip(&self.order[of_one.clone()]) {
                let from = if m == n { at + 1 } else { of_other.start };
                for (t, high) in &self.order[from..of_other.end] {
                    if low.overlaps(*high) {
                        visit(*s, *t);
                    }
                }
            }
        }
    }
}
