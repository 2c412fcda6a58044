//! Spheres, cylinders and tori that touch each other and planes in every position.

use crate::case::{BALL, Case, case, pieces};
use crate::tree::{Tree, ball, block, cube, cylinder, half_space, terms, torus, union};
use std::f64::consts::PI;

/// Volume of the unit ball.
const UNIT_BALL: f64 = 4.0 / 3.0 * PI;

/// Volume common to two unit balls at distance d: π (4 + d)(2 − d)²/12.
pub(crate) fn lens(d: f64) -> f64 {
    PI * (4.0 + d) * (2.0 - d).powi(2) / 12.0
}

/// Volume of a spherical torus: half the section's area is swept around the axis.
///
/// For tube > ring, ∫ 2π (R + u)·2√(r² − u²) du over [−R, r].
pub(crate) fn torus_volume(ring: f64, tube: f64) -> f64 {
    if tube <= ring {
        return 2.0 * PI * PI * ring * tube * tube;
    }
    let s = (tube * tube - ring * ring).sqrt();
    let section =
        PI * tube * tube / 4.0 + ring * s / 2.0 + tube * tube / 2.0 * (ring / tube).asin();
    4.0 * PI * (ring * section + s.powi(3) / 3.0)
}

fn balls() -> Vec<Case> {
    let unit = || ball(1.0);
    let two = 2.0 * UNIT_BALL;
    let apart_or_joined = || [pieces(2), BALL];
    let third = 1.0 / 3.0_f64.sqrt();
    vec![
        case("a ball", unit(), UNIT_BALL, [BALL]),
        case(
            "an ellipsoid of 1 : 10 : 100",
            unit().mapped([[0.1, 0., 0.], [0., 1., 0.], [0., 0., 10.]]),
            UNIT_BALL,
            [BALL],
        )
        .within(0.001),
        case(
            "two balls, tangent along x",
            unit() | unit().at(2.0, 0.0, 0.0),
            two,
            apart_or_joined(),
        ),
        case(
            "two balls, tangent along a diagonal",
            unit() | unit().at(2.0 * third, 2.0 * third, 2.0 * third),
            two,
            apart_or_joined(),
        ),
        case(
            "a small ball on a large one",
            unit() | ball(0.25).at(0.0, 1.25, 0.0),
            UNIT_BALL * (1.0 + 0.25_f64.powi(3)),
            apart_or_joined(),
        ),
        case(
            "three balls that touch each other",
            union([
                unit(),
                unit().at(2.0, 0.0, 0.0),
                unit().at(1.0, 3.0_f64.sqrt(), 0.0),
            ]),
            3.0 * UNIT_BALL,
            // Any of the three contacts may join.
            [pieces(3), pieces(2), BALL, BALL.genus(1)],
        ),
        case(
            "two balls that overlap",
            unit() | unit().at(1.0, 0.0, 0.0),
            two - lens(1.0),
            [BALL],
        ),
        case(
            "their lens",
            unit() & unit().at(1.0, 0.0, 0.0),
            lens(1.0),
            [BALL],
        ),
        case(
            "one without the other",
            unit() - unit().at(1.0, 0.0, 0.0),
            UNIT_BALL - lens(1.0),
            [BALL],
        ),
        case(
            "a lens a thousandth thick",
            unit() & unit().at(1.999, 0.0, 0.0),
            lens(1.999),
            [BALL],
        )
        .within(0.001),
        case(
            "a ball without a ball that touches it from inside",
            unit() - ball(0.5).at(0.5, 0.0, 0.0),
            UNIT_BALL * 7.0 / 8.0,
            // The cavity is closed, or open at the contact.
            [BALL.cavities(1), BALL],
        ),
        case(
            "a ball on a block",
            block([-2., -2., -1.], [2., 2., 0.]) | unit().at(0.0, 0.0, 1.0),
            16.0 + UNIT_BALL,
            apart_or_joined(),
        ),
        case(
            "a ball half in a block",
            block([-2., -2., -1.], [2., 2., 0.]) | unit(),
            16.0 + UNIT_BALL / 2.0,
            [BALL],
        ),
        case(
            "a ball in a cube that it touches",
            cube(2.0) | unit(),
            8.0,
            [BALL],
        ),
        case(
            "a cube without its inscribed ball",
            cube(2.0) - unit(),
            8.0 - UNIT_BALL,
            // Of the six contacts any number may be open; the first one only opens the cavity.
            [
                BALL.cavities(1),
                BALL,
                BALL.genus(1),
                BALL.genus(2),
                BALL.genus(3),
                BALL.genus(4),
                BALL.genus(5),
            ],
        ),
        // A cap of height h of the ball of radius r: π h² (r − h/3); r = √1.25, six caps beyond
        // the faces at distance 1, and no two of them overlap.
        case(
            "a ball that bulges from a cube's faces",
            cube(2.0) | ball(1.25_f64.sqrt()),
            {
                let (r, h) = (1.25_f64.sqrt(), 1.25_f64.sqrt() - 1.0);
                8.0 + 6.0 * PI * h * h * (r - h / 3.0)
            },
            [BALL],
        ),
        case(
            "a ball through a cube's edges: r² = 2",
            cube(2.0) - ball(2.0_f64.sqrt()),
            {
                let (r, h) = (2.0_f64.sqrt(), 2.0_f64.sqrt() - 1.0);
                8.0 - (UNIT_BALL * r.powi(3) - 6.0 * PI * h * h * (r - h / 3.0))
            },
            // The ball touches all twelve edges from inside: eight corners.
            Vec::new(),
        ),
    ]
}

