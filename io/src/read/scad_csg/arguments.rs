//! Arguments of a call, matched to the node's parameters and checked for their type.

use super::ast::{Ast, Call, Value};
use super::complaints::{Complaints, Reported};
use super::nodes::{Entry, nearest};
use super::token::Span;

/// The arguments of one call.
pub(super) struct Arguments<'a> {
    text: &'a str,
    ast: &'a Ast,
    /// The call's name, for complaints about what is missing.
    pub(super) name: Span,
    entry: &'static Entry,
    /// Given values by parameter, as indices into [`Ast::values`].
    given: Vec<Option<u32>>,
    /// `$fn`, if given.
    fragments: Option<u32>,
}

/// Arguments that change nothing about the solid, or only how finely OpenSCAD would facet it.
const IGNORED: [&str; 4] = ["convexity", "timestamp", "segments", "origin"];

/// An argument with its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Given<T> {
    pub(super) value: T,
    pub(super) at: Span,
}

impl<'a> Arguments<'a> {
    /// Matches by name, else by position. Warns about what the node does not know or is given twice.
    pub(super) fn new(
        text: &'a str,
        ast: &'a Ast,
        call: &Call,
        entry: &'static Entry,
        complaints: &mut Complaints<'_>,
    ) -> Self {
        let mut arguments = Self {
            text,
            ast,
            name: call.name,
            entry,
            given: vec![None; entry.parameters.len()],
            fragments: None,
        };
        let range = call.arguments.start as usize..call.arguments.end as usize;
        let mut next_position = 0;
        for argument in ast.arguments.get(range).unwrap_or_default() {
            let slot = match argument.name.map(|name| (name, name.of(text))) {
                None => {
                    next_position += 1;
                    arguments.given.get_mut(next_position - 1)
                }
                Some((_, "$fn")) => Some(&mut arguments.fragments),
                Some((_, name)) => {
                    let position = entry.parameters.iter().position(|known| *known == name);
                    position.and_then(|at| arguments.given.get_mut(at))
                }
            };
            let at = argument.name.unwrap_or(ast.value(argument.value).1);
            match slot {
                Some(slot) => {
                    if slot.replace(argument.value).is_some() {
                        let message =
                            format!("`{}` is given twice; the last one counts", at.of(text));
                        complaints.warn(at, message, None);
                    }
                }
                None => unknown(at, argument.name.is_some(), text, entry, complaints),
            }
        }
        arguments
    }

