//! Three-valued evaluation of a formula, and its pruning to what is still undecided: the
//! localization of thesis 4.3 (Algorithm 4.2).

use crate::{FormulaNode, Literal, Sense};

/// Value of a set over a region of space.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Ternary {
    /// The region lies outside.
    Out,
    /// The region lies inside.
    In,
    /// Neither is known.
    Unknown,
}

impl Ternary {
    /// The value of the half-space that `sense` selects, given that of `p ≤ 0`.
    #[must_use]
    pub fn of_sense(self, sense: Sense) -> Self {
        match (self, sense) {
            (Self::In, Sense::Outside) => Self::Out,
            (Self::Out, Sense::Outside) => Self::In,
            (value, _) => value,
        }
    }
}

/// Reusable work space of [`localize`]; holds nothing between calls.
#[derive(Clone, Debug, Default)]
pub struct LocalizeScratch {
    open: Vec<OpenOperator>,
}

/// An operator whose children are being read.
#[derive(Clone, Copy, Debug)]
struct OpenOperator {
    is_union: bool,
    /// Index after its last node in the input.
    input_end: usize,
    /// Where its header stands in the output.
    header: usize,
    /// Children kept so far.
    kept: u32,
}

/// Prunes a formula to the literals that matter in a region.
///
/// `nodes` is one formula in prefix order; `value` tells for each primitive whether the region
/// lies in `p ≤ 0` ([`Ternary::In`]), outside, or neither is known. When the result is
/// `Unknown`, the pruned formula has been appended to `out`; otherwise `out` is as it was.
/// The pruned formula has the same value as `nodes` for every sign pattern that agrees with
/// `value`, its operators have at least two children each, and none stands directly inside
/// another of its kind. Cost: linear in `nodes` (subtrees of decided operators are skipped).
pub fn localize(
    nodes: &[FormulaNode],
    value: impl Fn(crate::PrimitiveId) -> Ternary,
    out: &mut Vec<FormulaNode>,
    scratch: &mut LocalizeScratch,
) -> Ternary {
    let open = &mut scratch.open;
    open.clear();
    let mut at = 0;
    loop {
        // One step: read a node, or close the innermost operator.
        let result = match open.last() {
            Some(&top) if at == top.input_end => {
                open.pop();
                close(top, open.last_mut(), out)
            }
            _ => {
                let node = nodes[at];
                at += 1;
                match node {
                    FormulaNode::Literal(Literal {
                        primitive, sense, ..
                    }) => {
                        let known = value(primitive).of_sense(sense);
                        if known == Ternary::Unknown {
                            out.push(node);
                        }
                        known
                    }
                    FormulaNode::Union { len } | FormulaNode::Intersection { len } => {
                        open.push(OpenOperator {
                            is_union: matches!(node, FormulaNode::Union { .. }),
                            input_end: at + len as usize,
                            header: out.len(),
                            kept: 0,
                        });
                        out.push(node);
                        continue;
                    }
                }
            }
        };
        // Hand the result to the enclosing operators; an absorbing one ends its operator early.
        while let Some(top) = open.last_mut() {
            let absorbing = match result {
                Ternary::In => top.is_union,
                Ternary::Out => !top.is_union,
                Ternary::Unknown => {
                    top.kept += 1;
                    false
                }
            };
            if !absorbing {
                break;
            }
            out.truncate(top.header);
            at = top.input_end;
            open.pop();
        }
        if open.is_empty() {
            return result;
        }
    }
}

