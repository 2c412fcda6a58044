//! Exact signs of the minors that decide an arrangement, with symbolic ties.
//!
//! All decisions of the extraction are signs of determinants of at most 4×4 vertex values
//! (row: primitive, column: lattice vertex). They are decided by a floating-point filter, then
//! exactly, and a true zero by simulation of simplicity: the value of primitive i at vertex v
//! counts as `f_i(v) + ε_iv`, positive infinitesimals of which one with a smaller (i, v) exceeds
//! every product of those with larger ones. So no sign is ever zero, a zero vertex value counts
//! as positive, and two simplices that share the vertices of a minor find the same sign.
//!
//! Notation: `n` order of the minor, `rows`/`columns` its entries' names in storage order.

use crate::lattice::Point;
use num_bigint::{BigInt, Sign as BigSign};
use std::sync::LazyLock;

/// Sign of a quantity that cannot vanish.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Sign {
    /// Below zero.
    Negative,
    /// Above zero.
    Positive,
}

impl Sign {
    /// `Positive` when `positive` holds.
    #[must_use]
    pub(crate) fn of(positive: bool) -> Self {
        if positive {
            Self::Positive
        } else {
            Self::Negative
        }
    }

    /// The sign of the product.
    #[must_use]
    pub(crate) fn times(self, other: Self) -> Self {
        Self::of(self == other)
    }
}

/// Sign of a vertex value: zero counts as positive.
#[must_use]
pub(crate) fn vertex_sign(value: f64) -> Sign {
    Sign::of(value >= 0.0)
}

/// A square matrix of vertex values, of order 1 to 4, with the names of rows and columns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Minor {
    /// Its order n; only the first n rows and columns are used.
    pub order: usize,
    /// `entries[row][column]`.
    pub entries: [[f64; 4]; 4],
    /// Global primitive index of each row; pairwise different.
    pub rows: [u32; 4],
    /// Lattice vertex of each column; pairwise different.
    pub columns: [Point; 4],
}

/// Sign of the determinant.
#[must_use]
pub(crate) fn minor_sign(minor: &Minor) -> Sign {
    let n = minor.order;
    let (value, bound) = filtered(n, &minor.entries);
    if value > bound {
        return Sign::Positive;
    }
    if value < -bound {
        return Sign::Negative;
    }
    match exact(n, &minor.entries) {
        1 => Sign::Positive,
        -1 => Sign::Negative,
        _ => symbolic(minor),
    }
}

/// Sign of a determinant, given in floating point with the sum of its terms' magnitudes, if that
/// is beyond doubt.
#[must_use]
pub(crate) fn clear_sign(value: f64, permanent: f64) -> Option<Sign> {
    let is_clear = value.abs() > error_bound(permanent);
    is_clear.then_some(if value > 0.0 {
        Sign::Positive
    } else {
        Sign::Negative
    })
}

/// Cofactor expansion: at most 2n+1 roundings on any path, on terms whose magnitudes sum up to
/// the permanent of |m|; 16 units cover n = 4 with the rounding of the bound itself. The constant
/// keeps results that lost bits to underflow out of the filter.
fn error_bound(permanent: f64) -> f64 {
    16.0 * f64::EPSILON * permanent + 1e-280
}

/// Determinant in floating point and a bound on its error.
#[must_use]
pub(crate) fn filtered(n: usize, m: &[[f64; 4]; 4]) -> (f64, f64) {
    let (det, permanent) = match n {
        1 => (m[0][0], 0.0),
        2 => two(m[0], m[1], 0, 1),
        3 => three(m[0], m[1], m[2], [0, 1, 2]),
        _ => {
            let mut det = 0.0;
            let mut permanent = 0.0;
            for (c, rest) in [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]]
                .into_iter()
                .enumerate()
            {
                let (d, p) = three(m[1], m[2], m[3], rest);
                let term = m[0][c] * d;
                det += if c % 2 == 0 { term } else { -term };
                permanent += m[0][c].abs() * p;
            }
            (det, permanent)
        }
    };
    (det, error_bound(permanent))
}

