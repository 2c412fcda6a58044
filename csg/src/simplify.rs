//! Simplification of a formula: constants folded, nested operators of one kind merged, and what
//! [`propagate`] finds decided by other parts of the formula dropped.

use crate::lower::Token;
use crate::propagate::propagate;
use crate::{FormulaNode, Literal, PrimitiveId, Sense};

/// A simplified formula.
#[derive(Debug)]
pub(crate) enum Simplified {
    /// All of space, or nothing.
    Constant { all: bool },
    /// Nodes in prefix order; every operator has two or more children of other kinds.
    Nodes(Vec<FormulaNode>),
}

/// An entry of the output while it is built. Removing one leaves a gap, which costs nothing.
#[derive(Clone, Copy)]
enum Entry {
    Open { union: bool },
    Close,
    Literal(Literal),
    Gap,
}

/// An operator whose children are being read.
struct Open {
    union: bool,
    /// Where it begins in the output.
    header: usize,
    /// Operators of the same kind, merged with it, that are still open.
    merged: usize,
    /// Child operators kept.
    operators: usize,
    /// Literals kept.
    literals: usize,
    /// A child decided it; the rest is skipped.
    decided: bool,
    /// Operators open within what is skipped.
    skipped: usize,
}

/// Rounds of propagation; a round without a change is the last. Each costs time linear in the
/// formula, and the second rarely finds anything.
const ROUNDS: usize = 4;

/// Simplifies a token sequence; `of_half` gives the primitive of a half-space and its sense.
pub(crate) fn simplify(tokens: &[Token], of_half: &[(PrimitiveId, Sense)]) -> Simplified {
    let mut nodes = match fold(tokens, of_half) {
        Simplified::Nodes(nodes) => nodes,
        constant @ Simplified::Constant { .. } => return constant,
    };
    let itself = identity(of_half);
    for _ in 0..ROUNDS {
        let Some(tokens) = propagate(&nodes) else {
            break;
        };
        nodes = match fold(&tokens, &itself) {
            Simplified::Nodes(nodes) => nodes,
            constant @ Simplified::Constant { .. } => return constant,
        };
    }
    Simplified::Nodes(nodes)
}

/// The table for tokens that name primitives, not half-spaces.
fn identity(of_half: &[(PrimitiveId, Sense)]) -> Vec<(PrimitiveId, Sense)> {
    let ids = (0..).map(|id| (PrimitiveId(id), Sense::Inside));
    ids.take(of_half.len()).collect()
}

/// Folds constants and merges operators.
fn fold(tokens: &[Token], of_half: &[(PrimitiveId, Sense)]) -> Simplified {
    let mut builder = Builder::default();
    for token in tokens {
        builder.read(*token, of_half);
    }
    match builder.result {
        Some(all) => Simplified::Constant { all },
        None => Simplified::Nodes(nodes(&builder.out)),
    }
}

#[derive(Default)]
struct Builder {
    out: Vec<Entry>,
    open: Vec<Open>,
    /// Value of the whole formula, if it is constant.
    result: Option<bool>,
}

impl Builder {
    fn read(&mut self, token: Token, of_half: &[(PrimitiveId, Sense)]) {
        if let Some(top) = self.open.last_mut() {
            if top.decided {
                match token {
                    Token::Open { .. } => top.skipped += 1,
                    Token::Close if top.skipped > 0 => top.skipped -= 1,
                    Token::Close if top.merged > 0 => top.merged -= 1,
                    Token::Close => self.close(),
                    _ => {}
                }
                return;
            }
            match token {
                Token::Open { union } if union == top.union => {
                    top.merged += 1;
                    return;
                }
                Token::Close if top.merged > 0 => {
                    top.merged -= 1;
                    return;
                }
                _ => {}
            }
        }
        match token {
            Token::Open { union } => {
                self.open.push(Open {
                    union,
                    header: self.out.len(),
                    merged: 0,
                    operators: 0,
                    literals: 0,
                    decided: false,
                    skipped: 0,
                });
                self.out.push(Entry::Open { union });
            }
            Token::Close => self.close(),
            Token::Constant { all } => self.constant(all),
            Token::Half {
                half,
                sense,
                material,
            } => {
                let (primitive, relative) = of_half[half];
                let sense = match relative {
                    Sense::Inside => sense,
                    Sense::Outside => sense.complement(),
                };
                if let Some(top) = self.open.last_mut() {
                    top.literals += 1;
                }
                self.out.push(Entry::Literal(Literal {
                    primitive,
                    sense,
                    material,
                }));
            }
        }
    }

    /// Takes a constant child of the innermost operator.
    fn constant(&mut self, all: bool) {
        match self.open.last_mut() {
            None => self.result = Some(all),
            Some(top) => top.decided |= all == top.union,
        }
    }

    /// Ends the innermost operator.
    fn close(&mut self) {
        let Some(top) = self.open.pop() else {
            return;
        };
        let kept = top.literals + top.operators;
        if top.decided || kept == 0 {
            self.out.truncate(top.header);
            self.constant(top.union == top.decided);
            return;
        }
        if kept > 1 {
            self.out.push(Entry::Close);
            if let Some(around) = self.open.last_mut() {
                around.operators += 1;
            }
            return;
        }
        // A lone child replaces its operator.
        self.out[top.header] = Entry::Gap;
        if top.operators == 1 {
            self.merge_lone_operator(top.header);
        } else if let Some(around) = self.open.last_mut() {
            around.literals += 1;
        }
    }

    /// The operator that begins at or after `from` is the last thing in the output and its own
    /// operator has vanished: it is now a child of the one around, of the same kind, if any.
    fn merge_lone_operator(&mut self, from: usize) {
        let Some(around) = self.open.last_mut() else {
            return;
        };
        let mut depth = 0;
        for at in from..self.out.len() {
            match self.out[at] {
                Entry::Open { .. } => {
                    depth += 1;
                    if depth == 1 {
                        self.out[at] = Entry::Gap;
                    } else if depth == 2 {
                        around.operators += 1;
                    }
                }
                Entry::Close => {
                    depth -= 1;
                    if depth == 0 {
                        self.out[at] = Entry::Gap;
                    }
                }
                Entry::Literal(_) if depth == 1 => around.literals += 1,
                _ => {}
            }
        }
    }
}

/// The entries without gaps, operators with the lengths of their subtrees.
fn nodes(entries: &[Entry]) -> Vec<FormulaNode> {
    let mut nodes = Vec::new();
    let mut headers = Vec::new();
    for entry in entries {
        match *entry {
            Entry::Gap => {}
            Entry::Literal(literal) => nodes.push(FormulaNode::Literal(literal)),
            Entry::Open { union } => {
                headers.push(nodes.len());
                nodes.push(if union {
                    FormulaNode::Union { len: 0 }
                } else {
                    FormulaNode::Intersection { len: 0 }
                });
            }
            Entry::Close => {
                let Some(header) = headers.pop() else {
                    continue;
                };
                // At most MAX_LITERALS literals and fewer operators.
                let span = u32::try_from(nodes.len() - header - 1).unwrap_or(u32::MAX);
                if let FormulaNode::Union { len } | FormulaNode::Intersection { len } =
                    &mut nodes[header]
                {
                    *len = span;
                }
            }
        }
    }
    nodes
}
