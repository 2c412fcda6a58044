//! Ellipsoids and spheres.

use crate::Polynomial;
use crate::error::{Error, positive};
use glam::DVec3;

/// An ellipsoid about the origin with axes along the coordinate axes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Ellipsoid {
    radii: DVec3,
}

impl Ellipsoid {
    /// Takes the three semi-axes.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::NotPositive`].
    pub fn new(radii: DVec3) -> Result<Self, Error> {
        for radius in radii.to_array() {
            positive("radius", radius)?;
        }
        Ok(Self { radii })
    }

    /// The semi-axes.
    #[must_use]
    pub fn radii(&self) -> DVec3 {
        self.radii
    }

    /// (x/a)² + (y/b)² + (z/c)² − 1, times the square of the largest semi-axis.
    pub(crate) fn polynomial(&self) -> Result<Polynomial, Error> {
        let largest = self.radii.max_element();
        let [a, b, c] = self.radii.to_array().map(|r| (largest / r) * (largest / r));
        let terms = [
            ([2, 0, 0], a),
            ([0, 2, 0], b),
            ([0, 0, 2], c),
            ([0, 0, 0], -largest * largest),
        ];
        Polynomial::from_terms(2, &terms)
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        (self.radii * direction).length()
    }
}