fn two(a: [f64; 4], b: [f64; 4], i: usize, j: usize) -> (f64, f64) {
    let (p, q) = (a[i] * b[j], a[j] * b[i]);
    (p - q, p.abs() + q.abs())
}

fn three(a: [f64; 4], b: [f64; 4], c: [f64; 4], [i, j, k]: [usize; 3]) -> (f64, f64) {
    let (x, px) = two(b, c, j, k);
    let (y, py) = two(b, c, i, k);
    let (z, pz) = two(b, c, i, j);
    (
        a[i] * x - a[j] * y + a[k] * z,
        a[i].abs() * px + a[j].abs() * py + a[k].abs() * pz,
    )
}

/// Exact sign of the determinant: −1, 0 or 1.
fn exact(n: usize, m: &[[f64; 4]; 4]) -> i8 {
    let smallest = m[..n]
        .iter()
        .flat_map(|row| &row[..n])
        .filter(|x| **x != 0.0)
        .map(|x| x.abs())
        .fold(f64::INFINITY, f64::min);
    let sign = |x: f64| i8::from(x > 0.0) - i8::from(x < 0.0);
    // The adaptive predicates are exact as long as no product of n entries underflows.
    let adaptive = smallest > 1e-60;
    match n {
        1 => sign(m[0][0]),
        2 if adaptive => {
            let point = |r: usize| robust::Coord {
                x: m[r][0],
                y: m[r][1],
            };
            let origin = robust::Coord { x: 0.0, y: 0.0 };
            sign(robust::orient2d(point(0), point(1), origin))
        }
        3 if adaptive => {
            let point = |r: usize| robust::Coord3D {
                x: m[r][0],
                y: m[r][1],
                z: m[r][2],
            };
            let origin = robust::Coord3D {
                x: 0.0,
                y: 0.0,
                z: 0.0,
            };
            sign(robust::orient3d(point(0), point(1), point(2), origin))
        }
        _ => exact_big(n, m),
    }
}

/// The same in integers, for any finite entries.
fn exact_big(n: usize, m: &[[f64; 4]; 4]) -> i8 {
    let values: Vec<Vec<f64>> = m[..n].iter().map(|row| row[..n].to_vec()).collect();
    let all: Vec<usize> = (0..n).collect();
    match big_determinant(&scaled_integers(&values), &all, &all).sign() {
        BigSign::Minus => -1,
        BigSign::NoSign => 0,
        BigSign::Plus => 1,
    }
}

/// Finite numbers times a common power of two that makes all of them integers.
#[must_use]
pub(crate) fn scaled_integers(values: &[Vec<f64>]) -> Vec<Vec<BigInt>> {
    let lowest = values
        .iter()
        .flatten()
        .filter(|x| **x != 0.0)
        .map(|x| decompose(*x).1)
        .min()
        .unwrap_or(0);
    let scaled = |x: &f64| {
        let (mantissa, exponent) = decompose(*x);
        if mantissa == 0 {
            BigInt::ZERO
        } else {
            BigInt::from(mantissa) << (exponent - lowest)
        }
    };
    values
        .iter()
        .map(|row| row.iter().map(scaled).collect())
        .collect()
}

/// Determinant of the given rows and columns, as many of the one as of the other; 1 of none.
#[must_use]
pub(crate) fn big_determinant(m: &[Vec<BigInt>], rows: &[usize], columns: &[usize]) -> BigInt {
    let Some((row, below)) = rows.split_first() else {
        return BigInt::from(1);
    };
    let mut sum = BigInt::ZERO;
    for (at, column) in columns.iter().enumerate() {
        let rest: Vec<usize> = columns.iter().copied().filter(|c| c != column).collect();
        let term = &m[*row][*column] * big_determinant(m, below, &rest);
        if at % 2 == 0 {
            sum += term;
        } else {
            sum -= term;
        }
    }
    sum
}

/// A finite number as mantissa · 2^exponent.
fn decompose(x: f64) -> (i64, i64) {
    let bits = x.to_bits();
    let fraction = (bits & ((1 << 52) - 1)).cast_signed();
    let exponent = (bits >> 52 & 0x7ff).cast_signed();
    let mantissa = if exponent == 0 {
        fraction
    } else {
        fraction | 1 << 52
    };
    let signed = if x < 0.0 { -mantissa } else { mantissa };
    (signed, exponent.max(1) - 1075)
}

