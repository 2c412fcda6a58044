//! Solids built from models, compared with the models' definition.

#![expect(
    clippy::unwrap_used,
    reason = "these are tests, but clippy sees only test functions"
)]

mod extents;
mod interning;
mod membership;
mod oracle;
mod rounding;
mod scale;
