//! Circular cones and their frustums.

use super::slab;
use crate::Polynomial;
use crate::error::{Error, interval, not_negative};
use glam::DVec3;

/// A circular cone or frustum about the z axis between two planes.
///
/// The radius is nowhere negative between the planes, so they select the right nappe.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Frustum {
    r0: f64,
    r1: f64,
    z0: f64,
    z1: f64,
}

impl Frustum {
    /// Radius r0 at z0, r1 at z1, either of which may be 0, but not both.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::Negative`], [`Error::NotPositive`] when both radii are 0,
    /// [`Error::EmptyInterval`].
    pub fn new(r0: f64, r1: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        not_negative("radius", r0)?;
        not_negative("radius", r1)?;
        crate::error::positive("larger radius", r0.max(r1))?;
        interval("cone in z", z0, z1)?;
        Ok(Self { r0, r1, z0, z1 })
    }

    /// The radii at the two ends.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        [self.r0, self.r1]
    }

    /// The planes z = z0 and z = z1 that end it.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.z0, self.z1]
    }

    /// `x² + y² ≤ (slope · z + at_zero)²`.
    pub(crate) fn half_spaces(&self) -> Result<Vec<Polynomial>, Error> {
        let height = self.z1 - self.z0;
        let slope = (self.r1 - self.r0) / height;
        let at_zero = (self.r0 * self.z1 - self.r1 * self.z0) / height;
        let terms = [
            ([2, 0, 0], 1.0),
            ([0, 2, 0], 1.0),
            ([0, 0, 2], -slope * slope),
            ([0, 0, 1], -2.0 * slope * at_zero),
            ([0, 0, 0], -at_zero * at_zero),
        ];
        let [bottom, top] = slab(self.z0, self.z1)?;
        Ok(vec![Polynomial::from_terms(2, &terms)?, bottom, top])
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        let across = direction.x.hypot(direction.y);
        let low = across * self.r0 + direction.z * self.z0;
        let high = across * self.r1 + direction.z * self.z1;
        low.max(high)
    }
}
