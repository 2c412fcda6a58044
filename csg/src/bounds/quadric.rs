//! Support functions of ellipsoids and elliptic cylinders in any position.

use super::Support;
use crate::Polynomial;
use glam::{DMat3, DVec3};

/// Eigenvalues this small beside the largest count as zero.
const NULL: f64 = 1e-13;

/// Support function of `p ≤ 0` where p is linear or the set is bounded in some directions by a
/// quadric without hyperbolic or parabolic part; for all others that of all of space.
pub(crate) fn quadric_support(p: &Polynomial) -> Support<'static> {
    let c = p.coefficients();
    match p.degree() {
        0 if c[0] > 0.0 => Support::empty(),
        1 => Support::half_space(DVec3::new(c[0], c[1], c[2]), -c[3]),
        2 => {
            let matrix = DMat3::from_cols_array_2d(&[
                [c[0], 0.5 * c[1], 0.5 * c[2]],
                [0.5 * c[1], c[4], 0.5 * c[5]],
                [0.5 * c[2], 0.5 * c[5], c[7]],
            ]);
            let linear = DVec3::new(0.5 * c[3], 0.5 * c[6], 0.5 * c[8]);
            elliptic_support(matrix, linear, c[9])
        }
        _ => Support::everywhere(),
    }
}

/// Support function of xᵀAx + 2b·x + c ≤ 0 for positive semidefinite A.
fn elliptic_support(matrix: DMat3, linear: DVec3, constant: f64) -> Support<'static> {
    let (values, axes) = symmetric_eigen(matrix);
    let largest = values.abs().max_element();
    if values.min_element() < -NULL * largest {
        return Support::everywhere();
    }
    // What is left after completing the squares, kept on the safe side of rounding.
    let mut level = constant;
    let mut rounding = constant.abs();
    let mut center = DVec3::ZERO;
    let size = linear.length() + (largest * constant.abs()).sqrt();
    for k in 0..3 {
        let along = linear.dot(axes.col(k));
        if values[k] > NULL * largest {
            center -= axes.col(k) * (along / values[k]);
            level -= along * along / values[k];
            rounding += along * along / values[k];
        } else if along.abs() > 8.0 * f64::EPSILON * size {
            return Support::everywhere();
        }
    }
    level -= 8.0 * f64::EPSILON * rounding;
    if level >= 0.0 {
        return Support::empty();
    }
    Support::finite(move |d| {
        let mut square = 0.0;
        for k in 0..3 {
            let along = d.dot(axes.col(k));
            if values[k] > NULL * largest {
                square += along * along / values[k];
            } else if along.abs() > 1e-12 * d.length() {
                return f64::INFINITY;
            }
        }
        d.dot(center) + (-level * square).sqrt()
    })
}

/// Eigenvalues and eigenvectors (as columns) of a symmetric matrix, by Jacobi's rotations.
///
/// Diagonal matrices come back as they are.
pub(crate) fn symmetric_eigen(matrix: DMat3) -> (DVec3, DMat3) {
    let mut a = matrix.to_cols_array_2d();
    let mut v = DMat3::IDENTITY.to_cols_array_2d();
    // Quadratic convergence: four sweeps reach rounding, the rest is for safety.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if a[p][q] == 0.0 {
                continue;
            }
            let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let cosine = 1.0 / t.hypot(1.0);
            let sine = t * cosine;
            for row in &mut a {
                (row[p], row[q]) = (
                    cosine * row[p] - sine * row[q],
                    sine * row[p] + cosine * row[q],
                );
            }
            let (row_p, row_q) = (a[p], a[q]);
            for k in 0..3 {
                a[p][k] = cosine * row_p[k] - sine * row_q[k];
                a[q][k] = sine * row_p[k] + cosine * row_q[k];
            }
            a[p][q] = 0.0;
            a[q][p] = 0.0;
            let (col_p, col_q) = (v[p], v[q]);
            for k in 0..3 {
                v[p][k] = cosine * col_p[k] - sine * col_q[k];
                v[q][k] = sine * col_p[k] + cosine * col_q[k];
            }
        }
    }
    let values = DVec3::new(a[0][0], a[1][1], a[2][2]);
    (values, DMat3::from_cols_array_2d(&v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn eigenvectors_diagonalise(e in proptest::array::uniform6(-2.0..2.0)) {
            let m = DMat3::from_cols_array_2d(&[
                [e[0], e[1], e[2]],
                [e[1], e[3], e[4]],
                [e[2], e[4], e[5]],
            ]);
            let (values, axes) = symmetric_eigen(m);
            let back = axes * DMat3::from_diagonal(values) * axes.transpose();
            prop_assert!((back - m).abs_diff_eq(DMat3::ZERO, 1e-14));
            prop_assert!((axes.transpose() * axes).abs_diff_eq(DMat3::IDENTITY, 1e-14));
        }
    }
}
