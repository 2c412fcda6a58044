//! No piece of the boundary passes through another one (docs/decisions/0002).
//!
//! Pieces of different leaves cannot meet but in their common facet: each stays in its own closed
//! simplex, since vertices move within the edge, facet or simplex that names them. In the facet
//! both leaves see the same segments. What is left are the pieces of one leaf. On the affine
//! interpolants they do not cross, for the arrangement is exact and triangulated there; on the
//! true surfaces they might. So each leaf with several surfaces is checked with exact predicates.
//! Where triangles cross, all of the leaf's vertices return to the interpolants, for every leaf
//! that uses them, and those leaves are checked again. Vertices only ever return, so this ends,
//! and in the end each leaf is either checked or affine.

use crate::fragments::{Fragments, Triangle};
use glam::DVec3;
use rayon::prelude::*;
use robust::{Coord3D, orient3d};

/// Vertices of leaves with several surfaces, and the triangles of each such leaf.
#[derive(Debug, Default)]
pub(crate) struct Tangles {
    /// Where the interpolants put a vertex, in model units; a vertex may be listed again.
    pub(crate) interpolated: Vec<(u32, DVec3)>,
    /// Vertices that must not lie on their true surfaces; all are listed above.
    pub(crate) objections: Vec<u32>,
    /// First triangle and the one after the last.
    pub(crate) leaves: Vec<[u32; 2]>,
}

/// Returns vertices to the interpolants until no leaf's triangles cross; the number of leaves
/// whose triangles cross there, too, which only rounding of positions can cause.
///
/// `is_plane`: by primitive.
pub(crate) fn untangle(mesh: &mut Fragments, tangles: &Tangles, is_plane: &[bool]) -> u64 {
    if tangles.leaves.is_empty() {
        return 0;
    }
    let mut home = vec![u32::MAX; mesh.positions.len()];
    for (at, (vertex, _)) in tangles.interpolated.iter().enumerate().rev() {
        home[*vertex as usize] = at as u32;
    }
    // Gives the vertex back and tells whether it moved: each one does so once.
    let mut give_back = |vertex: u32, positions: &mut [DVec3], moved: &mut Vec<bool>| {
        let entry = std::mem::replace(&mut home[vertex as usize], u32::MAX);
        let Some((_, position)) = tangles.interpolated.get(entry as usize) else {
            return false;
        };
        positions[vertex as usize] = *position;
        moved[vertex as usize] = true;
        true
    };
    let mut moved = vec![false; mesh.positions.len()];
    for &vertex in &tangles.objections {
        give_back(vertex, &mut mesh.positions, &mut moved);
    }
    let mut stuck = 0;
    let mut suspects = tangles.leaves.clone();
    while !suspects.is_empty() {
        let crossing: Vec<[u32; 2]> = suspects
            .into_par_iter()
            .with_min_len(64)
            .map_init(Vec::new, |plates, leaf| {
                let triangles = triangles_of(&mesh.triangles, leaf);
                crosses(&mesh.positions, triangles, is_plane, plates).then_some(leaf)
            })
            .flatten()
            .collect();
        moved.fill(false);
        let mut any = false;
        for leaf in crossing {
            let mut moves = false;
            for at in leaf[0]..leaf[1] {
                for vertex in mesh.triangles[at as usize].vertices {
                    moves |= give_back(vertex, &mut mesh.positions, &mut moved);
                }
            }
            any |= moves;
            stuck += u64::from(!moves);
        }
        suspects = Vec::new();
        if any {
            let has_moved = |t: &Triangle| t.vertices.iter().any(|v| moved[*v as usize]);
            let affected =
                |leaf: &&[u32; 2]| triangles_of(&mesh.triangles, **leaf).iter().any(has_moved);
            suspects.extend(tangles.leaves.iter().filter(affected));
        }
    }
    stuck
}

fn triangles_of(all: &[Triangle], [from, to]: [u32; 2]) -> &[Triangle] {
    &all[from as usize..to as usize]
}

/// A triangle with what tells most others apart from it.
#[derive(Clone, Copy, Debug)]
struct Plate {
    triangle: Triangle,
    corners: [DVec3; 3],
    low: DVec3,
    high: DVec3,
    normal: DVec3,
}

