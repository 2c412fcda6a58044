//! What solids are made of, as far as hulls and Minkowski sums know closed forms for it.

use super::facets::Facets;
use super::point_hull::{corners, span};
use csg::{ModelBuilder, Node, NodeId, Shape, Transform};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Two factors of a map this close, relatively, leave spheres round.
const ROUND: f64 = 1e-5;

/// Distance of sample points from curved faces, in sizes of a body.
pub(super) const SAGITTA: f64 = 5e-4;

/// A convex body, or one whose hull only is known.
#[derive(Clone, Debug)]
pub(super) enum Body {
    /// A convex polyhedron, by its vertices.
    Points(Vec<DVec3>),
    /// A ball.
    Ball(DVec3, f64),
    /// The hull of two discs about the same axis, which are given by their middles and radii.
    Can([(DVec3, f64); 2]),
    /// Something curved and convex, by points within `sagitta` of it.
    Sampled { points: Vec<DVec3>, sagitta: f64 },
    /// Something that need not be convex.
    Cut(NodeId, Transform),
}

/// The bodies whose union is that of some nodes.
pub(super) fn bodies(builder: &ModelBuilder, nodes: &[NodeId]) -> Option<Vec<Body>> {
    let mut found = Vec::new();
    let mut waiting: Vec<(Transform, NodeId)> = nodes
        .iter()
        .rev()
        .map(|id| (Transform::identity(), *id))
        .collect();
    while let Some((at, id)) = waiting.pop() {
        let shape = match builder.get(id)? {
            Node::Union(all) => {
                waiting.extend(all.iter().rev().map(|child| (at.clone(), *child)));
                continue;
            }
            Node::Instance(by, child) => {
                waiting.push((by.compose(&at).ok()?, *child));
                continue;
            }
            Node::Painted(_, child) => {
                waiting.push((at, *child));
                continue;
            }
            Node::Intersection(all) | Node::Difference(all) if all.len() == 1 => {
                waiting.extend(all.iter().map(|child| (at.clone(), *child)));
                continue;
            }
            Node::Shape(shape) => shape,
            _ => {
                found.push(Body::Cut(id, at));
                continue;
            }
        };
        found.push(body(shape, &at)?.unwrap_or(Body::Cut(id, at)));
    }
    Some(found)
}

/// The factor of a map that leaves spheres round.
fn similarity(at: &Transform) -> Option<f64> {
    let origin = at.apply(DVec3::ZERO)?;
    let [x, y, z] = [
        at.apply(DVec3::X)? - origin,
        at.apply(DVec3::Y)? - origin,
        at.apply(DVec3::Z)? - origin,
    ];
    let scale = x.length();
    let slack = ROUND * scale;
    let is_round = (y.length() - scale).abs() <= slack
        && (z.length() - scale).abs() <= slack
        && [x.dot(y), y.dot(z), z.dot(x)]
            .iter()
            .all(|d| d.abs() <= slack * scale);
    is_round.then_some(scale)
}

/// Number of chords of a circle within a distance.
fn chord_count(radius: f64, sagitta: f64) -> u32 {
    let count = PI / (2.0 * sagitta / radius).sqrt();
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let count = count.ceil().clamp(12.0, 120.0) as u32;
    count
}

