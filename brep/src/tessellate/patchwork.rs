//! A triangle mesh in flat arrays, for local changes: half-edges 3f, 3f + 1, 3f + 2 belong to
//! facet f, and everything else is looked up by number.
//!
//! Curved faces keep their facets. A planar face is known by its loops alone; each of them is
//! capped by a fan around a phantom vertex, so that the whole is closed and every operation is
//! the same everywhere.

use super::measure::Shape;
use crate::group::{FaceId, Groups};
use crate::topology::{Brep, HalfEdgeKey, VertexView};
use glam::DVec3;
use slotmap::SecondaryMap;

/// No vertex, no half-edge, no crease.
pub(super) const NONE: u32 = u32::MAX;

/// What a vertex may do.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Role {
    /// It lies inside a face and may go.
    Inside,
    /// It lies on a B-Rep edge and may go along it.
    Chain,
    /// It stays: a B-Rep vertex, or on an edge that cannot be traced.
    Fixed,
    /// It does not even move: a corner in a face that keeps its facets.
    Held,
    /// The middle of a planar loop's cap.
    Phantom,
}

/// The mesh being changed.
#[derive(Clone, Debug)]
pub(super) struct Patchwork {
    /// By vertex.
    pub(super) positions: Vec<DVec3>,
    /// By vertex.
    pub(super) roles: Vec<Role>,
    /// By vertex: a half-edge that starts there; [`NONE`] once the vertex is removed.
    pub(super) outgoing: Vec<u32>,
    /// By half-edge: the vertex where it starts; [`NONE`] once its facet is removed.
    pub(super) origin: Vec<u32>,
    /// By half-edge.
    pub(super) twin: Vec<u32>,
    /// By half-edge: the B-Rep edge on which it lies, or [`NONE`].
    pub(super) crease: Vec<u32>,
    /// By half-edge: its surface's outward normal at its origin; zero for planes.
    pub(super) normal: Vec<DVec3>,
    /// By half-edge: how far it deviates from its surface, in units of the tolerance.
    pub(super) chord: Vec<f64>,
    /// By facet: its B-Rep face.
    pub(super) face: Vec<u32>,
    /// By facet.
    pub(super) shape: Vec<Shape>,
}

pub(super) fn next(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 {
        half_edge - 2
    } else {
        half_edge + 1
    }
}

pub(super) fn prev(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) {
        half_edge + 2
    } else {
        half_edge - 1
    }
}

impl Patchwork {
    /// The mesh of a boundary, with capped loops in place of planar faces; for each B-Rep edge
    /// its vertices in order, the first one again at the end if it is closed.
    pub(super) fn of(
        brep: &Brep,
        groups: &Groups,
        is_plane: impl Fn(FaceId) -> bool,
    ) -> (Self, Vec<Vec<u32>>) {
        let numbers = brep.number_vertices();
        let mut this = Self {
            positions: brep.vertices().map(VertexView::position).collect(),
            roles: vec![Role::Inside; brep.vertex_count()],
            outgoing: vec![NONE; brep.vertex_count()],
            origin: Vec::new(),
            twin: Vec::new(),
            crease: Vec::new(),
            normal: Vec::new(),
            chord: Vec::new(),
            face: Vec::new(),
            shape: Vec::new(),
        };
        let mut number: SecondaryMap<HalfEdgeKey, u32> =
            SecondaryMap::with_capacity(brep.half_edges.capacity());
        for facet in brep.facets() {
            let face = groups.face_of[facet.key()];
            if is_plane(face) {
                continue;
            }
            let corners = facet.half_edges();
            let first = this.add_facet(corners.map(|h| numbers[h.origin().key()]), face.0);
            for (at, half_edge) in (first..).zip(corners) {
                number.insert(half_edge.key(), at);
            }
        }
        for seed in brep.half_edges() {
            let face = groups.face_of[seed.facet().key()];
            if !is_plane(face) || !groups.is_crease(seed) || number.contains_key(seed.key()) {
                continue;
            }
            let phantom = this.add_vertex(DVec3::ZERO, Role::Phantom);
            let start = this.origin.len();
            let mut half_edge = seed;
            loop {
                let [from, to] = [half_edge.origin(), half_edge.target()];
                let corners = [numbers[from.key()], numbers[to.key()], phantom];
                number.insert(half_edge.key(), this.add_facet(corners, face.0));
                half_edge = groups.continuation(half_edge);
                if half_edge.key() == seed.key() {
                    break;
                }
            }
            this.join_fan(start);
        }
        for (key, &at) in &number {
            let twin = brep.half_edge(key).twin().key();
            this.twin[at as usize] = number[twin];
        }
        let mut chains = Vec::with_capacity(groups.edges.len());
        for (edge, name) in groups.edges.iter().zip(0..) {
            let mut chain = Vec::with_capacity(edge.chain.len() + 1);
            for &key in &edge.chain {
                let half_edge = number[key];
                this.crease[half_edge as usize] = name;
                let twin = this.twin[half_edge as usize];
                this.crease[twin as usize] = name;
                let vertex = this.origin[half_edge as usize];
                this.roles[vertex as usize] = Role::Chain;
                if chain.is_empty() {
                    chain.push(vertex);
                }
                chain.push(this.origin[twin as usize]);
            }
            chains.push(chain);
        }
        for &vertex in &groups.vertices {
            this.roles[numbers[vertex] as usize] = Role::Fixed;
        }
        (this, chains)
    }

