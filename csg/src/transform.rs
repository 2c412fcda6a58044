//! Maps of space: affine ones, with or without mirroring, and projective ones.
//!
//! A transform M takes the solid S to { p M : p ∈ S }, with points as row vectors (x, y, z, 1),
//! so that a polynomial p becomes p'(q) = p(q M⁻¹) (lecture notes 10.2.5).

use crate::error::{Error, finite};
use crate::matrix::{self, Bounded, IDENTITY, Rows};
use glam::DVec3;

/// An invertible affine or projective map of space.
///
/// ```
/// use csg::Transform;
/// use glam::DVec3;
/// let turn_then_move = Transform::from_columns(&[
///     [0., -1., 0., 5.],
///     [1., 0., 0., 0.],
///     [0., 0., 1., 0.],
///     [0., 0., 0., 1.],
/// ])?;
/// assert_eq!(turn_then_move.apply(DVec3::X), Some(DVec3::new(5., 1., 0.)));
/// # Ok::<(), csg::Error>(())
/// ```
#[derive(Clone, PartialEq, Debug)]
pub struct Transform {
    /// Boxed, so that nodes of a model stay small.
    maps: Box<Maps>,
}

/// A map and its inverse, for row vectors.
#[derive(Clone, PartialEq, Debug)]
struct Maps {
    forward: Bounded,
    inverse: Bounded,
}

impl Transform {
    fn new(forward: Bounded, inverse: Bounded) -> Self {
        Self {
            maps: Box::new(Maps { forward, inverse }),
        }
    }

    /// Takes the matrix as OpenSCAD's `multmatrix` writes it: rows of a matrix that multiplies
    /// column vectors, translation in the last column.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::SingularTransform`].
    pub fn from_columns(matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        Self::from_rows(&matrix::transposed(matrix))
    }

    /// Takes the rows of a matrix that row vectors are multiplied by: translation in the last
    /// row, as in the thesis and the lecture notes.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::SingularTransform`].
    pub fn from_rows(matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        for &entry in matrix.iter().flatten() {
            finite("transform matrix", entry)?;
        }
        Ok(Self::new(Bounded::exact(*matrix), matrix::inverse(matrix)?))
    }

    /// The map that moves nothing.
    #[must_use]
    pub fn identity() -> Self {
        Self::new(Bounded::exact(IDENTITY), Bounded::exact(IDENTITY))
    }

    /// Moves everything by `offset`.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub fn translation(offset: DVec3) -> Result<Self, Error> {
        let rows = |by: DVec3| {
            let mut rows = IDENTITY;
            rows[3] = [by.x, by.y, by.z, 1.0];
            rows
        };
        if !offset.is_finite() {
            let what = "translation";
            return Err(Error::NonFinite { what });
        }
        Ok(Self::new(
            Bounded::exact(rows(offset)),
            Bounded::exact(rows(-offset)),
        ))
    }

    /// Multiplies the coordinates; negative factors mirror.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::SingularTransform`] if a factor is 0.
    pub fn scale(factors: DVec3) -> Result<Self, Error> {
        let mut rows = IDENTITY;
        for axis in 0..3 {
            rows[axis][axis] = factors[axis];
        }
        Self::from_rows(&rows)
    }

    /// Turns about an axis through the origin, counter-clockwise seen against the axis.
    ///
    /// `axis` need not have unit length; `angle_rad` is in radians.
    ///
    /// # Errors
    /// [`Error::NonFinite`], or [`Error::ZeroVector`] for a zero axis.
    pub fn rotation(axis: DVec3, angle_rad: f64) -> Result<Self, Error> {
        finite("rotation angle", angle_rad)?;
        finite("rotation axis", axis.length())?;
        let what = "rotation axis";
        let axis = axis.try_normalize().ok_or(Error::ZeroVector { what })?;
        let (sine, cosine) = angle_rad.sin_cos();
        let mut rows = IDENTITY;
        for (row, unit) in rows.iter_mut().zip([DVec3::X, DVec3::Y, DVec3::Z]) {
            let along = axis * axis.dot(unit);
            let image = along + (unit - along) * cosine + axis.cross(unit) * sine;
            row[..3].copy_from_slice(&image.to_array());
        }
        Self::from_rows(&rows)
    }

    /// The map that does `self` first and `next` afterwards.
    ///
    /// # Errors
    /// [`Error::NonFinite`] on overflow.
    pub fn compose(&self, next: &Self) -> Result<Self, Error> {
        Ok(Self::new(
            self.maps.forward.then(&next.maps.forward).finite()?,
            next.maps.inverse.then(&self.maps.inverse).finite()?,
        ))
    }

    /// The inverse map.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self::new(self.maps.inverse, self.maps.forward)
    }

    /// The image of a point, or `None` if it lies at infinity.
    #[must_use]
    pub fn apply(&self, point: DVec3) -> Option<DVec3> {
        let [x, y, z, w] = apply_rows(&self.maps.forward.rows, point);
        let image = DVec3::new(x, y, z) / w;
        (w != 0.0 && image.is_finite()).then_some(image)
    }

    /// Whether parallel planes stay parallel.
    #[must_use]
    pub fn is_affine(&self) -> bool {
        is_affine(&self.maps.forward.rows)
    }

    /// Rows of the matrix that row vectors are multiplied by.
    #[must_use]
    pub fn to_rows(&self) -> [[f64; 4]; 4] {
        self.maps.forward.rows
    }

    /// Rows of the matrix that multiplies column vectors, as OpenSCAD writes it.
    #[must_use]
    pub fn to_columns(&self) -> [[f64; 4]; 4] {
        matrix::transposed(&self.maps.forward.rows)
    }

    /// The inverse, for row vectors, with its error bound.
    pub(crate) fn bounded_inverse(&self) -> &Bounded {
        &self.maps.inverse
    }
}

