//! Sets of sign patterns of up to eight primitives, as bit sets of 256 elements.
//!
//! Bit `s` of a set stands for the pattern in which primitive b lies inside its half-space
//! (p < 0) exactly when bit b of `s` is set. A formula is the set of patterns that lie inside the
//! solid, so union and intersection are those of sets, and what a leaf is known to exclude is
//! taken out of the set of patterns that occur in it.

use csg::{FormulaNode, Sense};

/// Most primitives that a pattern here describes: those of a leaf that the topological rule
/// accepts, and whose formula is tabulated.
pub(crate) const CROWD: usize = 8;

/// A set of sign patterns.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Patterns([u64; 4]);

/// Within a word, the patterns with primitive 0 ‥ 5 inside.
const INSIDE: [u64; 6] = [
    0xaaaa_aaaa_aaaa_aaaa,
    0xcccc_cccc_cccc_cccc,
    0xf0f0_f0f0_f0f0_f0f0,
    0xff00_ff00_ff00_ff00,
    0xffff_0000_ffff_0000,
    0xffff_ffff_0000_0000,
];

impl Patterns {
    /// No pattern.
    pub(crate) const NONE: Self = Self([0; 4]);
    /// All patterns.
    pub(crate) const ALL: Self = Self([u64::MAX; 4]);

    /// Whether a pattern is in the set.
    #[must_use]
    pub(crate) fn holds(self, pattern: u8) -> bool {
        self.0[usize::from(pattern >> 6)] >> (pattern & 63) & 1 == 1
    }

    /// Those with this primitive inside.
    #[must_use]
    pub(crate) fn inside(primitive: usize) -> Self {
        match primitive {
            0..=5 => Self([INSIDE[primitive]; 4]),
            6 => Self([0, u64::MAX, 0, u64::MAX]),
            _ => Self([0, 0, u64::MAX, u64::MAX]),
        }
    }

    /// Those with this primitive inside or, if `inside` is unset, outside.
    #[must_use]
    pub(crate) fn with(primitive: usize, inside: bool) -> Self {
        if inside {
            Self::inside(primitive)
        } else {
            Self::inside(primitive).complement()
        }
    }

    /// All others.
    #[must_use]
    pub(crate) fn complement(self) -> Self {
        Self(self.0.map(|word| !word))
    }

    /// Those in either.
    #[must_use]
    pub(crate) fn union(self, other: Self) -> Self {
        Self(std::array::from_fn(|at| self.0[at] | other.0[at]))
    }

    /// Those in both.
    #[must_use]
    pub(crate) fn intersection(self, other: Self) -> Self {
        Self(std::array::from_fn(|at| self.0[at] & other.0[at]))
    }

    /// Those in one but not in both.
    #[must_use]
    pub(crate) fn difference(self, other: Self) -> Self {
        Self(std::array::from_fn(|at| self.0[at] ^ other.0[at]))
    }

    /// Whether there is none.
    #[must_use]
    pub(crate) fn is_empty(self) -> bool {
        self == Self::NONE
    }

    /// The patterns with this primitive's sign reversed.
    #[must_use]
    pub(crate) fn flipped(self, primitive: usize) -> Self {
        let [a, b, c, d] = self.0;
        match primitive {
            0..=5 => {
                let (mask, shift) = (INSIDE[primitive], 1 << primitive);
                Self(
                    self.0
                        .map(|word| (word & mask) >> shift | (word & !mask) << shift),
                )
            }
            6 => Self([b, a, d, c]),
            _ => Self([c, d, a, b]),
        }
    }

    /// The formula's patterns inside the solid; `primitives` lists its primitives, at most
    /// [`CROWD`], by their global indices in ascending order.
    #[must_use]
    pub(crate) fn of_formula(
        nodes: &[FormulaNode],
        primitives: impl Fn(u32) -> usize,
        open: &mut Vec<(usize, Self)>,
    ) -> Self {
        // From the back, so that all children of a node are known before it: `open` holds the
        // finished subtrees by where they begin, the leftmost last.
        open.clear();
        for (at, node) in nodes.iter().enumerate().rev() {
            let value = match node {
                FormulaNode::Literal(literal) => Self::with(
                    primitives(literal.primitive.0),
                    literal.sense == Sense::Inside,
                ),
                FormulaNode::Union { .. } | FormulaNode::Intersection { .. } => {
                    let is_union = matches!(node, FormulaNode::Union { .. });
                    let end = at + node.span();
                    let mut value = if is_union { Self::NONE } else { Self::ALL };
                    while let Some((_, child)) = open.pop_if(|(start, _)| *start < end) {
                        value = if is_union {
                            value.union(child)
                        } else {
                            value.intersection(child)
                        };
                    }
                    value
                }
            };
            open.push((at, value));
        }
        open.pop().map_or(Self::NONE, |(_, value)| value)
    }

