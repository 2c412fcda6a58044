//! Bernstein–Bézier form of a polynomial on a simplex.
//!
//! A polynomial of degree n has (n+1)(n+2)(n+3)/6 coefficients `c_ijkl`, i+j+k+l = n, stored in
//! lexicographic descending order of (i,j,k,l). `c_ijkl` is the blossom at v0 (i times) … v3
//! (l times); the four corner coefficients are the values at the vertices, and the polynomial's
//! values lie between the smallest and the largest coefficient.

/// Number of coefficients of a trivariate polynomial of this degree.
#[must_use]
pub(crate) const fn count(degree: usize) -> usize {
    (degree + 1) * (degree + 2) * (degree + 3) / 6
}

/// Position of the coefficient whose last three exponents are (j, k, l), for any degree.
///
/// In descending order the exponents of v0 need not be known: m = j+k+l coefficients layers
/// stand before.
#[must_use]
pub(crate) const fn index(j: usize, k: usize, l: usize) -> usize {
    let m = j + k + l;
    let q = k + l;
    m * (m + 1) * (m + 2) / 6 + q * (q + 1) / 2 + l
}

/// Calls `visit(position, [i, j, k, l])` for all coefficients in storage order.
pub(crate) fn for_each_index(degree: usize, mut visit: impl FnMut(usize, [usize; 4])) {
    let mut at = 0;
    for m in 0..=degree {
        for q in 0..=m {
            for l in 0..=q {
                visit(at, [degree - m, m - q, q - l, l]);
                at += 1;
            }
        }
    }
}

/// The values at the four vertices.
#[must_use]
pub(crate) fn vertex_values(degree: usize, coefficients: &[f64]) -> [f64; 4] {
    [
        coefficients[0],
        coefficients[index(degree, 0, 0)],
        coefficients[index(0, degree, 0)],
        coefficients[index(0, 0, degree)],
    ]
}

/// Value at the point with barycentric coordinates `b`, by de Casteljau's algorithm.
#[cfg(test)]
pub(crate) fn evaluate(degree: usize, coefficients: &[f64], b: [f64; 4]) -> f64 {
    let mut c = coefficients.to_vec();
    for d in (0..degree).rev() {
        for_each_index(d, |at, [_, j, k, l]| {
            // Positions before `at` are overwritten, but each reads positions at or after it.
            c[at] = b[0] * c[index(j, k, l)]
                + b[1] * c[index(j + 1, k, l)]
                + b[2] * c[index(j, k + 1, l)]
                + b[3] * c[index(j, k, l + 1)];
        });
    }
    c[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn index_counts_in_storage_order() {
        for degree in 0..7 {
            let mut seen = 0;
            for_each_index(degree, |at, [i, j, k, l]| {
                assert_eq!((at, i + j + k + l), (seen, degree));
                assert_eq!(index(j, k, l), at);
                seen += 1;
            });
            assert_eq!(seen, count(degree));
        }
    }
}
