//! Two-valued evaluation: whether a point belongs to a formula or a solid.

use crate::{Formula, FormulaNode, PrimitiveId, Sense, Solid};
use glam::DVec3;

impl Formula {
    /// The empty set.
    pub(crate) fn empty() -> Self {
        Self::new(vec![FormulaNode::Union { len: 0 }]).expect("one node without children")
    }

    /// Whether a point belongs to the set, given for each primitive whether it has `p ≤ 0` there.
    ///
    /// Cost: linear; `inside` is not asked where an operator is decided already.
    pub fn contains(&self, mut inside: impl FnMut(PrimitiveId) -> bool) -> bool {
        let nodes = self.nodes();
        // Open operators: where each ends, and whether it is a union.
        let mut open: Vec<(usize, bool)> = Vec::new();
        let mut at = 0;
        loop {
            let node = nodes[at];
            let value = match node {
                FormulaNode::Literal(literal) => {
                    at += 1;
                    inside(literal.primitive) == (literal.sense == Sense::Inside)
                }
                FormulaNode::Union { len } | FormulaNode::Intersection { len } => {
                    let union = matches!(node, FormulaNode::Union { .. });
                    at += 1;
                    if len > 0 {
                        open.push((at + len as usize, union));
                        continue;
                    }
                    !union
                }
            };
            // It is also that of the operators around which it decides or whose last child it is.
            loop {
                let Some(&(end, union)) = open.last() else {
                    return value;
                };
                if value == union {
                    at = end;
                }
                if at < end {
                    break;
                }
                open.pop();
            }
        }
    }
}

impl Solid {
    /// Whether a point, in model units, lies in the solid. Points outside the domain do not.
    ///
    /// Decided by floating-point evaluation, so not reliable within rounding of the boundary.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        let at = self.domain.to_centered(point);
        let in_domain = at.abs().max_element() <= 1.0;
        in_domain
            && self.formula.contains(|id| {
                let primitive = &self.primitives[id.0 as usize];
                primitive.polynomial.evaluate(at) <= 0.0
            })
    }
}
