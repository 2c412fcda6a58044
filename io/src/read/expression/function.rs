//! Functions as people write them, also such as are no polynomials: `sin(x)*cos(y) - exp(-z)`.
//!
//! The grammar is that of polynomials with `sqrt(…)`, `sin(…)`, `cos(…)`, `exp(…)`, `pi`, and
//! divisors of any kind. Exponents are whole numbers from −64 to 64.

use super::{ExpressionError, Operator, Token, error, next};
use csg::Axis;
use std::ops::Range;
use subdiv::functions::Expression;
use winnow::LocatingSlice;

/// Most operations of a function: each is done again in every simplex.
const LONGEST: usize = 10_000;

/// Highest power.
const HIGHEST: f64 = 64.0;

/// A function and, if it is constant, its value.
struct Operand {
    function: Expression,
    constant: Option<f64>,
}

/// What waits on the stack.
enum Waiting {
    Operator(Operator),
    /// An opened call.
    Call(fn(Expression) -> Expression, fn(f64) -> f64),
}

/// Reads a function of x, y and z.
///
/// # Errors
/// The first thing that is no expression, or one that is too long.
pub(crate) fn parse_function(text: &str) -> Result<Expression, ExpressionError> {
    let mut input = LocatingSlice::new(text);
    let mut waiting: Vec<(Waiting, Range<usize>)> = Vec::new();
    let mut operands: Vec<Operand> = Vec::new();
    let mut operand_due = true;
    loop {
        let (token, at) = next(&mut input);
        let found = text.get(at.clone()).unwrap_or_default();
        match (token, operand_due) {
            (Token::Number(value), true) if value.is_finite() => {
                operands.push(constant(value));
                operand_due = false;
            }
            (Token::Variable(axis), true) => {
                operands.push(variable(axis));
                operand_due = false;
            }
            (Token::Name, true) if found == "pi" => {
                operands.push(constant(std::f64::consts::PI));
                operand_due = false;
            }
            (Token::Name, true) => {
                let Some(call) = call(found) else {
                    return Err(error(
                        at,
                        &format!("unknown name `{found}`"),
                        "known are x, y, z, pi, sqrt, sin, cos and exp",
                    ));
                };
                let (token, open) = next(&mut input);
                if token != Token::Mark('(') {
                    let text = format!("expected `(` after `{found}`");
                    return Err(error(open, &text, "write its argument, as in sin(x)"));
                }
                waiting.push((call, at));
            }
            (Token::Mark('('), true) => waiting.push((Waiting::Operator(Operator::Open), at)),
            (Token::Mark('-'), true) => waiting.push((Waiting::Operator(Operator::Negate), at)),
            (Token::Mark('+'), true) => {}
            (Token::Mark(mark @ ('+' | '-' | '*' | '/' | '^')), false) => {
                let operator = match mark {
                    '+' => Operator::Add,
                    '-' => Operator::Subtract,
                    '*' => Operator::Multiply,
                    '/' => Operator::Divide,
                    _ => Operator::Power,
                };
                apply_while(&mut waiting, &mut operands, |o| {
                    o.binds_tighter_than(operator)
                })?;
                waiting.push((Waiting::Operator(operator), at));
                operand_due = true;
            }
            (Token::Mark(')'), false) => {
                apply_while(&mut waiting, &mut operands, |_| true)?;
                match waiting.pop() {
                    None => return Err(error(at, "this `)` closes nothing", "remove it")),
                    Some((Waiting::Call(function, number), _)) => {
                        let argument = operands.pop().map(|operand| Operand {
                            function: function(operand.function),
                            constant: operand.constant.map(number),
                        });
                        operands.extend(argument);
                    }
                    Some((Waiting::Operator(_), _)) => {}
                }
            }
            (Token::End, false) => {
                apply_while(&mut waiting, &mut operands, |_| true)?;
                if let Some((_, open)) = waiting.pop() {
                    return Err(error(open, "this `(` is never closed", "add a `)`"));
                }
                return match operands.pop() {
                    Some(result) => Ok(result.function),
                    None => Err(error(at, "the expression is empty", None)),
                };
            }
            (Token::End, true) => {
                let text = "the expression ends where a number, a variable or a function was due";
                return Err(error(at, text, "complete it, as in \"sin(x) + y\""));
            }
            (_, due) => {
                let expected = if due {
                    "a number, a variable, a function or `(`"
                } else {
                    "an operator"
                };
                let found = found.escape_debug();
                let text = format!("expected {expected}, found `{found}`");
                return Err(error(at, &text, None));
            }
        }
    }
}

fn constant(value: f64) -> Operand {
    Operand {
        function: Expression::from(value),
        constant: Some(value),
    }
}

