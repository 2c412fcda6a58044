//! A polyhedron as a Boolean formula of its face planes, by binary space partition.
//!
//! A plane splits the faces into those before and those behind it. Where nothing lies before,
//! there is the outside, and the solid is the plane's half-space and what is found behind;
//! where nothing lies behind, there is the inside. Faces are split only to tell what lies where:
//! the formula's planes are the faces' own.
//!
//! Where many faces are left, an axis-parallel plane through their middle splits them first.
//! It bounds nothing, since both sides meet in it, but keeps the planes of faces out of parts of
//! space that they have nothing to do with: a mesh of n faces has a formula of O(n) literals in
//! which few matter in each place.

use super::faces::{Faces, Plane, Triangle, Unsound};
use glam::DVec3;

/// A part of a formula in prefix order.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Piece {
    Open {
        union: bool,
    },
    Close,
    /// `inside`: the points behind the plane with this index.
    Side {
        plane: usize,
        inside: bool,
    },
}

/// Pieces of faces that a partition may make of each face.
const MOST_PIECES: usize = 200;

/// Planes that are tried for each cell.
const CANDIDATES: usize = 12;

/// Cells with more faces are split by axis-parallel planes.
const CROWD: usize = 40;

/// Distance from a plane within which points count as lying in it, in sizes of the polyhedron.
const NEAR: f64 = 4e-6;

/// The formula of a polyhedron.
///
/// Planes that split space only are added to those of the faces.
pub(super) fn formula(faces: &mut Faces) -> Result<Vec<Piece>, Unsound> {
    enum Task {
        Cell(Vec<Triangle>),
        Part(Piece),
    }
    let near = NEAR * faces.size;
    let mut left = (faces.triangles.len() + 50) * MOST_PIECES;
    let mut pieces = Vec::new();
    let mut tasks = vec![Task::Cell(faces.triangles.clone())];
    while let Some(task) = tasks.pop() {
        let triangles = match task {
            Task::Part(piece) => {
                pieces.push(piece);
                continue;
            }
            Task::Cell(triangles) => triangles,
        };
        left = left.checked_sub(triangles.len()).ok_or(Unsound::Large)?;
        let across = (triangles.len() > CROWD)
            .then(|| across_the_middle(&triangles, near))
            .flatten();
        let best = match across {
            Some(plane) => {
                faces.planes.push(plane);
                Some(faces.planes.len() - 1)
            }
            None => choose(&triangles, &faces.planes, near),
        };
        let Some(best) = best else {
            continue;
        };
        let Some(plane) = faces.planes.get(best) else {
            continue;
        };
        let (mut front, mut back) = (Vec::new(), Vec::new());
        let (mut along, mut against) = (false, false);
        for triangle in triangles {
            if triangle.plane == best {
                along |= triangle.along;
                against |= !triangle.along;
            } else {
                split(&triangle, plane, near, &mut front, &mut back);
            }
        }
        // With faces both ways in one plane and none on a side, the side is neither.
        if along && against && (front.is_empty() || back.is_empty()) {
            return Err(Unsound::Crossing);
        }
        let side = |inside: bool| {
            Task::Part(Piece::Side {
                plane: best,
                inside,
            })
        };
        let open = |union: bool| Task::Part(Piece::Open { union });
        let close = || Task::Part(Piece::Close);
        // A side without faces is outside before a face, and inside behind it.
        match (front.is_empty(), back.is_empty()) {
            (true, true) => tasks.push(side(along)),
            (true, false) => {
                let cell = Task::Cell(back);
                tasks.extend([close(), cell, side(along), open(!along)]);
            }
            (false, true) => {
                let cell = Task::Cell(front);
                tasks.extend([close(), cell, side(along), open(along)]);
            }
            (false, false) => tasks.extend([
                close(),
                close(),
                Task::Cell(front),
                side(false),
                open(false),
                close(),
                Task::Cell(back),
                side(true),
                open(false),
                open(true),
            ]),
        }
    }
    Ok(pieces)
}

/// An axis-parallel plane with about half of the faces on each side; `None` if none has fewer
/// than most of them on both.
fn across_the_middle(triangles: &[Triangle], near: f64) -> Option<Plane> {
    let low = |t: &Triangle| t.corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = |t: &Triangle| {
        t.corners
            .iter()
            .copied()
            .fold(DVec3::NEG_INFINITY, DVec3::max)
    };
    let mut best: Option<(usize, Plane)> = None;
    for (axis, normal) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        let mut middles: Vec<f64> = triangles
            .iter()
            .map(|t| 0.5 * (low(t)[axis] + high(t)[axis]))
            .collect();
        let half = middles.len() / 2;
        let (_, middle, _) = middles.select_nth_unstable_by(half, f64::total_cmp);
        // Beside the vertices, of which many may lie in a plane.
        let offset = *middle + 7.3 * near;
        let reaches = |t: &&Triangle| high(t)[axis] > offset + near;
        let starts = |t: &&Triangle| low(t)[axis] < offset - near;
        let above = triangles.iter().filter(reaches).count();
        let below = triangles.iter().filter(starts).count();
        let larger = above.max(below);
        if above.min(below) > 0 && best.is_none_or(|(least, _)| larger < least) {
            best = Some((larger, Plane { normal, offset }));
        }
    }
    let (larger, plane) = best?;
    (larger * 5 < triangles.len() * 4).then_some(plane)
}

