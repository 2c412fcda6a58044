//! Many edges as a Boolean formula that is local: each part of the plane has only the half-planes
//! of edges that pass through it.
//!
//! The formula of a whole outline (`super::chain`) names each edge once, but its lines go on
//! across the figure: the 6,000 lines of a star all pass its middle, where none of them matters.
//! So axis-parallel lines split the plane until few edges are left in each part. They bound
//! nothing, since both sides agree there, and leave no trace in the result. Within a part, lines
//! of edges split the others (binary space partition).

use super::{Curve, Part};
use glam::DVec2;

/// Parts with fewer edges are not split by axis-parallel lines.
const CROWD: usize = 16;

/// Lines of edges that are tried for each part.
const CANDIDATES: usize = 8;

/// Distance from a line within which points count as lying on it, in sizes of the figure.
const NEAR: f64 = 1e-12;

/// A directed edge, or a piece of one, with the filled side on its left.
#[derive(Clone, Copy, Debug)]
struct Edge {
    ends: [DVec2; 2],
    curve: Curve,
}

enum Task {
    Cell(Vec<Edge>),
    Part(Part),
}

/// Appends the formula of closed loops that neither touch nor cross, filled on their left.
pub(super) fn formula(loops: &[Vec<DVec2>], parts: &mut Vec<Part>) {
    let edges = loops.iter().flat_map(|one| {
        let next = one.iter().cycle().skip(1);
        one.iter().zip(next).map(|(&a, &b)| Edge {
            ends: [a, b],
            curve: Curve::left_of(a, b),
        })
    });
    let edges: Vec<Edge> = edges.collect();
    let reach = edges
        .iter()
        .flat_map(|edge| edge.ends)
        .fold(0.0_f64, |m, p| m.max(p.abs().max_element()));
    let near = NEAR * reach;
    let mut tasks = vec![Task::Cell(edges)];
    while let Some(task) = tasks.pop() {
        let edges = match task {
            Task::Part(part) => {
                parts.push(part);
                continue;
            }
            Task::Cell(edges) => edges,
        };
        let across = (edges.len() > CROWD)
            .then(|| across_the_middle(&edges, near))
            .flatten();
        let Some((line, [front, back], own)) = across.or_else(|| along_an_edge(&edges, near))
        else {
            continue;
        };
        let side = |inside: bool| {
            let curve = if inside { line } else { line.negated() };
            Task::Part(Part::Side(curve))
        };
        let open = |union: bool| Task::Part(Part::Open { union });
        let close = || Task::Part(Part::Close);
        // A side without edges is outside before an edge, and inside behind it.
        match (front.is_empty(), back.is_empty()) {
            (true, true) => tasks.push(side(own)),
            (true, false) => tasks.extend([close(), Task::Cell(back), side(own), open(!own)]),
            (false, true) => tasks.extend([close(), Task::Cell(front), side(own), open(own)]),
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
}

/// A line, the edges before and behind it, and whether its own edge, if any, turns as it does.
type Cut = (Curve, [Vec<Edge>; 2], bool);

/// An axis-parallel line with about half of the edges on each side, as far as possible from all
/// ends of edges; `None` if there is none with far fewer than all edges on either side.
fn across_the_middle(edges: &[Edge], near: f64) -> Option<Cut> {
    let mut best: Option<(usize, Curve)> = None;
    for (axis, normal) in [DVec2::X, DVec2::Y].into_iter().enumerate() {
        let mut ends: Vec<f64> = edges.iter().flat_map(|e| e.ends.map(|p| p[axis])).collect();
        ends.sort_unstable_by(f64::total_cmp);
        let Some(offset) = widest_gap(&ends, near) else {
            continue;
        };
        let reaches = |e: &&Edge| e.ends.iter().any(|p| p[axis] > offset);
        let starts = |e: &&Edge| e.ends.iter().any(|p| p[axis] < offset);
        let larger = edges
            .iter()
            .filter(reaches)
            .count()
            .max(edges.iter().filter(starts).count());
        if best.as_ref().is_none_or(|(least, _)| larger < *least) {
            let line = Curve([0.0, 0.0, 0.0, normal.x, normal.y, -offset]);
            best = Some((larger, line));
        }
    }
    let (larger, line) = best?;
    if larger * 10 > edges.len() * 9 {
        return None;
    }
    let [mut front, mut back] = [Vec::new(), Vec::new()];
    for edge in edges {
        split(edge, &line, near, &mut front, &mut back);
    }
    (!front.is_empty() && !back.is_empty()).then_some((line, [front, back], false))
}

/// The middle of the widest gap in the middle half of sorted numbers.
pub(in super::super) fn widest_gap(sorted: &[f64], near: f64) -> Option<f64> {
    let middle = sorted.get(sorted.len() / 4..sorted.len() - sorted.len() / 4)?;
    let gaps = middle.windows(2).filter_map(|pair| match *pair {
        [a, b] => Some((b - a, 0.5 * (a + b))),
        _ => None,
    });
    let widest = gaps.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (widest.0 > 8.0 * near).then_some(widest.1)
}

/// The line of the edge that splits few others.
fn along_an_edge(edges: &[Edge], near: f64) -> Option<Cut> {
    let step = edges.len().div_ceil(CANDIDATES).max(1);
    let best = edges.iter().step_by(step).min_by_key(|candidate| {
        let (mut front, mut back, mut both) = (0_usize, 0_usize, 0_usize);
        for edge in edges {
            let away = edge.ends.map(|p| candidate.curve.value(p));
            match (away[0].max(away[1]) > near, away[0].min(away[1]) < -near) {
                (true, true) => both += 1,
                (true, false) => front += 1,
                (false, true) => back += 1,
                (false, false) => {}
            }
        }
        if both == 0 && (front == 0 || back == 0) {
            return 0;
        }
        8 * both + front.abs_diff(back) + 1
    })?;
    let [mut front, mut back] = [Vec::new(), Vec::new()];
    for edge in edges {
        split(edge, &best.curve, near, &mut front, &mut back);
    }
    Some((best.curve, [front, back], true))
}

/// Adds the parts of an edge before and behind a line; one on the line belongs to neither.
fn split(edge: &Edge, line: &Curve, near: f64, front: &mut Vec<Edge>, back: &mut Vec<Edge>) {
    let [a, b] = edge.ends;
    let [da, db] = [a, b].map(|p| line.value(p));
    match (da.max(db) > near, da.min(db) < -near) {
        (true, false) => front.push(*edge),
        (false, true) => back.push(*edge),
        (false, false) => {}
        (true, true) => {
            let crossing = a + (b - a) * (da / (da - db));
            let pieces = [[a, crossing], [crossing, b]];
            let (first, second) = if da > 0.0 {
                (front, back)
            } else {
                (back, front)
            };
            for (list, ends) in [first, second].into_iter().zip(pieces) {
                list.push(Edge { ends, ..*edge });
            }
        }
    }
}
