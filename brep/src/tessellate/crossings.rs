//! Triangles that pass through each other.

use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Pairs of triangles, by number, that pass through each other: an edge of one goes through the
/// inside of the other. Touching is no crossing. Decided exactly.
///
/// Cost: O(n log n) and one comparison of boxes for each pair that overlaps along one axis.
pub(super) fn crossings(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let boxes: Vec<[DVec3; 2]> = (triangles.iter())
        .map(|corners| {
            let [a, b, c] = corners.map(|v| positions[v as usize]);
            [a.min(b).min(c), a.max(b).max(c)]
        })
        .collect();
    let axis = thinnest(&boxes);
    let mut order: Vec<usize> = (0..triangles.len()).collect();
    order.sort_by(|&s, &t| boxes[s][0][axis].total_cmp(&boxes[t][0][axis]));
    let mut found = Vec::new();
    for (at, &one) in order.iter().enumerate() {
        let [low, high] = boxes[one];
        let following = order[at + 1..].iter();
        for &other in following.take_while(|&&other| boxes[other][0][axis] <= high[axis]) {
            let [other_low, other_high] = boxes[other];
            let apart = other_low.cmpgt(high) | low.cmpgt(other_high);
            if !apart.any() && cross(positions, triangles[one], triangles[other]) {
                found.push([one.min(other), one.max(other)]);
            }
        }
    }
    found.sort_unstable();
    found
}

/// The axis along which boxes are shortest in proportion to all of them.
fn thinnest(boxes: &[[DVec3; 2]]) -> usize {
    let mut whole = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let mut sum = DVec3::ZERO;
    for [low, high] in boxes {
        whole = [whole[0].min(*low), whole[1].max(*high)];
        sum += *high - *low;
    }
    (sum / (whole[1] - whole[0])).min_position()
}

fn cross(positions: &[DVec3], one: [u32; 3], other: [u32; 3]) -> bool {
    let edges = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
    let through = |edge: [u32; 2], triangle: [u32; 3]| {
        // An edge that has a corner of the triangle touches it.
        !edge.iter().any(|v| triangle.contains(v))
            && passes(
                edge.map(|v| positions[v as usize]),
                triangle.map(|v| positions[v as usize]),
            )
    };
    edges(one).into_iter().any(|edge| through(edge, other))
        || edges(other).into_iter().any(|edge| through(edge, one))
}

/// Whether a segment goes through the inside of a triangle.
fn passes([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
    let side = |a: DVec3, b: DVec3, c: DVec3, d: DVec3| {
        let [a, b, c, d] = [a, b, c, d].map(|v| Coord3D {
            x: v.x,
            y: v.y,
            z: v.z,
        });
        orient3d(a, b, c, d)
    };
    let (from, to) = (side(a, b, c, p), side(a, b, c, q));
    let opposite = (from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0);
    if !opposite {
        return false;
    }
    let around = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    around.iter().all(|&s| s > 0.0) || around.iter().all(|&s| s < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: [DVec3; 3] = [
        DVec3::ZERO,
        DVec3::new(2.0, 0.0, 0.0),
        DVec3::new(0.0, 2.0, 0.0),
    ];

    fn found(second: [DVec3; 3]) -> usize {
        let positions: Vec<DVec3> = FLAT.into_iter().chain(second).collect();
        crossings(&positions, &[[0, 1, 2], [3, 4, 5]]).len()
    }

    #[test]
    fn a_triangle_through_another_is_found_and_a_touching_one_is_not() {
        let [below, above] = [-1.0, 1.0].map(|z| DVec3::new(0.5, 0.5, z));
        assert_eq!(found([below, above, DVec3::new(9.0, 9.0, 1.0)]), 1);
        assert_eq!(
            found([below, DVec3::new(0.5, 0.5, 0.0), DVec3::new(9.0, 9.0, -1.0)]),
            0
        );
        assert_eq!(found([above, above + DVec3::X, above + DVec3::Y]), 0);
    }

    #[test]
    fn triangles_with_a_common_corner_may_cross_all_the_same() {
        let mut positions = FLAT.to_vec();
        positions.extend([DVec3::new(1.0, 0.5, -1.0), DVec3::new(1.0, 0.5, 1.0)]);
        assert_eq!(crossings(&positions, &[[0, 1, 2], [0, 3, 4]]).len(), 1);
        positions[3].z = 0.5;
        assert_eq!(crossings(&positions, &[[0, 1, 2], [0, 3, 4]]).len(), 0);
    }
}
