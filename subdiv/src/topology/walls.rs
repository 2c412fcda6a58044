//! The walls of the domain, which the solid must not reach, not even while it is deformed.

use crate::bernstein::for_each_index;
use crate::lattice::LATTICE_BITS;
use crate::simplex::Simplex;
use crate::walk::Frame;
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};

/// The vertices opposite to those facets of a simplex that lie in the domain's walls.
pub(crate) fn wall_facets(simplex: &Simplex) -> impl Iterator<Item = usize> {
    let corners = simplex.vertices.map(crate::lattice::Point::coordinates);
    (0..4).filter(move |apex| {
        (0..3).any(|axis| {
            [0, 1 << LATTICE_BITS].into_iter().any(|wall| {
                (0..4)
                    .filter(|v| v != apex)
                    .all(|v| corners[v][axis] == wall)
            })
        })
    })
}

/// Whether the formula is decided in a facet of a leaf, by the coefficients there alone.
pub(crate) fn is_decided(
    frame: &Frame,
    apex: usize,
    pruned: &mut Vec<FormulaNode>,
    scratch: &mut LocalizeScratch,
) -> bool {
    let value = |primitive: PrimitiveId| {
        let Some(active) = frame.active.iter().find(|a| a.primitive == primitive.0) else {
            return Ternary::Unknown;
        };
        let coefficients = frame.coefficients_of(active);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for_each_index(active.degree as usize, |at, exponents| {
            if exponents[apex] == 0 {
                low = low.min(coefficients[at]);
                high = high.max(coefficients[at]);
            }
        });
        let error = active.error();
        if low > error {
            Ternary::Out
        } else if high < -error {
            Ternary::In
        } else {
            Ternary::Unknown
        }
    };
    pruned.clear();
    localize(&frame.formula, value, pruned, scratch) != Ternary::Unknown
}
