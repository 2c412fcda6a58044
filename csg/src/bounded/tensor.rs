//! Tensor product Bernstein form of a polynomial over a box.

use crate::Polynomial;

/// The part that a homogeneous coordinate plays in a chart.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Role {
    /// It is fixed.
    Fixed(f64),
    /// It is the variable of this number and runs over [−1, 1].
    Symmetric(usize),
    /// It is the variable of this number and runs over [0, 1].
    Unit(usize),
}

/// Bernstein coefficients over a box; the last index runs fastest.
#[derive(Clone, Debug)]
pub(super) struct Tensor {
    degrees: [usize; 3],
    coefficients: Vec<f64>,
}

impl Tensor {
    /// The polynomial over the box that the roles of (x, y, z, w) describe.
    pub(super) fn new(p: &Polynomial, chart: [Role; 4]) -> Self {
        let mut variables = [(0, false); 3];
        for (coordinate, role) in chart.iter().enumerate() {
            match *role {
                Role::Fixed(_) => {}
                Role::Symmetric(v) => variables[v] = (coordinate, true),
                Role::Unit(v) => variables[v] = (coordinate, false),
            }
        }
        let terms = || p.terms().filter(|(_, c)| *c != 0.0);
        let degrees = variables.map(|(coordinate, _)| {
            let exponents = terms().map(|(e, _)| e[coordinate]);
            exponents.max().unwrap_or(0)
        });
        let size = degrees.iter().map(|n| n + 1).product();
        let mut tensor = Self {
            degrees,
            coefficients: vec![0.0; size],
        };
        for (e, c) in terms() {
            let fixed = chart.iter().zip(e).map(|(role, e)| match *role {
                Role::Fixed(value) if e % 2 == 1 => value.signum(),
                _ => 1.0,
            });
            let at = variables.iter().zip(degrees);
            let at = at.fold(0, |at, ((v, _), n)| at * (n + 1) + e[*v]);
            tensor.coefficients[at] += c * fixed.product::<f64>();
        }
        for (axis, (_, symmetric)) in variables.into_iter().enumerate() {
            tensor.change_basis(axis, symmetric);
        }
        tensor
    }

    /// Multiplications that making it cost.
    pub(super) fn work(&self) -> u64 {
        let rows: usize = self.degrees.iter().map(|n| n + 1).sum();
        (self.coefficients.len() * rows) as u64
    }

    /// Multiplications that halving it costs.
    pub(super) fn halving_work(&self, axis: usize) -> u64 {
        (self.coefficients.len() * (self.degrees[axis] + 4) / 2) as u64
    }

    /// Smallest and largest coefficient, which enclose the values over the box.
    pub(super) fn range(&self) -> (f64, f64) {
        let start = (f64::INFINITY, f64::NEG_INFINITY);
        let all = self.coefficients.iter();
        all.fold(start, |(low, high), c| (low.min(*c), high.max(*c)))
    }

    /// Bound on the change along each axis, relative to the largest coefficient.
    pub(super) fn variation(&self) -> [f64; 3] {
        let (low, high) = self.range();
        let scale = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
        [0, 1, 2].map(|axis| {
            let n = self.degrees[axis];
            let stride = self.stride(axis);
            let mut steps: f64 = 0.0;
            for start in self.fibers(axis) {
                for i in 0..n {
                    let here = self.coefficients[start + i * stride];
                    let next = self.coefficients[start + (i + 1) * stride];
                    steps = steps.max((next - here).abs());
                }
            }
            steps * n as f64 / scale
        })
    }

    /// The two halves of the box along an axis, lower one first.
    pub(super) fn halves(&self, axis: usize) -> [Self; 2] {
        let n = self.degrees[axis];
        let stride = self.stride(axis);
        let (mut low, mut high) = (self.clone(), self.clone());
        for start in self.fibers(axis) {
            for level in 0..n {
                low.coefficients[start + level * stride] = high.coefficients[start];
                for i in 0..n - level {
                    let at = start + i * stride;
                    high.coefficients[at] =
                        0.5 * (high.coefficients[at] + high.coefficients[at + stride]);
                }
            }
            low.coefficients[start + n * stride] = high.coefficients[start];
        }
        [low, high]
    }

