//! Which points a random tree holds, by school geometry: no polynomial, formula or library.

use super::{Part, Tree};
use glam::DVec3;
use std::f64::consts::PI;

/// Whether a tree holds a point. Its depth is at most four.
pub(crate) fn contains(tree: &Tree, point: DVec3) -> bool {
    let holds = |child: &Tree| contains(child, point);
    match tree {
        Tree::Leaf(part, placement) => {
            let (columns, at) = placement.frame();
            // The columns are orthonormal, so that their products undo the placement.
            let local = columns.map(|column| column.dot(point - at));
            part_contains(*part, local)
        }
        Tree::Union(children) => children.iter().any(holds),
        Tree::Intersection(children) => children.iter().all(holds),
        Tree::Difference(children) => {
            let Some((first, rest)) = children.split_first() else {
                return false;
            };
            holds(first) && !rest.iter().any(holds)
        }
        Tree::Xor(a, b) => holds(a) != holds(b),
    }
}

fn part_contains(part: Part, [x, y, z]: [f64; 3]) -> bool {
    let around = x.hypot(y);
    let between = z.abs() <= 1.0;
    match part {
        Part::Block => x.abs() <= 1.0 && y.abs() <= 1.0 && between,
        Part::Ball(radius) => around.hypot(z) <= radius,
        Part::Cylinder(radius) => around <= radius && between,
        Part::Cone(r0, r1) => between && around <= r0 + (r1 - r0) * (z + 1.0) / 2.0,
        Part::Torus => (around - 1.0).hypot(z) <= 0.5,
        Part::Prism(sides) => {
            // The apothem is cos(π/n); sides face the angles (2k + 1) π/n.
            let step = 2.0 * PI / f64::from(sides);
            let turn = y.atan2(x).rem_euclid(step) - step / 2.0;
            between && around * turn.cos() <= (step / 2.0).cos()
        }
        Part::HalfSpaceInBox(offset) => {
            x.abs() <= 1.0 && y.abs() <= 1.0 && between && x + y <= offset
        }
    }
}
