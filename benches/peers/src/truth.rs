//! The true boundary of a solid: distance to it from a point, and points on it.

use crate::solids::Solid;
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// The boundary, ready to be asked.
pub struct Truth<'a> {
    solid: &'a Solid,
    /// Points on the boundary: all over the faces, along creases, at corners.
    pub samples: Vec<DVec3>,
    /// Longest side of the box around the samples.
    pub longest_side: f64,
    /// Its middle.
    pub middle: DVec3,
}

/// How far from zero, relative to the size, a point of the boundary may evaluate.
const ON: f64 = 1e-9;

impl<'a> Truth<'a> {
    /// Samples the boundary about `1/fineness` of the longest side apart.
    pub fn new(solid: &'a Solid, fineness: f64) -> Self {
        let mut truth = Self {
            solid,
            samples: Vec::new(),
            longest_side: 2.0 * solid.reach,
            middle: DVec3::ZERO,
        };
        let step = truth.longest_side / fineness;
        // A plane may bound many parts: once is enough to sample it.
        let mut seen = Vec::new();
        for surface in &solid.surfaces {
            let name = format!("{surface:?}");
            if seen.contains(&name) {
                continue;
            }
            seen.push(name);
            let points = surface.samples(step, 1.01 * solid.reach);
            let kept = points
                .into_par_iter()
                .flat_map_iter(|p| truth.near(p, step));
            let kept: Vec<DVec3> = kept.collect();
            truth.samples.extend(kept);
        }
        let (mut low, mut high) = (DVec3::MAX, DVec3::MIN);
        for p in &truth.samples {
            (low, high) = (low.min(*p), high.max(*p));
        }
        truth.longest_side = (high - low).max_element();
        truth.middle = (low + high) * 0.5;
        truth
    }

    /// Negative inside, zero on the boundary.
    pub fn value(&self, p: DVec3) -> f64 {
        let distance = |at: usize| self.solid.surfaces[at].signed_distance(p);
        self.solid.tree.value(&distance)
    }

    fn on_boundary(&self, p: DVec3) -> bool {
        self.value(p).abs() <= ON * self.solid.reach
    }

    /// A sample itself if it is on the boundary, and the crease and corner points near it.
    fn near(&self, p: DVec3, step: f64) -> Vec<DVec3> {
        // Farther from the boundary than any point near it can be.
        if self.value(p).abs() > 2.0 * step {
            return Vec::new();
        }
        let mut kept = Vec::new();
        if self.on_boundary(p) {
            kept.push(p);
        }
        let close: Vec<usize> = (0..self.solid.surfaces.len())
            .filter(|&at| self.solid.surfaces[at].signed_distance(p).abs() < step)
            .collect();
        for (n, &i) in close.iter().enumerate() {
            for (m, &j) in close[..n].iter().enumerate() {
                kept.extend(self.meeting(&[i, j], p));
                kept.extend(
                    close[..m]
                        .iter()
                        .filter_map(|&k| self.meeting(&[i, j, k], p)),
                );
            }
        }
        kept
    }

    /// A boundary point near `p` where these two or three surfaces meet (Gauss–Newton steps of
    /// least length).
    fn meeting(&self, surfaces: &[usize], p: DVec3) -> Option<DVec3> {
        let mut q = p;
        for _ in 0..12 {
            let mut normals = [DVec3::ZERO; 3];
            let mut values = DVec3::ZERO;
            for (row, &at) in surfaces.iter().enumerate() {
                normals[row] = self.solid.surfaces[at].normal(q);
                values[row] = self.solid.surfaces[at].signed_distance(q);
            }
            if surfaces.len() == 2 {
                // Stay where you are along the crease.
                normals[2] = normals[0].cross(normals[1]);
            }
            let matrix = DMat3::from_cols(normals[0], normals[1], normals[2]).transpose();
            if matrix.determinant().abs() < 1e-12 {
                return None;
            }
            let move_by = matrix.inverse() * values;
            q -= move_by;
            if move_by.length() < 1e-14 * self.solid.reach {
                break;
            }
        }
        self.on_boundary(q).then_some(q)
    }

    /// Distance from a point to the nearest point of the boundary that was found: never less
    /// than the true distance.
    pub fn distance(&self, p: DVec3) -> f64 {
        let surfaces = &self.solid.surfaces;
        let gap = |at: usize| surfaces[at].signed_distance(p).abs();
        let nearest = (0..surfaces.len()).min_by(|&i, &j| gap(i).total_cmp(&gap(j)));
        let Some(nearest) = nearest else {
            return f64::INFINITY;
        };
        let foot = surfaces[nearest].foot(p);
        if self.on_boundary(foot) {
            return foot.distance(p);
        }
        let mut order: Vec<(f64, usize)> = (0..surfaces.len()).map(|i| (gap(i), i)).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut best = f64::INFINITY;
        for (n, &(gap, i)) in order.iter().enumerate().take(12) {
            if gap >= best {
                break;
            }
            let mut offer = |q: DVec3| best = best.min(q.distance(p));
            let foot = surfaces[i].foot(p);
            if self.on_boundary(foot) {
                offer(foot);
            }
            for (m, &(_, j)) in order[..n].iter().enumerate() {
                if let Some(q) = self.meeting(&[i, j], p) {
                    offer(q);
                }
                for &(_, k) in &order[..m] {
                    if let Some(q) = self.meeting(&[i, j, k], p) {
                        offer(q);
                    }
                }
            }
        }
        best
    }
}
