//! Cone apexes, cusps, tacnodes and self-crossings, alone and in contact.

use crate::case::{BALL, Case, case, pieces};
use crate::tree::{Tree, ball, block, cone, cube, terms, union};
use std::f64::consts::PI;

const X2: [usize; 3] = [2, 0, 0];
const Y2: [usize; 3] = [0, 2, 0];

/// x² + y² ≤ q(z), by the terms of q: a surface of revolution, cut to |z| ≤ 1.5, where all of it
/// lies.
fn revolved(degree: usize, q: &[(usize, f64)]) -> Tree {
    let mut all = vec![(X2, 1.0), (Y2, 1.0)];
    all.extend(q.iter().map(|(n, c)| ([0, 0, *n], -c)));
    terms(degree, &all) & cube(3.0)
}

fn upside_down(tree: Tree) -> Tree {
    tree.mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]])
}

pub(crate) fn cases() -> Vec<Case> {
    let apart_or_joined = || [pieces(2), BALL];
    // Apex at the origin, opening downward at 45°.
    let hat = || cone(1.0, 0.0, -1.0, 0.0);
    let third = PI / 3.0;
    vec![
        case("a cone", hat(), third, [BALL]),
        case(
            "a needle of 1 : 100",
            cone(0.1, 0.0, 0.0, 10.0),
            0.1 * third,
            [BALL],
        )
        .within(0.002),
        case(
            "an hourglass of two cones",
            hat() | upside_down(hat()),
            2.0 * third,
            apart_or_joined(),
        ),
        case(
            "an hourglass of one quadric",
            terms(2, &[(X2, 1.0), (Y2, 1.0), ([0, 0, 2], -1.0)])
                & block([-2., -2., -1.], [2., 2., 1.]),
            2.0 * third,
            apart_or_joined(),
        ),
        case(
            "a spindle of two cones",
            hat() | upside_down(hat()).at(0.0, 0.0, -2.0),
            2.0 * third,
            [BALL],
        ),
        case(
            "two apexes at right angles",
            hat() | upside_down(hat()).along_x(),
            2.0 * third,
            apart_or_joined(),
        ),
        case(
            "six apexes at one point",
            union([
                cone(0.5, 0.0, -1.0, 0.0),
                cone(0.5, 0.0, -1.0, 0.0).along_x(),
                cone(0.5, 0.0, -1.0, 0.0).along_y(),
                upside_down(cone(0.5, 0.0, -1.0, 0.0)),
                upside_down(cone(0.5, 0.0, -1.0, 0.0)).along_x(),
                upside_down(cone(0.5, 0.0, -1.0, 0.0)).along_y(),
            ]),
            6.0 * third / 4.0,
            // Rounding may join any of them.
            (1..=6).map(pieces).collect::<Vec<_>>(),
        ),
        case(
            "an apex on a face",
            block([-2., -2., -1.], [2., 2., 0.]) | upside_down(hat()),
            16.0 + third,
            apart_or_joined(),
        ),
        case(
            "an apex on a ball",
            ball(1.0).at(0.0, 0.0, -1.0) | upside_down(hat()),
            5.0 * third,
            apart_or_joined(),
        ),
        case(
            "a dent down to a cone's apex",
            cube(2.0) - upside_down(hat()),
            8.0 - third,
            [BALL],
        ),
        case(
            "a hole through a block that pinches to a point",
            cube(2.0) - (hat() | upside_down(hat())),
            8.0 - 2.0 * third,
            // The rims touch the side faces nowhere: radius 1 at z = ±1 meets the edges' middles.
            [BALL, BALL.genus(1)],
        )
        .within(0.01),
        case(
            "a cone out of a ball, apex at its centre",
            ball(1.0) & terms(2, &[(X2, -1.0), (Y2, -1.0), ([0, 0, 2], 1.0)]),
            // 4π/3 less two sectors 2π/3 (1 − cos 45°) each.
            4.0 * third - 4.0 * third * (1.0 - 0.5_f64.sqrt()),
            // A ring around the axis, closed at the centre or not.
            [BALL.genus(1), BALL],
        ),
        case(
            "a cusp, extruded: y² ≤ x³",
            terms(3, &[(Y2, 1.0), ([3, 0, 0], -1.0)]) & block([-1., -2., 0.], [1., 2., 1.]),
            0.8,
            [BALL],
        ),
        case(
            "two cusps at one edge: y² ≤ x⁶",
            terms(6, &[(Y2, 1.0), ([6, 0, 0], -1.0)]) & block([-1., -2., 0.], [1., 2., 1.]),
            1.0,
            Vec::new(),
        ),
        case(
            "a teardrop: z³ (1 − z)",
            revolved(4, &[(3, 1.0), (4, -1.0)]),
            PI / 20.0,
            [BALL],
        ),
        case(
            "an eight: z² (1 − z²)",
            revolved(4, &[(2, 1.0), (4, -1.0)]),
            4.0 * PI / 15.0,
            apart_or_joined(),
        ),
        case(
            "two drops with a tacnode: z⁴ (1 − z²)",
            revolved(6, &[(4, 1.0), (6, -1.0)]),
            4.0 * PI / 35.0,
            apart_or_joined(),
        ),
        // Area of the lemniscate (x² + y²)² = x² − y²: 1.
        case(
            "Bernoulli's lemniscate, extruded",
            terms(
                4,
                &[
                    ([4, 0, 0], 1.0),
                    ([2, 2, 0], 2.0),
                    ([0, 4, 0], 1.0),
                    (X2, -1.0),
                    (Y2, 1.0),
                ],
            ) & block([-2., -2., 0.], [2., 2., 1.]),
            1.0,
            Vec::new(),
        ),
        case(
            "two planes in one polynomial",
            terms(2, &[(X2, 1.0), (Y2, -1.0)]) & cube(2.0),
            4.0,
            Vec::new(),
        ),
    ]
}
