//! Planar faces triangulated from their loops alone.
//!
//! A subdivision cuts planes like any surface, into as many facets as it has leaves. What bounds
//! a planar face says all about it: this stage forgets the facets inside, drops vertices from
//! straight edges between planes, and fills the loops again. Curved faces stay as they are.

mod outline;
mod planar;

use crate::group::{FaceId, Groups};
use crate::stitch::stitch;
use crate::topology::Brep;
use crate::validate::Valid;
use csg::PrimitiveId;
use glam::DVec3;
use outline::Outlines;
use planar::{Outline, Refusal};
use subdiv::{Fragments, Triangle, VertexKind};

/// What [`retriangulate`] did.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Retriangulated {
    /// Planar faces that were triangulated from their loops.
    pub faces: usize,
    /// Planar faces that kept their facets: they are not as flat as rounding makes them, their
    /// loops touch or cross each other when projected, or the result would not be a manifold.
    pub kept: usize,
    /// Number of facets before.
    pub facets_before: usize,
    /// Number of facets after.
    pub facets_after: usize,
}

/// Triangulates all planar faces from their loops, by constrained Delaunay triangulation.
///
/// No vertex is added or moved. Vertices inside planar faces disappear, and so do those in the
/// middle of an edge between two planes, or of a border between two materials on one plane, where
/// that edge is straight but for rounding. Materials keep their borders. Faces,
/// edges, vertices, shells and genus stay what they are, volume and area up to rounding. Facets
/// are ordered by face, in the order of [`Groups::faces`]. `is_plane` says of a primitive whether
/// its polynomial has degree 1.
///
/// Cost: O(n log n) for n boundary vertices of planar faces, plus linear time for the rest.
///
/// ```
/// # let stitched = brep::stitch(&subdiv::Fragments::default())?.validate()?;
/// let (boundary, counts) = brep::retriangulate(stitched, |_primitive| true);
/// assert_eq!(counts.facets_after, boundary.facet_count());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn retriangulate(
    brep: Valid<Brep>,
    is_plane: impl Fn(PrimitiveId) -> bool,
) -> (Valid<Brep>, Retriangulated) {
    let groups = Groups::of(&brep);
    let planar = groups
        .faces
        .iter()
        .filter(|f| is_plane(f.primitive))
        .count();
    let mut counts = Retriangulated {
        faces: 0,
        kept: planar,
        facets_before: brep.facet_count(),
        facets_after: brep.facet_count(),
    };
    let mut attempt = Attempt::new(&brep, &groups, &is_plane);
    attempt.fill(0..groups.faces.len());
    loop {
        if !attempt.has_changes() {
            return (brep, counts);
        }
        let fragments = attempt.fragments();
        let result = stitch(&fragments).ok().and_then(|b| b.validate().ok());
        if let Some(result) = result {
            counts.faces = attempt.filled.iter().flatten().count();
            counts.kept = planar - counts.faces;
            counts.facets_after = result.facet_count();
            return (result, counts);
        }
        // Edges that others already use: where surfaces touch, a chord can have a double.
        let doubled = attempt.faces_with_doubled_edges(&fragments);
        if doubled.is_empty() {
            return (brep, counts);
        }
        let dirty = attempt.retreat(&doubled);
        attempt.fill(dirty);
    }
}

/// Triangles that fill loops of vertices, each with the face to its left seen from where `normal`
/// points; the loops bound a connected region of a plane.
pub(crate) fn fill_loops(
    loops: &[Vec<u32>],
    positions: &[DVec3],
    normal: DVec3,
) -> Result<Vec<[u32; 3]>, Refusal> {
    let mut outline = Outline::default();
    for corners in loops {
        outline.add_loop(corners.iter().copied())?;
    }
    // Euler: as many triangles as corners, two more for each loop but the first two.
    let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
    let expected = count(outline.len()) + 2 * count(loops.len()) - 4;
    planar::fill(&outline, positions, normal, expected)
}

/// Faces filled so far. Each retreat makes less of it, so there are only finitely many.
struct Attempt<'a> {
    brep: &'a Valid<Brep>,
    groups: &'a Groups,
    outlines: Outlines,
    /// For each face its new triangles, by vertex number.
    filled: Vec<Option<Vec<[u32; 3]>>>,
    /// The facets of each face that has not been filled.
    facets: FacetsByFace,
}

impl<'a> Attempt<'a> {
    fn new(
        brep: &'a Valid<Brep>,
        groups: &'a Groups,
        is_plane: &impl Fn(PrimitiveId) -> bool,
    ) -> Self {
        Self {
            brep,
            groups,
            outlines: Outlines::of(brep, groups, is_plane),
            filled: vec![None; groups.faces.len()],
            facets: FacetsByFace::of(brep, groups),
        }
    }

