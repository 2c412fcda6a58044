//! Faces in one plane: unions, differences, stairs, frames, sponges.

use crate::case::{BALL, Case, case, pieces};
use crate::tree::{Tree, block, cube, half_space, polyhedron, prism, pyramid, union};

/// `count` steps of width and height 1, each a block from the ground.
fn stairs(count: u32) -> Tree {
    union((1..=count).map(|step| {
        let x = f64::from(step);
        block([x - 1.0, 0.0, 0.0], [x, 2.0, x])
    }))
}

/// A Menger sponge of side 3ⁿ: a cube without all tunnels of all sizes.
pub(crate) fn sponge(level: u32) -> Tree {
    let side = 3_i32.pow(level);
    let mut parts = vec![block([0.0; 3], [f64::from(side); 3])];
    for depth in 1..=level {
        let width = 3_i32.pow(level - depth);
        for i in (width..side).step_by(3 * usize::try_from(width).unwrap_or(1)) {
            for j in (width..side).step_by(3 * usize::try_from(width).unwrap_or(1)) {
                let [i, j, width, side] = [i, j, width, side].map(f64::from);
                let tunnel = block([i, j, -1.0], [i + width, j + width, side + 1.0]);
                parts.push(tunnel.clone().along_x());
                parts.push(tunnel.clone().along_y());
                parts.push(tunnel);
            }
        }
    }
    Tree::Difference(parts)
}

/// Tetrahedron in the cube [0, 1]³, a third of it.
fn tetrahedron() -> Tree {
    polyhedron(
        &[[0., 0., 0.], [1., 1., 0.], [1., 0., 1.], [0., 1., 1.]],
        &[&[0, 1, 2], &[0, 2, 3], &[0, 3, 1], &[1, 3, 2]],
    )
}

/// The other one.
fn counter_tetrahedron() -> Tree {
    tetrahedron().mirrored().at(1.0, 0.0, 0.0)
}

