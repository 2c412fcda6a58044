//! The same solids turned by angles without a period, mirrored, sheared, stretched, projected.

use crate::case::{BALL, Case, case, pieces};
use crate::flat::sponge;
use crate::round::{inscribed, lens, torus_volume};
use crate::tree::{Tree, ball, block, cone, cube, cylinder, torus};
use csg::Transform;
use std::f64::consts::PI;

/// Determinant 1; nothing stays at right angles.
fn sheared(tree: Tree) -> Tree {
    tree.mapped([[1.0, 0.7, -0.3], [0.0, 1.0, 0.4], [0.0, 0.0, 1.0]])
}

pub(crate) fn cases() -> Vec<Case> {
    let unit = || block([0.0; 3], [1.0; 3]);
    let rod = || cylinder(1.0, -2.0, 2.0);
    let steinmetz = 16.0 / 3.0;
    vec![
        case("a cube, turned", unit().turned(), 1.0, [BALL]),
        case(
            "flush cubes, turned as one",
            (unit() | unit().at(1.0, 0.5, 0.0)).turned(),
            2.0,
            [BALL],
        ),
        case(
            "flush cubes, turned one by one",
            unit().turned() | unit().at(1.0, 0.5, 0.0).turned(),
            2.0,
            [BALL],
        ),
        case(
            "a cube without itself, written another way",
            cube(2.0).turned()
                - cube(4.0)
                    .mapped([[0.5, 0., 0.], [0., 0.5, 0.], [0., 0., 0.5]])
                    .turned(),
            0.0,
            [pieces(0)],
        ),
        case(
            "a window, turned",
            (cube(2.0) - block([-0.5, -0.5, -1.0], [0.5, 0.5, 1.0])).turned(),
            6.0,
            [BALL.genus(1)],
        ),
        case(
            "a sponge, turned",
            sponge(1).turned(),
            20.0,
            [BALL.genus(5)],
        ),
        case(
            "a sponge of two levels, turned",
            sponge(2).turned(),
            400.0,
            [BALL.genus(81)],
        ),
        case(
            "a sponge, sheared",
            sheared(sponge(1)),
            20.0,
            [BALL.genus(5)],
        ),
        case(
            "a sponge, mirrored",
            sponge(1).turned().mirrored(),
            20.0,
            [BALL.genus(5)],
        ),
        // Rounding decides about each contact anew.
        case(
            "two cubes with a common edge, turned",
            (unit() | unit().at(1.0, 1.0, 0.0)).turned(),
            2.0,
            Vec::new(),
        ),
        case(
            "two cubes with a common corner, turned",
            (unit() | unit().at(1.0, 1.0, 1.0)).turned(),
            2.0,
            [pieces(2), BALL],
        ),
        case(
            "tangent balls, turned",
            (ball(1.0) | ball(1.0).at(2.0, 0.0, 0.0)).turned(),
            8.0 / 3.0 * PI,
            [pieces(2), BALL],
        ),
        case(
            "a lens, turned",
            (ball(1.0) & ball(1.0).at(1.0, 0.0, 0.0)).turned(),
            lens(1.0),
            [BALL],
        ),
        case(
            "equal cylinders at right angles, turned",
            (rod() | rod().along_x()).turned(),
            8.0 * PI - steinmetz,
            [BALL],
        ),
        case(
            "their common part, turned",
            (rod() & rod().along_x()).turned(),
            steinmetz,
            [BALL],
        ),
        case(
            "their common part, sheared",
            sheared(rod() & rod().along_x()),
            steinmetz,
            [BALL],
        ),
        case(
            "a block without the inscribed cylinder, turned",
            inscribed().turned(),
            4.0 * (4.0 - PI),
            Vec::new(),
        ),
        case(
            "a capsule, turned",
            (rod() | ball(1.0).at(0.0, 0.0, 2.0)).turned(),
            4.0 * PI + 2.0 / 3.0 * PI,
            [BALL],
        ),
        case(
            "a torus, turned and mirrored",
            torus(2.0, 0.5).turned().mirrored(),
            torus_volume(2.0, 0.5),
            [BALL.genus(1)],
        ),
        case(
            "a torus, sheared",
            sheared(torus(2.0, 0.5)),
            torus_volume(2.0, 0.5),
            [BALL.genus(1)],
        ),
        case(
            "linked tori, turned",
            (torus(1.0, 0.2) | torus(1.0, 0.2).along_x().at(0.0, 1.0, 0.0)).turned(),
            2.0 * torus_volume(1.0, 0.2),
            [pieces(2).genus(2)],
        ),
        case(
            "an hourglass, turned",
            (cone(1.0, 0.0, -1.0, 0.0) | cone(0.0, 1.0, 0.0, 1.0)).turned(),
            2.0 / 3.0 * PI,
            [pieces(2), BALL],
        ),
        case(
            "a tube, stretched fiftyfold",
            (rod() - cylinder(0.5, -3.0, 3.0)).mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., 50.]]),
            150.0 * PI,
            [BALL.genus(1)],
        )
        .within(1e-3),
        // Of (x, y, z)/(1 + z/2) the Jacobian is (1 + z/2)⁻⁴; over the unit cube that is
        // (1 − 1.5⁻³)/1.5.
        case(
            "a cube in perspective",
            unit().by(Transform::from_columns(&[
                [1., 0., 0., 0.],
                [0., 1., 0., 0.],
                [0., 0., 1., 0.],
                [0., 0., 0.5, 1.],
            ])
            .expect("regular")),
            (1.0 - 1.5_f64.powi(-3)) / 1.5,
            [BALL],
        ),
    ]
}
