//! The methods that the thesis compares (6.2.2), side by side on one solid and one triangulation.
//!
//! | name | what it does | function |
//! | --- | --- | --- |
//! | MAC | evaluates every primitive in every simplex (Algorithm 2.2) | [`complete`] |
//! | MAI | goes from one F-intersecting simplex to the next across bridge facets (Algorithm 2.3) | [`continuation`] |
//! | SSA | bisects what may meet the boundary (Algorithms 4.1–4.3) | [`adaptive`] |
//! | MAO | evaluates, in each F-intersecting simplex, what bounds the solid there: a count only | [`Found::optimal_evaluations`] |
//!
//! A simplex is *F-intersecting* when the signs of the primitives at its four vertices leave the
//! formula undecided; those are the simplices that get a piece of the boundary. A zero counts as
//! inside. Nothing of this is used by [`convert`](crate::convert()): it is here to be measured.

mod adaptive;
mod complete;
mod continuation;
mod cube;
mod paths;
mod reduction;
mod signs;

pub use adaptive::{Adaptive, Halt, adaptive, adaptive_reduced};
pub use complete::{Complete, complete};
pub use continuation::{Continuation, continuation};
pub use cube::{CubeCut, Pattern};
pub use paths::{Geometry, Paths};

/// The conversion to Bernstein form that Table 6.1 times: coefficients of one primitive on the six
/// root simplices.
#[must_use]
pub fn bernstein_coefficients(primitive: &csg::Primitive) -> [Vec<f64>; 6] {
    crate::blossom::RootCoefficients::new(primitive).roots
}

/// The vertices of a simplex, ascending, in units of 2⁻²⁰ of the domain's side.
pub type Cell = [[u32; 3]; 4];

/// The F-intersecting simplices that a method found.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Found {
    /// Each once, in ascending order.
    pub cells: Vec<Cell>,
    /// Primitives left in the formula, pruned by the signs at a cell's vertices, added up: the
    /// number of evaluations of the optimal method (MAO).
    pub optimal_evaluations: u64,
}

impl Found {
    fn sorted(mut self) -> Self {
        self.cells.sort_unstable();
        self
    }
}

#[cfg(test)]
mod tests;
