//! The convex hull of balls and points, exactly.
//!
//! Its boundary is planes that touch three balls or more, cones and cylinders that touch two,
//! and the balls. So it is the union of the balls, of the hull of the points where the planes
//! touch, and for each edge between two planes of the frustum between the circles in which a
//! cone touches the two balls.

use super::figure::convex_ring;
use super::point_hull;
use csg::{Error, ModelBuilder, Node, NodeId, Shape, Transform};
use glam::{DVec2, DVec3};
use std::collections::BTreeSet;

/// Balls of one hull, at most: planes through all three of them are compared with all.
pub(super) const MAX_BALLS: usize = 100;

/// Relative distance within which a ball counts as touched.
const NEAR: f64 = 1e-9;

/// A ball or, of radius 0, a point.
pub(super) type Ball = (DVec3, f64);

/// The hull of balls; `None` if it has no volume.
pub(super) fn hull(balls: &[Ball], builder: &mut ModelBuilder) -> Result<Option<NodeId>, Error> {
    let balls = uncovered(balls);
    let size = balls
        .iter()
        .fold(0.0_f64, |m, b| m.max(b.0.abs().max_element() + b.1));
    let near = NEAR * size;
    let (mut touching, mut edges) = (Vec::new(), BTreeSet::new());
    for plane in planes(&balls, near) {
        let touched: Vec<(usize, DVec3)> = (balls.iter().enumerate())
            .filter(|(_, b)| (plane.dot_top(b) - plane.offset).abs() <= 10.0 * near)
            .map(|(i, b)| (i, b.0 + plane.normal * b.1))
            .collect();
        let (u, v) = plane.normal.any_orthonormal_pair();
        let flat: Vec<DVec2> = (touched.iter())
            .map(|(_, p)| DVec2::new(u.dot(*p), v.dot(*p)))
            .collect();
        touching.extend(touched.iter().map(|t| t.1));
        let ring = convex_ring(&flat);
        let ends = ring.iter().zip(ring.iter().cycle().skip(1));
        for (a, b) in ends {
            if let (Some(a), Some(b)) = (touched.get(*a), touched.get(*b)) {
                edges.insert((a.0.min(b.0), a.0.max(b.0)));
            }
        }
    }
    if touching.is_empty() {
        // All middles lie in one line: any two balls have a common cone.
        let all = 0..balls.len();
        edges.extend(
            all.clone()
                .flat_map(|a| (a + 1..balls.len()).map(move |b| (a, b))),
        );
    }
    let mut parts = Vec::new();
    if let Some(mut faces) = point_hull::triangles(&touching, near) {
        let vertices = point_hull::used(&touching, &mut faces);
        let core = Shape::convex_hull(&vertices, &faces)?;
        parts.push(builder.add(Node::Shape(core)));
    }
    for (a, b) in edges {
        if let (Some(a), Some(b)) = (balls.get(a), balls.get(b)) {
            parts.extend(cone(*a, *b, builder)?);
        }
    }
    for &(center, radius) in balls.iter().filter(|b| b.1 > 0.0) {
        let ball = builder.add(Node::Shape(Shape::sphere(radius)?));
        let at = Transform::translation(center)?;
        parts.push(builder.add(Node::Instance(at, ball)));
    }
    Ok(match parts[..] {
        [] => None,
        [only] => Some(only),
        _ => Some(builder.add(Node::Union(parts))),
    })
}

/// The balls that do not lie in others.
fn uncovered(balls: &[Ball]) -> Vec<Ball> {
    let mut sorted = balls.to_vec();
    sorted.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut kept: Vec<Ball> = Vec::new();
    for (center, radius) in sorted {
        let covers = |b: &Ball| {
            let slack = 1e-12 * (b.1 + center.abs().max_element());
            center.distance(b.0) + radius <= b.1 + slack
        };
        if !kept.iter().any(covers) {
            kept.push((center, radius));
        }
    }
    kept
}

#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

impl Plane {
    /// How far a ball reaches along the normal.
    fn dot_top(&self, ball: &Ball) -> f64 {
        self.normal.dot(ball.0) + ball.1
    }
}

/// The planes that touch three balls or more and have all on one side.
fn planes(balls: &[Ball], near: f64) -> Vec<Plane> {
    let mut found: Vec<Plane> = Vec::new();
    for (i, a) in balls.iter().enumerate() {
        for (j, b) in balls.iter().enumerate().skip(i + 1) {
            for c in balls.iter().skip(j + 1) {
                for plane in touching(a, b, c) {
                    let is_known = found.iter().any(|p| {
                        p.normal.dot(plane.normal) > 1.0 - 1e-12
                            && (p.offset - plane.offset).abs() <= near
                    });
                    let has_all = |b: &Ball| plane.dot_top(b) <= plane.offset + near;
                    if !is_known && balls.iter().all(has_all) {
                        found.push(plane);
                    }
                }
            }
        }
    }
    found
}

/// The planes, two at most, that touch three balls from the same side: n · cᵢ + rᵢ is the same
/// for all, which leaves n one component across the plane of the middles.
fn touching(a: &Ball, b: &Ball, c: &Ball) -> impl Iterator<Item = Plane> + use<> {
    let (p, q) = (b.0 - a.0, c.0 - a.0);
    let across = p.cross(q);
    let square = across.length_squared();
    let is_flat = square <= 1e-18 * p.length_squared() * q.length_squared();
    // The part of n in that plane is dual to p and q.
    let (dp, dq) = (a.1 - b.1, a.1 - c.1);
    let along = (q.cross(across) * dp + across.cross(p) * dq) / square;
    let rest = 1.0 - along.length_squared();
    let (center, radius) = *a;
    [1.0, -1.0]
        .into_iter()
        .filter(move |_| !is_flat && rest > 0.0)
        .map(move |sign| {
            let normal = along + across * (sign * (rest / square).sqrt());
            Plane {
                normal,
                offset: normal.dot(center) + radius,
            }
        })
}

/// The frustum between the circles in which the common cone of two balls touches them.
fn cone(a: Ball, b: Ball, builder: &mut ModelBuilder) -> Result<Option<NodeId>, Error> {
    let gap = b.0 - a.0;
    let length = gap.length();
    if a.1.max(b.1) == 0.0 || length <= (a.1 - b.1).abs() {
        return Ok(None);
    }
    let sine = (a.1 - b.1) / length;
    let cosine = (1.0 - sine * sine).max(0.0).sqrt();
    let z = [a.1 * sine, length + b.1 * sine];
    let shape = Shape::frustum(a.1 * cosine, b.1 * cosine, z[0], z[1])?;
    let axis = gap / length;
    let (u, v) = axis.any_orthonormal_pair();
    let [x, y, z] = [0, 1, 2].map(|k| [u[k], v[k], axis[k], a.0[k]]);
    let at = Transform::from_columns(&[x, y, z, [0.0, 0.0, 0.0, 1.0]])?;
    let shape = builder.add(Node::Shape(shape));
    Ok(Some(builder.add(Node::Instance(at, shape))))
}