/// (x, y, z, 1) M.
pub(crate) fn apply_rows(rows: &Rows, point: DVec3) -> [f64; 4] {
    std::array::from_fn(|j| {
        point.x * rows[0][j] + point.y * rows[1][j] + point.z * rows[2][j] + rows[3][j]
    })
}

/// Whether the last column is (0, 0, 0, w) with w > 0.
pub(crate) fn is_affine(rows: &Rows) -> bool {
    (0..3).all(|i| rows[i][3] == 0.0) && rows[3][3] > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn rows() -> impl Strategy<Value = Rows> {
        proptest::array::uniform4(proptest::array::uniform4(-2.0..2.0))
    }

    #[test]
    fn both_conventions_mean_the_same() {
        let columns = [
            [1.0, 0.0, 0.0, 7.0],
            [0.0, 2.0, 0.0, 8.0],
            [0.0, 0.0, -1.0, 9.0],
            [0.0, 0.0, 0.0, 1.0],
        ];
        let t = Transform::from_columns(&columns).unwrap();
        assert_eq!(t.to_columns(), columns);
        let image = t.apply(DVec3::ONE);
        assert_eq!(image, Some(DVec3::new(8.0, 10.0, 8.0)));
        assert!(t.is_affine());
        assert_eq!(Transform::from_rows(&t.to_rows()), Ok(t));
    }

    #[test]
    fn singular_and_infinite_matrices_are_refused() {
        let flat = Transform::scale(DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(flat, Err(Error::SingularTransform));
        // The last two rows are equal but for rounding.
        let mut rows = IDENTITY;
        rows[2] = [0.1, 0.2, 0.3, 0.0];
        rows[1] = [0.1 * 3.0, 0.2 * 3.0, 0.3 * 3.0, 0.0];
        assert_eq!(Transform::from_rows(&rows), Err(Error::SingularTransform));
        rows[0][0] = f64::INFINITY;
        assert!(matches!(
            Transform::from_rows(&rows),
            Err(Error::NonFinite { .. })
        ));
        assert!(Transform::translation(DVec3::NAN).is_err());
        assert!(matches!(
            Transform::rotation(DVec3::ZERO, 1.0),
            Err(Error::ZeroVector { .. })
        ));
    }

    #[test]
    fn very_unequal_scales_are_not_singular() {
        let t = Transform::scale(DVec3::new(1e-9, 1.0, 1e9)).unwrap();
        assert!((t.inverse().to_rows()[0][0] * 1e-9 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn points_at_infinity_have_no_image() {
        let mut rows = IDENTITY;
        rows[0][3] = 1.0;
        let t = Transform::from_rows(&rows).unwrap();
        assert!(!t.is_affine());
        assert_eq!(t.apply(-DVec3::X), None);
        assert_eq!(t.apply(DVec3::X), Some(DVec3::X / 2.0));
    }

    #[test]
    fn rotation_is_counter_clockwise() {
        let t = Transform::rotation(DVec3::Z * 3.0, std::f64::consts::FRAC_PI_2).unwrap();
        let image = t.apply(DVec3::X).unwrap();
        assert!(image.abs_diff_eq(DVec3::Y, 1e-15));
    }

    proptest! {
        #[test]
        fn composition_does_one_after_the_other(a in rows(), b in rows(), p in proptest::array::uniform3(-1.0..1.0)) {
            let (Ok(a), Ok(b)) = (Transform::from_rows(&a), Transform::from_rows(&b)) else {
                return Ok(());
            };
            let p = DVec3::from(p);
            if let (Some(both), Some(q)) = (a.compose(&b).unwrap().apply(p), a.apply(p).and_then(|q| b.apply(q))) {
                prop_assert!(both.abs_diff_eq(q, 1e-9 * (1.0 + q.length() * q.length())));
            }
        }

        /// The error bound holds against the inverse computed with twice the digits: one step
        /// of Newton's method in exact products.
        #[test]
        fn the_inverse_is_within_its_bound(m in rows()) {
            let Ok(t) = Transform::from_rows(&m) else {
                return Ok(());
            };
            let Bounded { rows: x, error } = *t.bounded_inverse();
            // X (2 − M X) − X = X (1 − M X), with 1 − M X accumulated without rounding error.
            let residual: Rows = std::array::from_fn(|i| std::array::from_fn(|j| {
                let (mut sum, mut rest) = (if i == j { 1.0 } else { 0.0 }, 0.0);
                for k in 0..4 {
                    let product = -m[i][k] * x[k][j];
                    rest += (-m[i][k]).mul_add(x[k][j], -product);
                    let next: f64 = sum + product;
                    let part = next - sum;
                    rest += (sum - (next - part)) + (product - part);
                    sum = next;
                }
                sum + rest
            }));
            let correction = matrix::multiply(&x, &residual);
            for i in 0..4 {
                for j in 0..4 {
                    prop_assert!(correction[i][j].abs() <= error[i][j], "{} > {}", correction[i][j], error[i][j]);
                }
            }
        }
    }
}
