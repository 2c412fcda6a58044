//! The words of the dialect: names, numbers, strings, marks; blanks and comments between them.

use crate::read::decimal::decimal;
use std::ops::Range;
use winnow::LocatingSlice;
use winnow::combinator::{alt, delimited, dispatch, opt, peek, preceded, repeat};
use winnow::prelude::*;
use winnow::stream::Location;
use winnow::token::{any, one_of, rest, take_till, take_until, take_while};

/// A byte range of the source; files are at most [`MAX_BYTES`] long.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Span {
    start: u32,
    end: u32,
}

/// Longest source that spans can address, in bytes.
pub(super) const MAX_BYTES: usize = u32::MAX as usize;

impl Span {
    /// Offsets beyond [`MAX_BYTES`] are cut to it; `read` refuses such sources.
    pub(super) fn new(start: usize, end: usize) -> Self {
        let short = |at| u32::try_from(at).unwrap_or(u32::MAX);
        Self {
            start: short(start),
            end: short(end),
        }
    }

    /// From the beginning of the one to the end of the other.
    pub(super) fn to(self, last: Self) -> Self {
        Self {
            start: self.start,
            end: last.end,
        }
    }

    /// The content of a string.
    pub(super) fn without_quotes(self) -> Self {
        Self {
            start: self.start.saturating_add(1),
            end: self.end.saturating_sub(1),
        }
    }

    /// As a range of bytes.
    pub(super) fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// The text it covers, empty should it not be one of this source.
    pub(super) fn of(self, source: &str) -> &str {
        source.get(self.range()).unwrap_or_default()
    }
}

/// One word.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Token {
    /// `[A-Za-z_$][A-Za-z0-9_]*`, also `true`, `undef`, `inf` and the like.
    Name,
    /// A decimal number without a sign.
    Number(f64),
    /// A string; the span includes the quotes.
    Text,
    /// Any other single ASCII character that OpenSCAD knows.
    Mark(char),
    /// `<file.scad>` after `use` or `include` is not told apart: `<` is a mark.
    Unexpected(char),
    /// A string whose closing quote is missing.
    OpenText,
    /// A comment whose closing `*/` is missing.
    OpenComment,
    /// The end of the file.
    End,
}

/// The next words of a source, one at a time: nothing is stored per token.
#[derive(Clone, Debug)]
pub(super) struct Lexer<'a> {
    input: LocatingSlice<&'a str>,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(source: &'a str) -> Self {
        let mut input = LocatingSlice::new(source);
        // A byte order mark is no part of the text.
        let _: Option<char> = opt::<_, _, (), _>('\u{feff}')
            .parse_next(&mut input)
            .unwrap_or_default();
        Self { input }
    }

    /// The next word; at the end of the file [`Token::End`], again and again.
    pub(super) fn next(&mut self) -> (Token, Span) {
        let input = &mut self.input;
        let _: Result<(), ()> = blanks(input);
        let start = input.current_token_start();
        let token = if input.is_empty() {
            Token::End
        } else {
            word(input).unwrap_or(Token::End)
        };
        (
            token,
            Span::new(start, input.previous_token_end().max(start)),
        )
    }
}

/// Skips white space and complete comments.
fn blanks(input: &mut LocatingSlice<&str>) -> Result<(), ()> {
    let space = take_while(1.., char::is_whitespace).void();
    let line = ("//", take_till(0.., '\n')).void();
    let block = ("/*", take_until(0.., "*/"), "*/").void();
    repeat(0.., alt((space, line, block))).parse_next(input)
}

fn word(input: &mut LocatingSlice<&str>) -> Result<Token, ()> {
    dispatch! { peek(any);
        'A'..='Z' | 'a'..='z' | '_' | '$' => name,
        '0'..='9' => decimal.map(Token::Number),
        '.' => alt((decimal.map(Token::Number), any.map(Token::Mark))),
        '"' => alt((text, rest.value(Token::OpenText))),
        '/' => alt((preceded("/*", rest).value(Token::OpenComment), any.map(Token::Mark))),
        ' '..='~' => any.map(Token::Mark),
        _ => any.map(Token::Unexpected),
    }
    .parse_next(input)
}

fn name(input: &mut LocatingSlice<&str>) -> Result<Token, ()> {
    (
        one_of(('A'..='Z', 'a'..='z', '_', '$')),
        take_while(0.., ('A'..='Z', 'a'..='z', '0'..='9', '_')),
    )
        .value(Token::Name)
        .parse_next(input)
}

fn text(input: &mut LocatingSlice<&str>) -> Result<Token, ()> {
    let plain = take_while(1.., |c| c != '"' && c != '\\').void();
    let escaped = ('\\', any).void();
    delimited(
        '"',
        repeat::<_, _, (), _, _>(0.., alt((plain, escaped))),
        '"',
    )
    .value(Token::Text)
    .parse_next(input)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(source: &str) -> Vec<(Token, &str)> {
        let mut lexer = Lexer::new(source);
        std::iter::from_fn(|| match lexer.next() {
            (Token::End, _) => None,
            (token, span) => Some((token, span.of(source))),
        })
        .collect()
    }

    #[test]
    fn names_numbers_strings_and_marks_are_told_apart() {
        let found = words("a_1 $fn -2.5e-3 .5 5. \"q\\\"r\" [;");
        let expected = vec![
            (Token::Name, "a_1"),
            (Token::Name, "$fn"),
            (Token::Mark('-'), "-"),
            (Token::Number(2.5e-3), "2.5e-3"),
            (Token::Number(0.5), ".5"),
            (Token::Number(5.0), "5."),
            (Token::Text, r#""q\"r""#),
            (Token::Mark('['), "["),
            (Token::Mark(';'), ";"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn comments_blanks_and_the_byte_order_mark_are_skipped() {
        let found = words("\u{feff}// x\r\n/* * / ** */ a // end");
        assert_eq!(found, vec![(Token::Name, "a")]);
    }

    #[test]
    fn what_has_no_end_is_one_word_to_the_end_of_the_file() {
        assert_eq!(words("\"abc\\"), vec![(Token::OpenText, "\"abc\\")]);
        assert_eq!(words("/* abc *"), vec![(Token::OpenComment, "/* abc *")]);
    }

    #[test]
    fn an_exponent_without_digits_is_no_exponent() {
        assert_eq!(
            words("1e"),
            vec![(Token::Number(1.0), "1"), (Token::Name, "e")]
        );
        assert_eq!(
            words("1e999"),
            vec![(Token::Number(f64::INFINITY), "1e999")]
        );
    }

    #[test]
    fn foreign_characters_are_reported_one_by_one() {
        assert_eq!(
            words("\0é"),
            vec![
                (Token::Unexpected('\0'), "\0"),
                (Token::Unexpected('é'), "é")
            ]
        );
    }
}
