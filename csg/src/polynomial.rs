//! Homogeneous polynomials in (x, y, z, w), which stand for polynomials in (x, y, z) with w = 1.
//!
//! Coefficients are ordered lexicographically by descending exponents (thesis A.2.3), so for
//! degree 2: x², xy, xz, xw, y², yz, yw, z², zw, w². All monomials with the same exponents i of
//! x and j of y stand side by side, by rising exponent of w: such a *row* is a form in (z, w).

mod arithmetic;
mod substitution;

use crate::error::{Error, finite};
use glam::DVec3;

/// The highest degree a [`Polynomial`] may have.
pub const MAX_DEGREE: usize = 64;

/// A coordinate axis of space.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Axis {
    /// The first coordinate.
    X,
    /// The second coordinate.
    Y,
    /// The third coordinate.
    Z,
}

/// A homogeneous polynomial of degree ≤ [`MAX_DEGREE`] in (x, y, z, w) with finite coefficients.
///
/// As the boundary of a half-space it means `p(x, y, z, 1) ≤ 0`: negative is inside.
///
/// ```
/// use csg::Polynomial;
/// // x² − 4xy + 3z² − 5, the example of thesis A.2.3.
/// let p = Polynomial::new(2, vec![1., -4., 0., 0., 0., 0., 0., 3., 0., -5.])?;
/// assert_eq!(p.evaluate([2., 1., 1.].into()), 4. - 8. + 3. - 5.);
/// # Ok::<(), csg::Error>(())
/// ```
#[derive(Clone, PartialEq, Debug)]
pub struct Polynomial {
    degree: usize,
    coefficients: Vec<f64>,
}

impl Polynomial {
    /// Takes all (n+1)(n+2)(n+3)/6 coefficients of degree n, lexicographic, descending.
    ///
    /// # Errors
    /// [`Error::DegreeTooHigh`], [`Error::CoefficientCount`], [`Error::NonFinite`].
    pub fn new(degree: usize, coefficients: Vec<f64>) -> Result<Self, Error> {
        if degree > MAX_DEGREE {
            return Err(Error::DegreeTooHigh { degree });
        }
        let expected = Self::coefficient_count(degree);
        if coefficients.len() != expected {
            let found = coefficients.len();
            return Err(Error::CoefficientCount {
                degree,
                expected,
                found,
            });
        }
        Self {
            degree,
            coefficients,
        }
        .checked()
    }

    /// The polynomial itself if all its coefficients are finite.
    fn checked(self) -> Result<Self, Error> {
        for &c in &self.coefficients {
            finite("polynomial coefficient", c)?;
        }
        Ok(self)
    }

    /// The polynomial of this degree without any term.
    fn zero_of_degree(degree: usize) -> Self {
        Self {
            degree,
            coefficients: vec![0.0; Self::coefficient_count(degree)],
        }
    }

