//! Circular cylinders.

use super::slab;
use crate::Polynomial;
use crate::error::{Error, interval, positive};
use glam::DVec3;

/// A circular cylinder about the z axis between two planes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Cylinder {
    radius: f64,
    z0: f64,
    z1: f64,
}

impl Cylinder {
    /// x² + y² ≤ radius², z0 ≤ z ≤ z1.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::NotPositive`], [`Error::EmptyInterval`].
    pub fn new(radius: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        positive("radius", radius)?;
        interval("cylinder in z", z0, z1)?;
        Ok(Self { radius, z0, z1 })
    }

    /// The radius.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// The planes z = z0 and z = z1 that end it.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.z0, self.z1]
    }

    pub(crate) fn half_spaces(&self) -> Result<Vec<Polynomial>, Error> {
        let terms = [
            ([2, 0, 0], 1.0),
            ([0, 2, 0], 1.0),
            ([0, 0, 0], -self.radius * self.radius),
        ];
        let [bottom, top] = slab(self.z0, self.z1)?;
        Ok(vec![Polynomial::from_terms(2, &terms)?, bottom, top])
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        let across = direction.x.hypot(direction.y) * self.radius;
        across + (direction.z * self.z0).max(direction.z * self.z1)
    }
}
