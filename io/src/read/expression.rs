//! Polynomials as people write them: `x^2 + y^2 - 1`.
//!
//! ```text
//! sum     := product (('+' | '-') product)*
//! product := signed (('*' | '/') signed)*        the divisor is a constant
//! signed  := ('-' | '+') signed | power
//! power   := atom ('^' signed)?                  the exponent is a constant, a whole number ≥ 0
//! atom    := NUMBER | 'x' | 'y' | 'z' | '(' sum ')'
//! ```
//! So `-x^2` is −(x²) and `x^2^3` is x⁸. Operators stand on an explicit stack: 100,000 parentheses
//! cost no more stack than one. Degrees are checked before anything is multiplied out.

mod function;
mod terms;

use crate::read::decimal::decimal;
use csg::Axis;
pub(crate) use function::parse_function;
use std::ops::Range;
pub(crate) use terms::Terms;
use terms::{Limits, Refusal};
use winnow::LocatingSlice;
use winnow::combinator::{alt, dispatch, peek, preceded};
use winnow::prelude::*;
use winnow::stream::Location;
use winnow::token::{any, take_while};

/// What is wrong with an expression.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct ExpressionError {
    /// Byte range within the expression.
    pub(crate) span: Range<usize>,
    /// What was expected and what was found.
    pub(crate) message: String,
    /// What to do.
    pub(crate) remedy: Option<String>,
}

/// Operations that one file's expressions may cost: about a second of products of coefficients.
pub(crate) const WORK: u64 = 500_000_000;

/// Evaluates an expression to its terms.
///
/// # Errors
/// The first thing that is no expression, a degree above `max_degree` (at most 255), a coefficient that is
/// not finite, or more operations than `work`, of which those done are taken away.
pub(crate) fn parse(text: &str, max_degree: u8, work: &mut u64) -> Result<Terms, ExpressionError> {
    Evaluator {
        text,
        limits: Limits::new(max_degree, work),
        operators: Vec::new(),
        operands: Vec::new(),
    }
    .run()
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Token {
    Number(f64),
    Variable(Axis),
    Mark(char),
    Name,
    End,
}

/// An operator that waits for its right operand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Operator {
    Open,
    Add,
    Subtract,
    Multiply,
    Divide,
    Negate,
    Power,
}

impl Operator {
    /// Whether it is applied before `next`, which follows its right operand, is pushed.
    fn binds_tighter_than(self, next: Self) -> bool {
        // A power's exponent may be signed or a power itself, so powers wait for what follows.
        self.rank() > next.rank() || (self.rank() == next.rank() && next != Self::Power)
    }

    fn rank(self) -> u8 {
        match self {
            Self::Open => 0,
            Self::Add | Self::Subtract => 1,
            Self::Multiply | Self::Divide => 2,
            Self::Negate => 3,
            Self::Power => 4,
        }
    }
}

struct Evaluator<'a> {
    text: &'a str,
    limits: Limits<'a>,
    operators: Vec<(Operator, Range<usize>)>,
    operands: Vec<Terms>,
}

