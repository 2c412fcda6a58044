//! Solids bounded by sines, exponentials and roots, against integrals in one or two variables.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

use brep::Properties;
use csg::{Aabb, Domain, Formula, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use subdiv::functions::{Bound, Expression, subdivide};

fn inside(primitive: u32) -> FormulaNode {
    FormulaNode::Literal(Literal {
        primitive: PrimitiveId(primitive),
        sense: Sense::Inside,
        material: MaterialId(0),
    })
}

/// Where all functions are negative, between two corners.
fn measure(functions: &[Expression], [min, max]: [DVec3; 2], level: u8) -> Properties {
    let domain = Domain::around(&Aabb { min, max });
    let count = u32::try_from(functions.len()).unwrap();
    let mut nodes = vec![FormulaNode::Intersection { len: count }];
    nodes.extend((0..count).map(inside));
    let formula = Formula::new(nodes).unwrap();
    let [loose, sharp] = [Bound::Interval, Bound::Slope].map(|bound| {
        let outcome = subdivide(functions, &formula, &domain, level, bound);
        outcome.unwrap()
    });
    assert_eq!(loose.fragments, sharp.fragments);
    assert!(sharp.simplices < loose.simplices);
    let stitched = brep::stitch(&sharp.fragments).unwrap();
    Properties::of(&stitched.validate().unwrap())
}

/// ∫ over [from, to] by Simpson's rule.
fn integral(from: f64, to: f64, of: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 2000;
    let step = (to - from) / f64::from(STEPS);
    let weight = |at: u32| match at {
        0 | STEPS => 1.0,
        at if at % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = (0..=STEPS)
        .map(|at| weight(at) * of(from + f64::from(at) * step))
        .sum();
    sum * step / 3.0
}

fn close(got: f64, expected: f64, relative: f64) {
    assert!(
        (got / expected - 1.0).abs() < relative,
        "{got} instead of {expected}"
    );
}

/// exp(−|p − a|²) + exp(−|p + a|²) ≥ c with a = (0.7, 0, 0) is a solid of revolution of squared
/// radius r = ln((exp(−(x − 0.7)²) + exp(−(x + 0.7)²))/c).
#[test]
fn a_blob_of_two_exponentials_has_the_volume_and_area_of_its_integrals() {
    const SHIFT: f64 = 0.7;
    const LEAST: f64 = 0.5;
    let [x, y, z] = Expression::variables();
    let bump = |shift: f64| {
        let along = (x.clone() + Expression::from(shift)).square();
        (-(along + y.clone().square() + z.clone().square())).exp()
    };
    let blob = Expression::from(LEAST) - bump(SHIFT) - bump(-SHIFT);
    let half = DVec3::new(1.7, 1.1, 1.1);
    let properties = measure(&[blob], [-half, half], 18);

    let sum = |x: f64| (-(x - SHIFT).powi(2)).exp() + (-(x + SHIFT).powi(2)).exp();
    let squared = |x: f64| (sum(x) / LEAST).ln().max(0.0);
    // d(r)/dx / 2.
    let slope = |x: f64| {
        let terms = [x - SHIFT, x + SHIFT].map(|d| -2.0 * d * (-d * d).exp());
        0.5 * (terms[0] + terms[1]) / sum(x)
    };
    let mut end = [SHIFT, 3.0];
    for _ in 0..60 {
        let middle = f64::midpoint(end[0], end[1]);
        end[usize::from(sum(middle) < LEAST)] = middle;
    }
    let end = end[0];
    let volume = PI * integral(-end, end, squared);
    let area = TAU * integral(-end, end, |x| (squared(x) + slope(x).powi(2)).sqrt());
    // Six halvings of a domain of 3.7: facets of 0.06 across curvature 1 err by 1e-3.
    close(properties.volume, volume, 3e-3);
    close(properties.area, area, 3e-3);
}

fn gyroid(shift: f64) -> Expression {
    let [x, y, z] = Expression::variables();
    x.clone().sin() * y.clone().cos() + y.sin() * z.clone().cos() + z.sin() * x.cos()
        - Expression::from(shift)
}

/// The six half-spaces of a cube around the origin.
fn cube(half: f64) -> Vec<Expression> {
    let sides = Expression::variables()
        .into_iter()
        .flat_map(|axis| [axis.clone(), -axis]);
    sides.map(|side| side - Expression::from(half)).collect()
}

/// sin x cos y + sin y cos z + sin z cos x ≤ t over a period. Along z the function is
/// R sin(z + φ) + C with R² = cos²x + sin²y, C = sin x cos y, so the part below t is known;
/// t = 0 gives half the cube by symmetry.
#[test]
fn a_gyroid_fills_the_part_that_its_integral_says() {
    const STEPS: u32 = 400;
    for shift in [0.0, 0.6] {
        let mut functions = vec![gyroid(shift)];
        functions.extend(cube(PI));
        let properties = measure(&functions, [DVec3::splat(-PI), DVec3::splat(PI)], 18);
        let at = |step: u32| TAU * f64::from(step) / f64::from(STEPS);
        // Periodic: the rule of rectangles.
        let below = |x: f64, y: f64| {
            let reach = x.cos().hypot(y.sin());
            let level = (shift - x.sin() * y.cos()) / reach.max(1e-12);
            0.5 + level.clamp(-1.0, 1.0).asin() / PI
        };
        let lines = (0..STEPS * STEPS).map(|s| below(at(s % STEPS), at(s / STEPS)));
        let part = lines.sum::<f64>() / f64::from(STEPS * STEPS);
        if shift == 0.0 {
            close(part, 0.5, 1e-12);
        }
        close(properties.volume, part * TAU.powi(3), 2e-3);
        // Schoen's minimal surface has 3.0915 a² in a cell of edge a, 1 % less than this one at
        // most; the cube's faces are half covered at t = 0, by symmetry.
        if shift == 0.0 {
            let inner = properties.area - 3.0 * TAU.powi(2);
            close(inner, 3.0915 * TAU.powi(2), 1.5e-2);
        }
    }
}

/// √(x² + y²) as such: a torus without its quartic, 2π²·R·r².
#[test]
fn a_torus_by_a_square_root_has_its_volume() {
    let [x, y, z] = Expression::variables();
    let ring = (x.square() + y.square()).sqrt() - Expression::from(1.0);
    let torus = (ring.square() + z.square()).sqrt() - Expression::from(0.4);
    let half = DVec3::new(1.4, 1.4, 0.4);
    let properties = measure(&[torus], [-half, half], 18);
    close(properties.volume, 2.0 * PI.powi(2) * 0.16, 5e-3);
    close(properties.area, 4.0 * PI.powi(2) * 0.4, 5e-3);
}
