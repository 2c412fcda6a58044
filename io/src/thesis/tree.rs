//! Binary Boolean trees as the thesis writes them: a node's Boolean "is it a leaf", then the leaf
//! or the operator and the two subtrees. In memory they are flat lists in the same prefix order.

use super::bytes::{Cursor, Encoder};
use super::{Error, Problem};
use csg::{FormulaNode, Literal, Model, ModelBuilder, Node, NodeId};
use std::io::Write;

/// A regularized set operation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Operation {
    /// A ∪ B.
    Union,
    /// A ∩ B.
    Intersection,
    /// A \ B.
    Difference,
}

/// The bytes that stand for operators, which the thesis does not give.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Operators {
    codes: [u8; 3],
    letters: bool,
}

impl Default for Operators {
    /// 0 union, 1 intersection, 2 difference; `U I D` and `+ * -` are read, too.
    fn default() -> Self {
        Self {
            codes: [0, 1, 2],
            letters: true,
        }
    }
}

impl Operators {
    /// These codes of union, intersection and difference and no others; `None` unless they differ.
    #[must_use]
    pub fn new(codes: [u8; 3]) -> Option<Self> {
        let [a, b, c] = codes;
        let letters = false;
        (a != b && b != c && c != a).then_some(Self { codes, letters })
    }

    /// What a byte means.
    #[must_use]
    pub fn meaning(self, code: u8) -> Option<Operation> {
        let letters = match code {
            b'U' | b'u' | b'+' => Some(0),
            b'I' | b'i' | b'*' => Some(1),
            b'D' | b'd' | b'-' => Some(2),
            _ => None,
        };
        let place = self.codes.iter().position(|known| *known == code);
        match place.or(letters.filter(|_| self.letters))? {
            0 => Some(Operation::Union),
            1 => Some(Operation::Intersection),
            _ => Some(Operation::Difference),
        }
    }

    /// The byte that stands for an operation.
    #[must_use]
    pub fn code(self, operation: Operation) -> u8 {
        let [union, intersection, difference] = self.codes;
        match operation {
            Operation::Union => union,
            Operation::Intersection => intersection,
            Operation::Difference => difference,
        }
    }

    fn known(self) -> String {
        let [union, intersection, difference] = self.codes;
        let letters = if self.letters { ", U I D, + * -" } else { "" };
        format!("{union} {intersection} {difference}{letters}")
    }
}

/// One node in prefix order.
#[derive(Clone, PartialEq, Debug)]
pub enum TreeNode<L> {
    /// An operator; its left and right subtrees follow.
    Operator(Operation),
    /// A leaf.
    Leaf(L),
}

/// A Boolean tree: exactly one, in prefix order.
#[derive(Clone, PartialEq, Debug)]
pub struct Tree<L> {
    nodes: Vec<TreeNode<L>>,
}

impl<L> Tree<L> {
    /// Takes a prefix sequence; `None` unless it is exactly one tree.
    #[must_use]
    pub fn new(nodes: Vec<TreeNode<L>>) -> Option<Self> {
        let mut open = 1_usize;
        for node in &nodes {
            open = open.checked_sub(1)?;
            if matches!(node, TreeNode::Operator(_)) {
                open += 2;
            } else if open == 0 {
                break;
            }
        }
        let operators = nodes.iter().filter(|n| matches!(n, TreeNode::Operator(_)));
        (open == 0 && nodes.len() == 2 * operators.count() + 1).then_some(Self { nodes })
    }

    /// An n-ary formula as a binary tree, no deeper than needed.
    ///
    /// `leaf` makes the leaf of a literal, `constant` that of all of space or of nothing.
    #[must_use]
    pub fn from_formula(
        formula: &[FormulaNode],
        mut leaf: impl FnMut(Literal) -> L,
        mut constant: impl FnMut(bool) -> L,
    ) -> Self {
        let mut nodes = Vec::with_capacity(2 * formula.len());
        // Operands still to be joined by one operation; the next run on top.
        let mut work = vec![(Operation::Union, vec![0_usize])];
        while let Some((operation, mut run)) = work.pop() {
            if run.len() > 1 {
                nodes.push(TreeNode::Operator(operation));
                let right = run.split_off(run.len() / 2);
                work.push((operation, right));
                work.push((operation, run));
                continue;
            }
            let node = run.first().map(|at| (*at, formula.get(*at)));
            match node {
                Some((_, Some(FormulaNode::Literal(literal)))) => {
                    nodes.push(TreeNode::Leaf(leaf(*literal)));
                }
                Some((at, Some(operator))) => {
                    let operation = match operator {
                        FormulaNode::Union { .. } => Operation::Union,
                        _ => Operation::Intersection,
                    };
                    let mut operands = Vec::new();
                    let mut child = at + 1;
                    while child < at + operator.span() {
                        operands.push(child);
                        child += formula.get(child).map_or(1, |n| n.span());
                    }
                    work.push((operation, operands));
                }
                _ => {
                    let all = operation == Operation::Intersection;
                    nodes.push(TreeNode::Leaf(constant(all)));
                }
            }
        }
        Self { nodes }
    }

