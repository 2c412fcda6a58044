//! 4×4 matrices that carry a bound on the rounding error of each entry.
//!
//! Points are row vectors: X becomes X M. `rows[i][j]` is in row i, column j.

use crate::error::Error;

/// Rows of a 4×4 matrix.
pub(crate) type Rows = [[f64; 4]; 4];

/// The identity.
pub(crate) const IDENTITY: Rows = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

/// A matrix with elementwise error bounds.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Bounded {
    pub(crate) rows: Rows,
    pub(crate) error: Rows,
}

impl Bounded {
    /// A matrix without error.
    pub(crate) const fn exact(rows: Rows) -> Self {
        Self {
            rows,
            error: [[0.0; 4]; 4],
        }
    }

    /// The matrix itself if all of it is finite.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub(crate) fn finite(self) -> Result<Self, Error> {
        for &entry in self.rows.iter().chain(&self.error).flatten() {
            crate::error::finite("composed transform matrix", entry)?;
        }
        Ok(self)
    }

    /// `self · other`: first `self`, then `other`.
    pub(crate) fn then(&self, other: &Self) -> Self {
        let mut error = multiply(&absolute(&self.rows), &other.error);
        add(&mut error, &multiply(&self.error, &absolute(&other.rows)));
        add(&mut error, &multiply(&self.error, &other.error));
        let mut rows = IDENTITY;
        for i in 0..4 {
            for j in 0..4 {
                let factors = [0, 1, 2, 3].map(|k| (self.rows[i][k], other.rows[k][j]));
                rows[i][j] = factors.iter().map(|(a, b)| a * b).sum();
                let terms = || factors.iter().filter(|(a, b)| a * b != 0.0);
                let count = terms().count();
                // Products with a factor of 1 are exact, and common: a shift of a shift rounds
                // once, relative to what is left of both.
                error[i][j] += if terms().all(|(a, b)| is_unit(*a) || is_unit(*b)) && count <= 2 {
                    0.5 * f64::EPSILON * if count == 2 { rows[i][j].abs() } else { 0.0 }
                } else {
                    let sum: f64 = factors.iter().map(|(a, b)| (a * b).abs()).sum();
                    2.5 * f64::EPSILON * sum
                };
            }
        }
        Self { rows, error }
    }
}

/// The product, without regard to errors.
pub(crate) fn multiply(a: &Rows, b: &Rows) -> Rows {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

/// The matrix with rows and columns exchanged.
pub(crate) fn transposed(m: &Rows) -> Rows {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

#[expect(
    clippy::float_cmp,
    reason = "only products with exactly 1 and −1 are exact"
)]
fn is_unit(value: f64) -> bool {
    value.abs() == 1.0
}

fn absolute(m: &Rows) -> Rows {
    m.map(|row| row.map(f64::abs))
}

fn add(sum: &mut Rows, other: &Rows) {
    for (row, other) in sum.iter_mut().zip(other) {
        for (s, o) in row.iter_mut().zip(other) {
            *s += o;
        }
    }
}

/// The inverse, with an error bound from its residual.
///
/// Gauss–Jordan elimination on the matrix scaled by powers of two, with row pivoting.
///
/// # Errors
/// [`Error::SingularTransform`] also when the matrix cannot be told from a singular one.
pub(crate) fn inverse(m: &Rows) -> Result<Bounded, Error> {
    let scale = Scaling::of(m)?;
    let balanced = scale.apply(m);
    let mut left = balanced;
    let mut right = IDENTITY;
    for column in 0..4 {
        let size = |row: usize| left[row][column].abs();
        let pivot = (column..4).fold(column, |p, r| if size(r) > size(p) { r } else { p });
        // Entries are balanced to 1, so this is a relative threshold.
        if size(pivot) < 1e-13 {
            return Err(Error::SingularTransform);
        }
        left.swap(column, pivot);
        right.swap(column, pivot);
        let d = left[column][column];
        for entry in left[column].iter_mut().chain(&mut right[column]) {
            *entry /= d;
        }
        for row in (0..4).filter(|&r| r != column) {
            let factor = left[row][column];
            if factor != 0.0 {
                for j in 0..4 {
                    left[row][j] -= factor * left[column][j];
                    right[row][j] -= factor * right[column][j];
                }
            }
        }
    }
    let product = multiply(&balanced, &right);
    let mut residual: Rows =
        std::array::from_fn(|i| std::array::from_fn(|j| (product[i][j] - IDENTITY[i][j]).abs()));
    let exact = residual.iter().flatten().all(|r| *r == 0.0) && is_monomial(&balanced);
    if !exact {
        let rounding = multiply(&absolute(&balanced), &absolute(&right));
        add(
            &mut residual,
            &rounding.map(|row| row.map(|r| 2.5 * f64::EPSILON * r)),
        );
    }
    let error = multiply(&absolute(&right), &residual).map(|row| row.map(|e| 1.1 * e));
    let result = Bounded {
        rows: scale.apply_to_inverse(&right),
        error: scale.apply_to_inverse(&error),
    };
    let all = result.rows.iter().chain(&result.error).flatten();
    if all.copied().all(f64::is_finite) {
        Ok(result)
    } else {
        Err(Error::SingularTransform)
    }
}

/// Whether each row and column holds one entry, whose reciprocal is exact.
fn is_monomial(m: &Rows) -> bool {
    let power_of_two = |v: f64| v == 0.0 || v.abs().log2().fract() == 0.0;
    let one = |line: &[f64; 4]| line.iter().filter(|v| **v != 0.0).count() == 1;
    m.iter().all(one)
        && transposed(m).iter().all(one)
        && m.iter().flatten().all(|v| power_of_two(*v))
}

/// Powers of two that bring the largest entry of each row, then of each column, near 1.
struct Scaling {
    rows: [f64; 4],
    columns: [f64; 4],
}

impl Scaling {
    fn of(m: &Rows) -> Result<Self, Error> {
        let reciprocal = |line: &[f64; 4]| {
            let size = line.iter().fold(0.0_f64, |s, v| s.max(v.abs()));
            let power = (-size.log2().floor()).exp2();
            if size.is_finite() && size > 0.0 && power.is_normal() {
                Ok(power)
            } else {
                Err(Error::SingularTransform)
            }
        };
        let mut scaling = Self {
            rows: [1.0; 4],
            columns: [1.0; 4],
        };
        for (size, row) in scaling.rows.iter_mut().zip(m) {
            *size = reciprocal(row)?;
        }
        let columns = transposed(&scaling.apply(m));
        for (size, column) in scaling.columns.iter_mut().zip(&columns) {
            *size = reciprocal(column)?;
        }
        Ok(scaling)
    }

    fn apply(&self, m: &Rows) -> Rows {
        std::array::from_fn(|i| std::array::from_fn(|j| m[i][j] * self.rows[i] * self.columns[j]))
    }

    /// (R M C)⁻¹ = C⁻¹ M⁻¹ R⁻¹, so M⁻¹ = C (…) R.
    fn apply_to_inverse(&self, m: &Rows) -> Rows {
        std::array::from_fn(|i| std::array::from_fn(|j| m[i][j] * self.columns[i] * self.rows[j]))
    }
}
