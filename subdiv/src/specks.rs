//! Specks: what the interpolants cut off where nothing is proved, about as large as the cells there.
//!
//! Near a cone's apex, a cusp's tip or a tangency, pieces may come off the solid, and faces may
//! show that the solid has not: the plane through a cone's apex. Whether they exist is not known
//! there, and a tip in pieces is worse than a blunt one.

use crate::fragments::{Fragments, Triangle};
use crate::lattice::Point;
use crate::simplex::Simplex;
use csg::Domain;
use glam::DVec3;
use rustc_hash::FxHashSet;

/// Diagonal of a speck in units of a cell's longest edge, at most. Larger ones may be real: a
/// tolerance may be coarse.
const CELLS: f64 = 2.5;

/// No number.
const NONE: u32 = u32::MAX;

/// The cells that prove nothing, by their midpoints, in the domain's own units.
#[derive(Debug, Default)]
pub(crate) struct Doubtful {
    /// Longest edge of the largest of them.
    size: f64,
    midpoints: Vec<Point>,
}

impl Doubtful {
    pub(crate) fn push(&mut self, simplex: &Simplex) {
        let [first, .., last] = simplex.vertices.map(Point::position);
        self.size = self.size.max(first.distance(last));
        self.midpoints.push(simplex.midpoint());
    }

    pub(crate) fn append(&mut self, mut other: Self) {
        self.size = self.size.max(other.size);
        self.midpoints.append(&mut other.midpoints);
    }
}

/// What was taken away.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Cleared {
    /// Closed pieces.
    pub(crate) pieces: u64,
    /// Faces that became part of a neighbour.
    pub(crate) faces: u64,
}

/// Takes away closed pieces, and gives faces to their neighbours, if they are as small as specks
/// and all their corners lie beside cells that prove nothing. What has no larger neighbour
/// stays: a model is not nothing.
///
/// Cost: O(n log n) for n triangles; nothing where all cells are proved.
pub(crate) fn clear_specks(
    fragments: &mut Fragments,
    doubtful: &Doubtful,
    domain: &Domain,
) -> Cleared {
    if doubtful.midpoints.is_empty() {
        return Cleared::default();
    }
    let near = Near::of(doubtful, domain);
    Cleared {
        pieces: drop_pieces(fragments, &near),
        faces: give_away_faces(fragments, &near),
    }
}

fn drop_pieces(fragments: &mut Fragments, near: &Near<'_>) -> u64 {
    let mut forest = Forest::new(fragments.positions.len());
    for Triangle { vertices, .. } in &fragments.triangles {
        let [a, b, c] = vertices.map(|v| v as usize);
        forest.join(a, b);
        forest.join(b, c);
    }
    let triangles = &fragments.triangles;
    let piece: Vec<usize> = (triangles.iter())
        .map(|triangle| forest.root(triangle.vertices[0] as usize))
        .collect();
    let specks = near.specks(fragments, &piece);
    let all: FxHashSet<usize> = piece.iter().copied().collect();
    if specks.is_empty() || specks.len() == all.len() {
        return 0;
    }
    let mut at = piece.iter();
    (fragments.triangles).retain(|_| at.next().is_some_and(|piece| !specks.contains(piece)));
    drop_lonely_vertices(fragments);
    specks.len() as u64
}

fn drop_lonely_vertices(fragments: &mut Fragments) {
    let mut number = vec![NONE; fragments.positions.len()];
    for vertex in fragments.triangles.iter().flat_map(|t| t.vertices) {
        number[vertex as usize] = 0;
    }
    let mut used = number.iter().map(|&number| number != NONE);
    fragments.positions.retain(|_| used.next() == Some(true));
    let mut used = number.iter().map(|&number| number != NONE);
    fragments.kinds.retain(|_| used.next() == Some(true));
    for (new, number) in (0..).zip(number.iter_mut().filter(|number| **number != NONE)) {
        *number = new;
    }
    for vertex in fragments.triangles.iter_mut().flat_map(|t| &mut t.vertices) {
        *vertex = number[*vertex as usize];
    }
}

