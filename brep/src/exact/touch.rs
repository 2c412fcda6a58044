//! Faces that touch themselves: what hangs together by no width is taken apart.
//!
//! The mesh keeps sheets apart that touch along edges or in points, and where a part of a face shrinks
//! to no width it keeps what is on both sides of that neck together:
//!
//! ```text
//!   ┌─────┐ ┌─────┐        ┌─────┐ ┌─────┐
//!   │     a b     │        │      V      │       a and b are one point in truth,
//!   │     ┌─┐     │   →    │     ┌ ┐     │       the face is two
//!   └─────┘ └─────┘        └─────┘ └─────┘
//! ```

use super::Raw;
use super::zip::COINCIDENT;
use crate::curve::{Curve, Piece};
use csg::{Sense, Solid, Surface};
use glam::DVec3;
use std::f64::consts::TAU;

/// Distance, relative to the solid, and sine below which two curves are one.
const SAME: f64 = 1e-9;
/// Smallest angle, in radians, between edges whose order around a vertex is to be known.
const CLEAR: f64 = 1e-6;
/// Chords of an edge in polygons.
const CHORDS: usize = 32;

impl Raw {
    /// Takes faces apart where they have no width. Says whether there was something to do.
    pub(super) fn part_touching(&mut self, solid: &Solid, near: f64) -> bool {
        let mut pending: Vec<usize> = (0..)
            .zip(self.borders())
            .filter(|(_, border)| {
                self.running_along(border, near).is_some()
                    || self.neck(border, solid, near).is_some()
            })
            .map(|(face, _)| face)
            .collect();
        let mut changed = false;
        while let Some(face) = pending.pop() {
            let known = self.face_alive.len();
            let is_other =
                self.part_along_edges(face, solid, near) | self.part_at_vertices(face, solid, near);
            if is_other {
                changed = true;
                pending.extend(known..self.face_alive.len());
            }
        }
        changed
    }

    /// Whether each face still hangs together by a neck without width.
    pub(super) fn necks(&self, solid: &Solid, near: f64) -> Vec<bool> {
        let borders = self.borders();
        let necks = borders.iter();
        necks
            .map(|border| self.neck(border, solid, near).is_some())
            .collect()
    }

    /// For each face its half-edges that have ends.
    fn borders(&self) -> Vec<Vec<usize>> {
        let mut borders = vec![Vec::new(); self.face_alive.len()];
        for half_edge in 0..self.next.len() {
            if self.edge_alive[half_edge / 2] && self.edges[half_edge / 2].ends.is_some() {
                borders[self.face[half_edge]].push(half_edge);
            }
        }
        borders
    }

    fn border(&self, face: usize) -> Vec<usize> {
        let open = |&half_edge: &usize| {
            self.face[half_edge] == face
                && self.edge_alive[half_edge / 2]
                && self.edges[half_edge / 2].ends.is_some()
        };
        (0..self.next.len()).filter(open).collect()
    }

    /// Makes a fold of its own of two edges that run along each other.
    fn part_along_edges(&mut self, face: usize, solid: &Solid, near: f64) -> bool {
        let mut changed = false;
        while let Some((one, other)) = self.running_along(&self.border(face), near) {
            // As long as each other, then with the same ends.
            let Some((one, other)) = self.cut_alike(one, other, near) else {
                return changed;
            };
            let [start, end] = [self.prev[one], self.prev[other]];
            let is_parted = (start == other || self.pinch(start, other, solid))
                && (end == one || self.pinch(self.prev[other], one, solid));
            if !is_parted {
                return changed;
            }
            changed = true;
            if !self.close_fold(one, other) {
                return changed;
            }
        }
        changed
    }

    /// Drops a face that is nothing but two half-edges.
    fn close_fold(&mut self, one: usize, other: usize) -> bool {
        self.next[one] == other && self.next[other] == one && self.close(one, other)
    }

