//! What one part of a formula tells about the others.
//!
//! In an intersection, everything inside one child may take the other children for true; in a
//! union, for false. A child, or any part of one, that equals a child of an enclosing operator
//! or its complement is therefore constant. So A \ A is found empty, repeated children are
//! dropped, and a ∪ (a ∩ b) becomes a.
//!
//! This is sound for all children at once: a part is replaced only in a larger term, so no two
//! terms justify each other.

use crate::lower::Token;
use crate::{FormulaNode, Literal, Sense};
use rustc_hash::FxHashMap;

/// Names of a term and of its complement, equal for terms that differ only in the order of
/// children and in materials. Different terms have different names but for a chance of about
/// n²/2¹²⁹ in a formula of n nodes.
#[derive(Clone, Copy, Default)]
struct Names {
    term: u128,
    complement: u128,
}

/// An operator around the current node.
struct Open {
    end: usize,
    /// Names that it made known.
    known: Vec<u128>,
}

/// The formula with decided parts replaced by constants, or `None` if there are none.
///
/// The tokens name primitives, not half-spaces. Cost: near linear.
pub(crate) fn propagate(nodes: &[FormulaNode]) -> Option<Vec<Token>> {
    let names = names(nodes);
    let mut known: FxHashMap<u128, bool> = FxHashMap::default();
    // Children that made their own names known are to be kept.
    let mut keeps = vec![false; nodes.len()];
    let mut open: Vec<Open> = Vec::new();
    let mut tokens = Vec::with_capacity(nodes.len() * 5 / 4);
    let mut changed = false;
    let mut at = 0;
    while at < nodes.len() {
        let node = nodes[at];
        let value = known.get(&names[at].term).filter(|_| !keeps[at]);
        if let Some(&all) = value {
            tokens.push(Token::Constant { all });
            changed = true;
            at += node.span();
        } else {
            at += 1;
            match node {
                FormulaNode::Literal(literal) => tokens.push(half(literal)),
                FormulaNode::Union { .. } | FormulaNode::Intersection { .. } => {
                    let union = matches!(node, FormulaNode::Union { .. });
                    let end = at - 1 + node.span();
                    let mut own = Vec::new();
                    let mut child = at;
                    while child < end {
                        let Names { term, complement } = names[child];
                        if !known.contains_key(&term) {
                            keeps[child] = true;
                            known.insert(term, !union);
                            known.insert(complement, union);
                            own.extend([term, complement]);
                        }
                        child += nodes[child].span();
                    }
                    tokens.push(Token::Open { union });
                    open.push(Open { end, known: own });
                }
            }
        }
        while open.last().is_some_and(|top| top.end == at) {
            tokens.push(Token::Close);
            for name in open.pop().into_iter().flat_map(|top| top.known) {
                known.remove(&name);
            }
        }
    }
    changed.then_some(tokens)
}

fn half(literal: Literal) -> Token {
    Token::Half {
        half: literal.primitive.0 as usize,
        sense: literal.sense,
        material: literal.material,
    }
}

/// The names of all nodes' terms.
fn names(nodes: &[FormulaNode]) -> Vec<Names> {
    let mut parents = vec![usize::MAX; nodes.len()];
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (at, node) in nodes.iter().enumerate() {
        while open.last().is_some_and(|&(_, end)| end <= at) {
            open.pop();
        }
        if let Some(&(parent, _)) = open.last() {
            parents[at] = parent;
        }
        if !matches!(node, FormulaNode::Literal(_)) {
            open.push((at, at + node.span()));
        }
    }
    // Children come after their parents, so backwards each node's sum is complete.
    let mut names = vec![Names::default(); nodes.len()];
    for at in (0..nodes.len()).rev() {
        let sums = names[at];
        let operator = |union: bool| Names {
            term: mix(sums.term, if union { 1 } else { 2 }),
            complement: mix(sums.complement, if union { 2 } else { 1 }),
        };
        names[at] = match nodes[at] {
            FormulaNode::Literal(literal) => {
                let side = |sense: Sense| {
                    let side = u128::from(sense == Sense::Inside);
                    mix(u128::from(literal.primitive.0) << 1 | side, 3)
                };
                Names {
                    term: side(literal.sense),
                    complement: side(literal.sense.complement()),
                }
            }
            FormulaNode::Union { .. } => operator(true),
            FormulaNode::Intersection { .. } => operator(false),
        };
        if let Some(sums) = names.get(parents[at]).copied() {
            names[parents[at]] = Names {
                term: sums.term.wrapping_add(mix(names[at].term, 4)),
                complement: sums.complement.wrapping_add(mix(names[at].complement, 4)),
            };
        }
    }
    names
}

