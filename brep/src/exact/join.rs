//! Edges cut in two, and put together again.

use super::Raw;
use crate::curve::{Curve, Piece};
use glam::DVec3;
use std::f64::consts::TAU;

/// Distance, relative to the solid, and sine below which two curves are one.
const SAME: f64 = 1e-9;

impl Piece {
    /// The same piece, run through from its end to its start.
    pub(super) fn reversed(&self) -> Self {
        let [from, to] = self.range;
        let ends = [self.ends[1], self.ends[0]];
        let (curve, range) = match &self.curve {
            Curve::Line { point, direction } => {
                let (point, direction) = (*point, -*direction);
                (Curve::Line { point, direction }, [-to, -from])
            }
            Curve::Circle { center, across } => {
                let (center, across) = (*center, [across[0], -across[1]]);
                (Curve::Circle { center, across }, [-to, -from])
            }
            Curve::Ellipse { center, across } => {
                let (center, across) = (*center, [across[0], -across[1]]);
                (Curve::Ellipse { center, across }, [-to, -from])
            }
            Curve::Traced { points } => {
                let points: Vec<DVec3> = points.iter().rev().copied().collect();
                (Curve::Traced { points }, self.range)
            }
        };
        Self { curve, range, ends }
    }

    /// Lets it begin and end in these points, which are near its ends.
    pub(super) fn stretch(&mut self, ends: [DVec3; 2]) {
        if self.ends == ends {
            return;
        }
        self.ends = ends;
        let parameters = ends.map(|end| self.curve.parameter(end));
        match &mut self.curve {
            Curve::Line { .. } => self.range = parameters,
            Curve::Circle { .. } | Curve::Ellipse { .. } => {
                for (bound, t) in self.range.iter_mut().zip(parameters) {
                    *bound = t + TAU * ((*bound - t) / TAU).round();
                }
            }
            Curve::Traced { points } => {
                let last = points.len() - 1;
                points[0] = ends[0];
                points[last] = ends[1];
            }
        }
    }

    /// This piece and then another one that begins where it ends, if both are one line, circle or
    /// ellipse.
    /// Positions closer than `near` are one.
    pub(super) fn continued(&self, after: &Self, near: f64) -> Option<Self> {
        let span = |piece: &Self| piece.range[1] - piece.range[0];
        let ends = [self.ends[0], after.ends[1]];
        let mut range = [self.range[0], self.range[1] + span(after)];
        let curve = match (&self.curve, &after.curve) {
            (Curve::Line { direction: d, .. }, Curve::Line { direction: e, .. }) => {
                (d.dot(*e) > 0.0 && d.cross(*e).length() <= SAME).then(|| self.curve.clone())?
            }
            (one, other) if one.is_one_conic(other, near) => {
                range[1] = range[1].min(range[0] + TAU);
                self.curve.clone()
            }
            _ => return None,
        };
        Some(Self { curve, range, ends })
    }

    /// Both parts of the piece before and after a point near it; `None` if that is one of its
    /// ends.
    pub(super) fn cut(&self, at: DVec3, near: f64) -> Option<[Self; 2]> {
        if self.ends.iter().any(|end| end.distance(at) <= near) {
            return None;
        }
        let t = self.parameter_within(at)?;
        let [from, to] = self.range;
        let [first, second] = match &self.curve {
            Curve::Traced { points } => {
                // A point beyond the last but one is on the last chord: both parts have an end.
                let cut = (whole(t) + 1).min(points.len() - 1);
                let mut first = points[..cut].to_vec();
                first.push(at);
                let mut second = vec![at];
                second.extend_from_slice(&points[cut..]);
                for part in [&mut first, &mut second] {
                    part.dedup();
                    // A piece without length has two ends all the same.
                    if let [only] = part[..] {
                        part.push(only);
                    }
                }
                [first, second].map(|points| {
                    let last = (points.len() - 1) as f64;
                    (Curve::Traced { points }, [0.0, last])
                })
            }
            _ => [
                (self.curve.clone(), [from, t]),
                (self.curve.clone(), [t, to]),
            ],
        };
        let piece = |(curve, range), ends| Self { curve, range, ends };
        Some([
            piece(first, [self.ends[0], at]),
            piece(second, [at, self.ends[1]]),
        ])
    }

