//! Contact in edges and vertices: checkerboards and their kin.
//!
//! Faces join what they bound together, edges and vertices do not: our reading of such contacts
//! is that the pieces are apart. The other reading is listed where it is easy to count.

use crate::case::{BALL, Case, case, pieces};
use crate::tree::{Tree, block, polyhedron, pyramid, union};

/// The cells of a grid whose coordinates' sum has this parity.
fn checkerboard(counts: [u32; 3], parity: u32) -> Tree {
    let mut cells = Vec::new();
    for x in 0..counts[0] {
        for y in 0..counts[1] {
            for z in 0..counts[2] {
                if (x + y + z) % 2 == parity {
                    let low = [x, y, z].map(f64::from);
                    cells.push(block(low, low.map(|c| c + 1.0)));
                }
            }
        }
    }
    union(cells)
}

/// Points in exactly one of the two.
fn either(a: &Tree, b: &Tree) -> Tree {
    (a.clone() - b.clone()) | (b.clone() - a.clone())
}

/// Tetrahedron with corners at the origin and on the positive axes.
fn corner() -> Tree {
    polyhedron(
        &[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]],
        &[&[0, 2, 1], &[0, 1, 3], &[0, 3, 2], &[1, 2, 3]],
    )
}

pub(crate) fn cases() -> Vec<Case> {
    let unit = || block([0.0; 3], [1.0; 3]);
    // Slabs across each axis; a point in an odd number of them is in a black cell.
    let slab = || block([1.0, 0.0, 0.0], [2.0, 3.0, 3.0]);
    let black = either(&either(&slab(), &slab().along_x()), &slab().along_y());
    vec![
        case(
            "two cubes with a common edge",
            unit() | unit().at(1.0, 1.0, 0.0),
            2.0,
            [pieces(2), BALL],
        ),
        case(
            "two cubes with a part of an edge",
            unit() | unit().at(1.0, 1.0, 0.5),
            2.0,
            [pieces(2), BALL],
        ),
        case(
            "two cubes with a common corner",
            unit() | unit().at(1.0, 1.0, 1.0),
            2.0,
            [pieces(2), BALL],
        ),
        case(
            "an edge across a face",
            block([-1.0, -1.0, -1.0], [1.0, 1.0, 0.0])
                | (block([-0.5; 3], [0.5; 3])
                    .by(
                        csg::Transform::rotation(glam::DVec3::X, 0.25 * std::f64::consts::PI)
                            .expect("a rotation"),
                    )
                    .at(0.0, 0.0, 0.5_f64.sqrt())),
            5.0,
            [pieces(2), BALL],
        ),
        case(
            "an apex on a face",
            block([-1.0, -1.0, -1.0], [1.0, 1.0, 0.0])
                | pyramid(4, 1.0, 0.0, 1.0)
                    .mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]])
                    .at(0.0, 0.0, 1.0),
            4.0 + 2.0 / 3.0,
            [pieces(2), BALL],
        ),
        case(
            "two apexes",
            pyramid(4, 1.0, -1.0, 0.0)
                | pyramid(5, 1.0, -1.0, 0.0).mapped([[1., 0., 0.], [0., 1., 0.], [0., 0., -1.]]),
            2.0 / 3.0 + 2.5 * (std::f64::consts::TAU / 5.0).sin() / 3.0,
            [pieces(2), BALL],
        ),
        case(
            "eight corners at one point, every second one",
            union([
                corner(),
                corner().mapped([[-1., 0., 0.], [0., -1., 0.], [0., 0., 1.]]),
                corner().mapped([[-1., 0., 0.], [0., 1., 0.], [0., 0., -1.]]),
                corner().mapped([[1., 0., 0.], [0., -1., 0.], [0., 0., -1.]]),
            ]),
            4.0 / 6.0,
            // They also touch along the axes.
            [pieces(4), BALL],
        ),
        case(
            "a chessboard of 4 × 4",
            checkerboard([4, 4, 1], 0),
            8.0,
            [
                pieces(8),
                // Nine contacts join eight fields: two loops.
                BALL.genus(2),
            ],
        ),
        case(
            "its other half",
            checkerboard([4, 4, 1], 1),
            8.0,
            [pieces(8), BALL.genus(2)],
        ),
        case(
            "a checkerboard of 3 × 3 × 3",
            checkerboard([3, 3, 3], 0),
            14.0,
            [pieces(14)],
        ),
        case(
            "its other half of 13",
            checkerboard([3, 3, 3], 1),
            13.0,
            [pieces(13)],
        ),
        // One slab: 9 cells, minus those in a second one: a cell is in one slab only or in all
        // three: 12 + 1 cells that touch in edges.
        case("a checkerboard by exclusive or", black, 13.0, [pieces(13)]),
        case(
            "a block and its copy, exclusive or",
            either(&block([0.0; 3], [2.0; 3]), &block([1.0; 3], [3.0; 3])),
            14.0,
            // They touch along the six edges of the common cube that lie in both boundaries: a loop.
            [pieces(2), BALL.genus(5)],
        ),
        case(
            "a cube with two dents that touch in an edge",
            block([0.0; 3], [4.0, 4.0, 2.0])
                - union([
                    block([1.0, 1.0, 1.0], [2.0, 2.0, 2.0]),
                    block([2.0, 2.0, 1.0], [3.0, 3.0, 2.0]),
                ]),
            30.0,
            // Open at the edge, the dents are one; closed, the edge is a wall without thickness.
            [BALL, BALL.genus(1)],
        ),
        case(
            "two cavities that touch in an edge",
            block([0.0; 3], [4.0; 3]) - union([unit().at(1.0, 1.0, 1.0), unit().at(2.0, 2.0, 1.0)]),
            62.0,
            [BALL.cavities(2), BALL.cavities(1)],
        ),
        case(
            "two cavities that touch in a corner",
            block([0.0; 3], [4.0; 3]) - union([unit().at(1.0, 1.0, 1.0), unit().at(2.0, 2.0, 2.0)]),
            62.0,
            [BALL.cavities(2), BALL.cavities(1)],
        ),
        case(
            "a cavity with an L as its section",
            block([0.0; 3], [2.0; 3]) - (block([-0.5; 3], [0.5; 3]).at(1.0, 1.0, 1.0) - quarter()),
            8.0 - 1.0 + 0.25,
            [BALL.cavities(1)],
        ),
        case(
            "a ring of four cubes, joined by edges",
            union([
                unit(),
                unit().at(1.0, 1.0, 0.0),
                unit().at(2.0, 0.0, 0.0),
                unit().at(1.0, -1.0, 0.0),
            ]),
            4.0,
            [pieces(4), BALL.genus(1)],
        ),
    ]
}

/// A quarter of the unit cube about (1, 1, 1), cut off by planes through its middle.
fn quarter() -> Tree {
    block([1.0, 1.0, 0.0], [2.0, 2.0, 2.0])
}
