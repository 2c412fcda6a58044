//! Decimal numbers as programs write them.

use winnow::LocatingSlice;
use winnow::combinator::{alt, opt};
use winnow::prelude::*;
use winnow::token::{one_of, take_while};

/// An unsigned decimal number such as `12`, `.5`, `5.` or `1.25e-3`.
///
/// Too large ones become infinite, too small ones zero, as IEEE 754 has it.
pub(crate) fn decimal(input: &mut LocatingSlice<&str>) -> Result<f64, ()> {
    let digits = |least: usize| take_while(least.., '0'..='9');
    let mantissa = alt((
        (digits(1), opt(('.', digits(0)))).void(),
        ('.', digits(1)).void(),
    ));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digits(1));
    (mantissa, opt(exponent))
        .take()
        .parse_to()
        .parse_next(input)
}
