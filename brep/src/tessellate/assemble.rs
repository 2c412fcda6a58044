//! The facets of all faces together, if there is nothing wrong with them.

use super::patchwork::Role;
use super::sheet::Sheet;
use super::{Run, crossings, measure};
use crate::triangulate::fill_loops;
use glam::DVec3;
use subdiv::{Fragments, Triangle, VertexKind};

/// What the tolerance of a face is multiplied by when its facets pass through others, or stand
/// across it.
const FINER: f64 = 0.25;

/// What it is multiplied by when facets are too far off after they were moved.
const A_LITTLE_FINER: f64 = 0.75;

/// Something that did not come out well.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trouble {
    pub(super) face: usize,
    /// The facet; `None` if a planar face cannot be filled from its loops.
    pub(super) corners: Option<[u32; 3]>,
    /// The side of it that should be split, if that is known: from the first to the second.
    pub(super) side: Option<[u32; 2]>,
    /// What the tolerance of the face should be multiplied by.
    finer: f64,
}

/// The faces in trouble, each with what its tolerance should be multiplied by.
pub(super) fn finer_faces(troubles: &[Trouble]) -> Vec<(usize, f64)> {
    let mut faces: Vec<(usize, f64)> = troubles.iter().map(|t| (t.face, t.finer)).collect();
    // Of several reasons in one face the graver one counts.
    faces.sort_by(|(f, x), (g, y)| f.cmp(g).then(x.total_cmp(y)));
    faces.dedup_by_key(|(face, _)| *face);
    faces
}

/// All facets, and to which face each belongs.
pub(super) struct Facets {
    pub(super) fragments: Fragments,
    face_of: Vec<usize>,
}

