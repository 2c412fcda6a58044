//! Cavities in cavities, links, thin walls and gaps, small things far away.

use crate::case::{BALL, Case, case, pieces};
use crate::round::torus_volume;
use crate::tree::{Tree, ball, block, cube, cylinder, torus, union};
use std::f64::consts::PI;

fn ball_volume(radius: f64) -> f64 {
    4.0 / 3.0 * PI * radius.powi(3)
}

/// Balls of radius n, n − 1, …, 1, each taken out of what is larger.
fn onion(layers: u32) -> Tree {
    (2..=layers).fold(ball(1.0), |inner, n| ball(f64::from(n)) - inner)
}

fn onion_volume(layers: u32) -> f64 {
    (2..=layers).fold(ball_volume(1.0), |inner, n| {
        ball_volume(f64::from(n)) - inner
    })
}

/// Rings of radius 1 along x, each standing across the last and through it.
fn chain(links: u32) -> Tree {
    union((0..links).map(|n| {
        let link = torus(1.0, 0.2);
        let link = if n % 2 == 0 {
            link
        } else {
            link.along_x().along_x()
        };
        link.at(1.2 * f64::from(n), 0.0, 0.0)
    }))
}

/// A rectangular ring in the plane z = 0 with a square section of side 1.
fn frame() -> Tree {
    block([-4., -2., -0.5], [4., 2., 0.5]) - block([-3., -1., -1.0], [3., 1., 1.0])
}

pub(crate) fn cases() -> Vec<Case> {
    let cells = |n: i32| (-n..=n).flat_map(move |x| (-n..=n).map(move |y| [x, y].map(f64::from)));
    let mut cases = vec![
        case(
            "a hollow ball",
            ball(2.0) - ball(1.0),
            ball_volume(2.0) - ball_volume(1.0),
            [BALL.cavities(1)],
        ),
        // Pieces: layers 4–3, 2–1; both are hollow.
        case(
            "an onion of four layers",
            onion(4),
            onion_volume(4),
            [pieces(2).cavities(2)],
        ),
        case(
            "an onion of nine layers",
            onion(9),
            onion_volume(9),
            [pieces(5).cavities(4)],
        ),
        case(
            "a cheese of 27 cavities",
            cube(6.0)
                - union(cells(1).flat_map(|[x, y]| {
                    [-1.0, 0.0, 1.0].map(|z| ball(0.5).at(1.5 * x, 1.5 * y, 1.5 * z))
                })),
            216.0 - 27.0 * ball_volume(0.5),
            [BALL.cavities(27)],
        ),
        case(
            "a box in a box in a box in a box",
            cube(4.0) - (cube(3.0) - (cube(2.0) - cube(1.0))),
            64.0 - 27.0 + 8.0 - 1.0,
            [pieces(2).cavities(2)],
        ),
        case(
            "two linked tori",
            chain(2),
            2.0 * torus_volume(1.0, 0.2),
            [pieces(2).genus(2)],
        ),
        case(
            "a chain of seven",
            chain(7),
            7.0 * torus_volume(1.0, 0.2),
            [pieces(7).genus(7)],
        )
        .within(0.005),
        case(
            "two linked tunnels, closed in themselves",
            block([-2., -2., -2.], [3.5, 2., 2.]) - chain(2),
            5.5 * 16.0 - 2.0 * torus_volume(1.0, 0.2),
            [BALL.cavities(2).genus(2)],
        ),
        case(
            "Borromean rings",
            frame() | frame().along_x() | frame().along_y(),
            3.0 * (32.0 - 12.0),
            [pieces(3).genus(3)],
        ),
        case(
            "a plate a millionth thick",
            block([0.0; 3], [1.0, 1.0, 1e-6]),
            1e-6,
            [BALL],
        ),
        case(
            "a cube with walls of 1e-9",
            cube(2.0) - cube(2.0 - 2e-9),
            24e-9 - 24e-18,
            [BALL.cavities(1)],
        ),
        case(
            "a gap of 1e-9 between cubes",
            cube(1.0) | cube(1.0).at(1.0 + 1e-9, 0.0, 0.0),
            2.0,
            [pieces(2)],
        ),
        case(
            "cubes that overlap by 1e-9",
            cube(1.0) | cube(1.0).at(1.0 - 1e-9, 0.0, 0.0),
            2.0 - 1e-9,
            [BALL],
        ),
        case(
            "a step of 1e-9",
            cube(1.0) | cube(1.0).at(1.0, 0.0, 1e-9),
            2.0,
            [BALL],
        ),
        case(
            "a can with walls of 1e-6",
            cylinder(1.0, -1.0, 1.0) - cylinder(1.0 - 1e-6, -1.0 + 1e-6, 1.0 - 1e-6),
            2.0 * PI - PI * (1.0 - 1e-6_f64).powi(2) * (2.0 - 2e-6),
            [BALL.cavities(1)],
        ),
        case(
            "a tube with walls of 1e-9",
            cylinder(1.0, -1.0, 1.0) - cylinder(1.0 - 1e-9, -2.0, 2.0),
            2.0 * PI * (2e-9 - 1e-18),
            [BALL.genus(1)],
        ),
        case(
            "a ball with walls of 1e-9",
            ball(1.0) - ball(1.0 - 1e-9),
            4.0 * PI * (1e-9 - 1e-18),
            [BALL.cavities(1)],
        ),
        case(
            "a torus with walls of 1e-6",
            torus(1.0, 0.5) - torus(1.0, 0.5 - 1e-6),
            2.0 * PI * PI * (1e-6 - 1e-12),
            [BALL.genus(2).cavities(1)],
        ),
        case(
            "a gap of 1e-6 between balls",
            ball(1.0) | ball(1.0).at(2.0 + 1e-6, 0.0, 0.0),
            2.0 * ball_volume(1.0),
            [pieces(2)],
        )
        .within(1e-3),
        case(
            "a tenth of a millimetre in a kilometre: planes",
            cube(1e-4) | cube(1.0).at(1e3, 0.0, 0.0),
            1.0 + 1e-12,
            [pieces(2)],
        ),
        case(
            "a pin of 0.01 on a plate of 10",
            block([-5., -5., -1.], [5., 5., 0.]) | cylinder(0.01, -0.5, 0.1),
            100.0 + PI * 1e-5,
            [BALL],
        )
        .within(1e-4),
        case(
            "a hole of 0.01 in a plate of 10",
            block([-5., -5., -1.], [5., 5., 0.]) - cylinder(0.01, -2.0, 1.0),
            100.0 - PI * 1e-4,
            [BALL.genus(1)],
        )
        .within(1e-4),
        case(
            "balls of 1 and of 0.001, 50 apart",
            ball(1.0) | ball(0.001).at(50.0, 0.0, 0.0),
            ball_volume(1.0) + ball_volume(0.001),
            [pieces(2)],
        )
        .within(1e-5),
    ];
    cases.push(case(
        "a plate with 25 holes",
        block([-3., -3., 0.], [3., 3., 1.])
            - union(cells(2).map(|[x, y]| cylinder(0.25, -1.0, 2.0).at(x, y, 0.0))),
        36.0 - 25.0 * PI / 16.0,
        [BALL.genus(25)],
    ));
    cases
}