/// Rounding of a product of three lengths, in units of the product.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl Plate {
    fn new(positions: &[DVec3], triangle: Triangle) -> Self {
        let corners = triangle.vertices.map(|v| positions[v as usize]);
        let [a, b, c] = corners;
        Self {
            triangle,
            corners,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            normal: (b - a).cross(c - a),
        }
    }

    /// Whether two triangles pass through each other or cover a part of a plane twice.
    fn meets(&self, other: &Self, is_plane: &[bool]) -> bool {
        if self.low.cmpgt(other.high).any() || self.high.cmplt(other.low).any() {
            return false;
        }
        let primitive = self.triangle.primitive;
        let size = (self.high.max(other.high) - self.low.min(other.low)).element_sum();
        if primitive == other.triangle.primitive && is_plane[primitive.0 as usize] {
            // Its pieces look one way but where the solid lies on its other side.
            let same = self.triangle.sense == other.triangle.sense;
            let turn = self.normal.dot(other.normal);
            let is_flipped = turn < -ROUNDING * size.powi(4);
            return same && (is_flipped || self.covers(other, size));
        }
        let Some(flat) = self.apart(other, size).or_else(|| other.apart(self, size)) else {
            return pierce(&self.corners, &other.corners);
        };
        flat && self.normal.dot(other.normal) > 0.0 && self.covers(other, size)
    }

    /// `Some(false)` when the other triangle is surely on one side but for common vertices,
    /// `Some(true)` when it lies in this one's plane, `None` when exact arithmetic must tell.
    fn apart(&self, other: &Self, size: f64) -> Option<bool> {
        let slack = ROUNDING * size * size * size;
        let (mut above, mut below, mut within) = (true, true, true);
        for (vertex, corner) in other.triangle.vertices.iter().zip(other.corners) {
            if !self.triangle.vertices.contains(vertex) {
                let height = self.normal.dot(corner - self.corners[0]);
                above &= height > slack;
                below &= height < -slack;
                within &= height.abs() <= slack;
            }
        }
        match (above || below, within) {
            (true, _) => Some(false),
            (_, true) => Some(true),
            _ => None,
        }
    }

    /// Whether triangles in one plane overlap by more than rounding.
    fn covers(&self, other: &Self, size: f64) -> bool {
        let slack = ROUNDING * size;
        [self, other].iter().all(|plate| {
            let [a, b, c] = plate.corners;
            [b - a, c - b, a - c].iter().all(|side| {
                let Some(axis) = plate.normal.cross(*side).try_normalize() else {
                    return false;
                };
                let range = |of: &Self| {
                    let [p, q, r] = of.corners.map(|corner| axis.dot(corner));
                    (p.min(q).min(r), p.max(q).max(r))
                };
                let ((low, high), (least, most)) = (range(self), range(other));
                high - least > slack && most - low > slack
            })
        })
    }
}

/// Whether two of these triangles pass through each other. Touching is not crossing.
fn crosses(
    positions: &[DVec3],
    triangles: &[Triangle],
    is_plane: &[bool],
    plates: &mut Vec<Plate>,
) -> bool {
    plates.clear();
    plates.extend(triangles.iter().map(|t| Plate::new(positions, *t)));
    plates.iter().enumerate().any(|(at, first)| {
        let others = &plates[..at];
        others.iter().any(|second| first.meets(second, is_plane))
    })
}

/// Whether a side of one triangle passes through the inside of the other one.
///
/// Corners with equal coordinates are one, whatever their numbers: sheets that touch are copies.
fn pierce(a: &[DVec3; 3], b: &[DVec3; 3]) -> bool {
    let shared = |p: &DVec3, other: &[DVec3; 3]| other.contains(p);
    let common = a.iter().filter(|p| shared(p, b)).count();
    // With a common side two triangles can only fold onto each other.
    if common >= 2 {
        return false;
    }
    let through = |side: [DVec3; 2], triangle: &[DVec3; 3], signs: [f64; 2]| {
        signs[0] * signs[1] < 0.0
            && !side.iter().any(|end| shared(end, triangle))
            && encircles(side, triangle)
    };
    let sides = |t: &[DVec3; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]];
    let heights =
        |t: &[DVec3; 3], over: &[DVec3; 3]| t.map(|p| orientation(over[0], over[1], over[2], p));
    let one_side = |h: &[f64; 3]| h.iter().all(|x| *x >= 0.0) || h.iter().all(|x| *x <= 0.0);
    let over_a = heights(b, a);
    if one_side(&over_a) {
        return false;
    }
    let over_b = heights(a, b);
    if one_side(&over_b) {
        return false;
    }
    (0..3).any(|s| {
        let next = (s + 1) % 3;
        through(sides(b)[s], a, [over_a[s], over_a[next]].map(f64::signum))
            || through(sides(a)[s], b, [over_b[s], over_b[next]].map(f64::signum))
    })
}

/// Whether the line from `from` to `to` passes strictly inside the triangle.
fn encircles([from, to]: [DVec3; 2], [a, b, c]: &[DVec3; 3]) -> bool {
    let turns = [(a, b), (b, c), (c, a)].map(|(p, q)| orientation(from, to, *p, *q));
    turns.iter().all(|x| *x > 0.0) || turns.iter().all(|x| *x < 0.0)
}

