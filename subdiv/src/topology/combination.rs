//! Linear combinations of primitives that keep one sign in a leaf: then these primitives do not
//! vanish together there, and one pattern of their signs does not occur.
//!
//! The same combination of the interpolants has the same sign, since its vertex values are among
//! the coefficients, and so has that of everything between.

use crate::patterns::{CROWD, Patterns};
use crate::topology::surface::Surface;
use arrayvec::ArrayVec;
use glam::DVec3;

/// Members of a leaf with their factors.
pub(crate) type Combination = ArrayVec<(usize, f64), 4>;

/// The sign pattern that a combination excludes, if it is proved to keep one sign in the leaf.
///
/// Polynomials of the highest degree enter with their coefficients, affine ones with their values
/// at the domain points, those of a degree between with their interpolant and its error.
#[must_use]
pub(crate) fn excluded(surfaces: &[Surface<'_>], combination: &Combination) -> Option<Patterns> {
    let degree_of = |at: usize| surfaces[at].table.degree();
    let degree = combination.iter().map(|(at, _)| degree_of(*at)).max()?;
    let mut slack = 0.0;
    let mut exact = ArrayVec::<(&[f64], f64), CROWD>::new();
    let mut affine = [0.0; 4];
    for &(at, factor) in combination {
        let surface = &surfaces[at];
        slack += factor.abs() * surface.noise;
        if degree_of(at) == degree {
            exact.push((surface.coefficients, factor));
            continue;
        }
        for (sum, value) in affine.iter_mut().zip(surface.values) {
            *sum += factor * value;
        }
        if degree_of(at) > 1 {
            slack += factor.abs() * surface.remainder();
        }
    }
    // Sums and products of at most five terms: 8u of the magnitudes, of which `noise` has 16u.
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    let has_affine = exact.len() < combination.len();
    let points = combination
        .iter()
        .find(|(at, _)| degree_of(*at) == degree)
        .map(|(at, _)| surfaces[*at].table.points())?;
    for (alpha, b) in points.iter().enumerate() {
        let mut value: f64 = exact.iter().map(|(c, factor)| factor * c[alpha]).sum();
        if has_affine {
            value += b[0] * affine[0] + b[1] * affine[1] + b[2] * affine[2] + b[3] * affine[3];
        }
        low = low.min(value);
        high = high.max(value);
        if !(low > slack || high < -slack) {
            return None;
        }
    }
    // All terms ≤ 0 contradicts a positive sum, all ≥ 0 a negative one.
    let positive = low > slack;
    let involved = combination.iter().filter(|(_, factor)| *factor != 0.0);
    Some(involved.fold(Patterns::ALL, |set, &(at, factor)| {
        set.intersection(Patterns::with(at, (factor > 0.0) == positive))
    }))
}

impl Surface<'_> {
    /// Bound on the coefficients of p − ℓ.
    fn remainder(&self) -> f64 {
        let mut largest = 0.0f64;
        for (c, b) in self.coefficients.iter().zip(self.table.points()) {
            let v = &self.values;
            let affine = b[0] * v[0] + b[1] * v[1] + b[2] * v[2] + b[3] * v[3];
            largest = largest.max((c - affine).abs());
        }
        largest + self.noise
    }
}

/// The point of the convex hull of these points that is nearest to the origin, where it lies on
/// a vertex, an edge or, if `faces`, a triangle; `None` when the origin is not clearly outside.
///
/// It is the direction of the widest gap between the origin and the points.
#[must_use]
pub(crate) fn nearest(points: &[DVec3; 4], faces: bool) -> Option<DVec3> {
    let mut best: Option<(f64, DVec3)> = None;
    let mut offer = |candidate: DVec3| {
        let Some(direction) = candidate.try_normalize() else {
            return;
        };
        let gap = points
            .iter()
            .map(|p| p.dot(direction))
            .fold(f64::INFINITY, f64::min);
        if gap > 0.0 && best.is_none_or(|(known, _)| gap > known) {
            best = Some((gap, direction));
        }
    };
    for a in 0..4 {
        for b in 0..a {
            let (p, q) = (points[a], points[b]);
            let edge = q - p;
            let square = edge.length_squared();
            let t = if square > 0.0 {
                (-p.dot(edge) / square).clamp(0.0, 1.0)
            } else {
                0.0
            };
            offer(p + edge * t);
        }
    }
    if faces {
        for omitted in 0..4 {
            let [a, b, c] = match omitted {
                0 => [1, 2, 3],
                1 => [0, 2, 3],
                2 => [0, 1, 3],
                _ => [0, 1, 2],
            };
            let normal = (points[b] - points[a]).cross(points[c] - points[a]);
            offer(normal * points[a].dot(normal).signum());
        }
    }
    best.map(|(_, direction)| direction)
}