    /// The constant polynomial, of degree 0.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub fn constant(value: f64) -> Result<Self, Error> {
        Self::new(0, vec![value])
    }

    /// One of the coordinates, of degree 1.
    #[must_use]
    pub fn variable(axis: Axis) -> Self {
        let mut p = Self::zero_of_degree(1);
        p.coefficients[axis as usize] = 1.0;
        p
    }

    /// `normal · (x, y, z) − offset`, of degree 1, or of degree 0 if `normal` is zero.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub fn affine(normal: DVec3, offset: f64) -> Result<Self, Error> {
        Ok(Self::new(1, vec![normal.x, normal.y, normal.z, -offset])?.without_w_factors())
    }

    /// The quadratic form `X M Xᵀ` with X = (x, y, z, w); `matrix` need not be symmetric.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub fn quadric(matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        let mut coefficients = Vec::with_capacity(10);
        for (i, row) in matrix.iter().enumerate() {
            coefficients.push(row[i]);
            for (j, column) in matrix.iter().enumerate().skip(i + 1) {
                coefficients.push(row[j] + column[i]);
            }
        }
        Ok(Self::new(2, coefficients)?.without_w_factors())
    }

    /// The form of this degree with these terms `c xⁱ yʲ zᵏ w^l`, given as ([i, j, k], c); equal
    /// monomials are added up.
    ///
    /// # Errors
    /// [`Error::DegreeTooHigh`] also when a monomial exceeds `degree`; [`Error::NonFinite`].
    pub fn from_terms(degree: usize, terms: &[([usize; 3], f64)]) -> Result<Self, Error> {
        if degree > MAX_DEGREE {
            return Err(Error::DegreeTooHigh { degree });
        }
        let mut p = Self::zero_of_degree(degree);
        for &([i, j, k], c) in terms {
            let own = i.saturating_add(j).saturating_add(k);
            if own > degree {
                return Err(Error::DegreeTooHigh { degree: own });
            }
            p.coefficients[Self::index(degree, i, j, k)] += c;
        }
        Ok(p.checked()?.without_w_factors())
    }

    /// The degree of the homogeneous form; a factor wⁿ may hide a lower degree in (x, y, z).
    #[must_use]
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// All coefficients, lexicographic by descending exponents of (x, y, z, w).
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }

    /// Number of coefficients of a form of this degree: (n+1)(n+2)(n+3)/6.
    #[must_use]
    pub fn coefficient_count(degree: usize) -> usize {
        (degree + 1) * (degree + 2) * (degree + 3) / 6
    }

    /// Position of `xⁱ yʲ zᵏ w^(degree−i−j−k)` among the coefficients of a form of this degree.
    ///
    /// # Panics
    /// If i + j + k is above the degree.
    #[must_use]
    pub fn index(degree: usize, i: usize, j: usize, k: usize) -> usize {
        row_start(degree, i, j) + (degree - i - j - k)
    }

    /// All exponents (i, j, k, l) of (x, y, z, w) with their coefficients, in order.
    pub fn terms(&self) -> impl Iterator<Item = ([usize; 4], f64)> + '_ {
        exponents(self.degree).zip(self.coefficients.iter().copied())
    }

    /// Value at a point of space (w = 1). Cost: one multiplication and addition a coefficient.
    #[must_use]
    pub fn evaluate(&self, point: DVec3) -> f64 {
        let mut at = self.coefficients.iter();
        let n = self.degree;
        let mut value = 0.0;
        for i in (0..=n).rev() {
            let mut in_yz = 0.0;
            for j in (0..=n - i).rev() {
                let row = at.by_ref().take(n - i - j + 1);
                let in_z = row.fold(0.0, |sum, c| sum * point.z + c);
                in_yz = in_yz * point.y + in_z;
            }
            value = value * point.x + in_yz;
        }
        value
    }

    /// Value at homogeneous coordinates (x, y, z, w).
    #[must_use]
    pub fn evaluate_homogeneous(&self, point: [f64; 4]) -> f64 {
        let [x, y, z, w] = point;
        let mut at = self.coefficients.iter();
        let n = self.degree;
        let mut value = 0.0;
        for i in (0..=n).rev() {
            let mut in_yz = 0.0;
            for j in (0..=n - i).rev() {
                let row = at.by_ref().take(n - i - j + 1);
                let (in_z, _) = row.fold((0.0, 1.0), |(sum, power), c| {
                    (sum * z + c * power, power * w)
                });
                in_yz = in_yz * y + in_z;
            }
            value = value * x + in_yz;
        }
        value
    }

    /// Derivatives by x, y and z at a point of space (w = 1).
    #[must_use]
    pub fn gradient(&self, point: DVec3) -> DVec3 {
        let mut at = self.coefficients.iter();
        let n = self.degree;
        let (mut value, mut gradient) = (0.0, DVec3::ZERO);
        for i in (0..=n).rev() {
            let (mut in_yz, mut by_y, mut by_z) = (0.0, 0.0, 0.0);
            for j in (0..=n - i).rev() {
                let row = at.by_ref().take(n - i - j + 1);
                let (in_z, row_by_z) = row.fold((0.0, 0.0), |(sum, slope), c| {
                    (sum * point.z + c, slope * point.z + sum)
                });
                by_y = by_y * point.y + in_yz;
                by_z = by_z * point.y + row_by_z;
                in_yz = in_yz * point.y + in_z;
            }
            gradient = gradient * point.x + DVec3::new(value, by_y, by_z);
            value = value * point.x + in_yz;
        }
        gradient
    }

    /// The largest absolute value of a coefficient.
    #[must_use]
    pub fn max_abs(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |m, c| c.abs().max(m))
    }

    /// The same polynomial in (x, y, z) as a form of the lowest possible degree.
    ///
    /// Only terms that are exactly zero are dropped.
    #[must_use]
    pub fn without_w_factors(self) -> Self {
        let mut p = self;
        while p.degree > 0 && p.terms().all(|(e, c)| e[3] > 0 || c == 0.0) {
            let kept = p.terms().filter(|(e, _)| e[3] > 0).map(|(_, c)| c);
            p = Self {
                degree: p.degree - 1,
                coefficients: kept.collect(),
            };
        }
        p
    }
}

