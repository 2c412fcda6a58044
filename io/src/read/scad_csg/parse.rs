//! Source text to [`Ast`], without recursion, going on after errors where that is easy.

use super::ast::{Ast, Call, Modifiers};
use super::program::Sign;
use super::token::{Lexer, Span, Token};
use crate::read::diagnostic::{Diagnostic, Diagnostics, Source};

mod values;

/// Complaints after this many are not looked for.
pub(super) const MAX_ERRORS: usize = 20;

/// Parses a file.
///
/// # Errors
/// Every syntax error found, at most [`MAX_ERRORS`]; a single one if the source is a program.
pub(super) fn parse(text: &str, name: &str, source: &Source<'_>) -> Result<Ast, Diagnostics> {
    let mut parser = Parser {
        text,
        source,
        lexer: Lexer::new(text),
        token: Token::End,
        span: Span::default(),
        previous: Span::default(),
        ast: Ast::default(),
        open: Vec::new(),
        errors: Vec::new(),
    };
    parser.advance();
    if let Err(Stop::Program(sign, at)) = parser.file() {
        return Err(sign.diagnostic(source, name, at.range()).into());
    }
    match Diagnostics::new(parser.errors) {
        Some(errors) => Err(errors),
        None => Ok(parser.ast),
    }
}

/// Why parsing ends before the end of the file.
enum Stop<'a> {
    Program(Sign<'a>, Span),
    TooMany,
}

/// A node whose children are being read.
struct Open {
    node: u32,
    /// `{ ... }` around the children; without it there is exactly one, as in `scale(2) cube();`.
    braced: bool,
}

/// Recursive descent with the recursion taken out: `open` is the stack of nodes.
struct Parser<'a, 's> {
    text: &'a str,
    source: &'s Source<'s>,
    lexer: Lexer<'a>,
    token: Token,
    span: Span,
    /// Where the token before `token` stood.
    previous: Span,
    ast: Ast,
    open: Vec<Open>,
    errors: Vec<Diagnostic>,
}

type Outcome<'a, T> = Result<T, Stop<'a>>;

/// The rest of the statement was given up; parsing goes on after it.
struct GivenUp;