/// Gives each small face to the neighbour with which it has most edges in common.
fn give_away_faces(fragments: &mut Fragments, near: &Near<'_>) -> u64 {
    let neighbours = neighbours(&fragments.triangles);
    let label = |at: usize| {
        let of = fragments.triangles[at];
        (of.primitive, of.sense, of.material)
    };
    let mut forest = Forest::new(fragments.triangles.len());
    for &[one, other] in &neighbours {
        if label(one) == label(other) {
            forest.join(one, other);
        }
    }
    let face: Vec<usize> = (0..fragments.triangles.len())
        .map(|at| forest.root(at))
        .collect();
    let specks = near.specks(fragments, &face);
    let mut borders: Vec<[usize; 2]> = (neighbours.iter())
        .flat_map(|&[one, other]| [[one, other], [other, one]])
        .map(|pair| pair.map(|at| face[at]))
        .filter(|[small, large]| specks.contains(small) && !specks.contains(large))
        .collect();
    borders.sort_unstable();
    let mut heirs: Vec<(usize, usize, usize)> = (borders.chunk_by(|one, other| one == other))
        .map(|edges| (edges[0][0], edges.len(), edges[0][1]))
        .collect();
    heirs.sort_by_key(|&(small, edges, large)| (small, std::cmp::Reverse(edges), large));
    heirs.dedup_by_key(|(small, ..)| *small);
    for (at, of_face) in face.iter().enumerate() {
        if let Ok(found) = heirs.binary_search_by_key(of_face, |(small, ..)| *small) {
            // A face is named by one of its triangles; larger ones keep their label.
            let heir = fragments.triangles[heirs[found].2];
            let triangle = &mut fragments.triangles[at];
            triangle.primitive = heir.primitive;
            triangle.sense = heir.sense;
            triangle.material = heir.material;
        }
    }
    heirs.len() as u64
}

/// Pairs of triangles with a common edge, in opposite directions.
fn neighbours(triangles: &[Triangle]) -> Vec<[usize; 2]> {
    let mut edges: Vec<([u32; 2], bool, u32)> = (0..)
        .zip(triangles)
        .flat_map(|(at, triangle)| {
            let [a, b, c] = triangle.vertices;
            [[a, b], [b, c], [c, a]].map(|[p, q]| ([p.min(q), p.max(q)], p < q, at))
        })
        .collect();
    edges.sort_unstable();
    let pairs = edges.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    pairs
        .map(|pair| [pair[0].2 as usize, pair[1].2 as usize])
        .collect()
}

/// Where cells prove nothing.
struct Near<'a> {
    domain: &'a Domain,
    /// Side of the cubes, in the domain's own units.
    size: f64,
    /// Cubes that hold midpoints of cells, and those around them.
    cubes: FxHashSet<[i64; 3]>,
}

impl<'a> Near<'a> {
    fn of(doubtful: &Doubtful, domain: &'a Domain) -> Self {
        let mut this = Self {
            domain,
            size: doubtful.size,
            cubes: FxHashSet::default(),
        };
        let midpoints = doubtful.midpoints.iter().map(|p| p.position());
        let places: FxHashSet<[i64; 3]> = midpoints.map(|p| this.cube(p)).collect();
        for [x, y, z] in places {
            let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
            this.cubes.extend(around);
        }
        this
    }

    fn cube(&self, unit: DVec3) -> [i64; 3] {
        (unit / self.size).to_array().map(|x| x.floor() as i64)
    }

    /// Those of these parts – named by a number for each triangle – that are specks.
    fn specks(&self, fragments: &Fragments, part: &[usize]) -> FxHashSet<usize> {
        let mut large = FxHashSet::default();
        let mut boxes: rustc_hash::FxHashMap<usize, [DVec3; 2]> = rustc_hash::FxHashMap::default();
        for (triangle, &part) in fragments.triangles.iter().zip(part) {
            if large.contains(&part) {
                continue;
            }
            let centered = (triangle.vertices)
                .map(|v| self.domain.to_centered(fragments.positions[v as usize]));
            let corners = centered.map(|p| 0.5 * (p + 1.0));
            let [low, high] = boxes.entry(part).or_insert([corners[0]; 2]);
            for corner in corners {
                (*low, *high) = (low.min(corner), high.max(corner));
            }
            let is_small = low.distance(*high) <= CELLS * self.size;
            if !is_small || !corners.iter().all(|&p| self.cubes.contains(&self.cube(p))) {
                large.insert(part);
            }
        }
        (boxes.into_keys())
            .filter(|part| !large.contains(part))
            .collect()
    }
}

