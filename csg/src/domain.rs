//! The cube that is subdivided: a little larger than the solid's extent, and placed so that no
//! lattice plane of the subdivision coincides with a plane of a model with round coordinates.

use crate::Aabb;
use glam::DVec3;

/// An axis-parallel cube in model space; its own coordinates run over [0, 1]³.
///
/// One cube suffices for extents of any proportion: simplices outside the extent are proved empty
/// after a few bisections, so the bintree itself does what a tiling by smaller cubes would do.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Domain {
    origin: DVec3,
    size: f64,
}

/// Ratio of the cube's side to the extent's longest side: enough room for the clip box and for
/// the deviation of facets at the coarsest tolerance, and not a round number.
const MARGIN: f64 = 1.073_618_3;

/// Displacement of the extent's centre from the cube's, in cube sides, different on each axis
/// and far from the dyadic fractions at which lattice planes lie.
const SHIFT: DVec3 = DVec3::new(0.009_173_1, -0.012_951_7, 0.006_837_9);

impl Domain {
    /// The domain for a solid with this extent, which must be finite and not empty.
    #[must_use]
    pub fn around(extent: &Aabb) -> Self {
        let size = (extent.max - extent.min).max_element() * MARGIN;
        let center = (extent.min + extent.max) * 0.5;
        Self {
            origin: center - size * (DVec3::splat(0.5) + SHIFT),
            size,
        }
    }

    /// The corner with the smallest coordinates, in model units.
    #[must_use]
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Length of a side, in model units.
    #[must_use]
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Maps the domain's own coordinates to model space.
    #[must_use]
    pub fn to_model(&self, unit: DVec3) -> DVec3 {
        self.origin + unit * self.size
    }

    /// Maps a point of model space to the domain's own coordinates.
    #[must_use]
    pub fn to_unit(&self, point: DVec3) -> DVec3 {
        (point - self.origin) / self.size
    }
}
