//! Other diagonals: nearer to the surface, or with larger angles.

use super::Run;
use super::measure::Shape;
use super::patchwork::{next, prev};
use glam::DVec3;

impl Run<'_> {
    /// Flips edges until no flip makes two facets better.
    pub(super) fn flip_all(&mut self, by_angle: bool) {
        let mut open: Vec<u32> = (0..super::index(self.mesh.origin.len()))
            .rev()
            .filter(|&h| self.is_inner(h) && h < self.mesh.twin[h as usize])
            .collect();
        let most = 8 * open.len();
        self.flip_from(&mut open, by_angle, most, |_| {});
    }

    /// Flips these edges and those around them; `touched` gets a half-edge of each facet that
    /// changes.
    pub(super) fn flip_from(
        &mut self,
        open: &mut Vec<u32>,
        by_angle: bool,
        mut most: usize,
        mut touched: impl FnMut(u32),
    ) {
        while let Some(h) = open.pop() {
            if most > 0 && self.is_inner(h) && self.try_flip(h, by_angle) {
                most -= 1;
                let t = self.mesh.twin[h as usize];
                open.extend([next(h), prev(h), next(t), prev(t)]);
                touched(h);
                touched(t);
            }
        }
    }

    /// Flips an edge inside a face if the other diagonal is nearer to the surface, or (where
    /// both are near enough, `by_angle`) if it makes the smallest angle larger, and if no facet
    /// leans more than before.
    fn try_flip(&mut self, h: u32, by_angle: bool) -> bool {
        let t = self.mesh.twin[h as usize];
        let face = self.face_of(h);
        let old = self.mesh.chord[h as usize];
        // What is straight already stays so.
        if !by_angle && old * self.tolerances[face] <= self.rounding {
            return false;
        }
        let corners = [h, t, prev(h), prev(t)].map(|e| self.mesh.origin[e as usize]);
        let [a, b, c, d] = corners.map(|v| self.mesh.position(v));
        let new = self.chord(face, c, d);
        let better = if by_angle && old.max(new) <= 1.0 {
            sharpest(d, c, a).min(sharpest(c, d, b))
                > sharpest(a, b, c).min(sharpest(b, a, d)) + 1e-9
        } else {
            (new - old * (1.0 - 1e-9)) * self.tolerances[face] < -self.rounding
        };
        if !better {
            return false;
        }
        let [before, after] = self.around_flip(h, new);
        let nearer = after.error < before.error || after.error <= 1.0;
        if nearer && after.lean <= before.lean && self.mesh.may_flip(h) {
            self.flip(h, new);
            return true;
        }
        false
    }

    /// The deviation of the other diagonal of the two facets at an edge.
    pub(super) fn other_chord(&self, h: u32) -> f64 {
        let t = self.mesh.twin[h as usize];
        let [c, d] = [prev(h), prev(t)].map(|e| self.mesh.position(self.mesh.origin[e as usize]));
        self.chord(self.face_of(h), c, d)
    }

    /// The two facets at an edge before and after flipping it, when the other diagonal deviates
    /// by `new`.
    pub(super) fn around_flip(&self, h: u32, new: f64) -> [Shape; 2] {
        let t = self.mesh.twin[h as usize];
        let [hn, hp, tn, tp] = [next(h), prev(h), next(t), prev(t)];
        let position = |e: u32| self.mesh.position(self.mesh.origin[e as usize]);
        let normal = |e: u32| self.mesh.normal[e as usize];
        let chord = |e: u32| self.mesh.chord[e as usize];
        // Corners d, c, a and c, d, b.
        let one = [tp, hp, h];
        let other = [hp, tp, t];
        let after = Shape::new(
            one.map(position),
            one.map(normal),
            [new, chord(hp), chord(tn)],
        )
        .worse_of(Shape::new(
            other.map(position),
            other.map(normal),
            [new, chord(tp), chord(hn)],
        ));
        [self.shape_of(h).worse_of(self.shape_of(t)), after]
    }
}

/// Sine of twice-area over the two longest sides: small for slivers of any kind.
fn sharpest(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [p, q, r] = [b - a, c - b, a - c];
    let [x, y, z] = [p, q, r].map(DVec3::length_squared);
    let area = p.cross(q).length_squared();
    let product = (x * y).max(y * z).max(z * x);
    (area / product).sqrt()
}
