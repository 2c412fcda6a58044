//! The metric acceptance rule: when mesh and true boundary are proved to be within the tolerance
//! of each other in a leaf. `docs/accuracy.md` has the argument; in short:
//!
//! From a point of the mesh the true boundary is reached by going straight, at most t far, in
//! a direction in which all surfaces around are left to their outer sides (and straight back, in
//! which all are entered): then the formula can only fall (rise) on the way. With cosine c
//! between that direction and all gradients, surface j is passed after the t with
//! t·(c·(m − t·H) − t·H/2) = ω. Nothing depends on whether the way leaves the leaf, because the
//! polynomials do not end there: surfaces that come within three tolerances of the leaf take part
//! (`crate::margin`), m, H and c hold within one.
//!
//! Surfaces that are proved apart need no common direction. A plane, whose ω is but rounding,
//! may be passed at an eighth of the others' cosine: so the tolerance is hardly smaller at the
//! edge of a cylinder than on it.

use crate::certify::{Around, Place, Sheet, apart, barycentric_gradients};
use crate::classify::{Criterion, classify};
use crate::convert::Plan;
use crate::direction::common_direction;
use crate::margin::Margin;
use crate::settings::Reason;
use crate::simplex::Simplex;
use crate::walk::{Active, Frame};
use arrayvec::ArrayVec;
use csg::{FormulaNode, Sense, Ternary};
use glam::DVec3;

/// Most primitives in and around a leaf that the rule accepts.
const CROWD: usize = 8;

/// Most primitives that a leaf's formula needs in both senses.
const MOST_TWO_SIDED: usize = 3;

/// Most planes of a leaf that nothing curved crosses, and most pairs of them that cross there.
/// More would be arranged as exactly, but it takes less time to bisect.
const MOST_PLANES: usize = 48;

/// Number of planes that are bisected rather than accepted as they are, above [`CROWDED_LEVEL`].
const FEW_PLANES: usize = 16;

/// Level from which on any leaf of planes is accepted as it is.
const CROWDED_LEVEL: u8 = 12;

/// See [`MOST_PLANES`].
const MOST_CROSSINGS: usize = 100;

/// Part of the tolerance that is left for the rounding of positions.
const ROUNDING_SHARE: f64 = 1e-6;

/// Share of the cosine at which planes are passed.
const PLANE_WEIGHT: f64 = 0.125;

/// A set of sheets, one bit each.
type Set = u32;

/// Tests leaves; holds only work space between them.
#[derive(Debug, Default)]
pub(crate) struct DeviationRule {
    sheets: ArrayVec<Sheet, CROWD>,
    /// Parallel to `sheets`.
    active: ArrayVec<Active, CROWD>,
    /// What may vanish in the neighbourhood at hand.
    near: Vec<Active>,
    control: Vec<DVec3>,
}

/// What is proved of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Proved {
    /// Distance from the mesh to the true boundary, in the domain's own units.
    pub distance: f64,
    /// Whether the true boundary is as near to the mesh.
    pub both_ways: bool,
}

impl DeviationRule {
    /// The distance within which mesh and true boundary are proved to be of each other.
    ///
    /// # Errors
    /// Why nothing below the tolerance is proved.
    pub(crate) fn test(
        &mut self,
        plan: &Plan<'_>,
        margin: &Margin,
        simplex: &Simplex,
        frame: &Frame,
    ) -> Result<Proved, Reason> {
        let place = Place {
            gradients: barycentric_gradients(simplex),
            rate: margin.rate(simplex.level),
            tolerance: margin.radius / 3.0 * (1.0 - ROUNDING_SHARE),
        };
        let mut near = std::mem::take(&mut self.near);
        let result = self.test_near(plan, margin, simplex, frame, (&place, &mut near));
        self.near = near;
        result.or_else(|reason| {
            self.test_planes(plan, simplex.level, frame, &place)
                .ok_or(reason)
        })
    }

    /// Planes are their own interpolants and are arranged exactly: where nothing else matters,
    /// the mesh is the true boundary but for rounding.
    fn test_planes(
        &mut self,
        plan: &Plan<'_>,
        level: u8,
        frame: &Frame,
        place: &Place,
    ) -> Option<Proved> {
        let mut needed = ArrayVec::<u32, MOST_PLANES>::new();
        for node in frame.formula_within() {
            if let FormulaNode::Literal(literal) = node
                && !needed.contains(&literal.primitive.0)
            {
                needed.try_push(literal.primitive.0).ok()?;
            }
        }
        // A few are better taken apart first, and then proved in both directions.
        if level < CROWDED_LEVEL && needed.len() <= FEW_PLANES {
            return None;
        }
        let around = Around {
            radius: place.tolerance,
            both_ways: false,
            rate: place.rate,
        };
        let mut distance = 0.0f64;
        let mut values = ArrayVec::<[f64; 4], MOST_PLANES>::new();
        let mut crossings = 0;
        for active in frame
            .active
            .iter()
            .filter(|a| needed.contains(&a.primitive))
        {
            if active.degree > 1 {
                return None;
            }
            let own = frame.values_of(active);
            crossings += values.iter().filter(|other| may_cross(&own, other)).count();
            if crossings > MOST_CROSSINGS {
                return None;
            }
            values.push(own);
            let coefficients = frame.coefficients_of(active);
            let control = &mut self.control;
            let sheet = Sheet::new(&plan.tables, active, coefficients, place, None, control)?;
            distance = distance.max(sheet.reach(1.0, &around)?);
        }
        Some(Proved {
            distance,
            both_ways: false,
        })
    }

