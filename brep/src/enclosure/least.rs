//! The shortest way past several planes.

use glam::{DMat3, DVec3};

/// More planes than these are passed along the middle of their normals.
const MOST: usize = 24;

/// The shortest d with n·d ≥ r for all given unit vectors n and distances r ≥ 0; `None` if there is
/// none. (With more than [`MOST`] planes it need not be the shortest.)
///
/// It is the shortest one with equality in up to three of the conditions, so all of these are
/// tried: a vertex has few surfaces.
pub(super) fn shortest(conditions: &[(DVec3, f64)]) -> Option<DVec3> {
    let holds = |d: DVec3| {
        let length = d.length();
        d.is_finite() && (conditions.iter()).all(|&(n, r)| n.dot(d) >= r - 1e-12 * length)
    };
    if let [(n, r)] = *conditions {
        return Some(n * r);
    }
    if conditions.len() > MOST {
        return in_the_middle(conditions);
    }
    let mut best: Option<DVec3> = None;
    let mut consider = |d: DVec3| {
        if best.is_none_or(|best| d.length_squared() < best.length_squared()) && holds(d) {
            best = Some(d);
        }
    };
    for (i, &(n, r)) in conditions.iter().enumerate() {
        consider(n * r);
        for (j, &(m, s)) in conditions.iter().enumerate().take(i) {
            let cos = n.dot(m);
            let sin2 = 1.0 - cos * cos;
            if sin2 > 1e-8 {
                consider(((r - cos * s) * n + (s - cos * r) * m) / sin2);
            }
            for &(o, t) in conditions.iter().take(j) {
                let rows = DMat3::from_cols(n, m, o).transpose();
                if rows.determinant().abs() > 1e-6 {
                    consider(rows.inverse() * DVec3::new(r, s, t));
                }
            }
        }
    }
    best
}

fn in_the_middle(conditions: &[(DVec3, f64)]) -> Option<DVec3> {
    let sum: DVec3 = conditions.iter().map(|(n, _)| *n).sum();
    let middle = sum.try_normalize()?;
    let mut length = 0.0f64;
    for &(n, r) in conditions {
        let cos = n.dot(middle);
        if cos <= 0.01 {
            return None;
        }
        length = length.max(r / cos);
    }
    Some(middle * length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn edges_and_corners_are_passed_by_their_middles() {
        let of = |normals: &[DVec3]| {
            let conditions: Vec<_> = normals.iter().map(|&n| (n, 1.0)).collect();
            shortest(&conditions)
        };
        assert_eq!(of(&[DVec3::X]), Some(DVec3::X));
        assert_eq!(of(&[DVec3::X, DVec3::Y]), Some(DVec3::X + DVec3::Y));
        assert_eq!(of(&[DVec3::X, DVec3::Y, DVec3::Z]), Some(DVec3::ONE));
        assert_eq!(of(&[DVec3::X, DVec3::NEG_X]), None);
        // What has been passed anyway costs nothing.
        assert_eq!(
            shortest(&[(DVec3::X, 1.0), (DVec3::Y, 0.0)]),
            Some(DVec3::X)
        );
    }

    proptest! {
        /// All conditions hold, and no other point that meets them is much nearer.
        #[test]
        fn it_is_the_shortest(
            conditions in proptest::collection::vec(
                (proptest::array::uniform3(-1.0..1.0f64), 0.0..1.0f64), 1..6),
            others in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 200),
        ) {
            let conditions: Vec<(DVec3, f64)> = conditions
                .into_iter()
                .map(|(n, r)| (DVec3::from(n).normalize_or(DVec3::X), r))
                .collect();
            let found = shortest(&conditions);
            if let Some(d) = found {
                prop_assert!(conditions.iter().all(|(n, r)| n.dot(d) >= r - 1e-9 * (1.0 + d.length())));
            }
            for other in others {
                // As long as is needed in its direction.
                let u = DVec3::from(other).normalize_or(DVec3::X);
                if conditions.iter().all(|(n, _)| n.dot(u) > 0.05) {
                    let need = conditions.iter().map(|(n, r)| r / n.dot(u)).fold(0.0, f64::max);
                    prop_assert!(found.is_some_and(|d| d.length() <= need + 1e-9));
                }
            }
        }
    }
}
