//! What is wrong in a file, where, and what to do about it.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// One complaint about a place in a text file.
///
/// Displays as `cube.csg:12:8: radius must be positive, found -3 (write r = 3)`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostic {
    /// What was expected and what was found, lowercase, without a trailing period.
    pub message: String,
    /// What the user can do, in the same form.
    pub remedy: Option<String>,
    /// Byte range in the text that was read.
    pub span: Range<usize>,
    /// Line of the span's start, from 1.
    pub line: usize,
    /// Column of the span's start in characters, from 1.
    pub column: usize,
    /// Name of the file, as the caller gave it.
    pub file: Arc<str>,
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            file, line, column, ..
        } = self;
        write!(f, "{file}:{line}:{column}: {}", self.message)?;
        match &self.remedy {
            Some(remedy) => write!(f, " ({remedy})"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for Diagnostic {}

/// Everything that keeps a file from being read: at least one [`Diagnostic`], in file order.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// Takes a list; `None` when it is empty.
    #[must_use]
    pub fn new(mut list: Vec<Diagnostic>) -> Option<Self> {
        list.sort_by_key(|d| d.span.start);
        (!list.is_empty()).then_some(Self(list))
    }

    /// The complaints, in file order; never empty.
    #[must_use]
    pub fn as_slice(&self) -> &[Diagnostic] {
        &self.0
    }

    /// The complaints, in file order; never empty.
    #[must_use]
    pub fn into_vec(self) -> Vec<Diagnostic> {
        self.0
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        Self(vec![one])
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, one) in self.0.iter().enumerate() {
            if at > 0 {
                writeln!(f)?;
            }
            write!(f, "{one}")?;
        }
        Ok(())
    }
}

impl std::error::Error for Diagnostics {}

/// A named text, and where its lines begin: turns byte ranges into lines and columns.
#[derive(Clone, Debug)]
pub(crate) struct Source<'a> {
    text: &'a str,
    name: Arc<str>,
    line_starts: Vec<usize>,
}

impl<'a> Source<'a> {
    /// Lines end at `\n`, so that `\r\n` counts once and belongs to the line it ends.
    pub(crate) fn new(text: &'a str, name: &str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        Self {
            text,
            name: name.into(),
            line_starts: std::iter::once(0)
                .chain(ends.map(|(at, _)| at + 1))
                .collect(),
        }
    }

    /// The line and column, both from 1, of a byte offset.
    pub(crate) fn locate(&self, offset: usize) -> (usize, usize) {
        let offset = offset.min(self.text.len());
        let line = self.line_starts.partition_point(|start| *start <= offset);
        let start = self.line_starts.get(line - 1).copied().unwrap_or(0);
        // Offsets come from the lexer and stand at character borders.
        let column = self
            .text
            .get(start..offset)
            .map_or(0, |s| s.chars().count());
        (line, column + 1)
    }

    /// A complaint about a byte range.
    pub(crate) fn diagnostic(
        &self,
        span: Range<usize>,
        message: impl Into<String>,
        remedy: impl Into<Option<String>>,
    ) -> Diagnostic {
        let (line, column) = self.locate(span.start);
        Diagnostic {
            message: message.into(),
            remedy: remedy.into(),
            span,
            line,
            column,
            file: Arc::clone(&self.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters_and_lines_count_line_feeds() {
        let source = Source::new("a\r\nβγ cube\n", "x.csg");
        assert_eq!(source.locate(0), (1, 1));
        assert_eq!(source.locate(3), (2, 1));
        assert_eq!(source.locate(8), (2, 4));
        assert_eq!(source.locate(13), (3, 1));
        assert_eq!(source.locate(99), (3, 1));
        assert_eq!(Source::new("", "").locate(0), (1, 1));
    }

    #[test]
    fn it_displays_as_place_cause_and_remedy() {
        let source = Source::new("\n\nsphere(r = -3);", "cube.csg");
        let found = source.diagnostic(
            13..15,
            "radius must be positive, found -3",
            Some("write r = 3".to_owned()),
        );
        assert_eq!(
            found.to_string(),
            "cube.csg:3:12: radius must be positive, found -3 (write r = 3)"
        );
    }

    #[test]
    fn no_complaint_is_no_error() {
        assert!(Diagnostics::new(Vec::new()).is_none());
    }
}
