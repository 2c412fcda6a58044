//! Readers: bytes of a file to a [`csg::Model`].
//!
//! [`decode`](decode::decode) turns bytes into text, [`format::sniff`] tells what the text is, and
//! one module per format reads it. Nothing here opens files, prints or recurses on the depth of
//! its input, and whatever is wrong is told with its place in the file. [`mesh`] reads boundaries,
//! of any program, to check and measure them.

#![cfg_attr(not(test), deny(clippy::indexing_slicing))]

mod decimal;
pub mod decode;
mod diagnostic;
mod expression;
mod files;
pub mod format;
pub mod mesh;
pub mod scad_csg;

pub use diagnostic::{Diagnostic, Diagnostics};
pub use files::{FileRefusal, Files, FontFile, NoFiles};

/// Reads a function of x, y and z such as `sin(x)*cos(y) - exp(-z)`.
///
/// # Errors
/// What is wrong, with its place in the text: column, cause, remedy.
pub fn function(text: &str) -> Result<subdiv::functions::Expression, FunctionError> {
    expression::parse_function(text).map_err(|wrong| FunctionError {
        column: text
            .get(..wrong.span.start)
            .map_or(0, |before| before.chars().count())
            + 1,
        message: wrong.message,
        remedy: wrong.remedy.map_or_else(String::new, |r| format!(" ({r})")),
    })
}

/// A text that is no function.
///
/// Displays as `column 5: unknown name `tan` (known are …)`.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[error("column {column}: {message}{remedy}")]
pub struct FunctionError {
    /// Where, from 1.
    pub column: usize,
    /// What is wrong.
    pub message: String,
    /// What to do, in parentheses, or nothing.
    pub remedy: String,
}

/// What a reader may decide.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ReadOptions {
    /// The largest explicit `$fn` that is taken literally (default 16).
    ///
    /// OpenSCAD knows no curves: `$fn` says how many sides stand for a circle. Here a cylinder
    /// with 0 < `$fn` ≤ `facet_limit` is the prism it says (a nut trap has `$fn = 6`), a sphere
    /// OpenSCAD's polyhedron; with `$fn = 0` or a larger one the author means round, and gets
    /// the true surface. 0 makes everything round.
    pub facet_limit: u32,
    /// The highest degree of a polynomial, at most [`csg::MAX_DEGREE`] (default: that).
    pub max_degree: u8,
}

impl Default for ReadOptions {
    fn default() -> Self {
        Self {
            facet_limit: 16,
            max_degree: 64,
        }
    }
}

/// What a reader makes of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct Reading {
    /// The model.
    pub model: csg::Model,
    /// What was dropped, ignored or taken in a way that the author may not expect.
    pub warnings: Vec<Diagnostic>,
    /// Nodes without a closed form, for which something flat was taken; the warnings say how near.
    pub approximated_nodes: u64,
}
