//! Vertices inside curved faces: taken away where the rest stays near its surface and faces the
//! same way, put in where it does not.

use super::patchwork::{NONE, Role, next, prev};
use super::sheet::{facet_error, project_on_both};
use super::{FaceId, Run};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Cosine of the angle between a facet and its surface's normals from which on it is bad.
const UPRIGHT: f64 = 0.3;

/// Flips after a split, at most: they come to an end by themselves, but for rounding.
const FLIPS: usize = 64;

/// Splits in one boundary, at most: something is wrong with a surface that needs more.
const SPLITS: usize = 1 << 15;

/// Rounds of decimation, at most.
const PASSES: usize = 8;

/// How good a facet is.
#[derive(Clone, Copy, Debug, Default)]
struct Shape {
    /// Largest deviation from its surface, in units of the tolerance.
    error: f64,
    /// How far it leans, from 0 (good) to 1.3 (turned over).
    lean: f64,
}

impl Shape {
    fn worse_of(self, other: Self) -> Self {
        Self {
            error: self.error.max(other.error),
            lean: self.lean + other.lean,
        }
    }
}

/// A facet that deviates too much.
struct Candidate {
    error: f64,
    facet: u32,
    corners: [u32; 3],
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error
            .total_cmp(&other.error)
            .then(other.facet.cmp(&self.facet))
    }
}

