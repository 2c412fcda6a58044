//! What the signs at a simplex' vertices say of the formula.

use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};

/// Reusable work space.
#[derive(Debug, Default)]
pub(super) struct Judge {
    values: Vec<Ternary>,
    counted: Vec<u32>,
    stamp: u32,
    pruned: Vec<FormulaNode>,
    scratch: LocalizeScratch,
}

/// The value of a primitive that is ≤ 0 at `inside` of `all` vertices.
#[must_use]
pub(super) fn value(inside: usize, all: usize) -> Ternary {
    match inside {
        0 => Ternary::Out,
        n if n == all => Ternary::In,
        _ => Ternary::Unknown,
    }
}

impl Judge {
    /// For `primitives` primitives, none of whose values is known yet.
    #[must_use]
    pub(super) fn new(primitives: usize) -> Self {
        Self {
            values: vec![Ternary::Unknown; primitives],
            counted: vec![0; primitives],
            ..Self::default()
        }
    }

    /// Notes the value of a primitive, until it is noted again.
    pub(super) fn note(&mut self, primitive: usize, value: Ternary) {
        self.values[primitive] = value;
    }

    /// How many primitives the formula still depends on; 0 when it is decided.
    pub(super) fn undecided(&mut self, formula: &[FormulaNode]) -> u64 {
        self.pruned.clear();
        let values = &self.values;
        let of = |p: PrimitiveId| values[p.0 as usize];
        if localize(formula, of, &mut self.pruned, &mut self.scratch) != Ternary::Unknown {
            return 0;
        }
        self.stamp += 1;
        let mut count = 0;
        for node in &self.pruned {
            if let FormulaNode::Literal(literal) = node {
                let stamp = &mut self.counted[literal.primitive.0 as usize];
                count += u64::from(*stamp != self.stamp);
                *stamp = self.stamp;
            }
        }
        count
    }
}
