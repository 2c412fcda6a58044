//! `offset`, `fill` and Minkowski sums of plane figures.
//!
//! A figure grown by r is the figure and all discs of radius r about its edges; shrunk, it is
//! the figure without them. Discs about an edge are the hull of two discs, so that outlines of
//! straight edges stay exact, with true arcs.

use super::disc_hull::similarity;
use super::loops::{Loops, chords};
use super::{Figure, FigureId, Figures, Outline, Region, doubled_area};
use glam::{DAffine2, DVec2};
use i_overlay::core::overlay_rule::OverlayRule;

/// Outlines with more edges are offset as polygons; each edge costs a formula.
const MOST_EXACT_EDGES: usize = 64;

/// Pairs of edges of a Minkowski sum, at most.
const MOST_PAIRS: usize = 400_000;

/// How far an outline is moved.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in super::super) enum Offset {
    /// By discs: positive ones round convex corners, negative ones concave ones.
    Round(f64),
    /// Edge by edge, corners staying pointed, or cut off at the same distance.
    Straight { delta: f64, chamfer: bool },
}

/// A figure, and whether it is exact.
pub(in super::super) type Found = (Option<FigureId>, bool);

impl Figures {
    /// The offset of a figure.
    pub(in super::super) fn offset(&mut self, root: FigureId, by: Offset) -> Found {
        match by {
            Offset::Round(0.0) | Offset::Straight { delta: 0.0, .. } => (Some(root), true),
            Offset::Round(r) if r > 0.0 => self.grown(root, r),
            Offset::Round(r) => self.shrunk(root, -r),
            Offset::Straight { delta, chamfer } => {
                let loops = self.loops(root);
                let moved = straight(&loops, delta, chamfer);
                (self.of_loops(&moved), loops.exact)
            }
        }
    }

    fn grown(&mut self, root: FigureId, r: f64) -> Found {
        let Some(regions) = self.united_regions(root) else {
            let loops = self.loops(root);
            return self.grown_loops(&loops, r);
        };
        let regions: Vec<(DAffine2, Region)> = regions
            .into_iter()
            .map(|(at, region)| (at, region.clone()))
            .collect();
        let sagitta = self.sagitta(root);
        let (mut all, mut exact) = (Vec::new(), true);
        for (at, region) in regions {
            let found = if let (Outline::Circle(radius), Some(scale)) =
                (&region.outline, similarity(&at))
            {
                (Some(self.disc(at.translation, radius * scale + r)), true)
            } else {
                let loops = region.loops(&at, sagitta);
                self.grown_loops(&loops, r)
            };
            all.extend(found.0);
            exact &= found.1;
        }
        ((!all.is_empty()).then(|| self.union(all)), exact)
    }

    fn grown_loops(&mut self, loops: &Loops, r: f64) -> Found {
        if loops.exact
            && let Some(corners) = loops.convex()
            && corners.len() <= 2 * MOST_EXACT_EDGES
        {
            let discs = corners.iter().map(|c| (*c, r)).collect();
            return (self.hull_of_discs(discs), true);
        }
        if loops.exact && loops.edge_count() <= MOST_EXACT_EDGES {
            let mut all: Vec<FigureId> = self.of_loops(loops).into_iter().collect();
            all.extend(self.about_edges(loops, r));
            return (Some(self.union(all)), true);
        }
        let sum = loops.combine(&stadiums(loops, r), OverlayRule::Union);
        (self.of_loops(&sum), false)
    }

    fn shrunk(&mut self, root: FigureId, r: f64) -> Found {
        if let Some(regions) = self.united_regions(root)
            && let [(at, region)] = regions[..]
            && let (Outline::Circle(radius), Some(scale)) = (&region.outline, similarity(&at))
        {
            let left = radius * scale - r;
            let disc = (left > 0.0).then(|| self.disc(at.translation, left));
            return (disc, true);
        }
        // What is left of A \ B is what is left of A, without B grown.
        let (at, top) = self.peeled(root);
        if let Some(Figure::Difference(all)) = self.node(top)
            && let [first, rest @ ..] = &all[..]
        {
            let (first, rest) = (*first, rest.to_vec());
            let first = self.add(Figure::Moved(at, first));
            let (body, mut exact) = match self.united_regions(first) {
                Some(regions) if regions.len() == 1 => self.shrunk(first, r),
                _ => {
                    let loops = self.loops(first);
                    self.shrunk_loops(&loops, r)
                }
            };
            let Some(body) = body else {
                return (None, exact);
            };
            let mut parts = vec![body];
            for one in rest {
                let one = self.add(Figure::Moved(at, one));
                let (grown, is_exact) = self.grown(one, r);
                parts.extend(grown);
                exact &= is_exact;
            }
            return (Some(self.add(Figure::Difference(parts))), exact);
        }
        let loops = self.loops(root);
        self.shrunk_loops(&loops, r)
    }

