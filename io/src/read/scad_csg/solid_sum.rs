//! `minkowski` of solids.
//!
//! Sums distribute over unions, so that each operand is taken body by body. A body A that is not
//! convex, and a convex one B that holds the origin, add up to A and the sums of A's faces with
//! B: a point of the sum outside A is reached by a copy of B about a point of A, which on its
//! way crosses A's boundary.

use super::body::{Body, bodies};
use super::evaluate::{Evaluator, Frame, Operand};
use super::facets::Facets;
use super::rounded::{Axis, Made, as_prism, polyhedron, round_hull};
use csg::{Node, NodeId, Transform};
use glam::{DVec2, DVec3};

/// Sums of single bodies, at most.
const MOST_SUMS: usize = 2000;

/// Faces of a body that is not convex, at most.
const MOST_FACES: usize = 600;

/// Vertices that are added to each other, at most.
const MOST_POINTS: usize = 4000;

/// The convex summands of one sum, joined by kind.
#[derive(Clone, Debug, Default)]
struct Convex {
    points: Vec<DVec3>,
    /// Where balls and cans have their middles, summed.
    shift: DVec3,
    radius: f64,
    can: Option<[(DVec3, f64); 2]>,
    /// Distance of sampled points from the truth.
    error: f64,
}

impl Evaluator<'_, '_> {
    /// The Minkowski sum of solids.
    pub(super) fn solid_sum(&mut self, frame: &Frame, operands: &[NodeId]) -> Operand {
        let mut sums: Vec<Vec<Body>> = vec![Vec::new()];
        for operand in operands {
            let Some(found) = bodies(&self.builder, &[*operand]) else {
                return self.out_of_range(frame);
            };
            if sums.len() * found.len() > MOST_SUMS {
                return self.not_closed(frame);
            }
            let extended = sums.iter().flat_map(|sum| {
                found.iter().map(|body| {
                    let mut sum = sum.clone();
                    sum.push(body.clone());
                    sum
                })
            });
            sums = extended.collect();
        }
        let mut parts = Vec::new();
        for sum in sums {
            match self.one_sum(frame, &sum) {
                Some(Ok(found)) => parts.extend(found),
                Some(Err(error)) => return self.made(frame, Err(error)),
                None => return self.not_closed(frame),
            }
        }
        if parts.is_empty() {
            return Operand::Nothing;
        }
        Operand::Solid(self.union(parts))
    }

    fn one_sum(&mut self, frame: &Frame, bodies: &[Body]) -> Option<Made> {
        let mut convex = Convex::default();
        let mut dented: Option<Facets> = None;
        for body in bodies {
            match body {
                Body::Points(points) => convex.add_points(points)?,
                Body::Ball(center, radius) => {
                    convex.shift += *center;
                    convex.radius += radius;
                }
                Body::Can(ends) if convex.can.is_none() => convex.can = Some(*ends),
                Body::Cut(id, at) => {
                    let moved = self.builder.add(Node::Instance(at.clone(), *id));
                    let facets = Facets::few(&self.builder, moved, 4.0)?;
                    if !facets.exact {
                        convex.error += facets.sagitta;
                    }
                    if facets.is_convex() {
                        convex.add_points(&facets.positions)?;
                    } else if dented.replace(facets).is_some() {
                        return None;
                    }
                }
                Body::Can(_) | Body::Sampled { .. } => {
                    let (points, error) = body.points(&mut self.builder, 4.0)?;
                    convex.error += error;
                    convex.add_points(&points)?;
                }
            }
        }
        let Some(facets) = dented else {
            return self.convex_sum(frame, &convex);
        };
        let faces = facets.convex_faces();
        if faces.len() > MOST_FACES {
            return None;
        }
        let start = convex.any_point();
        let mut parts = Vec::new();
        let body = facets_node(&facets, start, self)?;
        parts.push(body);
        for face in faces {
            let mut sum = convex.clone();
            sum.add_points(&face)?;
            match self.convex_sum(frame, &sum)? {
                Ok(found) => parts.extend(found),
                Err(error) => return Some(Err(error)),
            }
        }
        Some(Ok(Some(self.union(parts))))
    }