impl Evaluator<'_> {
    fn run(mut self) -> Result<Terms, ExpressionError> {
        let mut input = LocatingSlice::new(self.text);
        let mut operand_due = true;
        loop {
            let (token, at) = next(&mut input);
            match (token, operand_due) {
                (Token::Number(value), true) => {
                    if !value.is_finite() {
                        return Err(self.refuse(Refusal::NotFinite, at));
                    }
                    self.operands.push(Terms::constant(value));
                    operand_due = false;
                }
                (Token::Variable(axis), true) => {
                    self.operands.push(Terms::variable(axis));
                    operand_due = false;
                }
                (Token::Mark('('), true) => self.operators.push((Operator::Open, at)),
                (Token::Mark('-'), true) => self.operators.push((Operator::Negate, at)),
                (Token::Mark('+'), true) => {}
                (Token::Mark(mark @ ('+' | '-' | '*' | '/' | '^')), false) => {
                    let operator = match mark {
                        '+' => Operator::Add,
                        '-' => Operator::Subtract,
                        '*' => Operator::Multiply,
                        '/' => Operator::Divide,
                        _ => Operator::Power,
                    };
                    self.apply_while(|waiting| waiting.binds_tighter_than(operator))?;
                    self.operators.push((operator, at));
                    operand_due = true;
                }
                (Token::Mark(')'), false) => {
                    self.apply_while(|waiting| waiting != Operator::Open)?;
                    if self.operators.pop().is_none() {
                        return Err(error(at, "this `)` closes nothing", "remove it"));
                    }
                }
                (Token::End, false) => {
                    self.apply_while(|waiting| waiting != Operator::Open)?;
                    if let Some((_, open)) = self.operators.pop() {
                        return Err(error(open, "this `(` is never closed", "add a `)`"));
                    }
                    return match self.operands.pop() {
                        Some(result) => Ok(result),
                        None => Err(self.unexpected(Token::End, at, true)),
                    };
                }
                _ => return Err(self.unexpected(token, at, operand_due)),
            }
        }
    }

    fn unexpected(&self, token: Token, at: Range<usize>, operand_due: bool) -> ExpressionError {
        let found = self.text.get(at.clone()).unwrap_or_default();
        match (token, operand_due) {
            (Token::End, _) => error(
                at,
                "the expression ends where a number or x, y, z was expected",
                "complete it, as in \"x^2 + y^2 - 1\"",
            ),
            (Token::Name, true) => error(
                at,
                &format!("unknown name `{found}`"),
                "variables are x, y and z; functions have no place in a polynomial",
            ),
            (_, true) => error(
                at,
                &format!(
                    "expected a number, x, y, z or `(`, found `{}`",
                    found.escape_debug()
                ),
                None,
            ),
            (Token::Number(_) | Token::Variable(_) | Token::Mark('('), false) => error(
                at,
                &format!("expected an operator, found `{found}`"),
                "write * between factors, as in 2*x",
            ),
            (_, false) => error(
                at,
                &format!("expected an operator, found `{}`", found.escape_debug()),
                None,
            ),
        }
    }

    /// Applies waiting operators from the top of the stack.
    fn apply_while(
        &mut self,
        waits_no_more: impl Fn(Operator) -> bool,
    ) -> Result<(), ExpressionError> {
        while let Some((operator, at)) = self.operators.pop_if(|(o, _)| waits_no_more(*o)) {
            let result = self.apply(operator);
            match result {
                Ok(Some(value)) => self.operands.push(value),
                Ok(None) => return Err(self.unexpected(Token::End, at, true)),
                Err(refusal) => return Err(self.refuse(refusal, at)),
            }
        }
        Ok(())
    }

    /// `None` if operands are missing, which the grammar excludes.
    fn apply(&mut self, operator: Operator) -> Result<Option<Terms>, Refusal> {
        let Some(right) = self.operands.pop() else {
            return Ok(None);
        };
        if operator == Operator::Negate {
            return right.scaled(-1.0, &mut self.limits).map(Some);
        }
        let Some(left) = self.operands.pop() else {
            return Ok(None);
        };
        let limits = &mut self.limits;
        match operator {
            Operator::Add => left.plus(right, 1.0, limits),
            Operator::Subtract => left.plus(right, -1.0, limits),
            Operator::Multiply => left.times(&right, limits),
            Operator::Divide => left.over(&right, limits),
            Operator::Power => left.to_the(&right, limits),
            Operator::Open | Operator::Negate => return Ok(None),
        }
        .map(Some)
    }

    fn refuse(&self, refusal: Refusal, at: Range<usize>) -> ExpressionError {
        let max = self.limits.max_degree;
        match refusal {
            Refusal::Degree(degree) => error(
                at,
                &format!("degree {degree} is above the limit of {max}"),
                "split the solid into set operations on polynomials of lower degree",
            ),
            Refusal::NotFinite => error(
                at,
                "the coefficients become too large for a number",
                "scale the expression",
            ),
            Refusal::DivisorNotConstant => error(
                at,
                "only constants can divide a polynomial",
                "multiply the whole inequality by the denominator, minding its sign",
            ),
            Refusal::DivisionByZero => error(at, "division by zero", None),
            Refusal::Exponent => error(
                at,
                "an exponent must be a whole number, zero or more",
                "write a product such as x^2*y",
            ),
            Refusal::Work => error(
                at,
                "multiplying the expression out takes too long",
                "factor it into set operations on simpler polynomials",
            ),
        }
    }
}

fn error<'r>(
    at: Range<usize>,
    message: &str,
    remedy: impl Into<Option<&'r str>>,
) -> ExpressionError {
    ExpressionError {
        span: at,
        message: message.to_owned(),
        remedy: remedy.into().map(str::to_owned),
    }
}

fn next(input: &mut LocatingSlice<&str>) -> (Token, Range<usize>) {
    let blanks: Result<&str, ()> = take_while(0.., char::is_whitespace).parse_next(input);
    debug_assert!(blanks.is_ok(), "zero blanks are enough");
    let start = input.current_token_start();
    let token = word(input).unwrap_or(Token::End);
    (token, start..input.previous_token_end().max(start))
}

fn word(input: &mut LocatingSlice<&str>) -> Result<Token, ()> {
    let mut name =
        take_while(1.., |c: char| c.is_alphanumeric() || c == '_').map(|name| match name {
            "x" => Token::Variable(Axis::X),
            "y" => Token::Variable(Axis::Y),
            "z" => Token::Variable(Axis::Z),
            _ => Token::Name,
        });
    dispatch! { peek(any);
        '0'..='9' => decimal.map(Token::Number),
        '.' => alt((decimal.map(Token::Number), any.map(Token::Mark))),
        // Fortran's and Python's power.
        '*' => alt((preceded("**", winnow::combinator::empty).value(Token::Mark('^')), any.map(Token::Mark))),
        c if c.is_alphabetic() || c == '_' => name,
        _ => any.map(Token::Mark),
    }
    .parse_next(input)
}

#[cfg(test)]
mod tests;
