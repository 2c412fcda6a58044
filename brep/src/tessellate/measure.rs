//! How well facets follow their surfaces, kept up to date while edges change: normals and
//! chords are measured once, when a vertex or an edge comes.

use super::Run;
use super::patchwork::{NONE, next, prev};
use super::sheet::facet_error;
use glam::DVec3;

/// Cosine of the angle between a facet and its surface's normals from which on it is bad.
pub(super) const UPRIGHT: f64 = 0.3;

/// How good a facet is.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shape {
    /// Largest deviation from its surface, in units of the tolerance.
    pub(super) error: f64,
    /// How far it leans, from 0 (good) to 1.3 (turned over).
    pub(super) lean: f64,
}

impl Shape {
    /// Of a triangle with these corners, normals of the surface there (outward; zero where there
    /// is none) and deviations of its edges, in any order.
    pub(super) fn new(corners: [DVec3; 3], normals: [DVec3; 3], chords: [f64; 3]) -> Self {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        let length = normal.length();
        // A surface without a normal (an apex) says nothing; a triangle without one is bad.
        let upright = normals
            .map(|n| {
                if n == DVec3::ZERO {
                    length
                } else {
                    n.dot(normal)
                }
            })
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let upright = if length > 0.0 { upright / length } else { -1.0 };
        Self {
            error: facet_error(chords),
            lean: (UPRIGHT - upright).max(0.0),
        }
    }

    pub(super) fn worse_of(self, other: Self) -> Self {
        Self {
            error: self.error.max(other.error),
            lean: self.lean + other.lean,
        }
    }
}

