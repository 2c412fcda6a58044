//! Where periodic surfaces begin.
//!
//! Faces in STEP need no seam, but readers that cut surfaces open where their angle jumps want no edge to
//! end or to run there.

use brep::{ExactBrep, ExactFace};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Points on an edge at which its angle is taken.
const SAMPLES: usize = 32;
/// Widest angle, in radians, that may lie between two of them.
const STEP: f64 = 0.25;

/// A direction perpendicular to the axis in which the face is not, or in which at least none of
/// its edges ends, as far from them as can be.
pub(super) fn direction(exact: &ExactBrep, face: &ExactFace, origin: DVec3, axis: DVec3) -> DVec3 {
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let angle = |point: DVec3| {
        let from = point - origin;
        from.dot(y).atan2(from.dot(x))
    };
    let (mut all, mut ends) = (Vec::new(), Vec::new());
    for half_edge in face.loops.iter().flatten() {
        let piece = &exact.edges[half_edge / 2].piece;
        let [from, to] = piece.range;
        let points = (0..=SAMPLES).map(|k| {
            let t = from + (to - from) * (k as f64 / SAMPLES as f64);
            angle(piece.curve.point(t))
        });
        all.extend(points);
        ends.extend(piece.ends.map(angle));
    }
    let outside = widest_gap(&mut all).filter(|&(_, width)| width > STEP);
    let (middle, _) = outside
        .or_else(|| widest_gap(&mut ends))
        .unwrap_or((0.0, TAU));
    (x * middle.cos() + y * middle.sin()).normalize_or(x)
}

/// The middle of the widest gap between angles, and its width.
fn widest_gap(angles: &mut Vec<f64>) -> Option<(f64, f64)> {
    angles.sort_unstable_by(f64::total_cmp);
    let first = *angles.first()?;
    angles.push(first + TAU);
    let gaps = angles.windows(2).map(|pair| (pair[0], pair[1] - pair[0]));
    // The first one of equal gaps, so that rounding does not choose.
    let widest = gaps.fold(
        (first, 0.0),
        |best: (f64, f64), gap| {
            if gap.1 > best.1 + 1e-9 { gap } else { best }
        },
    );
    let middle = widest.0 + 0.5 * widest.1;
    Some((if middle > PI { middle - TAU } else { middle }, widest.1))
}
