//! Where planes meet: barycentric coordinates of the arrangement's vertices.
//!
//! Cramer's rule on the vertex values: with k planes on a face of k + 1 vertices, coordinate c is
//! the cofactor (−1)^c M_c. Floating point serves where the planes meet at an angle; where they
//! almost share a line it would put the vertex anywhere in the face, and integers are used. Planes
//! that share a line exactly meet where their symbolic perturbation (`crate::predicates`) makes
//! them meet in the limit, which is a point of all of them again.

use crate::arrange::{Indices, Planes, support};
use crate::predicates::{big_determinant, filtered, scaled_integers};
use num_bigint::BigInt;

/// Relative error of a coordinate that floating point may leave.
const ACCURACY: f64 = 1e-13;

/// Barycentric coordinates of the vertex with this name, all at least 0, zero off the face in
/// which it lies.
#[must_use]
pub(crate) fn barycentric(planes: &Planes<'_>, name: [u16; 3]) -> [f64; 4] {
    let (rows, columns) = support(name);
    let mut cofactors = [0.0; 4];
    let mut error = 0.0f64;
    for (at, &column) in columns.iter().enumerate() {
        let (det, bound) = filtered(rows.len(), &selected(planes, &rows, &columns, at));
        cofactors[column] = if at % 2 == 0 { det } else { -det };
        error = error.max(bound);
    }
    let sum: f64 = cofactors.iter().sum();
    if error > ACCURACY * sum.abs() || !sum.is_finite() {
        cofactors = exact(planes, &rows, &columns);
    }
    let sum: f64 = cofactors.iter().sum();
    let inside = cofactors.map(|b| (b / sum).max(0.0));
    let sum: f64 = inside.iter().sum();
    inside.map(|b| b / sum)
}

/// The values of `rows` at all of `columns` but the one at place `without`.
fn selected(
    planes: &Planes<'_>,
    rows: &Indices,
    columns: &Indices,
    without: usize,
) -> [[f64; 4]; 4] {
    let mut entries = [[0.0; 4]; 4];
    for (line, &row) in entries.iter_mut().zip(rows) {
        let kept = columns.iter().enumerate().filter(|(at, _)| *at != without);
        for (entry, (_, &column)) in line.iter_mut().zip(kept) {
            *entry = planes.values[row][column];
        }
    }
    entries
}

/// The cofactors up to a common factor, from integers; of planes that share a line the largest
/// infinitesimal part of the perturbed cofactors.
fn exact(planes: &Planes<'_>, rows: &Indices, columns: &Indices) -> [f64; 4] {
    // In the order of names, by which perturbations are compared.
    let mut sorted: Vec<usize> = columns.to_vec();
    sorted.sort_unstable_by_key(|column| planes.vertices[*column]);
    let values: Vec<Vec<f64>> = rows
        .iter()
        .map(|&row| sorted.iter().map(|&c| planes.values[row][c]).collect())
        .collect();
    let integers = scaled_integers(&values);
    let mut found = [0.0; 4];
    for taken in infinitesimals(rows.len()) {
        let coefficients: Vec<BigInt> = (0..sorted.len())
            .map(|without| coefficient(&integers, &taken, without))
            .collect();
        if coefficients.iter().all(|c| *c == BigInt::ZERO) {
            continue;
        }
        for (column, value) in sorted.iter().zip(leading_bits(&coefficients)) {
            found[*column] = value;
        }
        break;
    }
    found
}

/// Products of perturbations ε_rc of a k × (k + 1) matrix, at most one a row and a column, as
/// lists of (row, column); the largest infinitesimal first, the empty product before all.
fn infinitesimals(k: usize) -> Vec<Vec<(usize, usize)>> {
    let mut products = vec![Vec::new()];
    let mut from = 0;
    while from < products.len() {
        let product: Vec<(usize, usize)> = products[from].clone();
        let first_free = product.last().map_or(0, |(row, _)| row + 1);
        for row in first_free..k {
            for column in (0..=k).filter(|c| product.iter().all(|(_, taken)| taken != c)) {
                let mut longer = product.clone();
                longer.push((row, column));
                products.push(longer);
            }
        }
        from += 1;
    }
    let mask = |product: &[(usize, usize)]| -> u32 {
        product.iter().map(|(r, c)| 1 << ((k + 1) * r + c)).sum()
    };
    products.sort_by_key(|product| mask(product));
    products
}