impl Run<'_> {
    pub(super) fn face_of(&self, half_edge: u32) -> usize {
        self.mesh.face[half_edge as usize / 3] as usize
    }

    /// Whether a face is planar, so that it is known by its loops only.
    pub(super) fn is_capped(&self, face: usize) -> bool {
        self.sheets[face].is_plane() && !self.kept[face]
    }

    pub(super) fn is_planar(&self, half_edge: u32) -> bool {
        self.is_capped(self.face_of(half_edge))
    }

    /// Whether an edge lies inside a curved face whose facets may change.
    pub(super) fn is_inner(&self, h: u32) -> bool {
        let face = self.face_of(h);
        self.mesh.origin[h as usize] != NONE
            && self.mesh.crease[h as usize] == NONE
            && !self.kept[face]
            && !self.sheets[face].is_plane()
    }

    /// A chord's deviation from the surface of a face, in units of the tolerance; never more than
    /// half its length, since its ends are on the surface.
    pub(super) fn chord(&self, face: usize, a: DVec3, b: DVec3) -> f64 {
        let error = self.sheets[face].chord_error(a, b);
        let square = 0.25 * a.distance_squared(b);
        let error = if error * error <= square {
            error
        } else {
            square.sqrt()
        };
        error / self.tolerances[face]
    }

    /// Measures all facets.
    pub(super) fn measure_all(&mut self) {
        for h in 0..super::index(self.mesh.origin.len()) {
            self.measure_normal(h);
            let t = self.mesh.twin[h as usize];
            if t > h || self.face_of(t) != self.face_of(h) {
                self.measure_chord(h);
            }
        }
        for facet in 0..super::index(self.mesh.face.len()) {
            self.measure_shape(facet);
        }
    }

    pub(super) fn measure_normal(&mut self, h: u32) {
        let face = self.face_of(h);
        if !self.sheets[face].is_plane() {
            let at = self.mesh.position(self.mesh.origin[h as usize]);
            let normal = self.sheets[face].at(at).1 * self.outward[face];
            self.mesh.normal[h as usize] = normal;
        }
    }

    /// Measures an edge on its half-edge's side, and on the other if that is of the same face.
    pub(super) fn measure_chord(&mut self, h: u32) {
        let face = self.face_of(h);
        if !self.sheets[face].is_plane() {
            let [a, b] = [self.mesh.origin[h as usize], self.mesh.target(h)];
            let chord = self.chord(face, self.mesh.position(a), self.mesh.position(b));
            self.set_chord(h, chord);
        }
    }

    pub(super) fn set_chord(&mut self, h: u32, chord: f64) {
        self.mesh.chord[h as usize] = chord;
        let t = self.mesh.twin[h as usize];
        if self.face_of(t) == self.face_of(h) {
            self.mesh.chord[t as usize] = chord;
        }
    }

    pub(super) fn measure_shape(&mut self, facet: u32) {
        let sides = [3 * facet, 3 * facet + 1, 3 * facet + 2].map(|h| h as usize);
        if self.mesh.origin[sides[0]] == NONE || self.is_planar(3 * facet) {
            return;
        }
        self.mesh.shape[facet as usize] = Shape::new(
            sides.map(|h| self.mesh.position(self.mesh.origin[h])),
            sides.map(|h| self.mesh.normal[h]),
            sides.map(|h| self.mesh.chord[h]),
        );
    }

    pub(super) fn shape_of(&self, half_edge: u32) -> Shape {
        self.mesh.shape[half_edge as usize / 3]
    }

    /// Puts a vertex onto an edge; returns the half-edge from there to the edge's end.
    pub(super) fn split(&mut self, h: u32, position: DVec3, role: super::Role) -> u32 {
        let t = self.mesh.twin[h as usize];
        let left = self.mesh.split(h, position, role);
        let right = self.mesh.twin[h as usize];
        self.measure_normal(left);
        self.mesh.normal[next(h) as usize] = self.mesh.normal[left as usize];
        if self.face_of(right) == self.face_of(left) {
            self.mesh.normal[right as usize] = self.mesh.normal[left as usize];
        } else {
            self.measure_normal(right);
        }
        self.mesh.normal[next(t) as usize] = self.mesh.normal[right as usize];
        for edge in [h, left, next(h), next(t)] {
            self.measure_chord(edge);
        }
        if self.mesh.crease[h as usize] != NONE {
            self.measure_chord(t);
            self.measure_chord(right);
        }
        for facet in [h, left, t, right] {
            self.measure_shape(facet / 3);
        }
        left
    }

    /// Exchanges an edge inside a face for the other diagonal, which deviates by `chord`.
    pub(super) fn flip(&mut self, h: u32, chord: f64) {
        let t = self.mesh.twin[h as usize];
        self.mesh.flip(h);
        self.set_chord(h, chord);
        self.measure_shape(h / 3);
        self.measure_shape(t / 3);
    }

    /// Shrinks a → b to b; returns a half-edge from b.
    pub(super) fn collapse(&mut self, h: u32) -> u32 {
        let b = self.mesh.target(h);
        let t = self.mesh.twin[h as usize];
        let faces = [h, t].map(|e| self.face_of(e));
        let normals = [next(h), t].map(|e| self.mesh.normal[e as usize]);
        // From the edge after the one to c, to the one before the one to d: these are new.
        let end = next(t);
        let mut spoke = self.mesh.twin[prev(h) as usize];
        let mut new = Vec::new();
        while spoke != end {
            new.push(spoke);
            spoke = self.mesh.twin[prev(spoke) as usize];
        }
        self.mesh.collapse(h);
        for &spoke in &new {
            let side = usize::from(self.face_of(spoke) != faces[0]);
            self.mesh.normal[spoke as usize] = normals[side];
        }
        // Each spoke, and the side of the last facet that has no spoke of its own.
        for edge in (new.iter().copied()).chain(new.last().map(|&last| prev(last))) {
            self.measure_chord(edge);
            let twin = self.mesh.twin[edge as usize];
            if self.face_of(twin) != self.face_of(edge) {
                self.measure_chord(twin);
            }
        }
        for &spoke in &new {
            self.measure_shape(spoke / 3);
        }
        self.mesh.outgoing[b as usize]
    }
}
