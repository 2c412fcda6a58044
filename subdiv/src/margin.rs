//! Signs that hold not only in a simplex but within some distance of it.
//!
//! A polynomial is the same one outside a simplex: at barycentric coordinates whose negative ones
//! sum up to −o, the Bernstein polynomials of degree n have absolute values that sum up to at most
//! (1 + 2o)ⁿ. So a polynomial whose coefficients lie in \[m − r, m + r\] stays within r·(1 + 2o)ⁿ of
//! m there. Within a distance d of the simplex o is at most d·N with
//!
//! ```text
//! N = max over unit vectors e of ½·Σ |∇b_v · e| = max over sets V of vertices of |Σ_{v in V} ∇b_v|.
//! ```

use crate::certify::{BarycentricGradients, DegreeTable, barycentric_gradients, gradient};
use crate::classify::Class;
use crate::hessian::Hessian;
use crate::simplex::Simplex;
use crate::walk::Active;

/// N, the largest rate at which negative barycentric coordinates grow with the distance.
#[must_use]
pub(crate) fn outward_rate([a, b, c, d]: &BarycentricGradients) -> f64 {
    let squares = [*a, *b, *c, *d, *a + *b, *a + *c, *a + *d].map(glam::DVec3::length_squared);
    // Rounded outwards: some ten operations.
    squares.into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-14)
}

/// (1 + 2o)ⁿ, rounded outwards.
#[must_use]
pub(crate) fn growth(degree: usize, overshoot: f64) -> f64 {
    let base = 1.0 + 2.0 * overshoot;
    (0..degree).fold(1.0, |power, _| power * base) * (1.0 + 1e-13)
}

/// How far around its simplex a sign must hold.
#[derive(Debug)]
pub(crate) struct Margin {
    /// The distance.
    pub(crate) radius: f64,
    /// N for the simplices of each level.
    rates: Vec<f64>,
    /// Of each primitive.
    hessians: Vec<Option<Hessian>>,
    tables: Vec<DegreeTable>,
}

impl Margin {
    /// A margin of `radius`; `tables`: those of degrees 1, 2, …; `hessians`: of each primitive.
    #[must_use]
    pub(crate) fn new(radius: f64, tables: &[DegreeTable], hessians: &[Option<Hessian>]) -> Self {
        // Simplices of one level are congruent.
        let [mut simplex, ..] = Simplex::roots();
        let mut rates = Vec::new();
        for _ in 0..=crate::lattice::MAX_LEVEL {
            rates.push(outward_rate(&barycentric_gradients(&simplex)));
            [simplex, _] = simplex.children();
        }
        Self {
            radius,
            rates,
            hessians: hessians.to_vec(),
            tables: tables.to_vec(),
        }
    }

    /// N for the simplices of a level.
    #[must_use]
    pub(crate) fn rate(&self, level: u8) -> f64 {
        self.rates[usize::from(level)]
    }

    /// How far around a simplex an active polynomial that has one sign there is proved to keep it.
    /// For degrees above 2 it is either the margin's radius or nothing, see [`Self::keeps_sign`].
    ///
    /// `place`: N there, and the gradients of the simplex' barycentric coordinates.
    #[must_use]
    pub(crate) fn clearance(
        &self,
        place: (f64, &BarycentricGradients),
        active: &Active,
        coefficients: &[f64],
        class: &Class,
    ) -> f64 {
        let (rate, gradients) = place;
        let degree = active.degree as usize;
        let error = || 2.0 * active.error() * growth(degree, self.radius * rate);
        if degree == 1 {
            let (_, slope) = gradient(&self.tables[0], coefficients, gradients);
            let nearest = class.low.max(-class.high) - error();
            return nearest / slope.length() * (1.0 - 1e-14);
        }
        if let Some(hessian) = &self.hessians[active.primitive as usize] {
            let error = error();
            let range = (class.low - error, class.high + error);
            return hessian.clearance(coefficients, range, gradients);
        }
        if self.keeps_sign(self.radius, place, active, coefficients, class) {
            self.radius
        } else {
            0.0
        }
    }

