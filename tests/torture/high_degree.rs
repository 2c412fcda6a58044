//! Chmutov's and Barth's surfaces, and other polynomials of high degree.

use crate::case::{BALL, Case, case};
use crate::tree::{Tree, ball, cube, polynomial, terms};
use csg::{Axis, Polynomial};

fn sound(p: Result<Polynomial, csg::Error>) -> Polynomial {
    p.expect("a polynomial")
}

/// The Chebyshev polynomial of the first kind in one coordinate: T₀ = 1, T₁ = t,
/// Tₙ₊₁ = 2t Tₙ − Tₙ₋₁.
fn chebyshev(degree: usize, axis: Axis) -> Polynomial {
    let t = Polynomial::variable(axis);
    let mut last = sound(Polynomial::constant(1.0));
    let mut this = t.clone();
    for _ in 1..degree {
        let next = sound(sound(t.product(&this)).scaled(2.0));
        (last, this) = (this.clone(), sound(next.difference(&last)));
    }
    this
}

/// Tₙ(x) + Tₙ(y) + Tₙ(z) ≤ 0 in the cube [−1, 1]³, n odd.
///
/// The point reflection changes the sign, so half the cube is inside: 4. On an axis Tₙ has
/// m = (n + 1)/2 minima −1, the end −1 among them, and between neighbours a maximum 1. A sum of
/// three is below zero where at most one is at its maximum: m³ balls, joined along the axes by
/// 3m²(m − 1) necks, have 3m²(m − 1) − m³ + 1 handles (Morse theory).
fn chmutov(name: &'static str, n: usize) -> Case {
    let [x, y, z] = [Axis::X, Axis::Y, Axis::Z].map(|axis| chebyshev(n, axis));
    let m = (n as u64).div_ceil(2);
    let tree = polynomial(sound(sound(x.sum(&y)).sum(&z))) & cube(2.0);
    case(
        name,
        tree,
        4.0,
        [BALL.genus(3 * m * m * (m - 1) + 1 - m * m * m)],
    )
}

/// 4 (φ²x² − y²)(φ²y² − z²)(φ²z² − x²) − (1 + 2φ)(x² + y² + z² − 1)², with 65 nodes.
fn barth_sextic() -> Tree {
    let golden = f64::midpoint(1.0, 5.0_f64.sqrt());
    let square = golden * golden;
    let term = |axis: usize, c: f64| {
        let mut exponents = [0; 3];
        exponents[axis] = 2;
        (exponents, c)
    };
    let difference =
        |a: usize, b: usize| sound(Polynomial::from_terms(2, &[term(a, square), term(b, -1.0)]));
    let cones =
        sound(sound(difference(0, 1).product(&difference(1, 2))).product(&difference(2, 0)));
    let sphere = [term(0, 1.0), term(1, 1.0), term(2, 1.0), ([0; 3], -1.0)];
    let sphere = sound(sound(Polynomial::from_terms(2, &sphere)).power(2));
    let cones = sound(cones.scaled(4.0));
    let sphere = sound(sphere.scaled(1.0 + 2.0 * golden));
    polynomial(sound(cones.difference(&sphere)))
}

/// Its volume within the ball of radius 2, summed over rays from the centre: with k = 4A/(1 + 2φ),
/// A the product of the three differences, a point at squared distance s is inside where
/// k s³ ≤ (s − 1)². Midpoint and Gauß-Legendre rules with 1600² nodes an octant: ±3e-5.
const BARTH_IN_BALL: f64 = 32.1170;

/// xⁿ + yⁿ + zⁿ ≤ 1.
fn superball(n: usize) -> Tree {
    let term = |axis: usize| {
        let mut exponents = [0; 3];
        exponents[axis] = n;
        (exponents, 1.0)
    };
    terms(n, &[term(0), term(1), term(2), ([0; 3], -1.0)])
}

pub(crate) fn cases() -> Vec<Case> {
    vec![
        chmutov("Chmutov's cubic", 3),
        chmutov("Chmutov's quintic", 5),
        chmutov("Chmutov's septic", 7).within(0.01),
        case(
            "Barth's sextic in a ball",
            barth_sextic() & ball(2.0),
            BARTH_IN_BALL,
            Vec::new(),
        ),
        // 8 Γ(1 + 1/n)³/Γ(1 + 3/n).
        case(
            "a superball of degree 6",
            superball(6),
            8.0 * 0.927_719_333_630_039_f64.powi(3) / 0.886_226_925_452_758,
            [BALL],
        ),
        case(
            "a superball of degree 10",
            superball(10),
            8.0 * 0.951_350_769_866_873_f64.powi(3) / 0.897_470_696_306_277,
            [BALL],
        ),
    ]
}
