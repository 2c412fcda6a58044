//! Bounding box of an intersection of a few half-spaces in general position.

use crate::Aabb;
use glam::{DMat3, DVec3};

/// More planes than this are left to the general proof: the enumeration is O(n⁴).
const MOST_PLANES: usize = 24;

/// A direction whose sine to all planes is below this counts as leading to infinity. Needles
/// that this mistakes for unbounded are left to the general proof.
const MARGIN: f64 = 1e-3;

/// Box of the points with `normal · x ≤ offset` for all (normal, offset); infinite when they are
/// not clearly bounded. Points within rounding of a plane count as inside.
pub(crate) fn of_half_spaces(planes: &[(DVec3, f64)]) -> Aabb {
    let planes: Vec<(DVec3, f64)> = planes
        .iter()
        .filter_map(|&(normal, offset)| {
            let length = normal.length();
            let unit = (normal / length, offset / length);
            (unit.0.is_finite() && unit.1.is_finite()).then_some(unit)
        })
        .collect();
    if planes.len() > MOST_PLANES || !is_bounded(&planes) {
        return Aabb::EVERYWHERE;
    }
    let size = planes.iter().fold(0.0_f64, |m, p| m.max(p.1.abs()));
    let mut bounds = Aabb::EMPTY;
    for (i, &(a, p)) in planes.iter().enumerate() {
        for (j, &(b, q)) in planes.iter().enumerate().skip(i + 1) {
            for &(c, r) in &planes[j + 1..] {
                let matrix = DMat3::from_cols(a, b, c).transpose();
                let determinant = matrix.determinant();
                if determinant.abs() < 1e-9 {
                    continue;
                }
                let vertex = matrix.inverse() * DVec3::new(p, q, r);
                let slack = 1e-13 / determinant.abs() * (size + vertex.length());
                if planes.iter().all(|(n, o)| n.dot(vertex) <= o + slack) {
                    bounds.min = bounds.min.min(vertex);
                    bounds.max = bounds.max.max(vertex);
                }
            }
        }
    }
    bounds
}

/// Whether no direction leads to infinity: the extreme ones lie in two of the planes.
fn is_bounded(planes: &[(DVec3, f64)]) -> bool {
    let leads_away = |d: DVec3| planes.iter().all(|(n, _)| n.dot(d) <= MARGIN);
    let mut lines = 0;
    for (i, (a, _)) in planes.iter().enumerate() {
        for (b, _) in &planes[i + 1..] {
            let Some(d) = a.cross(*b).try_normalize() else {
                continue;
            };
            if a.cross(*b).length() < MARGIN {
                continue;
            }
            lines += 1;
            if leads_away(d) || leads_away(-d) {
                return false;
            }
        }
    }
    lines > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_simplex_is_bounded_and_a_wedge_is_not() {
        let corner = [(-DVec3::X, 0.0), (-DVec3::Y, 0.0), (-DVec3::Z, 0.0)];
        assert!(!of_half_spaces(&corner).is_finite());
        let mut simplex = corner.to_vec();
        simplex.push((DVec3::new(1.0, 2.0, 4.0), 4.0));
        let bounds = of_half_spaces(&simplex);
        assert!(bounds.min.abs_diff_eq(DVec3::ZERO, 1e-12));
        assert!(bounds.max.abs_diff_eq(DVec3::new(4.0, 2.0, 1.0), 1e-12));
    }

    proptest! {
        /// Planes tangent to a ball: it lies in the box, which touches all feasible samples.
        #[test]
        fn feasible_points_lie_inside(
            normals in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0), 4..10),
            samples in proptest::collection::vec(proptest::array::uniform3(-5.0..5.0), 50),
        ) {
            let normals: Vec<DVec3> = normals.into_iter().map(DVec3::from).collect();
            prop_assume!(normals.iter().all(|n| n.length() > 0.1));
            let planes: Vec<_> = normals.iter().map(|n| (*n, n.length())).collect();
            let bounds = of_half_spaces(&planes);
            for s in samples.into_iter().map(DVec3::from) {
                if planes.iter().all(|(n, o)| n.dot(s) <= *o) {
                    prop_assert!(s.cmpge(bounds.min).all() && s.cmple(bounds.max).all());
                }
            }
        }
    }
}
