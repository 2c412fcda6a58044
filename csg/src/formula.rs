//! The Boolean formula of a solid: n-ary regularized unions and intersections over literals.
//!
//! Difference and complement never appear: they are pushed to the literals' senses when the
//! formula is built (`A \ B = A ∩ ¬B`). The nodes stand in prefix order in one flat array, so a
//! subtree is a slice and no algorithm here recurses on the depth of the input.

/// Index of an interned primitive in [`Solid::primitives`](crate::Solid::primitives).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct PrimitiveId(pub u32);

/// Index of a material in [`Solid::materials`](crate::Solid::materials).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct MaterialId(pub u32);

/// Which of the two half-spaces of a primitive's polynomial `p` a literal means.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Sense {
    /// `p ≤ 0`.
    Inside,
    /// `p > 0`, the complement.
    Outside,
}

impl Sense {
    /// The sense of the complementary half-space.
    #[must_use]
    pub fn complement(self) -> Self {
        match self {
            Self::Inside => Self::Outside,
            Self::Outside => Self::Inside,
        }
    }
}

/// A half-space of one primitive, with the material that its boundary shows.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Literal {
    /// The primitive whose zero set bounds the half-space.
    pub primitive: PrimitiveId,
    /// Which side of it is meant.
    pub sense: Sense,
    /// Material of the facets that this literal contributes.
    pub material: MaterialId,
}

/// One node of a [`Formula`] in prefix order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FormulaNode {
    /// Regularized union of the following `len` nodes' subtrees (none: the empty set).
    Union {
        /// Number of nodes in all subtrees of this node, itself excluded.
        len: u32,
    },
    /// Regularized intersection of the following `len` nodes' subtrees (none: all of space).
    Intersection {
        /// Number of nodes in all subtrees of this node, itself excluded.
        len: u32,
    },
    /// A half-space.
    Literal(Literal),
}

impl FormulaNode {
    /// Number of nodes of the subtree that starts here, this node included.
    #[must_use]
    pub fn span(self) -> usize {
        match self {
            Self::Union { len } | Self::Intersection { len } => len as usize + 1,
            Self::Literal(_) => 1,
        }
    }
}

/// A Boolean formula over half-spaces: one well-formed prefix sequence of [`FormulaNode`]s.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Formula {
    nodes: Vec<FormulaNode>,
}

impl Formula {
    /// Takes a prefix sequence.
    ///
    /// Returns `None` unless `nodes` is exactly one well-formed formula.
    #[must_use]
    pub fn new(nodes: Vec<FormulaNode>) -> Option<Self> {
        let mut ends: Vec<usize> = Vec::new();
        for (at, node) in nodes.iter().enumerate() {
            if at > 0 && ends.is_empty() {
                return None;
            }
            let end = at + node.span();
            if ends.last().is_some_and(|&outer| end > outer) || end > nodes.len() {
                return None;
            }
            ends.push(end);
            while ends.last() == Some(&(at + 1)) {
                ends.pop();
            }
        }
        (!nodes.is_empty() && ends.is_empty()).then_some(Self { nodes })
    }

    /// The nodes in prefix order.
    #[must_use]
    pub fn nodes(&self) -> &[FormulaNode] {
        &self.nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_well_formed_prefix_sequence_is_accepted() {
        let literal = FormulaNode::Literal(Literal {
            primitive: PrimitiveId(0),
            sense: Sense::Inside,
            material: MaterialId(0),
        });
        assert!(Formula::new(vec![]).is_none());
        assert!(Formula::new(vec![literal]).is_some());
        assert!(Formula::new(vec![literal, literal]).is_none());
        assert!(Formula::new(vec![FormulaNode::Union { len: 0 }]).is_some());
        assert!(Formula::new(vec![FormulaNode::Union { len: 2 }, literal]).is_none());
        let nested = FormulaNode::Intersection { len: 2 };
        assert!(Formula::new(vec![FormulaNode::Union { len: 2 }, nested, literal]).is_none());
        let inner = FormulaNode::Intersection { len: 1 };
        assert!(Formula::new(vec![FormulaNode::Union { len: 2 }, inner, literal]).is_some());
    }
}
