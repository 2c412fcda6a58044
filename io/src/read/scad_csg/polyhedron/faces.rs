//! Faces of a closed polyhedron as oriented triangles in common planes.

use super::super::figure::{doubled_area, turn};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// How far a vertex may lie from a plane to count as lying in it, in sizes of the polyhedron:
/// OpenSCAD writes coordinates with six digits.
const FLATNESS: f64 = 2e-6;

/// Heights of triangles without a plane of their own, in distances within which faces are flat.
const NEEDLE: f64 = 1e-6;

/// [`FLATNESS`] for planes that are equal but for rounding.
const SAME: f64 = 1e-12;

/// Cosine of the largest angle, 10⁻⁴, between the normals of faces that are taken for coplanar.
/// Planes through a vertex that meet at larger ones meet within 10⁻⁸ of it, in spite of rounding.
const PARALLEL: f64 = 1.0 - 5e-9;

/// Why faces are not those of a polyhedron.
#[derive(Clone, PartialEq, Debug)]
pub(in super::super) enum Unsound {
    /// An edge, given by its ends, does not join two faces that turn the same way.
    Edge(DVec3, DVec3),
    /// The faces enclose no volume.
    Flat,
    /// A face crosses itself or others.
    Crossing,
    /// There are too many faces, or too many pieces of them.
    Large,
}

/// A triangle, counter-clockwise from outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    pub(super) corners: [DVec3; 3],
    /// Index of its plane.
    pub(super) plane: usize,
    /// Whether its outward normal is the plane's.
    pub(super) along: bool,
}

/// `normal · x = offset`, `normal` a unit vector.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Plane {
    pub(super) normal: DVec3,
    pub(super) offset: f64,
}

/// A triangle with its plane, if it finds no company.
struct Candidate {
    corners: [DVec3; 3],
    plane: Plane,
}

/// Triangles, and the planes that they lie in.
#[derive(Debug)]
pub(super) struct Faces {
    pub(super) triangles: Vec<Triangle>,
    /// Triangles without area, which have no plane of their own.
    pub(super) needles: Vec<[DVec3; 3]>,
    pub(super) planes: Vec<Plane>,
    /// Size of the polyhedron.
    pub(super) size: f64,
    /// How far corners lie from the planes of their faces.
    pub(super) slack: f64,
    pub(super) min: DVec3,
    pub(super) max: DVec3,
}

impl Faces {
    /// Takes faces as lists of positions in one sense of rotation, whichever.
    pub(super) fn new(mut polygons: Vec<Vec<DVec3>>) -> Result<Self, Unsound> {
        for polygon in &mut polygons {
            // Adding 0 turns −0 into 0.
            for p in polygon.iter_mut() {
                *p += DVec3::ZERO;
            }
            polygon.dedup();
            while polygon.len() > 1 && polygon.first() == polygon.last() {
                polygon.pop();
            }
        }
        polygons.retain(|polygon| polygon.len() > 2);
        check_edges(&polygons)?;
        let all = || polygons.iter().flatten();
        let min = all().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let max = all().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        let size = min.distance(max);
        let volume: f64 = polygons.iter().map(|p| volume_below(p, min)).sum();
        if volume.abs() <= 1e-12 * size.powi(3) || !volume.is_finite() {
            return Err(Unsound::Flat);
        }
        if volume < 0.0 {
            for polygon in &mut polygons {
                polygon.reverse();
            }
        }
        // The largest of coplanar faces knows its plane best.
        polygons.sort_by(|a, b| {
            let (a, b) = (vector_area(a), vector_area(b));
            b.length_squared().total_cmp(&a.length_squared())
        });
        let (mut pieces, mut needles) = (Vec::new(), Vec::new());
        for polygon in polygons {
            cut(&polygon, FLATNESS * size, &mut pieces, &mut needles)?;
        }
        let mut faces = Self::of_pieces(&pieces, [min, max]);
        faces.needles = needles;
        Ok(faces)
    }

    /// Takes triangles, counter-clockwise from outside, that need not close.
    pub(super) fn open(triangles: Vec<[DVec3; 3]>) -> Self {
        let all = || triangles.iter().flatten();
        let min = all().fold(DVec3::INFINITY, |m, p| m.min(*p));
        let max = all().fold(DVec3::NEG_INFINITY, |m, p| m.max(*p));
        let pieces = triangles.into_iter().filter_map(|corners| {
            let plane = plane_of(&corners)?;
            Some(Candidate { corners, plane })
        });
        Self::of_pieces(&pieces.collect::<Vec<_>>(), [min, max])
    }

