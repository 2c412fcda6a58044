//! The bound that each primitive carries, against its polynomial in exact rational numbers.

use csg::{Aabb, ModelBuilder, Node, Polynomial, Shape, Solid, Transform};
use glam::DVec3;
use num_rational::BigRational;
use proptest::prelude::*;
use std::collections::BTreeMap;

type Rows = [[f64; 4]; 4];
type ExactRows = Vec<Vec<BigRational>>;
/// Exponents of (x, y, z, w), and the coefficient.
type Terms = BTreeMap<[usize; 4], BigRational>;

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn integer(value: i32) -> BigRational {
    BigRational::from_integer(value.into())
}

/// Gauss–Jordan elimination; pivots are nonzero for the diagonally dominant rows used here.
fn inverse(m: &Rows) -> ExactRows {
    let mut left: ExactRows = m.iter().map(|row| row.map(exact).to_vec()).collect();
    let unit = |i: usize| (0..4).map(|j| integer(i32::from(i == j))).collect();
    let mut right: ExactRows = (0..4).map(unit).collect();
    for column in 0..4 {
        let pivot = left[column][column].clone();
        for entry in left[column].iter_mut().chain(&mut right[column]) {
            *entry /= &pivot;
        }
        for row in (0..4).filter(|row| *row != column) {
            let factor = left[row][column].clone();
            for j in 0..4 {
                let (l, r) = (&left[column][j] * &factor, &right[column][j] * &factor);
                left[row][j] -= l;
                right[row][j] -= r;
            }
        }
    }
    right
}

fn product(a: &ExactRows, b: &ExactRows) -> ExactRows {
    let entry = |i: usize, j: usize| (0..4).map(|k| &a[i][k] * &b[k][j]).sum();
    (0..4)
        .map(|i| (0..4).map(|j| entry(i, j)).collect())
        .collect()
}

/// `p(X M)` by multiplying out every term.
fn substituted(p: &Polynomial, m: &ExactRows) -> Terms {
    let mut sum = Terms::new();
    for (exponents, c) in p.terms() {
        let mut term = Terms::from([([0; 4], exact(c))]);
        for (axis, exponent) in exponents.into_iter().enumerate() {
            for _ in 0..exponent {
                let mut next = Terms::new();
                for (e, c) in &term {
                    for (row, by) in m.iter().enumerate() {
                        let mut raised = *e;
                        raised[row] += 1;
                        *next.entry(raised).or_insert_with(|| integer(0)) += c * &by[axis];
                    }
                }
                term = next;
            }
        }
        for (e, c) in term {
            *sum.entry(e).or_insert_with(|| integer(0)) += c;
        }
    }
    sum
}

fn absolute(value: BigRational) -> BigRational {
    if value < integer(0) { -value } else { value }
}

fn dominant() -> impl Strategy<Value = Rows> {
    proptest::array::uniform4(proptest::array::uniform3(-1.0..1.0f64)).prop_map(|m| {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (3, 3) => 1.0,
                (_, 3) => 0.0,
                _ => m[i][j] + if i == j { 3.0 } else { 0.0 },
            })
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// There is a factor by which primitive and exact polynomial differ by at most the bound.
    #[test]
    fn coefficients_are_within_their_bound(
        terms in proptest::collection::vec(-1.0..1.0f64, 20),
        inner in dominant(), outer in dominant(), far in -1000.0..1000.0f64,
    ) {
        let p = Polynomial::new(3, terms).unwrap();
        let mut builder = ModelBuilder::new();
        let shape = builder.add(Node::Shape(Shape::Polynomial(p.clone())));
        let within = builder.add(Node::Instance(Transform::from_rows(&inner).unwrap(), shape));
        let root = builder.add(Node::Instance(Transform::from_rows(&outer).unwrap(), within));
        let center = DVec3::new(far, 1.0, -0.5 * far);
        let clip = Aabb { min: center - DVec3::splat(2.0), max: center + DVec3::splat(3.0) };
        let Ok(solid) = Solid::build(&builder.finish(root), Some(clip)) else {
            return Ok(());
        };
        let Some(primitive) = solid.primitives.iter().find(|p| p.polynomial.degree() == 3) else {
            return Ok(());
        };
        // From centred coordinates to the model, to the outer instance, to the shape.
        let center = solid.domain.center();
        let half = solid.domain.half_size();
        let to_model = [
            [half, 0.0, 0.0, 0.0],
            [0.0, half, 0.0, 0.0],
            [0.0, 0.0, half, 0.0],
            [center.x, center.y, center.z, 1.0],
        ];
        let to_model = to_model.iter().map(|row| row.map(exact).to_vec()).collect();
        let to_shape = product(&product(&to_model, &inverse(&outer)), &inverse(&inner));
        let truth = substituted(&p, &to_shape);
        let pairs: Vec<_> = primitive.polynomial.terms()
            .map(|(e, c)| (exact(c), truth.get(&e).cloned().unwrap_or_else(|| integer(0))))
            .collect();
        let (largest, its_truth) = pairs.iter().max_by_key(|(c, _)| absolute(c.clone())).unwrap();
        // Equating the largest coefficients instead of using the unknown best factor at most
        // doubles the error, but for the square of the bound.
        let factor = largest / its_truth;
        let bound = exact(2.0 * primitive.coefficient_error * (1.0 + 1e-9));
        for (c, truth) in &pairs {
            prop_assert!(absolute(c - truth * &factor) <= bound);
        }
        // A bound that says nothing would pass, too: 46 roundings on the absolute polynomial.
        prop_assert!(primitive.coefficient_error < 1e-8);
    }
}