fn cylinders() -> Vec<Case> {
    let rod = || cylinder(1.0, -2.0, 2.0);
    let apart_or_joined = || [pieces(2), BALL];
    let steinmetz = 16.0 / 3.0;
    let tricylinder = 8.0 * (2.0 - 2.0_f64.sqrt());
    vec![
        case("a cylinder", rod(), 4.0 * PI, [BALL]),
        // Along a line the contact may break up into any number of bridges.
        case(
            "two cylinders side by side",
            rod() | rod().at(2.0, 0.0, 0.0),
            8.0 * PI,
            Vec::new(),
        ),
        case(
            "two cylinders crosswise, touching",
            rod() | rod().along_x().at(0.0, 2.0, 0.0),
            8.0 * PI,
            apart_or_joined(),
        ),
        case(
            "two equal cylinders end to end",
            cylinder(1.0, -2.0, 0.0) | cylinder(1.0, 0.0, 2.0),
            4.0 * PI,
            [BALL],
        ),
        case(
            "a thin one on top of a thick one",
            cylinder(1.0, -2.0, 0.0) | cylinder(0.5, 0.0, 2.0),
            2.5 * PI,
            [BALL],
        ),
        case(
            "a cylinder without itself turned over",
            rod() - rod().mapped([[1., 0., 0.], [0., -1., 0.], [0., 0., -1.]]),
            0.0,
            [pieces(0)],
        ),
        case(
            "equal cylinders at right angles, common part",
            rod() & rod().along_x(),
            steinmetz,
            [BALL],
        ),
        case(
            "equal cylinders at right angles, united",
            rod() | rod().along_x(),
            8.0 * PI - steinmetz,
            [BALL],
        ),
        case(
            "one without the other",
            rod() - rod().along_x(),
            4.0 * PI - steinmetz,
            // Two stumps whose tips meet in two points.
            [pieces(2), BALL, BALL.genus(1)],
        ),
        case(
            "three of them, common part",
            rod() & rod().along_x() & rod().along_y(),
            tricylinder,
            [BALL],
        ),
        case(
            "three of them, united",
            rod() | rod().along_x() | rod().along_y(),
            12.0 * PI - 3.0 * steinmetz + tricylinder,
            [BALL],
        ),
        case(
            "a tube",
            rod() - cylinder(0.5, -3.0, 3.0),
            3.0 * PI,
            [BALL.genus(1)],
        ),
        case(
            "a tube bored flush with its ends",
            rod() - cylinder(0.5, -2.0, 2.0),
            3.0 * PI,
            [BALL.genus(1)],
        ),
        case(
            "a tube whose bore touches it from inside",
            rod() - cylinder(0.5, -3.0, 3.0).at(0.5, 0.0, 0.0),
            3.0 * PI,
            Vec::new(),
        ),
        case(
            "a block without the inscribed cylinder",
            block([-1., -1., -2.], [1., 1., 2.]) - cylinder(1.0, -3.0, 3.0),
            4.0 * (4.0 - PI),
            // Four corners that meet along four lines.
            Vec::new(),
        ),
        case(
            "a block with the inscribed cylinder",
            block([-1., -1., -2.], [1., 1., 2.]) | rod(),
            16.0,
            [BALL],
        ),
        case(
            "a cylinder on a block",
            block([-3., -2., -1.], [3., 2., 0.]) | rod().along_x().at(0.0, 0.0, 1.0),
            24.0 + 4.0 * PI,
            Vec::new(),
        ),
        case(
            "a capsule: balls on a cylinder of their radius",
            rod() | ball(1.0).at(0.0, 0.0, 2.0) | ball(1.0).at(0.0, 0.0, -2.0),
            4.0 * PI + UNIT_BALL,
            [BALL],
        ),
        case(
            "a napkin ring",
            ball(1.0) - cylinder(0.6, -2.0, 2.0),
            PI / 6.0 * 1.6_f64.powi(3),
            [BALL.genus(1)],
        ),
        // Viviani: two cylinders of half the radius, tangent to the ball and to each other,
        // leave 16/9 of the ball.
        case(
            "a ball without Viviani's cylinder",
            ball(1.0) - cylinder(0.5, -2.0, 2.0).at(0.5, 0.0, 0.0),
            UNIT_BALL - (UNIT_BALL - 16.0 / 9.0) / 2.0,
            // The ring is closed or open where the cylinder touches the ball.
            [BALL.genus(1), BALL],
        ),
        case(
            "a box with rounded edges",
            {
                let sides = |r: f64| block([-1.0 - r, -1.0, -1.0], [1.0 + r, 1.0, 1.0]);
                let mut parts = vec![sides(0.5), sides(0.5).along_x(), sides(0.5).along_y()];
                for a in [-1.0, 1.0] {
                    for b in [-1.0, 1.0] {
                        let edge = || cylinder(0.5, -1.0, 1.0).at(a, b, 0.0);
                        parts.extend([edge(), edge().along_x(), edge().along_y()]);
                        parts.extend([-1.0, 1.0].map(|c| ball(0.5).at(a, b, c)));
                    }
                }
                union(parts)
            },
            // Steiner: V + A r + 3π a r² + 4/3 π r³ for a cube of side a = 2.
            8.0 + 24.0 * 0.5 + 6.0 * PI * 0.25 + UNIT_BALL * 0.125,
            [BALL],
        ),
    ]
}

