//! Convex hulls of discs and points.
//!
//! The hull of discs is the union of the discs and of the polygon between the points where
//! their common tangents touch them, so its boundary is straight lines and true arcs.

use super::chain::hull;
use super::loops::chords;
use super::{Figure, FigureId, Figures, Outline, Region};
use glam::{DAffine2, DVec2};

/// Discs of one hull, at most: pairs of them are compared with all.
const MAX_DISCS: usize = 200;

/// Two factors of a map this close, relatively, leave circles round.
const ROUND: f64 = 1e-5;

impl Figures {
    /// The convex hull of a figure, and whether it is exact; arcs are replaced by chords where
    /// circles are cut or stretched.
    pub(in super::super) fn hull(&mut self, root: FigureId) -> (Option<FigureId>, bool) {
        let (mut points, mut discs) = (Vec::new(), Vec::new());
        let Some(regions) = self.united_regions(root) else {
            let loops = self.loops(root);
            discs.extend(loops.all.into_iter().flatten().map(|p| (p, 0.0)));
            return (self.hull_of_discs(discs), loops.exact);
        };
        let mut exact = true;
        let sagitta = self.sagitta(root);
        for (at, region) in regions {
            match &region.outline {
                Outline::Corners { at: corners, .. } => {
                    points.extend(corners.iter().map(|c| (at.transform_point2(*c), 0.0)));
                }
                Outline::Circle(radius) => {
                    if let Some(scale) = similarity(&at) {
                        discs.push((at.translation, scale * radius));
                    } else {
                        exact = false;
                        let loops = region.loops(&at, sagitta).all;
                        points.extend(loops.into_iter().flatten().map(|p| (p, 0.0)));
                    }
                }
            }
        }
        let corners: Vec<DVec2> = points.iter().map(|p| p.0).collect();
        if !discs.is_empty() && discs.len() + hull(&corners).len() > MAX_DISCS {
            exact = false;
            for (center, radius) in std::mem::take(&mut discs) {
                let around = chords(center, radius, sagitta.max(1e-6 * radius));
                points.extend(around.into_iter().map(|p| (p, 0.0)));
            }
        }
        points.extend(discs);
        (self.hull_of_discs(points), exact)
    }

    /// The convex hull of discs and points; `None` if it has no area.
    pub(in super::super) fn hull_of_discs(&mut self, given: Vec<(DVec2, f64)>) -> Option<FigureId> {
        let (mut discs, points): (Vec<_>, Vec<_>) = given.into_iter().partition(|d| d.1 > 0.0);
        let points: Vec<DVec2> = points.into_iter().map(|d| d.0).collect();
        let corners = hull(&points);
        let corners = corners.iter().filter_map(|i| points.get(*i).copied());
        discs.extend(corners.map(|p| (p, 0.0)));
        let round = drop_covered(&mut discs);
        let touching: Vec<DVec2> = if round == 0 {
            discs.iter().map(|d| d.0).collect()
        } else {
            tangent_points(&discs)
        };
        let mut all = Vec::new();
        let polygon = if touching.len() > 2 {
            Region::polygon(&[super::convex_corners(&touching)])
        } else {
            None
        };
        all.extend(polygon.map(|p| self.add(Figure::Region(p))));
        for &(center, radius) in discs.iter().filter(|d| d.1 > 0.0) {
            let disc = self.add(Figure::Region(Region::disc(radius)));
            all.push(self.add(Figure::Moved(DAffine2::from_translation(center), disc)));
        }
        (!all.is_empty()).then(|| self.union(all))
    }
}

/// The factor of a map that leaves circles round.
pub(super) fn similarity(at: &DAffine2) -> Option<f64> {
    let (x, y) = (at.matrix2.x_axis, at.matrix2.y_axis);
    let scale = x.length();
    let is_round =
        (y.length() - scale).abs() <= ROUND * scale && x.dot(y).abs() <= ROUND * scale * scale;
    is_round.then_some(scale)
}

/// Removes discs that lie in others; the number of true discs left.
fn drop_covered(discs: &mut Vec<(DVec2, f64)>) -> usize {
    discs.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut kept: Vec<(DVec2, f64)> = Vec::new();
    let mut round = 0;
    for &(center, radius) in discs.iter() {
        let covers = |d: &(DVec2, f64)| {
            let slack = 1e-12 * (d.1 + center.abs().max_element());
            center.distance(d.0) + radius <= d.1 + slack
        };
        if !kept.iter().take(round).any(covers) {
            kept.push((center, radius));
            round += usize::from(radius > 0.0);
        }
    }
    *discs = kept;
    round
}

/// Where the lines that have all discs on one side and touch two of them do so.
fn tangent_points(discs: &[(DVec2, f64)]) -> Vec<DVec2> {
    let size = discs
        .iter()
        .fold(0.0_f64, |m, d| m.max(d.0.abs().max_element() + d.1));
    let mut points = Vec::new();
    for (i, a) in discs.iter().enumerate() {
        for (j, b) in discs.iter().enumerate() {
            let gap = b.0 - a.0;
            let length = gap.length();
            if i == j || length <= (a.1 - b.1).abs() {
                continue;
            }
            // The outward normal n of the tangent to the right of a → b has
            // n · gap = r_a − r_b.
            let along = gap / length;
            let cosine = (a.1 - b.1) / length;
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            let n = along * cosine - along.perp() * sine;
            let reach = n.dot(a.0) + a.1;
            let is_outermost = discs
                .iter()
                .all(|d| n.dot(d.0) + d.1 <= reach + 1e-12 * size);
            if is_outermost {
                points.extend([a.0 + n * a.1, b.0 + n * b.1]);
            }
        }
    }
    points
}
