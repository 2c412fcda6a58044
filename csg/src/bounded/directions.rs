//! Extents of one set in many directions, from a table of a few hundred.
//!
//! A support function is sublinear: if d = Σ λᵢ dᵢ with λᵢ ≥ 0 then h(d) ≤ Σ λᵢ h(dᵢ). The
//! directions dᵢ are the points with integer coordinates on the octahedron |x| + |y| + |z| = n;
//! any direction lies in one of its small triangles. They are searched when first needed.

use glam::DVec3;
use rustc_hash::FxHashMap;
use std::cell::RefCell;

/// Steps along an edge of the octahedron: the polyhedron of these directions around a ball of
/// radius 1 has its vertices within 1.02.
const STEPS: i32 = 8;

/// Known extents by direction.
#[derive(Default)]
pub(super) struct DirectionTable {
    /// By the bits of the coordinates, which are whole numbers.
    known: RefCell<FxHashMap<[u64; 3], f64>>,
}

impl DirectionTable {
    /// An upper bound of the support function in a direction, given a way to find it for others.
    pub(super) fn support(&self, direction: DVec3, search: impl Fn(DVec3) -> f64) -> f64 {
        let size = direction.abs().element_sum() / f64::from(STEPS);
        let at = direction.abs() / size;
        let signs = direction.signum();
        let floor = at.floor();
        let part = at - floor;
        let mut bound = 0.0;
        let missing = f64::from(STEPS) - floor.element_sum();
        for (axis, weight) in part.to_array().into_iter().enumerate() {
            let (vertex, weight) = if missing < 0.5 {
                // The direction is in the table; it is added once.
                (floor, if axis == 0 { 1.0 } else { 0.0 })
            } else if missing < 1.5 {
                (floor + DVec3::AXES[axis], weight)
            } else {
                (floor + DVec3::ONE - DVec3::AXES[axis], 1.0 - weight)
            };
            if weight > 0.0 {
                bound += weight * self.entry(vertex * signs, &search);
            }
        }
        // Rounding of the weights, for values up to the size of the box.
        size * bound + 1e-12 * direction.abs().element_sum()
    }

    fn entry(&self, direction: DVec3, search: impl Fn(DVec3) -> f64) -> f64 {
        let mut known = self.known.borrow_mut();
        // Adding 0 turns −0 into 0.
        let key = (direction + DVec3::ZERO).to_array().map(f64::to_bits);
        *known.entry(key).or_insert_with(|| search(direction))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_ball_is_enclosed_closely(d in proptest::array::uniform3(-1.0..1.0)) {
            let d = DVec3::from(d);
            prop_assume!(d.length() > 1e-3);
            let found = DirectionTable::default().support(d, DVec3::length);
            prop_assert!(found >= d.length());
            prop_assert!(found <= 1.02 * d.length());
        }

        #[test]
        fn a_point_is_enclosed_exactly(d in proptest::array::uniform3(-1.0..1.0)) {
            let (d, point) = (DVec3::from(d), DVec3::new(0.3, -0.9, 0.5));
            prop_assume!(d.length() > 1e-3);
            let found = DirectionTable::default().support(d, |d| d.dot(point));
            prop_assert!((found - d.dot(point)).abs() < 1e-11);
        }
    }
}
