//! Tori.

use crate::Polynomial;
use crate::error::{Error, not_negative, positive};
use glam::DVec3;

/// A torus about the z axis: the points within `tube` of the circle of radius `ring`.
///
/// With ring < tube it crosses itself and its spindle-shaped core belongs to it; with ring = 0
/// it is a ball.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Torus {
    ring: f64,
    tube: f64,
}

impl Torus {
    /// Takes the radius of the circle in the plane z = 0 and the radius of the tube around it.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::Negative`], [`Error::NotPositive`].
    pub fn new(ring: f64, tube: f64) -> Result<Self, Error> {
        not_negative("ring radius", ring)?;
        positive("tube radius", tube)?;
        Ok(Self { ring, tube })
    }

    /// Radius of the circle that the tube follows.
    #[must_use]
    pub fn ring(&self) -> f64 {
        self.ring
    }

    /// Radius of the tube.
    #[must_use]
    pub fn tube(&self) -> f64 {
        self.tube
    }

    /// With ρ² = x² + y², R the ring and r the tube, the quartic is
    /// (ρ² + z² + R² − r²)² − 4R²ρ² = ((ρ − R)² + z² − r²) ((ρ + R)² + z² − r²).
    ///
    /// Where both factors are negative, in the core of a self-crossing torus, it is positive.
    /// The ball of radius √(r² − R²) contains that core and lies in the torus, since there
    /// (ρ − R)² + z² ≤ r² − 2Rρ. The thesis misprints the quartic (A.2.3, SETRD).
    pub(crate) fn half_spaces(&self) -> Result<Vec<Vec<Polynomial>>, Error> {
        let (ring, tube) = (self.ring, self.tube);
        let gap = (ring - tube) * (ring + tube);
        let mut union = Vec::new();
        if ring > 0.0 {
            let across = -2.0 * (ring * ring + tube * tube);
            union.push(vec![Polynomial::from_terms(
                4,
                &[
                    ([4, 0, 0], 1.0),
                    ([2, 2, 0], 2.0),
                    ([2, 0, 2], 2.0),
                    ([0, 4, 0], 1.0),
                    ([0, 2, 2], 2.0),
                    ([0, 0, 4], 1.0),
                    ([2, 0, 0], across),
                    ([0, 2, 0], across),
                    ([0, 0, 2], 2.0 * gap),
                    ([0, 0, 0], gap * gap),
                ],
            )?]);
        }
        if ring < tube {
            let squares = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|e| (e, 1.0));
            let terms = [squares[0], squares[1], squares[2], ([0, 0, 0], gap)];
            union.push(vec![Polynomial::from_terms(2, &terms)?]);
        }
        Ok(union)
    }

    pub(crate) fn half_space_count(&self) -> usize {
        usize::from(self.ring > 0.0) + usize::from(self.ring < self.tube)
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        self.ring * direction.x.hypot(direction.y) + self.tube * direction.length()
    }
}
