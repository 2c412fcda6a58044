//! The second derivatives of a quadric, which are the same everywhere, and what follows for its
//! values around a simplex.

use crate::certify::BarycentricGradients;
use csg::Primitive;
use glam::{DMat3, DVec3};

/// Bounds on the second derivatives of a quadric in any direction, in unit coordinates, its error
/// included.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Hessian {
    /// Largest absolute value; exact for balls.
    pub(crate) norm: f64,
    /// The least value; exact for balls.
    least: f64,
    /// The largest one.
    most: f64,
}

impl Hessian {
    /// That of a primitive, if it is a quadric.
    #[must_use]
    pub(crate) fn of(primitive: &Primitive) -> Option<Self> {
        let polynomial = &primitive.polynomial;
        if polynomial.degree() != 2 {
            return None;
        }
        let c = polynomial.coefficients();
        // Half a unit is one centred one.
        let hessian = DMat3::from_cols(
            DVec3::new(8.0 * c[0], 4.0 * c[1], 4.0 * c[2]),
            DVec3::new(4.0 * c[1], 8.0 * c[4], 4.0 * c[5]),
            DVec3::new(4.0 * c[2], 4.0 * c[5], 8.0 * c[7]),
        );
        // Six entries are off by up to eight times the coefficients' error.
        let error = 48.0 * primitive.coefficient_error;
        let norm = norm(&hessian);
        // All eigenvalues are as close to their mean as the rest's norm tells.
        let mean = (hessian.x_axis.x + hessian.y_axis.y + hessian.z_axis.z) / 3.0;
        let rest = self::norm(&(hessian - DMat3::from_diagonal(DVec3::splat(mean))));
        let error = error + 1e-14 * norm;
        Some(Self {
            norm: norm + error,
            least: (mean - rest).max(-norm) - error,
            most: (mean + rest).min(norm) + error,
        })
    }

    /// Those of a + λb.
    #[must_use]
    pub(crate) fn plus(&self, lambda: f64, b: &Self) -> Self {
        let both = [lambda * b.least, lambda * b.most];
        Self {
            norm: self.norm + (lambda * b.norm).abs(),
            least: self.least + both[0].min(both[1]),
            most: self.most + both[0].max(both[1]),
        }
    }

    /// How far around a simplex a quadric that has one sign there is proved to keep it.
    ///
    /// `low`, `high`: bounds of its ten coefficients there. In a distance t of a point where it is
    /// c it is at least c − t·|∇p| + t²·λ/2, with λ its least second derivative.
    #[must_use]
    pub(crate) fn clearance(
        &self,
        coefficients: &[f64],
        (low, high): (f64, f64),
        gradients: &BarycentricGradients,
    ) -> f64 {
        let (nearest, curving) = if low > 0.0 {
            (low, self.least)
        } else {
            (-high, -self.most)
        };
        if nearest <= 0.0 {
            return 0.0;
        }
        // A dozen roundings each.
        let nearest = nearest - 1e-14 * low.abs().max(high.abs());
        let slope = steepest(coefficients, gradients) * (1.0 + 1e-14);
        let square = slope * slope - 2.0 * nearest * curving;
        if square < -1e-14 * slope * slope {
            return f64::INFINITY;
        }
        2.0 * nearest / (slope + square.max(0.0).sqrt()) * (1.0 - 1e-14)
    }
}

/// The largest length of a quadric's gradient in a simplex: it is at a vertex.
fn steepest(coefficients: &[f64], gradients: &BarycentricGradients) -> f64 {
    let Some(c) = coefficients.first_chunk::<10>() else {
        return f64::INFINITY;
    };
    // Coefficients of the edges from each vertex, in storage order.
    let rows = [
        [c[0], c[1], c[2], c[3]],
        [c[1], c[4], c[5], c[6]],
        [c[2], c[5], c[7], c[8]],
        [c[3], c[6], c[8], c[9]],
    ];
    let [g0, g1, g2, g3] = *gradients;
    let mut square = 0.0f64;
    for [r0, r1, r2, r3] in rows {
        square = square.max((g0 * r0 + g1 * r1 + g2 * r2 + g3 * r3).length_squared());
    }
    2.0 * square.sqrt()
}

/// Bound on |M x|/|x| for symmetric M: the smaller of two matrix norms.
#[must_use]
pub(crate) fn norm(m: &DMat3) -> f64 {
    let columns = [m.x_axis, m.y_axis, m.z_axis];
    let by_columns = columns.map(|c| c.abs().element_sum());
    let squares: f64 = columns.iter().map(|c| c.length_squared()).sum();
    by_columns
        .into_iter()
        .fold(0.0, f64::max)
        .min(squares.sqrt())
}
