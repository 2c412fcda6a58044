//! From facets to the B-Rep: faces, the edges between them, and the vertices where edges end.

use crate::topology::{Brep, FacetKey, HalfEdgeKey, HalfEdgeView, VertexKey, VertexView};
use crate::validate::Valid;
use csg::{MaterialId, PrimitiveId, Sense};
use slotmap::SecondaryMap;

/// Index of a face in [`Groups::faces`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct FaceId(pub u32);

/// A maximal connected set of facets on one primitive, with one sense and one material.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Face {
    /// The primitive on which it lies.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
    /// Its first facet.
    pub facet: FacetKey,
    /// How many facets it has.
    pub facet_count: usize,
}

/// A maximal chain of mesh edges between the same two faces.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Edge {
    /// Its half-edges in order, all with the first face to the left.
    pub chain: Vec<HalfEdgeKey>,
    /// The faces to the left and to the right of the chain, seen from outside.
    pub faces: [FaceId; 2],
    /// Start and end vertex (equal for a loop through one vertex), or `None` for a closed chain
    /// that meets no third face.
    pub ends: Option<[VertexKey; 2]>,
}

/// The B-Rep elements above the facets.
#[derive(Clone, Debug)]
pub struct Groups {
    /// Faces in the order of their first facets.
    pub faces: Vec<Face>,
    /// Edges: first those with ends, by their first vertex, then the closed ones.
    pub edges: Vec<Edge>,
    /// Vertices where three or more creases meet, in mesh order.
    pub vertices: Vec<VertexKey>,
    /// The face of each facet.
    pub face_of: SecondaryMap<FacetKey, FaceId>,
}

impl Groups {
    /// Groups the facets of a boundary. Cost: linear.
    pub fn of(brep: &Valid<Brep>) -> Self {
        let (faces, face_of) = find_faces(brep);
        let mut groups = Self {
            faces,
            edges: Vec::new(),
            vertices: Vec::new(),
            face_of,
        };
        groups.find_vertices(brep);
        groups.find_edges(brep);
        groups
    }

    /// Whether different faces lie on both sides of a half-edge.
    pub fn is_crease(&self, half_edge: HalfEdgeView<'_>) -> bool {
        self.faces_beside(half_edge)
            .is_some_and(|[left, right]| left != right)
    }

    fn faces_beside(&self, half_edge: HalfEdgeView<'_>) -> Option<[FaceId; 2]> {
        let left = self.face_of.get(half_edge.facet().key())?;
        let right = self.face_of.get(half_edge.twin().facet().key())?;
        Some([*left, *right])
    }

    /// Two creases at a vertex separate the same two faces and continue each other; one alone is
    /// impossible; at three or more, edges end.
    fn find_vertices(&mut self, brep: &Brep) {
        self.vertices = brep
            .vertices()
            .filter(|vertex| {
                vertex
                    .ring()
                    .filter(|&h| self.is_crease(h))
                    .nth(2)
                    .is_some()
            })
            .map(VertexView::key)
            .collect();
    }

    fn find_edges(&mut self, brep: &Brep) {
        let mut is_end: SecondaryMap<VertexKey, ()> = SecondaryMap::new();
        for &vertex in &self.vertices {
            is_end.insert(vertex, ());
        }
        let mut done: SecondaryMap<HalfEdgeKey, ()> = SecondaryMap::new();
        let from_vertices = self
            .vertices
            .iter()
            .flat_map(|&vertex| brep.vertex(vertex).ring());
        let mut edges = Vec::new();
        for seed in from_vertices.chain(brep.half_edges()) {
            let Some(faces) = self
                .faces_beside(seed)
                .filter(|[left, right]| left != right)
            else {
                continue;
            };
            if done.contains_key(seed.key()) {
                continue;
            }
            let mut chain = Vec::new();
            let mut half_edge = seed;
            let ends = loop {
                chain.push(half_edge.key());
                done.insert(half_edge.key(), ());
                done.insert(half_edge.twin().key(), ());
                let target = half_edge.target().key();
                if is_end.contains_key(target) {
                    break Some([seed.origin().key(), target]);
                }
                half_edge = self.continuation(half_edge);
                if half_edge.key() == seed.key() {
                    break None;
                }
            };
            edges.push(Edge { chain, faces, ends });
        }
        self.edges = edges;
    }

    /// The crease that leaves the target of `crease` with the same face to the left.
    pub(crate) fn continuation<'a>(&self, crease: HalfEdgeView<'a>) -> HalfEdgeView<'a> {
        // Clockwise around the target, through the facets of the left face.
        let mut half_edge = crease.next();
        while !self.is_crease(half_edge) {
            half_edge = half_edge.twin().next();
        }
        half_edge
    }
}

