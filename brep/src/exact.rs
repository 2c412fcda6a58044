//! The B-Rep as textbooks have it: solids, shells, faces, loops, half-edges, edges and vertices,
//! with the true geometry of each, and without the crumbs that touching surfaces leave.
//!
//! Half-edge h runs along edge h / 2: forward if h is even, so its twin is h ^ 1. The face of a
//! half-edge is to its left, seen from outside.

mod crumbs;
mod join;
mod rings;
mod touch;
mod zip;

use crate::curve::{Curves, Piece};
use crate::group::Groups;
use crate::shells::{ShellRole, Shells, Solid as Component};
use crate::topology::{Brep, FacetKey, VertexKey};
use crate::validate::Valid;
use csg::{MaterialId, PrimitiveId, Sense, Solid};
use glam::DVec3;
use slotmap::SecondaryMap;

/// A smooth edge between two faces.
#[derive(Clone, PartialEq, Debug)]
pub struct ExactEdge {
    /// Its curve.
    pub piece: Piece,
    /// The primitives whose surfaces hold the curve.
    pub primitives: Vec<PrimitiveId>,
    /// Start and end, indices of [`ExactBrep::vertices`]; `None` for a closed edge without a
    /// vertex.
    pub ends: Option<[usize; 2]>,
}

/// A face with its boundary.
#[derive(Clone, PartialEq, Debug)]
pub struct ExactFace {
    /// The primitive on which it lies.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
    /// Its loops, as their half-edges in order. The first one is the outer loop if the face is plane;
    /// on other surfaces no loop is more an outer one than the others.
    pub loops: Vec<Vec<usize>>,
    /// Handles of the face itself: 1 for a whole torus.
    pub genus: usize,
    /// Whether parts of it hang together by a point, where it has no width.
    pub is_pinched: bool,
    /// One of its facets in the mesh.
    pub facet: FacetKey,
}

/// A connected component of the boundary.
#[derive(Clone, PartialEq, Debug)]
pub struct ExactShell {
    /// Its faces, indices of [`ExactBrep::faces`].
    pub faces: Vec<usize>,
    /// Whether it bounds a solid from outside or a cavity.
    pub role: ShellRole,
    /// V − E + Σ (2 − 2 genus − loops) over its faces, closed edges not counted.
    pub euler: i64,
    /// Handles of the mesh's shell: `euler` is 2 − 2 genus.
    pub genus: u64,
}

/// What was merged away.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Crumbs {
    /// Edges between two vertices that are one point.
    pub edges: usize,
    /// Faces that had no other edges.
    pub faces: usize,
    /// Pairs of neighbouring edges of one face that are one curve: the face, or this end of it, has
    /// no width there.
    pub slivers: usize,
}

/// The B-Rep with true geometry.
#[derive(Clone, PartialEq, Debug)]
pub struct ExactBrep {
    /// Positions of vertices.
    pub vertices: Vec<DVec3>,
    /// Edges.
    pub edges: Vec<ExactEdge>,
    /// Faces.
    pub faces: Vec<ExactFace>,
    /// Shells, parallel to those of the mesh.
    pub shells: Vec<ExactShell>,
    /// Solids, by their shells.
    pub solids: Vec<Component>,
    /// What was merged away.
    pub crumbs: Crumbs,
    /// For each half-edge its face and loop.
    places: Vec<Option<(usize, usize)>>,
}

impl ExactBrep {
    /// Builds it from the mesh and what was found on it. Edges not longer than `tolerance`, in model
    /// units, are merged away if all surfaces at their ends meet in one point. Cost: linear.
    pub fn of(
        brep: &Valid<Brep>,
        groups: &Groups,
        shells: &Shells,
        curves: &Curves,
        solid: &Solid,
        tolerance: f64,
    ) -> Self {
        let mut raw = Raw::of(brep, groups, curves);
        let crumbs = raw.merge_crumbs(solid, tolerance);
        raw.finish(brep, groups, shells, solid, crumbs)
    }