    /// Two half-edges of a face, not one after the other, that run along each other's curve in
    /// opposite directions.
    fn running_along(&self, border: &[usize], near: f64) -> Option<(usize, usize)> {
        let mut all: Vec<(csg::Aabb, usize, Piece)> = border
            .iter()
            .map(|&half_edge| {
                let piece = self.along(half_edge);
                (piece.bounds(), half_edge, piece)
            })
            .collect();
        all.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x).then(a.1.cmp(&b.1)));
        for (at, (aabb, one, piece)) in all.iter().enumerate() {
            for (others, other, back) in &all[at + 1..] {
                if others.min.x > aabb.max.x + near {
                    break;
                }
                let meets = others.min.cmple(aabb.max + near).all()
                    && aabb.min.cmple(others.max + near).all();
                let is_neighbour = self.next[*one] == *other || self.next[*other] == *one;
                if meets
                    && one / 2 != other / 2
                    && !is_neighbour
                    && piece.overlap(&back.reversed(), near) > near
                {
                    return Some((*one, *other));
                }
            }
        }
        None
    }

    /// Cuts two half-edges that run along each other where either one ends; returns the parts that
    /// run along each other.
    fn cut_alike(&mut self, one: usize, other: usize, near: f64) -> Option<(usize, usize)> {
        let (mut one, mut other) = (one, other);
        // Starts: the later one of the two.
        let end_of = |this: &Self, half_edge: usize| this.target(half_edge);
        if let Some(vertex) = end_of(self, other)
            && let Some(rest) = self.cut(one, vertex, near)
        {
            one = rest;
        } else if let Some(vertex) = self.source(one) {
            self.cut(other, vertex, near);
        }
        if let Some(vertex) = self.source(other)
            && self.cut(one, vertex, near).is_some()
        {
        } else if let Some(vertex) = self.target(one)
            && let Some(rest) = self.cut(other, vertex, near)
        {
            other = rest;
        }
        let position = |vertex: Option<usize>| vertex.map(|at| self.vertices[at]);
        let is_one = |a: Option<DVec3>, b: Option<DVec3>| {
            a.zip(b).is_some_and(|(a, b)| a.distance(b) <= near)
        };
        let is_alike = is_one(position(self.source(one)), position(self.target(other)))
            && is_one(position(self.target(one)), position(self.source(other)));
        is_alike.then_some((one, other))
    }

    fn source(&self, half_edge: usize) -> Option<usize> {
        Some(self.edges[half_edge / 2].ends?[half_edge % 2])
    }

    fn target(&self, half_edge: usize) -> Option<usize> {
        Some(self.edges[half_edge / 2].ends?[1 - half_edge % 2])
    }

    /// Makes one vertex of two that are one point, where the face has no width between them.
    fn part_at_vertices(&mut self, face: usize, solid: &Solid, near: f64) -> bool {
        let mut changed = false;
        while let Some((into, other)) = self.neck(&self.border(face), solid, near) {
            if !self.pinch(into, other, solid) {
                return changed;
            }
            changed = true;
        }
        changed
    }

    /// Two half-edges that end in one point, but in different vertices, and between which the face has no
    /// width: seen from the vertex, the other one's end comes first.
    fn neck(&self, border: &[usize], solid: &Solid, near: f64) -> Option<(usize, usize)> {
        let mut ends: Vec<(DVec3, usize, usize)> = border
            .iter()
            .filter_map(|&half_edge| {
                let vertex = self.target(half_edge)?;
                Some((self.vertices[vertex], vertex, half_edge))
            })
            .collect();
        ends.sort_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.2.cmp(&b.2)));
        for (at, &(point, vertex, into)) in ends.iter().enumerate() {
            for &(other_point, other_vertex, other) in &ends[at + 1..] {
                if other_point.x > point.x + near {
                    break;
                }
                if other_vertex != vertex
                    && point.distance(other_point) <= near
                    && self.is_neck(into, other, solid)
                {
                    return Some((into, other));
                }
            }
        }
        None
    }

    fn is_neck(&self, into: usize, other: usize, solid: &Solid) -> bool {
        let Some(normal) = self.normal(self.face[into], self.along(into).ends[1], solid) else {
            return false;
        };
        let out = |half_edge: usize| self.along(self.next[half_edge]).leaving();
        let back = |half_edge: usize| self.along(half_edge).reversed().leaving();
        let turn = |from: DVec3, to: DVec3| {
            let angle = from.cross(to).dot(normal).atan2(from.dot(to));
            angle.rem_euclid(TAU)
        };
        let comes_first = |from: usize, own: usize, foreign: usize| {
            let own = turn(out(from), back(own));
            let foreign = turn(out(from), back(foreign));
            foreign > CLEAR && foreign + CLEAR < own
        };
        comes_first(into, into, other) && comes_first(other, other, into)
    }

    /// The outward normal of a face's surface.
    fn normal(&self, face: usize, at: DVec3, solid: &Solid) -> Option<DVec3> {
        let (primitive, sense) = self.surface_of[face];
        let primitive = solid.primitives.get(primitive.0 as usize)?;
        let gradient = primitive.polynomial.gradient(solid.domain.to_centered(at));
        let normal = gradient.try_normalize()?;
        Some(if sense == Sense::Inside {
            normal
        } else {
            -normal
        })
    }

    /// Lets each of two half-edges of a face be followed by what followed the other one, and makes one
    /// vertex of their ends. If that makes two loops of one, the face becomes two.
    fn pinch(&mut self, into: usize, other: usize, solid: &Solid) -> bool {
        let (Some(kept), Some(gone)) = (self.target(into), self.target(other)) else {
            return false;
        };
        let face = self.face[into];
        let was_one = self.ring(into).contains(&other);
        let (after, after_other) = (self.next[into], self.next[other]);
        self.link(into, after_other);
        self.link(other, after);
        if was_one && !self.split(face, into, other, solid) {
            self.link(into, after);
            self.link(other, after_other);
            return false;
        }
        if !was_one {
            self.loop_count[face] -= 1;
        }
        if kept == gone {
            self.part_vertex(kept, into, other);
        } else {
            self.identify(kept, gone);
        }
        true
    }

    /// Gives the half-edges around the end of `other` a vertex of their own, if those around the
    /// end of `into` are not the same.
    fn part_vertex(&mut self, vertex: usize, into: usize, other: usize) {
        let mut around = vec![other];
        let mut half_edge = self.next[other] ^ 1;
        while half_edge != other && around.len() <= self.next.len() {
            around.push(half_edge);
            half_edge = self.next[half_edge] ^ 1;
        }
        if around.contains(&into) {
            return;
        }
        let new = self.vertices.len();
        self.vertices.push(self.vertices[vertex]);
        self.meeting.push(self.meeting[vertex].clone());
        for half_edge in around {
            if let Some(ends) = &mut self.edges[half_edge / 2].ends {
                ends[1 - half_edge % 2] = new;
            }
        }
    }

    fn ring(&self, start: usize) -> Vec<usize> {
        let mut ring = vec![start];
        let mut half_edge = self.next[start];
        while half_edge != start && ring.len() <= self.next.len() {
            ring.push(half_edge);
            half_edge = self.next[half_edge];
        }
        ring
    }

    /// Makes two faces of one whose loop became two: those of these half-edges. `false` if other
    /// loops might belong to either.
    fn split(&mut self, face: usize, one: usize, other: usize, solid: &Solid) -> bool {
        let (stays, leaves) = (self.ring(one), self.ring(other));
        let mut rest: Vec<Vec<usize>> = self.rings();
        rest.retain(|ring| {
            self.face[ring[0]] == face && !ring.contains(&one) && !ring.contains(&other)
        });
        let mut leaving = vec![leaves];
        if !rest.is_empty() {
            // A fold of two edges encloses nothing.
            let near = COINCIDENT * solid.extent.diagonal();
            let is_fold = |ring: &[usize]| {
                let &[one, other] = ring else {
                    return false;
                };
                self.along(one).overlap(&self.along(other).reversed(), near) > near
            };
            if is_fold(&stays) && !is_fold(&leaving[0]) {
                leaving.append(&mut rest);
            } else if !is_fold(&leaving[0]) {
                for ring in rest {
                    let leaves = match self.surface(face, solid) {
                        Some(Surface::Plane { .. }) => {
                            self.is_in(&ring, &leaving[0], &stays, face, solid)
                        }
                        Some(
                            Surface::Cylinder {
                                point: center,
                                axis,
                                ..
                            }
                            | Surface::Cone {
                                apex: center, axis, ..
                            },
                        ) => {
                            // Around the axis the loops of a face cancel each other.
                            let [t, leave, stay] =
                                [&ring, &leaving[0], &stays].map(|r| self.turns(r, center, axis));
                            let is = |a: f64, b: f64| (a - b).abs() < 0.5;
                            if !is(t, 0.0) && is(t, -leave) && is(t, stay) {
                                Some(true)
                            } else if !is(t, 0.0) && is(t, -stay) && is(t, leave) {
                                Some(false)
                            } else {
                                None
                            }
                        }
                        _ => None,
                    };
                    match leaves {
                        Some(true) => leaving.push(ring),
                        Some(false) => {}
                        None => return false,
                    }
                }
            }
        }
        let new = self.face_alive.len();
        self.face_alive.push(true);
        self.face_size.push(self.face_size[face]);
        self.origin.push(self.origin[face]);
        self.surface_of.push(self.surface_of[face]);
        self.loop_count[face] = self.loop_count[face] + 1 - leaving.len();
        self.loop_count.push(leaving.len());
        for half_edge in leaving.into_iter().flatten() {
            self.face[half_edge] = new;
        }
        true
    }

    fn surface(&self, face: usize, solid: &Solid) -> Option<Surface> {
        let (primitive, _) = self.surface_of[face];
        let primitive = solid.primitives.get(primitive.0 as usize)?;
        Some(primitive.surface(&solid.domain))
    }

    /// How often a loop runs around an axis.
    fn turns(&self, ring: &[usize], center: DVec3, axis: DVec3) -> f64 {
        let polygon = self.polygon(ring);
        let across = |point: DVec3| (point - center).reject_from_normalized(axis);
        let angles = polygon.windows(2).map(|pair| {
            let [a, b] = [across(pair[0]), across(pair[1])];
            a.cross(b).dot(axis).atan2(a.dot(b))
        });
        (angles.sum::<f64>() / TAU).round()
    }

    /// Whether a hole of a plane face lies in the part that one loop bounds rather than in that of
    /// another.
    fn is_in(
        &self,
        hole: &[usize],
        one: &[usize],
        other: &[usize],
        face: usize,
        solid: &Solid,
    ) -> Option<bool> {
        let point = *self.polygon(hole).get(1)?;
        let normal = self.normal(face, point, solid)?;
        let [one, other] = [one, other].map(|ring| {
            let polygon = self.polygon(ring);
            let turns: f64 = polygon
                .windows(2)
                .map(|pair| {
                    let [a, b] = [pair[0] - point, pair[1] - point];
                    a.cross(b).dot(normal).atan2(a.dot(b))
                })
                .sum();
            (turns / TAU).round()
        });
        // Within an outer loop, or not within what became a hole.
        Some(one > 0.5 || (one > -0.5 && other < -0.5))
    }

    /// Points along a loop; the first one is repeated at the end.
    pub(super) fn polygon(&self, ring: &[usize]) -> Vec<DVec3> {
        let mut points = Vec::with_capacity(ring.len() * CHORDS + 1);
        for &half_edge in ring {
            let piece = self.along(half_edge);
            let [from, to] = piece.range;
            points.extend((0..CHORDS).map(|k| {
                let t = from + (to - from) * (k as f64 / CHORDS as f64);
                piece.curve.point(t)
            }));
        }
        points.extend(points.first().copied());
        points
    }
}

