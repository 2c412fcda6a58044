//! Solids bounded by functions that are not polynomials (thesis 6.3.5): expressions with roots,
//! sines, exponentials, whose sign in a simplex is proved by interval arithmetic.
//!
//! They have no Bernstein form, so nothing is inherited from simplex to simplex: each is bounded
//! anew in each one, and its values at the leaves' vertices make the affine interpolants. All
//! leaves have one level; the mesh is closed, but nothing is proved of its distance.
//!
//! ```
//! use subdiv::functions::{Bound, Expression, subdivide};
//! // Where exp(−x² − y² − z²) ≥ ½: a ball.
//! let [x, y, z] = Expression::variables();
//! let blob = Expression::from(0.5) - (-(x.clone() * x + y.clone() * y + z.clone() * z)).exp();
//! let cube = csg::Domain::around(&csg::Aabb {
//!     min: glam::DVec3::NEG_ONE,
//!     max: glam::DVec3::ONE,
//! });
//! let inside = csg::Formula::new(vec![csg::FormulaNode::Literal(csg::Literal {
//!     primitive: csg::PrimitiveId(0),
//!     sense: csg::Sense::Inside,
//!     material: csg::MaterialId(0),
//! })]);
//! let inside = inside.ok_or("one literal is a formula")?;
//! let outcome = subdivide(&[blob], &inside, &cube, 12, Bound::Slope)?;
//! assert!(!outcome.fragments.triangles.is_empty());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use crate::error::Error;
use crate::extract::{Extractor, LeafError};
use crate::fragments::Fragments;
use crate::lattice::{MAX_LEVEL, Point};
use crate::mesh::{MeshBuilder, join};
use crate::simplex::Simplex;
use crate::walk::{Active, Frame};
use csg::{Domain, Formula, FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};
use expression::Scratch;
use glam::DVec3;
use interval::Interval;
use rayon::prelude::*;

mod expression;
mod interval;

pub use expression::Expression;

/// How the range of an expression in a simplex is bounded.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Bound {
    /// By interval arithmetic over the simplex' bounding box.
    Interval,
    /// By the value at the barycentre and intervals of the gradient, as Lipschitz' criterion
    /// (thesis 4.4.1) does with one constant; or by the interval, whichever is sharper.
    #[default]
    Slope,
}

/// What subdivision yields.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct FunctionOutcome {
    /// The boundary, in model units; closed unless it leaves the domain.
    pub fragments: Fragments,
    /// Simplices looked at.
    pub simplices: u64,
    /// Ranges bounded.
    pub bounds: u64,
    /// Simplices at the last level whose formula is undecided.
    pub leaves: u64,
}

/// Subdivides a domain down to `level`.
///
/// `formula`: over the functions, whose half-space is f ≤ 0. The solid should lie inside of the
/// domain: clip it with affine functions if need be.
///
/// # Errors
/// [`Error::Level`], [`Error::TooManySurfaces`].
pub fn subdivide(
    functions: &[Expression],
    formula: &Formula,
    domain: &Domain,
    level: u8,
    bound: Bound,
) -> Result<FunctionOutcome, Error> {
    if level > MAX_LEVEL {
        return Err(Error::Level {
            asked: level,
            deepest: MAX_LEVEL,
        });
    }
    let parts: Result<Vec<_>, Error> = Simplex::roots()
        .into_par_iter()
        .map(|root| {
            let mut descent = Descent {
                functions,
                domain,
                level,
                bound,
                mesh: MeshBuilder::new(&root),
                counts: [0; 3],
                extractor: Extractor::default(),
                frame: Frame::default(),
                values: vec![Ternary::Unknown; functions.len()],
                localizing: LocalizeScratch::default(),
                scratch: Scratch::default(),
            };
            descent.visit(&root, formula.nodes())?;
            descent.mesh.finish();
            Ok((descent.mesh, descent.counts))
        })
        .collect();
    let (meshes, counts): (Vec<_>, Vec<_>) = parts?.into_iter().unzip();
    let (fragments, _) = join(meshes, |unit| domain.from_unit(unit));
    let sum = |at: usize| counts.iter().map(|count| count[at]).sum();
    Ok(FunctionOutcome {
        fragments,
        simplices: sum(0),
        bounds: sum(1),
        leaves: sum(2),
    })
}

