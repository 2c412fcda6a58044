//! Zipping: neighbouring edges of a face that run back on one curve become one edge.
//!
//! Where surfaces touch along a curve, or edges of a solid touch each other, the mesh leaves faces without width,
//! and ends of faces without width. Their two sides are one curve in truth.

use super::{Crumbs, Raw};
use crate::curve::{self, Curve};
use csg::Solid;
use glam::DVec3;

/// Distance below which curves are one, relative to the solid.
pub(super) const COINCIDENT: f64 = 1e-8;
/// How far a traced curve may be from its chords, relative to their length.
const SLACK: f64 = 0.25;
/// Points on an edge at which it is compared with another.
const SAMPLES: usize = 8;

impl Raw {
    /// Zips as long as there is something to zip, and joins edges that nothing separates any more.
    pub(super) fn zip(&mut self, solid: &Solid, crumbs: &mut Crumbs) {
        let near = COINCIDENT * solid.extent.diagonal();
        // Each step but a cut removes an edge, and a cut is followed by a removal.
        loop {
            let mut changed = false;
            for half_edge in 0..self.next.len() {
                while self.edge_alive[half_edge / 2] && self.zip_after(half_edge, solid, near) {
                    crumbs.slivers += 1;
                    changed = true;
                }
            }
            // What is taken apart may have to be zipped.
            if !self.part_touching(solid, near) && !changed {
                break;
            }
        }
        self.zip_bands(solid, near, crumbs);
        for half_edge in 0..self.next.len() {
            while self.edge_alive[half_edge / 2] && self.join(half_edge, near) {}
        }
    }

    /// Makes one edge of the two closed ones that are all the boundary of a face without width.
    fn zip_bands(&mut self, solid: &Solid, near: f64, crumbs: &mut Crumbs) {
        let mut closed: Vec<Vec<usize>> = vec![Vec::new(); self.face_alive.len()];
        for half_edge in 0..self.next.len() {
            if self.edge_alive[half_edge / 2] && self.edges[half_edge / 2].ends.is_none() {
                closed[self.face[half_edge]].push(half_edge);
            }
        }
        for face in 0..closed.len() {
            let [kept, gone] = closed[face][..] else {
                continue;
            };
            let is_band = self.loop_count[face] == 2
                && [kept, gone]
                    .iter()
                    .all(|&h| self.face[h] == face && self.edge_alive[h / 2])
                && kept / 2 != gone / 2
                && self.is_along(kept, gone, solid, near);
            if !is_band {
                continue;
            }
            self.face_alive[face] = false;
            self.edge_alive[gone / 2] = false;
            self.face[kept] = self.face[gone ^ 1];
            self.unite_primitives(kept, gone);
            crumbs.slivers += 1;
            let into = self.face[kept];
            for list in closed.iter_mut().skip(into).take(1) {
                list.retain(|&other| other != gone ^ 1);
                list.push(kept);
            }
        }
    }

    fn unite_primitives(&mut self, kept: usize, gone: usize) {
        let gone = self.edges[gone / 2].primitives.clone();
        let edge = &mut self.edges[kept / 2];
        edge.primitives.extend(gone);
        edge.primitives.sort_unstable();
        edge.primitives.dedup();
    }

    /// Zips a half-edge with the next one, or as much of the longer one as the shorter one covers.
    fn zip_after(&mut self, half_edge: usize, solid: &Solid, near: f64) -> bool {
        let following = self.next[half_edge];
        if following / 2 == half_edge / 2 {
            return false;
        }
        let (Some(ends), Some(others)) = (
            self.edges[half_edge / 2].ends,
            self.edges[following / 2].ends,
        ) else {
            return false;
        };
        let (from, to) = (ends[half_edge % 2], others[1 - following % 2]);
        let [start, end] = [from, to].map(|vertex| self.vertices[vertex]);
        if start.distance(end) <= near {
            if !self.is_along(half_edge, following, solid, near) {
                return false;
            }
            self.identify(from, to);
            return self.close(half_edge, following);
        }
        let (a, b) = (self.along(half_edge), self.along(following));
        if a.parameter_within(end).is_some() && self.is_along(following, half_edge, solid, near) {
            let Some(rest) = self.cut(half_edge, to, near) else {
                return false;
            };
            return self.close(rest, following);
        }
        if b.parameter_within(start).is_some() && self.is_along(half_edge, following, solid, near) {
            return self.cut(following, from, near).is_some() && self.close(half_edge, following);
        }
        false
    }

    /// Two vertices become one.
    pub(super) fn identify(&mut self, kept: usize, gone: usize) {
        if kept == gone {
            return;
        }
        for edge in &mut self.edges {
            if let Some(ends) = &mut edge.ends {
                for end in ends.iter_mut().filter(|end| **end == gone) {
                    *end = kept;
                }
            }
        }
    }

    /// Makes one edge of a half-edge and the next one, which runs back on it: the half-edge takes
    /// the place of the other one's twin.
    pub(super) fn close(&mut self, half_edge: usize, following: usize) -> bool {
        let outside = following ^ 1;
        let before = self.prev[half_edge];
        let after = self.next[following];
        let (left, right) = (self.prev[outside], self.next[outside]);
        let twin = half_edge ^ 1;
        let ends_here = [before, after]
            .iter()
            .any(|&at| at == twin || at == outside);
        if before != following && ends_here {
            return false;
        }
        let face = self.face[half_edge];
        if before == following {
            // The loop was nothing else.
            self.loop_count[face] -= 1;
            if self.loop_count[face] == 0 {
                self.face_alive[face] = false;
            }
        } else {
            self.link(before, after);
        }
        let into = self.face[outside];
        if left == outside {
            self.link(half_edge, half_edge);
        } else {
            self.link(left, half_edge);
            self.link(half_edge, right);
        }
        self.face[half_edge] = into;
        self.edge_alive[following / 2] = false;
        self.unite_primitives(half_edge, following);
        true
    }

    /// Whether all of one half-edge's curve lies on the other one's.
    fn is_along(&self, half_edge: usize, other: usize, solid: &Solid, near: f64) -> bool {
        let [a, b] = [half_edge, other].map(|at| &self.edges[at / 2]);
        let samples: Vec<DVec3> = match &a.piece.curve {
            Curve::Traced { points } => points.clone(),
            curve => {
                let [from, to] = a.piece.range;
                let part = |k| from + (to - from) * (k as f64 / SAMPLES as f64);
                (0..=SAMPLES).map(|k| curve.point(part(k))).collect()
            }
        };
        let curve = &b.piece.curve;
        // Between traced points only the surfaces know.
        let allowed = match curve {
            Curve::Traced { points } => points
                .windows(2)
                .map(|pair| SLACK * pair[0].distance(pair[1]))
                .fold(near, f64::max),
            _ => near,
        };
        samples.iter().all(|&point| {
            let distance = curve.point(curve.parameter(point)).distance(point);
            // Both halves of a circle are on one curve, and yet not on each other.
            let is_end = || b.piece.ends.iter().any(|end| end.distance(point) <= near);
            let is_within = || b.piece.parameter_within(point).is_some() || is_end();
            distance <= allowed
                && is_within()
                && (allowed <= near || curve::distance(solid, &b.primitives, point) <= near)
        })
    }
}