impl<'a> Parser<'a, '_> {
    fn advance(&mut self) {
        self.previous = self.span;
        (self.token, self.span) = self.lexer.next();
    }

    fn eat(&mut self, mark: char) -> bool {
        let found = self.token == Token::Mark(mark);
        if found {
            self.advance();
        }
        found
    }

    fn error(&mut self, at: Span, message: String, remedy: Option<String>) -> Outcome<'a, ()> {
        self.errors
            .push(self.source.diagnostic(at.range(), message, remedy));
        if self.errors.len() < MAX_ERRORS {
            Ok(())
        } else {
            Err(Stop::TooMany)
        }
    }

    /// Complains that the current token is not what should stand here.
    fn unexpected(&mut self, expected: &str) -> Outcome<'a, ()> {
        let at = self.span;
        match self.token {
            Token::OpenText => self.error(
                at,
                "the string that begins here has no end".to_owned(),
                Some("add the closing \"".to_owned()),
            ),
            Token::OpenComment => self.error(
                at,
                "the comment that begins here has no end".to_owned(),
                Some("add the closing */".to_owned()),
            ),
            Token::End => self.error(
                at,
                format!("the file ends where {expected} was expected"),
                Some("it seems to be cut off: write or copy it again".to_owned()),
            ),
            Token::Unexpected('\0') => self.error(
                at,
                format!("expected {expected}, found a NUL byte"),
                Some("the file is damaged or not text: write or copy it again".to_owned()),
            ),
            Token::Unexpected(c) => self.error(
                at,
                format!(
                    "expected {expected}, found the character `{}`",
                    c.escape_debug()
                ),
                None,
            ),
            _ => {
                let found: String = at.of(self.text).chars().take(40).collect();
                self.error(at, format!("expected {expected}, found `{found}`"), None)
            }
        }
    }

    /// `statement*`
    fn file(&mut self) -> Outcome<'a, ()> {
        loop {
            match self.token {
                Token::End => return self.end_of_file(),
                Token::Mark(';') => {
                    self.advance();
                    self.statement_ended();
                }
                Token::Mark('}') => self.closing_brace()?,
                _ => {
                    let given_up = self.statement()?.is_err();
                    if given_up {
                        self.skip_statement();
                    }
                }
            }
        }
    }

    fn end_of_file(&mut self) -> Outcome<'a, ()> {
        let missing = self.open.iter().filter(|open| open.braced).count();
        let Some(open) = self.open.iter().rfind(|open| open.braced) else {
            if self.open.is_empty() {
                return Ok(());
            }
            return self.unexpected("a node");
        };
        // Where a value or the like was broken off, that has been said.
        let end = self.span.range().start;
        if self.errors.last().is_some_and(|last| last.span.end >= end) {
            return Ok(());
        }
        let name = self.ast.nodes.get(open.node as usize);
        let name = name.map_or(self.span, |call| call.name);
        let (line, _) = self.source.locate(name.range().start);
        let closing = match missing {
            1 => "1 closing `}` is".to_owned(),
            more => format!("{more} closing `}}` are"),
        };
        self.error(
            self.span,
            format!(
                "the file ends inside `{}` of line {line}: {closing} missing",
                name.of(self.text)
            ),
            Some("it seems to be cut off: write or copy it again".to_owned()),
        )
    }

    fn closing_brace(&mut self) -> Outcome<'a, ()> {
        if self.open.last().is_some_and(|open| !open.braced) {
            self.unexpected("a node")?;
            self.statement_ended();
        }
        if let Some(open) = self.open.pop() {
            self.close(&open);
            self.advance();
            self.statement_ended();
            return Ok(());
        }
        let at = self.span;
        self.advance();
        self.error(
            at,
            "this `}` closes nothing".to_owned(),
            Some("remove it, or add the missing `{`".to_owned()),
        )
    }

    fn close(&mut self, open: &Open) {
        let end = index(self.ast.nodes.len());
        if let Some(call) = self.ast.nodes.get_mut(open.node as usize) {
            call.end = end;
        }
    }

    /// A statement is complete, and with it those that had it as their only child.
    fn statement_ended(&mut self) {
        while let Some(open) = self.open.pop_if(|open| !open.braced) {
            self.close(&open);
        }
    }

    /// Goes on after the next `;`, or into or out of the next braces.
    fn skip_statement(&mut self) {
        loop {
            match self.token {
                Token::End | Token::Mark('}') => return,
                Token::Mark(';') => {
                    self.advance();
                    self.statement_ended();
                    return;
                }
                // The children of a broken node are worth checking, too.
                Token::Mark('{') => {
                    self.push(self.span, Modifiers::default(), 0, true);
                    self.advance();
                    return;
                }
                _ => self.advance(),
            }
        }
    }

    fn push(&mut self, name: Span, modifiers: Modifiers, first_argument: usize, braced: bool) {
        let node = index(self.ast.nodes.len());
        self.ast.nodes.push(Call {
            name,
            modifiers,
            arguments: index(first_argument)..index(self.ast.arguments.len()),
            end: node + 1,
        });
        self.open.push(Open { node, braced });
    }

    /// `modifier* NAME '(' args? ')'` and what decides about children: `;`, `{` or a node.
    fn statement(&mut self) -> Outcome<'a, Result<(), GivenUp>> {
        let mut modifiers = Modifiers::default();
        while let Token::Mark(mark @ ('%' | '#' | '!' | '*')) = self.token {
            modifiers.removed |= matches!(mark, '%' | '*');
            modifiers.disabled |= mark == '*';
            modifiers.root |= mark == '!';
            self.advance();
        }
        let (name, at) = (self.span.of(self.text), self.span);
        if self.token != Token::Name {
            self.unexpected("a node such as `union() {`")?;
            return Ok(Err(GivenUp));
        }
        self.advance();
        if self.token == Token::Mark('=') {
            return Err(Stop::Program(Sign::Assignment(name), at));
        }
        if let Some(sign) = Sign::of_statement(name) {
            return Err(Stop::Program(sign, at));
        }
        if !self.eat('(') {
            self.unexpected(&format!("`(` after `{name}`"))?;
            return Ok(Err(GivenUp));
        }
        let first = self.ast.arguments.len();
        if self.arguments()?.is_err() {
            return Ok(Err(GivenUp));
        }
        match self.token {
            Token::Mark(';') => {
                self.push(at, modifiers, first, false);
                self.advance();
                self.statement_ended();
            }
            Token::Mark('{') => {
                self.push(at, modifiers, first, true);
                self.advance();
            }
            Token::Name | Token::Mark('%' | '#' | '!' | '*') => {
                self.push(at, modifiers, first, false);
            }
            _ => {
                self.unexpected(&format!("`;` or `{{` after `{name}(...)`"))?;
                return Ok(Err(GivenUp));
            }
        }
        Ok(Ok(()))
    }
}

/// Every element takes at least one byte of a source of at most 4 GiB.
fn index(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}
