//! Traced pieces as cubic splines with the curve's own tangents.

use super::meet::Meet;
use super::{Curve, Piece, trace};
use csg::{PrimitiveId, Solid};
use glam::DVec3;

/// Times that the number of points is about doubled.
const ROUNDS: usize = 6;

/// A cubic B-spline, once continuously differentiable, in model units.
#[derive(Clone, PartialEq, Debug)]
pub struct Spline {
    /// Control points; first and last are the piece's ends.
    pub points: Vec<DVec3>,
    /// Knots, each as often as its multiplicity: as many as control points, and four more.
    pub knots: Vec<f64>,
    /// Largest distance found from the surfaces, between the points that lie on them.
    pub error: f64,
}

impl Piece {
    /// A spline within `tolerance` of both surfaces, if the piece is a traced curve and such a
    /// spline is found. `primitives` are the edge's.
    pub fn spline(
        &self,
        solid: &Solid,
        primitives: &[PrimitiveId],
        tolerance: f64,
    ) -> Option<Spline> {
        let Curve::Traced { points } = &self.curve else {
            return None;
        };
        let meet = Meet::new(solid, primitives);
        // The error of a cubic is about the square of that of a chord.
        let length: f64 = points
            .windows(2)
            .map(|pair| pair[0].distance(pair[1]))
            .sum();
        let mut chord_error = (tolerance * length).sqrt().max(tolerance);
        for _ in 0..ROUNDS {
            let spline = hermite(meet, &trace::at(meet, points, chord_error));
            if spline.error <= tolerance {
                return Some(spline);
            }
            chord_error *= 0.25;
        }
        None
    }
}

/// The cubic that has the curve's direction in each point.
fn hermite(meet: Meet<'_>, points: &[DVec3]) -> Spline {
    let last = points.len() - 1;
    let tangents: Vec<DVec3> = (0..=last)
        .map(|at| {
            let ahead = points[(at + 1).min(last)] - points[at.saturating_sub(1)];
            let guess = ahead.normalize_or_zero();
            let direction = meet.direction(points[at]).unwrap_or_else(|| {
                // Where surfaces touch, an end takes the parabola through its neighbours.
                let [a, b, c] = if at == 0 {
                    [0, 1.min(last), 2.min(last)]
                } else {
                    [at, at.saturating_sub(1), at.saturating_sub(2)]
                }
                .map(|k| points[k]);
                let bend = (b - a).normalize_or_zero() * 2.0 - (c - a).normalize_or_zero();
                bend.normalize_or_zero()
            });
            if direction.dot(guess) < 0.0 {
                -direction
            } else {
                direction
            }
        })
        .collect();
    let mut spline = Spline {
        points: vec![points[0]],
        knots: vec![0.0; 4],
        error: 0.0,
    };
    let mut parameter = 0.0;
    for at in 0..last {
        let (from, to) = (points[at], points[at + 1]);
        // A third of the arc: a little more than a third of the chord.
        let chord = from.distance(to);
        let cosine = tangents[at].dot(tangents[at + 1]).clamp(-1.0, 1.0);
        let angle = cosine.acos();
        let arc = if angle > 1e-6 {
            chord * (angle / 4.0).tan() / (0.5 * angle).sin() * 2.0 / 3.0
        } else {
            chord / 3.0
        };
        let handles = [from + tangents[at] * arc, to - tangents[at + 1] * arc];
        let middle = (from + to + (handles[0] + handles[1]) * 3.0) / 8.0;
        spline.error = spline.error.max(meet.distance(middle));
        for t in [0.25, 0.75] {
            let [a, b] = [from.lerp(handles[0], t), handles[0].lerp(handles[1], t)];
            let c = handles[1].lerp(to, t);
            let point = a.lerp(b, t).lerp(b.lerp(c, t), t);
            spline.error = spline.error.max(meet.distance(point));
        }
        parameter += 3.0 * arc;
        spline.points.extend(handles);
        let is_last = at + 1 == last;
        spline.points.extend(is_last.then_some(to));
        let repeats = if is_last { 4 } else { 2 };
        spline.knots.extend(std::iter::repeat_n(parameter, repeats));
    }
    spline
}
