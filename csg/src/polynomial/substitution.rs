//! Linear substitution, and a bound on its rounding error.

use super::{Polynomial, row_start};
use crate::error::Error;

impl Polynomial {
    /// The polynomial `q(X) = self(X M)` with row vectors X = (x, y, z, w).
    ///
    /// When M maps one set of homogeneous coordinates to another, q is `self` written in the
    /// former. Cost: O(n⁴) for scaling with translation along the axes, else O(n⁶ / 180):
    /// microseconds up to degree 6, half a second for degree 64.
    ///
    /// # Errors
    /// [`Error::NonFinite`] if `matrix` is not finite or a coefficient overflows.
    pub fn substituted(&self, matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        let axes_kept = (0..3).all(|i| (0..4).all(|j| i == j || matrix[i][j] == 0.0));
        let q = if axes_kept && self.degree > 2 {
            self.substituted_along_axes(matrix)
        } else {
            self.substituted_by_forms(matrix)
        };
        q.checked()
    }

    /// Horner's scheme in x, in it in y, in it in (z, w), on forms in the new coordinates.
    fn substituted_by_forms(&self, matrix: &[[f64; 4]; 4]) -> Self {
        let n = self.degree;
        let column = |j: usize| [matrix[0][j], matrix[1][j], matrix[2][j], matrix[3][j]];
        let [for_x, for_y, for_z, for_w] = [0, 1, 2, 3].map(column);
        let mut powers_of_w = vec![Self {
            degree: 0,
            coefficients: vec![1.0],
        }];
        for l in 0..n {
            let next = powers_of_w[l].times_linear(for_w);
            powers_of_w.push(next);
        }
        let zero = || Self::zero_of_degree(0);
        // At each level the sum begins at degree 0 and gains one degree with every factor.
        let mut value = zero();
        for i in (0..=n).rev() {
            let mut in_yzw = zero();
            for j in (0..=n - i).rev() {
                let start = row_start(n, i, j);
                let row = &self.coefficients[start..=start + n - i - j];
                let mut in_zw = zero();
                for (l, c) in row.iter().enumerate() {
                    if l > 0 {
                        in_zw = in_zw.times_linear(for_z);
                    }
                    in_zw.add_multiple(*c, &powers_of_w[l]);
                }
                if j < n - i {
                    in_yzw = in_yzw.times_linear(for_y);
                }
                in_yzw.add_multiple(1.0, &in_zw);
            }
            if i < n {
                value = value.times_linear(for_x);
            }
            value.add_multiple(1.0, &in_yzw);
        }
        value
    }

    /// For matrices with nothing but a diagonal and a last row: one scaling, three shifts.
    fn substituted_along_axes(&self, matrix: &[[f64; 4]; 4]) -> Self {
        let n = self.degree;
        let mut q = self.clone();
        // p(s x' + t w') = q(x' + (t/s) w') with q(x') = p(s x'): scale first, then shift.
        let diagonal = [0, 1, 2, 3].map(|axis| matrix[axis][axis]);
        if diagonal.contains(&0.0) {
            return self.substituted_by_forms(matrix);
        }
        let scale: Vec<[f64; 4]> = (0..=n)
            .scan([1.0; 4], |powers, _| {
                let these = *powers;
                for (power, factor) in powers.iter_mut().zip(diagonal) {
                    *power *= factor;
                }
                Some(these)
            })
            .collect();
        for (c, [i, j, k, l]) in q.coefficients.iter_mut().zip(super::exponents(n)) {
            *c *= scale[i][0] * scale[j][1] * scale[k][2] * scale[l][3];
        }
        for (axis, offset) in matrix[3].into_iter().take(3).enumerate() {
            q.shift(axis, offset / diagonal[axis]);
        }
        q
    }

    /// Replaces a coordinate x by x + t·w, in place, by repeated synthetic division.
    fn shift(&mut self, axis: usize, t: f64) {
        if t == 0.0 {
            return;
        }
        let n = self.degree;
        let mut line: Vec<usize> = Vec::with_capacity(n + 1);
        for a in 0..=n {
            for b in 0..=n - a {
                // Fixed exponents a, b of the other two axes; m is left for this axis and w.
                let m = n - a - b;
                line.clear();
                line.extend((0..=m).map(|e| match axis {
                    0 => Self::index(n, e, a, b),
                    1 => Self::index(n, a, e, b),
                    _ => Self::index(n, a, b, e),
                }));
                for lowest in 0..m {
                    for e in (lowest..m).rev() {
                        let above = self.coefficients[line[e + 1]];
                        self.coefficients[line[e]] += t * above;
                    }
                }
            }
        }
    }

    /// `self · (f₀x + f₁y + f₂z + f₃w)`, without a check of the degree.
    fn times_linear(&self, form: [f64; 4]) -> Self {
        let n = self.degree;
        let mut product = Self::zero_of_degree(n + 1);
        let mut at = 0;
        for i in (0..=n).rev() {
            for j in (0..=n - i).rev() {
                let row = &self.coefficients[at..=at + n - i - j];
                at += row.len();
                let starts = [
                    row_start(n + 1, i + 1, j),
                    row_start(n + 1, i, j + 1),
                    row_start(n + 1, i, j),
                    row_start(n + 1, i, j) + 1,
                ];
                for (start, f) in starts.into_iter().zip(form) {
                    if f != 0.0 {
                        let sums = &mut product.coefficients[start..][..row.len()];
                        for (sum, c) in sums.iter_mut().zip(row) {
                            *sum += f * c;
                        }
                    }
                }
            }
        }
        product
    }