    /// Puts triangles into common planes: those that hang together by edges and are flat within
    /// the digits of files, and others only where they have the same plane but for rounding. So
    /// the triangles of a mesh that is curved keep their own planes, which meet in its vertices.
    fn of_pieces(pieces: &[Candidate], [min, max]: [DVec3; 2]) -> Self {
        let size = min.distance(max);
        let mut faces = Self {
            triangles: Vec::with_capacity(pieces.len()),
            needles: Vec::new(),
            planes: Vec::new(),
            size,
            slack: 0.0,
            min,
            max,
        };
        let mut at_edge: BTreeMap<[[u64; 3]; 2], Vec<usize>> = BTreeMap::new();
        for (at, piece) in pieces.iter().enumerate() {
            for edge in edges(&piece.corners) {
                at_edge.entry(edge).or_default().push(at);
            }
        }
        let mut buckets = BTreeMap::new();
        let mut placed = vec![false; pieces.len()];
        let mut waiting = Vec::new();
        for seed in 0..pieces.len() {
            let Some(first) = pieces
                .get(seed)
                .filter(|_| placed.get(seed) == Some(&false))
            else {
                continue;
            };
            let at = faces.plane(first, &mut buckets);
            let Some(plane) = faces.planes.get(at).copied() else {
                continue;
            };
            waiting.push(seed);
            while let Some(next) = waiting.pop() {
                let (Some(piece), Some(is_placed)) = (pieces.get(next), placed.get_mut(next))
                else {
                    continue;
                };
                let Some(along) = plane.holds(piece, FLATNESS * size).filter(|_| !*is_placed)
                else {
                    continue;
                };
                *is_placed = true;
                let corners = piece.corners;
                let away = corners.map(|p| (plane.normal.dot(p) - plane.offset).abs());
                faces.slack = away.into_iter().fold(faces.slack, f64::max);
                faces.triangles.push(Triangle {
                    corners,
                    plane: at,
                    along,
                });
                let beside = edges(&corners).into_iter().filter_map(|e| at_edge.get(&e));
                waiting.extend(beside.flatten());
            }
        }
        faces
    }

    /// The plane of a triangle: a known one where that is the same but for rounding.
    fn plane(&mut self, piece: &Candidate, buckets: &mut BTreeMap<i64, Vec<usize>>) -> usize {
        // Distances of equal planes from the middle differ little.
        let middle = 0.5 * (self.min + self.max);
        let reach = piece.plane.normal.dot(middle) - piece.plane.offset;
        let width = self.size * 1e-3;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "at most the size over a thousandth of it"
        )]
        let bucket = (reach.abs() / width) as i64;
        let near = (bucket - 1..=bucket + 1)
            .filter_map(|b| buckets.get(&b))
            .flatten();
        let known = near.copied().find(|at| {
            let plane = self.planes.get(*at);
            plane.is_some_and(|p| p.holds(piece, SAME * self.size).is_some())
        });
        known.unwrap_or_else(|| {
            self.planes.push(piece.plane);
            let at = self.planes.len() - 1;
            buckets.entry(bucket).or_default().push(at);
            at
        })
    }
}

impl Plane {
    /// Whether a triangle lies in the plane within a distance; then whether its normal is the
    /// plane's.
    fn holds(&self, piece: &Candidate, within: f64) -> Option<bool> {
        let cosine = self.normal.dot(piece.plane.normal);
        let mut away = piece
            .corners
            .iter()
            .map(|p| self.normal.dot(*p) - self.offset);
        let holds = cosine.abs() > PARALLEL && away.all(|d| d.abs() <= within);
        holds.then_some(cosine > 0.0)
    }
}

/// Cuts a face into triangles with its plane or, where it is not plane, their own: OpenSCAD, too,
/// splits such faces, along whichever diagonals.
fn cut(
    polygon: &[DVec3],
    flat: f64,
    pieces: &mut Vec<Candidate>,
    needles: &mut Vec<[DVec3; 3]>,
) -> Result<(), Unsound> {
    let Some(normal) = vector_area(polygon).try_normalize() else {
        if let Some((&first, rest)) = polygon.split_first() {
            let fan = rest.array_windows().map(|&[a, b]| [first, a, b]);
            needles.extend(fan);
        }
        return Ok(());
    };
    let offset = normal.dot(polygon.iter().sum::<DVec3>() / polygon.len() as f64);
    let own = Plane { normal, offset };
    let mut away = polygon.iter().map(|p| normal.dot(*p) - offset);
    let is_flat = polygon.len() > 3 && away.all(|d| d.abs() <= flat);
    let triangles = triangulate(polygon, normal).ok_or(Unsound::Crossing)?;
    for corners in triangles {
        let plane = if is_flat {
            Some(own)
        } else {
            plane_of(&corners).filter(|_| !is_needle(&corners, NEEDLE * flat))
        };
        match plane {
            Some(plane) => pieces.push(Candidate { corners, plane }),
            None => needles.push(corners),
        }
    }
    Ok(())
}