    /// `near`: work space.
    fn test_near(
        &mut self,
        plan: &Plan<'_>,
        margin: &Margin,
        simplex: &Simplex,
        frame: &Frame,
        (place, near): (&Place, &mut Vec<Active>),
    ) -> Result<Proved, Reason> {
        let crossing = frame.active.iter().filter(|a| a.value == Ternary::Unknown);
        near.clear();
        near.extend(crossing);
        self.gather(plan, frame, near, place)?;
        let least = self.sheets.iter().map(Sheet::least_reach);
        let least = least.fold(0.0, f64::max);
        let mut gathered = self.active.len();
        let mut why = None;
        // The whole tolerance around; then less, as far as the leaf itself may need.
        for (both_ways, radius) in [
            (true, place.tolerance),
            (false, place.tolerance),
            (false, 2.0 * least),
            (false, 6.0 * least),
        ] {
            if radius > place.tolerance {
                // Nothing new.
                break;
            }
            let around = Around {
                radius,
                both_ways,
                rate: place.rate,
            };
            let around_it = frame.active.iter();
            let around_it =
                around_it.filter(|a| is_near(a, simplex, frame, margin, place, &around));
            near.clear();
            near.extend(around_it);
            // Sets of one size are the same: a smaller radius has no more around it.
            let result = if near.len() == gathered {
                Ok(())
            } else {
                let done = self.gather(plan, frame, near, place);
                gathered = done.map_or(usize::MAX, |()| self.active.len());
                done
            };
            let result = result.and_then(|()| self.try_around(plan, frame, (place, &around)));
            match result {
                Ok(distance) => {
                    return Ok(Proved {
                        distance,
                        both_ways,
                    });
                }
                Err(reason) => why = why.or(Some(reason)),
            }
        }
        Err(why.unwrap_or(Reason::Singular))
    }

    /// Looks at each of these primitives on its own.
    fn gather(
        &mut self,
        plan: &Plan<'_>,
        frame: &Frame,
        active: &[Active],
        place: &Place,
    ) -> Result<(), Reason> {
        self.sheets.clear();
        self.active.clear();
        self.active
            .try_extend_from_slice(active)
            .map_err(|_| Reason::Crowded)?;
        for active in &self.active {
            let coefficients = frame.coefficients_of(active);
            let hessian = plan.hessians[active.primitive as usize].as_ref();
            let control = &mut self.control;
            let sheet = Sheet::new(&plan.tables, active, coefficients, place, hessian, control);
            self.sheets.push(sheet.ok_or(Reason::Singular)?);
        }
        if self.sheets.len() > 1 {
            for (active, sheet) in self.active.iter().zip(&mut self.sheets) {
                let table = &plan.tables[active.degree as usize - 1];
                sheet.find_spread(table, frame.coefficients_of(active), place);
            }
        }
        Ok(())
    }

    /// The rule for one neighbourhood.
    fn try_around(
        &mut self,
        plan: &Plan<'_>,
        frame: &Frame,
        (place, around): (&Place, &Around),
    ) -> Result<f64, Reason> {
        let mut alone = self.sheets.iter().map(|s| s.reach(1.0, around));
        let alone = alone.try_fold(0.0f64, |m, t| Some(m.max(t?)));
        let alone = alone.ok_or(Reason::Singular)?;
        if self.sheets.len() == 1 {
            return Ok(alone);
        }
        // Planes are their own interpolants: their arrangement is exact.
        let exact = self.sheets.iter().all(|s| s.degree == 1);
        self.try_several(plan, frame, (place, around))
            .or_else(|reason| exact.then_some(alone).ok_or(reason))
    }

    fn try_several(
        &mut self,
        plan: &Plan<'_>,
        frame: &Frame,
        (place, around): (&Place, &Around),
    ) -> Result<f64, Reason> {
        let mut senses = [1.0; CROWD];
        let mut two_sided = ArrayVec::<usize, MOST_TWO_SIDED>::new();
        for (at, active) in self.active.iter().enumerate() {
            match single_sense(&frame.formula, active.primitive) {
                Some(sense) => senses[at] = sense,
                None => two_sided.try_push(at).map_err(|_| Reason::Tangent)?,
            }
        }
        let mut largest = 0.0f64;
        for flips in 0..1u32 << two_sided.len() {
            for (bit, &at) in two_sided.iter().enumerate() {
                senses[at] = if flips >> bit & 1 == 1 { -1.0 } else { 1.0 };
            }
            let cosine = self.cosine(plan, frame, &senses, (place, around))?;
            for sheet in &self.sheets {
                let cosine = (cosine * weight(sheet)).min(1.0);
                let reach = sheet.reach(cosine, around);
                largest = largest.max(reach.ok_or(Reason::Tangent)?);
            }
        }
        Ok(largest)
    }