impl Run<'_> {
    /// The boundary as triangles within `tolerance` of the surfaces, none of them through another,
    /// or what did not come out well.
    pub(super) fn facets(&self, tolerance: f64) -> Result<Facets, Vec<Trouble>> {
        let mut troubles = self.bad_facets(tolerance);
        let mut of_face: Vec<Vec<[u32; 3]>> = vec![Vec::new(); self.sheets.len()];
        for facet in self.mesh.facets() {
            if !self.is_planar(3 * facet) {
                of_face[self.face_of(3 * facet)].push(self.mesh.corners(facet));
            }
        }
        for (face, loops) in self.planar_loops().iter().enumerate() {
            let Sheet::Plane { normal, .. } = *self.sheets[face] else {
                continue;
            };
            if self.kept[face] {
                continue;
            }
            let outward = normal * self.plane_sense(loops, normal);
            match fill_loops(loops, &self.mesh.positions, outward) {
                Ok(triangles) => of_face[face] = triangles,
                Err(_) => troubles.push(Trouble {
                    face,
                    corners: None,
                    side: None,
                    finer: FINER,
                }),
            }
        }
        if troubles.is_empty() {
            troubles = self.crossing_facets(&of_face);
        }
        if !troubles.is_empty() {
            return Err(troubles);
        }
        let (mut triangles, mut face_of) = (Vec::new(), Vec::new());
        for (at, (face, corners)) in self.groups.faces.iter().zip(of_face).enumerate() {
            face_of.extend(std::iter::repeat_n(at, corners.len()));
            triangles.extend(corners.into_iter().map(|vertices| Triangle {
                vertices,
                primitive: face.primitive,
                sense: face.sense,
                material: face.material,
            }));
        }
        let fragments = Fragments {
            kinds: vec![VertexKind::Interior; self.mesh.positions.len()],
            positions: self.mesh.positions.clone(),
            triangles,
        };
        Ok(Facets { fragments, face_of })
    }

    /// Facets that deviate too much, or stand across their surface.
    fn bad_facets(&self, tolerance: f64) -> Vec<Trouble> {
        let mut bad = Vec::new();
        for facet in self.mesh.facets() {
            if self.kept[self.face_of(3 * facet)] {
                continue;
            }
            let shape = self.shape_of(3 * facet);
            let finer = if shape.error > 1.0 + 1e-9 || shape.lean > measure::UPRIGHT {
                FINER
            } else if self.deviation(facet) > tolerance * (1.0 + 1e-9) {
                A_LITTLE_FINER
            } else {
                continue;
            };
            bad.push(Trouble {
                face: self.face_of(3 * facet),
                corners: Some(self.mesh.corners(facet)),
                side: None,
                finer,
            });
        }
        bad
    }

    /// Facets with a side that two others have, too: a chord across one face may be one across
    /// its neighbour. Those in curved faces if there are
    /// any, since they can be split.
    pub(super) fn doubled(&self, facets: &Facets) -> Vec<Trouble> {
        let sides_of = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]];
        let triangles = &facets.fragments.triangles;
        let mut sides: Vec<[u32; 2]> = (triangles.iter())
            .flat_map(|triangle| sides_of(triangle.vertices))
            .collect();
        sides.sort_unstable();
        let twice = sides.windows(2).filter(|pair| pair[0] == pair[1]);
        let double: Vec<[u32; 2]> = twice.map(|pair| pair[0]).collect();
        let is_double = |side: [u32; 2]| double.binary_search(&side).is_ok();
        let mut troubles = Vec::new();
        for facet in self.mesh.facets() {
            for h in 3 * facet..3 * facet + 3 {
                let side = [self.mesh.origin[h as usize], self.mesh.target(h)];
                if self.is_inner(h) && is_double(side) {
                    troubles.push(Trouble {
                        face: self.face_of(h),
                        corners: Some(self.mesh.corners(facet)),
                        side: Some(side),
                        finer: FINER,
                    });
                }
            }
        }
        if troubles.is_empty() {
            let of_triangles = triangles.iter().zip(&facets.face_of);
            troubles = of_triangles
                .filter(|(_, face)| !self.kept[**face])
                .filter(|(triangle, _)| sides_of(triangle.vertices).into_iter().any(is_double))
                .map(|(_, &face)| Trouble {
                    face,
                    corners: None,
                    side: None,
                    finer: FINER,
                })
                .collect();
        }
        troubles
    }

    /// Facets that pass through others.
    fn crossing_facets(&self, of_face: &[Vec<[u32; 3]>]) -> Vec<Trouble> {
        let triangles: Vec<[u32; 3]> = of_face.iter().flatten().copied().collect();
        let faces: Vec<usize> = of_face
            .iter()
            .enumerate()
            .flat_map(|(face, triangles)| std::iter::repeat_n(face, triangles.len()))
            .collect();
        let pairs = crossings::crossings(&self.mesh.positions, &triangles);
        let mut crossing: Vec<usize> = pairs.into_flattened();
        crossing.sort_unstable();
        crossing.dedup();
        let trouble = |triangle: usize| Trouble {
            face: faces[triangle],
            corners: Some(triangles[triangle]),
            side: None,
            finer: FINER,
        };
        // A pair of kept ones is one in the subdivision, too: below what is called a crossing there.
        (crossing.into_iter().map(trouble))
            .filter(|trouble| !self.kept[trouble.face])
            .collect()
    }

    /// By face: the loops of planar ones, each with the face to its left.
    fn planar_loops(&self) -> Vec<Vec<Vec<u32>>> {
        let mut loops: Vec<Vec<Vec<u32>>> = vec![Vec::new(); self.sheets.len()];
        for (phantom, &role) in (0_u32..).zip(&self.mesh.roles) {
            if role != Role::Phantom {
                continue;
            }
            let first = self.mesh.outgoing[phantom as usize];
            // The ring is counter-clockwise around the phantom, as the loop is around the face.
            let around = self.mesh.ring(first).map(|spoke| self.mesh.target(spoke));
            loops[self.face_of(first)].push(around.collect());
        }
        loops
    }

    /// 1 if loops with the face to their left run counter-clockwise around `normal`, else −1.
    fn plane_sense(&self, loops: &[Vec<u32>], normal: DVec3) -> f64 {
        let mut area = DVec3::ZERO;
        for corners in loops {
            let first = self.mesh.position(corners[0]);
            for pair in corners.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|v| self.mesh.position(v) - first);
                area += a.cross(b);
            }
        }
        if area.dot(normal) < 0.0 { -1.0 } else { 1.0 }
    }
}
