//! Polynomials of degree three and more over a triangle, from their values on a lattice in it.
//!
//! A polynomial is the quadratic with its values at the corners and the middles of the sides, plus a rest
//! that is bounded by its Bernstein coefficients. The rest is of the third order, so small
//! where the triangle is.

/// Interpolation is not tried beyond: its rounding grows with the degree, and its cost.
pub(super) const MOST: usize = 8;

/// The linear maps from the values of polynomials of one degree.
#[derive(Clone, Debug)]
pub(super) struct Lattice {
    degree: usize,
    /// Barycentric coordinates, times the degree, of the points where values are taken.
    points: Vec<[usize; 3]>,
    /// Rows: the quadratic's coefficients, three at the corners and three on the sides 01, 12, 20.
    quadratic: Vec<f64>,
    /// Rows: the rest's.
    rest: Vec<f64>,
    /// By how much errors of values are amplified at most.
    amplification: f64,
}

/// A polynomial over a triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Split {
    /// The quadratic's coefficients, three at the corners and three on the sides 01, 12, 20.
    pub(super) quadratic: [f64; 6],
    /// Range of the rest, with zero.
    pub(super) rest: [f64; 2],
}

impl Lattice {
    /// For polynomials of degree 3 to [`MOST`].
    pub(super) fn new(degree: usize) -> Self {
        let points: Vec<[usize; 3]> = (0..=degree)
            .flat_map(|i| (0..=degree - i).map(move |j| [i, j, degree - i - j]))
            .collect();
        let count = points.len();
        let scale = 1.0 / degree as f64;
        let values: Vec<Vec<f64>> = (points.iter())
            .map(|at| {
                let at = at.map(|k| k as f64 * scale);
                points.iter().map(|&of| bernstein(of, at)).collect()
            })
            .collect();
        let coefficients = inverse(values);
        // The quadratic's value in the middle of a side is the mean of its coefficients there, twice that on
        // the side.
        let at = |barycentric: [f64; 3]| -> Vec<f64> {
            let weights: Vec<f64> = points
                .iter()
                .map(|&of| bernstein(of, barycentric))
                .collect();
            (0..count)
                .map(|value| {
                    (0..count)
                        .map(|c| weights[c] * coefficients[c][value])
                        .sum()
                })
                .collect()
        };
        let corners = [[1., 0., 0.], [0., 1., 0.], [0., 0., 1.]].map(at);
        let middles = [[0.5, 0.5, 0.], [0., 0.5, 0.5], [0.5, 0., 0.5]].map(at);
        let mut quadratic: Vec<Vec<f64>> = corners.to_vec();
        for (side, middle) in middles.iter().enumerate() {
            let [p, q] = [&corners[side], &corners[(side + 1) % 3]];
            let row = (0..count).map(|v| 2.0 * middle[v] - 0.5 * (p[v] + q[v]));
            quadratic.push(row.collect());
        }
        let rest: Vec<Vec<f64>> = (points.iter().zip(&coefficients))
            .map(|(&of, row)| {
                let elevated = elevated(of, degree);
                (0..count)
                    .map(|v| row[v] - (0..6).map(|k| elevated[k] * quadratic[k][v]).sum::<f64>())
                    .collect()
            })
            .collect();
        let sum = |row: &Vec<f64>| row.iter().map(|c| c.abs()).sum::<f64>();
        let amplification = quadratic.iter().chain(&rest).map(sum).fold(1.0, f64::max);
        Self {
            degree,
            points,
            quadratic: quadratic.concat(),
            rest: rest.concat(),
            amplification,
        }
    }

    pub(super) fn amplification(&self) -> f64 {
        self.amplification
    }

    /// The least and the largest value on the lattice.
    pub(super) fn sampled(&self, value: impl Fn([f64; 3]) -> f64) -> [f64; 2] {
        let scale = 1.0 / self.degree as f64;
        let values = self
            .points
            .iter()
            .map(|at| value(at.map(|k| k as f64 * scale)));
        values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| {
            [low.min(v), high.max(v)]
        })
    }

    /// Splits the polynomial whose value at barycentric coordinates is given.
    pub(super) fn split(&self, value: impl Fn([f64; 3]) -> f64) -> Split {
        let scale = 1.0 / self.degree as f64;
        let mut values = [0.0; (MOST + 1) * (MOST + 2) / 2];
        for (out, at) in values.iter_mut().zip(&self.points) {
            *out = value(at.map(|k| k as f64 * scale));
        }
        let count = self.points.len();
        let values = &values[..count];
        let dot = |row: &[f64]| row.iter().zip(values).map(|(a, b)| a * b).sum::<f64>();
        let mut quadratic = [0.0; 6];
        for (out, row) in quadratic.iter_mut().zip(self.quadratic.chunks_exact(count)) {
            *out = dot(row);
        }
        let mut rest = [0.0f64; 2];
        for row in self.rest.chunks_exact(count) {
            let coefficient = dot(row);
            rest = [rest[0].min(coefficient), rest[1].max(coefficient)];
        }
        Split { quadratic, rest }
    }
}

