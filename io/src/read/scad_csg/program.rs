//! Signs that a source is an OpenSCAD program and not the flat dump that OpenSCAD makes of it.

use crate::read::diagnostic::{Diagnostic, Source};
use std::ops::Range;
use std::path::Path;

/// Names that begin a statement only in programs.
const STATEMENTS: [&str; 13] = [
    "module",
    "function",
    "include",
    "use",
    "for",
    "intersection_for",
    "if",
    "else",
    "let",
    "assign",
    "each",
    "echo",
    "assert",
];

/// What in the source can only be evaluated by OpenSCAD.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Sign<'a> {
    /// A statement such as `module` or `for`.
    Statement(&'a str),
    /// `name = value;`.
    Assignment(&'a str),
    /// A name where a value should stand.
    Variable(&'a str),
    /// A function call where a value should stand.
    Function(&'a str),
    /// Arithmetic, comparison, a range or the like.
    Operator(char),
}

impl<'a> Sign<'a> {
    /// Whether a statement that begins with this name is a program's.
    pub(super) fn of_statement(name: &'a str) -> Option<Self> {
        STATEMENTS.contains(&name).then_some(Self::Statement(name))
    }

    /// The complaint, whose remedy is the command that evaluates the program.
    pub(super) fn diagnostic(
        self,
        source: &Source<'_>,
        name: &str,
        at: Range<usize>,
    ) -> Diagnostic {
        let found = match self {
            Self::Statement(word) => format!("the statement `{word}`"),
            Self::Assignment(variable) => format!("an assignment to `{variable}`"),
            Self::Variable(variable) => format!("the variable `{variable}` instead of a value"),
            Self::Function(function) => format!("a call of the function `{function}`"),
            Self::Operator(mark) => format!("an expression with `{mark}`"),
        };
        source.diagnostic(
            at,
            format!("this is an OpenSCAD program, not a flat CSG dump: found {found}"),
            format!("let OpenSCAD evaluate it: {}", command(name)),
        )
    }
}

/// The command that turns the program of this name into a dump.
pub(crate) fn command(name: &str) -> String {
    let stem = Path::new(name)
        .file_stem()
        .and_then(|s| s.to_str())
        .filter(|s| !s.is_empty() && !name.starts_with(['-', '<']))
        .unwrap_or("model");
    let program = match Path::new(name).extension() {
        Some(scad) if scad == "scad" => name.to_owned(),
        _ => format!("{stem}.scad"),
    };
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "._-/".contains(c);
    let quote = |word: &str| {
        if word.chars().all(is_plain) {
            word.to_owned()
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    };
    format!(
        "openscad -o {} {}",
        quote(&format!("{stem}.csg")),
        quote(&program)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_names_the_file() {
        assert_eq!(command("a/part.scad"), "openscad -o part.csg a/part.scad");
        assert_eq!(command("part.csg"), "openscad -o part.csg part.scad");
        assert_eq!(command("-"), "openscad -o model.csg model.scad");
        assert_eq!(command("<stdin>"), "openscad -o model.csg model.scad");
        assert_eq!(command("a b.scad"), "openscad -o 'a b.csg' 'a b.scad'");
    }
}