fn tori() -> Vec<Case> {
    let ring = || torus(2.0, 0.5);
    let volume = torus_volume(2.0, 0.5);
    let sixth = |c: f64, n: usize, axis: usize| {
        let mut exponents = [0; 3];
        exponents[axis] = n;
        (exponents, c)
    };
    vec![
        case("a torus", ring(), volume, [BALL.genus(1)]),
        case(
            "a horn torus",
            torus(1.0, 1.0),
            torus_volume(1.0, 1.0),
            [BALL, BALL.genus(1)],
        ),
        case(
            "a spindle torus",
            torus(0.5, 1.0),
            torus_volume(0.5, 1.0),
            [BALL],
        ),
        case(
            "half a torus",
            ring() & half_space([1.0, 0.0, 0.0], 0.0),
            volume / 2.0,
            [BALL],
        ),
        case(
            "a torus sliced like bread",
            ring() & half_space([0.0, 0.0, 1.0], 0.0),
            volume / 2.0,
            [BALL.genus(1)],
        ),
        case(
            "two tori side by side",
            ring() | ring().at(5.0, 0.0, 0.0),
            2.0 * volume,
            [pieces(2).genus(2), BALL.genus(2)],
        ),
        // The ball touches the inner equator all around.
        case(
            "a torus with a ball in its hole",
            ring() | ball(1.5),
            volume + UNIT_BALL * 1.5_f64.powi(3),
            Vec::new(),
        ),
        case(
            "a torus on a block",
            ring().at(0.0, 0.0, 0.5) | block([-3., -3., -1.], [3., 3., 0.]),
            volume + 36.0,
            Vec::new(),
        ),
        case(
            "a torus with its hole plugged",
            ring() | cylinder(1.5, -0.25, 0.25),
            volume + PI * 2.25 * 0.5,
            // The plug touches the innermost line all around.
            Vec::new(),
        ),
        case(
            "a superball of degree 4",
            terms(
                4,
                &[
                    sixth(1.0, 4, 0),
                    sixth(1.0, 4, 1),
                    sixth(1.0, 4, 2),
                    ([0, 0, 0], -1.0),
                ],
            ),
            // 8 Γ(1 + 1/n)³/Γ(1 + 3/n), with Γ(5/4) and Γ(7/4) from DLMF 5.4.
            8.0 * 0.906_402_477_055_477_f64.powi(3) / 0.919_062_526_848_883_6,
            [BALL],
        ),
    ]
}

pub(crate) fn cases() -> Vec<Case> {
    let mut cases = balls();
    cases.extend(cylinders());
    cases.extend(tori());
    cases
}

/// Four tangent lines in one solid.
pub(crate) fn inscribed() -> Tree {
    block([-1., -1., -2.], [1., 1., 2.]) - cylinder(1.0, -3.0, 3.0)
}