impl Run<'_> {
    fn face_of(&self, half_edge: u32) -> usize {
        self.mesh.face[half_edge as usize / 3] as usize
    }

    /// A chord's deviation from the surface of a face; never more than half its length, since
    /// its ends are on the surface.
    fn chord_error(&self, face: usize, a: DVec3, b: DVec3) -> f64 {
        self.sheets[face].chord_error(a, b).min(0.5 * a.distance(b))
    }

    fn shape(&self, face: usize, corners: [u32; 3]) -> Shape {
        let sheet = self.sheets[face];
        if sheet.is_plane() {
            return Shape::default();
        }
        let [a, b, c] = corners.map(|v| self.mesh.position(v));
        let errors = [[a, b], [b, c], [c, a]].map(|[p, q]| self.chord_error(face, p, q));
        let normal = (b - a).cross(c - a);
        let upright = match normal.try_normalize() {
            None => -1.0,
            Some(normal) => [a, b, c]
                .map(|p| sheet.at(p).1)
                .into_iter()
                .filter(|n| *n != DVec3::ZERO)
                .map(|n| n.dot(normal) * self.outward[face])
                .fold(1.0, f64::min),
        };
        Shape {
            error: facet_error(errors) / self.tolerances[face],
            lean: (UPRIGHT - upright).max(0.0),
        }
    }

    fn shape_of(&self, half_edge: u32) -> Shape {
        let corners = self.mesh.corners(half_edge / 3);
        self.shape(self.face_of(half_edge), corners)
    }

    /// What collapsing a → b makes of the facets around a; `None` if it must not be.
    fn collapsed(&self, h: u32, within: f64) -> Option<Shape> {
        // Most collapses fail here: one new edge is enough.
        let to = self.mesh.position(self.mesh.target(h));
        let beside =
            [prev(h), prev(self.mesh.twin[h as usize])].map(|e| self.mesh.origin[e as usize]);
        let too_far = |spoke: u32| {
            let far = self.mesh.target(spoke);
            let face = self.face_of(spoke);
            !beside.contains(&far)
                && self.chord_error(face, to, self.mesh.position(far)) > self.tolerances[face]
        };
        if within <= 1.0 && self.mesh.ring(h).skip(1).any(too_far) {
            return None;
        }
        let (before, after) = self.around_collapse(h)?;
        let near = after.error <= within || (within > 1.0 && after.error <= before.error);
        (near && after.lean <= before.lean).then_some(after)
    }

    /// The facets around a before and after collapsing a → b; `None` if that cannot be.
    fn around_collapse(&self, h: u32) -> Option<(Shape, Shape)> {
        if !self.mesh.may_collapse(h) {
            return None;
        }
        let [from, to] = [self.mesh.origin[h as usize], self.mesh.target(h)];
        let (mut before, mut after) = (Shape::default(), Shape::default());
        for spoke in self.mesh.ring(h) {
            let face = self.face_of(spoke);
            if self.sheets[face].is_plane() {
                continue;
            }
            let corners = self.mesh.corners(spoke / 3);
            before = before.worse_of(self.shape(face, corners));
            if !corners.contains(&to) {
                let moved = corners.map(|v| if v == from { to } else { v });
                after = after.worse_of(self.shape(face, moved));
            }
        }
        Some((before, after))
    }

    /// Turns facets that lean: by flips, and by taking away vertices that are out of place.
    ///
    /// A subdivision's facets do not lean against its own interpolants; they may against the
    /// true surfaces, or when their B-Rep edges have moved to where they should be.
    fn straighten(&mut self) {
        for _ in 0..PASSES {
            let leaning: Vec<u32> = (self.mesh.facets())
                .filter(|&facet| self.shape_of(3 * facet).lean > 0.0)
                .collect();
            let mut done = 0;
            for facet in &leaning {
                done += usize::from(self.straighten_facet(*facet));
            }
            if done == 0 {
                break;
            }
        }
    }

    /// The flip or collapse that lessens the lean most.
    fn straighten_facet(&mut self, facet: u32) -> bool {
        const LEAST: f64 = 1e-6;
        let sides = [3 * facet, 3 * facet + 1, 3 * facet + 2];
        if self.mesh.origin[sides[0] as usize] == NONE || self.shape_of(sides[0]).lean == 0.0 {
            return false;
        }
        for h in sides {
            if self.is_inner(h) {
                let [before, after] = self.around_flip(h);
                if after.lean < before.lean - LEAST && self.mesh.may_flip(h) {
                    self.mesh.flip(h);
                    return true;
                }
            }
        }
        let mut best = (LEAST, NONE);
        for corner in sides {
            let vertex = self.mesh.origin[corner as usize] as usize;
            let role = self.mesh.roles[vertex];
            for h in self.mesh.ring(corner) {
                let along = role == Role::Chain && self.mesh.crease[h as usize] != NONE;
                if role != Role::Inside && !along {
                    continue;
                }
                if let Some((before, after)) = self.around_collapse(h)
                    && before.lean - after.lean > best.0
                {
                    best = (before.lean - after.lean, h);
                }
            }
        }
        if best.1 == NONE {
            return false;
        }
        self.mesh.collapse(best.1);
        true
    }

    /// Takes vertices of the subdivision off the B-Rep edges that have got points of their own.
    pub(super) fn collapse_along_chains(&mut self, mut vertices: Vec<u32>) {
        for limit in [1.0, 4.0, f64::INFINITY] {
            loop {
                let before = vertices.len();
                vertices.retain(|&vertex| {
                    let first = self.mesh.outgoing[vertex as usize];
                    let best = (self.mesh.ring(first))
                        .filter(|&h| self.mesh.crease[h as usize] != NONE)
                        .filter_map(|h| Some((self.collapsed(h, limit)?, h)))
                        .min_by(|(a, _), (b, _)| a.error.total_cmp(&b.error));
                    if let Some((_, h)) = best {
                        self.mesh.collapse(h);
                    }
                    best.is_none()
                });
                if vertices.len() == before {
                    break;
                }
            }
        }
    }

    /// Decimates, refines, decimates again.
    pub(super) fn refine(&mut self) {
        self.straighten();
        self.decimate();
        self.split_far_facets();
        self.decimate();
        self.flip_all(true);
    }

    fn decimate(&mut self) {
        for _ in 0..PASSES {
            self.flip_all(false);
            let mut gone = 0;
            for vertex in 0..super::index(self.mesh.positions.len()) {
                let first = self.mesh.outgoing[vertex as usize];
                if first == NONE || self.mesh.roles[vertex as usize] != Role::Inside {
                    continue;
                }
                let best = (self.mesh.ring(first))
                    .filter_map(|h| Some((self.collapsed(h, 1.0)?, h)))
                    .min_by(|(a, _), (b, _)| a.error.total_cmp(&b.error));
                if let Some((_, h)) = best {
                    self.mesh.collapse(h);
                    gone += 1;
                }
            }
            if gone == 0 {
                break;
            }
        }
    }

    /// Flips edges until no flip makes two facets better.
    fn flip_all(&mut self, by_angle: bool) {
        let mut open: Vec<u32> = (0..super::index(self.mesh.origin.len()))
            .rev()
            .filter(|&h| self.is_inner(h) && h < self.mesh.twin[h as usize])
            .collect();
        let mut left = 8 * open.len();
        while let Some(h) = open.pop() {
            if left == 0 {
                break;
            }
            if self.is_inner(h) && self.try_flip(h, by_angle) {
                left -= 1;
                let t = self.mesh.twin[h as usize];
                open.extend([next(h), prev(h), next(t), prev(t)]);
            }
        }
    }

    fn is_inner(&self, h: u32) -> bool {
        self.mesh.origin[h as usize] != NONE
            && self.mesh.crease[h as usize] == NONE
            && !self.sheets[self.face_of(h)].is_plane()
    }

    /// Flips an edge inside a face if the other diagonal is nearer to the surface, or (where
    /// both are near enough, `by_angle`) if it makes the smallest angle larger, and if no facet
    /// leans more than before.
    fn try_flip(&mut self, h: u32, by_angle: bool) -> bool {
        let t = self.mesh.twin[h as usize];
        let face = self.face_of(h);
        let corners = [h, t, prev(h), prev(t)].map(|e| self.mesh.origin[e as usize]);
        let [a, b, c, d] = corners.map(|v| self.mesh.position(v));
        let [old, new] = [[a, b], [c, d]].map(|[p, q]| self.chord_error(face, p, q));
        let better = if by_angle && old.max(new) <= self.tolerances[face] {
            sharpest(d, c, a).min(sharpest(c, d, b))
                > sharpest(a, b, c).min(sharpest(b, a, d)) + 1e-9
        } else {
            new < old * (1.0 - 1e-9) - self.rounding
        };
        if !better {
            return false;
        }
        let [before, after] = self.around_flip(h);
        let nearer = after.error < before.error || after.error <= 1.0;
        if nearer && after.lean <= before.lean && self.mesh.may_flip(h) {
            self.mesh.flip(h);
            return true;
        }
        false
    }

    /// The two facets at an edge before and after flipping it.
    fn around_flip(&self, h: u32) -> [Shape; 2] {
        let t = self.mesh.twin[h as usize];
        let face = self.face_of(h);
        let [a, b, c, d] = [h, t, prev(h), prev(t)].map(|e| self.mesh.origin[e as usize]);
        let [before, after] = [[[a, b, c], [b, a, d]], [[d, c, a], [c, d, b]]];
        [before, after].map(|[one, other]| self.shape(face, one).worse_of(self.shape(face, other)))
    }

    fn split_far_facets(&mut self) {
        let mut heap = BinaryHeap::new();
        let facets: Vec<u32> = self.mesh.facets().collect();
        for facet in facets {
            self.push(&mut heap, facet);
        }
        let mut left = SPLITS;
        while let Some(candidate) = heap.pop() {
            if left == 0 {
                break;
            }
            if self.mesh.corners(candidate.facet) != candidate.corners {
                continue;
            }
            // What lies on its face is no matter of size.
            if self.shape_of(3 * candidate.facet).lean > UPRIGHT {
                continue;
            }
            let Some(spoke) = self.split_worst_edge(candidate.facet) else {
                continue;
            };
            left -= 1;
            let mut open: Vec<u32> = self.mesh.ring(spoke).map(next).collect();
            let mut touched: Vec<u32> = open.iter().map(|h| h / 3).collect();
            let mut flips = 0;
            while let Some(h) = open.pop() {
                if flips < FLIPS && self.is_inner(h) && self.try_flip(h, false) {
                    flips += 1;
                    let t = self.mesh.twin[h as usize];
                    open.extend([next(h), prev(h), next(t), prev(t)]);
                    touched.extend([h / 3, t / 3]);
                }
            }
            touched.sort_unstable();
            touched.dedup();
            for facet in touched {
                self.push(&mut heap, facet);
            }
        }
    }

    fn push(&self, heap: &mut BinaryHeap<Candidate>, facet: u32) {
        let Shape { error, .. } = self.shape_of(3 * facet);
        if error > 1.0 {
            let corners = self.mesh.corners(facet);
            heap.push(Candidate {
                error,
                facet,
                corners,
            });
        }
    }

    /// Splits the edge of a facet that deviates most; returns a half-edge from the new vertex.
    fn split_worst_edge(&mut self, facet: u32) -> Option<u32> {
        let face = self.mesh.face[facet as usize] as usize;
        let ends = |h: u32| {
            [self.mesh.origin[h as usize], self.mesh.target(h)].map(|v| self.mesh.position(v))
        };
        let worst = [3 * facet, 3 * facet + 1, 3 * facet + 2]
            .map(|h| {
                let [a, b] = ends(h);
                (self.chord_error(face, a, b), h)
            })
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))?
            .1;
        let [a, b] = ends(worst);
        let middle = a.midpoint(b);
        let crease = self.mesh.crease[worst as usize];
        let (position, role) = if crease == NONE {
            (
                self.sheets[face].project(middle, self.rounding)?,
                Role::Inside,
            )
        } else {
            let faces = self.groups.edges[crease as usize].faces;
            let sheets = faces.map(|FaceId(face)| self.sheets[face as usize]);
            (project_on_both(sheets, middle, self.rounding)?, Role::Fixed)
        };
        if position.distance(middle) > 0.6 * a.distance(b) {
            return None;
        }
        Some(self.mesh.split(worst, position, role))
    }

    /// Faces with facets that deviate too much, or stand across their surface.
    pub(super) fn troubled(&self) -> Vec<usize> {
        let mut faces: Vec<usize> = (self.mesh.facets())
            .filter(|&facet| {
                let shape = self.shape_of(3 * facet);
                shape.error > 1.0 + 1e-9 || shape.lean > UPRIGHT
            })
            .map(|facet| self.mesh.face[facet as usize] as usize)
            .collect();
        faces.dedup();
        faces
    }

    pub(super) fn largest_deviation(&self) -> f64 {
        let deviation = |facet: u32| {
            let face = self.mesh.face[facet as usize] as usize;
            self.shape_of(3 * facet).error * self.tolerances[face]
        };
        self.mesh.facets().map(deviation).fold(0.0, f64::max)
    }
}

/// Sine of twice-area over the two longest sides: small for slivers of any kind.
fn sharpest(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let [p, q, r] = [b - a, c - b, a - c];
    let mut squares = [p, q, r].map(DVec3::length_squared);
    squares.sort_by(f64::total_cmp);
    let area = p.cross(q).length();
    area / (squares[1] * squares[2]).sqrt()
}