    fn stride(&self, axis: usize) -> usize {
        self.degrees[axis + 1..].iter().map(|n| n + 1).product()
    }

    /// Where the lines of coefficients along an axis begin.
    fn fibers(&self, axis: usize) -> impl Iterator<Item = usize> + use<> {
        let stride = self.stride(axis);
        let block = stride * (self.degrees[axis] + 1);
        let outer = self.coefficients.len() / block;
        (0..outer).flat_map(move |o| (0..stride).map(move |inner| o * block + inner))
    }

    /// Changes the basis along an axis from powers to Bernstein polynomials.
    fn change_basis(&mut self, axis: usize, symmetric: bool) {
        let n = self.degrees[axis];
        let basis = powers_in_bernstein(n, symmetric);
        let stride = self.stride(axis);
        let mut line = vec![0.0; n + 1];
        for start in self.fibers(axis) {
            for (k, value) in line.iter_mut().enumerate() {
                *value = self.coefficients[start + k * stride];
            }
            for (i, row) in basis.iter().enumerate() {
                let sum = row.iter().zip(&line).map(|(b, c)| b * c).sum();
                self.coefficients[start + i * stride] = sum;
            }
        }
    }
}

/// Coefficient i of the Bernstein form of degree n of u^k, in row i and column k.
///
/// It is the mean of all products of k of the n arguments of the blossom, i of which are the
/// upper end of the interval and the rest the lower end, so at most 1 in size. Computed exactly
/// in integers before the division.
fn powers_in_bernstein(n: usize, symmetric: bool) -> Vec<Vec<f64>> {
    let times = |polynomial: &mut Vec<i128>, sign: i128| {
        polynomial.push(0);
        for k in (1..polynomial.len()).rev() {
            polynomial[k] += sign * polynomial[k - 1];
        }
    };
    let expand = |plus: usize, minus: usize| {
        let mut product = vec![1_i128];
        (0..plus).for_each(|_| times(&mut product, 1));
        (0..minus).for_each(|_| times(&mut product, -1));
        product.resize(n + 1, 0);
        product
    };
    let binomials = expand(n, 0);
    let row = |i: usize| {
        let sums = expand(i, if symmetric { n - i } else { 0 });
        let means = sums.iter().zip(&binomials);
        means
            .map(|(sum, count)| *sum as f64 / *count as f64)
            .collect()
    };
    (0..=n).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The corners of the box are among the coefficients, and all values between them.
        #[test]
        fn halves_enclose_the_values(
            c in proptest::collection::vec(-1.0..1.0, 35),
            at in proptest::array::uniform3(-1.0..1.0),
        ) {
            let p = Polynomial::new(4, c).unwrap();
            let chart = [Role::Symmetric(0), Role::Symmetric(1), Role::Symmetric(2), Role::Fixed(1.0)];
            let mut tensor = Tensor::new(&p, chart);
            let value = p.evaluate(at.into());
            let mut box_ = [(-1.0, 1.0); 3];
            for step in 0..24 {
                let (low, high) = tensor.range();
                prop_assert!(low <= value + 1e-12 && value <= high + 1e-12);
                let axis = step % 3;
                let middle = 0.5 * (box_[axis].0 + box_[axis].1);
                let [lower, upper] = tensor.halves(axis);
                if at[axis] < middle {
                    tensor = lower;
                    box_[axis].1 = middle;
                } else {
                    tensor = upper;
                    box_[axis].0 = middle;
                }
            }
            let (low, high) = tensor.range();
            prop_assert!(high - low < 1.0);
        }

        #[test]
        fn faces_at_infinity_enclose_the_values(
            c in proptest::collection::vec(-1.0..1.0, 20),
            u in -1.0..1.0, v in -1.0..1.0, t in 0.0..1.0,
        ) {
            let p = Polynomial::new(3, c).unwrap();
            let chart = [Role::Symmetric(0), Role::Fixed(-1.0), Role::Symmetric(1), Role::Unit(2)];
            let (low, high) = Tensor::new(&p, chart).range();
            let value = p.evaluate_homogeneous([u, -1.0, v, t]);
            prop_assert!(low <= value + 1e-12 && value <= high + 1e-12);
        }
    }
}