    /// The parameter of a point on the curve, if it lies within the piece's range.
    pub(super) fn parameter_within(&self, at: DVec3) -> Option<f64> {
        let [from, to] = self.range;
        let mut t = self.curve.parameter(at);
        if matches!(self.curve, Curve::Circle { .. } | Curve::Ellipse { .. }) {
            t = from + (t - from).rem_euclid(TAU);
        }
        (t >= from && t <= to).then_some(t)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a position in a list"
)]
fn whole(t: f64) -> usize {
    t.max(0.0) as usize
}

impl Raw {
    /// The curve of a half-edge, in its own direction.
    pub(super) fn along(&self, half_edge: usize) -> Piece {
        let piece = &self.edges[half_edge / 2].piece;
        if half_edge.is_multiple_of(2) {
            piece.clone()
        } else {
            piece.reversed()
        }
    }

    /// Cuts a half-edge's edge at a vertex: the half-edge keeps its first part, the number of
    /// which follows it is returned.
    pub(super) fn cut(&mut self, half_edge: usize, vertex: usize, near: f64) -> Option<usize> {
        let ends = self.edges[half_edge / 2].ends?;
        let at = self.vertices[vertex];
        let [first, second] = self.along(half_edge).cut(at, near)?;
        let twin = half_edge ^ 1;
        let new = self.next.len();
        let (from, to) = (ends[half_edge % 2], ends[1 - half_edge % 2]);
        let mut edge = self.edges[half_edge / 2].clone();
        edge.piece = second;
        edge.ends = Some([vertex, to]);
        self.edges.push(edge);
        self.edge_alive.push(true);
        let edge = &mut self.edges[half_edge / 2];
        (edge.piece, edge.ends) = if half_edge.is_multiple_of(2) {
            (first, Some([from, vertex]))
        } else {
            (first.reversed(), Some([vertex, from]))
        };
        self.face.extend([self.face[half_edge], self.face[twin]]);
        // half_edge → new → what followed; what preceded the twin → new's twin → twin.
        let before_twin = self.prev[twin];
        self.next.extend([0, 0]);
        self.prev.extend([0, 0]);
        let after = self.next[half_edge];
        self.link(new, if after == twin { new ^ 1 } else { after });
        self.link(half_edge, new);
        if before_twin != half_edge {
            self.link(before_twin, new ^ 1);
        }
        self.link(new ^ 1, twin);
        Some(new)
    }

    pub(super) fn link(&mut self, before: usize, after: usize) {
        self.next[before] = after;
        self.prev[after] = before;
    }

    /// Joins a half-edge with the next one if nothing else ends between them and both are one
    /// line, circle or ellipse.
    pub(super) fn join(&mut self, half_edge: usize, near: f64) -> bool {
        let following = self.next[half_edge];
        let (twin, other) = (half_edge ^ 1, following ^ 1);
        if following / 2 == half_edge / 2 || self.next[other] != twin {
            return false;
        }
        let (Some(ends), Some(others)) = (
            self.edges[half_edge / 2].ends,
            self.edges[following / 2].ends,
        ) else {
            return false;
        };
        let Some(piece) = self
            .along(half_edge)
            .continued(&self.along(following), near)
        else {
            return false;
        };
        let (from, to) = (ends[half_edge % 2], others[1 - following % 2]);
        let edge = &mut self.edges[half_edge / 2];
        (edge.piece, edge.ends) = if half_edge.is_multiple_of(2) {
            (piece, Some([from, to]))
        } else {
            (piece.reversed(), Some([to, from]))
        };
        self.edge_alive[following / 2] = false;
        let after = self.next[following];
        self.link(
            half_edge,
            if after == following { half_edge } else { after },
        );
        let before = self.prev[other];
        self.link(before, twin);
        true
    }
}
