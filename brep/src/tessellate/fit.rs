//! Facets on both sides of their surfaces instead of one, so that volumes are not biased.
//!
//! A convex surface bulges over all its facets when their corners are on it: the mesh is too
//! small. Here each corner moves along its surfaces' normals by the mean height of the bulges
//! around it, weighted by area. Then the layers over and under the facets have the same volume,
//! to the first order exactly.

use super::Run;
use super::patchwork::{NONE, Role};
use super::sheet::{self, Sheet};
use glam::DVec3;

/// Where the corners of facets lie.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Fit {
    /// On the true surfaces.
    #[default]
    Inscribed,
    /// Off them by no more than the tolerance, so that facets deviate by zero on the average.
    Mean,
}

/// One surface at a vertex: sums over its facets there.
struct Pull {
    is_curved: bool,
    face: usize,
    normal: DVec3,
    area: f64,
    /// Area times the mean height of the surface above.
    volume: f64,
}

/// Normals more alike than this give one constraint (a residue below it is no direction).
const INDEPENDENT: f64 = 0.1;

/// Times that a step may be halved.
const HALVINGS: usize = 6;

impl Fit {
    /// The tolerance for inscribed facets that are within `tolerance` after the move: bulges over
    /// triangles have a mean of ¾ of their height, over strips of a cylinder of ⅔.
    pub(super) fn inscribed_tolerance(self, sheet: &Sheet<'_>, tolerance: f64) -> f64 {
        match (self, sheet) {
            (Self::Mean, Sheet::Cylinder { .. } | Sheet::Cone { .. }) => 1.5 * tolerance,
            (Self::Mean, Sheet::Sphere { .. }) => 4.0 / 3.0 * tolerance,
            // Others may be saddles, whose facets are on both sides in any case.
            _ => tolerance,
        }
    }
}

impl Run<'_> {
    /// How far the surface is above a point near a face, outward.
    fn above(&self, face: usize, p: DVec3) -> f64 {
        -self.sheets[face].distance(p) * self.outward[face]
    }

    /// The height of the surface above the middle of an edge; of a surface of higher degree, where
    /// it is largest of three places.
    fn bulge(&self, face: usize, a: DVec3, b: DVec3) -> f64 {
        let at = |t: f64| self.above(face, a.lerp(b, t));
        let middle = at(0.5);
        if self.sheets[face].is_quadric() {
            return middle;
        }
        let [first, last] = [0.25, 0.75].map(at);
        [first, last].into_iter().fold(middle, |largest, height| {
            if height.abs() > largest.abs() {
                height
            } else {
                largest
            }
        })
    }

    /// Moves corners off their surfaces.
    pub(super) fn fit_mean(&mut self, tolerance: f64) {
        // By half-edge: its facet's area, and that times the mean height above the facet.
        let mut weights = vec![(0.0, 0.0); self.mesh.origin.len()];
        for facet in self.mesh.facets() {
            let face = self.face_of(3 * facet);
            if self.sheets[face].is_plane() {
                continue;
            }
            let [a, b, c] = self.mesh.corners(facet).map(|v| self.mesh.position(v));
            let area = 0.5 * (b - a).cross(c - a).length();
            let mean = [[a, b], [b, c], [c, a]]
                .map(|[p, q]| self.bulge(face, p, q))
                .iter()
                .sum::<f64>()
                / 3.0;
            for h in 3 * facet..3 * facet + 3 {
                weights[h as usize] = (area, area * mean);
            }
        }
        let mut moved = Vec::new();
        for vertex in 0..super::index(self.mesh.positions.len()) {
            let first = self.mesh.outgoing[vertex as usize];
            let role = self.mesh.roles[vertex as usize];
            if first == NONE || matches!(role, Role::Phantom | Role::Held) {
                continue;
            }
            if let Some(to) = self.fitted(first, &weights, tolerance) {
                moved.push((vertex, to));
            }
        }
        // From here on the places from where they came.
        for (vertex, place) in &mut moved {
            std::mem::swap(&mut self.mesh.positions[*vertex as usize], place);
        }
        // Where heights differ much from facet to facet their mean is too far for some.
        for _ in 0..HALVINGS {
            let mut too_far = vec![false; self.mesh.positions.len()];
            for facet in self.mesh.facets() {
                if self.deviation(facet) > tolerance {
                    for vertex in self.mesh.corners(facet) {
                        too_far[vertex as usize] = true;
                    }
                }
            }
            moved.retain(|&(vertex, _)| too_far[vertex as usize]);
            for &(vertex, on_surface) in &moved {
                let at = &mut self.mesh.positions[vertex as usize];
                *at = at.midpoint(on_surface);
            }
        }
    }

    /// Where the vertex at the beginning of a half-edge goes.
    fn fitted(&self, first: u32, weights: &[(f64, f64)], tolerance: f64) -> Option<DVec3> {
        let from = self.mesh.position(self.mesh.origin[first as usize]);
        let mut around: Vec<Pull> = Vec::with_capacity(4);
        for spoke in self.mesh.ring(first) {
            let face = self.face_of(spoke);
            let primitive = self.groups.faces[face].primitive;
            let (area, volume) = weights[spoke as usize];
            let is_known = |pull: &&mut Pull| self.groups.faces[pull.face].primitive == primitive;
            if let Some(known) = around.iter_mut().find(is_known) {
                known.area += area;
                known.volume += volume;
                continue;
            }
            let normal = if let Sheet::Plane { normal, .. } = self.sheets[face] {
                *normal
            } else {
                self.mesh.normal[spoke as usize]
            };
            around.push(Pull {
                is_curved: !self.is_planar(spoke),
                face,
                normal,
                area,
                volume,
            });
        }
        // Planes first: the vertex stays on them.
        around.sort_by_key(|pull| (pull.is_curved, pull.face));
        let mut basis: Vec<DVec3> = Vec::with_capacity(3);
        let mut step = DVec3::ZERO;
        for pull in &around {
            let normal = pull.normal;
            let residue = basis
                .iter()
                .fold(normal, |rest, q| rest - rest.dot(*q) * *q);
            let length = residue.length();
            if length < INDEPENDENT || basis.len() == 3 {
                continue;
            }
            let direction = residue / length;
            if pull.is_curved && pull.area > 0.0 {
                step += (pull.volume / pull.area - normal.dot(step)) / length * direction;
            }
            basis.push(direction);
        }
        let length = step.length();
        if length == 0.0 || !length.is_finite() {
            return None;
        }
        let to = from + step * (tolerance / length).min(1.0);
        // Rounding must not lift it off its planes.
        let planes: Vec<&Sheet<'_>> = (around.iter())
            .filter(|pull| !pull.is_curved)
            .map(|pull| self.sheets[pull.face])
            .collect();
        match planes[..] {
            [] => Some(to),
            [plane] => plane.project(to, self.rounding),
            [one, other] => sheet::project_on_both([one, other], to, self.rounding),
            _ => None,
        }
    }

    /// Largest distance of a facet from its surface, wherever its corners are.
    pub(super) fn deviation(&self, facet: u32) -> f64 {
        let face = self.face_of(3 * facet);
        if self.sheets[face].is_plane() {
            return 0.0;
        }
        let corners = self.mesh.corners(facet).map(|v| self.mesh.position(v));
        let [a, b, c] = corners;
        let ends = corners.map(|p| self.above(face, p));
        let middles = [[b, c], [c, a], [a, b]].map(|[p, q]| self.bulge(face, p, q));
        largest_of_quadratic(ends, middles)
    }
}

