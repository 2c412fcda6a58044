//! The helicoid of the thesis.

use super::slab;
use crate::Polynomial;
use crate::error::Error;
use glam::DVec3;

/// The thesis' helicoid: half of the cylinder x² + y² ≤ 1, 0 ≤ z ≤ 1, below a surface that turns
/// half about the z axis from bottom to top.
///
/// SEHEL ∩ SECIL ∩ SEPZ0 ∩ SEPZ1 of thesis A.2.3, where SEHEL approximates the transcendental
/// surface by a quartic.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Helicoid;

/// The thesis' coefficient of (z − ½)³ in SEHEL.
const CUBIC: f64 = 2.265_481_6;

impl Helicoid {
    /// x (4u² − 1) + y u (CUBIC u² − π) with u = z − ½, multiplied out.
    fn surface() -> Result<Polynomial, Error> {
        use std::f64::consts::PI;
        let terms = [
            ([1, 0, 2], 4.0),
            ([1, 0, 1], -4.0),
            ([0, 1, 3], CUBIC),
            ([0, 1, 2], -1.5 * CUBIC),
            ([0, 1, 1], 0.75 * CUBIC - PI),
            ([0, 1, 0], 0.5 * PI - 0.125 * CUBIC),
        ];
        Polynomial::from_terms(4, &terms)
    }

    pub(crate) fn half_spaces() -> Result<Vec<Polynomial>, Error> {
        let circle = [([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 0], -1.0)];
        let [bottom, top] = slab(0.0, 1.0)?;
        let cylinder = Polynomial::from_terms(2, &circle)?;
        Ok(vec![Self::surface()?, cylinder, bottom, top])
    }

    /// That of the whole cylinder, every side of which the turning surface reaches.
    pub(crate) fn support(direction: DVec3) -> f64 {
        direction.x.hypot(direction.y) + direction.z.max(0.0)
    }
}
