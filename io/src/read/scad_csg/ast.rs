//! The parsed file: flat arrays in prefix order, so that no depth of nesting needs recursion.

use super::token::Span;
use std::ops::Range;

/// A whole file; its top level is an implicit union.
#[derive(Clone, Debug, Default)]
pub(super) struct Ast {
    /// All calls in prefix order: a node is followed by its subtree.
    pub(super) nodes: Vec<Call>,
    /// The arguments of all calls.
    pub(super) arguments: Vec<Argument>,
    /// The values of all arguments in prefix order: a list is followed by its elements.
    pub(super) values: Vec<(Value, Span)>,
}

/// `modifiers name(arguments) { subtree }`.
#[derive(Clone, Debug)]
pub(super) struct Call {
    /// The name.
    pub(super) name: Span,
    /// The marks before it.
    pub(super) modifiers: Modifiers,
    /// Indices into [`Ast::arguments`].
    pub(super) arguments: Range<u32>,
    /// Index after the last node of the subtree.
    pub(super) end: u32,
}

/// The marks that may stand before a call.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(super) struct Modifiers {
    /// `*` or `%`: not part of the solid.
    pub(super) removed: bool,
    /// `*` itself: not even evaluated.
    pub(super) disabled: bool,
    /// `!`: only this subtree is the model.
    pub(super) root: bool,
}

/// `name = value`, or a value alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Argument {
    /// The name, if one was given.
    pub(super) name: Option<Span>,
    /// Index into [`Ast::values`].
    pub(super) value: u32,
}

/// A literal.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Value {
    /// A number, perhaps infinite or not a number.
    Number(f64),
    /// `true` or `false`.
    Bool(bool),
    /// `undef`.
    Undefined,
    /// A string; the value's span includes its quotes.
    Text,
    /// A list: its elements follow, up to index `end` of [`Ast::values`].
    List {
        /// Index after its last element.
        end: u32,
    },
}

impl Ast {
    /// The literal at an index, with its place.
    pub(super) fn value(&self, at: u32) -> (Value, Span) {
        self.values
            .get(at as usize)
            .copied()
            .unwrap_or((Value::Undefined, Span::default()))
    }

    /// The indices of a list's elements; of none when the value is no list.
    pub(super) fn elements(&self, list: u32) -> impl Iterator<Item = u32> {
        let end = match self.value(list).0 {
            Value::List { end } => end,
            _ => 0,
        };
        let mut next = list + 1;
        std::iter::from_fn(move || {
            let at = (next < end).then_some(next)?;
            next = match self.value(at).0 {
                Value::List { end } => end,
                _ => at + 1,
            };
            Some(at)
        })
    }
}
