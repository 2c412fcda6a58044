//! Power form to Bernstein form on the six root simplices.
//!
//! On the root simplex that climbs the unit cube along the axes a, b, c, the blossom of the
//! monomial a^α b^β c^γ at v0 (i times) … v3 (l times) counts the ways to give γ of the l last
//! arguments to c, β of the remaining k+l−γ to b and α of the remaining j+k+l−γ−β to a:
//!
//! ```text
//! c_ijkl = Σ p_αβγ · [l]_γ/[n]_γ · [k+l−γ]_β/[n−γ]_β · [j+k+l−γ−β]_α/[n−γ−β]_α
//! ```
//!
//! with falling factorials [m]_r. All terms are sums and products of numbers of one sign with
//! the coefficients, and the sum splits into three passes of O(n⁴) together (the thesis' sum
//! over permutations took 14 minutes at degree 6, Table 6.1).

use crate::bernstein::{count, for_each_index, index};
use crate::rounding;
use crate::simplex::ROOT_AXES;
use csg::Primitive;

/// Bernstein coefficients of one primitive on the six root simplices.
#[derive(Clone, Debug)]
pub(crate) struct RootCoefficients {
    /// Polynomial degree.
    pub degree: usize,
    /// One list for each root simplex, in the order of [`ROOT_AXES`].
    pub roots: [Vec<f64>; 6],
    /// Bound on the rounding of every coefficient here.
    pub rounding: f64,
    /// Bound on the error of the polynomial itself, see [`crate::rounding`].
    pub model_error: f64,
}

impl RootCoefficients {
    /// Converts a primitive given in the domain's own coordinates.
    #[must_use]
    pub(crate) fn new(primitive: &Primitive) -> Self {
        let degree = primitive.polynomial.degree();
        let power = primitive.polynomial.coefficients();
        let mut roots = ROOT_AXES.map(|axes| convert(degree, power, axes));
        share_facets(degree, &mut roots);
        let magnitude: f64 = power.iter().map(|c| c.abs()).sum();
        Self {
            degree,
            roots,
            rounding: rounding::of_conversion(degree, magnitude),
            model_error: rounding::of_model(primitive),
        }
    }
}

/// `power`: coefficients in lexicographic descending order of exponents (thesis A.2.3).
fn convert(n: usize, power: &[f64], axes: [usize; 3]) -> Vec<f64> {
    let coefficient = |alpha: usize, beta: usize, gamma: usize| {
        let mut exponents = [0; 3];
        for (axis, exponent) in axes.into_iter().zip([alpha, beta, gamma]) {
            exponents[axis] = exponent;
        }
        let w = n - alpha - beta - gamma;
        power[index(exponents[1], exponents[2], w)]
    };
    let side = n + 1;
    let at = |a: usize, b: usize, c: usize| (a * side + b) * side + c;
    // first[γ][β][m]: summed over α, with m = j+k+l−γ−β.
    let mut first = vec![0.0; side * side * side];
    for gamma in 0..=n {
        for beta in 0..=n - gamma {
            let rest = n - gamma - beta;
            for m in 0..=rest {
                let mut ratio = 1.0;
                let mut sum = 0.0;
                for alpha in 0..=m {
                    sum += ratio * coefficient(alpha, beta, gamma);
                    ratio *= (m - alpha) as f64 / (rest - alpha).max(1) as f64;
                }
                first[at(gamma, beta, m)] = sum;
            }
        }
    }
    // second[γ][q][r]: summed over β, with q = k+l−γ and r = j+k+l−γ.
    let mut second = vec![0.0; side * side * side];
    for gamma in 0..=n {
        for q in 0..=n - gamma {
            for r in q..=n - gamma {
                let mut ratio = 1.0;
                let mut sum = 0.0;
                for beta in 0..=q {
                    sum += ratio * first[at(gamma, beta, r - beta)];
                    ratio *= (q - beta) as f64 / (n - gamma - beta).max(1) as f64;
                }
                second[at(gamma, q, r)] = sum;
            }
        }
    }
    let mut bernstein = vec![0.0; count(n)];
    for_each_index(n, |position, [_, j, k, l]| {
        let mut ratio = 1.0;
        let mut sum = 0.0;
        for gamma in 0..=l {
            sum += ratio * second[at(gamma, k + l - gamma, j + k + l - gamma)];
            ratio *= (l - gamma) as f64 / (n - gamma).max(1) as f64;
        }
        bernstein[position] = sum;
    });
    bernstein
}

/// Makes shared coefficients bit-identical: each is taken from the first root that has it.
///
/// Roots (a,b,c) and (b,a,c) share the facet without v1 (j = 0), (a,b,c) and (a,c,b) the one
/// without v2 (k = 0), and all six the diagonal (j = k = 0).
fn share_facets(degree: usize, roots: &mut [Vec<f64>; 6]) {
    for root in 1..6 {
        let [a, b, c] = ROOT_AXES[root];
        let find = |axes| ROOT_AXES.iter().position(|x| *x == axes).unwrap_or(root);
        let (without_v1, without_v2) = (find([b, a, c]), find([a, c, b]));
        for_each_index(degree, |at, [_, j, k, _]| {
            let source = match (j, k) {
                (0, 0) => 0,
                (0, _) => without_v1.min(root),
                (_, 0) => without_v2.min(root),
                _ => root,
            };
            roots[root][at] = roots[source][at];
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::evaluate;
    use crate::simplex::Simplex;
    use csg::Polynomial;
    use glam::DVec3;
    use proptest::prelude::*;

    proptest! {
        /// The oracle is the power form evaluated at the same point.
        #[test]
        fn bernstein_form_has_the_polynomials_values(
            degree in 1u32..9,
            seed in proptest::collection::vec(-1.0..1.0f64, 165),
            b in proptest::array::uniform4(0.01..1.0f64),
        ) {
            let power = seed[..count(degree as usize)].to_vec();
            let polynomial = Polynomial::new(degree as usize, power).unwrap();
            let primitive = Primitive { polynomial, coefficient_error: 0.0 };
            let roots = RootCoefficients::new(&primitive);
            let sum: f64 = b.iter().sum();
            let b = b.map(|x| x / sum);
            for (simplex, coefficients) in Simplex::roots().iter().zip(&roots.roots) {
                let point: DVec3 = (0..4).map(|v| simplex.vertices[v].position() * b[v]).sum();
                let expected = primitive.polynomial.evaluate(point);
                let got = evaluate(degree as usize, coefficients, b);
                // Both evaluations round at most as often as the conversion.
                prop_assert!((got - expected).abs() <= 4.0 * roots.rounding, "{got} {expected}");
            }
        }
    }
}