/// Whether a triangle is no higher than a length, so that rounding makes its plane.
fn is_needle(&[a, b, c]: &[DVec3; 3], height: f64) -> bool {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    (b - a).cross(c - a).length() <= height * longest
}

/// The edges of a triangle, whichever way.
pub(super) fn edges(&[a, b, c]: &[DVec3; 3]) -> [[[u64; 3]; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|ends| {
        let mut keys = ends.map(|p| p.to_array().map(f64::to_bits));
        keys.sort_unstable();
        keys
    })
}

/// Every edge must be passed as often one way as the other.
fn check_edges(polygons: &[Vec<DVec3>]) -> Result<(), Unsound> {
    let key = |p: DVec3| p.to_array().map(f64::to_bits);
    let mut balance: BTreeMap<[[u64; 3]; 2], (i64, DVec3, DVec3)> = BTreeMap::new();
    for polygon in polygons {
        let next = polygon.iter().cycle().skip(1);
        for (&a, &b) in polygon.iter().zip(next) {
            let (low, high, way) = if key(a) < key(b) {
                (a, b, 1)
            } else {
                (b, a, -1)
            };
            balance
                .entry([key(low), key(high)])
                .or_insert((0, low, high))
                .0 += way;
        }
    }
    match balance.values().find(|(count, ..)| *count != 0) {
        Some(&(_, a, b)) => Err(Unsound::Edge(a, b)),
        None => Ok(()),
    }
}

/// Six times the volume between a polygon and a point.
fn volume_below(polygon: &[DVec3], apex: DVec3) -> f64 {
    let Some((&first, rest)) = polygon.split_first() else {
        return 0.0;
    };
    let fans = rest.windows(2).map(|w| match *w {
        [a, b] => (first - apex).dot((a - apex).cross(b - apex)),
        _ => 0.0,
    });
    fans.sum()
}

/// Twice the vector area of a polygon, whose direction is the normal that fits it best.
fn vector_area(polygon: &[DVec3]) -> DVec3 {
    let Some((&first, rest)) = polygon.split_first() else {
        return DVec3::ZERO;
    };
    let fans = rest.windows(2).map(|w| match *w {
        [a, b] => (a - first).cross(b - first),
        _ => DVec3::ZERO,
    });
    fans.sum()
}

fn plane_of(&[a, b, c]: &[DVec3; 3]) -> Option<Plane> {
    let normal = (b - a).cross(c - a).try_normalize()?;
    let offset = normal.dot((a + b + c) / 3.0);
    Some(Plane { normal, offset })
}

/// Cuts ears off a simple polygon; `None` if it crosses itself.
fn triangulate(polygon: &[DVec3], normal: DVec3) -> Option<Vec<[DVec3; 3]>> {
    let (x, y) = normal.any_orthonormal_pair();
    let (x, y) = if x.cross(y).dot(normal) > 0.0 {
        (x, y)
    } else {
        (y, x)
    };
    let mut left: Vec<(DVec2, DVec3)> = polygon
        .iter()
        .map(|&p| (DVec2::new(x.dot(p), y.dot(p)), p))
        .collect();
    let outline: Vec<DVec2> = left.iter().map(|l| l.0).collect();
    let mut triangles = Vec::with_capacity(left.len());
    let mut covered = 0.0;
    // OpenSCAD splits quadrilaterals along the shorter diagonal, which matters where they are not
    // plane.
    if let [a, b, c, d] = *polygon
        && a.distance_squared(c) < b.distance_squared(d)
    {
        // Then the first ear is at b.
        left.rotate_left(1);
    }
    while left.len() > 3 {
        let n = left.len();
        let at = |i: usize| left.get(i % n).copied().unwrap_or_default();
        let ear = (0..n).find(|&i| {
            let (a, b, c) = (at(i + n - 1).0, at(i).0, at(i + 1).0);
            let blocks = |p: DVec2| {
                p != a
                    && p != b
                    && p != c
                    && turn(a, b, p) >= 0.0
                    && turn(b, c, p) >= 0.0
                    && turn(c, a, p) >= 0.0
            };
            turn(a, b, c) >= 0.0 && !left.iter().any(|&(p, _)| blocks(p))
        })?;
        let corners = [at(ear + n - 1), at(ear), at(ear + 1)];
        covered += doubled_area(&corners.map(|c| c.0));
        triangles.push(corners.map(|c| c.1));
        left.remove(ear);
    }
    if let [a, b, c] = left[..] {
        covered += doubled_area(&[a.0, b.0, c.0]);
        triangles.push([a.1, b.1, c.1]);
    }
    let area = doubled_area(&outline);
    ((covered - area).abs() <= 1e-6 * area.abs()).then_some(triangles)
}
