//! Simplification of a formula: constants folded, nested operators of one kind merged, repeated
//! literals dropped, x ∩ ¬x and x ∪ ¬x recognised. One pass, near linear.

use crate::lower::Token;
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
    /// Where its literals begin in the list of literals.
    literals: usize,
    /// A child decided it; the rest is skipped.
    decided: bool,
    /// Operators open within what is skipped.
    skipped: usize,
}

/// Simplifies a token sequence; `intern` gives the primitive of a half-space and its sense.
pub(crate) fn simplify(tokens: &[Token], of_half: &[(PrimitiveId, Sense)]) -> Simplified {
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
    /// Places in the output of the literals of all open operators.
    literals: Vec<usize>,
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
                    literals: self.literals.len(),
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
                self.literals.push(self.out.len());
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
        let decided = top.decided || self.drop_repetitions(&top);
        let kept = self.literals.len() - top.literals + top.operators;
        if decided || kept == 0 {
            self.out.truncate(top.header);
            self.literals.truncate(top.literals);
            self.constant(top.union == decided);
            return;
        }
        if kept > 1 {
            self.out.push(Entry::Close);
            self.literals.truncate(top.literals);
            if let Some(around) = self.open.last_mut() {
                around.operators += 1;
            }
            return;
        }
        // A lone child replaces its operator. A literal already stands in the list, now as
        // one of the operator around.
        self.out[top.header] = Entry::Gap;
        if top.operators == 1 {
            self.merge_lone_operator(top.header);
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
                Entry::Literal(_) if depth == 1 => self.literals.push(at),
                _ => {}
            }
        }
    }

    /// Drops literals that repeat an earlier one of the same operator; tells whether two are
    /// complementary.
    fn drop_repetitions(&mut self, top: &Open) -> bool {
        let own = &mut self.literals[top.literals..];
        let out = &mut self.out;
        let literal = |out: &[Entry], at: usize| match out[at] {
            Entry::Literal(literal) => Some((literal.primitive, literal.sense)),
            _ => None,
        };
        own.sort_unstable_by_key(|&at| (literal(out, at), at));
        let mut kept = 0;
        let mut last = None;
        for index in 0..own.len() {
            let this = literal(out, own[index]);
            if this == last {
                out[own[index]] = Entry::Gap;
                continue;
            }
            if let (Some((p, _)), Some((q, _))) = (this, last)
                && p == q
            {
                return true;
            }
            last = this;
            own[kept] = own[index];
            kept += 1;
        }
        self.literals.truncate(top.literals + kept);
        false
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