/// Position of the first coefficient with exponents i of x and j of y.
fn row_start(degree: usize, i: usize, j: usize) -> usize {
    let without_x = degree - i;
    let without_y = without_x - j;
    without_x * (without_x + 1) * (without_x + 2) / 6 + without_y * (without_y + 1) / 2
}

/// The exponents of (x, y, z, w) of all monomials of a degree, lexicographic, descending.
fn exponents(degree: usize) -> impl Iterator<Item = [usize; 4]> {
    let n = degree;
    (0..=n).rev().flat_map(move |i| {
        (0..=n - i)
            .rev()
            .flat_map(move |j| (0..=n - i - j).map(move |l| [i, j, n - i - j - l, l]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(super) fn polynomial(degree: usize) -> impl Strategy<Value = Polynomial> {
        proptest::collection::vec(-1.0..1.0, Polynomial::coefficient_count(degree))
            .prop_map(move |c| Polynomial::new(degree, c).unwrap())
    }

    pub(super) fn point() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-1.5..1.5).prop_map(DVec3::from)
    }

    #[test]
    fn the_order_is_that_of_the_thesis() {
        let names: Vec<_> = exponents(2).collect();
        let xy = [1, 1, 0, 0];
        assert_eq!(names[0..3], [[2, 0, 0, 0], xy, [1, 0, 1, 0]]);
        assert_eq!(names[9], [0, 0, 0, 2]);
        for degree in 0..8 {
            assert_eq!(
                exponents(degree).count(),
                Polynomial::coefficient_count(degree)
            );
            for (at, [i, j, k, _]) in exponents(degree).enumerate() {
                assert_eq!(Polynomial::index(degree, i, j, k), at);
            }
        }
    }

    #[test]
    fn wrong_input_is_refused() {
        let refused = Polynomial::new(2, vec![0.0; 9]).unwrap_err();
        let expected = Error::CoefficientCount {
            degree: 2,
            expected: 10,
            found: 9,
        };
        assert_eq!(refused, expected);
        let degree = 65;
        assert_eq!(
            Polynomial::new(degree, vec![]).unwrap_err(),
            Error::DegreeTooHigh { degree }
        );
        assert!(matches!(
            Polynomial::constant(f64::NAN),
            Err(Error::NonFinite { .. })
        ));
    }

    #[test]
    fn hidden_degrees_are_found() {
        let m = [
            [0.0; 4],
            [0.0; 4],
            [0.0, 0.0, 0.0, 2.0],
            [0.0, 0.0, 1.0, 5.0],
        ];
        let plane = Polynomial::quadric(&m).unwrap();
        assert_eq!(plane.degree(), 1);
        assert_eq!(plane.coefficients(), [0.0, 0.0, 3.0, 5.0]);
        assert_eq!(Polynomial::affine(DVec3::ZERO, 2.0).unwrap().degree(), 0);
    }

    proptest! {
        /// The oracle is the plain sum of monomials.
        #[test]
        fn evaluation_is_the_sum_of_the_terms(p in polynomial(5), at in point(), w in -1.5..1.5) {
            let x = [at.x, at.y, at.z, w];
            let power = |v: f64, e: usize| (0..e).map(|_| v).product::<f64>();
            let sum = |x: [f64; 4]| -> f64 {
                p.terms().map(|(e, c)| c * (0..4).map(|v| power(x[v], e[v])).product::<f64>()).sum()
            };
            prop_assert!((p.evaluate_homogeneous(x) - sum(x)).abs() < 1e-11);
            prop_assert!((p.evaluate(at) - sum([at.x, at.y, at.z, 1.0])).abs() < 1e-11);
        }

        /// The oracle is a central difference: error h² times third derivatives, plus rounding.
        #[test]
        fn gradient_is_the_slope(p in polynomial(4), at in point()) {
            let h = 1e-5;
            let slope = |d: DVec3| (p.evaluate(at + d * h) - p.evaluate(at - d * h)) / (2.0 * h);
            let difference = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z));
            prop_assert!((p.gradient(at) - difference).length() < 1e-6);
        }
    }
}
