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

use super::super::figure::widest_gap;
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

/// Pieces that are allowed in any case: about two seconds and 200 MB.
const ALWAYS: usize = 20_000_000;

/// Planes that are tried for each cell.
const CANDIDATES: usize = 12;

/// Cells with more faces are split by axis-parallel planes.
const CROWD: usize = 16;

/// Distance from a plane within which points count as lying in it, in sizes of the polyhedron,
/// besides how far corners are from the planes of their own faces: what rounding makes of corners of
/// pieces, and room. What is dropped for lying in a plane leaves a notch this deep, and longer where
/// planes are almost parallel. It has to be the same for all planes: pieces reach this far beyond
/// those that cut them.
const NEAR: f64 = 2e-13;

/// Distance from faces at which the formula is probed, in sizes of the polyhedron.
const PROBE: f64 = 2e-9;

fn near(faces: &Faces) -> f64 {
    NEAR * faces.size + 2.0 * faces.slack
}

/// The formula of a polyhedron.
///
/// Planes that split space only are added to those of the faces.
pub(super) fn formula(faces: &mut Faces) -> Result<Vec<Piece>, Unsound> {
    enum Task {
        Cell(Vec<Triangle>),
        Part(Piece),
    }
    let near = near(faces);
    let mut left = (faces.triangles.len() * MOST_PIECES).max(ALWAYS);
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
        let (best, [front, back], along) = if let Some((plane, sides)) = across {
            faces.planes.push(plane);
            (faces.planes.len() - 1, sides, false)
        } else {
            let Some(best) = choose(&triangles, &faces.planes, near) else {
                continue;
            };
            let Some(plane) = faces.planes.get(best) else {
                continue;
            };
            let sides = sides(triangles.iter().filter(|t| t.plane != best), plane, near);
            let own = || triangles.iter().filter(|t| t.plane == best);
            let (along, against) = (own().any(|t| t.along), own().any(|t| !t.along));
            // With faces both ways in one plane and none on a side, the side is neither.
            if along && against && sides.iter().any(Vec::is_empty) {
                return Err(Unsound::Crossing);
            }
            (best, sides, along)
        };
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

/// An axis-parallel plane with about half of the faces on each side, as far as possible from all
/// vertices, and the faces before and behind it; `None` if none has far fewer than all of them
/// on both.
fn across_the_middle(triangles: &[Triangle], near: f64) -> Option<(Plane, [Vec<Triangle>; 2])> {
    let mut best: Option<(usize, Plane)> = None;
    for (axis, normal) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        let corners = triangles.iter().flat_map(|t| t.corners.map(|p| p[axis]));
        let mut corners: Vec<f64> = corners.collect();
        corners.sort_unstable_by(f64::total_cmp);
        let Some(offset) = widest_gap(&corners, near) else {
            continue;
        };
        let reaches = |t: &&Triangle| t.corners.iter().any(|p| p[axis] > offset);
        let starts = |t: &&Triangle| t.corners.iter().any(|p| p[axis] < offset);
        let above = triangles.iter().filter(reaches).count();
        let below = triangles.iter().filter(starts).count();
        let larger = above.max(below);
        if best.is_none_or(|(least, _)| larger < least) {
            best = Some((larger, Plane { normal, offset }));
        }
    }
    let (larger, plane) = best?;
    if larger * 10 > triangles.len() * 9 {
        return None;
    }
    let sides = sides(triangles.iter(), &plane, near);
    (!sides.iter().any(Vec::is_empty)).then_some((plane, sides))
}

/// The parts of triangles before and behind a plane.
fn sides<'a>(
    triangles: impl Iterator<Item = &'a Triangle>,
    plane: &Plane,
    near: f64,
) -> [Vec<Triangle>; 2] {
    let [mut front, mut back] = [Vec::new(), Vec::new()];
    for triangle in triangles {
        split(triangle, plane, near, &mut front, &mut back);
    }
    [front, back]
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

/// For each operator, where what follows it begins.
fn ends(pieces: &[Piece]) -> Vec<usize> {
    let mut ends = vec![0; pieces.len()];
    let mut open = Vec::new();
    for (at, piece) in pieces.iter().enumerate() {
        match piece {
            Piece::Open { .. } => open.push(at),
            Piece::Close => {
                if let Some(end) = open.pop().and_then(|start: usize| ends.get_mut(start)) {
                    *end = at + 1;
                }
            }
            Piece::Side { .. } => {}
        }
    }
    ends
}

/// Whether the formula holds a point. What a side decides is skipped: the time is that of
/// finding the point's part of space.
fn contains(pieces: &[Piece], ends: &[usize], planes: &[Plane], point: DVec3) -> bool {
    let mut open: Vec<(bool, bool, usize)> = Vec::new();
    let mut at = 0;
    let mut value = false;
    while let Some(piece) = pieces.get(at) {
        value = match *piece {
            Piece::Open { union } => {
                open.push((union, !union, ends.get(at).copied().unwrap_or(usize::MAX)));
                at += 1;
                continue;
            }
            Piece::Close => open.pop().is_some_and(|(_, value, _)| value),
            Piece::Side { plane, inside } => planes
                .get(plane)
                .is_some_and(|p| (p.normal.dot(point) <= p.offset) == inside),
        };
        at += 1;
        // A union is decided by what holds the point, an intersection by what does not.
        while let Some(&(union, _, end)) = open.last()
            && value == union
        {
            open.pop();
            at = end;
        }
    }
    value
}

/// Whether the formula is false just before each face and true just behind, which it is not
/// when faces cross.
pub(super) fn is_bounded_by(pieces: &[Piece], faces: &Faces) -> bool {
    let height = PROBE * faces.size + 40.0 * faces.slack;
    let ends = ends(pieces);
    let mut seen = faces.triangles.iter().filter(|t| {
        let [a, b, c] = t.corners;
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        // Slivers have no room for the two points.
        (b - a).cross(c - a).length() > 20.0 * height * longest
    });
    seen.all(|triangle| {
        let [a, b, c] = triangle.corners;
        let center = (a + b + c) / 3.0;
        let up = (b - a).cross(c - a).normalize_or_zero() * height;
        contains(pieces, &ends, &faces.planes, center - up)
            && !contains(pieces, &ends, &faces.planes, center + up)
    })
}
