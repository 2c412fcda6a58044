//! The cube that is subdivided: a little larger than the solid's extent, and placed so that no
//! lattice plane of the subdivision coincides with a plane of a model with round coordinates.

use crate::Aabb;
use glam::DVec3;

/// An axis-parallel cube in model space.
///
/// Positions of the subdivision are given in unit coordinates, 0 to 1 from corner to corner;
/// polynomials in centred ones, −1 to 1, in which powers do not cancel.
///
/// One cube suffices for extents of any proportion: simplices outside the extent are proved empty
/// after a few bisections, so the bintree itself does what a tiling by smaller cubes would do.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Domain {
    center: DVec3,
    half: f64,
}

/// How much larger than a solid's extent its domain is, and where in it the extent lies.
///
/// The result of a conversion depends on it as it depends on rounding: in the mesh, and in what
/// becomes of surfaces that touch. Proved topology does not.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct DomainFit {
    margin: f64,
    shift: DVec3,
}

impl DomainFit {
    /// `margin`: ratio of the cube's side to the extent's longest side; `shift`: displacement of
    /// the extent's centre from the cube's, in cube sides. `None` unless at least 1 % of the side
    /// is left around the extent. Neither should be a round number.
    #[must_use]
    pub fn new(margin: f64, shift: DVec3) -> Option<Self> {
        let room = 0.5 * (1.0 - 1.0 / margin) - shift.abs().max_element();
        (margin.is_finite() && room >= 0.01).then_some(Self { margin, shift })
    }
}

impl Default for DomainFit {
    /// Enough room for the clip box and for the deviation of facets at the coarsest tolerance;
    /// shifts that are different on each axis and far from the dyadic fractions at which lattice
    /// planes lie.
    fn default() -> Self {
        Self {
            margin: 1.073_618_3,
            shift: DVec3::new(0.009_173_1, -0.012_951_7, 0.006_837_9),
        }
    }
}

impl Domain {
    /// The usual domain for a solid with this extent, which must be finite and not empty.
    #[must_use]
    pub fn around(extent: &Aabb) -> Self {
        Self::fitted(extent, DomainFit::default())
    }

    /// A domain for a solid with this extent, which must be finite and not empty.
    #[must_use]
    pub fn fitted(extent: &Aabb, fit: DomainFit) -> Self {
        let size = (extent.max - extent.min).max_element() * fit.margin;
        let center = (extent.min + extent.max) * 0.5;
        Self {
            center: center - size * fit.shift,
            half: 0.5 * size,
        }
    }

    /// The corner with the smallest coordinates, in model units.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.center - self.half
    }

    /// The middle, in model units.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Half the length of a side, in model units.
    #[must_use]
    pub fn half_size(&self) -> f64 {
        self.half
    }

    /// Length of a side, in model units.
    #[must_use]
    pub fn size(&self) -> f64 {
        2.0 * self.half
    }

    /// Maps unit coordinates to model space.
    #[must_use]
    pub fn from_unit(&self, unit: DVec3) -> DVec3 {
        self.from_centered(2.0 * unit - 1.0)
    }

    /// Maps centred coordinates to model space.
    #[must_use]
    pub fn from_centered(&self, centered: DVec3) -> DVec3 {
        self.center + centered * self.half
    }

    /// Maps a point of model space to centred coordinates.
    #[must_use]
    pub fn to_centered(&self, point: DVec3) -> DVec3 {
        (point - self.center) / self.half
    }
}
