//! Proofs that a set described by polynomials is bounded, and tight boxes around such sets.
//!
//! Space outside the cube [−1, 1]³ of a frame is six projective boxes: with x = ±1/t, y = u/t,
//! z = v/t and so on, u and v in [−1, 1] and t in [0, 1], where t = 0 is the plane at infinity.
//! The set is bounded if the boxes that touch t = 0 can be proved to miss it; Bernstein
//! coefficients bound the polynomials and the formula is evaluated in three values. The box is
//! then found by branch and bound in each direction.

mod cell;
mod tensor;

pub(crate) use cell::Problem;

use crate::matrix::{Bounded, IDENTITY};
use crate::{Aabb, Error, LocalizeScratch, Polynomial, Ternary};
use cell::Cell;
use glam::DVec3;
use std::collections::BinaryHeap;
use tensor::Role;

/// Multiplications that one proof may cost: about half a second.
const PROOF_WORK: u64 = 300_000_000;

/// Multiplications that the search for a box's extent in one direction may cost.
const SEARCH_WORK: u64 = 20_000_000;

/// Solids farther away than this many times their frame's size count as unbounded.
const FARTHEST: f64 = 1e9;

/// Width of the cells in which a direction's search ends, in sizes of the box, while the box is
/// still shrinking and at last.
const COARSE: f64 = 1.0 / 32.0;

/// See [`COARSE`].
const FINE: f64 = 1.0 / 512.0;

/// A bounded set, with its description over the box that it was found in.
pub(crate) struct BoundedSet {
    /// Centre and half sides of the box.
    center: DVec3,
    half: DVec3,
    root: Option<Cell>,
    errors: Vec<f64>,
}

/// Gives the problem in the coordinates of a frame, given by the map from the frame to them.
pub(crate) trait Framed {
    fn in_frame(&self, frame: &Bounded) -> Result<Problem, Error>;
}

/// Tries to prove that a set is bounded; `Ok(None)` when it is not or no proof was found.
pub(crate) fn prove(set: &impl Framed) -> Result<Option<BoundedSet>, Error> {
    let plain = set.in_frame(&Bounded::exact(IDENTITY))?;
    let scale = plain
        .polynomials
        .iter()
        .map(natural_scale)
        .fold(0.0, f64::max);
    if !scale.is_normal() {
        return Ok(None);
    }
    let problem = set.in_frame(&frame(DVec3::ZERO, DVec3::splat(scale)))?;
    let Some(reach) = reach(&problem) else {
        return Ok(None);
    };
    let mut half = DVec3::splat(reach * scale);
    let mut center = DVec3::ZERO;
    let mut found = BoundedSet::over(set, center, half)?;
    // Each pass shrinks by up to 1/COARSE; one that shrinks little is the last.
    for _ in 0..40 {
        let Some(inner) = found.extent(COARSE) else {
            found.root = None;
            return Ok(Some(found));
        };
        let sides = (inner.max - inner.min).max(DVec3::splat(1e-12 * reach * scale));
        let shrinks = sides.cmplt(half * 1.2).any();
        center = 0.5 * (inner.min + inner.max);
        half = 0.5 * sides * (1.0 + 1e-9) + center.abs() * f64::EPSILON;
        found = BoundedSet::over(set, center, half)?;
        if !shrinks {
            break;
        }
    }
    Ok(Some(found))
}

/// Distance within which a polynomial's leading terms do not prevail yet (Fujiwara's bound).
fn natural_scale(p: &Polynomial) -> f64 {
    let n = p.degree();
    let mut sizes = vec![0.0_f64; n + 1];
    for (e, c) in p.terms() {
        sizes[e[3]] = sizes[e[3]].max(c.abs());
    }
    let leading = sizes[0];
    let ratios = (1..=n).map(|l| (sizes[l] / leading).powf(1.0 / l as f64));
    ratios.fold(0.0, f64::max)
}

/// The map from [−1, 1]³ to a box.
fn frame(center: DVec3, half: DVec3) -> Bounded {
    let mut rows = IDENTITY;
    for (axis, row) in rows.iter_mut().take(3).enumerate() {
        row[axis] = half[axis];
    }
    rows[3][..3].copy_from_slice(&center.to_array());
    Bounded::exact(rows)
}