    /// The node's name.
    pub(super) fn node(&self) -> &'static str {
        self.entry.name
    }

    /// The value of a parameter, unless it is missing or `undef`.
    fn find(&self, parameter: &str) -> Option<u32> {
        let position = self.entry.parameters.iter().position(|p| *p == parameter)?;
        let value = self.given.get(position).copied().flatten()?;
        (self.ast.value(value).0 != Value::Undefined).then_some(value)
    }

    /// A number, if given.
    pub(super) fn number(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<f64>>, Reported> {
        self.find(parameter)
            .map(|at| self.as_number(parameter, at, complaints))
            .transpose()
    }

    fn as_number(
        &self,
        parameter: &str,
        value: u32,
        complaints: &mut Complaints<'_>,
    ) -> Result<Given<f64>, Reported> {
        match self.ast.value(value) {
            (Value::Number(value), at) => Ok(Given { value, at }),
            (_, at) => Err(self.wrong_type(parameter, "a number", at, complaints)),
        }
    }

    /// `true` or `false`; `false` if missing.
    pub(super) fn flag(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<bool, Reported> {
        let Some(value) = self.find(parameter) else {
            return Ok(false);
        };
        match self.ast.value(value) {
            (Value::Bool(flag), _) => Ok(flag),
            (Value::Number(number), _) => Ok(number != 0.0),
            (_, at) => Err(self.wrong_type(parameter, "true or false", at, complaints)),
        }
    }

    /// One flag, or a list of them; none if missing.
    pub(super) fn flags(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<Vec<bool>, Reported> {
        let Some(value) = self.find(parameter) else {
            return Ok(Vec::new());
        };
        if !matches!(self.ast.value(value).0, Value::List { .. }) {
            return Ok(vec![self.flag(parameter, complaints)?]);
        }
        let each = self.ast.elements(value).map(|at| match self.ast.value(at) {
            (Value::Bool(flag), _) => Ok(flag),
            (Value::Number(number), _) => Ok(number != 0.0),
            (_, at) => Err(self.wrong_type(parameter, "a list of true or false", at, complaints)),
        });
        each.collect()
    }

    /// A string without its quotes, if given.
    pub(super) fn string(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<&'a str>>, Reported> {
        let Some(value) = self.find(parameter) else {
            return Ok(None);
        };
        match self.ast.value(value) {
            (Value::Text, at) => {
                let at = at.without_quotes();
                let value = at.of(self.text);
                Ok(Some(Given { value, at }))
            }
            (_, at) => Err(self.wrong_type(parameter, "a string", at, complaints)),
        }
    }

    /// Whether a parameter's value is a single number.
    pub(super) fn is_number(&self, parameter: &str) -> bool {
        self.find(parameter)
            .is_some_and(|at| matches!(self.ast.value(at).0, Value::Number(_)))
    }

    /// Whether a parameter's value is a string.
    pub(super) fn is_string(&self, parameter: &str) -> bool {
        self.find(parameter)
            .is_some_and(|at| self.ast.value(at).0 == Value::Text)
    }

    /// A list of numbers, if given, with at least `least` and at most `most` of them.
    pub(super) fn numbers(
        &self,
        parameter: &str,
        least: usize,
        most: usize,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<Vec<f64>>>, Reported> {
        self.find(parameter)
            .map(|at| self.row(parameter, at, least..=most, complaints))
            .transpose()
    }

    /// Three numbers, if given.
    pub(super) fn vector(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<[f64; 3]>>, Reported> {
        let row = self.numbers(parameter, 3, 3, complaints)?;
        Ok(row.and_then(|Given { value, at }| {
            let value = value.try_into().ok()?;
            Some(Given { value, at })
        }))
    }

    fn row(
        &self,
        parameter: &str,
        list: u32,
        count: std::ops::RangeInclusive<usize>,
        complaints: &mut Complaints<'_>,
    ) -> Result<Given<Vec<f64>>, Reported> {
        let (value, at) = self.ast.value(list);
        let expected = match (count.start(), count.end()) {
            (0, _) => "a list of numbers".to_owned(),
            (a, b) if a == b => format!("a list of {a} numbers"),
            (a, b) => format!("a list of {a} to {b} numbers"),
        };
        let found = self
            .ast
            .elements(list)
            .take(count.end().saturating_add(1))
            .count();
        if !matches!(value, Value::List { .. }) || !count.contains(&found) {
            return Err(self.wrong_type(parameter, &expected, at, complaints));
        }
        let numbers = self
            .ast
            .elements(list)
            .map(|element| Ok(self.as_number(parameter, element, complaints)?.value));
        let value = numbers.collect::<Result<_, _>>()?;
        Ok(Given { value, at })
    }

    /// A list of lists of numbers, if given, each with so many of them.
    pub(super) fn rows(
        &self,
        parameter: &str,
        count: std::ops::RangeInclusive<usize>,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<Vec<Vec<f64>>>>, Reported> {
        let Some(list) = self.find(parameter) else {
            return Ok(None);
        };
        let (value, at) = self.ast.value(list);
        if !matches!(value, Value::List { .. }) {
            return Err(self.wrong_type(parameter, "a list of lists", at, complaints));
        }
        let rows = self.ast.elements(list);
        let rows = rows.map(|row| Ok(self.row(parameter, row, count.clone(), complaints)?.value));
        let value = rows.collect::<Result<_, _>>()?;
        Ok(Some(Given { value, at }))
    }

    /// A 4×4 matrix, if given, by rows; a fourth row of 0 0 0 1 may be missing.
    pub(super) fn matrix(
        &self,
        parameter: &str,
        complaints: &mut Complaints<'_>,
    ) -> Result<Option<Given<[[f64; 4]; 4]>>, Reported> {
        let Some(list) = self.find(parameter) else {
            return Ok(None);
        };
        let (value, at) = self.ast.value(list);
        let rows: Vec<u32> = self.ast.elements(list).take(5).collect();
        if !matches!(value, Value::List { .. }) || !(3..=4).contains(&rows.len()) {
            return Err(self.wrong_type(parameter, "a list of 4 rows", at, complaints));
        }
        let mut matrix = [[0.0; 4], [0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, 1.0]];
        for (row, list) in matrix.iter_mut().zip(rows) {
            let numbers = self.row(parameter, list, 4..=4, complaints)?;
            row.copy_from_slice(&numbers.value);
        }
        let value = matrix;
        Ok(Some(Given { value, at }))
    }

    /// The value of `$fn`; 0, which is "not given", if it is missing or no number.
    pub(super) fn fragments(&self) -> f64 {
        match self.fragments.map(|at| self.ast.value(at).0) {
            Some(Value::Number(number)) => number,
            _ => 0.0,
        }
    }

    /// An error: a parameter without which the node means nothing is missing.
    pub(super) fn missing(
        &self,
        parameter: &str,
        example: &str,
        complaints: &mut Complaints<'_>,
    ) -> Reported {
        let name = self.entry.name;
        complaints.error(
            self.name,
            format!("`{name}` needs `{parameter}`"),
            format!("write {name}({example})"),
        )
    }

    fn wrong_type(
        &self,
        parameter: &str,
        expected: &str,
        at: Span,
        complaints: &mut Complaints<'_>,
    ) -> Reported {
        let mut found: String = at.of(self.text).chars().take(41).collect();
        if found.chars().count() > 40 {
            found = found.chars().take(37).chain("...".chars()).collect();
        }
        complaints.error(
            at,
            format!("`{parameter}` must be {expected}, found `{found}`"),
            None,
        )
    }
}

fn unknown(
    at: Span,
    is_named: bool,
    text: &str,
    entry: &'static Entry,
    complaints: &mut Complaints<'_>,
) {
    let node = entry.name;
    if !is_named {
        let message = format!("`{node}` takes no more arguments; this one is ignored");
        complaints.warn(at, message, None);
        return;
    }
    let name = at.of(text);
    if name.starts_with('$') || IGNORED.contains(&name) {
        return;
    }
    let remedy = match nearest(name, entry.parameters.iter().copied()) {
        Some(known) => Some(format!("did you mean `{known}`?")),
        None if entry.parameters.is_empty() => None,
        None => Some(format!("it knows {}", entry.parameters.join(", "))),
    };
    let message = format!("`{node}` knows no argument `{name}`; it is ignored");
    complaints.warn(at, message, remedy);
}