    /// The half-edge that follows in the same loop; `None` for one that merging removed.
    pub fn next(&self, half_edge: usize) -> Option<usize> {
        let (face, ring) = (*self.places.get(half_edge)?)?;
        let ring = &self.faces[face].loops[ring];
        let at = ring.iter().position(|&other| other == half_edge)?;
        Some(ring[(at + 1) % ring.len()])
    }

    /// The same edge in the other direction.
    pub fn twin(half_edge: usize) -> usize {
        half_edge ^ 1
    }

    /// The face to the left of a half-edge.
    pub fn face_of(&self, half_edge: usize) -> Option<usize> {
        Some((*self.places.get(half_edge)?)?.0)
    }

    /// Start vertex of a half-edge; `None` on closed edges without a vertex.
    pub fn origin(&self, half_edge: usize) -> Option<usize> {
        let ends = self.edges.get(half_edge / 2)?.ends?;
        Some(ends[half_edge % 2])
    }

    /// Whether a face touches itself along an edge: there its boundary runs back on itself, and
    /// it has no width, or the solid touches itself. `near` is a distance that counts as none.
    pub fn is_folded(&self, face: &ExactFace, near: f64) -> bool {
        let mut edges: Vec<usize> = face.loops.iter().flatten().map(|h| h / 2).collect();
        edges.sort_unstable();
        if edges.windows(2).any(|pair| pair[0] == pair[1]) {
            return true;
        }
        let mut all: Vec<(csg::Aabb, &Piece)> = edges
            .iter()
            .map(|&edge| {
                let piece = &self.edges[edge].piece;
                (piece.bounds(), piece)
            })
            .collect();
        all.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x));
        all.iter().enumerate().any(|(at, (bounds, piece))| {
            let after = all[at + 1..].iter();
            after
                .take_while(|(others, _)| others.min.x <= bounds.max.x + near)
                .any(|(_, other)| {
                    piece.overlap(other, near) > near
                        || piece.overlap(&other.reversed(), near) > near
                })
        })
    }

    /// Shells for which the Euler–Poincaré formula does not hold: merging changed more than
    /// crumbs there.
    pub fn broken_shells(&self) -> Vec<usize> {
        let is_broken = |shell: &ExactShell| {
            i64::try_from(shell.genus).map_or(true, |genus| shell.euler != 2 - 2 * genus)
        };
        let shells = self.shells.iter().enumerate();
        shells
            .filter(|(_, shell)| is_broken(shell))
            .map(|(at, _)| at)
            .collect()
    }
}

/// The elements while they are being merged: indices stay, `alive` says what is left.
struct Raw {
    vertices: Vec<DVec3>,
    /// The primitives that meet in each vertex.
    meeting: Vec<Vec<PrimitiveId>>,
    edges: Vec<ExactEdge>,
    edge_alive: Vec<bool>,
    /// Following half-edge in the same loop.
    next: Vec<usize>,
    /// Preceding half-edge in the same loop.
    prev: Vec<usize>,
    /// Face to the left of each half-edge.
    face: Vec<usize>,
    face_alive: Vec<bool>,
    /// Loops of each face.
    loop_count: Vec<usize>,
    /// Largest extent of each face.
    face_size: Vec<f64>,
    /// The face of the mesh of which each one is a part.
    origin: Vec<usize>,
    /// The surface of each face, and where the solid is.
    surface_of: Vec<(PrimitiveId, Sense)>,
}