/// Finishes an operator all of whose children were read; its undecided ones stand in `out`.
fn close(
    top: OpenOperator,
    parent: Option<&mut OpenOperator>,
    out: &mut Vec<FormulaNode>,
) -> Ternary {
    if top.kept == 0 {
        out.truncate(top.header);
        return if top.is_union {
            Ternary::Out
        } else {
            Ternary::In
        };
    }
    // A lone child takes its operator's place; then it may be of the new parent's kind.
    let kind = if top.kept == 1 {
        out.remove(top.header);
        match out[top.header] {
            FormulaNode::Union { .. } => true,
            FormulaNode::Intersection { .. } => false,
            FormulaNode::Literal(_) => return Ternary::Unknown,
        }
    } else {
        let len = u32::try_from(out.len() - top.header - 1).unwrap_or(u32::MAX);
        out[top.header] = if top.is_union {
            FormulaNode::Union { len }
        } else {
            FormulaNode::Intersection { len }
        };
        top.is_union
    };
    if let Some(parent) = parent.filter(|p| p.is_union == kind) {
        // Its children, two at least, become the parent's.
        out.remove(top.header);
        parent.kept += 1;
    }
    Ternary::Unknown
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MaterialId, PrimitiveId};
    use proptest::prelude::*;

    #[derive(Clone, Debug)]
    enum Tree {
        Leaf(u32, bool),
        Op(bool, Vec<Tree>),
    }

    fn tree() -> impl Strategy<Value = Tree> {
        let leaf = (0u32..6, any::<bool>()).prop_map(|(p, s)| Tree::Leaf(p, s));
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

    fn two_valued(tree: &Tree, inside: &[bool]) -> bool {
        match tree {
            Tree::Leaf(p, sense) => inside[*p as usize] == *sense,
            Tree::Op(true, children) => children.iter().any(|c| two_valued(c, inside)),
            Tree::Op(false, children) => children.iter().all(|c| two_valued(c, inside)),
        }
    }

    fn ternary(byte: u8, bit: bool) -> Ternary {
        match (byte, bit) {
            (0, _) => Ternary::Unknown,
            (_, true) => Ternary::In,
            (_, false) => Ternary::Out,
        }
    }

    proptest! {
        /// Pruned and whole formula agree on every sign pattern that agrees with what is known;
        /// the oracle is a direct recursive evaluation.
        #[test]
        fn pruning_keeps_the_value(t in tree(), known in proptest::collection::vec(0u8..2, 6), bits in 0u8..64) {
            let inside: Vec<bool> = (0..6).map(|i| bits >> i & 1 == 1).collect();
            let mut nodes = Vec::new();
            flatten(&t, &mut nodes);
            let mut out = Vec::new();
            let mut scratch = LocalizeScratch::default();
            let value = |p: PrimitiveId| ternary(known[p.0 as usize], inside[p.0 as usize]);
            let result = localize(&nodes, value, &mut out, &mut scratch);
            let expected = two_valued(&t, &inside);
            match result {
                Ternary::In => prop_assert!(expected && out.is_empty()),
                Ternary::Out => prop_assert!(!expected && out.is_empty()),
                Ternary::Unknown => {
                    prop_assert!(crate::Formula::new(out.clone()).is_some());
                    let all = |p: PrimitiveId| ternary(1, inside[p.0 as usize]);
                    let mut none = Vec::new();
                    let full = localize(&out, all, &mut none, &mut scratch);
                    prop_assert_eq!(full == Ternary::In, expected);
                    for (at, node) in out.iter().enumerate() {
                        let union = match node {
                            FormulaNode::Literal(l) => {
                                prop_assert_eq!(known[l.primitive.0 as usize], 0);
                                continue;
                            }
                            FormulaNode::Union { .. } => true,
                            FormulaNode::Intersection { .. } => false,
                        };
                        let mut children = 0;
                        let mut child = at + 1;
                        while child < at + node.span() {
                            children += 1;
                            let same = match out[child] {
                                FormulaNode::Union { .. } => union,
                                FormulaNode::Intersection { .. } => !union,
                                FormulaNode::Literal(_) => false,
                            };
                            prop_assert!(!same);
                            child += out[child].span();
                        }
                        prop_assert!(children >= 2);
                    }
                }
            }
        }
    }
}