fn orientation(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    });
    orient3d(a, b, c, d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragments::VertexKind;
    use csg::{MaterialId, PrimitiveId, Sense};

    fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Fragments {
        Fragments {
            positions: positions.iter().map(|p| DVec3::from(*p)).collect(),
            kinds: vec![VertexKind::Interior; positions.len()],
            triangles: triangles
                .iter()
                .map(|vertices| Triangle {
                    vertices: *vertices,
                    primitive: PrimitiveId(0),
                    sense: Sense::Inside,
                    material: MaterialId(0),
                })
                .collect(),
        }
    }

    fn flat() -> [[f64; 3]; 3] {
        [[0., 0., 0.], [4., 0., 0.], [0., 4., 0.]]
    }

    #[test]
    fn crossing_is_told_from_touching() {
        let with = |more: [[f64; 3]; 3]| {
            let positions: Vec<[f64; 3]> = flat().into_iter().chain(more).collect();
            let mesh = mesh(&positions, &[[0, 1, 2], [3, 4, 5]]);
            crosses(&mesh.positions, &mesh.triangles, &[false], &mut Vec::new())
        };
        assert!(
            with([[1., 1., -1.], [1., 1., 1.], [9., 9., 0.5]]),
            "a side passes through"
        );
        assert!(
            with([[1., 1., 1.], [0.5, 1., -1.], [1., 0.5, -1.]]),
            "a corner passes through"
        );
        assert!(
            with([[0., 0., 0.], [1., 1.5, 1.], [1.5, 1., -1.]]),
            "from a common corner"
        );
        assert!(
            !with([[1., 1., 0.], [1., 1., 1.], [2., 2., 1.]]),
            "a corner touches"
        );
        assert!(
            !with([[0., 0., 0.], [4., 0., 0.], [1., 1., 1.]]),
            "a side in common"
        );
        assert!(
            !with([[9., 9., -1.], [9., 9., 1.], [8., 9., 0.]]),
            "far away"
        );
        assert!(
            !with([[0., 0., 1.], [4., 0., 1.], [0., 4., 1e-300]]),
            "above"
        );
    }

    #[test]
    fn a_plane_is_covered_once() {
        let positions = [
            [0., 0., 0.],
            [4., 0., 0.],
            [0., 4., 0.],
            [4., 4., 0.],
            [1., 1., 0.],
            [2., 1., 0.],
            [1., 2., 0.],
        ];
        let covered = |triangles: [[u32; 3]; 2], is_plane: bool| {
            let mesh = mesh(&positions, &triangles);
            crosses(
                &mesh.positions,
                &mesh.triangles,
                &[is_plane],
                &mut Vec::new(),
            )
        };
        for is_plane in [false, true] {
            assert!(!covered([[0, 1, 2], [1, 3, 2]], is_plane), "neighbours");
            assert!(
                !covered([[0, 4, 2], [0, 1, 4]], is_plane),
                "around a corner"
            );
            assert!(
                covered([[0, 1, 2], [4, 5, 6]], is_plane),
                "one in the other"
            );
            assert!(covered([[0, 1, 3], [0, 1, 2]], is_plane), "over a side");
        }
        // Back to back two surfaces may touch; a plane may not turn over.
        assert!(!covered([[0, 1, 2], [4, 6, 5]], false));
        assert!(covered([[0, 1, 2], [4, 6, 5]], true));
    }

    /// Two leaves that share a vertex: the first leaf's crossing sends it home, which makes the
    /// second leaf's triangles cross until its own vertices return.
    #[test]
    fn vertices_return_until_nothing_crosses() {
        let mut positions: Vec<[f64; 3]> = flat().to_vec();
        // 3–5 pierces the flat triangle; home it does not.
        positions.extend([[1., 1., -1.], [1., 2., 1.], [2., 1., 1.]]);
        // A second triangle below, which vertex 3 meets when it returns, until it sinks itself.
        positions.extend([[0., 0., 0.4], [4., 0., 0.4], [0., 4., 0.4]]);
        let mut mesh = mesh(&positions, &[[0, 1, 2], [3, 4, 5], [6, 7, 8], [3, 4, 5]]);
        let home = |v: u32, p: [f64; 3]| (v, DVec3::from(p));
        let tangles = Tangles {
            interpolated: vec![
                home(3, [1., 1., 0.2]),
                home(6, [0., 0., 0.1]),
                home(7, [4., 0., 0.1]),
                home(8, [0., 4., 0.1]),
                home(6, [9., 9., 9.]),
            ],
            objections: Vec::new(),
            leaves: vec![[0, 2], [2, 4]],
        };
        assert!(crosses(
            &mesh.positions,
            &mesh.triangles[..2],
            &[false],
            &mut Vec::new()
        ));
        assert_eq!(untangle(&mut mesh, &tangles, &[false]), 0);
        assert_eq!(mesh.positions[3], DVec3::new(1., 1., 0.2));
        assert_eq!(mesh.positions[6], DVec3::new(0., 0., 0.1));
        assert!(!crosses(
            &mesh.positions,
            &mesh.triangles[..2],
            &[false],
            &mut Vec::new()
        ));
        assert!(!crosses(
            &mesh.positions,
            &mesh.triangles[2..],
            &[false],
            &mut Vec::new()
        ));
        // Without anywhere to return to it is counted.
        let mut stuck = self::mesh(&positions, &[[0, 1, 2], [3, 4, 5]]);
        let tangles = Tangles {
            leaves: vec![[0, 2]],
            ..Tangles::default()
        };
        assert_eq!(untangle(&mut stuck, &tangles, &[false]), 1);
    }
}