    /// Least cosine, over all sets of sheets that may meet, of their common outward direction.
    fn cosine(
        &self,
        plan: &Plan<'_>,
        frame: &Frame,
        senses: &[f64; CROWD],
        (place, around): (&Place, &Around),
    ) -> Result<f64, Reason> {
        let all: Set = (1 << self.sheets.len()) - 1;
        // Most often all have a common direction.
        if let Some(cosine) = self.cosine_of(all, senses, around) {
            return Ok(cosine);
        }
        let mut apart_from = [0 as Set; CROWD];
        for i in 0..self.sheets.len() {
            for j in 0..i {
                let both = [i, j];
                let sheets = both.map(|at| &self.sheets[at]);
                let coefficients = both.map(|at| frame.coefficients_of(&self.active[at]));
                let hessians =
                    both.map(|at| plan.hessians[self.active[at].primitive as usize].as_ref());
                if apart(
                    sheets,
                    coefficients,
                    both.map(|at| senses[at]),
                    (&plan.tables, hessians),
                    around,
                    &place.gradients,
                ) {
                    apart_from[i] |= 1 << j;
                    apart_from[j] |= 1 << i;
                }
            }
        }
        let members = |set: Set| (0..self.sheets.len()).filter(move |at| set >> at & 1 == 1);
        let mut least = f64::INFINITY;
        for set in 1..=all {
            // Maximal sets of which no two are apart.
            let against = members(set).fold(0, |sum, at| sum | apart_from[at]);
            let extendable = members(all & !set).any(|at| apart_from[at] & set == 0);
            if against & set == 0 && !extendable {
                least = least.min(self.cosine_of(set, senses, around).ok_or(Reason::Tangent)?);
            }
        }
        Ok(least)
    }

    /// Least cosine between the sheets' outward gradients and a direction common to them, divided
    /// by their weights.
    fn cosine_of(&self, set: Set, senses: &[f64; CROWD], around: &Around) -> Option<f64> {
        let mut normals = ArrayVec::<DVec3, CROWD>::new();
        let mut chosen = ArrayVec::<&Sheet, CROWD>::new();
        for (at, sheet) in self.sheets.iter().enumerate() {
            if set >> at & 1 == 1 {
                normals.push(sheet.normal * (senses[at] / weight(sheet)));
                chosen.push(sheet);
            }
        }
        let direction = common_direction(&normals)?;
        let cosines = normals.iter().zip(&chosen).map(|(normal, sheet)| {
            let weight = weight(sheet);
            // The direction and the normals have unit length but for a few roundings.
            let cosine = (normal.dot(direction) * weight).clamp(0.0, 1.0);
            let (sine, spread) = ((1.0 - cosine * cosine).sqrt(), sheet.spread_sine(around));
            (cosine * (1.0 - spread * spread).sqrt() - sine * spread - 1e-12) / weight
        });
        let least = cosines.fold(f64::INFINITY, f64::min);
        (least > 0.0).then_some(least)
    }
}

/// Whether a primitive may vanish around the simplex: within the frame's margin for the whole
/// tolerance, within the radius for less, since only the way from the mesh counts then.
fn is_near(
    active: &Active,
    simplex: &Simplex,
    frame: &Frame,
    margin: &Margin,
    place: &Place,
    around: &Around,
) -> bool {
    if active.value == Ternary::Unknown || around.both_ways {
        return true;
    }
    if active.clearance >= around.radius {
        return false;
    }
    if active.degree <= 2 {
        return true;
    }
    let (degree, coefficients) = (active.degree as usize, frame.coefficients_of(active));
    let class = classify(Criterion::Bezier, simplex.kind(), degree, coefficients, 0.0);
    let place = (place.rate, &place.gradients);
    !margin.keeps_sign(around.radius, place, active, coefficients, &class)
}

/// Whether two planes, given by their values at a simplex' vertices, cross in it: whether no
/// combination of the two is positive at all vertices.
fn may_cross(p: &[f64; 4], q: &[f64; 4]) -> bool {
    let turn = |a: usize, b: usize| p[a] * q[b] - p[b] * q[a];
    !(0..4).any(|a| (0..4).all(|b| a == b || turn(a, b) > 0.0))
}

fn weight(sheet: &Sheet) -> f64 {
    if sheet.degree == 1 { PLANE_WEIGHT } else { 1.0 }
}

/// 1 when all literals of a primitive mean its inside, so that its gradient points outward, −1
/// when all mean its outside, `None` when both occur.
fn single_sense(formula: &[FormulaNode], primitive: u32) -> Option<f64> {
    let mut found = None;
    for node in formula {
        if let FormulaNode::Literal(literal) = node
            && literal.primitive.0 == primitive
        {
            if found.is_some_and(|sense| sense != literal.sense) {
                return None;
            }
            found = Some(literal.sense);
        }
    }
    Some(match found? {
        Sense::Inside => 1.0,
        Sense::Outside => -1.0,
    })
}
