//! B-Rep edges: points on both true surfaces, spaced evenly by what their chords deviate.

use super::sheet::{Sheet, project_on_both};
use glam::DVec3;

/// Bisections of one mesh edge, at most.
const DEPTH: u32 = 24;

/// A point to be put onto a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// Which of the chain's mesh edges it lies above.
    pub(super) segment: usize,
    /// Where.
    pub(super) position: DVec3,
}

/// A piece of the curve, nearly straight.
#[derive(Clone, Copy)]
struct Piece {
    segment: usize,
    ends: [DVec3; 2],
    /// Square root of its deviation in units of the tolerance: adds up along a curve, since the
    /// deviation of a chord grows with the square of its length.
    cost: f64,
}

/// Inner points for a chain of vertices on the curve where two surfaces meet, so that each
/// chord deviates by at most `tolerance`: as few as possible, and evenly.
///
/// `points` are the chain's vertices; a closed chain repeats the first one at the end. The first
/// and the last one stay where they are. `None` if the curve cannot be followed: the surfaces are
/// tangent.
pub(super) fn resample(
    sheets: [&Sheet<'_>; 2],
    points: &[DVec3],
    is_closed: bool,
    tolerance: f64,
    rounding: f64,
) -> Option<Vec<Target>> {
    let guide = guide(sheets, points, rounding)?;
    let mut pieces = Vec::with_capacity(2 * guide.len());
    for pair in guide.windows(2) {
        let [(segment, from), (_, to)] = [pair[0], pair[1]];
        refine(
            sheets,
            segment,
            [from, to],
            tolerance,
            rounding,
            &mut pieces,
        )?;
    }
    let total: f64 = pieces.iter().map(|piece| piece.cost).sum();
    // A loop without area would be none; straight edges need no points at all.
    let least = if is_closed { 3.0 } else { 1.0 };
    let count = (total - 1e-9).ceil().max(least);
    let mut targets = Vec::new();
    let mut passed = 0.0;
    let mut wanted = total / count;
    for piece in pieces {
        while wanted < passed + piece.cost && (targets.len() as f64) < count - 1.0 {
            let at = (wanted - passed) / piece.cost;
            let guess = piece.ends[0].lerp(piece.ends[1], at);
            targets.push(Target {
                segment: piece.segment,
                position: project_on_both(sheets, guess, rounding)?,
            });
            wanted = total * (targets.len() + 1) as f64 / count;
        }
        passed += piece.cost;
    }
    Some(targets)
}

/// The chain's vertices moved onto the curve, each with its number. Those that would lead back
/// are left out: a subdivision's vertices are not all on the true surfaces.
fn guide(sheets: [&Sheet<'_>; 2], points: &[DVec3], rounding: f64) -> Option<Vec<(usize, DVec3)>> {
    let (&start, rest) = points.split_first()?;
    let (&end, inner) = rest.split_last()?;
    let mut guide = vec![(0, start)];
    let leads_on = |from: DVec3, to: DVec3, toward: DVec3| {
        let [n0, n1] = sheets.map(|sheet| sheet.at(from.midpoint(to)).1);
        let tangent = n0.cross(n1);
        (to - from).dot(tangent) * toward.dot(tangent) > 0.0
    };
    for (at, &point) in (1..).zip(inner) {
        let on_curve = project_on_both(sheets, point, rounding)?;
        let last = guide.last()?.1;
        let toward = points[at + 1] - points[at - 1];
        if leads_on(last, on_curve, toward) {
            guide.push((at, on_curve));
        }
    }
    while let Some(&(at, last)) = guide.last()
        && at > 0
        && !leads_on(last, end, end - points[at])
    {
        guide.pop();
    }
    guide.push((points.len() - 1, end));
    Some(guide)
}

/// Cuts a mesh edge until its pieces deviate by no more than the tolerance.
fn refine(
    sheets: [&Sheet<'_>; 2],
    segment: usize,
    ends: [DVec3; 2],
    tolerance: f64,
    rounding: f64,
    pieces: &mut Vec<Piece>,
) -> Option<()> {
    let mut open = vec![(ends, 0)];
    while let Some((ends, depth)) = open.pop() {
        let middle = ends[0].midpoint(ends[1]);
        let on_curve = project_on_both(sheets, middle, rounding)?;
        let deviation = on_curve.distance(middle);
        // More than half a circle, or another branch: no piece of this curve.
        if deviation > 0.6 * ends[0].distance(ends[1]) + rounding || depth > DEPTH {
            return None;
        }
        if deviation > tolerance {
            open.push(([on_curve, ends[1]], depth + 1));
            open.push(([ends[0], on_curve], depth + 1));
        } else {
            pieces.push(Piece {
                segment,
                ends,
                cost: (deviation / tolerance).sqrt(),
            });
        }
    }
    Some(())
}
