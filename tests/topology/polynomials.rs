//! Random quartics and sextics, clipped by a box: one polynomial with many sheets.

use crate::agreement::{Verdict, compare};
use crate::seed;
use crate::trees::{number, runner};
use csg::{Model, ModelBuilder, Node, Polynomial, Shape};
use glam::DVec3;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use rayon::prelude::*;

/// n! / (i! j! k! l!).
fn multinomial(exponents: [usize; 4]) -> f64 {
    let mut value = 1.0;
    let mut drawn = 0;
    for exponent in exponents {
        for t in 1..=exponent {
            drawn += 1;
            value *= f64::from(drawn) / t as f64;
        }
    }
    value
}

/// A polynomial whose terms are as large as those of a random one on the sphere (Kostlan's
/// ensemble), so that its zero set has parts of all sizes; clipped by an oblique box.
fn model(degree: usize, random: &[f64]) -> Model {
    let mut terms = Vec::new();
    let mut next = random.iter();
    for i in 0..=degree {
        for j in 0..=degree - i {
            for k in 0..=degree - i - j {
                let weight = multinomial([i, j, k, degree - i - j - k]).sqrt();
                terms.push(([i, j, k], weight * next.next().unwrap()));
            }
        }
    }
    let mut builder = ModelBuilder::new();
    let polynomial = Polynomial::from_terms(degree, &terms).unwrap();
    let curved = builder.add(Node::Shape(Shape::Polynomial(polynomial)));
    let half = DVec3::new(1.1, 0.93, 1.27);
    let block = builder.add(Node::Shape(Shape::block(-half, half * 0.87).unwrap()));
    let both = builder.add(Node::Intersection(vec![curved, block]));
    builder.finish(both)
}

fn agree(degree: usize, count: u64) -> Vec<Verdict> {
    let terms = (degree + 1) * (degree + 2) * (degree + 3) / 6;
    let strategy = proptest::collection::vec(-1.0..1.0f64, terms);
    let mut runner = runner(seed());
    let random: Vec<Vec<f64>> = (0..count)
        .map(|_| strategy.new_tree(&mut runner).unwrap().current())
        .collect();
    random
        .par_iter()
        .enumerate()
        .map(|(at, random)| {
            let name = || format!("number {at} of degree {degree}: {random:?}");
            compare(&model(degree, random), 1e-5, &name)
        })
        .collect()
}

/// `CSG2BREP_POLYNOMIALS=500 cargo test --release --test topology polynomials` runs more.
fn agree_in_every_position(degree: usize) {
    let count = number("CSG2BREP_POLYNOMIALS", 20);
    let verdicts = agree(degree, count);
    println!(
        "degree {degree}, seed {}: {}",
        seed(),
        Verdict::summary(&verdicts)
    );
    assert!(verdicts.iter().all(|v| v.certified));
    let compared = verdicts.iter().filter(|v| v.metric.is_some()).count();
    assert!(compared as u64 * 10 > count * 8, "{compared}");
}

#[test]
fn random_quartics_agree_in_every_position() {
    agree_in_every_position(4);
}

#[test]
fn random_sextics_agree_in_every_position() {
    agree_in_every_position(6);
}