/// Sets that grow together.
struct Forest(Vec<usize>);

impl Forest {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn root(&mut self, mut at: usize) -> usize {
        while self.0[at] != at {
            self.0[at] = self.0[self.0[at]];
            at = self.0[at];
        }
        at
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragments::VertexKind;
    use csg::{Aabb, MaterialId, PrimitiveId, Sense};

    /// Tetrahedra with these lowest corners and sizes, each with four faces.
    fn tetrahedra(of: &[([f64; 3], f64)]) -> Fragments {
        let mut all = Fragments::default();
        for &(low, size) in of {
            let first = all.positions.len() as u32;
            let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
            let corners = corners.map(|corner| DVec3::from_array(low) + size * corner);
            all.positions.extend(corners);
            all.kinds.extend([VertexKind::Edge; 4]);
            let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
            all.triangles
                .extend((0..).zip(faces).map(|(p, face)| Triangle {
                    vertices: face.map(|k| first + k),
                    primitive: PrimitiveId(p),
                    sense: Sense::Inside,
                    material: MaterialId(0),
                }));
        }
        all
    }

    /// Clears what is beside two cells of 2⁻⁶ of the domain's side, around (0.02, 0.02, 0.02).
    fn cleared(fragments: &mut Fragments) -> Cleared {
        let domain = Domain::around(&Aabb {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        });
        let side = 1 << 14;
        // The lattice point next to it.
        let middle = 0.5 * (domain.to_centered(DVec3::splat(0.02)) + 1.0);
        let scaled = middle * f64::from(1 << 20);
        let [x, y, z] = scaled
            .to_array()
            .map(|x| (0..1 << 20).find(|&k| f64::from(k) >= x).unwrap());
        let doubtful = Doubtful {
            size: f64::from(side) / f64::from(1 << 20),
            midpoints: vec![Point::new([x, y, z]), Point::new([x + side, y, z])],
        };
        clear_specks(fragments, &doubtful, &domain)
    }

    #[test]
    fn what_is_small_and_doubtful_goes() {
        let mut mesh = tetrahedra(&[([0.01; 3], 0.02), ([0.5; 3], 0.4), ([0.5, 0.1, 0.1], 0.02)]);
        let cleared = cleared(&mut mesh);
        assert_eq!([cleared.pieces, cleared.faces], [1, 0]);
        // Neither the large one, nor the small one where nothing is doubtful.
        assert_eq!(
            mesh,
            tetrahedra(&[([0.5; 3], 0.4), ([0.5, 0.1, 0.1], 0.02)])
        );
    }

    #[test]
    fn a_whole_model_stays() {
        let mut mesh = tetrahedra(&[([0.01; 3], 0.02)]);
        let before = mesh.clone();
        assert_eq!(cleared(&mut mesh), Cleared::default());
        assert_eq!(mesh, before);
    }

    /// The tip of a large tetrahedron, cut off by a fifth face in the doubtful corner.
    #[test]
    fn small_faces_go_to_their_neighbours() {
        let mut mesh = tetrahedra(&[([0.01; 3], 0.9)]);
        let tip = [[0.03, 0.01, 0.01], [0.01, 0.03, 0.01], [0.01, 0.01, 0.03]];
        mesh.positions.extend(tip.map(DVec3::from_array));
        mesh.kinds.extend([VertexKind::Edge; 3]);
        let of = |vertices, primitive| Triangle {
            vertices,
            primitive: PrimitiveId(primitive),
            ..tetrahedra(&[([0.0; 3], 1.0)]).triangles[0]
        };
        mesh.triangles = vec![
            of([4, 2, 1], 0),
            of([4, 5, 2], 0),
            of([4, 1, 3], 1),
            of([4, 3, 6], 1),
            of([1, 2, 3], 2),
            of([5, 6, 3], 3),
            of([5, 3, 2], 3),
            of([4, 6, 5], 9),
        ];
        let cleared = cleared(&mut mesh);
        assert_eq!([cleared.pieces, cleared.faces], [0, 1]);
        assert_eq!(mesh.triangles.len(), 8);
        assert!(mesh.triangles[7].primitive.0 < 9, "{:?}", mesh.triangles[7]);
    }
}