/// Coefficient of a product of perturbations in the cofactor of column `without`.
fn coefficient(m: &[Vec<BigInt>], taken: &[(usize, usize)], without: usize) -> BigInt {
    let mut columns: Vec<usize> = (0..=m.len()).filter(|c| *c != without).collect();
    let mut rows: Vec<usize> = (0..m.len()).collect();
    let mut negative = without % 2 == 1;
    for (row, column) in taken {
        let Some(c) = columns.iter().position(|x| x == column) else {
            return BigInt::ZERO;
        };
        let r = rows.iter().position(|x| x == row).unwrap_or(0);
        negative ^= (r + c) % 2 == 1;
        rows.remove(r);
        columns.remove(c);
    }
    let value = big_determinant(m, &rows, &columns);
    if negative { -value } else { value }
}

/// The numbers divided by a common power of two, so that the largest keeps all bits of a float.
fn leading_bits(numbers: &[BigInt]) -> Vec<f64> {
    let longest = numbers.iter().map(BigInt::bits).max().unwrap_or(0);
    let shift = longest.saturating_sub(120);
    numbers
        .iter()
        .map(|x| i128::try_from(x >> shift).unwrap_or(0) as f64)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arrange::FACET;
    use crate::lattice::Point;
    use proptest::prelude::*;

    fn corners() -> [Point; 4] {
        [[0, 0, 0], [4, 0, 0], [4, 4, 0], [4, 4, 4]].map(Point::new)
    }

    fn at(values: &[[f64; 4]], name: [u16; 3]) -> [f64; 4] {
        let planes = Planes {
            vertices: corners(),
            positive: true,
            primitives: &[3, 5, 8],
            values,
        };
        barycentric(&planes, name)
    }

    fn residual(values: &[f64; 4], b: [f64; 4]) -> f64 {
        values.iter().zip(b).map(|(v, b)| v * b).sum::<f64>().abs()
    }

    /// Three planes through one line, their coefficients rounded: the float cofactors are noise.
    #[test]
    fn planes_that_almost_share_a_line_meet_on_it() {
        let (p, q) = ([1.0, -0.3, 0.7, -0.9], [-0.2, 0.8, -0.5, 0.1]);
        let r = [0, 1, 2, 3].map(|v: usize| p[v] / 3.0 + q[v] / 7.0);
        let b = at(&[p, q, r], [0, 1, 2]);
        for values in [p, q, r] {
            assert!(residual(&values, b) < 1e-15, "{b:?}");
        }
    }

    #[test]
    fn planes_that_share_a_line_meet_on_it() {
        let (p, q) = ([1.0, -1.0, 2.0, -2.0], [-1.0, 3.0, 1.0, -2.0]);
        let r = [0, 1, 2, 3].map(|v: usize| p[v] + q[v]);
        let b = at(&[p, q, r], [0, 1, 2]);
        for values in [p, q, r] {
            assert!(residual(&values, b) < 1e-15, "{b:?}");
        }
    }

    /// Planes that coincide meet in a point of theirs; whether it is in the face is another matter.
    #[test]
    fn equal_planes_meet_on_themselves() {
        let (p, q) = ([1.0, -1.0, 2.0, -2.0], [-1.0, 3.0, 1.0, -2.0]);
        for (values, name) in [
            ([p, p, p], [0, 1, 2]),
            ([p, p, q], [0, 1, 2]),
            ([p, p, q], [0, 1, FACET + 2]),
        ] {
            let planes = Planes {
                vertices: corners(),
                positive: true,
                primitives: &[3, 5, 8],
                values: &values,
            };
            let (rows, columns) = support(name);
            let b = exact(&planes, &rows, &columns);
            let size = b.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            assert!(size > 0.0, "{b:?}");
            for row in rows {
                assert!(residual(&values[row], b.map(|x| x / size)) < 1e-15, "{b:?}");
            }
        }
    }

    proptest! {
        /// Integers agree with floating point wherever that can be trusted.
        #[test]
        fn integers_and_floats_agree(
            values in proptest::array::uniform3(proptest::array::uniform4(-1.0..1.0f64)),
            planes_met in 1usize..=3,
        ) {
            let name = match planes_met {
                1 => [0, FACET + 1, FACET + 2],
                2 => [0, 1, FACET + 3],
                _ => [0, 1, 2],
            };
            let planes = Planes {
                vertices: corners(),
                positive: true,
                primitives: &[3, 5, 8],
                values: &values,
            };
            let (rows, columns) = support(name);
            let mut floats = [0.0; 4];
            let mut size = 0.0f64;
            for (at, &column) in columns.iter().enumerate() {
                let (det, _) = filtered(rows.len(), &selected(&planes, &rows, &columns, at));
                floats[column] = if at % 2 == 0 { det } else { -det };
                size = size.max(det.abs());
            }
            prop_assume!(size > 1e-3);
            let found = exact(&planes, &rows, &columns);
            let largest = found.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            let same = |sign: f64| {
                (0..4).all(|v| (sign * found[v] / largest - floats[v] / size).abs() < 1e-12)
            };
            // The order of names may turn all signs.
            prop_assert!(same(1.0) || same(-1.0));
        }
    }
}
