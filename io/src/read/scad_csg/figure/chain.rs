//! A simple polygon as a Boolean formula in which each edge's half-plane stands exactly once.
//!
//! The polygon is its convex hull without its pockets. Seen from a pocket, the polygon's side is
//! the complement of the pocket's hull without the pocket's own pockets, and so on. The lids
//! between are no half-planes of the formula: a pocket that reaches beyond its lid cuts nothing
//! off, since the hull ends there. After Dobkin, Guibas, Hershberger and Snoeyink: An efficient
//! algorithm for finding the CSG representation of a simple polygon, Algorithmica 10 (1993).

use super::{Curve, Part};
use glam::DVec2;
use robust::{Coord, orient2d};

/// The sign of the area of a triangle, exactly: positive if it is counter-clockwise.
pub(in super::super) fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// Twice the area that a closed chain encloses; positive if it is counter-clockwise.
pub(in super::super) fn doubled_area(loop_: &[DVec2]) -> f64 {
    let Some(&origin) = loop_.first() else {
        return 0.0;
    };
    let pairs = loop_.windows(2).map(|w| match *w {
        [a, b] => (a - origin).perp_dot(b - origin),
        _ => 0.0,
    });
    pairs.sum()
}

/// The strict convex hull of points, counter-clockwise, as their indices.
pub(in super::super) fn hull(points: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    let at = |i: usize| points.get(i).copied().unwrap_or_default();
    order.sort_by(|&a, &b| {
        let (a, b) = (at(a), at(b));
        a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y))
    });
    order.dedup_by(|a, b| at(*a) == at(*b));
    let half = |indices: &mut dyn Iterator<Item = usize>| {
        let mut chain: Vec<usize> = Vec::new();
        for i in indices {
            while let [.., a, b] = chain[..]
                && turn(at(a), at(b), at(i)) <= 0.0
            {
                chain.pop();
            }
            chain.push(i);
        }
        chain.pop();
        chain
    };
    if order.len() < 3 {
        return order;
    }
    let mut all = half(&mut order.iter().copied());
    all.extend(half(&mut order.iter().rev().copied()));
    all
}

/// What is still to be written.
enum Task {
    /// The chain of the vertices from `first` to `last`.
    Chain {
        first: usize,
        last: usize,
        union: bool,
    },
    /// The end of an operator.
    Close,
}

/// Appends the formula of a simple, counter-clockwise polygon; returns whether it is convex.
pub(super) fn formula(polygon: &[DVec2], parts: &mut Vec<Part>) -> bool {
    let n = polygon.len();
    let at = |i: usize| polygon.get(i % n.max(1)).copied().unwrap_or_default();
    let ring = hull(polygon);
    let Some(&start) = ring.iter().min() else {
        return false;
    };
    let is_convex = ring.len() == n;
    let mut tasks = vec![Task::Chain {
        first: start,
        last: start + n,
        union: false,
    }];
    while let Some(task) = tasks.pop() {
        let Task::Chain { first, last, union } = task else {
            parts.push(Part::Close);
            continue;
        };
        if last - first == 1 {
            parts.push(Part::Side(Curve::left_of(at(first), at(last))));
            continue;
        }
        let points: Vec<DVec2> = (first..=last).map(at).collect();
        let is_closed = last - first == n;
        let open = if is_closed {
            points.get(..n).unwrap_or_default()
        } else {
            &points[..]
        };
        let mut corners: Vec<usize> = hull(open).into_iter().map(|i| first + i).collect();
        corners.push(first);
        corners.push(last);
        corners.sort_unstable();
        corners.dedup();
        // A chain in one line has no inner corners; rounding apart there are none.
        if corners.len() == 2 {
            corners = (first..=last).collect();
        }
        parts.push(Part::Open { union });
        tasks.push(Task::Close);
        for pair in corners.windows(2).rev() {
            if let [first, last] = *pair {
                tasks.push(Task::Chain {
                    first,
                    last,
                    union: !union,
                });
            }
        }
    }
    is_convex
}

/// Turns a formula into that of the complement.
pub(super) fn complement(parts: &mut [Part]) {
    for part in parts {
        *part = match *part {
            Part::Open { union } => Part::Open { union: !union },
            Part::Close => Part::Close,
            Part::Side(curve) => Part::Side(curve.negated()),
        };
    }
}
