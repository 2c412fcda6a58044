//! The criterion of Lipschitz (thesis 4.4.1): a function that changes by at most L a unit of
//! length, and is larger than L·d at the barycentre of a simplex whose vertices are at most d
//! away, has no zero there.
//!
//! L is the largest length of a Bernstein coefficient of the gradient: the gradient is a convex
//! combination of them. For quadrics they are its values at the vertices, and L is the smallest
//! possible constant. Lengths are measured in the unit cube of which the simplex is a part.

use crate::bernstein::{for_each_index, index};
use crate::classify::{KeepsSign, Local};
use csg::Ternary;

/// Squared distance of the barycentre from the farthest vertices of types 0, 1 and 2.
const SQUARED_RADII: [f64; 3] = [0.875, 0.546_875, 0.328_125];

pub(crate) struct Lipschitz;

impl KeepsSign for Lipschitz {
    fn sign(polynomial: &Local<'_>) -> Ternary {
        let &Local {
            kind,
            degree,
            coefficients,
            error,
            ..
        } = polynomial;
        let Some(of_gradient) = degree.checked_sub(1) else {
            return Ternary::Unknown;
        };
        let mut squared_slope = 0.0f64;
        let n = degree as f64;
        for_each_index(of_gradient, |at, [_, j, k, l]| {
            // In both degrees the coefficient that has the (j, k, l) of this one stands at its place.
            let along = |a: usize, b: usize, c: usize| {
                n * (coefficients[index(j + a, k + b, l + c)] - coefficients[at])
            };
            let gradient = in_frame(kind, [along(1, 0, 0), along(0, 1, 0), along(0, 0, 1)]);
            squared_slope = squared_slope.max(gradient.iter().map(|g| g * g).sum());
        });
        let mut middle = 0.0;
        let mut largest = 0.0f64;
        for_each_index(degree, |at, exponents| {
            middle += at_barycentre(exponents) * coefficients[at];
            largest = largest.max(coefficients[at].abs());
        });
        let variation = (squared_slope * SQUARED_RADII[usize::from(kind)]).sqrt();
        // Rounding of the sum and of the weights, relative to the largest coefficient; of the slope,
        // and what the coefficients' own error makes of it: each of its
        // three components is off by at most 6n·error.
        let sum = (coefficients.len() + 8 * degree + 8) as f64 * f64::EPSILON * largest;
        let slack = sum + (1.0 + 14.0 * n) * error + variation * 16.0 * f64::EPSILON;
        if middle > variation + slack {
            Ternary::Out
        } else if middle < -variation - slack {
            Ternary::In
        } else {
            Ternary::Unknown
        }
    }
}

/// The vector whose products with the edges v0–v1, v0–v2, v0–v3 are these, in orthonormal axes.
///
/// Up to symmetries of the cube type 0 is 000, 100, 110, 111; its near child of type 1 is
/// 000, ½½½, 100, 110, and that one's of type 2 is 000, ½½0, ½½½, 100.
fn in_frame(kind: u8, [a, b, c]: [f64; 3]) -> [f64; 3] {
    match kind {
        0 => [a, b - a, c - b],
        1 => [b, c - b, 2.0 * a - c],
        _ => [c, 2.0 * a - c, 2.0 * (b - a)],
    }
}

/// The Bernstein polynomial n!/(i!j!k!l!) · tⁱuʲvᵏwˡ at t = u = v = w = 1/4.
fn at_barycentre(exponents: [usize; 4]) -> f64 {
    let mut value = 1.0;
    let mut drawn = 0;
    for exponent in exponents {
        for t in 1..=exponent {
            drawn += 1;
            value *= f64::from(drawn) / t as f64 * 0.25;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blossom::{RootCoefficients, centered};
    use crate::halving::halve;
    use crate::simplex::Simplex;
    use csg::{Polynomial, Primitive};
    use glam::DVec3;

    /// Of a plane the criterion knows the slope exactly, whatever the simplex: it decides exactly
    /// where the plane misses the ball around the barycentre.
    #[test]
    fn planes_are_decided_outside_the_ball_around_a_simplex() {
        let normal = DVec3::new(0.48, -0.6, 0.64);
        let mut decided = [0; 2];
        for offset in [-0.4, -0.1, 0.05, 0.2, 0.45, 0.7] {
            let polynomial = centered(&Polynomial::affine(normal, offset).unwrap());
            let primitive = Primitive {
                polynomial,
                coefficient_error: 0.0,
            };
            let roots = RootCoefficients::new(&primitive).roots;
            let mut layer: Vec<_> = Simplex::roots().into_iter().zip(roots).collect();
            for _ in 0..7 {
                for (simplex, c) in &layer {
                    let corners = simplex.vertices.map(crate::lattice::Point::position);
                    let middle = corners.iter().sum::<DVec3>() / 4.0;
                    let radius = corners
                        .iter()
                        .map(|v| v.distance(middle))
                        .fold(0.0, f64::max);
                    let distance = normal.dot(middle) - offset;
                    if (distance.abs() - radius).abs() < 1e-9 {
                        continue;
                    }
                    let expected = if distance > radius {
                        Ternary::Out
                    } else if distance < -radius {
                        Ternary::In
                    } else {
                        Ternary::Unknown
                    };
                    let local = Local {
                        kind: simplex.kind(),
                        degree: 1,
                        coefficients: c,
                        error: 1e-15,
                        range: [0.0; 2],
                    };
                    assert_eq!(Lipschitz::sign(&local), expected);
                    decided[usize::from(expected == Ternary::Unknown)] += 1;
                }
                layer = layer
                    .iter()
                    .flat_map(|(simplex, c)| {
                        let (mut near, mut far) = (vec![0.0; 4], vec![0.0; 4]);
                        halve(1, simplex.kind(), c, &mut near, &mut far);
                        simplex.children().into_iter().zip([near, far])
                    })
                    .collect();
            }
        }
        assert!(decided.iter().all(|n| *n > 100), "{decided:?}");
    }
}