/// The plane that splits few faces, and best one with all faces on one side.
fn choose(triangles: &[Triangle], planes: &[Plane], near: f64) -> Option<usize> {
    let step = triangles.len().div_ceil(CANDIDATES).max(1);
    let candidates = triangles.iter().step_by(step).map(|t| t.plane);
    candidates.min_by_key(|&at| {
        let Some(plane) = planes.get(at) else {
            return usize::MAX;
        };
        let (mut front, mut back, mut both) = (0_usize, 0_usize, 0_usize);
        for triangle in triangles.iter().filter(|t| t.plane != at) {
            let away = triangle.corners.map(|p| plane.normal.dot(p) - plane.offset);
            let before = away.iter().any(|d| *d > near);
            let behind = away.iter().any(|d| *d < -near);
            match (before, behind) {
                (true, true) => both += 1,
                (true, false) => front += 1,
                _ => back += 1,
            }
        }
        if both == 0 && (front == 0 || back == 0) {
            return 0;
        }
        8 * both + front.abs_diff(back) + 1
    })
}

/// Adds the parts of a triangle before and behind a plane.
fn split(
    triangle: &Triangle,
    plane: &Plane,
    near: f64,
    front: &mut Vec<Triangle>,
    back: &mut Vec<Triangle>,
) {
    let away = triangle.corners.map(|p| plane.normal.dot(p) - plane.offset);
    let before = away.iter().any(|d| *d > near);
    let behind = away.iter().any(|d| *d < -near);
    match (before, behind) {
        (true, false) => front.push(*triangle),
        (false, true) => back.push(*triangle),
        // In the plane but not of it: it belongs to both sides' worlds and decides neither.
        (false, false) => {}
        (true, true) => {
            for (sign, list) in [(1.0, front), (-1.0, back)] {
                let part = clip(triangle.corners, away.map(|d| sign * d), near);
                let Some((&first, rest)) = part.split_first() else {
                    continue;
                };
                list.extend(rest.windows(2).filter_map(|w| match *w {
                    [a, b] => Some(Triangle {
                        corners: [first, a, b],
                        ..*triangle
                    }),
                    _ => None,
                }));
            }
        }
    }
}

/// The part of a triangle where the distances of its corners are positive.
fn clip(corners: [DVec3; 3], away: [f64; 3], near: f64) -> Vec<DVec3> {
    let next = [1, 2, 0];
    let mut part = Vec::with_capacity(4);
    for ((&a, &d), n) in corners.iter().zip(&away).zip(next) {
        let (b, e) = match (corners.get(n), away.get(n)) {
            (Some(&b), Some(&e)) => (b, e),
            _ => (a, d),
        };
        if d >= -near {
            part.push(a);
        }
        if (d > near && e < -near) || (d < -near && e > near) {
            part.push(a + (b - a) * (d / (d - e)));
        }
    }
    part
}

/// Whether the formula holds a point.
fn contains(pieces: &[Piece], planes: &[Plane], point: DVec3) -> bool {
    let mut open = vec![(true, false)];
    for piece in pieces {
        let value = match *piece {
            Piece::Open { union } => {
                open.push((union, !union));
                continue;
            }
            Piece::Close => open.pop().is_some_and(|(_, value)| value),
            Piece::Side { plane, inside } => planes
                .get(plane)
                .is_some_and(|p| (p.normal.dot(point) <= p.offset) == inside),
        };
        if let Some((union, all)) = open.last_mut() {
            *all = if *union { *all || value } else { *all && value };
        }
    }
    open.pop().is_some_and(|(_, value)| value)
}

/// Whether the formula is false just before each face and true just behind, which it is not
/// when faces cross.
pub(super) fn is_bounded_by(pieces: &[Piece], faces: &Faces) -> bool {
    let height = 20.0 * NEAR * faces.size;
    // Checking all of many faces would take quadratic time.
    let step = (faces.triangles.len() * pieces.len() / 50_000_000).max(1);
    let mut seen = faces.triangles.iter().step_by(step).filter(|t| {
        let [a, b, c] = t.corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        // Slivers have no room for the two points.
        (b - a).cross(c - a).length() > 20.0 * height * longest
    });
    seen.all(|triangle| {
        let [a, b, c] = triangle.corners;
        let center = (a + b + c) / 3.0;
        let up = (b - a).cross(c - a).normalize_or_zero() * height;
        contains(pieces, &faces.planes, center - up)
            && !contains(pieces, &faces.planes, center + up)
    })
}
