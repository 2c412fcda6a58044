//! The direction that goes to the same side of several surfaces as quickly as possible.

use glam::DVec3;

/// Most steps of the search.
const STEPS: usize = 24;

/// A unit vector u with min_j u·v_j near its maximum; `None` when no u has all u·v_j positive.
///
/// Gilbert's algorithm: u is the direction of the point nearest to the origin in the convex hull
/// of the v_j, which is approached along segments to the vector that is worst off.
#[must_use]
pub(crate) fn common_direction(vectors: &[DVec3]) -> Option<DVec3> {
    let sum: DVec3 = vectors.iter().copied().sum();
    let mut point = sum / vectors.len() as f64;
    for _ in 0..STEPS {
        let length = point.length_squared();
        let worst = vectors.iter().copied();
        let worst = worst.min_by(|a, b| a.dot(point).total_cmp(&b.dot(point)))?;
        let least = worst.dot(point);
        if least >= 0.9 * length {
            break;
        }
        let step = point - worst;
        let share = step.dot(point) / step.length_squared();
        point -= step * share.clamp(0.0, 1.0);
    }
    let direction = point.try_normalize()?;
    let positive = vectors.iter().all(|v| v.dot(direction) > 0.0);
    positive.then_some(direction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn least(vectors: &[DVec3], direction: DVec3) -> f64 {
        let along = vectors.iter().map(|v| v.dot(direction));
        along.fold(f64::INFINITY, f64::min)
    }

    proptest! {
        /// No direction of a fine grid over the sphere is much better.
        #[test]
        fn nearly_the_best_direction_is_found(
            seed in proptest::collection::vec(proptest::array::uniform3(-1.0..1.0f64), 1..6),
            shift in proptest::array::uniform3(-1.0..1.0f64),
        ) {
            let vectors: Vec<DVec3> = seed
                .iter()
                .map(|v| (DVec3::from(*v) + DVec3::from(shift)).normalize_or(DVec3::X))
                .collect();
            let mut best = f64::NEG_INFINITY;
            for i in 0..60 {
                for j in 0..60 {
                    let (z, turn) = (-1.0 + f64::from(i) / 29.5, f64::from(j) * 0.104_7);
                    let r = (1.0 - z * z).max(0.0).sqrt();
                    let u = DVec3::new(r * turn.cos(), r * turn.sin(), z);
                    best = best.max(least(&vectors, u));
                }
            }
            match common_direction(&vectors) {
                Some(u) => {
                    prop_assert!(least(&vectors, u) > 0.0);
                    // Slow to converge where little is to be gained.
                    prop_assert!(best < 0.3 || least(&vectors, u) >= 0.75 * best);
                }
                None => prop_assert!(best < 0.2, "{best}"),
            }
        }
    }
}