    /// Adds a multiple of a form of the same degree.
    fn add_multiple(&mut self, factor: f64, other: &Self) {
        debug_assert_eq!(self.degree, other.degree);
        if factor != 0.0 {
            for (sum, c) in self.coefficients.iter_mut().zip(&other.coefficients) {
                *sum += factor * c;
            }
        }
    }

    /// Bound on the sum of the absolute errors of all coefficients of `self.substituted(matrix)`, when the
    /// entries of `matrix` are uncertain by those of `matrix_error`, and the coefficients of
    /// `self` by a few units in the last place.
    ///
    /// With |p| the polynomial of absolute coefficients and s the column sums of |M|, the
    /// coefficients of |p|(X |M|) sum up to |p|(s), and their sensitivities to the gradient.
    #[must_use]
    pub fn substitution_error(&self, matrix: &[[f64; 4]; 4], matrix_error: &[[f64; 4]; 4]) -> f64 {
        let column_sums = |m: &[[f64; 4]; 4]| -> [f64; 4] {
            std::array::from_fn(|j| m.iter().map(|row| row[j].abs()).sum())
        };
        let (sums, errors) = (column_sums(matrix), column_sums(matrix_error));
        let widened: [f64; 4] = std::array::from_fn(|j| sums[j] + errors[j]);
        let p = self.abs();
        // Each factor of a monomial costs at most five roundings; twice that, to be safe.
        let rounding =
            (10 * self.degree + 16) as f64 * f64::EPSILON * p.evaluate_homogeneous(widened);
        let uncertain = (0..4).filter(|&j| errors[j] > 0.0);
        let spread: f64 = uncertain
            .map(|j| p.derivative(j).evaluate_homogeneous(widened) * errors[j])
            .sum();
        rounding + spread
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::polynomial;
    use super::*;
    use crate::Axis;
    use proptest::prelude::*;

    type Matrix = [[f64; 4]; 4];

    fn matrix() -> impl Strategy<Value = Matrix> {
        proptest::array::uniform4(proptest::array::uniform4(-1.0..1.0))
    }

    fn axis_parallel(mut m: Matrix) -> Matrix {
        for (i, row) in m.iter_mut().enumerate().take(3) {
            *row = std::array::from_fn(|j| if i == j { row[j] } else { 0.0 });
        }
        m
    }

    fn image(x: [f64; 4], m: &Matrix) -> [f64; 4] {
        std::array::from_fn(|j| (0..4).map(|i| x[i] * m[i][j]).sum())
    }

    proptest! {
        /// Values agree to the bound on the coefficients' errors, times their number.
        #[test]
        fn substitution_is_evaluation_at_the_image(
            p in polynomial(7), m in matrix(), x in proptest::array::uniform4(-1.0..1.0), simple: bool,
        ) {
            let m = if simple { axis_parallel(m) } else { m };
            let q = p.substituted(&m).unwrap();
            let bound = 2.0 * p.substitution_error(&m, &[[0.0; 4]; 4]);
            let difference = q.evaluate_homogeneous(x) - p.evaluate_homogeneous(image(x, &m));
            prop_assert!(difference.abs() <= bound, "{difference} > {bound}");
        }

        /// Both algorithms are exact but for rounding, so they check each other's bound.
        #[test]
        fn axis_passes_agree_with_forms(p in polynomial(9), m in matrix()) {
            let m = axis_parallel(m);
            let bound = 2.0 * p.substitution_error(&m, &[[0.0; 4]; 4]);
            let by_axes = p.substituted(&m).unwrap();
            let by_forms = p.substituted_by_forms(&m);
            for (a, b) in by_axes.coefficients.iter().zip(&by_forms.coefficients) {
                prop_assert!((a - b).abs() <= bound);
            }
        }

        /// The bound covers what a change of the matrix within its error does.
        #[test]
        fn uncertain_matrices_are_covered(p in polynomial(4), m in matrix(), e in matrix()) {
            let e: Matrix = e.map(|row| row.map(|v| 1e-9 * v));
            let moved = std::array::from_fn(|i| std::array::from_fn(|j| m[i][j] + e[i][j]));
            let bound = p.substitution_error(&m, &e.map(|row| row.map(f64::abs)));
            let (a, b) = (p.substituted(&m).unwrap(), p.substituted(&moved).unwrap());
            for (a, b) in a.coefficients.iter().zip(&b.coefficients) {
                prop_assert!((a - b).abs() <= 2.0 * bound);
            }
        }
    }

    #[test]
    fn singular_and_zero_matrices_are_substituted_too() {
        let p = Polynomial::variable(Axis::X).power(3).unwrap();
        let mut m = [[0.0; 4]; 4];
        m[3] = [2.0, 0.0, 0.0, 1.0];
        let q = p.substituted(&m).unwrap();
        assert_eq!(q.without_w_factors().coefficients(), [8.0]);
    }

    #[test]
    fn degree_64_is_substituted() {
        let x = Polynomial::variable(Axis::X);
        let p = x.power(64).unwrap();
        let m = [
            [0.5, 0.25, 0.0, 0.0],
            [0.25, 0.5, 0.0, 0.0],
            [0.0, 0.0, 1.0, 0.0],
            [0.25, 0.0, 0.0, 1.0],
        ];
        let q = p.substituted(&m).unwrap();
        // (x/2 + y/4 + w/4)⁶⁴ is 1 at (1, 1, ·, 1).
        assert!((q.evaluate([1.0, 1.0, 0.3].into()) - 1.0).abs() < 1e-12);
    }
}