fn variable(axis: Axis) -> Operand {
    let [x, y, z] = Expression::variables();
    Operand {
        function: match axis {
            Axis::X => x,
            Axis::Y => y,
            Axis::Z => z,
        },
        constant: None,
    }
}

fn call(name: &str) -> Option<Waiting> {
    match name {
        "sqrt" => Some(Waiting::Call(Expression::sqrt, |x| x.max(0.0).sqrt())),
        "sin" => Some(Waiting::Call(Expression::sin, f64::sin)),
        "cos" => Some(Waiting::Call(Expression::cos, f64::cos)),
        "exp" => Some(Waiting::Call(Expression::exp, f64::exp)),
        _ => None,
    }
}

/// Applies waiting operators from the top of the stack, down to what is open.
fn apply_while(
    waiting: &mut Vec<(Waiting, Range<usize>)>,
    operands: &mut Vec<Operand>,
    waits_no_more: impl Fn(Operator) -> bool,
) -> Result<(), ExpressionError> {
    let ends = |(waiting, _): &mut (Waiting, Range<usize>)| match waiting {
        Waiting::Operator(operator) => *operator != Operator::Open && waits_no_more(*operator),
        Waiting::Call(..) => false,
    };
    while let Some((Waiting::Operator(operator), at)) = waiting.pop_if(ends) {
        let right = operands.pop().unwrap_or(constant(0.0));
        let result = if operator == Operator::Negate {
            Operand {
                function: -right.function,
                constant: right.constant.map(|c| -c),
            }
        } else {
            let left = operands.pop().unwrap_or(constant(0.0));
            apply(operator, left, right, &at)?
        };
        if result.function.operation_count() > LONGEST {
            let text = format!("the function takes more than {LONGEST} operations");
            return Err(error(at, &text, "write it with fewer powers of long terms"));
        }
        operands.push(result);
    }
    Ok(())
}

fn apply(
    operator: Operator,
    left: Operand,
    right: Operand,
    at: &Range<usize>,
) -> Result<Operand, ExpressionError> {
    if operator == Operator::Power {
        let exponent = right.constant.unwrap_or(0.5);
        if exponent.fract() != 0.0 || exponent.abs() > HIGHEST {
            return Err(error(
                at.clone(),
                "an exponent must be a whole number from -64 to 64",
                "write sqrt(x), or exp(x)",
            ));
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "whole and at most 64, as was just checked"
        )]
        let exponent = exponent as i32;
        return Ok(Operand {
            function: power(&left.function, exponent),
            constant: left.constant.map(|c| c.powi(exponent)),
        });
    }
    let (a, b) = (left.function, right.function);
    let (function, number): (Expression, fn(f64, f64) -> f64) = match operator {
        Operator::Subtract => (a - b, |a, b| a - b),
        Operator::Multiply => (a * b, |a, b| a * b),
        Operator::Divide => (a / b, |a, b| a / b),
        _ => (a + b, |a, b| a + b),
    };
    let constant = left.constant.zip(right.constant);
    Ok(Operand {
        function,
        constant: constant.map(|(a, b)| number(a, b)),
    })
}

/// By squares where the exponent is even: ranges of squares are sharper than those of products.
fn power(base: &Expression, exponent: i32) -> Expression {
    let one = Expression::from(1.0);
    let mut left = exponent.unsigned_abs();
    let mut square = base.clone();
    let mut product: Option<Expression> = None;
    while left > 0 {
        if left & 1 == 1 {
            product = Some(match product {
                None => square.clone(),
                Some(product) => product * square.clone(),
            });
        }
        left >>= 1;
        if left > 0 {
            square = square.square();
        }
    }
    let product = product.unwrap_or_else(|| one.clone());
    if exponent < 0 { one / product } else { product }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_the_place() {
        for (text, start, message) in [
            ("sin x", 4, "expected `(` after `sin`"),
            ("tan(x)", 0, "unknown name `tan`"),
            ("(x", 0, "this `(` is never closed"),
            ("sin(x", 0, "this `(` is never closed"),
            ("x)", 1, "this `)` closes nothing"),
            (
                "x^y",
                1,
                "an exponent must be a whole number from -64 to 64",
            ),
            (
                "x^0.5",
                1,
                "an exponent must be a whole number from -64 to 64",
            ),
            ("x +", 3, "the expression ends where"),
            ("x y", 2, "expected an operator, found `y`"),
            (
                "((((((x+y)^63)^63)^63)^63)^63)^63",
                26,
                "the function takes more than 10000 operations",
            ),
        ] {
            let error = parse_function(text).unwrap_err();
            assert_eq!(error.span.start, start, "{text}: {}", error.message);
            assert!(error.message.starts_with(message), "{}", error.message);
        }
        // Depth costs no stack.
        let deep = "(".repeat(100_000) + "x" + &")".repeat(100_000);
        assert!(parse_function(&deep).is_ok());
    }
}
