//! Whether a polynomial's coefficients leave enough digits to tell where it is zero.
//!
//! High powers, and polynomials written far from where they are used, have coefficients
//! that are much larger than the values between them. How many digits that costs is known in
//! advance: the coefficients' errors sum up to a bound on the values' error, and a grid of values
//! tells how large those usually are.

use crate::{Error, Imprecise, Primitive, PrimitiveId};
use glam::DVec3;

/// Values that are less certain than this, relative to their usual size, are reported.
const SUSPICIOUS: f64 = 1e-6;

/// What is less certain than this is no surface.
const HOPELESS: f64 = 0.1;

/// Values on a grid of so many points a side are looked at.
const SIDE: u32 = 5;

/// Primitives that have lost too many digits.
///
/// # Errors
/// [`Error::NoDigitsLeft`].
pub(crate) fn imprecise(primitives: &[Primitive]) -> Result<Vec<Imprecise>, Error> {
    let mut found = Vec::new();
    for (id, primitive) in (0..).map(PrimitiveId).zip(primitives) {
        let uncertainty = uncertainty(primitive);
        if uncertainty > HOPELESS {
            return Err(Error::NoDigitsLeft {
                degree: primitive.polynomial.degree(),
                uncertainty,
            });
        }
        if uncertainty > SUSPICIOUS {
            found.push(Imprecise {
                primitive: id,
                uncertainty,
            });
        }
    }
    Ok(found)
}

/// Bound on the error of the values in the domain, relative to the size that three quarters of
/// them exceed.
fn uncertainty(primitive: &Primitive) -> f64 {
    let polynomial = &primitive.polynomial;
    let sum: f64 = polynomial.coefficients().iter().map(|c| c.abs()).sum();
    // Coefficients, conversion to Bernstein form, and as much again for subdivision.
    let rounding = (12 * (polynomial.degree() + 6)) as f64 * f64::EPSILON * sum;
    let error = primitive.coefficient_error + rounding;
    let at = |n: u32| (2.0 * f64::from(n) + 1.0) / f64::from(SIDE) - 1.0;
    let mut values = Vec::with_capacity((SIDE * SIDE * SIDE) as usize);
    for n in 0..SIDE * SIDE * SIDE {
        let point = DVec3::new(at(n % SIDE), at(n / SIDE % SIDE), at(n / SIDE / SIDE));
        values.push(polynomial.evaluate(point).abs());
    }
    values.sort_unstable_by(f64::total_cmp);
    error / values[values.len() / 4]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Polynomial;

    /// (x − 1)ⁿ, written out: its coefficients sum up to 2ⁿ, most of its values are far below.
    #[test]
    fn cancelling_coefficients_are_noticed() {
        let x = Polynomial::affine(DVec3::X, -1.0).unwrap();
        let mut uncertain = Vec::new();
        for power in [2, 20, 60] {
            let polynomial = x.power(power).unwrap();
            uncertain.push(uncertainty(&Primitive {
                polynomial,
                coefficient_error: 0.0,
            }));
        }
        assert!(uncertain[0] < 1e-12);
        // Three in five values are at most 1: the quarter lies at (3/5)ⁿ or below.
        let expected = |n: f64, at: f64| 12.0 * (n + 6.0) * f64::EPSILON * (2.0 / at).powf(n);
        assert!((uncertain[1] / expected(20.0, 0.6) - 1.0).abs() < 0.01);
        // Here even the values that it is compared with are noise.
        assert!(uncertain[2] > HOPELESS);
    }
}
