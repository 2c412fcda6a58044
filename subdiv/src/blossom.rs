//! Power form to Bernstein form on the six root simplices.
//!
//! Polynomials come in the cube's centred coordinates, −1 to 1, in which powers neither grow nor
//! cancel: about a corner, `x^64 + y^64 + z^64 − 1` would lose more digits than there are.
//!
//! On the root simplex that climbs the cube along the axes a, b, c the vertices are v0 (−, −, −),
//! v1 (+, −, −), v2 (+, +, −) and v3 (+, +, +). The coefficient c_ijkl is the blossom at v0
//! (i times) … v3 (l times). In a monomial a^α b^β c^γ w^(n−α−β−γ) the n arguments go to n
//! places, in all ways, and the blossom is the mean of the products: −1 or 1 each time, so it
//! is at most 1. Taken axis by axis the mean splits into passes of O(n⁴) together (the thesis' sum
//! over permutations took 14 minutes at degree 6, Table 6.1):
//!
//! * *turn* an axis: for fixed powers of the others, the m places of c and w become the mean over
//!   those of c for each number of arguments v3 among them (Krawtchouk's polynomials);
//! * *place* the v3 among the places of another axis, where they are 1: hypergeometric
//!   weights, which are positive and sum up to 1.
//!
//! So every sum's terms are at most Σ|p_αβγ| together, whatever the degree.

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
    /// Converts a primitive given in the domain's centred coordinates.
    #[must_use]
    pub(crate) fn new(primitive: &Primitive) -> Self {
        let degree = primitive.polynomial.degree();
        let power = primitive.polynomial.coefficients();
        let weights = Weights::new(degree);
        let mut roots = ROOT_AXES.map(|axes| weights.convert(power, axes));
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

/// Binomials and means for all degrees up to one.
struct Weights {
    degree: usize,
    /// Binomial coefficients, exact below 2⁵³.
    binomials: Vec<Vec<f64>>,
    /// For each number m of places: for r arguments 1 and m − r arguments −1, and γ places of
    /// the coordinate, the mean product.
    turns: Vec<Vec<f64>>,
}

impl Weights {
    fn new(degree: usize) -> Self {
        // Rows of Pascal's triangle; the largest, C(64, 32), has 61 bits.
        let mut exact: Vec<Vec<i64>> = vec![vec![1]];
        // Coefficients of (1 + t)^r (1 − t)^(m−r): by absolute value at most C(m, γ).
        let mut signed: Vec<Vec<i64>> = vec![vec![1]];
        let mut turns = vec![vec![1.0]];
        for m in 1..=degree {
            let row = times(&exact[m - 1], 1);
            signed = (0..=m)
                .map(|r| match r {
                    0 => times(&signed[0], -1),
                    _ => times(&signed[r - 1], 1),
                })
                .collect();
            let mean = |(of, all): (&i64, &i64)| *of as f64 / *all as f64;
            let means = signed.iter().flat_map(|s| s.iter().zip(&row).map(mean));
            turns.push(means.collect());
            exact.push(row);
        }
        let binomials = exact
            .iter()
            .map(|row| row.iter().map(|c| *c as f64).collect())
            .collect();
        Self {
            degree,
            binomials,
            turns,
        }
    }

    /// The chance that of `drawn` out of `all` places `hits` are among `marked` ones.
    fn chance(&self, marked: usize, all: usize, drawn: usize, hits: usize) -> f64 {
        let c = |n: usize, k: usize| self.binomials[n][k];
        c(marked, hits) * c(all - marked, drawn - hits) / c(all, drawn)
    }

    /// For m places of a coordinate and w, given by their coefficients for γ = 0 … m: the mean
    /// for r arguments 1.
    fn turn(&self, m: usize, r: usize, coefficient: impl Fn(usize) -> f64) -> f64 {
        let row = &self.turns[m][r * (m + 1)..(r + 1) * (m + 1)];
        row.iter()
            .enumerate()
            .map(|(at, k)| k * coefficient(at))
            .sum()
    }

    /// Places `drawn` arguments 1 among `all` places of which `power + hits` belong to a
    /// coordinate that keeps `power`: the mean of `rest(hits)`.
    fn place(&self, all: usize, drawn: usize, power: usize, rest: impl Fn(usize) -> f64) -> f64 {
        let most = drawn.min(all - power);
        (0..=most)
            // The places that are left must suffice for the others.
            .filter(|hits| drawn - hits <= all - power - hits)
            .map(|hits| self.chance(power + hits, all, drawn, hits) * rest(hits))
            .sum()
    }

    /// `power`: coefficients in lexicographic descending order of exponents (thesis A.2.3).
    fn convert(&self, power: &[f64], axes: [usize; 3]) -> Vec<f64> {
        let n = self.degree;
        let side = n + 1;
        let at = |a: usize, b: usize, c: usize| (a * side + b) * side + c;
        let coefficient = |alpha: usize, beta: usize, gamma: usize| {
            let mut exponents = [0; 3];
            for (axis, exponent) in axes.into_iter().zip([alpha, beta, gamma]) {
                exponents[axis] = exponent;
            }
            let w = n - alpha - beta - gamma;
            power[index(exponents[1], exponents[2], w)]
        };
        let (mut first, mut second) =
            (vec![0.0; side * side * side], vec![0.0; side * side * side]);
        // first[α][β][r]: the third axis turned.
        for alpha in 0..=n {
            for beta in 0..=n - alpha {
                let m = n - alpha - beta;
                for r in 0..=m {
                    first[at(alpha, beta, r)] =
                        self.turn(m, r, |gamma| coefficient(alpha, beta, gamma));
                }
            }
        }
        // second[α][β][s]: s arguments v3 outside of the first axis' places.
        for alpha in 0..=n {
            let all = n - alpha;
            for beta in 0..=all {
                for s in 0..=all - beta {
                    second[at(alpha, beta, s)] =
                        self.place(all, s, beta, |hits| first[at(alpha, beta + hits, s - hits)]);
                }
            }
        }
        // first[l][α][β]: all l arguments v3 placed.
        for l in 0..=n {
            for alpha in 0..=n - l {
                for beta in 0..=n - l - alpha {
                    first[at(l, alpha, beta)] =
                        self.place(n, l, alpha, |hits| second[at(alpha + hits, beta, l - hits)]);
                }
            }
        }
        let mut turned = vec![0.0; side * side];
        for l in 0..=n {
            let all = n - l;
            // turned[α][r]: the second axis turned.
            for alpha in 0..=all {
                for r in 0..=all - alpha {
                    turned[alpha * side + r] =
                        self.turn(all - alpha, r, |beta| first[at(l, alpha, beta)]);
                }
            }
            // second[l][k][α]: k arguments v2 placed.
            for k in 0..=all {
                for alpha in 0..=all - k {
                    second[at(l, k, alpha)] = self.place(all, k, alpha, |hits| {
                        turned[(alpha + hits) * side + k - hits]
                    });
                }
            }
        }
        let mut bernstein = vec![0.0; count(n)];
        for_each_index(n, |position, [_, j, k, l]| {
            bernstein[position] = self.turn(n - l - k, j, |alpha| second[at(l, k, alpha)]);
        });
        bernstein
    }
}

/// The coefficients of a polynomial times 1 + t or 1 − t.
fn times(coefficients: &[i64], sign: i64) -> Vec<i64> {
    let shifted = |at: usize| at.checked_sub(1).and_then(|at| coefficients.get(at));
    (0..=coefficients.len())
        .map(|at| coefficients.get(at).unwrap_or(&0) + sign * shifted(at).unwrap_or(&0))
        .collect()
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

/// The centred form of a polynomial given in unit coordinates.
#[cfg(test)]
#[must_use]
pub(crate) fn centered(in_unit: &csg::Polynomial) -> csg::Polynomial {
    let h = 0.5;
    let to_unit = [
        [h, 0.0, 0.0, 0.0],
        [0.0, h, 0.0, 0.0],
        [0.0, 0.0, h, 0.0],
        [h, h, h, 1.0],
    ];
    in_unit.substituted(&to_unit).unwrap()
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
                let expected = primitive.polynomial.evaluate(2.0 * point - 1.0);
                let got = evaluate(degree as usize, coefficients, b);
                // Both evaluations round at most as often as the conversion.
                prop_assert!((got - expected).abs() <= 4.0 * roots.rounding, "{got} {expected}");
            }
        }
    }

    /// x^n + y^n + z^n − 1 keeps its digits up to the highest degree, in the root simplices and in
    /// small ones.
    #[test]
    fn high_degrees_keep_their_digits() {
        for n in [16, 32, 64] {
            let terms = [
                ([n, 0, 0], 1.0),
                ([0, n, 0], 1.0),
                ([0, 0, n], 1.0),
                ([0; 3], -1.0),
            ];
            let primitive = Primitive {
                polynomial: csg::Polynomial::from_terms(n, &terms).unwrap(),
                coefficient_error: 0.0,
            };
            let roots = RootCoefficients::new(&primitive);
            assert!(roots.rounding < 1e-12);
            let mut simplex = Simplex::roots()[3];
            let mut c = roots.roots[3].clone();
            let mut bound = roots.rounding;
            for level in 0..12 {
                for b in [[0.25; 4], [0.7, 0.1, 0.1, 0.1], [0.05, 0.1, 0.15, 0.7]] {
                    let at: DVec3 = (0..4).map(|v| simplex.vertices[v].position() * b[v]).sum();
                    let expected = primitive.polynomial.evaluate(2.0 * at - 1.0);
                    let found = evaluate(n, &c, b);
                    assert!(
                        (found - expected).abs() < 4.0 * bound,
                        "{n} {level} {found} {expected}"
                    );
                }
                let largest = c.iter().fold(0.0, |m: f64, x| x.abs().max(m));
                bound = crate::rounding::of_halving(n, bound, largest);
                let (mut near, mut far) = (vec![0.0; c.len()], vec![0.0; c.len()]);
                crate::halving::halve(n, simplex.kind(), &c, &mut near, &mut far);
                let side = level % 2;
                simplex = simplex.children()[side];
                c = if side == 0 { near } else { far };
            }
        }
    }
}