/// A shape as a body; `None` inside if it has to be looked at as a whole, outside if numbers
/// overflow.
#[expect(
    clippy::option_option,
    reason = "two kinds of absence, told apart at once"
)]
fn body(shape: &Shape, at: &Transform) -> Option<Option<Body>> {
    if let Some(points) = corners(shape) {
        // Adding 0 turns −0 into 0.
        let moved = points.into_iter().map(|p| Some(at.apply(p)? + DVec3::ZERO));
        return Some(Some(Body::Points(moved.collect::<Option<_>>()?)));
    }
    let round = similarity(at);
    let ends = match shape {
        Shape::Ellipsoid(e) => {
            let radii = e.radii();
            if let Some(scale) = round
                && radii.max_element() - radii.min_element() <= ROUND * radii.x
            {
                return Some(Some(Body::Ball(at.apply(DVec3::ZERO)?, radii.x * scale)));
            }
            let sphere = sphere_points(chord_count(1.0, SAGITTA).min(40));
            let moved = sphere.into_iter().map(|p| at.apply(p * radii));
            let points: Vec<DVec3> = moved.collect::<Option<_>>()?;
            return Some(Some(Body::Sampled {
                sagitta: 8.0 * SAGITTA * span(&points),
                points,
            }));
        }
        Shape::Cylinder(c) => [(c.ends()[0], c.radius()), (c.ends()[1], c.radius())],
        Shape::Frustum(f) => [(f.ends()[0], f.radii()[0]), (f.ends()[1], f.radii()[1])],
        _ => return Some(None),
    };
    if let Some(scale) = round {
        let mut moved = [(DVec3::ZERO, 0.0); 2];
        for (to, (z, radius)) in moved.iter_mut().zip(ends) {
            *to = (at.apply(DVec3::Z * z)?, radius * scale);
        }
        return Some(Some(Body::Can(moved)));
    }
    let count = chord_count(1.0, SAGITTA);
    let mut points = Vec::new();
    for (z, radius) in ends {
        for i in 0..count {
            let (sine, cosine) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
            points.push(at.apply(DVec3::new(radius * cosine, radius * sine, z))?);
        }
    }
    let sagitta = SAGITTA * span(&points);
    Some(Some(Body::Sampled { points, sagitta }))
}

/// Points on the unit sphere, `count` around the equator, poles included.
fn sphere_points(count: u32) -> Vec<DVec3> {
    let rings = count / 2;
    let mut points = vec![DVec3::Z, DVec3::NEG_Z];
    for ring in 1..rings {
        let polar = PI * f64::from(ring) / f64::from(rings);
        for side in 0..count {
            let azimuth = TAU * f64::from(side) / f64::from(count);
            let across = polar.sin();
            points.push(DVec3::new(
                across * azimuth.cos(),
                across * azimuth.sin(),
                polar.cos(),
            ));
        }
    }
    points
}

impl Body {
    /// Points whose hull is the body's hull, or within a distance of it, which is returned.
    pub(super) fn points(
        &self,
        builder: &mut ModelBuilder,
        coarseness: f64,
    ) -> Option<(Vec<DVec3>, f64)> {
        Some(match self {
            Self::Points(points) => (points.clone(), 0.0),
            Self::Ball(center, radius) => {
                let sagitta = 4.0 * coarseness * SAGITTA * 2.0 * radius;
                let sphere = sphere_points(chord_count(*radius, sagitta));
                (
                    sphere.into_iter().map(|p| *center + p * *radius).collect(),
                    2.0 * sagitta,
                )
            }
            Self::Can(ends) => {
                let [(a, r), (b, s)] = *ends;
                let (u, v) = (b - a).normalize_or_zero().any_orthonormal_pair();
                let radius = r.max(s);
                let sagitta = coarseness * SAGITTA * 2.0 * radius;
                let count = chord_count(radius, sagitta);
                let mut points = Vec::new();
                for (center, radius) in *ends {
                    if radius == 0.0 {
                        points.push(center);
                        continue;
                    }
                    points.extend((0..count).map(|i| {
                        let (sine, cosine) = (TAU * f64::from(i) / f64::from(count)).sin_cos();
                        center + (u * cosine + v * sine) * radius
                    }));
                }
                (points, sagitta)
            }
            Self::Sampled { points, sagitta } => (points.clone(), *sagitta),
            Self::Cut(id, at) => {
                let moved = builder.add(Node::Instance(at.clone(), *id));
                let facets = Facets::of(builder, moved, 4.0 * coarseness)?;
                let sagitta = if facets.exact { 0.0 } else { facets.sagitta };
                (facets.positions, sagitta)
            }
        })
    }
}