    fn shrunk_loops(&mut self, loops: &Loops, r: f64) -> Found {
        if let Some(corners) = loops.convex() {
            let mut left = corners.to_vec();
            for [a, b] in loops.edges() {
                left = clipped(&left, a, b, r);
            }
            let left = Loops {
                all: vec![left],
                exact: loops.exact,
            };
            return (self.of_loops(&left), loops.exact);
        }
        if loops.exact && loops.edge_count() <= MOST_EXACT_EDGES {
            let Some(body) = self.of_loops(loops) else {
                return (None, true);
            };
            let mut parts = vec![body];
            parts.extend(self.about_edges(loops, r));
            return (Some(self.add(Figure::Difference(parts))), true);
        }
        let rest = loops.combine(&stadiums(loops, r), OverlayRule::Difference);
        (self.of_loops(&rest), false)
    }

    /// For each edge the points within r of it.
    fn about_edges(&mut self, loops: &Loops, r: f64) -> Vec<FigureId> {
        let edges = loops.edges();
        edges
            .filter_map(|[a, b]| self.hull_of_discs(vec![(a, r), (b, r)]))
            .collect()
    }

    /// Goes down through motions and lone children.
    fn peeled(&self, root: FigureId) -> (DAffine2, FigureId) {
        let (mut at, mut id) = (DAffine2::IDENTITY, root);
        loop {
            match self.node(id) {
                Some(Figure::Moved(by, child)) => (at, id) = (at * *by, *child),
                Some(Figure::Union(all) | Figure::Intersection(all) | Figure::Difference(all))
                    if all.len() == 1 =>
                {
                    match all[..] {
                        [only] => id = only,
                        _ => return (at, id),
                    }
                }
                _ => return (at, id),
            }
        }
    }

    /// A figure with its holes filled.
    pub(in super::super) fn fill(&mut self, root: FigureId) -> Found {
        let loops = self.loops(root);
        let (filled, holes): (Vec<_>, Vec<_>) =
            (loops.all.iter().cloned()).partition(|one| doubled_area(one) > 0.0);
        if holes.is_empty() {
            return (Some(root), true);
        }
        if loops.exact {
            let filled = Loops {
                all: filled,
                exact: true,
            };
            return (self.of_loops(&filled.resolved()), true);
        }
        // Arcs stay arcs: the holes are stopped with polygons that reach into what is around.
        let stops = holes.into_iter().map(|mut hole| {
            hole.reverse();
            hole
        });
        let stops = Loops {
            all: stops.collect(),
            exact: true,
        };
        let stops = straight(&stops, 4.0 * self.sagitta(root), false);
        let all: Vec<FigureId> = [Some(root), self.of_loops(&stops)]
            .into_iter()
            .flatten()
            .collect();
        (Some(self.union(all)), true)
    }

    /// The Minkowski sum of two figures; `None` if it takes too many edges.
    pub(in super::super) fn minkowski(&mut self, a: FigureId, b: FigureId) -> Option<Found> {
        for (body, disc) in [(a, b), (b, a)] {
            if let Some(regions) = self.united_regions(disc)
                && let [(at, region)] = regions[..]
                && let (Outline::Circle(radius), Some(scale)) = (&region.outline, similarity(&at))
            {
                let (center, r) = (at.translation, radius * scale);
                let (grown, exact) = self.grown(body, r);
                let by = DAffine2::from_translation(center);
                let moved = grown.map(|grown| self.add(Figure::Moved(by, grown)));
                return Some((moved, exact));
            }
        }
        let (a, b) = (self.loops(a), self.loops(b));
        if a.edge_count() * b.edge_count() > MOST_PAIRS {
            return None;
        }
        let mut all = Vec::new();
        for (one, other) in [(&a, &b), (&b, &a)] {
            for start in other.all.iter().filter_map(|l| l.first()) {
                all.extend(
                    one.all
                        .iter()
                        .map(|l| l.iter().map(|p| *p + *start).collect()),
                );
            }
        }
        for [p, q] in a.edges() {
            for [r, s] in b.edges() {
                let mut around = vec![p + r, q + r, q + s, p + s];
                if doubled_area(&around) < 0.0 {
                    around.reverse();
                }
                all.push(around);
            }
        }
        let exact = a.exact && b.exact;
        let sum = Loops { all, exact }.resolved();
        Some((self.of_loops(&sum), exact))
    }