    fn has_changes(&self) -> bool {
        self.filled.iter().any(Option::is_some)
    }

    /// Fills these faces, and those that have to follow since a neighbour could not be filled.
    fn fill(&mut self, faces: impl IntoIterator<Item = usize>) {
        let mut dirty: Vec<usize> = faces.into_iter().collect();
        while !dirty.is_empty() {
            let mut failed = Vec::new();
            for &face in &dirty {
                if !self.outlines.is_candidate(face) {
                    continue;
                }
                self.filled[face] = self.outlines.fill(face).ok();
                if self.filled[face].is_none() {
                    failed.push(face);
                }
            }
            dirty = self.retreat(&failed);
        }
    }

    /// Gives the edges of these faces their vertices back, or, where they have all of them, the
    /// faces their facets. Returns the faces to be filled again.
    fn retreat(&mut self, failed: &[usize]) -> Vec<usize> {
        let mut dirty = Vec::new();
        for &face in failed {
            let neighbours = self.outlines.restore_edges(face);
            if neighbours.is_empty() {
                // Possibly restored by a neighbour in this very round: then it has its own turn.
                if dirty.contains(&face) {
                    continue;
                }
                self.outlines.give_up(face);
                self.filled[face] = None;
            } else {
                dirty.push(face);
                dirty.extend(neighbours);
            }
        }
        dirty.sort_unstable();
        dirty.dedup();
        dirty
    }

    /// The mesh with filled faces, ordered by face.
    fn fragments(&self) -> Fragments {
        let numbers = &self.outlines.numbers;
        let positions = self.outlines.positions.clone();
        let mut triangles = Vec::new();
        for (at, face) in self.groups.faces.iter().enumerate() {
            let triangle = |vertices| Triangle {
                vertices,
                primitive: face.primitive,
                sense: face.sense,
                material: face.material,
            };
            match &self.filled[at] {
                Some(filled) => triangles.extend(filled.iter().copied().map(triangle)),
                None => triangles.extend(self.facets.of_face(at).iter().map(|&facet| {
                    let vertices = self.brep.facet(facet).vertices();
                    triangle(vertices.map(|vertex| numbers[vertex.key()]))
                })),
            }
        }
        Fragments {
            kinds: vec![VertexKind::Interior; positions.len()],
            positions,
            triangles,
        }
    }

    /// The filled faces with an edge that the whole mesh has more than twice.
    fn faces_with_doubled_edges(&self, fragments: &Fragments) -> Vec<usize> {
        let faces = self.filled.iter().enumerate().flat_map(|(at, filled)| {
            let facets = self.facets.of_face(at).len();
            std::iter::repeat_n(at, filled.as_ref().map_or(facets, Vec::len))
        });
        let mut edges: Vec<([u32; 2], usize)> = faces
            .zip(&fragments.triangles)
            .flat_map(|(face, triangle)| {
                let [a, b, c] = triangle.vertices;
                [[a, b], [b, c], [c, a]].map(|[u, v]| ([u.min(v), u.max(v)], face))
            })
            .collect();
        edges.sort_unstable();
        let mut faces: Vec<usize> = edges
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|uses| uses.len() > 2)
            .flat_map(|uses| uses.iter().map(|&(_, face)| face))
            .filter(|&face| self.filled[face].is_some())
            .collect();
        faces.sort_unstable();
        faces.dedup();
        faces
    }
}

/// The facets of each face, in mesh order.
struct FacetsByFace {
    facets: Vec<crate::FacetKey>,
    starts: Vec<usize>,
}

impl FacetsByFace {
    fn of(brep: &Brep, groups: &Groups) -> Self {
        let mut starts = Vec::with_capacity(groups.faces.len() + 1);
        let mut sum = 0;
        for face in &groups.faces {
            starts.push(sum);
            sum += face.facet_count;
        }
        starts.push(sum);
        let mut facets = vec![crate::FacetKey::default(); sum];
        let mut next = starts.clone();
        for facet in brep.facets() {
            let FaceId(face) = groups.face_of[facet.key()];
            let at = &mut next[face as usize];
            facets[*at] = facet.key();
            *at += 1;
        }
        Self { facets, starts }
    }

    fn of_face(&self, face: usize) -> &[crate::FacetKey] {
        &self.facets[self.starts[face]..self.starts[face + 1]]
    }
}

#[cfg(test)]
mod tests;
