//! Section 6.3.2: lower degrees during subdivision.

use crate::solids::read_fixture;
use crate::{ratio, seconds};
use csg::{ModelBuilder, Node, Polynomial, Shape, Solid};
use glam::DVec3;
use subdiv::methods::{Adaptive, Cell, Halt, adaptive, adaptive_reduced};
use subdiv::{Criterion, Rule, Settings, convert};

const LEVEL: u8 = 15;

/// How far a zero set may move, in smallest simplices.
const ALLOWED: f64 = 0.01;

/// Prints what is saved, and which simplices are no longer the same.
pub(crate) fn table() {
    println!("\n**Section 6.3.2** level {LEVEL}, zero sets moved by at most {ALLOWED} simplices\n");
    println!(
        "| solid | degree | visited | coefficients halved | lowered | ms | lowered | minimal | of them others | whole conversion, ms |"
    );
    println!("| :-- | --: | --: | --: | --: | --: | --: | --: | --: | --: |");
    for name in ["S3_torus_sphere", "S7_heart"] {
        let model = read_fixture(&format!("solids/{name}"));
        row(name, &Solid::build(&model, None).expect("bounded"));
    }
    for degree in [6, 8, 10, 14, 20] {
        row("Chmutov", &chmutov(degree));
    }
}

fn row(name: &str, solid: &Solid) {
    let plain = || adaptive(solid, Criterion::Bezier, LEVEL, Halt::Never);
    let lowered = || adaptive_reduced(solid, Criterion::Bezier, LEVEL, Halt::Never, ALLOWED);
    let (with, without) = (lowered(), plain());
    let settings = Settings {
        threads: Some(1),
        ..Settings::new(Rule::Level(LEVEL))
    };
    let degrees = solid.primitives.iter().map(|p| p.polynomial.degree());
    let whole = seconds(|| convert(solid, &settings, &()).expect("few cells"));
    println!(
        "| {name} | {} | {} / {} | {} | {} | {:.1} | {:.1} | {} | {} | {:.1} |",
        degrees.max().unwrap_or(0),
        without.simplices,
        with.simplices,
        without.coefficients,
        ratio(with.coefficients, without.coefficients),
        1e3 * seconds(plain),
        1e3 * seconds(lowered),
        without.found.cells.len(),
        others(&without, &with),
        1e3 * whole,
    );
}

/// Minimal simplices that only one of two runs found.
fn others(one: &Adaptive, other: &Adaptive) -> usize {
    let missing = |from: &[Cell], of: &[Cell]| {
        let lost = from.iter().filter(|cell| of.binary_search(cell).is_err());
        lost.count()
    };
    let (one, other) = (&one.found.cells, &other.found.cells);
    missing(one, other) + missing(other, one)
}

/// Tₙ(x) + Tₙ(y) + Tₙ(z) ≤ 0 in a cube a little larger than [−1, 1]³.
pub(crate) fn chmutov(degree: usize) -> Solid {
    let mut chebyshev = [vec![1.0], vec![0.0, 1.0]];
    for _ in 1..degree {
        let [before, last] = &chebyshev;
        let mut next: Vec<f64> = std::iter::once(&0.0).chain(last).map(|c| 2.0 * c).collect();
        for (sum, c) in next.iter_mut().zip(before) {
            *sum -= c;
        }
        chebyshev = [last.clone(), next];
    }
    let powers = chebyshev[1].iter().enumerate();
    let terms: Vec<([usize; 3], f64)> = powers
        .flat_map(|(power, c)| (0..3).map(move |axis| (axis, power, *c)))
        .map(|(axis, power, c)| {
            let mut exponents = [0; 3];
            exponents[axis] = power;
            (exponents, c)
        })
        .collect();
    let polynomial = Polynomial::from_terms(degree, &terms).expect("finite");
    let mut model = ModelBuilder::new();
    let surface = model.add(Node::Shape(Shape::Polynomial(polynomial)));
    let half = DVec3::splat(1.1);
    let cube = model.add(Node::Shape(Shape::block(-half, half).expect("a block")));
    let root = model.add(Node::Intersection(vec![surface, cube]));
    Solid::build(&model.finish(root), None).expect("bounded")
}
