//! Integer points of the subdivision, packed into one word each.

use glam::DVec3;

/// Bits of a lattice coordinate at the domain's far corner.
pub(crate) const LATTICE_BITS: u32 = 20;

/// Deepest bisection level whose simplices still have lattice points as edge midpoints.
///
/// Three levels halve the cube, and level 3·19 leaves cubes of side 2.
pub const MAX_LEVEL: u8 = 3 * (LATTICE_BITS as u8 - 1);

const FIELD: u32 = 21;
const MASK: u64 = (1 << FIELD) - 1;

/// A point of the lattice: three coordinates in 0 ..= 2²⁰, x in the lowest bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(crate) struct Point(u64);

impl Point {
    /// The point with these coordinates, each in 0 ..= 2²⁰.
    #[must_use]
    pub(crate) fn new([x, y, z]: [u32; 3]) -> Self {
        debug_assert!(x.max(y).max(z) <= 1 << LATTICE_BITS);
        Self(u64::from(x) | u64::from(y) << FIELD | u64::from(z) << (2 * FIELD))
    }

    /// Its coordinates.
    #[must_use]
    pub(crate) fn coordinates(self) -> [u32; 3] {
        [
            (self.0 & MASK) as u32,
            (self.0 >> FIELD & MASK) as u32,
            (self.0 >> (2 * FIELD)) as u32,
        ]
    }

    /// The middle of two points whose coordinates have pairwise even sums.
    ///
    /// Common bits plus half the differing ones: no field overflows, and since the lowest
    /// differing bits are zero, no shifted bit crosses into the next field.
    #[must_use]
    pub(crate) fn midpoint(self, other: Self) -> Self {
        Self((self.0 & other.0) + ((self.0 ^ other.0) >> 1))
    }

    /// Position in the domain's own coordinates, [0, 1]³; exact.
    #[must_use]
    pub(crate) fn position(self) -> DVec3 {
        const SCALE: f64 = 1.0 / (1u32 << LATTICE_BITS) as f64;
        let [x, y, z] = self.coordinates();
        DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * SCALE
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn coordinates() -> impl Strategy<Value = [u32; 3]> {
        proptest::array::uniform3(0u32..=1 << LATTICE_BITS)
    }

    proptest! {
        #[test]
        fn packing_is_lossless(c in coordinates()) {
            prop_assert_eq!(Point::new(c).coordinates(), c);
        }

        #[test]
        fn midpoint_is_the_mean(a in coordinates(), b in coordinates()) {
            let b = [0, 1, 2].map(|axis| (b[axis] & !1) | (a[axis] & 1)).map(|c| c.min((1 << LATTICE_BITS) - 1));
            prop_assume!((0..3).all(|axis| (a[axis] + b[axis]) % 2 == 0));
            let mean = [0, 1, 2].map(|axis| u32::midpoint(a[axis], b[axis]));
            prop_assert_eq!(Point::new(a).midpoint(Point::new(b)).coordinates(), mean);
        }
    }
}
