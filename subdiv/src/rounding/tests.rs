//! The oracle is the same computation in exact rational numbers.

use super::*;
use crate::bernstein::{count, for_each_index, index};
use crate::blossom::RootCoefficients;
use crate::halving::halve;
use crate::simplex::ROOT_AXES;
use csg::Polynomial;
use num_rational::BigRational;
use proptest::prelude::*;

type Exact = Vec<BigRational>;

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn ratio(numerator: usize, denominator: usize) -> BigRational {
    BigRational::new(numerator.into(), denominator.into())
}

/// \[m\]_r / \[n\]_r with falling factorials.
fn falling(m: usize, n: usize, r: usize) -> BigRational {
    (0..r).fold(ratio(1, 1), |product, t| {
        product * ratio(m.saturating_sub(t), n - t)
    })
}

/// A polynomial in centred coordinates 2x − 1, 2y − 1, 2z − 1 as one in x, y, z.
fn in_unit(n: usize, power: &[f64]) -> Exact {
    // Coefficients of (2t − 1)^e, lowest first.
    let expanded = |e: usize| {
        (0..e).fold(vec![ratio(1, 1)], |p, _| {
            let zero = ratio(0, 1);
            (0..=p.len())
                .map(|at| {
                    let below = at.checked_sub(1).map_or(&zero, |at| &p[at]);
                    below * ratio(2, 1) - p.get(at).unwrap_or(&zero)
                })
                .collect()
        })
    };
    let expanded: Vec<Exact> = (0..=n).map(expanded).collect();
    let mut sums = vec![ratio(0, 1); count(n)];
    for i in 0..=n {
        for j in 0..=n - i {
            for k in 0..=n - i - j {
                let c = exact(power[Polynomial::index(n, i, j, k)]);
                for (a, x) in expanded[i].iter().enumerate() {
                    for (b, y) in expanded[j].iter().enumerate() {
                        for (d, z) in expanded[k].iter().enumerate() {
                            sums[Polynomial::index(n, a, b, d)] += &c * x * y * z;
                        }
                    }
                }
            }
        }
    }
    sums
}

/// On the unit cube's root simplex along `axes`: the blossom of a^α b^β c^γ counts the ways to give
/// γ of the l last arguments to c, β of the remaining k+l−γ to b and α of the others to a.
fn converted(n: usize, power: &Exact, axes: [usize; 3]) -> Exact {
    let mut all = vec![ratio(0, 1); count(n)];
    for_each_index(n, |at, [_, j, k, l]| {
        for gamma in 0..=l {
            for beta in 0..=k + l - gamma {
                for alpha in 0..=j + k + l - gamma - beta {
                    let mut e = [0; 3];
                    for (axis, exponent) in axes.into_iter().zip([alpha, beta, gamma]) {
                        e[axis] = exponent;
                    }
                    let c = &power[Polynomial::index(n, e[0], e[1], e[2])];
                    let ways = falling(l, n, gamma)
                        * falling(k + l - gamma, n - gamma, beta)
                        * falling(j + k + l - gamma - beta, n - gamma - beta, alpha);
                    all[at] += c * ways;
                }
            }
        }
    });
    all
}

/// De Casteljau at the midpoint of v0–v3, as in `crate::halving`.
fn halved(n: usize, kind: usize, parent: &Exact) -> [Exact; 2] {
    let mut children = [parent.clone(), parent.clone()];
    for j in 0..=n {
        for k in 0..=n - j {
            let s = n - j - k;
            let mut line: Exact = (0..=s).map(|l| parent[index(j, k, l)].clone()).collect();
            for r in 0..=s {
                let (x, y) = if kind == 0 { (k, j) } else { (j, k) };
                children[0][index(r, j, k)] = line[0].clone();
                children[1][index(r, x, y)] = line[s - r].clone();
                for l in 0..s - r {
                    line[l] = (line[l].clone() + &line[l + 1]) * ratio(1, 2);
                }
            }
        }
    }
    children
}

fn distance(floats: &[f64], exacts: &Exact) -> BigRational {
    let pairs = floats.iter().zip(exacts);
    let gaps = pairs.map(|(f, e)| {
        let gap = exact(*f) - e;
        if gap < ratio(0, 1) { -gap } else { gap }
    });
    gaps.max().unwrap()
}

fn largest(coefficients: &[f64]) -> f64 {
    coefficients.iter().fold(0.0, |m, c| c.abs().max(m))
}

/// From the root down along `turns`: never farther from the exact coefficients than bounded.
fn descend(degree: usize, power: &[f64], root: usize, turns: &[bool]) {
    let polynomial = Polynomial::new(degree, power.to_vec()).unwrap();
    let roots = RootCoefficients::new(&Primitive {
        polynomial,
        coefficient_error: 0.0,
    });
    let mut floats = roots.roots[root].clone();
    let mut exacts = converted(degree, &in_unit(degree, power), ROOT_AXES[root]);
    let mut bound = roots.rounding;
    for (level, &far) in turns.iter().enumerate() {
        let gap = distance(&floats, &exacts);
        assert!(gap <= exact(bound), "level {level}: {gap} > {bound}");
        bound = of_halving(degree, bound, largest(&floats));
        let mut children = [floats.clone(), floats.clone()];
        let [near, other] = &mut children;
        halve(degree, (level % 3) as u8, &floats, near, other);
        floats.clone_from(&children[usize::from(far)]);
        exacts = halved(degree, level % 3, &exacts)[usize::from(far)].clone();
    }
    assert!(distance(&floats, &exacts) <= exact(bound));
    // A bound that says nothing would pass, too.
    let magnitude: f64 = power.iter().map(|c| c.abs()).sum();
    let roundings = (9 + turns.len()) * (degree + 1);
    assert!(bound <= roundings as f64 * f64::EPSILON * magnitude);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn coefficients_are_within_their_bound(
        degree in 1usize..7, root in 0usize..6,
        power in proptest::collection::vec(-1.0..1.0f64, 84),
        turns in proptest::collection::vec(any::<bool>(), 12),
    ) {
        descend(degree, &power[..count(degree)], root, &turns);
    }
}

/// Many terms of alternating signs that cancel: Π (x − k/n), in all three coordinates.
#[test]
fn high_degrees_are_within_their_bound() {
    let n = 12;
    let mut power = vec![0.0; count(n)];
    let mut product = vec![1.0];
    for root in 1..=n {
        let at = root as f64 / (n + 1) as f64;
        product.push(0.0);
        for power in (1..=root).rev() {
            product[power] -= at * product[power - 1];
        }
    }
    for (l, c) in product.into_iter().enumerate() {
        power[Polynomial::index(n, n - l, 0, 0)] += c;
        power[Polynomial::index(n, 0, n - l, 0)] += 0.3 * c;
        power[Polynomial::index(n, 0, 0, n - l)] -= 0.7 * c;
    }
    descend(n, &power, 3, &[true, false, true, true, false, false]);
}