impl Piece {
    /// A box that holds the piece.
    pub(super) fn bounds(&self) -> csg::Aabb {
        let points = match &self.curve {
            Curve::Line { .. } => self.ends.to_vec(),
            Curve::Traced { points } => points.clone(),
            Curve::Circle { center, across } | Curve::Ellipse { center, across } => {
                let reach = across[0].abs() + across[1].abs();
                vec![*center - reach, *center + reach]
            }
        };
        let mut bounds = csg::Aabb::EMPTY;
        for point in points {
            bounds.min = bounds.min.min(point);
            bounds.max = bounds.max.max(point);
        }
        bounds
    }

    /// Direction in which it leaves its start.
    fn leaving(&self) -> DVec3 {
        self.curve.tangent(self.range[0]).normalize_or_zero()
    }

    /// How long the other piece runs on this one in the same direction: zero for traced curves that
    /// do not have the same ends.
    pub(super) fn overlap(&self, other: &Self, near: f64) -> f64 {
        let spans = |start: f64, turn: f64| {
            let end = start + other.range[1] - other.range[0];
            let [from, to] = self.range;
            let part = |shift: f64| (end + shift).min(to) - (start + shift).max(from);
            part(0.0).max(part(-turn)).max(part(turn))
        };
        let on = |curve: &Curve, point: DVec3| {
            curve.point(curve.parameter(point)).distance(point) <= near
        };
        match (&self.curve, &other.curve) {
            (
                Curve::Line { direction: d, .. },
                Curve::Line {
                    direction: e,
                    point,
                },
            ) => {
                let is_one = d.dot(*e) > 0.0 && d.cross(*e).length() <= SAME;
                if is_one && on(&self.curve, *point) && on(&self.curve, other.ends[1]) {
                    spans(self.curve.parameter(other.ends[0]), 0.0)
                } else {
                    0.0
                }
            }
            (Curve::Circle { across, .. } | Curve::Ellipse { across, .. }, conic)
                if self.curve.is_one_conic(conic, near) =>
            {
                let size = across[0].length().min(across[1].length());
                let start = self.curve.parameter(other.curve.point(other.range[0]));
                let start = self.range[0] + (start - self.range[0]).rem_euclid(TAU);
                spans(start, TAU) * size
            }
            (Curve::Traced { points: a }, Curve::Traced { points: b }) => {
                let [gap, far] = [0, 1].map(|end| self.ends[end].distance(other.ends[end]));
                let middle = b[b.len() / 2];
                let chord = |points: &[DVec3]| {
                    let lengths = points.windows(2).map(|pair| pair[0].distance(pair[1]));
                    lengths.fold(0.0, f64::max)
                };
                let allowed = near.max(1e-3 * chord(a));
                let is_one = gap <= near
                    && far <= near
                    && self
                        .curve
                        .point(self.curve.parameter(middle))
                        .distance(middle)
                        <= allowed;
                if is_one { chord(a) } else { 0.0 }
            }
            _ => 0.0,
        }
    }
}
