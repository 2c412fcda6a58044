//! The OpenSCAD `.csg` dialect: dumps of evaluated OpenSCAD models, and a few exact shapes more.
//!
//! ```text
//! file      := statement*
//! statement := ';' | modifier* NAME '(' args? ')' ( ';' | '{' statement* '}' | statement )
//! modifier  := '%' | '#' | '!' | '*'
//! args      := arg (',' arg)*          arg := (NAME '=')? value
//! value     := NUMBER | 'true' | 'false' | 'undef' | 'inf' | 'nan' | STRING | '[' (value (',' value)*)? ']'
//! ```
//! Nodes: `union group render intersection difference color multmatrix translate rotate scale
//! mirror resize cube sphere cylinder polyhedron linear_extrude rotate_extrude hull minkowski
//! projection square circle polygon offset fill`,
//! as OpenSCAD means them (`docs/openscad.md` says how exactly); of this project's own:
//!
//! | node | solid |
//! |---|---|
//! | `torus(r1 =, r2 =)` | about z, ring radius r1, tube radius r2 |
//! | `halfspace(n = [a, b, c], d =)` | a·x + b·y + c·z ≤ d |
//! | `quadric([[4×4]])` | \[x y z 1\] M \[x y z 1\]ᵀ ≤ 0 |
//! | `polynomial("x^2 + y^2 - 1")` | expression ≤ 0; `+ - * / ^ ( )`, numbers, x, y, z |
//! | `helicoid()` | the thesis' helicoid in the unit cylinder |
//!
//! Curved shapes are exact where OpenSCAD facets them, unless the author asked for few facets:
//! see [`ReadOptions::facet_limit`]. What OpenSCAD accepts and drops, such as shapes without
//! volume and singular matrices, is dropped with a warning. Nesting of any depth is read.

mod arguments;
mod ast;
mod ball_hull;
mod body;
mod color;
mod combine;
mod complaints;
mod evaluate;
mod facets;
mod figure;
mod import;
mod motion;
mod nodes;
mod parse;
mod point_hull;
mod polyhedron;
mod program;
mod reshape;
mod rounded;
mod shapes;
mod solid_hull;
mod solid_sum;
mod surface;
mod token;

use super::diagnostic::{Diagnostics, Source};
use super::{Files, NoFiles, ReadOptions, Reading};

/// Reads a model from the text of a `.csg` file that names no other files.
///
/// `name` stands for the file in complaints. A byte order mark is skipped.
///
/// ```
/// use io::read::{ReadOptions, scad_csg};
/// let text = "difference() { cube(2, center = true); sphere(r = 1.2); }";
/// let reading = scad_csg::read(text, "hollow.csg", &ReadOptions::default())?;
/// assert_eq!(reading.model.nodes().len(), 3);
/// assert!(reading.warnings.is_empty());
/// # Ok::<(), io::read::Diagnostics>(())
/// ```
///
/// # Errors
/// What keeps the file from being read, each with its place and a remedy: syntax errors, nodes
/// that are unknown or not supported, wrong arguments, or a program instead of a dump.
pub fn read(source: &str, name: &str, options: &ReadOptions) -> Result<Reading, Diagnostics> {
    read_with(source, name, options, &NoFiles)
}

/// Reads a model whose `import` and `surface` nodes get their files from `files`.
///
/// # Errors
/// Those of [`read`]; files that are refused or cannot be read.
pub fn read_with(
    source: &str,
    name: &str,
    options: &ReadOptions,
    files: &dyn Files,
) -> Result<Reading, Diagnostics> {
    let places = Source::new(source, name);
    if source.len() > token::MAX_BYTES {
        let message = "the file is longer than 4 GiB";
        return Err(places.diagnostic(0..0, message, None).into());
    }
    let ast = parse::parse(source, name, &places)?;
    evaluate::evaluate(source, &ast, &places, *options, files)
}

#[cfg(test)]
mod tests;