/// A well-scattered function of a number and the role that it plays.
fn mix(value: u128, role: u128) -> u128 {
    const ODD: u128 = 0x9e37_79b9_7f4a_7c15_f39c_c060_5ced_c835;
    let mut z = (value ^ role.wrapping_mul(ODD)).wrapping_mul(ODD);
    for shift in [61, 67, 59] {
        z = (z ^ (z >> shift)).wrapping_mul(ODD);
    }
    z ^ (z >> 64)
}

#[cfg(test)]
mod tests {
    use crate::lower::Token;
    use crate::simplify::{Simplified, simplify};
    use crate::{Formula, FormulaNode, MaterialId, PrimitiveId, Sense};
    use proptest::prelude::*;

    #[derive(Clone, Debug)]
    enum Tree {
        Half(usize, bool),
        Constant(bool),
        Operator(bool, Vec<Tree>),
    }

    fn tree() -> impl Strategy<Value = Tree> {
        let leaf = prop_oneof![
            9 => (0..5_usize, any::<bool>()).prop_map(|(h, s)| Tree::Half(h, s)),
            1 => any::<bool>().prop_map(Tree::Constant),
        ];
        leaf.prop_recursive(6, 40, 4, |inner| {
            let children = proptest::collection::vec(inner, 0..5);
            (any::<bool>(), children).prop_map(|(u, c)| Tree::Operator(u, c))
        })
    }

    fn tokens(tree: &Tree, out: &mut Vec<Token>) {
        match tree {
            Tree::Half(half, inside) => out.push(Token::Half {
                half: *half,
                sense: if *inside {
                    Sense::Inside
                } else {
                    Sense::Outside
                },
                material: MaterialId(0),
            }),
            Tree::Constant(all) => out.push(Token::Constant { all: *all }),
            Tree::Operator(union, children) => {
                out.push(Token::Open { union: *union });
                for child in children {
                    tokens(child, out);
                }
                out.push(Token::Close);
            }
        }
    }

    fn value(tree: &Tree, bits: usize) -> bool {
        match tree {
            Tree::Half(half, inside) => (bits >> half & 1 == 1) == *inside,
            Tree::Constant(all) => *all,
            Tree::Operator(true, children) => children.iter().any(|c| value(c, bits)),
            Tree::Operator(false, children) => children.iter().all(|c| value(c, bits)),
        }
    }

    fn complemented(tree: &Tree) -> Tree {
        match tree {
            Tree::Half(half, inside) => Tree::Half(*half, !inside),
            Tree::Constant(all) => Tree::Constant(!all),
            Tree::Operator(union, children) => {
                Tree::Operator(!union, children.iter().map(complemented).collect())
            }
        }
    }

    fn simplified(tree: &Tree) -> Simplified {
        let mut list = Vec::new();
        tokens(tree, &mut list);
        let ids: Vec<_> = (0..5).map(|id| (PrimitiveId(id), Sense::Inside)).collect();
        simplify(&list, &ids)
    }

    fn check_shape(nodes: &[FormulaNode]) -> Result<(), TestCaseError> {
        for (at, node) in nodes.iter().enumerate() {
            let end = at + node.span();
            let mut child = at + 1;
            let mut count = 0;
            while child < end {
                let same = std::mem::discriminant(node) == std::mem::discriminant(&nodes[child]);
                prop_assert!(!same, "nested operators of one kind");
                child += nodes[child].span();
                count += 1;
            }
            let is_literal = matches!(node, FormulaNode::Literal(_));
            prop_assert!(is_literal || count >= 2);
        }
        Ok(())
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn simplification_keeps_the_value(t in tree()) {
            match simplified(&t) {
                Simplified::Constant { all } => {
                    for bits in 0..32 {
                        prop_assert_eq!(value(&t, bits), all);
                    }
                }
                Simplified::Nodes(nodes) => {
                    check_shape(&nodes)?;
                    let formula = Formula::new(nodes).unwrap();
                    for bits in 0..32_usize {
                        let found = formula.contains(|id| bits >> id.0 & 1 == 1);
                        prop_assert_eq!(found, value(&t, bits));
                    }
                }
            }
        }

        #[test]
        fn anything_without_itself_is_empty(t in tree(), more in tree()) {
            let difference = Tree::Operator(false, vec![t.clone(), more, complemented(&t)]);
            let is_empty = matches!(simplified(&difference), Simplified::Constant { all: false });
            prop_assert!(is_empty);
            let union = Tree::Operator(true, vec![complemented(&t), t]);
            let is_all = matches!(simplified(&union), Simplified::Constant { all: true });
            prop_assert!(is_all);
        }
    }
}
