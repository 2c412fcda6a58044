//! Loops of faces, genus of faces, Euler's characteristic of shells.

use super::zip::COINCIDENT;
use super::{Crumbs, ExactBrep, ExactFace, ExactShell, Raw};
use crate::group::Groups;
use crate::shells::Shells;
use crate::topology::Brep;
use crate::validate::Valid;
use csg::{PrimitiveId, Sense, Solid, Surface};
use glam::DVec3;

impl Raw {
    /// Collects what is left.
    pub(super) fn finish(
        self,
        brep: &Valid<Brep>,
        groups: &Groups,
        shells: &Shells,
        solid: &Solid,
        crumbs: Crumbs,
    ) -> ExactBrep {
        let genera = face_genera(brep, groups);
        let rings = self.rings();
        let necks = self.necks(solid, COINCIDENT * solid.extent.diagonal());
        let mut faces = Vec::new();
        let mut shell_faces = vec![Vec::new(); shells.shells.len()];
        let mut new_number = vec![None; self.face_alive.len()];
        for (at, &origin) in self.origin.iter().enumerate() {
            if !self.face_alive[at] {
                continue;
            }
            let face = &groups.faces[origin];
            new_number[at] = Some(faces.len());
            shell_faces[shells.shell_of[face.facet].0 as usize].push(faces.len());
            faces.push(ExactFace {
                primitive: face.primitive,
                sense: face.sense,
                material: face.material,
                loops: Vec::new(),
                is_pinched: necks[at],
                genus: genera[origin],
                facet: face.facet,
            });
        }
        for ring in rings {
            if let Some(face) = new_number[self.face[ring[0]]] {
                faces[face].loops.push(ring);
            }
        }
        for face in &mut faces {
            self.put_outer_loop_first(face, solid);
        }
        let mut places = vec![None; self.next.len()];
        for (at, face) in faces.iter().enumerate() {
            for (number, ring) in face.loops.iter().enumerate() {
                for &half_edge in ring {
                    places[half_edge] = Some((at, number));
                }
            }
        }
        let exact_shells = shell_faces
            .into_iter()
            .zip(&shells.shells)
            .map(|(list, shell)| ExactShell {
                euler: self.euler(&faces, &list),
                faces: list,
                role: shell.role,
                genus: shell.genus,
            })
            .collect();
        ExactBrep {
            vertices: self.vertices,
            edges: self.edges,
            faces,
            shells: exact_shells,
            solids: shells.solids.clone(),
            crumbs,
            places,
        }
    }

    pub(super) fn rings(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.next.len()];
        let mut rings = Vec::new();
        for start in 0..self.next.len() {
            if !self.edge_alive[start / 2] {
                continue;
            }
            let mut ring = Vec::new();
            let mut half_edge = start;
            while !seen[half_edge] {
                seen[half_edge] = true;
                ring.push(half_edge);
                half_edge = self.next[half_edge];
            }
            if !ring.is_empty() {
                rings.push(ring);
            }
        }
        rings
    }

    /// A plane's loops all run around its normal, the outer one to the left and with the largest area.
    fn put_outer_loop_first(&self, face: &mut ExactFace, solid: &Solid) {
        let PrimitiveId(at) = face.primitive;
        let Some(primitive) = solid.primitives.get(at as usize) else {
            return;
        };
        let Surface::Plane { normal, .. } = primitive.surface(&solid.domain) else {
            return;
        };
        let outward = match face.sense {
            Sense::Inside => normal,
            Sense::Outside => -normal,
        };
        let areas = face.loops.iter().map(|ring| self.area(ring).dot(outward));
        let largest = areas.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((outer, _)) = largest {
            face.loops.swap(0, outer);
        }
    }

    /// Area vector of a loop, from points on its edges.
    fn area(&self, ring: &[usize]) -> DVec3 {
        const STEPS: usize = 32;
        let mut points = Vec::new();
        for &half_edge in ring {
            let piece = &self.edges[half_edge / 2].piece;
            let [from, to] = piece.range;
            let ends = if half_edge % 2 == 0 {
                [from, to]
            } else {
                [to, from]
            };
            points.extend((0..STEPS).map(|k| {
                let t = ends[0] + (ends[1] - ends[0]) * (k as f64 / STEPS as f64);
                piece.curve.point(t)
            }));
        }
        let Some(&origin) = points.first() else {
            return DVec3::ZERO;
        };
        points
            .windows(2)
            .map(|pair| (pair[0] - origin).cross(pair[1] - origin))
            .sum()
    }

    #[expect(
        clippy::cast_possible_wrap,
        reason = "slotmaps hold fewer than 2^32 elements"
    )]
    fn euler(&self, faces: &[ExactFace], list: &[usize]) -> i64 {
        let mut vertices = Vec::new();
        let mut half_edges = 0;
        let mut sum = 0;
        for &face in list {
            let face = &faces[face];
            sum += 2 - 2 * face.genus as i64 - face.loops.len() as i64;
            for &half_edge in face.loops.iter().flatten() {
                if let Some(ends) = self.edges[half_edge / 2].ends {
                    half_edges += 1;
                    vertices.extend(ends);
                }
            }
        }
        vertices.sort_unstable();
        vertices.dedup();
        vertices.len() as i64 - half_edges / 2 + sum
    }
}

/// Handles of each face: its characteristic is 2 − 2 genus − loops.
fn face_genera(brep: &Valid<Brep>, groups: &Groups) -> Vec<usize> {
    let count = groups.faces.len();
    let mut euler = vec![0_i64; count];
    let mut loops = vec![0_i64; count];
    for facet in brep.facets() {
        euler[groups.face_of[facet.key()].0 as usize] += 1;
    }
    let face_at =
        |half_edge: crate::HalfEdgeView<'_>| groups.face_of[half_edge.facet().key()].0 as usize;
    for half_edge in brep.half_edges().filter(|h| h.is_representative()) {
        if !groups.is_crease(half_edge) {
            euler[face_at(half_edge)] -= 1;
        }
    }
    for vertex in brep.vertices() {
        if !vertex.ring().any(|half_edge| groups.is_crease(half_edge)) {
            euler[face_at(vertex.outgoing())] += 1;
        }
    }
    let mut done = slotmap::SecondaryMap::new();
    for start in brep.half_edges() {
        if done.contains_key(start.key()) || !groups.is_crease(start) {
            continue;
        }
        loops[face_at(start)] += 1;
        let mut half_edge = start;
        while done.insert(half_edge.key(), ()).is_none() {
            half_edge = groups.continuation(half_edge);
        }
    }
    (0..count)
        .map(|at| usize::try_from((2 - loops[at] - euler[at]) / 2).unwrap_or(0))
        .collect()
}