    /// The tree as a formula without differences; leaf i becomes literal i in prefix order, in the
    /// sense that `literal` gives it, turned around inside an odd number of differences.
    #[must_use]
    pub fn to_formula(&self, mut literal: impl FnMut(&L) -> Literal) -> Vec<FormulaNode> {
        let mut formula: Vec<FormulaNode> = Vec::with_capacity(self.nodes.len());
        // Whether each subtree still to come is complemented, the next one on top.
        let mut complements = vec![false];
        for node in &self.nodes {
            let outside = complements.pop().unwrap_or_default();
            match node {
                TreeNode::Leaf(leaf) => {
                    let mut literal = literal(leaf);
                    if outside {
                        literal.sense = literal.sense.complement();
                    }
                    formula.push(FormulaNode::Literal(literal));
                }
                TreeNode::Operator(operation) => {
                    let right = outside != (*operation == Operation::Difference);
                    complements.extend([right, outside]);
                    let is_union = (*operation == Operation::Union) != outside;
                    formula.push(if is_union {
                        FormulaNode::Union { len: 0 }
                    } else {
                        FormulaNode::Intersection { len: 0 }
                    });
                }
            }
        }
        // Backwards, the spans of both operands are known when their operator comes.
        let mut spans: Vec<u32> = Vec::new();
        for node in formula.iter_mut().rev() {
            if let FormulaNode::Union { len } | FormulaNode::Intersection { len } = node {
                let operands = [spans.pop(), spans.pop()];
                *len = operands.into_iter().flatten().sum();
                spans.push(*len + 1);
            } else {
                spans.push(1);
            }
        }
        formula
    }

    /// The tree as a model, given the node of each leaf.
    pub(super) fn to_model<E>(
        &self,
        mut leaf: impl FnMut(&mut ModelBuilder, &L) -> Result<NodeId, E>,
    ) -> Result<Model, E> {
        let mut builder = ModelBuilder::new();
        let mut done: Vec<NodeId> = Vec::new();
        // Backwards, both operands of an operator stand on the stack when it comes, the left on top.
        for node in self.nodes.iter().rev() {
            let next = match node {
                TreeNode::Leaf(content) => leaf(&mut builder, content)?,
                TreeNode::Operator(operation) => {
                    let operands: Vec<NodeId> =
                        [done.pop(), done.pop()].into_iter().flatten().collect();
                    builder.add(match operation {
                        Operation::Union => Node::Union(operands),
                        Operation::Intersection => Node::Intersection(operands),
                        Operation::Difference => Node::Difference(operands),
                    })
                }
            };
            done.push(next);
        }
        let root = done
            .pop()
            .unwrap_or_else(|| builder.add(Node::Union(Vec::new())));
        Ok(builder.finish(root))
    }

    /// The nodes in prefix order.
    #[must_use]
    pub fn nodes(&self) -> &[TreeNode<L>] {
        &self.nodes
    }

    /// The leaves from left to right.
    pub fn leaves(&self) -> impl Iterator<Item = &L> {
        self.nodes.iter().filter_map(|node| match node {
            TreeNode::Leaf(leaf) => Some(leaf),
            TreeNode::Operator(_) => None,
        })
    }

    /// Reads a tree. Every node takes two bytes or more, so the bytes bound the memory.
    pub(super) fn read(
        cursor: &mut Cursor<'_>,
        operators: Operators,
        leaf: impl Fn(&mut Cursor<'_>) -> Result<L, Error>,
    ) -> Result<Self, Error> {
        let mut nodes = Vec::new();
        let mut open = 1_usize;
        while open > 0 {
            if cursor.byte("a node of the Boolean tree")? != 0 {
                nodes.push(TreeNode::Leaf(leaf(cursor)?));
                open -= 1;
                continue;
            }
            let start = *cursor;
            let code = cursor.byte("an operator")?;
            let Some(operation) = operators.meaning(code) else {
                let known = operators.known();
                return Err(start.error(Problem::Operator { code, known }));
            };
            nodes.push(TreeNode::Operator(operation));
            open += 1;
        }
        Ok(Self { nodes })
    }

    pub(super) fn write<W: Write>(
        &self,
        encoder: &mut Encoder<'_, W>,
        operators: Operators,
        leaf: impl Fn(&L, &mut Encoder<'_, W>) -> std::io::Result<()>,
    ) -> std::io::Result<()> {
        for node in &self.nodes {
            match node {
                TreeNode::Operator(operation) => {
                    encoder.byte(0)?;
                    encoder.byte(operators.code(*operation))?;
                }
                TreeNode::Leaf(one) => {
                    encoder.byte(1)?;
                    leaf(one, encoder)?;
                }
            }
        }
        Ok(())
    }
}
