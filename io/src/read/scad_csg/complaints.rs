//! Where errors and warnings are collected while a file's meaning is worked out.

use super::parse::MAX_ERRORS;
use super::token::Span;
use crate::read::diagnostic::{Diagnostic, Source};
use std::collections::BTreeMap;

/// Warnings after this many are only counted.
const MAX_WARNINGS: usize = 50;

/// The errors and warnings of one file.
pub(super) struct Complaints<'s> {
    source: &'s Source<'s>,
    errors: Vec<Diagnostic>,
    warnings: Vec<Diagnostic>,
    /// Warnings beyond [`MAX_WARNINGS`], and the place of the first of them.
    unlisted: Option<(usize, Span)>,
    /// Things that are told once and counted: the first complaint's index, and how many more.
    repeated: BTreeMap<String, Repeated>,
}

#[derive(Clone, Copy)]
struct Repeated {
    is_error: bool,
    at: usize,
    more: usize,
}

/// An error was reported; the value is unusable.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Reported;

impl<'s> Complaints<'s> {
    pub(super) fn new(source: &'s Source<'s>) -> Self {
        Self {
            source,
            errors: Vec::new(),
            warnings: Vec::new(),
            unlisted: None,
            repeated: BTreeMap::new(),
        }
    }

    /// Whether looking for more errors is pointless.
    pub(super) fn are_too_many(&self) -> bool {
        self.errors.len() >= MAX_ERRORS
    }

    pub(super) fn error(
        &mut self,
        at: Span,
        message: impl Into<String>,
        remedy: impl Into<Option<String>>,
    ) -> Reported {
        let error = self.source.diagnostic(at.range(), message, remedy);
        self.errors.push(error);
        Reported
    }

    pub(super) fn warn(
        &mut self,
        at: Span,
        message: impl Into<String>,
        remedy: impl Into<Option<String>>,
    ) {
        if self.warnings.len() < MAX_WARNINGS {
            let warning = self.source.diagnostic(at.range(), message, remedy);
            self.warnings.push(warning);
        } else {
            self.unlisted.get_or_insert((0, at)).0 += 1;
        }
    }

    /// An error that is told once for all nodes of this name.
    pub(super) fn error_once(
        &mut self,
        name: &str,
        at: Span,
        message: String,
        remedy: Option<String>,
    ) {
        if let Some(repeated) = self.repeated.get_mut(name) {
            repeated.more += 1;
            return;
        }
        let (is_error, index) = (true, self.errors.len());
        self.error(at, message, remedy);
        self.remember(name, is_error, index);
    }

    /// A warning that is told once for all things of this name.
    pub(super) fn warn_once(
        &mut self,
        name: &str,
        at: Span,
        message: String,
        remedy: Option<String>,
    ) {
        if let Some(repeated) = self.repeated.get_mut(name) {
            repeated.more += 1;
            return;
        }
        let (is_error, index) = (false, self.warnings.len());
        self.warn(at, message, remedy);
        self.remember(name, is_error, index);
    }

    fn remember(&mut self, name: &str, is_error: bool, at: usize) {
        let repeated = Repeated {
            is_error,
            at,
            more: 0,
        };
        self.repeated.insert(name.to_owned(), repeated);
    }

    /// All errors and all warnings.
    pub(super) fn finish(mut self) -> (Vec<Diagnostic>, Vec<Diagnostic>) {
        for repeated in self.repeated.values().filter(|r| r.more > 0) {
            let list = if repeated.is_error {
                &mut self.errors
            } else {
                &mut self.warnings
            };
            if let Some(first) = list.get_mut(repeated.at) {
                let again = match repeated.more {
                    1 => "once".to_owned(),
                    more => format!("{more} times"),
                };
                first.message = format!("{}, here and {again} more", first.message);
            }
        }
        if let Some((more, at)) = self.unlisted {
            let message = format!("{more} more warnings from here on are not listed");
            self.warnings
                .push(self.source.diagnostic(at.range(), message, None));
        }
        (self.errors, self.warnings)
    }
}
