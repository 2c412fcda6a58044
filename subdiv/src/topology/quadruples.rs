//! Four surfaces in a leaf: in general they have no common point, and a combination shows it.

use crate::patterns::Patterns;
use crate::topology::combination::{Combination, excluded};
use crate::topology::surface::Surface;
use glam::{DMat4, DVec4};

/// The sign pattern that does not occur, if four surfaces are proved to have no common point.
///
/// The combination is that whose interpolant is constant. It exists unless the four interpolants
/// pass through one point.
#[must_use]
pub(crate) fn apart(surfaces: &[Surface<'_>], members: [usize; 4]) -> Option<Patterns> {
    let four = members.map(|at| &surfaces[at]);
    // One column for each primitive, one row for each vertex: values · factors = 1.
    let columns = four.map(|surface| DVec4::from_array(surface.values) / surface.steepness);
    let [a, b, c, d] = columns;
    let values = DMat4::from_cols(a, b, c, d);
    let determinant = values.determinant();
    if determinant == 0.0 {
        return None;
    }
    let factors = (values.inverse() * DVec4::ONE).to_array();
    if factors.iter().any(|factor| !factor.is_finite()) {
        return None;
    }
    let combination: [(usize, f64); 4] =
        std::array::from_fn(|m| (members[m], factors[m] / four[m].steepness));
    excluded(surfaces, &Combination::from_iter(combination))
}
