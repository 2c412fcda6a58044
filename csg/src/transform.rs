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
