//! Which midpoints an adaptive conforming subdivision needs: the closure of inserted points.
//!
//! Bisecting at m is legal only when every tetrahedron around the refinement edge has it as its
//! own refinement edge. That is so exactly when the tetrahedra's parents were bisected, at
//! points that can be read off the coordinates of m: let s be the lowest bit set in any of them.
//!
//! * Three coordinates have bit s: m is the centre of a cube (parent type 0). Its cube is one
//!   octant of a bigger one; needed are the midpoints of the bigger cube's three edges that
//!   touch the octant. The root's centre needs nothing.
//! * Two have it: m is the centre of a face; needed are the centres of the two cubes beside it.
//! * One has it: m is the middle of a cube's edge; needed are the four face centres around it.
//!
//! Points outside the domain excepted. So a subdivision *is* a set of points closed under this
//! rule, and a traversal splits a simplex exactly when its midpoint is in the set.

use crate::lattice::{LATTICE_BITS, Point};
use rustc_hash::FxHashSet;

/// The points that must be inserted before `m`; at most four.
#[must_use]
pub(crate) fn prerequisites(m: Point) -> arrayvec::ArrayVec<Point, 4> {
    let c = m.coordinates();
    let s = (c[0] | c[1] | c[2]).trailing_zeros();
    let half = 1u32 << s;
    let has = c.map(|x| x >> s & 1 == 1);
    let mut needed = arrayvec::ArrayVec::new();
    let shifted = |axis: usize, up: bool| {
        let mut d = c;
        d[axis] = if up {
            c[axis] + half
        } else {
            c[axis].checked_sub(half)?
        };
        (d[axis] <= 1 << LATTICE_BITS).then(|| Point::new(d))
    };
    match has.iter().filter(|h| **h).count() {
        3 if s + 1 == LATTICE_BITS => {}
        3 => {
            // Of m ± half on each axis one is an odd multiple of 2·half, one an even multiple.
            let odd = c.map(|x| {
                if (x + half) >> (s + 1) & 1 == 1 {
                    x + half
                } else {
                    x - half
                }
            });
            let even = [0, 1, 2].map(|axis| 2 * c[axis] - odd[axis]);
            for axis in 0..3 {
                let mut d = even;
                d[axis] = odd[axis];
                needed.push(Point::new(d));
            }
        }
        _ => {
            for axis in (0..3).filter(|axis| !has[*axis]) {
                needed.extend([false, true].into_iter().filter_map(|up| shifted(axis, up)));
            }
        }
    }
    needed
}

/// Closes a set of midpoints under [`prerequisites`]; calls `new` with each point that it lacked.
pub(crate) fn close(
    points: &mut FxHashSet<Point>,
    inserted: Vec<Point>,
    mut new: impl FnMut(Point),
) {
    let mut pending = inserted;
    while let Some(point) = pending.pop() {
        if points.insert(point) {
            new(point);
            pending.extend(
                prerequisites(point)
                    .into_iter()
                    .filter(|p| !points.contains(p)),
            );
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simplex::Simplex;
    use proptest::prelude::*;
    use rustc_hash::FxHashSet;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]

        /// After random refinements no leaf has a vertex of the subdivision in the middle of one
        /// of its edges.
        #[test]
        fn no_hanging_midpoint(walks in proptest::collection::vec((0usize..6, any::<u32>(), 1u8..26), 1..40)) {
            let mut wanted = Vec::new();
            for (root, turns, depth) in walks {
                let mut simplex = Simplex::roots()[root];
                for level in 0..depth {
                    wanted.push(simplex.midpoint());
                    simplex = simplex.children()[(turns >> level & 1) as usize];
                }
            }
            let mut set = FxHashSet::default();
            close(&mut set, wanted, |_| {});
            let mut open: Vec<Simplex> = Simplex::roots().into();
            let mut reached = FxHashSet::default();
            while let Some(simplex) = open.pop() {
                if set.contains(&simplex.midpoint()) {
                    reached.insert(simplex.midpoint());
                    open.extend(simplex.children());
                    continue;
                }
                for a in 0..4 {
                    for b in a + 1..4 {
                        let middle = simplex.vertices[a].midpoint(simplex.vertices[b]);
                        prop_assert!(!set.contains(&middle), "{simplex:?}");
                    }
                }
            }
            // The closure is no larger than needed to reach its points.
            prop_assert_eq!(reached.len(), set.len());
        }
    }
}