    /// Holds all corners of faces that keep their facets.
    pub(super) fn hold(&mut self, kept: &[bool]) {
        for (corners, &face) in self.origin.chunks_exact(3).zip(&self.face) {
            if kept[face as usize] {
                for &corner in corners {
                    self.roles[corner as usize] = Role::Held;
                }
            }
        }
    }

    /// Joins the spokes of a fan whose facets begin at half-edge `start`, phantom last.
    fn join_fan(&mut self, start: usize) {
        let end = self.origin.len();
        for first in (start..end).step_by(3) {
            let following = if first + 3 == end { start } else { first + 3 };
            // target → phantom, and phantom → origin of the following one.
            self.twin[first + 1] = index(following + 2);
            self.twin[following + 2] = index(first + 1);
        }
    }

    fn add_vertex(&mut self, position: DVec3, role: Role) -> u32 {
        self.positions.push(position);
        self.roles.push(role);
        self.outgoing.push(NONE);
        index(self.positions.len() - 1)
    }

    /// Adds a facet without neighbours; returns its first half-edge.
    fn add_facet(&mut self, corners: [u32; 3], face: u32) -> u32 {
        let first = index(self.origin.len());
        self.face.push(face);
        self.shape.push(Shape::default());
        for (half_edge, corner) in (first..).zip(corners) {
            self.origin.push(corner);
            self.twin.push(NONE);
            self.crease.push(NONE);
            self.normal.push(DVec3::ZERO);
            self.chord.push(0.0);
            self.outgoing[corner as usize] = half_edge;
        }
        first
    }

    pub(super) fn target(&self, half_edge: u32) -> u32 {
        self.origin[next(half_edge) as usize]
    }

