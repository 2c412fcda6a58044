//! Bounds on how far Bernstein coefficients are from the exact ones.
//!
//! Two errors are kept apart, both absolute and for all coefficients of a primitive in a simplex:
//!
//! * *rounding*: against the polynomial that the subdivision was given, its power coefficients
//!   taken as exact numbers. It begins with the conversion at the roots and grows with each
//!   halving by what the averages round off there;
//! * *model*: of that polynomial itself against the user's model, whose transformations, shift
//!   to the domain and interning rounded: [`Primitive::coefficient_error`]. Monomials are
//!   Bernstein forms with coefficients in [−1, 1] in the cube, and an affine map of the
//!   arguments averages coefficients, so it is the same in all simplices.
//!
//! A sign that exceeds the sum of both is the sign that the user's polynomial has. Decisions
//! shared by two simplices need no common bound: a primitive is dropped in one of them only if
//! its coefficients there, so those of the shared facet, have one sign as they stand.
//!
//! u = 2⁻⁵³ is the largest relative error of one operation.

use csg::Primitive;

/// Largest relative error of one rounding.
pub(crate) const UNIT_ROUNDOFF: f64 = 0.5 * f64::EPSILON;

/// Absorbs the roundings of a bound's own computation, some ten of them.
const OUTWARD: f64 = 1.0 + 8.0 * f64::EPSILON;

/// Rounding of the conversion from power form (`crate::blossom`).
///
/// `magnitude`: sum of the absolute power coefficients. In each of six passes a term is
/// multiplied by a weight, itself rounded five times, and takes part in at most n additions; all
/// weights of a pass together are at most 1.
#[must_use]
pub(crate) fn of_conversion(degree: usize, magnitude: f64) -> f64 {
    let roundings = 6 * (degree + 6);
    // (1+u)^k − 1 ≤ k·u·(1 + k·u) for the k that occur, some 420 at degree 64.
    let relative = roundings as f64 * UNIT_ROUNDOFF;
    relative * (1.0 + relative) * magnitude * OUTWARD + f64::MIN_POSITIVE
}

/// Rounding in a child, given that in its parent and the parent's largest absolute coefficient.
///
/// Averaging never enlarges an inherited error. Each of at most n averages in a row rounds once,
/// relative to a number that is no larger than the largest coefficient; below the normal range
/// absolutely.
#[must_use]
pub(crate) fn of_halving(degree: usize, parent: f64, largest: f64) -> f64 {
    (parent + degree as f64 * UNIT_ROUNDOFF * largest) * OUTWARD + f64::MIN_POSITIVE
}

/// Error of a primitive's Bernstein coefficients against the user's model, in any simplex of the
/// domain.
#[must_use]
pub(crate) fn of_model(primitive: &Primitive) -> f64 {
    primitive.coefficient_error * OUTWARD
}

#[cfg(test)]
mod tests;