    fn disc(&mut self, center: DVec2, radius: f64) -> FigureId {
        let disc = self.add(Figure::Region(Region::disc(radius)));
        self.add(Figure::Moved(DAffine2::from_translation(center), disc))
    }
}

/// The part of a convex polygon at least r to the left of a line.
fn clipped(polygon: &[DVec2], a: DVec2, b: DVec2, r: f64) -> Vec<DVec2> {
    let inward = (b - a).normalize_or_zero().perp();
    let depth = |p: DVec2| inward.dot(p - a) - r;
    let mut kept = Vec::new();
    for (&p, &q) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
        let (d, e) = (depth(p), depth(q));
        if d >= 0.0 {
            kept.push(p);
        }
        if (d > 0.0 && e < 0.0) || (d < 0.0 && e > 0.0) {
            kept.push(p + (q - p) * (d / (d - e)));
        }
    }
    kept
}

/// The points within r of each edge, as polygons.
fn stadiums(loops: &Loops, r: f64) -> Loops {
    let bounds = loops.bounds();
    let sagitta = (2e-4 * (bounds.max - bounds.min).max_element()).max(1e-6 * r);
    let one = |[a, b]: [DVec2; 2]| {
        let mut points = chords(a, r, sagitta);
        points.extend(chords(b, r, sagitta));
        let ring = super::chain::hull(&points).into_iter();
        ring.filter_map(|i| points.get(i).copied()).collect()
    };
    Loops {
        all: loops.edges().map(one).collect(),
        exact: false,
    }
}

/// An outline with its edges moved; corners stay pointed or are cut off at the same distance.
fn straight(loops: &Loops, delta: f64, chamfer: bool) -> Loops {
    let d = delta.abs();
    let mut strips = Vec::new();
    for one in &loops.all {
        let n = one.len();
        let at = |i: usize| one.get(i % n).copied().unwrap_or_default();
        for i in 0..n {
            let (a, b, c) = (at(i), at(i + 1), at(i + 2));
            // Away from what is filled when growing, into it when shrinking.
            let side = |p: DVec2, q: DVec2| -(q - p).normalize_or_zero().perp() * delta.signum();
            let (m, n) = (side(a, b), side(b, c));
            strips.push(vec![a, b, b + m * d, a + m * d]);
            let opens = (b - a).perp_dot(c - b) * delta > 0.0;
            if !opens {
                continue;
            }
            let cosine = m.dot(n);
            let middle = (m + n).normalize_or_zero();
            // tan of a quarter of the turn, by which edges run on to a cut at distance d.
            let half = (0.5 * (1.0 + cosine)).max(0.0).sqrt();
            if chamfer || half < 1e-6 {
                let beyond = d * (1.0 - half) / (1.0 - half * half).max(1e-18).sqrt();
                let (u, v) = ((b - a).normalize_or_zero(), (c - b).normalize_or_zero());
                strips.push(vec![
                    b,
                    b + m * d,
                    b + m * d + u * beyond,
                    b + n * d - v * beyond,
                    b + n * d,
                ]);
            } else {
                strips.push(vec![b, b + m * d, b + middle * (d / half), b + n * d]);
            }
        }
    }
    for strip in &mut strips {
        if doubled_area(strip) < 0.0 {
            strip.reverse();
        }
    }
    let strips = Loops {
        all: strips,
        exact: true,
    };
    let rule = if delta > 0.0 {
        OverlayRule::Union
    } else {
        OverlayRule::Difference
    };
    loops.combine(&strips, rule)
}
