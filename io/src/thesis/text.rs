//! Numbers in the thesis' two text files.

use super::{Error, Problem};

/// A word of a text with its line and byte offset.
#[derive(Clone, Copy, Debug)]
pub(super) struct Word<'a> {
    pub(super) text: &'a str,
    pub(super) line: usize,
    pub(super) offset: usize,
}

impl Word<'_> {
    pub(super) fn error(&self, expected: &'static str) -> Error {
        Error {
            offset: self.offset,
            problem: Problem::Text {
                line: self.line,
                expected,
                found: self.text.chars().take(40).collect(),
            },
            little_endian: false,
        }
    }

    pub(super) fn parse<T: std::str::FromStr>(&self, expected: &'static str) -> Result<T, Error> {
        self.text.parse().map_err(|_| self.error(expected))
    }
}

/// The words of a text.
pub(super) fn words(text: &str) -> impl Iterator<Item = Word<'_>> {
    let base = text.as_ptr() as usize;
    (1..).zip(text.lines()).flat_map(move |(line, content)| {
        content.split_ascii_whitespace().map(move |word| Word {
            text: word,
            line,
            offset: word.as_ptr() as usize - base,
        })
    })
}

/// The end of a text, for complaints about what is missing.
pub(super) fn end(text: &str) -> Word<'static> {
    Word {
        text: "the end of the file",
        line: text.lines().count().max(1),
        offset: text.len(),
    }
}
