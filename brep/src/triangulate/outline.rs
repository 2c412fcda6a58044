//! The loops of planar faces, and the vertices that straight edges can do without.

use super::planar::{self, Outline, Refusal};
use crate::group::{Edge, FaceId, Groups};
use crate::topology::{Brep, HalfEdgeKey, VertexKey, VertexView};
use crate::validate::Valid;
use csg::PrimitiveId;
use glam::DVec3;
use slotmap::SecondaryMap;
use std::ops::Range;

/// How far vertices may be from the plane or line they belong to, relative to the largest
/// coordinate. Positions carry a few ulps (1e-16) of rounding, and more where planes meet at
/// small angles; the volume must stay the same in twelve digits.
const FLATNESS: f64 = 1e-13;

/// No chain.
const NONE: u32 = u32::MAX;

/// The loops of all planar faces.
pub(super) struct Outlines {
    /// By vertex number.
    pub(super) positions: Vec<DVec3>,
    /// Vertex numbers, as in [`Brep::number_vertices`].
    pub(super) numbers: SecondaryMap<VertexKey, u32>,
    /// Vertex numbers of all loops, one loop after the other, each with its face to the left.
    corners: Vec<u32>,
    /// Each loop's part of `corners`, by face.
    loops: Vec<Range<usize>>,
    /// By face.
    faces: Vec<FaceOutline>,
    /// By vertex number: the straight chain in the middle of which it is, or [`NONE`].
    chain_of: Vec<u32>,
    chains: Vec<Chain>,
}

/// What is known about a face.
#[derive(Clone, Debug, Default)]
struct FaceOutline {
    /// Whether it is a plane that has not been given up.
    is_candidate: bool,
    /// Twice the sum of the facets' area vectors.
    normal: DVec3,
    /// Its part of the loops.
    loops: Range<usize>,
    /// Facets, less two for each vertex inside, less one for each boundary edge.
    excess: i64,
    /// Straight chains along it.
    chains: Vec<u32>,
}

/// A straight edge between two planar faces, or two materials on one plane, that has more than its two ends.
struct Chain {
    faces: [usize; 2],
    /// Whether its inner vertices are left out.
    is_reduced: bool,
}

impl Outlines {
    pub(super) fn of(
        brep: &Valid<Brep>,
        groups: &Groups,
        is_plane: &impl Fn(PrimitiveId) -> bool,
    ) -> Self {
        let mut this = Self {
            positions: brep.vertices().map(VertexView::position).collect(),
            numbers: brep.number_vertices(),
            corners: Vec::new(),
            loops: Vec::new(),
            faces: (groups.faces.iter())
                .map(|face| FaceOutline {
                    is_candidate: is_plane(face.primitive),
                    excess: i64::try_from(face.facet_count).unwrap_or(i64::MAX),
                    ..FaceOutline::default()
                })
                .collect(),
            chain_of: vec![NONE; brep.vertex_count()],
            chains: Vec::new(),
        };
        for facet in brep.facets() {
            let FaceId(face) = groups.face_of[facet.key()];
            this.faces[face as usize].normal += facet.area_vector();
        }
        for vertex in brep.vertices() {
            if !vertex.ring().any(|h| groups.is_crease(h)) {
                let FaceId(face) = groups.face_of[vertex.outgoing().facet().key()];
                this.faces[face as usize].excess -= 2;
            }
        }
        this.find_loops(brep, groups);
        let largest = (this.positions.iter()).fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        this.keep_only_flat_faces(brep, groups, FLATNESS * largest);
        for edge in &groups.edges {
            this.add_chain(brep, groups, edge, FLATNESS * largest);
        }
        this
    }

    fn find_loops(&mut self, brep: &Brep, groups: &Groups) {
        let mut done: SecondaryMap<HalfEdgeKey, ()> = SecondaryMap::new();
        let mut found: Vec<(usize, Range<usize>)> = Vec::new();
        for seed in brep.half_edges() {
            let face = groups.face_of[seed.facet().key()].0 as usize;
            let is_new = self.faces[face].is_candidate && !done.contains_key(seed.key());
            if !is_new || !groups.is_crease(seed) {
                continue;
            }
            let start = self.corners.len();
            let mut half_edge = seed;
            loop {
                done.insert(half_edge.key(), ());
                self.corners.push(self.numbers[half_edge.origin().key()]);
                half_edge = groups.continuation(half_edge);
                if half_edge.key() == seed.key() {
                    break;
                }
            }
            found.push((face, start..self.corners.len()));
        }
        // Stable, so loops of a face stay in mesh order.
        found.sort_by_key(|(face, _)| *face);
        for of_face in found.chunk_by(|a, b| a.0 == b.0) {
            let face = &mut self.faces[of_face[0].0];
            let start = self.loops.len();
            self.loops
                .extend(of_face.iter().map(|(_, corners)| corners.clone()));
            face.loops = start..self.loops.len();
            for (_, corners) in of_face {
                face.excess -= i64::try_from(corners.len()).unwrap_or(i64::MAX);
            }
        }
    }

