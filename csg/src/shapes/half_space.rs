//! Linear half-spaces.

use crate::Polynomial;
use crate::bounds::Support;
use crate::error::{Error, finite};
use glam::DVec3;

/// All points on one side of a plane.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct HalfSpace {
    normal: DVec3,
    offset: f64,
}

impl HalfSpace {
    /// `normal · x ≤ offset`; `normal` points out and need not have unit length.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::ZeroVector`].
    pub fn new(normal: DVec3, offset: f64) -> Result<Self, Error> {
        finite("plane offset", offset)?;
        finite("plane normal", normal.length())?;
        if normal == DVec3::ZERO {
            let what = "plane normal";
            return Err(Error::ZeroVector { what });
        }
        Ok(Self { normal, offset })
    }

    /// The outward normal.
    #[must_use]
    pub fn normal(&self) -> DVec3 {
        self.normal
    }

    /// Value of `normal · x` on the plane.
    #[must_use]
    pub fn offset(&self) -> f64 {
        self.offset
    }

    pub(crate) fn polynomial(&self) -> Result<Polynomial, Error> {
        Polynomial::affine(self.normal, self.offset)
    }

    pub(crate) fn support(&self) -> Support<'static> {
        Support::half_space(self.normal, self.offset)
    }

    pub(crate) fn complement_support(&self) -> Support<'static> {
        Support::half_space(-self.normal, -self.offset)
    }
}
