//! Regular polygonal prisms, pyramids and frustums: OpenSCAD's cylinders with an explicit `$fn`.

use super::slab;
use crate::Polynomial;
use crate::error::{Error, interval, not_negative, positive};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_SQRT_2, TAU};

/// A regular polygonal prism, pyramid or frustum about the z axis between two planes.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Prism {
    sides: u32,
    r0: f64,
    r1: f64,
    z0: f64,
    z1: f64,
}

impl Prism {
    /// Regular polygons with their first vertex on the positive x side and circumscribed radius
    /// r0 at z0, r1 at z1; either may be 0 (an apex), but not both.
    ///
    /// # Errors
    /// [`Error::TooFewSides`], [`Error::NonFinite`], [`Error::Negative`],
    /// [`Error::NotPositive`] when both radii are 0, [`Error::EmptyInterval`].
    pub fn new(sides: u32, r0: f64, r1: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        if sides < 3 {
            return Err(Error::TooFewSides { sides });
        }
        not_negative("radius", r0)?;
        not_negative("radius", r1)?;
        positive("larger radius", r0.max(r1))?;
        interval("prism in z", z0, z1)?;
        Ok(Self {
            sides,
            r0,
            r1,
            z0,
            z1,
        })
    }

    /// Number of side faces.
    #[must_use]
    pub fn sides(&self) -> u32 {
        self.sides
    }

    /// Circumscribed radii at the two ends.
    #[must_use]
    pub fn radii(&self) -> [f64; 2] {
        [self.r0, self.r1]
    }

    /// The planes z = z0 and z = z1 that end it.
    #[must_use]
    pub fn ends(&self) -> [f64; 2] {
        [self.z0, self.z1]
    }

    /// The side between vertices v and v' lies in m · (x, y) = |m|² r(z) with m = (v + v')/2 on
    /// the unit circle and r the radius, linear in z.
    pub(crate) fn half_spaces(&self) -> Result<Vec<Polynomial>, Error> {
        let height = self.z1 - self.z0;
        let slope = (self.r1 - self.r0) / height;
        let at_zero = (self.r0 * self.z1 - self.r1 * self.z0) / height;
        let mut planes = Vec::with_capacity(self.sides as usize + 2);
        for side in 0..self.sides {
            let middle = self.direction(2 * u64::from(side) + 1);
            let apothem = self.direction(1).x;
            let normal = middle.extend(-apothem * slope);
            planes.push(Polynomial::affine(normal, apothem * at_zero)?);
        }
        planes.extend(slab(self.z0, self.z1)?);
        Ok(planes)
    }

    /// The unit vector after this many half steps; exact on the axes, mirror-symmetric bits.
    fn direction(&self, half_steps: u64) -> DVec2 {
        let whole = 2 * u64::from(self.sides);
        // Eighths of a turn: reduce to the first one, so that sin and cos see the same argument.
        let at = half_steps % whole;
        let octant = 8 * at / whole;
        let rest = match octant % 2 {
            0 => 8 * at - octant * whole,
            _ => (octant + 1) * whole - 8 * at,
        };
        let (short, long) = if rest == whole {
            (FRAC_1_SQRT_2, FRAC_1_SQRT_2)
        } else {
            (rest as f64 / (8 * whole) as f64 * TAU).sin_cos()
        };
        match octant {
            0 => DVec2::new(long, short),
            1 => DVec2::new(short, long),
            2 => DVec2::new(-short, long),
            3 => DVec2::new(-long, short),
            4 => DVec2::new(-long, -short),
            5 => DVec2::new(-short, -long),
            6 => DVec2::new(short, -long),
            _ => DVec2::new(long, -short),
        }
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        let vertices = (0..u64::from(self.sides)).map(|side| self.direction(2 * side));
        let across = vertices.map(|v| v.dot(direction.truncate()));
        let across = across.fold(f64::NEG_INFINITY, f64::max);
        let low = across * self.r0 + direction.z * self.z0;
        let high = across * self.r1 + direction.z * self.z1;
        low.max(high)
    }
}