/// The largest absolute value over a triangle of the quadratic with these values in its corners
/// and in the middles of the sides opposite to them.
pub(super) fn largest_of_quadratic(corners: [f64; 3], middles: [f64; 3]) -> f64 {
    let [a, b, c] = corners;
    // On the side from p to q, p + t·slope − 4t(t − 1)·bulge.
    let on_side = |p: f64, q: f64, middle: f64| {
        let bulge = middle - 0.5 * (p + q);
        let at = 0.5 + (q - p) / (8.0 * bulge);
        let extreme = if at > 0.0 && at < 1.0 {
            p + at * (q - p) + 4.0 * at * (1.0 - at) * bulge
        } else {
            0.0
        };
        p.abs().max(middle.abs()).max(extreme.abs())
    };
    let sides = on_side(b, c, middles[0])
        .max(on_side(c, a, middles[1]))
        .max(on_side(a, b, middles[2]));
    // Inside: over u, v from corner a, f = a + pu + qv + ru² + suv + tv².
    let [d, e, f] = middles;
    let (p, r) = (4.0 * f - 3.0 * a - b, 2.0 * a + 2.0 * b - 4.0 * f);
    let (q, t) = (4.0 * e - 3.0 * a - c, 2.0 * a + 2.0 * c - 4.0 * e);
    let s = 4.0 * a + 4.0 * d - 4.0 * e - 4.0 * f;
    let determinant = 4.0 * r * t - s * s;
    let (u, v) = (
        (s * q - 2.0 * t * p) / determinant,
        (s * p - 2.0 * r * q) / determinant,
    );
    if u > 0.0 && v > 0.0 && u + v < 1.0 {
        sides.max((a + 0.5 * (p * u + q * v)).abs())
    } else {
        sides
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against a fine grid of points.
        #[test]
        fn no_point_of_the_triangle_is_higher(
            corners in prop::array::uniform3(-1.0..1.0),
            middles in prop::array::uniform3(-1.0..1.0),
        ) {
            let largest = largest_of_quadratic(corners, middles);
            let n = 64;
            let mut sampled = 0.0_f64;
            for i in 0..=n {
                for j in 0..=n - i {
                    let l = [i, j, n - i - j].map(|k| f64::from(k) / f64::from(n));
                    let mut value = 0.0;
                    for k in 0..3 {
                        let [x, y] = [l[(k + 1) % 3], l[(k + 2) % 3]];
                        value += l[k] * (2.0 * l[k] - 1.0) * corners[k] + 4.0 * x * y * middles[k];
                    }
                    sampled = sampled.max(value.abs());
                }
            }
            prop_assert!(sampled <= largest + 1e-12, "{sampled} {largest}");
            prop_assert!(largest <= sampled + 0.01, "{sampled} {largest}");
        }
    }
}
