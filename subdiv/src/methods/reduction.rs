//! Lower degree during subdivision (thesis 6.3.2): a polynomial becomes one of a degree less where
//! the error, proved by Bernstein coefficients, is allowed.
//!
//! The best such polynomial in the sense of least squares over the coefficients is also the best
//! in L² over the simplex (Lutterkort, Peters and Reif, *Polynomial degree reduction in the
//! L2-norm equals best Euclidean approximation of Bézier coefficients*, 1999). Here to be
//! measured: it gives two simplices different values on the facet that they share, so that a
//! boundary made from them would not close.

use crate::bernstein::{count, for_each_index, index};
use crate::walk::Frame;

/// Lowers the degrees of a frame's polynomials.
#[derive(Debug)]
pub(super) struct Reducer {
    /// Largest error, relative to the width of a polynomial's range in the simplex and to the
    /// ratio of the smallest simplices' edges to its own.
    allowed: f64,
    /// Level of the smallest simplices.
    level: u8,
    /// By degree to reduce from.
    systems: Vec<System>,
    lower: Vec<f64>,
}

/// The normal equations of E c' = c, E being the elevation to a degree: lower triangle of their
/// Cholesky factor, row by row.
#[derive(Debug)]
struct System {
    degree: usize,
    factor: Vec<f64>,
}

impl Reducer {
    /// For polynomials up to `degree` and leaves of a level.
    pub(super) fn new(degree: usize, level: u8, allowed: f64) -> Self {
        Self {
            allowed,
            level,
            systems: (0..=degree).map(System::new).collect(),
            lower: Vec::new(),
        }
    }

    /// Lowers what can be lowered; the errors become part of the coefficients' rounding.
    pub(super) fn reduce(&mut self, level: u8, frame: &mut Frame) {
        let halvings = f64::from(self.level.saturating_sub(level)) / 3.0;
        let share = self.allowed * (-halvings).exp2();
        for active in &mut frame.active {
            let start = active.offset as usize;
            while active.degree > 1 {
                let degree = active.degree as usize;
                let c = &mut frame.coefficients[start..start + count(degree)];
                let (low, high) = c
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                        (l.min(*x), h.max(*x))
                    });
                let allowed = share * (high - low);
                // No polynomial of lower degree comes nearer than the term of highest degree,
                // shrunk as Chebyshev's polynomial is.
                if largest_top(degree, c) > allowed * (2.0 * degree as f64 - 1.0).exp2() {
                    break;
                }
                let error = self.systems[degree].reduce(c, &mut self.lower);
                if error > allowed {
                    break;
                }
                c[..self.lower.len()].copy_from_slice(&self.lower);
                active.degree -= 1;
                active.rounding += error;
            }
        }
    }
}

/// The largest n-th difference from v0 along the three edges there: the coefficients of the term
/// of highest degree.
fn largest_top(degree: usize, c: &[f64]) -> f64 {
    let mut differences = c.to_vec();
    let mut largest = 0.0_f64;
    // Differences along one edge after the other, in place, from the far end.
    for axis in 0..3 {
        for order in 0..degree {
            for m in (order + 1..=degree).rev() {
                for q in 0..=m {
                    for l in 0..=q {
                        let (j, k) = (m - q, q - l);
                        let own = [j, k, l][axis];
                        if own > order {
                            let before = match axis {
                                0 => index(j - 1, k, l),
                                1 => index(j, k - 1, l),
                                _ => index(j, k, l - 1),
                            };
                            differences[index(j, k, l)] -= differences[before];
                        }
                    }
                }
            }
        }
    }
    for_each_index(degree, |at, [i, ..]| {
        if i == 0 {
            largest = largest.max(differences[at].abs());
        }
    });
    largest
}

