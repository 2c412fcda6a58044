//! Vertices of equal position become one.

use glam::DVec3;

/// The number of the first vertex at the same position, for each vertex.
///
/// Positions are equal when all their bits are, with −0 taken as 0; only vertices of the same
/// body are joined, where body i are the vertices from `bodies[i]` (increasing) to the next
/// one's. Without bodies all vertices are one. Cost: O(n log n).
#[must_use]
pub fn join_equal(positions: &[DVec3], bodies: &[u32]) -> Vec<u32> {
    let mut first: Vec<u32> = (0..).take(positions.len()).collect();
    // Adding zero turns −0 into 0.
    let bits = |v: u32| {
        (positions[v as usize] + DVec3::ZERO)
            .to_array()
            .map(f64::to_bits)
    };
    let body = |v: u32| bodies.partition_point(|&start| start <= v);
    let mut order = first.clone();
    order.sort_unstable_by_key(|&v| (bits(v), v));
    for pair in order.windows(2) {
        let (one, other) = (pair[0], pair[1]);
        // Within one position vertices are in order, and so are their bodies.
        if bits(one) == bits(other) && body(one) == body(other) {
            first[other as usize] = first[one as usize];
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_of_one_body_are_joined() {
        let (a, b) = (DVec3::new(0.0, 1.0, 2.0), DVec3::X);
        let list = [a, b, DVec3::new(-0.0, 1.0, 2.0), b, a];
        assert_eq!(join_equal(&list, &[]), [0, 1, 0, 1, 0]);
        assert_eq!(join_equal(&list, &[0, 2]), [0, 1, 2, 3, 2]);
        let near = [a, a * (1.0 + f64::EPSILON)];
        assert_eq!(join_equal(&near, &[]), [0, 1]);
    }
}