impl Raw {
    fn of(brep: &Valid<Brep>, groups: &Groups, curves: &Curves) -> Self {
        let mut this = Self {
            vertices: Vec::new(),
            meeting: Vec::new(),
            edges: Vec::new(),
            edge_alive: Vec::new(),
            next: Vec::new(),
            prev: Vec::new(),
            face: Vec::new(),
            loop_count: vec![0; groups.faces.len()],
            face_alive: vec![true; groups.faces.len()],
            face_size: face_sizes(brep, groups),
            origin: (0..groups.faces.len()).collect(),
            surface_of: groups
                .faces
                .iter()
                .map(|face| (face.primitive, face.sense))
                .collect(),
        };
        let mut vertex_of: SecondaryMap<VertexKey, usize> = SecondaryMap::new();
        for &key in &groups.vertices {
            let ring = brep.vertex(key).ring();
            let primitives = ring.map(|h| h.facet().primitive()).collect();
            vertex_of.insert(key, this.vertex(curves.vertices[key], primitives));
        }
        // The first and last edge of each chain, to link loops.
        let mut starts = SecondaryMap::new();
        let mut spans = Vec::new();
        for (edge, curve) in groups.edges.iter().zip(&curves.edges) {
            let first = this.edges.len();
            let count = curve.pieces.len();
            let joints: Vec<usize> = curve.pieces[1..]
                .iter()
                .map(|piece| this.vertex(piece.ends[0], curve.primitives.clone()))
                .collect();
            let closing = match edge.ends {
                Some(ends) => Some(ends.map(|key| vertex_of[key])),
                None if count > 1 => {
                    let start = this.vertex(curve.pieces[0].ends[0], curve.primitives.clone());
                    Some([start, start])
                }
                None => None,
            };
            for (at, piece) in curve.pieces.iter().enumerate() {
                let ends = closing.map(|[start, end]| {
                    let from = if at == 0 { start } else { joints[at - 1] };
                    let to = joints.get(at).copied().unwrap_or(end);
                    [from, to]
                });
                this.edges.push(ExactEdge {
                    piece: piece.clone(),
                    primitives: curve.primitives.clone(),
                    ends,
                });
                let [left, right] = edge.faces.map(|face| face.0 as usize);
                this.face.extend([left, right]);
                this.next.extend([0, 0]);
            }
            let last = first + count - 1;
            let chain = (edge.chain[0], edge.chain[edge.chain.len() - 1]);
            starts.insert(chain.0, 2 * first);
            starts.insert(brep.half_edge(chain.1).twin().key(), 2 * last + 1);
            spans.push((first, last, chain));
        }
        for (first, last, chain) in spans {
            for edge in first..last {
                this.next[2 * edge] = 2 * edge + 2;
                this.next[2 * edge + 3] = 2 * edge + 1;
            }
            let is_closed = this.edges[first].ends.is_none()
                || !vertex_of.contains_key(brep.half_edge(chain.0).origin().key());
            if is_closed {
                this.next[2 * last] = 2 * first;
                this.next[2 * first + 1] = 2 * last + 1;
            } else {
                let follow = |key| {
                    let following = groups.continuation(brep.half_edge(key));
                    starts.get(following.key()).copied()
                };
                let back = brep.half_edge(chain.0).twin().key();
                this.next[2 * last] = follow(chain.1).unwrap_or(2 * last);
                this.next[2 * first + 1] = follow(back).unwrap_or(2 * first + 1);
            }
        }
        this.edge_alive = vec![true; this.edges.len()];
        this
    }

    fn vertex(&mut self, position: DVec3, mut primitives: Vec<PrimitiveId>) -> usize {
        primitives.sort_unstable();
        primitives.dedup();
        self.vertices.push(position);
        self.meeting.push(primitives);
        self.vertices.len() - 1
    }
}

/// Largest extents of all faces, in model units.
fn face_sizes(brep: &Brep, groups: &Groups) -> Vec<f64> {
    let mut boxes = vec![csg::Aabb::EMPTY; groups.faces.len()];
    for facet in brep.facets() {
        let bounds = &mut boxes[groups.face_of[facet.key()].0 as usize];
        for position in facet.positions() {
            bounds.min = bounds.min.min(position);
            bounds.max = bounds.max.max(position);
        }
    }
    boxes
        .iter()
        .map(|bounds| (bounds.max - bounds.min).length())
        .collect()
}

#[cfg(test)]
mod tests;
