//! Complete evaluation of a regular triangulation (MAC, Algorithms 2.1 and 2.2).

use super::signs::{Judge, value};
use super::{Found, Pattern};
use crate::lattice::{LATTICE_BITS, Point};
use csg::Solid;

/// What the complete evaluation did.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Complete {
    /// What it found.
    pub found: Found,
    /// Simplices looked at.
    pub simplices: u64,
    /// Primitives times simplices, as the thesis counts: 6·2ⁿ·P at level n.
    pub evaluations: u64,
    /// Polynomial values taken when each vertex is evaluated once.
    pub values: u64,
}

/// Looks at all simplices of a grid of `2^halvings` cubes a side (bisection level 3·`halvings`);
/// `halvings` at most 8.
#[must_use]
pub fn complete(solid: &Solid, halvings: u8, pattern: Pattern) -> Complete {
    let halvings = halvings.min(8);
    let side = 1u32 << halvings;
    let vertices = Vertices::new(solid, halvings);
    let primitives = solid.primitives.len();
    let mut judge = Judge::new(primitives);
    let mut done = Complete {
        values: (u64::from(side) + 1).pow(3) * primitives as u64,
        ..Complete::default()
    };
    for at in 0..side.pow(3) {
        let cube = [at % side, at / side % side, at / side / side];
        for tetrahedron in pattern.tetrahedra(cube) {
            done.simplices += 1;
            let corners = tetrahedron.map(|v| vertices.inside(v));
            for primitive in 0..primitives {
                let inside = corners.iter().filter(|c| bit(c, primitive)).count();
                judge.note(primitive, value(inside, 4));
            }
            let left = judge.undecided(solid.formula.nodes());
            if left > 0 {
                let shift = LATTICE_BITS - u32::from(halvings);
                let mut cell = tetrahedron.map(|v| v.map(|c| c << shift));
                cell.sort_unstable();
                done.found.cells.push(cell);
                done.found.optimal_evaluations += left;
            }
        }
    }
    done.evaluations = done.simplices * primitives as u64;
    done.found = done.found.sorted();
    done
}

/// Whether the primitives are ≤ 0 at the grid's vertices, one bit each.
struct Vertices {
    side: usize,
    words: usize,
    bits: Vec<u64>,
}

impl Vertices {
    fn new(solid: &Solid, halvings: u8) -> Self {
        let side = (1 << halvings) + 1;
        let words = solid.primitives.len().div_ceil(64);
        let mut bits = Vec::with_capacity(side * side * side * words);
        for at in 0..side * side * side {
            let vertex = [at % side, at / side % side, at / side / side];
            bits.extend(inside(solid, vertex.map(|c| c as u32), halvings));
        }
        Self { side, words, bits }
    }

    fn inside(&self, [x, y, z]: [u32; 3]) -> &[u64] {
        let at = (z as usize * self.side + y as usize) * self.side + x as usize;
        &self.bits[at * self.words..(at + 1) * self.words]
    }
}

/// Whether each primitive is ≤ 0 at a vertex of the grid, 64 to a word.
pub(super) fn inside(solid: &Solid, vertex: [u32; 3], halvings: u8) -> impl Iterator<Item = u64> {
    let shift = LATTICE_BITS - u32::from(halvings);
    let point = Point::new(vertex.map(|c| c << shift)).position();
    solid.primitives.chunks(64).map(move |chunk| {
        chunk.iter().enumerate().fold(0, |word, (at, primitive)| {
            word | u64::from(primitive.polynomial.evaluate(2.0 * point - 1.0) <= 0.0) << at
        })
    })
}

/// The bit of a primitive.
pub(super) fn bit(words: &[u64], primitive: usize) -> bool {
    words[primitive / 64] >> (primitive % 64) & 1 == 1
}
