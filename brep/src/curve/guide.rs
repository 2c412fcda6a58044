//! The mesh's chain, put onto the curve.
//!
//! Vertices of a subdivision are not all on the true surfaces, and may then be farther off than
//! the mesh is fine. What is read off a chain – direction, sweep, shape – is read off its image
//! on the curve.

use super::Chain;
use super::meet::Meet;
use glam::DVec3;

/// How far a point may be moved, in lengths of the longest mesh edge.
pub(super) const REACH: f64 = 4.0;

impl Chain {
    /// Moves all points but the ends onto the surfaces. Left out are those that would lead back
    /// and those that find no way onto the surfaces: how many the latter are is returned.
    pub(super) fn settle(&mut self, meet: Meet<'_>) -> usize {
        let last = self.points.len() - 1;
        let reach = REACH * self.reach.iter().copied().fold(0.0, f64::max);
        let mut unsolved = 0;
        let mut on_curve = Vec::with_capacity(last + 1);
        on_curve.push((self.points[0], self.reach[0]));
        for at in 1..last {
            match meet.solve(self.points[at], reach) {
                Some(point) => on_curve.push((point, self.reach[at])),
                None => unsolved += 1,
            }
        }
        on_curve.push((self.points[last], self.reach[last]));

        let with_tangents = along_tangents(meet, &on_curve);
        let leads_on = |from: DVec3, to: DVec3, raw: DVec3| {
            let way = to - from;
            match meet.direction(from.midpoint(to)) {
                Some(tangent) if with_tangents != 0.0 => way.dot(tangent) * with_tangents > 0.0,
                _ => way.dot(raw) > 0.0,
            }
        };
        let end = on_curve.len() - 1;
        let mut kept = vec![on_curve[0]];
        for at in 1..end {
            let raw = on_curve[at + 1].0 - on_curve[at - 1].0;
            if leads_on(kept[kept.len() - 1].0, on_curve[at].0, raw) {
                kept.push(on_curve[at]);
            }
        }
        while kept.len() > 1
            && !leads_on(
                kept[kept.len() - 1].0,
                on_curve[end].0,
                on_curve[end].0 - on_curve[end - 1].0,
            )
        {
            kept.pop();
        }
        kept.push(on_curve[end]);
        (self.points, self.reach) = kept.into_iter().unzip();
        unsolved
    }
}

/// Whether a chain runs with the cross product of its surfaces' normals (positive) or against it
/// (negative). Between two points where the surfaces touch it does not change.
fn along_tangents(meet: Meet<'_>, points: &[(DVec3, f64)]) -> f64 {
    points
        .windows(2)
        .filter_map(|pair| {
            let [(from, _), (to, _)] = [pair[0], pair[1]];
            Some((to - from).dot(meet.direction(from.midpoint(to))?))
        })
        .sum()
}
