//! The file formats of the thesis (Appendix A), byte for byte, reading and writing.
//!
//! | module | file | thesis |
//! | --- | --- | --- |
//! | [`solid`] | `.CSG`, what a user describes | A.2.1 |
//! | [`sectors`] | `.cspg`, Bézier coefficients in simplices; back to polynomials: [`power_form`] | A.3.1 |
//! | [`approximation`] | `.apl`, the boundary's triangles | A.3.3.1 |
//! | [`subdivision`] | the tree of simplices | A.3.3.2 |
//! | [`wireframe`] | `.wfr` of LCGRENDERER | A.5.2 |
//! | [`projection`] | `sisproj.dat` | A.4.3 |
//! | [`colors`] | `tabcor.dat` | A.4.4 |
//! | [`display`] | the picture that VISUAL shows | A.4 |
//!
//! The first five are binary: `int` and `float` take 4 bytes, `double` 8, big-endian as on the
//! Sun workstations, without padding. A reader tries big-endian first and takes little-endian
//! where only that reading makes sense. No count from a file is trusted: memory is taken for what
//! the bytes that are left can hold. Nothing recurses on the depth of a tree.

pub mod approximation;
mod bytes;
pub mod colors;
pub mod display;
mod error;
pub mod power_form;
pub mod projection;
pub mod sectors;
pub mod solid;
pub mod subdivision;
mod text;
pub mod tree;
pub mod wireframe;

pub use bytes::{ByteOrder, Decoded};
pub use error::{Error, Problem};

#[cfg(test)]
mod tests;
