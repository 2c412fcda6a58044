//! Writers: a validated boundary to the bytes of a file.
//!
//! Each writer takes a [`Valid<Brep>`](brep::Valid), the materials that its facets name, its own
//! options, and anything that implements [`std::io::Write`]; [`atomic`] puts the bytes into a
//! file. Same input, same bytes: nothing here knows a date, a path or the number of threads. The
//! empty solid is legal everywhere.

mod appearance;
mod decimal;
mod error;
mod unit;

pub mod atomic;
pub mod gltf;
pub mod obj;
pub mod page;
pub mod picture;
pub mod ply;
pub mod step;
pub mod stl;
pub mod threemf;

pub use error::Error;
pub use unit::Unit;

#[cfg(test)]
#[allow(dead_code, reason = "each crate's tests need other samples")]
#[path = "../../../brep/src/samples.rs"]
pub(crate) mod samples;

/// Name and version, as files say who made them.
const GENERATOR: &str = concat!("csg2brep ", env!("CARGO_PKG_VERSION"));