struct Descent<'a> {
    functions: &'a [Expression],
    domain: &'a Domain,
    level: u8,
    bound: Bound,
    mesh: MeshBuilder,
    /// Simplices, bounds, leaves.
    counts: [u64; 3],
    extractor: Extractor,
    frame: Frame,
    values: Vec<Ternary>,
    localizing: LocalizeScratch,
    scratch: Scratch,
}

impl Descent<'_> {
    /// The recursion is as deep as there are levels, whatever the input.
    fn visit(&mut self, simplex: &Simplex, formula: &[FormulaNode]) -> Result<(), Error> {
        self.counts[0] += 1;
        let corners = simplex
            .vertices
            .map(|vertex| self.domain.from_unit(vertex.position()));
        for primitive in primitives(formula) {
            let function = &self.functions[primitive as usize];
            let range = range(function, &corners, self.bound, &mut self.scratch);
            self.values[primitive as usize] = range.sign();
            self.counts[1] += 1;
        }
        let mut pruned = Vec::with_capacity(formula.len());
        let values = &self.values;
        let value = |p: PrimitiveId| values[p.0 as usize];
        if localize(formula, value, &mut pruned, &mut self.localizing) != Ternary::Unknown {
            return Ok(());
        }
        if simplex.level < self.level {
            for child in simplex.children() {
                self.visit(&child, &pruned)?;
            }
            return Ok(());
        }
        self.counts[2] += 1;
        self.leaf(simplex, &pruned)
    }

    fn leaf(&mut self, simplex: &Simplex, formula: &[FormulaNode]) -> Result<(), Error> {
        let frame = &mut self.frame;
        frame.coefficients.clear();
        frame.active.clear();
        frame.formula.clear();
        frame.formula.extend_from_slice(formula);
        let corners = simplex.vertices.map(Point::position);
        for primitive in primitives(formula) {
            let offset = frame.coefficients.len() as u32;
            let function = &self.functions[primitive as usize];
            let scratch = &mut self.scratch;
            let value = |unit: DVec3| function.value(self.domain.from_unit(unit), scratch);
            frame.coefficients.extend(corners.map(value));
            frame.active.push(Active::unbounded(primitive, 1, offset));
        }
        let extracted = self
            .extractor
            .extract_affine(simplex, frame, &mut self.mesh);
        extracted
            .map(|_| ())
            .map_err(|LeafError::TooManyPrimitives(count)| {
                let place = self.domain.from_unit(corners[0]);
                Error::TooManySurfaces {
                    count,
                    x: place.x,
                    y: place.y,
                    z: place.z,
                }
            })
    }
}

/// Those of a formula, ascending.
fn primitives(formula: &[FormulaNode]) -> Vec<u32> {
    let literals = formula.iter().filter_map(|node| match node {
        FormulaNode::Literal(literal) => Some(literal.primitive.0),
        _ => None,
    });
    let mut primitives: Vec<u32> = literals.collect();
    primitives.sort_unstable();
    primitives.dedup();
    primitives
}

/// The range of a function in a simplex.
fn range(
    function: &Expression,
    corners: &[DVec3; 4],
    bound: Bound,
    scratch: &mut Scratch,
) -> Interval {
    let [a, b, c, d] = *corners;
    let (low, high) = (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)));
    let cell = [0, 1, 2].map(|axis| Interval::new(low[axis], high[axis]));
    if bound == Bound::Interval {
        return function.range(cell, scratch);
    }
    let (own, gradient) = function.range_and_gradient(cell, scratch);
    if own.sign() != Ternary::Unknown {
        return own;
    }
    let middle = (a + b + c + d) * 0.25;
    let at_middle = function.range([0, 1, 2].map(|axis| Interval::of(middle[axis])), scratch);
    let change = corners.map(|corner| {
        let [x, y, z] = [0, 1, 2]
            .map(|axis| gradient[axis] * (Interval::of(corner[axis]) - Interval::of(middle[axis])));
        x + y + z
    });
    let change = change.into_iter().reduce(Interval::hull).unwrap_or(own);
    own.intersection(at_middle + change)
}