fn find_faces(brep: &Brep) -> (Vec<Face>, SecondaryMap<FacetKey, FaceId>) {
    let mut face_of = SecondaryMap::with_capacity(brep.facets.capacity());
    let mut faces: Vec<Face> = Vec::new();
    let mut stack = Vec::new();
    for (seed, facet) in &brep.facets {
        if face_of.contains_key(seed) {
            continue;
        }
        let label = (facet.primitive, facet.sense, facet.material);
        // Facets, hence faces, are fewer than 2^32: slotmap keys have 32-bit indices.
        let id = FaceId(u32::try_from(faces.len()).unwrap_or(u32::MAX));
        let mut facet_count = 0;
        face_of.insert(seed, id);
        stack.push(seed);
        while let Some(key) = stack.pop() {
            facet_count += 1;
            for neighbour in brep.facet(key).neighbours() {
                let same = (
                    neighbour.primitive(),
                    neighbour.sense(),
                    neighbour.material(),
                ) == label;
                if same && !face_of.contains_key(neighbour.key()) {
                    face_of.insert(neighbour.key(), id);
                    stack.push(neighbour.key());
                }
            }
        }
        faces.push(Face {
            primitive: facet.primitive,
            sense: facet.sense,
            material: facet.material,
            facet: seed,
            facet_count,
        });
    }
    (faces, face_of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, painted, sphere, together, torus};
    use crate::stitch;
    use subdiv::Fragments;

    fn group(fragments: &Fragments) -> (Valid<Brep>, Groups) {
        let brep = stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let groups = Groups::of(&brep);
        (brep, groups)
    }

    #[test]
    fn a_cube_has_six_faces_twelve_edges_eight_vertices() {
        let (brep, groups) = group(&cube([0.0; 3], 1.0));
        assert_eq!(
            (
                groups.faces.len(),
                groups.edges.len(),
                groups.vertices.len()
            ),
            (6, 12, 8)
        );
        assert!(groups.faces.iter().all(|face| face.facet_count == 2));
        for edge in &groups.edges {
            assert_eq!(edge.chain.len(), 1);
            let half_edge = brep.half_edge(edge.chain[0]);
            let ends = [half_edge.origin().key(), half_edge.target().key()];
            assert_eq!(edge.ends, Some(ends));
            let beside = [half_edge, half_edge.twin()].map(|h| groups.face_of[h.facet().key()]);
            assert_eq!(edge.faces, beside);
        }
    }

    #[test]
    fn a_closed_surface_on_one_primitive_has_one_face_only() {
        let (_, groups) = group(&together(&[sphere(2), torus(5.0, 1.0, 8, 6)]));
        assert_eq!(
            (
                groups.faces.len(),
                groups.edges.len(),
                groups.vertices.len()
            ),
            (2, 0, 0)
        );
    }

    #[test]
    fn two_hemispheres_meet_in_one_closed_edge() {
        let mut fragments = sphere(3);
        for triangle in &mut fragments.triangles {
            let z: f64 = triangle
                .vertices
                .iter()
                .map(|&v| fragments.positions[v as usize].z)
                .sum();
            triangle.primitive = PrimitiveId(u32::from(z > 0.0));
        }
        let (brep, groups) = group(&fragments);
        assert_eq!(
            (
                groups.faces.len(),
                groups.edges.len(),
                groups.vertices.len()
            ),
            (2, 1, 0)
        );
        let edge = &groups.edges[0];
        // The equator: four quarters of 2³ edges, each joined to the next.
        assert_eq!((edge.chain.len(), edge.ends), (32, None));
        for (at, &key) in edge.chain.iter().enumerate() {
            let next = edge.chain[(at + 1) % edge.chain.len()];
            assert_eq!(
                brep.half_edge(key).target().key(),
                brep.half_edge(next).origin().key()
            );
            assert_eq!(
                groups.face_of[brep.half_edge(key).facet().key()],
                edge.faces[0]
            );
        }
    }

    #[test]
    fn octants_meet_in_six_vertices() {
        let mut fragments = sphere(3);
        let octants = fragments.triangles.len() / 8;
        for (at, triangle) in fragments.triangles.iter_mut().enumerate() {
            triangle.material = MaterialId(u32::try_from(at / octants).expect("small"));
        }
        let (brep, groups) = group(&fragments);
        assert_eq!(
            (
                groups.faces.len(),
                groups.edges.len(),
                groups.vertices.len()
            ),
            (8, 12, 6)
        );
        assert!(groups.edges.iter().all(|edge| edge.chain.len() == 8));
        let creases = brep.half_edges().filter(|&h| groups.is_crease(h)).count();
        assert_eq!(creases, 2 * 12 * 8);
    }

    #[test]
    fn a_sense_or_material_makes_a_face_of_its_own() {
        let (_, same) = group(&painted(sphere(1), 3, 4));
        assert_eq!(same.faces.len(), 1);
        assert_eq!(
            (same.faces[0].primitive, same.faces[0].material),
            (PrimitiveId(3), MaterialId(4))
        );
        let mut fragments = sphere(1);
        fragments.triangles[0].sense = Sense::Outside;
        assert_eq!(group(&fragments).1.faces.len(), 2);
    }
}
