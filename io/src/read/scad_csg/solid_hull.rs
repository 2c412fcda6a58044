//! `hull` of solids.

use super::ball_hull::Ball;
use super::body::{Body, bodies};
use super::evaluate::{Evaluator, Frame, Operand};
use super::point_hull;
use super::rounded::{Axis, Made, as_prism, polyhedron, round_hull};
use csg::NodeId;
use glam::{DVec2, DVec3};

/// Points of one body from which on those inside its hull are left out first.
const SEVERAL_POINTS: usize = 500;

/// How much coarser than alone small bodies are sampled, at most.
const COARSEST: f64 = 8.0;

/// How fine bodies are sampled: within 10⁻³ of their sizes. Twice half as much again is lost to points
/// that are left out, so the hull is within 2·10⁻³.
const FINE: f64 = 0.5;

impl Evaluator<'_, '_> {
    /// The convex hull of solids.
    pub(super) fn hull(&mut self, frame: &Frame, solids: &[NodeId]) -> Operand {
        let Some(bodies) = bodies(&self.builder, solids) else {
            return self.out_of_range(frame);
        };
        match self.exact_hull(&bodies) {
            Some(made) => self.made(frame, made),
            None => self.sampled_hull(frame, &bodies),
        }
    }

    /// `None` outside if it has no closed form.
    fn exact_hull(&mut self, bodies: &[Body]) -> Option<Made> {
        let (mut points, mut balls, mut cans) = (Vec::new(), Vec::<Ball>::new(), Vec::new());
        for body in bodies {
            match body {
                Body::Points(some) => points.extend(some),
                Body::Ball(center, radius) => balls.push((*center, *radius)),
                Body::Can(ends) => cans.push(*ends),
                Body::Sampled { .. } | Body::Cut(..) => return None,
            }
        }
        let Some(&[(a, r), (b, s)]) = cans.first() else {
            if balls.is_empty() {
                return Some(polyhedron(&points, 0.0, &mut self.builder));
            }
            return round_hull(&points, &balls, &mut self.builder);
        };
        let size = a.distance(b) + r + s;
        let axis = Axis::new(a, b - a, size)?;
        self.coaxial(&axis, &points, &balls, &cans).or_else(|| {
            if balls.is_empty() {
                self.parallel(&axis, &points, &cans)
            } else {
                None
            }
        })
    }

    /// If all is about one axis.
    fn coaxial(
        &mut self,
        axis: &Axis,
        points: &[DVec3],
        balls: &[Ball],
        cans: &[[Ball; 2]],
    ) -> Option<Made> {
        let mut discs = Vec::new();
        let points = points.iter().map(|p| (*p, 0.0));
        for (center, radius) in points.chain(balls.iter().copied()) {
            let p = axis.local(center);
            if !axis.is_same(p.truncate().length(), 0.0) {
                return None;
            }
            discs.push((DVec2::new(0.0, p.z), radius));
        }
        for can in cans {
            for (center, radius) in can {
                let p = axis.local(*center);
                if !axis.is_same(p.truncate().length(), 0.0) {
                    return None;
                }
                discs.push((DVec2::new(*radius, p.z), 0.0));
            }
        }
        Some(axis.turned(&discs, &mut self.figures, &mut self.builder))
    }

    /// If all are upright between the same two heights.
    fn parallel(&mut self, axis: &Axis, points: &[DVec3], cans: &[[Ball; 2]]) -> Option<Made> {
        let mut discs = Vec::new();
        let mut range: Option<[f64; 2]> = None;
        for [(a, r), (b, s)] in cans {
            let (p, q) = (axis.local(*a), axis.local(*b));
            let heights = [p.z.min(q.z), p.z.max(q.z)];
            let [z0, z1] = *range.get_or_insert(heights);
            let is_upright = axis.is_same(p.truncate().distance(q.truncate()), 0.0)
                && axis.is_same(*r, *s)
                && axis.is_same(heights[0], z0)
                && axis.is_same(heights[1], z1);
            if !is_upright {
                return None;
            }
            discs.push((p.truncate(), *r));
        }
        let range = range?;
        if !points.is_empty() {
            let (flat, [low, high]) = as_prism(points, axis)?;
            if !axis.is_same(low, range[0]) || !axis.is_same(high, range[1]) {
                return None;
            }
            discs.extend(flat.into_iter().map(|p| (p, 0.0)));
        }
        (discs.len() <= 200).then(|| axis.prism(discs, range, &mut self.figures, &mut self.builder))
    }

    /// The hull of points on the bodies.
    fn sampled_hull(&mut self, frame: &Frame, bodies: &[Body]) -> Operand {
        let mut samples = Vec::with_capacity(bodies.len());
        for body in bodies {
            let Some(sample) = body.points(&mut self.builder, COARSEST * FINE) else {
                return self.not_closed(frame);
            };
            samples.push(sample);
        }
        let all: Vec<DVec3> = samples.iter().flat_map(|s| &s.0).copied().collect();
        let size = point_hull::span(&all);
        let (mut points, mut error) = (Vec::new(), 0.0_f64);
        for (body, mut sample) in bodies.iter().zip(samples) {
            // Small bodies need fewer points for their size: between as many as make them as
            // good as they would be alone, and as the whole.
            let coarser = (size / point_hull::span(&sample.0)).sqrt();
            if coarser < COARSEST {
                let Some(finer) = body.points(&mut self.builder, coarser * FINE) else {
                    return self.not_closed(frame);
                };
                sample = finer;
            }
            let (some, off) = sample;
            error = error.max(off);
            let mut hull = None;
            if some.len() > SEVERAL_POINTS {
                hull = point_hull::triangles(&some, 0.5 * off);
            }
            match &mut hull {
                Some(faces) => points.extend(point_hull::used(&some, faces)),
                None => points.extend(some),
            }
        }
        if error > 0.0 {
            self.approximate(frame, "convex polyhedron", 2.0 * error);
        }
        let made = polyhedron(&points, 0.5 * error, &mut self.builder);
        self.made(frame, made)
    }
}
