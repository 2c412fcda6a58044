//! How far a quadric is from its affine interpolant in a simplex, exactly.
//!
//! r = p − ℓ vanishes at the vertices, so r(b) = Σ_{i≠j} b_i b_j o_ij with o_ij the edge coefficient
//! less the mean of the vertex values. Its extremes over the simplex are at stationary points of
//! edges, facets or the simplex itself, and each of them is a candidate:
//!
//! * edge: o/2 in the middle;
//! * facet with a, b, c on its edges: 2abc/(2ab + 2bc + 2ca − a² − b² − c²), where the barycentric
//!   coordinates a(b + c − a), … have one sign;
//! * simplex: 1/(1·O⁻¹·1) where O⁻¹·1 has one sign.

/// Edge positions in storage order: (coefficient, the two vertices' coefficients).
const EDGES: [(usize, usize, usize); 6] = [
    (1, 0, 4), // v0 v1
    (2, 0, 7), // v0 v2
    (3, 0, 9), // v0 v3
    (5, 4, 7), // v1 v2
    (6, 4, 9), // v1 v3
    (8, 7, 9), // v2 v3
];

/// The three edges of each facet, as positions in [`EDGES`]; in the order of the opposite vertex.
const FACETS: [[usize; 3]; 4] = [[3, 4, 5], [1, 2, 5], [0, 2, 4], [0, 1, 3]];

/// Range, with zero, of p − ℓ for the ten coefficients of a quadric.
#[must_use]
pub(crate) fn quadric_remainder(c: &[f64]) -> (f64, f64) {
    let Some(c) = c.first_chunk::<10>() else {
        return (f64::NEG_INFINITY, f64::INFINITY);
    };
    let o = EDGES.map(|(edge, a, b)| c[edge] - 0.5 * (c[a] + c[b]));
    let (mut low, mut high) = (0.0f64, 0.0f64);
    for off in o {
        low = low.min(off);
        high = high.max(off);
    }
    let largest = high.max(-low);
    // Nowhere more than this: Σ_{i≠j} b_i b_j ≤ 3/4.
    let bounds = (0.75 * low, 0.75 * high);
    let (mut low, mut high) = (0.5 * low, 0.5 * high);
    let mut slack = ROUNDING;
    let mut include = |candidate: Stationary| match candidate {
        Stationary::Outside => {}
        Stationary::Value(value) => {
            low = low.min(value);
            high = high.max(value);
        }
        Stationary::Flat => slack = FLAT,
    };
    for [a, b, c] in FACETS {
        include(in_facet(o[a], o[b], o[c]));
    }
    include(in_simplex(&o));
    let slack = slack * largest;
    ((low - slack).max(bounds.0), (high + slack).min(bounds.1))
}

/// A stationary point of a face.
enum Stationary {
    /// Outside the face.
    Outside,
    /// Inside or, by rounding, next to it.
    Value(f64),
    /// In some direction r hardly changes over the face.
    Flat,
}

/// Sums of weights below this part of the terms they are made of are not trusted.
const CLEAR: f64 = 1e-6;

/// Twenty roundings, amplified by 1/[`CLEAR`], relative to the largest offset.
const ROUNDING: f64 = 1e-8;

/// The product of r's two or three second derivatives is below [`CLEAR`], while one of them is as
/// large as an offset: another one is at most 1e-3 of it, and along it r changes no more than
/// that on the way to the face's border.
const FLAT: f64 = 2e-3;

/// The point with barycentric coordinates in the ratios of `weights`, of magnitude `size`.
fn stationary<const N: usize>(weights: [f64; N], size: f64, numerator: f64) -> Stationary {
    let sum: f64 = weights.iter().sum();
    if sum.abs() <= CLEAR * size {
        return Stationary::Flat;
    }
    if weights.iter().all(|w| w / sum >= -CLEAR) {
        Stationary::Value(numerator / sum)
    } else {
        Stationary::Outside
    }
}

fn in_facet(a: f64, b: f64, c: f64) -> Stationary {
    let weights = [a * (b + c - a), b * (c + a - b), c * (a + b - c)];
    let size = a * a + b * b + c * c;
    stationary(weights, size, 2.0 * a * b * c)
}

/// By Cramer's rule: with the products x, y, z of opposite edges' offsets the determinant of O is
/// x² + y² + z² − 2xy − 2yz − 2zx.
fn in_simplex(o: &[f64; 6]) -> Stationary {
    let [o01, o02, o03, o12, o13, o23] = *o;
    let (x, y, z) = (o01 * o23, o02 * o13, o03 * o12);
    let (by_x, by_y, by_z) = (x - y - z, y - z - x, z - x - y);
    let weights = [
        2.0 * o12 * o13 * o23 + o23 * by_x + o13 * by_y + o12 * by_z,
        2.0 * o02 * o03 * o23 + o23 * by_x + o02 * by_y + o03 * by_z,
        2.0 * o01 * o03 * o13 + o01 * by_x + o13 * by_y + o03 * by_z,
        2.0 * o01 * o02 * o12 + o01 * by_x + o02 * by_y + o12 * by_z,
    ];
    let largest = o.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let determinant = x * by_x + y * by_y + z * by_z;
    stationary(weights, largest.powi(3), determinant)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::evaluate;
    use proptest::prelude::*;

    fn deviation(c: &[f64], b: [f64; 4]) -> f64 {
        let affine = b[0] * c[0] + b[1] * c[4] + b[2] * c[7] + b[3] * c[9];
        evaluate(2, c, b) - affine
    }

    proptest! {
        /// No point of a grid over the simplex is outside, and the extremes are nearly reached.
        #[test]
        fn range_is_that_of_a_dense_grid(
            c in proptest::collection::vec(-1.0..1.0f64, 10), flat in 0usize..3,
        ) {
            let mut c = c;
            if flat == 1 {
                // The square of a linear form: r is constant along planes.
                let l = [c[0], c[4], c[7], c[9]];
                for (at, (i, j)) in [(0, 0), (0, 1), (0, 2), (0, 3), (1, 1), (1, 2), (1, 3),
                    (2, 2), (2, 3), (3, 3)].into_iter().enumerate() {
                    c[at] = l[i] * l[j];
                }
            }
            let (low, high) = quadric_remainder(&c);
            let n = 40;
            let (mut least, mut most) = (0.0f64, 0.0f64);
            for i in 0..=n {
                for j in 0..=n - i {
                    for k in 0..=n - i - j {
                        let b = [i, j, k, n - i - j - k].map(|e| f64::from(e) / f64::from(n));
                        let r = deviation(&c, b);
                        least = least.min(r);
                        most = most.max(r);
                    }
                }
            }
            prop_assert!(low <= least + 1e-12 && most <= high + 1e-12);
            // A grid point is within 1/40 of the extreme in each coordinate: second order.
            prop_assert!(high - low <= (most - least) + 2e-2, "{low} {least} {most} {high}");
        }
    }

    /// For |x|² it is the square of the circumradius: √3/2 for the root simplex.
    #[test]
    fn sphere_in_a_kuhn_simplex() {
        let c: Vec<f64> = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0, 2.0, 3.0].to_vec();
        let (low, high) = quadric_remainder(&c);
        assert!((low + 0.75).abs() < 2e-8 && high.abs() < 2e-8);
    }
}
