//! Which sheets of the boundary meet in a vertex: the cure for XOR-like formulas and touching
//! solids.
//!
//! Around a crossing of two or three planes the solid is a set of quadrants or octants. Its
//! boundary there is a 2-manifold again when each sheet gets its own copy of the vertex: inside
//! parts belong together when they share a face; outside parts also when they meet across an
//! edge where the four quadrants are a checkerboard, since the inside is separated there. A
//! sheet is then the common boundary of one inside and one outside component.

/// Copy of a facet vertex: 0, unless inside and outside quadrants alternate; then the inside
/// quadrant `here` has a copy of its own.
///
/// Quadrants are numbered by bit 0: inside the first primitive, bit 1: inside the second.
#[must_use]
pub(crate) fn quadrant_copy(inside: [bool; 4], here: u8) -> u8 {
    let checkerboard = inside[0] == inside[3] && inside[1] == inside[2] && inside[0] != inside[1];
    if !checkerboard {
        return 0;
    }
    // Quadrants 0 and 3, or 1 and 2, are inside: the lower one is copy 0.
    u8::from(here >= 2)
}

/// The solid in the eight octants around a corner; bit b of an octant's number: inside the
/// corner's b-th primitive.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Octants {
    inside: [bool; 8],
    /// Smallest octant of each octant's component.
    component: [u8; 8],
}

impl Octants {
    /// Finds the components.
    #[must_use]
    pub(crate) fn new(inside: [bool; 8]) -> Self {
        let mut component = [0, 1, 2, 3, 4, 5, 6, 7];
        let mut join = |a: u8, b: u8| {
            let (low, high) = {
                let (x, y) = (component[usize::from(a)], component[usize::from(b)]);
                (x.min(y), x.max(y))
            };
            for c in &mut component {
                if *c == high {
                    *c = low;
                }
            }
        };
        for octant in 0..8u8 {
            for bit in [1, 2, 4] {
                if inside[usize::from(octant)] == inside[usize::from(octant ^ bit)] {
                    join(octant, octant ^ bit);
                }
                // The edge on which the two other primitives cross, on this octant's side.
                let across = octant ^ (7 ^ bit);
                let others = [1, 2, 4].into_iter().filter(|other| *other != bit);
                let checkerboard = !inside[usize::from(octant)]
                    && !inside[usize::from(across)]
                    && others
                        .into_iter()
                        .all(|other| inside[usize::from(octant ^ other)]);
                if checkerboard {
                    join(octant, across);
                }
            }
        }
        Self { inside, component }
    }

    /// Whether the boundary is more than a plane or a crease here, or a crease in which four
    /// sheets meet.
    #[must_use]
    pub(crate) fn is_corner(&self) -> bool {
        let at = |octant: u8| self.inside[usize::from(octant)];
        let straight = |bit: u8| (0..8).all(|octant| at(octant) == at(octant ^ bit));
        let alternating = |[a, b]: [u8; 2]| at(0) == at(a | b) && at(a) == at(b) && at(0) != at(a);
        [(1, [2, 4]), (2, [4, 1]), (4, [1, 2])]
            .into_iter()
            .all(|(bit, others)| !straight(bit) || alternating(others))
    }

    /// The sheet between two octants that share a face, one inside and one outside: the
    /// components that it separates.
    #[must_use]
    pub(crate) fn sheet(&self, [a, b]: [u8; 2]) -> (u8, u8) {
        let (inner, outer) = if self.inside[usize::from(a)] {
            (a, b)
        } else {
            (b, a)
        };
        (
            self.component[usize::from(inner)],
            self.component[usize::from(outer)],
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every pattern: the link of the corner, cut up by sheets, is one cycle per sheet.
    ///
    /// The link has the 12 quadrants of the three planes as edges; two of them meet on each of
    /// the six half-axes in every sheet that passes there, never four.
    #[test]
    fn every_sheet_is_a_disc() {
        for pattern in 0..=255u8 {
            let inside = [0, 1, 2, 3, 4, 5, 6, 7].map(|o| pattern >> o & 1 == 1);
            let octants = Octants::new(inside);
            // Arcs of the link between octants a and a ^ bit, with their sheets.
            let mut arcs = Vec::new();
            for a in 0..8u8 {
                for bit in [1, 2, 4] {
                    if a & bit == 0 && inside[usize::from(a)] != inside[usize::from(a ^ bit)] {
                        arcs.push((a, bit, octants.sheet([a, a ^ bit])));
                    }
                }
            }
            let mut sheets: Vec<_> = arcs.iter().map(|arc| arc.2).collect();
            sheets.sort_unstable();
            sheets.dedup();
            for sheet in sheets {
                let mine: Vec<_> = arcs.iter().filter(|arc| arc.2 == sheet).collect();
                // Walk from arc to arc, pairing at each half-axis within the inside quadrant.
                let mut reached = vec![mine[0]];
                let mut at = 0;
                while at < reached.len() {
                    let &(a, bit, _) = reached[at];
                    let inner = if inside[usize::from(a)] { a } else { a ^ bit };
                    for axis in [1u8, 2, 4].into_iter().filter(|axis| *axis != bit) {
                        // Half-axis: the other planes are crossed by `bit` and by `third`.
                        let third = 7 ^ bit ^ axis;
                        let turn = inner ^ third;
                        let (na, nbit) = if inside[usize::from(turn)] {
                            ((turn & !bit), bit)
                        } else {
                            ((inner & !third), third)
                        };
                        let found = arcs.iter().find(|arc| arc.0 == na && arc.1 == nbit);
                        let next = if let Some(arc) = found {
                            arc
                        } else {
                            // Three of the four quadrants are inside: around the outside one.
                            let a2 = (turn ^ bit) & !third;
                            arcs.iter()
                                .find(|arc| arc.0 == a2 && arc.1 == third)
                                .unwrap()
                        };
                        assert_eq!(next.2, sheet, "pattern {pattern:08b}");
                        if !reached.contains(&next) {
                            reached.push(next);
                        }
                    }
                    at += 1;
                }
                assert_eq!(reached.len(), mine.len(), "pattern {pattern:08b}");
            }
        }
    }
}
