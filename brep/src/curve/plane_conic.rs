//! Ellipses in which planes cut quadrics.

use csg::Polynomial;
use glam::{DMat3, DVec3};

/// The ellipse in which a plane cuts a quadric: its centre and its perpendicular semi-axes, the
/// longer one first; `None` if the plane cuts another conic.
///
/// `near` is a point near the ellipse, from which centres are computed with few digits lost.
pub(super) fn ellipse(p: &Polynomial, normal: DVec3, near: DVec3) -> Option<(DVec3, [DVec3; 2])> {
    if p.degree() != 2 {
        return None;
    }
    let c = p.coefficients();
    let matrix = DMat3::from_cols_array_2d(&[
        [c[0], 0.5 * c[1], 0.5 * c[2]],
        [0.5 * c[1], c[4], 0.5 * c[5]],
        [0.5 * c[2], 0.5 * c[5], c[7]],
    ]);
    let (e, f) = normal.any_orthonormal_pair();
    let (ee, ef, ff) = (e.dot(matrix * e), e.dot(matrix * f), f.dot(matrix * f));
    let determinant = ee * ff - ef * ef;
    if determinant <= 1e-12 * (ee.abs() + ff.abs()).powi(2) {
        return None;
    }
    // Principal directions in the plane.
    let angle = 0.5 * (2.0 * ef).atan2(ee - ff);
    let (sine, cosine) = angle.sin_cos();
    let (u, v) = (e * cosine + f * sine, f * cosine - e * sine);
    let values = [u, v].map(|axis| axis.dot(matrix * axis));
    let mut center = near;
    for _ in 0..2 {
        let gradient = p.gradient(center);
        for (axis, value) in [u, v].into_iter().zip(values) {
            center -= axis * (0.5 * gradient.dot(axis) / value);
        }
    }
    let level = p.evaluate(center);
    let squares = values.map(|value| -level / value);
    if squares
        .iter()
        .any(|&square| square.is_nan() || square <= 0.0)
    {
        return None;
    }
    let across = [u * squares[0].sqrt(), v * squares[1].sqrt()];
    let [major, minor] = if squares[0] >= squares[1] {
        across
    } else {
        [across[1], across[0]]
    };
    Some((center, [major, minor]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slanting_plane_cuts_a_cylinder_in_an_ellipse() {
        // x² + y² = 1/4 and z = x: semi-axes 1/2 and √2/2.
        let p = Polynomial::quadric(&[
            [1.0, 0.0, 0.0, 0.0],
            [0.0, 1.0, 0.0, 0.0],
            [0.0; 4],
            [0.0, 0.0, 0.0, -0.25],
        ])
        .expect("finite");
        let normal = DVec3::new(1.0, 0.0, -1.0).normalize();
        let (center, [major, minor]) = ellipse(&p, normal, DVec3::new(0.5, 0.0, 0.5)).expect("one");
        assert!(center.length() < 1e-15);
        assert!((major.length() - 0.5_f64.sqrt()).abs() < 1e-15);
        assert!((minor.length() - 0.5).abs() < 1e-15);
        assert!(minor.cross(DVec3::Y).length() < 1e-15);
        assert!(ellipse(&p, DVec3::X, DVec3::new(0.5, 0.0, 0.0)).is_none());
    }
}
