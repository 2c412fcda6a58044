//! Triangulation of one planar piece of the boundary between given mesh vertices.

use crate::arrange::{FACET, NO_PLANE};
use crate::kernel::Kernel;
use crate::leaf_formula::Label;
use crate::mesh::MeshBuilder;
use glam::{DVec2, DVec3};

/// A corner of a piece: its mesh vertex and the planes of the leaf on which it lies.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Corner {
    /// Index in the mesh.
    pub vertex: u32,
    /// Planes as numbered by [`crate::arrange`].
    pub planes: [u16; 3],
    /// Where the interpolants put it, in the domain's own coordinates.
    pub affine: DVec3,
}

/// Planes of a vertex inside a piece, which no neighbour knows.
const FREE: [u16; 3] = [NO_PLANE; 3];

/// Clips ears, remembering the diagonals used in the leaf.
#[derive(Debug, Default)]
pub(crate) struct PieceTriangulator {
    diagonals: Vec<[u32; 2]>,
    flat: Vec<DVec2>,
    normal: DVec3,
    kernel: Kernel,
}

impl PieceTriangulator {
    /// Forgets the last leaf.
    pub(crate) fn clear(&mut self) {
        self.diagonals.clear();
    }

    /// Triangulates the piece with these corners, counter-clockwise seen from where its
    /// primitive is positive; `ring` is used up.
    ///
    /// No diagonal joins two corners that share a plane besides the piece's own: they lie on a
    /// common side, and the neighbour there may join them, too. When no ear is left, corners on
    /// one primitive may be joined across the piece, where that primitive makes no boundary; then
    /// the rest is a fan around a new inner vertex that sees all corners. Without such a point an
    /// ear is cut off by way of a new vertex in it, once for each corner.
    pub(crate) fn triangulate(
        &mut self,
        ring: &mut Vec<Corner>,
        (own, primitive, label): (u16, u32, Label),
        mesh: &mut MeshBuilder,
    ) {
        if ring.len() > 3 {
            self.flatten(ring);
        }
        while ring.len() > 3 {
            let strict = self.best_ear(ring, |a, c| share_a_side(a, c, own));
            let n = ring.len();
            let around = |ear: usize| (ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n]);
            let Some(ear) = strict.or_else(|| self.best_ear(ring, share_a_facet)) else {
                let corners = ring.iter().map(|corner| corner.affine);
                let center = self.kernel.center(corners, self.normal);
                let tip = self
                    .best_ear(ring, |_, _| false)
                    .filter(|ear| center.is_none() && ring[*ear].planes != FREE);
                let Some(tip) = tip else {
                    let center = center.unwrap_or_else(|| least_folded(ring));
                    fan(ring, center, primitive, label, mesh);
                    return;
                };
                let (a, b, c) = around(tip);
                let affine = (a.affine + b.affine + c.affine) / 3.0;
                let vertex = mesh.interior_vertex(affine);
                mesh.push_oriented([a.vertex, b.vertex, vertex], primitive, label);
                mesh.push_oriented([b.vertex, c.vertex, vertex], primitive, label);
                ring[tip] = Corner {
                    vertex,
                    planes: FREE,
                    affine,
                };
                self.flatten(ring);
                continue;
            };
            let (a, b, c) = around(ear);
            mesh.push_oriented([a.vertex, b.vertex, c.vertex], primitive, label);
            self.diagonals.push(diagonal(a, c));
            ring.remove(ear);
            self.flat.remove(ear);
        }
        if let [a, b, c] = ring[..] {
            mesh.push_oriented([a.vertex, b.vertex, c.vertex], primitive, label);
        }
    }

    /// Projects the corners along the piece's dominant normal axis, keeping the orientation.
    ///
    /// On the interpolants, where the piece is flat: should its vertices have to return there, the
    /// triangles are right.
    fn flatten(&mut self, ring: &[Corner]) {
        let at = |c: &Corner| c.affine;
        let mut normal = DVec3::ZERO;
        for (n, corner) in ring.iter().enumerate() {
            let next = at(&ring[(n + 1) % ring.len()]);
            let origin = at(&ring[0]);
            normal += (at(corner) - origin).cross(next - origin);
        }
        self.normal = normal;
        let size = normal.abs();
        self.flat.clear();
        self.flat.extend(ring.iter().map(|corner| {
            let p = at(corner);
            let (flat, forward) = if size.x >= size.y && size.x >= size.z {
                (DVec2::new(p.y, p.z), normal.x >= 0.0)
            } else if size.y >= size.z {
                (DVec2::new(p.z, p.x), normal.y >= 0.0)
            } else {
                (DVec2::new(p.x, p.y), normal.z >= 0.0)
            };
            if forward {
                flat
            } else {
                DVec2::new(flat.y, flat.x)
            }
        }));
    }

    /// The convex, empty, allowed ear with the shortest diagonal.
    fn best_ear(
        &self,
        ring: &[Corner],
        forbidden: impl Fn(Corner, Corner) -> bool,
    ) -> Option<usize> {
        let n = ring.len();
        let mut best = None;
        for ear in 0..n {
            let (before, after) = ((ear + n - 1) % n, (ear + 1) % n);
            let (a, c) = (ring[before], ring[after]);
            if forbidden(a, c) || self.diagonals.contains(&diagonal(a, c)) {
                continue;
            }
            let [p, q, r] = [before, ear, after].map(|at| self.flat[at]);
            if (q - p).perp_dot(r - q) <= 0.0 {
                continue;
            }
            let empty = (0..n)
                .filter(|at| ![before, ear, after].contains(at))
                .all(|at| {
                    let x = self.flat[at];
                    (q - p).perp_dot(x - p) < 0.0
                        || (r - q).perp_dot(x - q) < 0.0
                        || (p - r).perp_dot(x - r) < 0.0
                });
            let length = p.distance_squared(r);
            if empty && best.is_none_or(|(shortest, _)| length < shortest) {
                best = Some((length, ear));
            }
        }
        best.map(|(_, ear)| ear)
    }
}

