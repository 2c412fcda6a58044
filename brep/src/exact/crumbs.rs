//! Crumbs: what the mesh has a short edge for although its ends are one point.
//!
//! Where surfaces touch, or more than three of them meet in a point, the mesh keeps vertices apart
//! by up to its tolerance. An edge is a crumb only if all surfaces at its ends prove to meet in one point:
//! a true edge stays, however short it is.

use super::{Crumbs, Raw};
use crate::curve;
use csg::{PrimitiveId, Solid, Surface};
use glam::DVec3;

/// Points on an edge at which it is compared with another.
const SAMPLES: usize = 8;
/// Value of a polynomial, in the domain's units, that counts as zero.
const ON_SURFACE: f64 = 1e-11;

impl Raw {
    /// Shrinks crumbs to points, drops the faces between them, and zips what is left of them.
    pub(super) fn merge_crumbs(&mut self, solid: &Solid, tolerance: f64) -> Crumbs {
        let mut crumbs = Crumbs::default();
        let mut parent: Vec<usize> = (0..self.vertices.len()).collect();
        for at in 0..self.edges.len() {
            if extent(&self.samples(at)) <= tolerance
                && self.shrink(at, &mut parent, solid, tolerance)
            {
                self.edge_alive[at] = false;
                crumbs.edges += 1;
            }
        }
        for edge in &mut self.edges {
            edge.ends = edge.ends.map(|ends| ends.map(|end| root(&parent, end)));
            if let Some(ends) = edge.ends {
                edge.piece.stretch(ends.map(|end| self.vertices[end]));
            }
        }
        self.skip_dead();
        let mut has_edge = vec![false; self.face_alive.len()];
        let mut had_edge = has_edge.clone();
        for half_edge in 0..self.next.len() {
            had_edge[self.face[half_edge]] = true;
            has_edge[self.face[half_edge]] |= self.edge_alive[half_edge / 2];
        }
        for face in 0..self.face_alive.len() {
            if had_edge[face] && !has_edge[face] && self.face_size[face] <= 2.0 * tolerance {
                self.face_alive[face] = false;
                crumbs.faces += 1;
            }
        }
        self.zip(solid, &mut crumbs);
        crumbs
    }

    /// Makes both ends of an edge one vertex, if they are one.
    fn shrink(&mut self, edge: usize, parent: &mut [usize], solid: &Solid, tolerance: f64) -> bool {
        let Some(ends) = self.edges[edge].ends else {
            let piece = &self.edges[edge].piece;
            let primitives = &self.edges[edge].primitives;
            return curve::touching_point(solid, primitives, piece.ends[0], tolerance).is_some()
                || is_apex(solid, primitives, piece.ends[0], tolerance);
        };
        let [from, to] = ends.map(|end| root(parent, end));
        if from == to {
            return true;
        }
        let mut all = self.meeting[from].clone();
        all.extend(&self.meeting[to]);
        all.sort_unstable();
        all.dedup();
        let middle = self.vertices[from].midpoint(self.vertices[to]);
        let Some(point) = curve::meeting_point(solid, &all, middle, tolerance) else {
            return false;
        };
        let (kept, gone) = (from.min(to), from.max(to));
        parent[gone] = kept;
        self.vertices[kept] = point;
        self.meeting[kept] = all;
        true
    }

    fn samples(&self, edge: usize) -> Vec<DVec3> {
        let piece = &self.edges[edge].piece;
        let [from, to] = piece.range;
        (0..=SAMPLES)
            .map(|k| {
                let t = from + (to - from) * (k as f64 / SAMPLES as f64);
                piece.curve.point(t)
            })
            .collect()
    }

    /// Links around what is gone.
    fn skip_dead(&mut self) {
        self.prev = vec![0; self.next.len()];
        for half_edge in 0..self.next.len() {
            let mut following = self.next[half_edge];
            let mut steps = 0;
            while !self.edge_alive[following / 2] && steps < self.next.len() {
                following = self.next[following];
                steps += 1;
            }
            self.next[half_edge] = following;
            if self.edge_alive[half_edge / 2] {
                self.prev[following] = half_edge;
            }
        }
        for ring in self.rings() {
            self.loop_count[self.face[ring[0]]] += 1;
        }
    }
}

/// Whether a closed edge goes around the apex of a cone, through which the other surface passes.
fn is_apex(solid: &Solid, primitives: &[PrimitiveId], near: DVec3, tolerance: f64) -> bool {
    let all = || {
        let ids = primitives.iter();
        ids.filter_map(|id| solid.primitives.get(id.0 as usize))
    };
    all().any(|primitive| {
        let Surface::Cone { apex, .. } = primitive.surface(&solid.domain) else {
            return false;
        };
        let at = solid.domain.to_centered(apex);
        apex.distance(near) <= tolerance
            && all().all(|other| other.polynomial.evaluate(at).abs() <= ON_SURFACE)
    })
}

fn root(parent: &[usize], mut at: usize) -> usize {
    while parent[at] != at {
        at = parent[at];
    }
    at
}

fn extent(points: &[DVec3]) -> f64 {
    let farthest = points.iter().map(|point| point.distance(points[0]));
    farthest.fold(0.0, f64::max)
}
