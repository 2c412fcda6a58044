//! Two surfaces in a leaf: they cross transversally, or they are apart.

use crate::patterns::Patterns;
use crate::topology::combination::{Combination, excluded, nearest};
use crate::topology::kindred::Kin;
use crate::topology::surface::{Cone, Surface};
use glam::DVec3;

/// Whether no line lies in both cones: ψ₁ + ψ₂ is less than the angle between the axes' lines.
///
/// tan(ψ₁ + ψ₂) = (t₁ + t₂)/(1 − t₁t₂) is compared with sine over cosine, each of which is off by
/// at most 8u.
#[must_use]
pub(crate) fn transversal(a: &Cone, b: &Cone) -> bool {
    let room = 1.0 - a.tangent * b.tangent;
    let cosine = a.axis.dot(b.axis).abs() + 1e-14;
    let sine = a.axis.cross(b.axis).length() - 1e-14;
    room > 0.0 && (a.tangent + b.tangent) * cosine * (1.0 + 1e-14) < sine * room
}

/// The sign pattern that does not occur, if two surfaces are proved to have no common point.
///
/// First p − λq with λ the ratio of kin or of the slopes, which makes the sheets of the thinnest
/// wall a constant apart; then the combination whose vertex values are farthest from zero.
#[must_use]
pub(crate) fn apart(surfaces: &[Surface<'_>], i: usize, j: usize) -> Option<Patterns> {
    let (p, q) = (&surfaces[i], &surfaces[j]);
    let combination = |a: f64, b: f64| Combination::from_iter([(i, a), (j, b)]);
    if let (Some(a), Some(b)) = (p.kin, q.kin)
        && Kin::joins(p.kin, q.kin)
        && let Some(pattern) = excluded(surfaces, &combination(a.factor, -b.factor))
    {
        return Some(pattern);
    }
    let ratio = (p.steepness / q.steepness).copysign(-p.slope.dot(q.slope));
    if let Some(pattern) = excluded(surfaces, &combination(1.0, ratio)) {
        return Some(pattern);
    }
    let points = std::array::from_fn(|v| {
        DVec3::new(p.values[v] / p.steepness, q.values[v] / q.steepness, 0.0)
    });
    let direction = nearest(&points, false)?;
    let factors = combination(direction.x / p.steepness, direction.y / q.steepness);
    excluded(surfaces, &factors)
}
