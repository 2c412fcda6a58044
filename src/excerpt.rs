//! The piece of a source that a diagnostic is about, for [`miette`] to draw.

use io::read::Diagnostic;
use miette::SpanContents;
use miette::{LabeledSpan, MietteError, MietteSpanContents, Severity, SourceCode, SourceSpan};
use std::fmt;

/// Characters shown before and after the beginning of the place; dumps may be one long line.
const BEFORE: usize = 60;
const AFTER: usize = 100;

/// A [`Diagnostic`] together with the line it is about.
#[derive(Debug)]
pub(crate) struct Excerpt<'a> {
    diagnostic: &'a Diagnostic,
    severity: Severity,
    line: LineExcerpt,
    label: SourceSpan,
}

/// One line, or the part of it around the place.
#[derive(Debug)]
struct LineExcerpt {
    text: String,
    name: String,
    line: usize,
    /// Column of the place, counted from 0; the drawing's title shows it.
    column: usize,
}

impl<'a> Excerpt<'a> {
    /// `source`: the text that the diagnostic's span refers to.
    pub(crate) fn new(diagnostic: &'a Diagnostic, source: &str, severity: Severity) -> Self {
        let at = diagnostic.span.start;
        let before = source.get(..at).unwrap_or_default();
        let rest = source.get(at..).unwrap_or_default();
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let left: String = last(before.get(line_start..).unwrap_or_default(), BEFORE);
        let line_rest = rest.split('\n').next().unwrap_or_default();
        let right: String = line_rest.chars().take(AFTER).map(visible).collect();
        let length = diagnostic.span.len().min(line_rest.len());
        let marked = line_rest.get(..length).unwrap_or_default();
        let marked: usize = marked
            .chars()
            .take(AFTER)
            .map(|c| visible(c).len_utf8())
            .sum();
        Self {
            diagnostic,
            severity,
            label: SourceSpan::from((left.len(), marked)),
            line: LineExcerpt {
                column: diagnostic.column.saturating_sub(1),
                text: left + right.trim_end(),
                name: diagnostic.file.to_string(),
                line: diagnostic.line,
            },
        }
    }

    /// Whether there is nothing to show.
    pub(crate) fn is_blank(&self) -> bool {
        self.line.text.trim().is_empty()
    }
}

/// The last `count` characters.
fn last(text: &str, count: usize) -> String {
    let skipped = text.chars().count().saturating_sub(count);
    text.chars().skip(skipped).map(visible).collect()
}

/// Control characters must not reach a terminal.
fn visible(c: char) -> char {
    match c {
        '\t' | '\r' => ' ',
        c if c.is_control() || c == '\u{feff}' => char::REPLACEMENT_CHARACTER,
        c => c,
    }
}

impl fmt::Display for Excerpt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.diagnostic.message)
    }
}

impl std::error::Error for Excerpt<'_> {}

impl miette::Diagnostic for Excerpt<'_> {
    fn severity(&self) -> Option<Severity> {
        Some(self.severity)
    }

    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let remedy = self.diagnostic.remedy.as_ref()?;
        Some(Box::new(remedy))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(&self.line)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::new_with_span(None, self.label);
        Some(Box::new(std::iter::once(label)))
    }
}

impl SourceCode for LineExcerpt {
    fn read_span<'a>(
        &'a self,
        _: &SourceSpan,
        _: usize,
        _: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let whole = SourceSpan::from((0, self.text.len()));
        Ok(Box::new(MietteSpanContents::new_named(
            self.name.clone(),
            self.text.as_bytes(),
            whole,
            self.line - 1,
            self.column,
            1,
        )))
    }
}
