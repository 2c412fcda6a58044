//! Where a polynomial keeps its sign in a simplex (thesis 4.4).

use crate::bernstein::for_each_index;
use crate::lipschitz::Lipschitz;
use csg::Ternary;

/// A polynomial in a simplex, in Bernstein form.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Local<'a> {
    /// The simplex' type.
    pub kind: u8,
    /// The polynomial's degree.
    pub degree: usize,
    /// Its coefficients.
    pub coefficients: &'a [f64],
    /// Bound on their absolute error.
    pub error: f64,
    /// The smallest and the largest of them.
    pub range: [f64; 2],
}

/// A proof that a polynomial keeps its sign in a simplex: what tells the criteria apart.
pub(crate) trait KeepsSign {
    /// `In` when p < 0 is proved in the whole simplex, `Out` when p > 0 is.
    fn sign(polynomial: &Local<'_>) -> Ternary;
}

struct Bezier;

impl KeepsSign for Bezier {
    fn sign(&Local { range, error, .. }: &Local<'_>) -> Ternary {
        let [low, high] = range;
        if low > error {
            Ternary::Out
        } else if high < -error {
            Ternary::In
        } else {
            Ternary::Unknown
        }
    }
}

struct Rivlin;

impl KeepsSign for Rivlin {
    /// The bound needs the sign at every coefficient but the extreme one.
    fn sign(polynomial: &Local<'_>) -> Ternary {
        let simple = Bezier::sign(polynomial);
        if simple != Ternary::Unknown {
            simple
        } else if rivlin_lower_bound(polynomial, 1.0) > polynomial.error {
            Ternary::Out
        } else if rivlin_lower_bound(polynomial, -1.0) > polynomial.error {
            Ternary::In
        } else {
            Ternary::Unknown
        }
    }
}

/// How the range of a polynomial in a simplex is bounded.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Criterion {
    /// By its smallest and largest Bernstein coefficient (thesis 4.4.2).
    #[default]
    Bezier,
    /// The same, sharpened where one coefficient alone spoils the sign (Rivlin, thesis 4.4.3).
    Rivlin,
    /// By its value at the barycentre and the largest gradient (thesis 4.4.1).
    Lipschitz,
}

/// A primitive in a simplex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Class {
    value: Ternary,
    /// Its smallest coefficient.
    pub low: f64,
    /// Its largest one.
    pub high: f64,
}

impl Class {
    /// Of a polynomial that does not change; zero is inside.
    pub(crate) fn of_constant(value: f64) -> Self {
        Self {
            value: if value > 0.0 {
                Ternary::Out
            } else {
                Ternary::In
            },
            low: value,
            high: value,
        }
    }

    /// `In` when p < 0 is proved in the whole simplex, `Out` when p > 0 is.
    pub(crate) fn value(&self) -> Ternary {
        self.value
    }

    /// Its largest absolute coefficient.
    pub(crate) fn largest(&self) -> f64 {
        self.high.max(-self.low)
    }
}

/// Classifies against `p ≤ 0` in a simplex of type `kind`; `error` bounds the absolute error of
/// the coefficients.
#[must_use]
pub(crate) fn classify(
    criterion: Criterion,
    kind: u8,
    degree: usize,
    coefficients: &[f64],
    error: f64,
) -> Class {
    let (low, high) = match degree {
        1 => range::<4>(coefficients),
        2 => range::<10>(coefficients),
        3 => range::<20>(coefficients),
        4 => range::<35>(coefficients),
        5 => range::<56>(coefficients),
        6 => range::<84>(coefficients),
        _ => coefficients
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), c| {
                (low.min(*c), high.max(*c))
            }),
    };
    let polynomial = Local {
        kind,
        degree,
        coefficients,
        error,
        range: [low, high],
    };
    let value = match criterion {
        Criterion::Bezier => Bezier::sign(&polynomial),
        Criterion::Rivlin => Rivlin::sign(&polynomial),
        Criterion::Lipschitz => Lipschitz::sign(&polynomial),
    };
    Class { value, low, high }
}

fn range<const N: usize>(coefficients: &[f64]) -> (f64, f64) {
    let Some(c) = coefficients.first_chunk::<N>() else {
        return (f64::NEG_INFINITY, f64::INFINITY);
    };
    let (mut low, mut high) = (c[0], c[0]);
    for x in &c[1..] {
        low = if *x < low { *x } else { low };
        high = if *x > high { *x } else { high };
    }
    (low, high)
}

/// Lower bound of `sign · p`: with c_m the smallest coefficient and c_next the one after it,
/// p ≥ c_next + (c_m − c_next)·B_m, and the Bernstein polynomial B_m is largest at m/n.
fn rivlin_lower_bound(polynomial: &Local<'_>, sign: f64) -> f64 {
    let degree = polynomial.degree;
    let mut smallest = (f64::INFINITY, [0; 4]);
    let mut next = f64::INFINITY;
    for_each_index(degree, |at, exponents| {
        let c = sign * polynomial.coefficients[at];
        if c < smallest.0 {
            next = smallest.0;
            smallest = (c, exponents);
        } else if c < next {
            next = c;
        }
    });
    let (extreme, exponents) = smallest;
    let bound = next + (extreme - next) * largest_bernstein(degree, exponents);
    // A difference, a product and a sum, each rounded once.
    bound - 2.0 * f64::EPSILON * (next.abs() + extreme.abs())
}

/// B_m(m/n) = n!/(i!j!k!l!) · Π (m_v/n)^m_v.
fn largest_bernstein(degree: usize, exponents: [usize; 4]) -> f64 {
    let mut value = 1.0;
    let mut drawn = 0;
    for exponent in exponents {
        for t in 1..=exponent {
            drawn += 1;
            value *= f64::from(drawn) / t as f64 * exponent as f64 / degree as f64;
        }
    }
    // Rounded upwards: at most four roundings a factor.
    (value * (1.0 + 4.0 * degree as f64 * f64::EPSILON)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::{count, evaluate};
    use proptest::prelude::*;

    proptest! {
        /// One suite for all criteria: never `Out` or `In` where a sample says otherwise.
        #[test]
        fn classification_is_sound(
            name in 0usize..3, kind in 0u8..3, degree in 1usize..6, shift in -1.0..1.0f64,
            seed in proptest::collection::vec(-1.0..1.0f64, 56),
            samples in proptest::collection::vec(proptest::array::uniform4(0.0..1.0f64), 20),
        ) {
            let criterion = [Criterion::Bezier, Criterion::Rivlin, Criterion::Lipschitz][name];
            let c: Vec<f64> = seed[..count(degree)].iter().map(|x| x + shift).collect();
            let class = classify(criterion, kind, degree, &c, 1e-12).value();
            for b in samples {
                let sum = b.iter().sum::<f64>().max(1e-9);
                let value = evaluate(degree, &c, b.map(|x| x / sum));
                match class {
                    Ternary::In => prop_assert!(value < 0.0),
                    Ternary::Out => prop_assert!(value > 0.0),
                    Ternary::Unknown => {}
                }
            }
        }
    }

    /// x² − 0.4·x·(1−x)·2 + (1−x)² over the edge v0–v3: the middle coefficient alone is negative.
    #[test]
    fn rivlin_decides_more_than_bezier() {
        let mut c = vec![1.0; 10];
        c[3] = -0.4;
        let by = |criterion| classify(criterion, 0, 2, &c, 0.0).value();
        assert_eq!(by(Criterion::Bezier), Ternary::Unknown);
        assert_eq!(by(Criterion::Rivlin), Ternary::Out);
    }
}
