//! Axis-parallel boxes.

use crate::Polynomial;
use crate::error::{Error, interval};
use glam::DVec3;

/// An axis-parallel box.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Block {
    min: DVec3,
    max: DVec3,
}

impl Block {
    /// The box between two corners.
    ///
    /// # Errors
    /// [`Error::NonFinite`], or [`Error::EmptyInterval`] unless `min` is below `max` on each axis.
    pub fn new(min: DVec3, max: DVec3) -> Result<Self, Error> {
        for axis in 0..3 {
            let what = ["block in x", "block in y", "block in z"][axis];
            interval(what, min[axis], max[axis])?;
        }
        Ok(Self { min, max })
    }

    /// The corner with the smallest coordinates.
    #[must_use]
    pub fn min(&self) -> DVec3 {
        self.min
    }

    /// The corner with the largest coordinates.
    #[must_use]
    pub fn max(&self) -> DVec3 {
        self.max
    }

    pub(crate) fn half_spaces(&self) -> Result<Vec<Polynomial>, Error> {
        let mut planes = Vec::with_capacity(6);
        for (axis, normal) in DVec3::AXES.into_iter().enumerate() {
            planes.push(Polynomial::affine(-normal, -self.min[axis])?);
            planes.push(Polynomial::affine(normal, self.max[axis])?);
        }
        Ok(planes)
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        (direction * self.min)
            .max(direction * self.max)
            .element_sum()
    }
}