/// Half the side of a cube that contains the set, in frame sizes, if one is found.
fn reach(problem: &Problem) -> Option<f64> {
    let mut work = 0;
    let mut scratch = LocalizeScratch::default();
    let mut cells = Vec::new();
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut chart = [
                Role::Symmetric(0),
                Role::Symmetric(0),
                Role::Symmetric(0),
                Role::Unit(2),
            ];
            chart[axis] = Role::Fixed(sign);
            chart[(axis + 1) % 3] = Role::Symmetric(1);
            cells.push(Cell::root(problem, chart, &mut work));
        }
    }
    let mut nearest: f64 = 1.0;
    while let Some(mut cell) = cells.pop() {
        let class = cell.classify(&problem.errors, &mut scratch);
        if class == Ternary::Out {
            continue;
        }
        if cell.low.z > 0.0 {
            nearest = nearest.min(cell.low.z);
            continue;
        }
        if class == Ternary::In || cell.high.z * FARTHEST < 1.0 || work > PROOF_WORK {
            return None;
        }
        let axis = cell.liveliest_axis();
        // Cells this narrow are beyond rounding: what is undecided there stays so.
        if cell.high[axis] - cell.low[axis] < 1e-9 {
            return None;
        }
        cells.extend(cell.halves(axis, &mut work));
    }
    Some(1.0 / nearest)
}

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

impl BoundedSet {
    /// The set, known to lie in a box.
    fn over(set: &impl Framed, center: DVec3, half: DVec3) -> Result<Self, Error> {
        let problem = set.in_frame(&frame(center, half))?;
        let inner = [
            Role::Symmetric(0),
            Role::Symmetric(1),
            Role::Symmetric(2),
            Role::Fixed(1.0),
        ];
        Ok(Self {
            center,
            half,
            root: Some(Cell::root(&problem, inner, &mut 0)),
            errors: problem.errors,
        })
    }

    /// The least upper bound found of d · x over the set; −∞ if the set is proved empty.
    ///
    /// Never too small; too large by a thousandth of the set's size, or more if the search
    /// becomes too expensive.
    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        self.search(direction, FINE)
    }

    /// The set's bounding box to a relative precision, if it is not proved empty.
    fn extent(&self, precision: f64) -> Option<Aabb> {
        let mut extent = Aabb::EVERYWHERE;
        for (axis, direction) in DVec3::AXES.into_iter().enumerate() {
            extent.max[axis] = self.search(direction, precision);
            extent.min[axis] = -self.search(-direction, precision);
        }
        (!extent.is_empty()).then_some(extent)
    }

    fn search(&self, direction: DVec3, precision: f64) -> f64 {
        let Some(root) = &self.root else {
            return f64::NEG_INFINITY;
        };
        let d = direction * self.half;
        let farthest = |cell: &Cell| (d * cell.low).max(d * cell.high).element_sum();
        let narrow = precision * 2.0 * d.abs().element_sum();
        let mut work = 0;
        let mut scratch = LocalizeScratch::default();
        let mut queue = BinaryHeap::new();
        queue.push(Queued {
            farthest: farthest(root),
            level: 0,
            cell: root.clone(),
        });
        while let Some(Queued {
            farthest: bound,
            level,
            mut cell,
        }) = queue.pop()
        {
            match cell.classify(&self.errors, &mut scratch) {
                Ternary::Out => continue,
                Ternary::Unknown => {}
                Ternary::In => return direction.dot(self.center) + bound,
            }
            let sides = cell.high - cell.low;
            if (d.abs() * sides).element_sum() <= narrow && sides.max_element() <= 16.0 * precision
                || work > SEARCH_WORK
            {
                return direction.dot(self.center) + bound;
            }
            let longest = |best: usize, axis: usize| {
                if sides[axis] > sides[best] {
                    axis
                } else {
                    best
                }
            };
            let axis = [1, 2].into_iter().fold(0, longest);
            for half in cell.halves(axis, &mut work) {
                queue.push(Queued {
                    farthest: farthest(&half),
                    level: level + 1,
                    cell: half,
                });
            }
        }
        f64::NEG_INFINITY
    }
}
