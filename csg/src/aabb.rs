//! Axis-parallel bounding boxes, possibly empty or unbounded.

use glam::DVec3;

/// An axis-parallel box; empty when some `min` exceeds its `max`, and possibly infinite.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Aabb {
    /// Smallest coordinates.
    pub min: DVec3,
    /// Largest coordinates.
    pub max: DVec3,
}

impl Aabb {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// All of space.
    pub const EVERYWHERE: Self = Self {
        min: DVec3::NEG_INFINITY,
        max: DVec3::INFINITY,
    };

    /// Whether no point lies inside.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether all coordinates are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.min.is_finite() && self.max.is_finite()
    }

    /// The smallest box that contains both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// The points that both contain.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        let both = Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        };
        if both.is_empty() { Self::EMPTY } else { both }
    }

    /// Length of the diagonal, in model units.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        (self.max - self.min).length()
    }
}