/// A Bernstein polynomial's value.
fn bernstein(of: [usize; 3], at: [f64; 3]) -> f64 {
    let [i, j, k] = of;
    let power = |base: f64, exponent: usize| (0..exponent).fold(1.0, |p, _| p * base);
    choose(i + j + k, i) * choose(j + k, j) * power(at[0], i) * power(at[1], j) * power(at[2], k)
}

fn choose(n: usize, k: usize) -> f64 {
    (0..k).fold(1.0, |c, m| c * (n - m) as f64 / (m + 1) as f64)
}

/// The weights of a quadratic's six coefficients in this one of the form of higher degree.
fn elevated(of: [usize; 3], degree: usize) -> [f64; 6] {
    // Two of the arguments are the quadratic's; the ways to choose them.
    let pairs = (degree * (degree - 1)) as f64;
    let two = |k: usize| (k * k.saturating_sub(1)) as f64 / pairs;
    let one = |k: usize, l: usize| (2 * k * l) as f64 / pairs;
    let [i, j, k] = of;
    [two(i), two(j), two(k), one(i, j), one(j, k), one(k, i)]
}

/// The inverse of a regular matrix, by elimination with pivots.
fn inverse(mut matrix: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    let count = matrix.len();
    let mut inverse: Vec<Vec<f64>> = (0..count)
        .map(|row| {
            (0..count)
                .map(|column| f64::from(u8::from(row == column)))
                .collect()
        })
        .collect();
    for column in 0..count {
        let largest = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..count).max_by(|a, b| largest(a).total_cmp(&largest(b)));
        let pivot = pivot.unwrap_or(column);
        matrix.swap(column, pivot);
        inverse.swap(column, pivot);
        let factor = 1.0 / matrix[column][column];
        for rows in [&mut matrix, &mut inverse] {
            for entry in &mut rows[column] {
                *entry *= factor;
            }
        }
        for row in (0..count).filter(|&row| row != column) {
            let factor = matrix[row][column];
            for rows in [&mut matrix, &mut inverse] {
                let of_pivot = rows[column].clone();
                for (entry, other) in rows[row].iter_mut().zip(of_pivot) {
                    *entry -= factor * other;
                }
            }
        }
    }
    inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A form with known coefficients: quadratic and rest give its values again, and the rest of
        /// a quadratic is nothing.
        #[test]
        fn the_parts_are_the_whole(
            degree in 3usize..=MOST,
            numbers in proptest::collection::vec(-1.0..1.0f64, 45),
            at in proptest::array::uniform3(0.0..1.0f64),
        ) {
            let lattice = Lattice::new(degree);
            let form = |at| -> f64 {
                let terms = lattice.points.iter().zip(&numbers);
                terms.map(|(&of, c)| c * bernstein(of, at)).sum()
            };
            let square = |c: [f64; 6], [x, y, z]: [f64; 3]| {
                c[0] * x * x + c[1] * y * y + c[2] * z * z
                    + 2.0 * (c[3] * x * y + c[4] * y * z + c[5] * z * x)
            };
            let sum: f64 = at.iter().sum();
            let at = at.map(|x| x / sum);
            let split = lattice.split(form);
            let rest = form(at) - square(split.quadratic, at);
            let rounding = 1e-13 * lattice.amplification();
            prop_assert!(split.rest[0] - rounding <= rest && rest <= split.rest[1] + rounding);
            let six: [f64; 6] = std::array::from_fn(|k| numbers[k]);
            let split = lattice.split(|at| square(six, at));
            prop_assert!(split.rest.iter().all(|r| r.abs() <= rounding));
            for (found, given) in split.quadratic.iter().zip(six) {
                prop_assert!((found - given).abs() <= rounding);
            }
        }
    }
}