    /// Facets of a flat face lie between two planes this close, perpendicular to its area vector.
    fn keep_only_flat_faces(&mut self, brep: &Brep, groups: &Groups, allowed: f64) {
        let normals = self
            .faces
            .iter()
            .map(|face| face.normal.normalize_or_zero());
        let normals: Vec<DVec3> = normals.collect();
        let mut heights = vec![(f64::INFINITY, f64::NEG_INFINITY); normals.len()];
        for facet in brep.facets() {
            let FaceId(face) = groups.face_of[facet.key()];
            let (low, high) = &mut heights[face as usize];
            for position in facet.positions() {
                let height = normals[face as usize].dot(position);
                (*low, *high) = (low.min(height), high.max(height));
            }
        }
        for ((face, (low, high)), normal) in self.faces.iter_mut().zip(heights).zip(normals) {
            face.is_candidate &= high - low <= allowed && normal != DVec3::ZERO;
        }
    }

    /// Two different planes meet in a line: the vertices inside the edge are not needed. Neither
    /// are those inside a straight border between two materials on one plane.
    fn add_chain(&mut self, brep: &Brep, groups: &Groups, edge: &Edge, allowed: f64) {
        let faces = edge.faces.map(|FaceId(face)| face as usize);
        let [left, right] = faces.map(|face| groups.faces[face]);
        // Faces of opposite senses on one plane lie on each other instead.
        let is_border = left.primitive != right.primitive || left.sense == right.sense;
        let is_planar = faces.iter().all(|&face| self.faces[face].is_candidate);
        let ends = edge.ends.filter(|[start, end]| start != end);
        let (true, true, Some(ends)) = (is_planar, is_border, ends) else {
            return;
        };
        let [start, end] = ends.map(|key| brep.vertex(key).position());
        let Some(direction) = (end - start).try_normalize() else {
            return;
        };
        let inner = || edge.chain[1..].iter().map(|&h| brep.half_edge(h).origin());
        let is_straight = inner().all(|vertex| {
            let along = vertex.position() - start;
            along.reject_from_normalized(direction).length() <= allowed
        });
        if edge.chain.len() < 2 || !is_straight {
            return;
        }
        // Chains are fewer than vertices, and those are counted with 32 bits.
        let chain = u32::try_from(self.chains.len()).unwrap_or(NONE);
        for vertex in inner() {
            self.chain_of[self.numbers[vertex.key()] as usize] = chain;
        }
        for face in faces {
            self.faces[face].chains.push(chain);
        }
        self.chains.push(Chain {
            faces,
            is_reduced: true,
        });
    }

    /// Whether a face is to be filled.
    pub(super) fn is_candidate(&self, face: usize) -> bool {
        self.faces[face].is_candidate
    }

    /// Leaves a face as it is.
    pub(super) fn give_up(&mut self, face: usize) {
        self.faces[face].is_candidate = false;
    }

    /// Puts all vertices back into the edges of a face; returns the faces across those that
    /// changed.
    pub(super) fn restore_edges(&mut self, face: usize) -> Vec<usize> {
        let mut neighbours = Vec::new();
        for &chain in &self.faces[face].chains {
            let chain = &mut self.chains[chain as usize];
            if chain.is_reduced {
                chain.is_reduced = false;
                neighbours.extend(chain.faces.into_iter().filter(|&other| other != face));
            }
        }
        neighbours
    }

    /// Triangles that fill the loops of a face, as far as they are reduced at present.
    pub(super) fn fill(&self, face: usize) -> Result<Vec<[u32; 3]>, Refusal> {
        let face = &self.faces[face];
        let mut outline = Outline::default();
        for corners in &self.loops[face.loops.clone()] {
            let corners = self.corners[corners.clone()].iter().copied();
            outline.add_loop(corners.filter(|&vertex| self.is_kept(vertex)))?;
        }
        let edges = i64::try_from(outline.len()).unwrap_or(i64::MAX);
        planar::fill(&outline, &self.positions, face.normal, face.excess + edges)
    }

    fn is_kept(&self, vertex: u32) -> bool {
        let chain = self.chain_of[vertex as usize];
        chain == NONE || !self.chains[chain as usize].is_reduced
    }
}
