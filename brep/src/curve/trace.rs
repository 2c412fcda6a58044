//! Curves without a closed form, as points on both surfaces.

use super::meet::Meet;
use glam::DVec3;

/// Halvings of a chord: 2¹² points between two of the mesh.
const DEPTH: usize = 12;

/// The curve through these points of it, with as few of them as the chord error needs, and more
/// where they do not suffice.
pub(super) fn at(meet: Meet<'_>, points: &[DVec3], chord_error: f64) -> Vec<DVec3> {
    let fine = refined(meet, points, chord_error);
    thinned(&fine, chord_error)
}

fn refined(meet: Meet<'_>, points: &[DVec3], chord_error: f64) -> Vec<DVec3> {
    // Thinning spends the error again: half of it for each.
    let allowed = 0.5 * chord_error;
    let mut fine = vec![points[0]];
    let mut stack = Vec::new();
    for pair in points.windows(2) {
        stack.push((pair[0], pair[1], 0));
        while let Some((from, to, depth)) = stack.pop() {
            match middle(meet, from, to, allowed) {
                Some(middle) if depth < DEPTH => {
                    stack.push((middle, to, depth + 1));
                    stack.push((from, middle, depth + 1));
                }
                _ => fine.push(to),
            }
        }
    }
    fine
}

/// The point of the curve in the middle of a chord, if the chord is too far from the curve.
fn middle(meet: Meet<'_>, from: DVec3, to: DVec3, allowed: f64) -> Option<DVec3> {
    let length = from.distance(to);
    let chord = from.midpoint(to);
    let middle = meet.solve(chord, 0.5 * length)?;
    let forward = (to - from).normalize_or_zero();
    // A sagitta is a quarter of the length times the tangent of the angle at an end; S-shaped
    // pieces show only there.
    let slope = |at: DVec3| {
        let direction = meet.direction(at);
        direction.map_or(0.0, |d| 0.25 * length * d.cross(forward).length())
    };
    let sagitta = middle.distance(chord).max(slope(from)).max(slope(to));
    (sagitta > allowed).then_some(middle)
}

/// Douglas and Peucker's choice of points.
fn thinned(fine: &[DVec3], chord_error: f64) -> Vec<DVec3> {
    let allowed = 0.5 * chord_error;
    let last = fine.len() - 1;
    let mut kept = vec![fine[0]];
    let mut stack = Vec::new();
    // The chord of a closed curve has no length: split it before.
    if fine[0] == fine[last] && last > 1 {
        stack.push((last / 2, last));
        stack.push((0, last / 2));
    } else {
        stack.push((0, last));
    }
    while let Some((from, to)) = stack.pop() {
        let chord = fine[to] - fine[from];
        let square = chord.length_squared();
        let distance = |at: usize| {
            let part = ((fine[at] - fine[from]).dot(chord) / square).clamp(0.0, 1.0);
            let part = if part.is_finite() { part } else { 0.0 };
            fine[at].distance(fine[from] + chord * part)
        };
        let farthest = (from + 1..to)
            .map(|at| (distance(at), at))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match farthest {
            Some((distance, at)) if distance > allowed => {
                stack.push((at, to));
                stack.push((from, at));
            }
            _ => kept.push(fine[to]),
        }
    }
    kept
}
