//! A thousand parts.

use crate::case::{BALL, Case, case, pieces};
use crate::round::lens;
use crate::tree::{ball, block, cylinder, union};
use std::f64::consts::PI;

/// 1,000 places on a grid.
fn grid() -> impl Iterator<Item = [f64; 3]> {
    (0..1000).map(|n| [n % 10, n / 10 % 10, n / 100].map(f64::from))
}

pub(crate) fn cases() -> Vec<Case> {
    let unit_ball = 4.0 / 3.0 * PI;
    let small = unit_ball * 0.4_f64.powi(3);
    vec![
        case(
            "a thousand balls",
            union(grid().map(|[x, y, z]| ball(0.4).at(x, y, z))),
            1000.0 * small,
            [pieces(1000)],
        ),
        case(
            "a thousand cavities",
            block([-1.0; 3], [10.0; 3]) - union(grid().map(|[x, y, z]| ball(0.4).at(x, y, z))),
            1331.0 - 1000.0 * small,
            [BALL.cavities(1000)],
        ),
        case(
            "a thousand cubes that fill a cube",
            union(grid().map(|[x, y, z]| block([x, y, z], [x + 1.0, y + 1.0, z + 1.0]))),
            1000.0,
            [BALL],
        ),
        case(
            "a plate with a thousand holes",
            block([-1., -1., 0.], [40., 25., 1.])
                - union((0..1000).map(|n| {
                    cylinder(0.3, -1.0, 2.0).at(f64::from(n % 40), f64::from(n / 40), 0.0)
                })),
            41.0 * 26.0 - 1000.0 * PI * 0.09,
            [BALL.genus(1000)],
        )
        .within(0.004),
        // Neighbours overlap, others are at least 2 apart.
        case(
            "a necklace of a thousand beads",
            {
                let radius = 0.75 / (PI / 1000.0).sin();
                union((0..1000).map(|n| {
                    let turn = 2.0 * PI * f64::from(n) / 1000.0;
                    ball(1.0).at(radius * turn.cos(), radius * turn.sin(), 0.0)
                }))
            },
            1000.0 * (unit_ball - lens(1.5)),
            [BALL.genus(1)],
        )
        .within(6e-4),
    ]
}
