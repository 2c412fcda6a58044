//! Triangles that pass through each other.

use crate::hierarchy::Hierarchy;
use crate::topology::{Brep, VertexView};
use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Pairs of triangles, by number, that pass through each other: an edge of one goes through the
/// inside of the other. Touching is no crossing. Decided exactly.
///
/// Cost: O(n log n) and one decision for each pair of boxes that overlap.
pub(super) fn crossings(positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<[usize; 2]> {
    let hierarchy = Hierarchy::of(positions, triangles);
    let mut found = Vec::new();
    let planes: Vec<Plane> = (triangles.iter())
        .map(|corners| Plane::through(corners.map(|v| positions[v as usize])))
        .collect();
    let aside = |one: usize, other: usize| {
        planes[one].is_aside(positions, triangles[one], triangles[other])
    };
    hierarchy.for_each_overlap(|one, other| {
        if !aside(one, other)
            && !aside(other, one)
            && cross(positions, triangles[one], triangles[other])
        {
            found.push([one.min(other), one.max(other)]);
        }
    });
    found.sort_unstable();
    found
}

/// Whether triangles of a boundary pass through each other: an edge of one goes through the inside
/// of another, and both of its ends are farther than `depth` from that one's plane. Touching is no
/// crossing. Cost as of a sort, usually.
pub fn passes_through_itself(brep: &Brep, depth: f64) -> bool {
    let numbers = brep.number_vertices();
    let number = |vertex: VertexView<'_>| numbers.get(vertex.key()).copied().unwrap_or(u32::MAX);
    let positions: Vec<DVec3> = brep.vertices().map(VertexView::position).collect();
    let triangles: Vec<[u32; 3]> = brep.facets().map(|f| f.vertices().map(number)).collect();
    let place = |v: u32| positions[v as usize];
    crossings(&positions, &triangles).iter().any(|pair| {
        let [one, other] = pair.map(|at| triangles[at]);
        [(one, other), (other, one)].iter().any(|&(edges, facet)| {
            let [a, b, c] = facet.map(place);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            (0..3).any(|k| {
                let ends = [edges[k], edges[(k + 1) % 3]];
                !ends.iter().any(|v| facet.contains(v))
                    && passes(ends.map(place), [a, b, c])
                    && ends.iter().all(|&v| normal.dot(place(v) - a).abs() > depth)
            })
        })
    })
}

/// The plane of a triangle, to tell quickly what is on one side of it.
struct Plane {
    corner: DVec3,
    normal: DVec3,
    /// Times a distance: more than rounding can change a product with the normal.
    rounding: f64,
}

impl Plane {
    fn through([a, b, c]: [DVec3; 3]) -> Self {
        let [p, q] = [b - a, c - a];
        Self {
            corner: a,
            normal: p.cross(q),
            // Three differences, two products and a sum for each term, and a lot to spare.
            rounding: 32.0 * f64::EPSILON * p.length() * q.length(),
        }
    }

    /// Whether the corners of another triangle are all on one side, but for those in common. Then
    /// nothing passes through. False if rounding leaves it open.
    fn is_aside(&self, positions: &[DVec3], own: [u32; 3], other: [u32; 3]) -> bool {
        let (mut above, mut below) = (true, true);
        for vertex in other {
            if own.contains(&vertex) {
                continue;
            }
            let from = positions[vertex as usize] - self.corner;
            let side = self.normal.dot(from);
            let sure = side.abs() > self.rounding * from.length();
            above &= sure && side > 0.0;
            below &= sure && side < 0.0;
        }
        above || below
    }
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

/// On which side of the plane through a, b and c the point d is: positive where they are clockwise seen
/// from it, zero on it. The sign is exact.
pub(crate) fn side(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|v| Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    });
    orient3d(a, b, c, d)
}

/// Whether a segment goes through the inside of a triangle.
fn passes([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> bool {
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

    /// Against all pairs: 300 triangles in a small cube, many crossings.
    #[test]
    fn no_pair_is_forgotten() {
        let mut state = 1_u64;
        let mut number = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut positions = Vec::new();
        for _ in 0..300 {
            let near = DVec3::new(number(), number(), number());
            for _ in 0..3 {
                positions.push(near + 0.4 * DVec3::new(number(), number(), number()));
            }
        }
        let triangles: Vec<[u32; 3]> = (0..300).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
        let mut all = Vec::new();
        for s in 0..300 {
            for t in s + 1..300 {
                if cross(&positions, triangles[s], triangles[t]) {
                    all.push([s, t]);
                }
            }
        }
        assert!(all.len() > 100, "{}", all.len());
        assert_eq!(crossings(&positions, &triangles), all);
        assert_eq!(crossings(&positions, &[]), Vec::<[usize; 2]>::new());
    }

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
