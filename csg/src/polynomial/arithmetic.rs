//! Sums, products and powers. Results have the lowest degree that exact zeros allow.

use super::{MAX_DEGREE, Polynomial, exponents, row_start};
use crate::error::Error;

impl Polynomial {
    /// The same polynomial in (x, y, z) as a form of a degree that is not lower: times powers of w.
    fn raised(&self, degree: usize) -> Self {
        let mut p = Self::zero_of_degree(degree);
        for ([i, j, k, _], c) in self.terms() {
            p.coefficients[Self::index(degree, i, j, k)] = c;
        }
        p
    }

    /// `self + other`, as polynomials in (x, y, z).
    ///
    /// # Errors
    /// [`Error::NonFinite`] on overflow.
    pub fn sum(&self, other: &Self) -> Result<Self, Error> {
        let degree = self.degree.max(other.degree);
        let mut p = self.raised(degree);
        for (c, d) in p
            .coefficients
            .iter_mut()
            .zip(other.raised(degree).coefficients)
        {
            *c += d;
        }
        Ok(p.checked()?.without_w_factors())
    }

    /// `self − other`, as polynomials in (x, y, z).
    ///
    /// # Errors
    /// [`Error::NonFinite`] on overflow.
    pub fn difference(&self, other: &Self) -> Result<Self, Error> {
        self.sum(&other.clone().negated())
    }

    /// `self · other`. Cost: the product of the numbers of coefficients.
    ///
    /// # Errors
    /// [`Error::DegreeTooHigh`], and [`Error::NonFinite`] on overflow.
    pub fn product(&self, other: &Self) -> Result<Self, Error> {
        let degree = self.degree + other.degree;
        if degree > MAX_DEGREE {
            return Err(Error::DegreeTooHigh { degree });
        }
        let mut p = Self::zero_of_degree(degree);
        for (i, j, row) in self.rows() {
            for (other_i, other_j, other_row) in other.rows() {
                let start = row_start(degree, i + other_i, j + other_j);
                for (at, c) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                    let sums = &mut p.coefficients[start + at..][..other_row.len()];
                    for (sum, d) in sums.iter_mut().zip(other_row) {
                        *sum += c * d;
                    }
                }
            }
        }
        Ok(p.checked()?.without_w_factors())
    }

    /// `self` to a power that is a natural number; the power 0 is 1.
    ///
    /// # Errors
    /// [`Error::DegreeTooHigh`], and [`Error::NonFinite`] on overflow.
    pub fn power(&self, exponent: u32) -> Result<Self, Error> {
        let degree = self.degree.saturating_mul(exponent as usize);
        if degree > MAX_DEGREE {
            return Err(Error::DegreeTooHigh { degree });
        }
        let mut p = Self::constant(1.0)?;
        for bit in (0..u32::BITS - exponent.leading_zeros()).rev() {
            p = p.product(&p)?;
            if exponent >> bit & 1 == 1 {
                p = p.product(self)?;
            }
        }
        Ok(p)
    }

    /// `−self`: the half-space on the other side.
    #[must_use]
    pub fn negated(mut self) -> Self {
        for c in &mut self.coefficients {
            *c = -*c;
        }
        self
    }

    /// `factor · self`.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if `factor` is not finite or a product overflows.
    pub fn scaled(mut self, factor: f64) -> Result<Self, Error> {
        for c in &mut self.coefficients {
            *c *= factor;
        }
        Ok(self.checked()?.without_w_factors())
    }

    /// The rows (i, j, coefficients by rising exponent of w), in order.
    fn rows(&self) -> impl Iterator<Item = (usize, usize, &[f64])> {
        let n = self.degree;
        let of_y = move |i| (0..=n - i).rev().map(move |j| (i, j));
        (0..=n).rev().flat_map(of_y).map(move |(i, j)| {
            let start = row_start(n, i, j);
            (i, j, &self.coefficients[start..=start + n - i - j])
        })
    }

    /// The polynomial whose coefficients are the absolute values of these.
    #[must_use]
    pub fn abs(&self) -> Self {
        Self {
            degree: self.degree,
            coefficients: self.coefficients.iter().map(|c| c.abs()).collect(),
        }
    }

    /// Derivative by one of the homogeneous coordinates (0: x, 1: y, 2: z, 3: w).
    #[must_use]
    pub fn derivative(&self, coordinate: usize) -> Self {
        if self.degree == 0 {
            return Self::zero_of_degree(0);
        }
        let degree = self.degree - 1;
        let of = |mut e: [usize; 4]| {
            e[coordinate] += 1;
            e[coordinate] as f64 * self.coefficients[Self::index(self.degree, e[0], e[1], e[2])]
        };
        Self {
            degree,
            coefficients: exponents(degree).map(of).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{point, polynomial};
    use super::*;
    use crate::Axis;
    use proptest::prelude::*;

    #[test]
    fn cancelled_leading_terms_lower_the_degree() {
        let x = Polynomial::variable(Axis::X);
        let one = Polynomial::constant(1.0).unwrap();
        let square = x.sum(&one).unwrap().power(2).unwrap();
        let rest = square.difference(&x.power(2).unwrap()).unwrap();
        assert_eq!(rest.degree(), 1);
        assert_eq!(rest.coefficients(), [2.0, 0.0, 0.0, 1.0]);
        assert_eq!(rest.difference(&rest).unwrap().degree(), 0);
    }

    #[test]
    fn degree_64_is_reached_and_not_passed() {
        let terms = [Axis::X, Axis::Y, Axis::Z].map(Polynomial::variable);
        let one = Polynomial::constant(1.0).unwrap();
        let sum = terms.iter().fold(one, |sum, v| sum.sum(v).unwrap());
        let p = sum.power(64).unwrap();
        assert_eq!(p.coefficients().len(), 47905);
        // 64!/(16!)^4 is the multinomial coefficient of x¹⁶y¹⁶z¹⁶w¹⁶.
        let multinomial = (1..=16).fold(1.0, |m, k: i32| {
            let k = f64::from(k);
            m * (k + 16.0) * (k + 32.0) * (k + 48.0) / (k * k * k)
        });
        let middle = p.coefficients()[Polynomial::index(64, 16, 16, 16)];
        assert!((middle / multinomial - 1.0).abs() < 1e-12);
        assert_eq!(
            p.product(&sum).unwrap_err(),
            Error::DegreeTooHigh { degree: 65 }
        );
        assert!(sum.power(u32::MAX).is_err());
    }

    #[test]
    fn overflow_is_an_error() {
        let big = Polynomial::constant(1e300).unwrap();
        assert!(matches!(big.product(&big), Err(Error::NonFinite { .. })));
        assert!(matches!(big.scaled(1e300), Err(Error::NonFinite { .. })));
    }

    proptest! {
        #[test]
        fn operations_agree_with_those_of_the_values(p in polynomial(3), q in polynomial(4), at in point()) {
            let (a, b) = (p.evaluate(at), q.evaluate(at));
            prop_assert!((p.sum(&q).unwrap().evaluate(at) - (a + b)).abs() < 1e-11);
            prop_assert!((p.difference(&q).unwrap().evaluate(at) - (a - b)).abs() < 1e-11);
            prop_assert!((p.product(&q).unwrap().evaluate(at) - a * b).abs() < 1e-8);
            prop_assert!((p.power(3).unwrap().evaluate(at) - a * a * a).abs() < 1e-7);
            prop_assert!((p.clone().negated().evaluate(at) + a).abs() < 1e-15);
            let slope = p.derivative(1).evaluate(at);
            prop_assert!((slope - p.gradient(at).y).abs() < 1e-10);
        }
    }
}
