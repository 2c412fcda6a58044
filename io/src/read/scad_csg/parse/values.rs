//! Arguments and the literals in them.

use super::super::ast::{Argument, Value};
use super::super::program::Sign;
use super::super::token::{Span, Token};
use super::{GivenUp, Outcome, Parser, Stop, index};

impl<'a> Parser<'a, '_> {
    /// `args? ')'`
    pub(super) fn arguments(&mut self) -> Outcome<'a, Result<(), GivenUp>> {
        loop {
            if self.eat(')') {
                return Ok(Ok(()));
            }
            let mut name = None;
            if self.token == Token::Name && literal(self.span.of(self.text)).is_none() {
                let at = self.span;
                self.advance();
                if !self.eat('=') {
                    return self.not_a_literal(at).map(Err);
                }
                name = Some(at);
            }
            let value = index(self.ast.values.len());
            self.ast.arguments.push(Argument { name, value });
            if self.value()?.is_err() {
                return Ok(Err(GivenUp));
            }
            match self.token {
                Token::Mark(',') => self.advance(),
                Token::Mark(')') => {}
                _ => return self.after_value("`,` or `)`").map(Err),
            }
        }
    }

    /// A name stands where a value should, and the parser stands after it.
    fn not_a_literal(&mut self, at: Span) -> Outcome<'a, GivenUp> {
        let name = at.of(self.text);
        let nearest = ["true", "false", "undef"]
            .into_iter()
            .find(|known| strsim::osa_distance(name, known) == 1);
        if let Some(known) = nearest {
            let remedy = Some(format!("did you mean `{known}`?"));
            self.error(at, format!("unknown value `{name}`"), remedy)?;
            return Ok(GivenUp);
        }
        let sign = match self.token {
            Token::Mark('(') => Sign::Function(name),
            _ => Sign::Variable(name),
        };
        Err(Stop::Program(sign, at))
    }

    /// Something that is no separator follows a value.
    fn after_value(&mut self, expected: &str) -> Outcome<'a, GivenUp> {
        match self.token {
            Token::Mark(
                mark @ ('+' | '-' | '*' | '/' | '%' | '^' | '<' | '>' | '=' | '!' | '?' | ':' | '&'
                | '|' | '[' | '.'),
            ) => Err(Stop::Program(Sign::Operator(mark), self.span)),
            _ => self.unexpected(expected).map(|()| GivenUp),
        }
    }

    /// One literal; `lists` is the stack of those that are being read.
    fn value(&mut self) -> Outcome<'a, Result<(), GivenUp>> {
        let mut lists: Vec<usize> = Vec::new();
        loop {
            if self.token == Token::Mark('[') {
                lists.push(self.ast.values.len());
                self.ast.values.push((Value::List { end: 0 }, self.span));
                self.advance();
            } else if !self.at_list_end(&lists) && self.scalar()?.is_err() {
                return Ok(Err(GivenUp));
            }
            // Close what ends here, and see whether another element follows.
            loop {
                let Some(&list) = lists.last() else {
                    return Ok(Ok(()));
                };
                let fresh = list + 1 == self.ast.values.len();
                if self.eat(']') {
                    let end = index(self.ast.values.len());
                    if let Some((value, span)) = self.ast.values.get_mut(list) {
                        *value = Value::List { end };
                        *span = span.to(self.previous);
                    }
                    lists.pop();
                } else if fresh || self.eat(',') {
                    break;
                } else {
                    return self.after_value("`,` or `]`").map(Err);
                }
            }
        }
    }

    /// Whether the `]` ahead closes a list after a comma, as in `[1, 2, ]`.
    fn at_list_end(&self, lists: &[usize]) -> bool {
        self.token == Token::Mark(']') && !lists.is_empty() && self.previous.of(self.text) == ","
    }

    fn scalar(&mut self) -> Outcome<'a, Result<(), GivenUp>> {
        let begin = self.span;
        let mut sign = None;
        if let Token::Mark(mark @ ('-' | '+')) = self.token {
            sign = Some(if mark == '-' { -1.0 } else { 1.0 });
            self.advance();
        }
        let value = match (self.token, sign) {
            (Token::Number(number), _) => Value::Number(sign.unwrap_or(1.0) * number),
            (Token::Text, None) => Value::Text,
            (Token::Name, _) => {
                let at = self.span;
                match (literal(at.of(self.text)), sign) {
                    (Some(Value::Number(number)), _) => Value::Number(sign.unwrap_or(1.0) * number),
                    (Some(value), None) => value,
                    _ => {
                        self.advance();
                        return self.not_a_literal(at).map(Err);
                    }
                }
            }
            (Token::Mark('('), _) => return Err(Stop::Program(Sign::Operator('('), self.span)),
            (Token::Mark('!'), _) => return Err(Stop::Program(Sign::Operator('!'), self.span)),
            _ => {
                self.unexpected("a value")?;
                return Ok(Err(GivenUp));
            }
        };
        self.ast.values.push((value, begin.to(self.span)));
        self.advance();
        Ok(Ok(()))
    }
}

/// The value of a name that is a literal.
fn literal(name: &str) -> Option<Value> {
    Some(match name {
        "true" => Value::Bool(true),
        "false" => Value::Bool(false),
        "undef" => Value::Undefined,
        "inf" => Value::Number(f64::INFINITY),
        "nan" => Value::Number(f64::NAN),
        _ => return None,
    })
}