/// One term of a determinant's expansion in the perturbations: the entries whose ε it takes, the
/// rows and columns of the minor it is multiplied with, and its sign.
#[derive(Clone, Debug)]
struct Term {
    /// Bit n·row + column for each ε: as numbers, smaller masks are larger infinitesimals.
    mask: u32,
    rows: Vec<usize>,
    columns: Vec<usize>,
    negative: bool,
}

/// All terms for each order, largest infinitesimal first, rows and columns in name order.
static TERMS: LazyLock<[Vec<Term>; 4]> = LazyLock::new(|| [1, 2, 3, 4].map(expansion));

fn expansion(n: usize) -> Vec<Term> {
    let mut terms = vec![Term {
        mask: 0,
        rows: (0..n).collect(),
        columns: (0..n).collect(),
        negative: false,
    }];
    // Take ε's in row order: each term is extended only by rows below its last one.
    let mut from = 0;
    while from < terms.len() {
        let term = terms[from].clone();
        let first_free = (0..n)
            .rev()
            .find(|r| !term.rows.contains(r))
            .map_or(0, |r| r + 1);
        for (r_at, &r) in term
            .rows
            .iter()
            .enumerate()
            .filter(|(_, r)| **r >= first_free)
        {
            for (c_at, &c) in term.columns.iter().enumerate() {
                let mut next = term.clone();
                next.mask |= 1 << (n * r + c);
                next.rows.remove(r_at);
                next.columns.remove(c_at);
                next.negative ^= (r_at + c_at) % 2 == 1;
                terms.push(next);
            }
        }
        from += 1;
    }
    terms.sort_by_key(|term| term.mask);
    terms
}

/// Sign of the determinant of the perturbed matrix, whose own determinant is zero.
fn symbolic(minor: &Minor) -> Sign {
    let n = minor.order;
    let (rows, row_parity) = order_of(&minor.rows[..n]);
    let (columns, column_parity) = order_of(&minor.columns[..n]);
    let parity = row_parity ^ column_parity;
    for term in &TERMS[n - 1][1..] {
        let mut rest = [[0.0; 4]; 4];
        for (r, row) in term.rows.iter().enumerate() {
            for (c, column) in term.columns.iter().enumerate() {
                rest[r][c] = minor.entries[rows[*row]][columns[*column]];
            }
        }
        let sign = if term.rows.is_empty() {
            1
        } else {
            exact(term.rows.len(), &rest)
        };
        if sign != 0 {
            return Sign::of((sign < 0) == (term.negative ^ parity));
        }
    }
    // Not reached: the terms of n ε's have the empty minor, which is 1.
    Sign::Positive
}