impl System {
    fn new(degree: usize) -> Self {
        let size = if degree == 0 { 0 } else { count(degree - 1) };
        let mut matrix = vec![0.0; size * size];
        if size > 0 {
            for_each_index(degree, |_, exponents| {
                let row = row(degree, exponents);
                for (a, x) in row.into_iter().flatten() {
                    for (b, y) in row.into_iter().flatten() {
                        matrix[a * size + b] += x * y;
                    }
                }
            });
        }
        for at in 0..size {
            for before in 0..=at {
                let (top, rest) = matrix.split_at_mut(at * size);
                let (upper, own) = if before == at {
                    (None, &mut rest[..size])
                } else {
                    (
                        Some(&top[before * size..before * size + size]),
                        &mut rest[..size],
                    )
                };
                let dot: f64 = match upper {
                    Some(upper) => own[..before].iter().zip(upper).map(|(a, b)| a * b).sum(),
                    None => own[..before].iter().map(|a| a * a).sum(),
                };
                let left = own[before] - dot;
                own[before] = match upper {
                    Some(upper) => left / upper[before],
                    None => left.sqrt(),
                };
            }
        }
        let factor = matrix;
        Self { degree, factor }
    }

    /// Fills `lower`; returns the largest coefficient of the difference, which bounds it.
    fn reduce(&self, c: &[f64], lower: &mut Vec<f64>) -> f64 {
        let size = count(self.degree - 1);
        lower.clear();
        lower.resize(size, 0.0);
        for_each_index(self.degree, |at, exponents| {
            for (column, weight) in row(self.degree, exponents).into_iter().flatten() {
                lower[column] += weight * c[at];
            }
        });
        for at in 0..size {
            let own = &self.factor[at * size..at * size + size];
            let dot: f64 = own[..at].iter().zip(&*lower).map(|(a, b)| a * b).sum();
            lower[at] = (lower[at] - dot) / own[at];
        }
        for at in (0..size).rev() {
            lower[at] /= self.factor[at * size + at];
            let (value, own) = (lower[at], &self.factor[at * size..at * size + at]);
            for (other, factor) in lower.iter_mut().zip(own) {
                *other -= value * factor;
            }
        }
        let mut error = 0.0_f64;
        for_each_index(self.degree, |at, exponents| {
            let row = row(self.degree, exponents);
            let elevated: f64 = row.into_iter().flatten().map(|(a, w)| w * lower[a]).sum();
            error = error.max((elevated - c[at]).abs());
        });
        error
    }
}

/// The coefficients of the lower degree of which one of the higher degree is made, with their
/// weights: c_ijkl = (i c'_{i−1,jkl} + j c'_{i,j−1,kl} + …)/n.
fn row(degree: usize, [i, j, k, l]: [usize; 4]) -> [Option<(usize, f64)>; 4] {
    let weight = |exponent: usize| exponent as f64 / degree as f64;
    [
        (i > 0).then(|| (index(j, k, l), weight(i))),
        (j > 0).then(|| (index(j - 1, k, l), weight(j))),
        (k > 0).then(|| (index(j, k - 1, l), weight(k))),
        (l > 0).then(|| (index(j, k, l - 1), weight(l))),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::evaluate;

    /// A quadratic written as a quintic comes back; a quintic stays within the error told.
    #[test]
    fn reduction_is_exact_or_tells_its_error() {
        let mut c: Vec<f64> = (0..count(2)).map(|at| (at as f64).sin()).collect();
        let original = c.clone();
        for degree in 3..6 {
            let mut higher = vec![0.0; count(degree)];
            for_each_index(degree, |at, exponents| {
                let row = row(degree, exponents);
                higher[at] = row.into_iter().flatten().map(|(a, w)| w * c[a]).sum();
            });
            assert!(largest_top(degree, &higher) < 1e-12);
            c = higher;
        }
        let mut lower = Vec::new();
        for degree in (3..6).rev() {
            assert!(System::new(degree).reduce(&c, &mut lower) < 1e-13);
            c.clone_from(&lower);
        }
        assert!(c.iter().zip(&original).all(|(a, b)| (a - b).abs() < 1e-12));

        let wild: Vec<f64> = (0..count(5)).map(|at| (1.7 * at as f64).sin()).collect();
        let error = System::new(5).reduce(&wild, &mut lower);
        assert!(largest_top(5, &wild) < error * 512.0);
        for b in [[0.25; 4], [0.1, 0.2, 0.3, 0.4], [1.0, 0.0, 0.0, 0.0]] {
            let difference = evaluate(5, &wild, b) - evaluate(4, &lower, b);
            assert!(difference.abs() <= error);
        }
    }
}
