//! How far a bounded set extends in a direction: best-first branch and bound.

use super::cell::Cell;
use crate::{LocalizeScratch, Ternary};
use glam::DVec3;
use std::collections::BinaryHeap;

/// A cell in the queue: farthest first, of equally far ones the smallest, so that a flat side
/// is reached by one descent.
struct Queued {
    farthest: f64,
    level: u32,
    cell: Cell,
}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_distance = self.farthest.total_cmp(&other.farthest);
        by_distance.then(self.level.cmp(&other.level))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Queued {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Queued {}

/// An upper bound of d · x over the set described in a box, −∞ if the set is proved empty.
///
/// Ends at a cell that is undecided and narrower than `precision` times the box, or when more
/// than `allowed` multiplications were spent.
pub(super) fn farthest(
    root: &Cell,
    errors: &[f64],
    direction: DVec3,
    precision: f64,
    allowed: u64,
) -> f64 {
    let d = direction;
    let reach = |cell: &Cell| (d * cell.low).max(d * cell.high).element_sum();
    let widest = precision * (root.high - root.low);
    let narrow = (d.abs() * widest).element_sum();
    // Where few halvings are affordable, cells that are flat in the direction decide more.
    let is_dear = allowed < 200 * root.halving_work();
    let weights = DVec3::select(d.cmpne(DVec3::ZERO), DVec3::splat(4.0), DVec3::ONE);
    let weights = if is_dear { weights } else { DVec3::ONE };
    let mut work = 0;
    let mut scratch = LocalizeScratch::default();
    let mut queue = BinaryHeap::new();
    queue.push(Queued {
        farthest: reach(root),
        level: 0,
        cell: root.clone(),
    });
    while let Some(top) = queue.pop() {
        let mut cell = top.cell;
        match cell.classify(errors, &mut scratch) {
            Ternary::Out => continue,
            Ternary::Unknown => {}
            Ternary::In => return top.farthest,
        }
        let sides = cell.high - cell.low;
        let is_narrow = (d.abs() * sides).element_sum() <= narrow;
        if is_narrow && sides.cmple(8.0 * widest).all() || work > allowed {
            return top.farthest;
        }
        let weighted = sides * weights;
        let longer = |best: usize, axis: usize| {
            if weighted[axis] > weighted[best] {
                axis
            } else {
                best
            }
        };
        let axis = [1, 2].into_iter().fold(0, longer);
        for half in cell.halves(axis, &mut work) {
            queue.push(Queued {
                farthest: reach(&half),
                level: top.level + 1,
                cell: half,
            });
        }
    }
    f64::NEG_INFINITY
}