    /// The patterns that stay in the set whatever signs the `members` are given.
    #[must_use]
    pub(crate) fn all_signs_of(self, members: &[usize]) -> Self {
        members
            .iter()
            .fold(self, |set, &member| set.intersection(set.flipped(member)))
    }

    /// Whether the formula really depends on all of `members` together somewhere: whether the
    /// others can have signs for which every pattern of the members is `feasible` and the
    /// formula depends on each member.
    #[must_use]
    pub(crate) fn depends_jointly(self, feasible: Self, members: &[usize]) -> bool {
        let mut possible = feasible.all_signs_of(members);
        for &member in members {
            if possible.is_empty() {
                return false;
            }
            let mut turns = self.difference(self.flipped(member));
            for &other in members.iter().filter(|other| **other != member) {
                turns = turns.union(turns.flipped(other));
            }
            possible = possible.intersection(turns);
        }
        !possible.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use csg::{Literal, MaterialId, PrimitiveId};
    use proptest::prelude::*;

    #[derive(Clone, Debug)]
    enum Tree {
        Leaf(u32, bool),
        Op(bool, Vec<Tree>),
    }

    fn tree() -> impl Strategy<Value = Tree> {
        let leaf = (0u32..8, any::<bool>()).prop_map(|(p, s)| Tree::Leaf(p, s));
        leaf.prop_recursive(5, 40, 4, |inner| {
            (any::<bool>(), proptest::collection::vec(inner, 0..4))
                .prop_map(|(u, c)| Tree::Op(u, c))
        })
    }

    fn flatten(tree: &Tree, out: &mut Vec<FormulaNode>) {
        match tree {
            Tree::Leaf(p, inside) => out.push(FormulaNode::Literal(Literal {
                primitive: PrimitiveId(*p),
                sense: if *inside {
                    Sense::Inside
                } else {
                    Sense::Outside
                },
                material: MaterialId(0),
            })),
            Tree::Op(is_union, children) => {
                let header = out.len();
                out.push(FormulaNode::Union { len: 0 });
                for child in children {
                    flatten(child, out);
                }
                let len = u32::try_from(out.len() - header - 1).unwrap();
                out[header] = if *is_union {
                    FormulaNode::Union { len }
                } else {
                    FormulaNode::Intersection { len }
                };
            }
        }
    }

    fn value(tree: &Tree, pattern: usize) -> bool {
        match tree {
            Tree::Leaf(p, sense) => (pattern >> p & 1 == 1) == *sense,
            Tree::Op(true, children) => children.iter().any(|c| value(c, pattern)),
            Tree::Op(false, children) => children.iter().all(|c| value(c, pattern)),
        }
    }

    proptest! {
        /// The oracle evaluates the tree directly, pattern by pattern.
        #[test]
        fn a_formula_is_the_set_of_its_inside_patterns(t in tree()) {
            let mut nodes = Vec::new();
            flatten(&t, &mut nodes);
            let set = Patterns::of_formula(&nodes, |p| p as usize, &mut Vec::new());
            for pattern in 0..=255u8 {
                prop_assert_eq!(set.holds(pattern), value(&t, usize::from(pattern)));
            }
        }

        /// The oracle follows the definition: over all signs of the others.
        #[test]
        fn joint_dependence_is_as_defined(t in tree(), words: [u64; 4], more: [u64; 4], chosen in 1usize..256) {
            let mut nodes = Vec::new();
            flatten(&t, &mut nodes);
            let set = Patterns::of_formula(&nodes, |p| p as usize, &mut Vec::new());
            let feasible = Patterns(words).union(Patterns(more));
            let members: Vec<usize> = (0..8).filter(|b| chosen >> b & 1 == 1).collect();
            let chosen = u8::try_from(chosen).unwrap();
            let expected = (0..=255u8).filter(|p| p & chosen == 0).any(|others| {
                let own: Vec<u8> = (0..=255).filter(|p| p & !chosen == others).collect();
                own.iter().all(|p| feasible.holds(*p))
                    && members.iter().all(|b| own.iter().any(|p| set.holds(*p) != set.holds(p ^ 1 << b)))
            });
            prop_assert_eq!(set.depends_jointly(feasible, &members), expected);
        }
    }
}