    /// The half-edges that start at the same vertex, counter-clockwise.
    pub(super) fn ring(&self, half_edge: u32) -> impl Iterator<Item = u32> + '_ {
        std::iter::successors(Some(half_edge), move |&at| {
            let following = self.twin[prev(at) as usize];
            (following != half_edge).then_some(following)
        })
    }

    /// The corners of a facet, counter-clockwise seen from outside.
    pub(super) fn corners(&self, facet: u32) -> [u32; 3] {
        let first = 3 * facet as usize;
        [0, 1, 2].map(|k| self.origin[first + k])
    }

    pub(super) fn position(&self, vertex: u32) -> DVec3 {
        self.positions[vertex as usize]
    }

    /// All facets that are not removed.
    pub(super) fn facets(&self) -> impl Iterator<Item = u32> + '_ {
        (0..index(self.face.len())).filter(|&f| self.origin[3 * f as usize] != NONE)
    }

    fn pair(&mut self, one: u32, other: u32) {
        self.twin[one as usize] = other;
        self.twin[other as usize] = one;
    }

    /// Puts a vertex onto an edge a → b; returns the half-edge from there to b.
    ///
    /// ```text
    ///        c                 c
    ///      ╱   ╲             ╱ | ╲
    ///     a ──h─> b    →    a ─ v ─ b
    ///      ╲   ╱             ╲ | ╱
    ///        d                 d
    /// ```
    pub(super) fn split(&mut self, h: u32, position: DVec3, role: Role) -> u32 {
        let t = self.twin[h as usize];
        let (hn, tn) = (next(h), next(t));
        let [a, b] = [h, t].map(|e| self.origin[e as usize]);
        let [c, d] = [prev(h), prev(t)].map(|e| self.origin[e as usize]);
        let [hn_twin, tn_twin] = [hn, tn].map(|e| self.twin[e as usize]);
        let [hn_crease, tn_crease] = [hn, tn].map(|e| self.crease[e as usize]);
        let crease = self.crease[h as usize];
        let v = self.add_vertex(position, role);
        // Vertices b and a may lose hn and tn as their outgoing half-edges, and gain these.
        let left = self.add_facet([v, b, c], self.face[h as usize / 3]);
        let right = self.add_facet([v, a, d], self.face[t as usize / 3]);
        for (corner, of) in [
            (left + 1, hn),
            (left + 2, prev(h)),
            (right + 1, tn),
            (right + 2, prev(t)),
        ] {
            self.normal[corner as usize] = self.normal[of as usize];
        }
        self.chord[left as usize + 1] = self.chord[hn as usize];
        self.chord[right as usize + 1] = self.chord[tn as usize];
        self.outgoing[c as usize] = prev(h);
        self.outgoing[d as usize] = prev(t);
        self.origin[hn as usize] = v;
        self.origin[tn as usize] = v;
        self.pair(h, right);
        self.pair(t, left);
        self.pair(hn, left + 2);
        self.pair(tn, right + 2);
        self.pair(left + 1, hn_twin);
        self.pair(right + 1, tn_twin);
        for (half_edge, name) in [
            (left, crease),
            (right, crease),
            (hn, NONE),
            (tn, NONE),
            (left + 1, hn_crease),
            (right + 1, tn_crease),
        ] {
            self.crease[half_edge as usize] = name;
        }
        left
    }

    /// Whether the edge a → b may be replaced by the one from d to c.
    pub(super) fn may_flip(&self, h: u32) -> bool {
        let t = self.twin[h as usize];
        let [c, d] = [prev(h), prev(t)].map(|e| self.origin[e as usize]);
        self.crease[h as usize] == NONE
            && c != d
            && !self.ring(prev(h)).any(|spoke| self.target(spoke) == d)
    }

    /// Replaces the edge a → b by the one from d to c, in the same two facets.
    pub(super) fn flip(&mut self, h: u32) {
        let t = self.twin[h as usize];
        let [hn, hp, tn, tp] = [next(h), prev(h), next(t), prev(t)];
        let [a, b, c, d] = [h, t, hp, tp].map(|e| self.origin[e as usize]);
        let [of_a, of_b, of_c, of_d] = [h, t, hp, tp].map(|e| self.normal[e as usize]);
        let old = [hn, hp, tn, tp].map(|e| {
            let e = e as usize;
            (self.twin[e], self.crease[e], self.chord[e])
        });
        let [bc, ca, ad, db] = old;
        for (half_edge, origin, normal, (twin, crease, chord)) in [
            (hn, c, of_c, ca),
            (hp, a, of_a, ad),
            (tn, d, of_d, db),
            (tp, b, of_b, bc),
        ] {
            self.origin[half_edge as usize] = origin;
            self.normal[half_edge as usize] = normal;
            self.crease[half_edge as usize] = crease;
            self.chord[half_edge as usize] = chord;
            self.outgoing[origin as usize] = half_edge;
            self.pair(half_edge, twin);
        }
        self.origin[h as usize] = d;
        self.normal[h as usize] = of_d;
        self.origin[t as usize] = c;
        self.normal[t as usize] = of_c;
    }

    /// Whether a → b can be shrunk to b: the ends have no common neighbours but the two opposite
    /// corners, which keep at least three neighbours, and no crease is lost.
    pub(super) fn may_collapse(&self, h: u32) -> bool {
        let t = self.twin[h as usize];
        let [c, d] = [prev(h), prev(t)].map(|e| self.origin[e as usize]);
        let both =
            |e: u32| self.crease[next(e) as usize] != NONE && self.crease[prev(e) as usize] != NONE;
        if c == d || both(h) || both(t) {
            return false;
        }
        let over_three = |e: u32| self.ring(e).nth(3).is_some();
        if !over_three(prev(h)) || !over_three(prev(t)) {
            return false;
        }
        self.ring(h).skip(1).all(|spoke| {
            let w = self.target(spoke);
            w == c || w == d || !self.ring(t).any(|other| self.target(other) == w)
        })
    }

    /// Shrinks a → b to b, which keeps its place.
    pub(super) fn collapse(&mut self, h: u32) {
        let t = self.twin[h as usize];
        let [a, b] = [h, t].map(|e| self.origin[e as usize]);
        let mut spoke = h;
        loop {
            let following = self.twin[prev(spoke) as usize];
            self.origin[spoke as usize] = b;
            if following == h {
                break;
            }
            spoke = following;
        }
        for side in [h, t] {
            let (n, p) = (next(side), prev(side));
            let [x, y] = [n, p].map(|e| self.twin[e as usize]);
            let [one, other] = [n, p].map(|e| self.crease[e as usize]);
            let crease = if one == NONE { other } else { one };
            self.pair(x, y);
            self.crease[x as usize] = crease;
            self.crease[y as usize] = crease;
            for e in [x, y] {
                let origin = self.origin[e as usize];
                self.outgoing[origin as usize] = e;
            }
            for e in [side, n, p] {
                self.origin[e as usize] = NONE;
            }
        }
        self.outgoing[a as usize] = NONE;
    }
}

/// Half-edges are fewer than 2³² − 1: a boundary is stored with 32-bit keys.
pub(super) fn index(number: usize) -> u32 {
    u32::try_from(number).unwrap_or(NONE)
}