    fn convex_sum(&mut self, frame: &Frame, sum: &Convex) -> Option<Made> {
        if sum.error > 0.0 {
            self.approximate(frame, "convex polyhedron", sum.error);
        }
        let points: Vec<DVec3> = sum.points.iter().map(|p| *p + sum.shift).collect();
        let Some(can) = sum.can else {
            if sum.radius == 0.0 {
                return Some(polyhedron(&points, sum.error, &mut self.builder));
            }
            if points.is_empty() {
                return round_hull(&[], &[(sum.shift, sum.radius)], &mut self.builder);
            }
            let corners = super::point_hull::reduced(&points);
            let balls: Vec<_> = corners.into_iter().map(|p| (p, sum.radius)).collect();
            if let Some(made) = round_hull(&[], &balls, &mut self.builder) {
                return Some(made);
            }
            return self.sampled_sum(frame, sum);
        };
        let [(a, r), (b, s)] = can;
        let size = a.distance(b) + r + s + super::point_hull::span(&points);
        let axis = Axis::new(DVec3::ZERO, b - a, size)?;
        if points.is_empty() {
            let axis = Axis::new(a + sum.shift, b - a, size)?;
            let discs = [
                (DVec2::new(r, 0.0), sum.radius),
                (DVec2::new(s, a.distance(b)), sum.radius),
            ];
            return Some(axis.turned(&discs, &mut self.figures, &mut self.builder));
        }
        if sum.radius == 0.0
            && axis.is_same(r, s)
            && let Some((flat, [low, high])) = as_prism(&points, &axis)
        {
            let (p, q) = (axis.local(a), axis.local(b));
            let flat: Vec<DVec2> = super::figure::convex_corners(&flat);
            let discs = flat.into_iter().map(|d| (d + p.truncate(), r)).collect();
            let range = [low + p.z.min(q.z), high + p.z.max(q.z)];
            return Some(axis.prism(discs, range, &mut self.figures, &mut self.builder));
        }
        self.sampled_sum(frame, sum)
    }

    /// Everything round by points on it.
    fn sampled_sum(&mut self, frame: &Frame, sum: &Convex) -> Option<Made> {
        let mut flat = Convex {
            shift: sum.shift,
            ..Convex::default()
        };
        let mut error = 0.0;
        flat.add_points(&sum.points)?;
        let can = sum.can.map(Body::Can);
        let ball = (sum.radius > 0.0).then_some(Body::Ball(DVec3::ZERO, sum.radius));
        for body in can.into_iter().chain(ball) {
            let (points, off) = body.points(&mut self.builder, 8.0)?;
            error += off;
            flat.add_points(&points)?;
        }
        self.approximate(frame, "convex polyhedron", error);
        let points: Vec<DVec3> = flat.points.iter().map(|p| *p + flat.shift).collect();
        Some(polyhedron(&points, error, &mut self.builder))
    }
}

fn facets_node(facets: &Facets, start: DVec3, evaluator: &mut Evaluator<'_, '_>) -> Option<NodeId> {
    let polygons = facets.corners().map(|t| t.to_vec()).collect();
    let body = evaluator.closed_polyhedron(polygons)?;
    let at = Transform::translation(start).ok()?;
    Some(evaluator.builder.add(Node::Instance(at, body)))
}

impl Convex {
    fn add_points(&mut self, others: &[DVec3]) -> Option<()> {
        let others = super::point_hull::reduced(others);
        if self.points.is_empty() {
            self.points = others;
            return Some(());
        }
        if self.points.len() * others.len() > MOST_POINTS {
            return None;
        }
        let sums = self
            .points
            .iter()
            .flat_map(|p| others.iter().map(move |q| *p + *q));
        self.points = super::point_hull::reduced(&sums.collect::<Vec<_>>());
        Some(())
    }

    /// A point of the sum.
    fn any_point(&self) -> DVec3 {
        let can = self
            .can
            .map_or(DVec3::ZERO, |[(a, _), (b, _)]| 0.5 * (a + b));
        let count = self.points.len().max(1) as f64;
        self.shift + can + self.points.iter().sum::<DVec3>() / count
    }
}
