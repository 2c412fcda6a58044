//! Proofs that a set described by polynomials is bounded, and tight boxes around such sets.
//!
//! Space outside the cube [−1, 1]³ of a frame is six projective boxes: with x = ±1/t, y = u/t,
//! z = v/t and so on, u and v in [−1, 1] and t in [0, 1], where t = 0 is the plane at infinity.
//! The set is taken for bounded if it is proved to have no point with t in [1e-9, 1e-6]; Bernstein
//! coefficients bound the polynomials and the formula is evaluated in three values. Parts that
//! are only farther away than that are ignored. The box is then found by branch and bound in
//! each direction.

mod cell;
mod directions;
mod search;
mod tensor;

pub(crate) use cell::Problem;

use crate::matrix::{Bounded, IDENTITY};
use crate::{Aabb, Error, LocalizeScratch, Polynomial, Ternary};
use cell::Cell;
use directions::DirectionTable;
use glam::DVec3;
use search::farthest;
use tensor::Role;

/// Multiplications that one proof may cost: about a second.
const PROOF_WORK: u64 = 1_000_000_000;

/// Multiplications that the search for the extent in one direction may cost.
const SEARCH_WORK: u64 = 20_000_000;

/// The same for the six directions of the final box, on which most depends.
const AXIS_WORK: u64 = 60_000_000;

/// Halvings that each search may make at least, whatever the degree: as many as find a cube
/// to a half or better. At degree 64 one of them costs nine million multiplications.
const LEAST_HALVINGS: u64 = 28;

/// Solids that reach farther than this many frame sizes count as unbounded.
const FARTHEST: f64 = 1e6;

/// What is farther away than this many frame sizes is not looked at.
///
/// On the plane at infinity itself nothing can be proved for paraboloids and other surfaces that
/// touch it: their coefficients' last bits decide whether there is another sheet out there.
const HORIZON: f64 = 1e9;

/// Width of the cells in which a direction's search ends, in sizes of the box, while the box is
/// still shrinking and at last.
const COARSE: f64 = 1.0 / 32.0;

/// See [`COARSE`].
const FINE: f64 = 1.0 / 256.0;

/// A bounded set, with its description over the box that it was found in.
pub(crate) struct BoundedSet {
    /// Centre and half sides of the box.
    center: DVec3,
    half: DVec3,
    /// None when the set is proved empty.
    root: Option<Cell>,
    errors: Vec<f64>,
    /// The final box, in the coordinates of the box above.
    tight: Aabb,
    /// Extents in other directions, in the same coordinates.
    table: DirectionTable,
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
        let inner = found.extent(COARSE, SEARCH_WORK);
        if inner.is_empty() {
            found.root = None;
            return Ok(Some(found));
        }
        let inner = Aabb {
            min: center + half * inner.min,
            max: center + half * inner.max,
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
    found.tighten();
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
        if class == Ternary::Out || cell.high.z * HORIZON <= 1.0 {
            continue;
        }
        if cell.low.z * FARTHEST >= 1.0 {
            nearest = nearest.min(cell.low.z);
            continue;
        }
        if class == Ternary::In || work > PROOF_WORK {
            return None;
        }
        let axis = cell.liveliest_axis();
        // Cells this narrow are beyond rounding: what is undecided there stays so.
        if cell.high[axis] - cell.low[axis] < 1e-11 {
            return None;
        }
        cells.extend(cell.halves(axis, &mut work));
    }
    Some(1.0 / nearest)
}

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
            tight: Aabb {
                min: DVec3::NEG_ONE,
                max: DVec3::ONE,
            },
            table: DirectionTable::default(),
        })
    }

    /// The least upper bound found of d · x over the set; −∞ if the set is proved empty.
    ///
    /// Never too small. Too large by a few thousandths of the set's size along the axes and by a
    /// hundredth in other directions, or more if the search becomes too expensive.
    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        let Some(root) = &self.root else {
            return f64::NEG_INFINITY;
        };
        let d = direction * self.half;
        let of_box = (d * self.tight.min).max(d * self.tight.max).element_sum();
        let axes = d.to_array().iter().filter(|c| **c != 0.0).count();
        let extent = if axes == 1 {
            of_box
        } else {
            let search = |d| farthest(root, &self.errors, d, FINE, SEARCH_WORK);
            of_box.min(self.table.support(d, search))
        };
        direction.dot(self.center) + extent
    }

    /// Finds the final box.
    fn tighten(&mut self) {
        self.tight = self.extent(FINE, AXIS_WORK);
        if self.tight.is_empty() {
            self.root = None;
        }
    }

    /// The set's bounding box to a relative precision, empty if the set is proved so, in the
    /// coordinates of the box that it was found in.
    fn extent(&self, precision: f64, allowed: u64) -> Aabb {
        let mut extent = Aabb::EMPTY;
        if let Some(root) = &self.root {
            let allowed = allowed.max(LEAST_HALVINGS * root.halving_work());
            let search = |d: DVec3| farthest(root, &self.errors, d, precision, allowed);
            for (axis, direction) in DVec3::AXES.into_iter().enumerate() {
                extent.max[axis] = search(direction);
                extent.min[axis] = -search(-direction);
            }
        }
        extent
    }
}