fn diagonal(a: Corner, b: Corner) -> [u32; 2] {
    [a.vertex.min(b.vertex), a.vertex.max(b.vertex)]
}

fn share_a_side(a: Corner, b: Corner, own: u16) -> bool {
    a.vertex == b.vertex
        || a.planes
            .iter()
            .any(|p| *p != own && *p != NO_PLANE && b.planes.contains(p))
}

/// Whether two corners lie in one facet of the simplex, where a neighbour may join them.
fn share_a_facet(a: Corner, b: Corner) -> bool {
    let in_facet = |p: &&u16| **p >= FACET && **p != NO_PLANE;
    a.vertex == b.vertex
        || a.planes
            .iter()
            .filter(in_facet)
            .any(|p| b.planes.contains(p))
}

/// The corner around which a fan covers least: where planes coincide, a ring may run to and fro
/// along a line, and any other place would fold the fan over itself.
fn least_folded(ring: &[Corner]) -> DVec3 {
    let covered = |center: DVec3| -> f64 {
        let next = ring.iter().cycle().skip(1);
        let sides = ring.iter().zip(next);
        sides
            .map(|(a, b)| (a.affine - center).cross(b.affine - center).length())
            .sum()
    };
    let least = |a: &DVec3, b: &DVec3| covered(*a).total_cmp(&covered(*b));
    let corners = ring.iter().map(|corner| corner.affine);
    corners.min_by(least).unwrap_or_default()
}

/// Joins every side to a new vertex on the interpolants.
fn fan(ring: &[Corner], center: DVec3, primitive: u32, label: Label, mesh: &mut MeshBuilder) {
    let center = mesh.interior_vertex(center);
    for (at, corner) in ring.iter().enumerate() {
        let next = ring[(at + 1) % ring.len()];
        mesh.push_oriented([corner.vertex, next.vertex, center], primitive, label);
    }
}