pub(crate) fn cases() -> Vec<Case> {
    let unit = || block([0.0; 3], [1.0; 3]);
    let bar = || block([-3.0, -0.5, -0.5], [3.0, 0.5, 0.5]);
    let mut cases = vec![
        case("a cube", unit(), 1.0, [BALL]),
        case(
            "two cubes with a common face",
            unit() | unit().at(1.0, 0.0, 0.0),
            2.0,
            [BALL],
        ),
        case(
            "a face shifted along its plane",
            unit() | unit().at(1.0, 0.5, 0.25),
            2.0,
            [BALL],
        ),
        case(
            "an L of overlapping blocks with one top",
            block([0.0; 3], [3.0, 1.0, 1.0]) | block([0.0; 3], [1.0, 3.0, 1.0]),
            5.0,
            [BALL],
        ),
        case(
            "blocks with two common planes each, three heights",
            union([
                block([0.0; 3], [1.0, 1.0, 1.0]),
                block([1.0, 0.0, 0.0], [2.0, 1.0, 2.0]),
                block([0.0, 1.0, 0.0], [2.0, 2.0, 3.0]),
            ]),
            1.0 + 2.0 + 6.0,
            [BALL],
        ),
        case(
            "a notch flush with three faces",
            cube(2.0) - block([0.0; 3], [1.0; 3]),
            7.0,
            [BALL],
        ),
        case(
            "a slot flush with both ends",
            cube(2.0) - block([-0.5, -1.0, -1.0], [0.5, 1.0, 1.0]),
            4.0,
            [pieces(2)],
        ),
        case(
            "a window as deep as the wall",
            cube(2.0) - block([-0.5, -0.5, -1.0], [0.5, 0.5, 1.0]),
            6.0,
            [BALL.genus(1)],
        ),
        case("a cube without itself", unit() - unit(), 0.0, [pieces(0)]),
        case(
            "a cube without its halves",
            cube(2.0) - (block([-1.0; 3], [0.0, 1.0, 1.0]) | block([0.0, -1.0, -1.0], [1.0; 3])),
            0.0,
            [pieces(0)],
        ),
        case(
            "halves of a cube, each cut by the same plane",
            (cube(2.0) & half_space([1.0, 2.0, 3.0], 0.5))
                | (cube(2.0) & half_space([-2.0, -4.0, -6.0], -1.0)),
            8.0,
            [BALL],
        ),
        case(
            "three bars through one middle",
            bar() | bar().along_x() | bar().along_y(),
            16.0,
            [BALL],
        ),
        case("a sponge", sponge(1), 20.0, [BALL.genus(5)]),
        // Handles of the nth sponge: 5, 81, 1409 (OEIS A135918 counts the same graph).
        case("a sponge of two levels", sponge(2), 400.0, [BALL.genus(81)]),
        case("ten steps", stairs(10), 110.0, [BALL]),
        case("fifty steps", stairs(50), 2550.0, [BALL]),
        case(
            "a comb: ten slots down from the top",
            block([0.0; 3], [21.0, 2.0, 5.0])
                - union((0..10).map(|tooth| {
                    let x = f64::from(2 * tooth + 1);
                    block([x, 0.0, 1.0], [x + 1.0, 2.0, 5.0])
                })),
            210.0 - 80.0,
            [BALL],
        ),
        case(
            "a house: roof flush with the walls",
            prism(4, 2.0_f64.sqrt(), -1.0, 0.0) | pyramid(4, 2.0_f64.sqrt(), 0.0, 1.5),
            4.0 + 4.0 * 1.5 / 3.0,
            [BALL],
        ),
        case(
            "six pyramids that fill a cube",
            union((0..6).map(|face| {
                let up = pyramid(4, 2.0_f64.sqrt(), -1.0, 0.0).by(csg::Transform::rotation(
                    glam::DVec3::Z,
                    0.25 * std::f64::consts::PI,
                )
                .expect("a rotation"));
                match face {
                    0 => up,
                    1 => up.along_x(),
                    2 => up.along_y(),
                    3 => up.mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]]),
                    4 => up
                        .mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]])
                        .along_x(),
                    _ => up
                        .mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]])
                        .along_y(),
                }
            })),
            8.0,
            // Three planes meet along each half diagonal. Their rounded coefficients do not agree
            // on it, which may leave a tunnel of no width between the pyramids: up to eight
            // tunnels, joined in the middle.
            (0..8)
                .map(|handles| BALL.genus(handles))
                .collect::<Vec<_>>(),
        ),
        case(
            "an octahedron of two pyramids",
            pyramid(4, 1.0, 0.0, 1.0)
                | pyramid(4, 1.0, 0.0, 1.0).mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]]),
            4.0 / 3.0,
            [BALL],
        ),
        case(
            "a stella octangula",
            tetrahedron() | counter_tetrahedron(),
            0.5,
            [BALL],
        ),
        case(
            "the octahedron in it",
            tetrahedron() & counter_tetrahedron(),
            1.0 / 6.0,
            [BALL],
        ),
        case(
            "a hexagram of two triangles",
            prism(3, 1.0, 0.0, 1.0)
                | prism(3, 1.0, 0.0, 1.0).mapped([[-1., 0., 0.], [0., -1., 0.], [0., 0., 1.]]),
            3.0_f64.sqrt(),
            [BALL],
        ),
        case(
            "triangular, pentagonal and heptagonal prisms stacked",
            prism(3, 1.0, 0.0, 1.0) | prism(5, 1.0, 1.0, 2.0) | prism(7, 1.0, 2.0, 3.0),
            [3.0_f64, 5.0, 7.0]
                .map(|n| n / 2.0 * (std::f64::consts::TAU / n).sin())
                .iter()
                .sum(),
            [BALL],
        ),
    ];
    // The same box from 1000 cubes, from slabs, and from what is left of a larger one.
    let slabs = union((0..10).map(|z| {
        let z = f64::from(z);
        block([0.0, 0.0, z], [10.0, 10.0, z + 1.0])
    }));
    cases.push(case("ten slabs", slabs, 1000.0, [BALL]));
    let cut = block([-5.0; 3], [20.0; 3])
        & half_space([1.0, 0.0, 0.0], 10.0)
        & half_space([-3.0, 0.0, 0.0], 0.0);
    let rest = Tree::Difference(vec![
        cut,
        block([-9.0, -9.0, -9.0], [30.0, 0.0, 30.0]),
        block([-9.0, 10.0, -9.0], [30.0, 30.0, 30.0]),
        block([-9.0, -9.0, -9.0], [30.0, 30.0, 0.0]),
        block([-9.0, -9.0, 10.0], [30.0, 30.0, 30.0]),
    ]);
    cases.push(case("what four cuts leave", rest, 1000.0, [BALL]));
    cases
}