/// The order that sorts `names`, and whether it is an odd permutation.
fn order_of<T: Ord + Copy>(names: &[T]) -> ([usize; 4], bool) {
    let mut order = [0, 1, 2, 3];
    let mut odd = false;
    for i in 1..names.len() {
        let mut j = i;
        while j > 0 && names[order[j - 1]] > names[order[j]] {
            order.swap(j - 1, j);
            odd = !odd;
            j -= 1;
        }
    }
    (order, odd)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> [Point; 4] {
        [[0, 0, 0], [4, 0, 0], [4, 4, 0], [4, 4, 4]].map(Point::new)
    }

    fn minor(order: usize, entries: [[f64; 4]; 4]) -> Minor {
        Minor {
            order,
            entries,
            rows: [0, 1, 2, 3],
            columns: points(),
        }
    }

    /// Determinant by expansion, in integers; the oracle for small entries.
    fn integer_determinant(n: usize, m: &[[i128; 4]; 4], rows: &[usize]) -> i128 {
        if rows.len() == n {
            return 1;
        }
        let column = rows.len();
        (0..n)
            .filter(|r| !rows.contains(r))
            .map(|r| {
                let inversions = rows.iter().filter(|x| **x > r).count();
                let sign = if inversions % 2 == 0 { 1 } else { -1 };
                let mut next = rows.to_vec();
                next.push(r);
                sign * m[r][column] * integer_determinant(n, m, &next)
            })
            .sum()
    }

    #[test]
    fn expansion_has_all_partial_matchings() {
        assert_eq!(TERMS.each_ref().map(Vec::len), [2, 7, 34, 209]);
    }

    #[test]
    fn zero_value_counts_as_positive() {
        let zero = minor(1, [[0.0; 4]; 4]);
        assert_eq!(minor_sign(&zero), Sign::Positive);
        assert_eq!(vertex_sign(-0.0), Sign::Positive);
    }

    proptest! {
        /// The oracle perturbs the values by actual powers of a huge base in exact integers:
        /// with entries in −2..2 the base 64 separates all products of order up to 2, and for
        /// larger orders generic entries are compared without ties.
        #[test]
        fn ties_are_decided_as_by_a_real_perturbation(
            entries in proptest::array::uniform4(-2i8..=2), swap_rows: bool, swap_columns: bool,
        ) {
            let e: Vec<i128> = entries.iter().map(|x| i128::from(*x)).collect();
            // ε_00 ≫ ε_01 ≫ ε_10 ≫ ε_11 as 2^-10, 2^-20·…: scaled to integers.
            let scale = 1i128 << 60;
            let eps = [1i128 << 54, 1 << 42, 1 << 22, 1];
            let m = |i: usize| e[i] * scale + eps[i];
            let (a, b, c, d) = (m(0), m(1), m(2), m(3));
            // 128 bits hold products of two 62-bit numbers.
            let det = a * d - b * c;
            let f = |i: usize| f64::from(entries[i]);
            let mut matrix = [[0.0; 4]; 4];
            (matrix[0][0], matrix[0][1], matrix[1][0], matrix[1][1]) = (f(0), f(1), f(2), f(3));
            let mut test = minor(2, matrix);
            let mut expected = det > 0;
            if swap_rows {
                test.entries.swap(0, 1);
                test.rows.swap(0, 1);
                expected = !expected;
            }
            if swap_columns {
                for row in &mut test.entries {
                    row.swap(0, 1);
                }
                test.columns.swap(0, 1);
                expected = !expected;
            }
            prop_assert_eq!(minor_sign(&test), Sign::of(expected));
        }

        #[test]
        fn signs_are_those_of_integer_arithmetic(
            order in 1usize..=4, entries in proptest::array::uniform16(-9i8..=9), shift in -300i32..300,
        ) {
            let mut integers = [[0i128; 4]; 4];
            let mut floats = [[0.0; 4]; 4];
            for r in 0..4 {
                for c in 0..4 {
                    integers[r][c] = i128::from(entries[4 * r + c]);
                    floats[r][c] = f64::from(entries[4 * r + c]) * f64::from(shift).exp2();
                }
            }
            let det = integer_determinant(order, &integers, &[]);
            prop_assert_eq!(i128::from(exact(order, &floats)), det.signum());
            if det != 0 {
                prop_assert_eq!(minor_sign(&minor(order, floats)), Sign::of(det > 0));
            }
        }

        /// Exchanging two rows or columns with their names turns the sign, ties included.
        #[test]
        fn sign_is_alternating(
            order in 2usize..=4, entries in proptest::array::uniform16(-1i8..=1),
            r in proptest::array::uniform2(0usize..4), c in proptest::array::uniform2(0usize..4),
        ) {
            let mut floats = [[0.0; 4]; 4];
            for (at, entry) in entries.iter().enumerate() {
                floats[at / 4][at % 4] = f64::from(*entry);
            }
            let before = minor(order, floats);
            let mut after = before;
            let mut odd = false;
            let (r0, r1, c0, c1) = (r[0] % order, r[1] % order, c[0] % order, c[1] % order);
            if r0 != r1 {
                after.entries.swap(r0, r1);
                after.rows.swap(r0, r1);
                odd = !odd;
            }
            if c0 != c1 {
                for row in &mut after.entries {
                    row.swap(c0, c1);
                }
                after.columns.swap(c0, c1);
                odd = !odd;
            }
            prop_assert_eq!(minor_sign(&before) == minor_sign(&after), !odd);
        }
    }
}