    /// Whether an active polynomial of degree above 2 that has one sign in a simplex is proved to
    /// keep it within `radius` of it.
    #[must_use]
    pub(crate) fn keeps_sign(
        &self,
        radius: f64,
        (rate, gradients): (f64, &BarycentricGradients),
        active: &Active,
        coefficients: &[f64],
        class: &Class,
    ) -> bool {
        let degree = active.degree as usize;
        let growth = growth(degree, radius * rate);
        let error = 2.0 * active.error() * growth;
        let (middle, half) = (
            0.5 * (class.high + class.low),
            0.5 * (class.high - class.low),
        );
        if middle.abs() > half * growth + error {
            return true;
        }
        // More sharply: the affine part goes on as it is, only the rest may grow.
        let table = &self.tables[degree - 1];
        let (values, slope) = gradient(table, coefficients, gradients);
        let nearest = values.iter().map(|v| v.abs()).fold(f64::INFINITY, f64::min);
        let left = nearest - radius * slope.length() - error;
        left > 0.0 && left > table.remainder(coefficients, &values) * growth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::count;
    use crate::blossom::RootCoefficients;
    use crate::classify::{Criterion, classify};
    use crate::halving::halve;
    use csg::Ternary;
    use glam::DVec3;
    use proptest::prelude::*;

    proptest! {
        /// Points at most the radius away from a random point of a random simplex; the oracle is
        /// the power form.
        #[test]
        fn signs_are_kept_within_the_radius(
            degree in 1usize..5, turns in proptest::collection::vec(any::<bool>(), 0..12),
            seed in proptest::collection::vec(-1.0..1.0f64, 35), shift in 0.5..4.0f64,
            radius in 0.001..0.3f64, b in proptest::array::uniform4(0.0..1.0f64),
            directions in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 20),
        ) {
            let mut power = seed[..count(degree)].to_vec();
            *power.last_mut().unwrap() += shift;
            let polynomial = csg::Polynomial::new(degree, power).unwrap();
            let primitive = csg::Primitive { polynomial, coefficient_error: 0.0 };
            let tables: Vec<_> = (1..5).map(DegreeTable::new).collect();
            let margin = Margin::new(radius, &tables, &[Hessian::of(&primitive)]);
            let mut c = RootCoefficients::new(&primitive).roots[2].clone();
            let mut simplex = Simplex::roots()[2];
            for turn in turns {
                let mut halves = [vec![0.0; c.len()], vec![0.0; c.len()]];
                let [near, far] = &mut halves;
                halve(degree, simplex.kind(), &c, near, far);
                simplex = simplex.children()[usize::from(turn)];
                c = std::mem::take(&mut halves[usize::from(turn)]);
            }
            let class = classify(Criterion::Bezier, simplex.kind(), degree, &c, 0.0);
            let gradients = barycentric_gradients(&simplex);
            let place = (margin.rate(simplex.level), &gradients);
            let active = Active {
                primitive: 0, degree: degree as u32, offset: 0, rounding: 0.0, root_rounding: 0.0,
                model_error: 0.0, largest: class.largest(), value: class.value(), clearance: 0.0,
            };
            if class.value() == Ternary::Unknown
                || margin.clearance(place, &active, &c, &class) < radius {
                return Ok(());
            }
            // On the simplex' surface, where leaving it is quickest.
            let mut b = b;
            b[degree % 4] = 0.0;
            let sum = b.iter().sum::<f64>().max(1e-9);
            let at: DVec3 = (0..4).map(|v| simplex.vertices[v].position() * (b[v] / sum)).sum();
            for direction in directions {
                let by = DVec3::from(direction).normalize_or_zero() * radius;
                let value = primitive.polynomial.evaluate(2.0 * (at + by) - 1.0);
                prop_assert_eq!(value > 0.0, class.value() == Ternary::Out);
            }
        }
    }

    #[test]
    fn simplices_of_a_level_leave_equally_fast() {
        let mut layer: Vec<Simplex> = Simplex::roots().into();
        for _ in 0..7 {
            let rates: Vec<f64> = layer
                .iter()
                .map(|s| outward_rate(&barycentric_gradients(s)))
                .collect();
            assert!(rates.iter().all(|r| (r / rates[0] - 1.0).abs() < 1e-12));
            layer = layer.iter().flat_map(Simplex::children).collect();
        }
    }
}
