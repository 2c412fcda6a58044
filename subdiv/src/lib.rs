//! Adaptive simplicial subdivision: from a [`csg::Solid`] to its piecewise linear boundary.
//!
//! The domain cube is cut into six Kuhn simplices, each bisected again and again where the
//! boundary is. Polynomials travel down as Bernstein–Bézier coefficients; their signs prove
//! simplices empty or full and prune the formula. In each leaf every polynomial is replaced by
//! its affine interpolant and the formula is evaluated exactly over the arrangement of a few
//! planes (da Silva's thesis, chapters 3 and 4).
//!
//! Guaranteed for every input: the triangles form a closed, oriented 2-manifold without
//! boundary; walls between different primitives survive at any thickness; the result depends on
//! the solid and the settings only, not on the number of threads. With [`Rule::Tolerance`] the
//! distance between mesh and true boundary, creases, corners and rounding included, is proved to be
//! within the tolerance, except at the leaves that the report lists as uncertified.
//!
//! Not guaranteed: that a component of one primitive is found which is smaller than the leaves
//! at a fixed level, or that pieces of different uncertified leaves have the true topology.
//!
//! ```
//! use csg::{ModelBuilder, Node, Shape, Solid};
//! let mut model = ModelBuilder::new();
//! let ball = model.add(Node::Shape(Shape::Ellipsoid(csg::Ellipsoid::new(glam::DVec3::ONE)?)));
//! let solid = Solid::build(&model.finish(ball), None)?;
//! let settings = subdiv::Settings::new(subdiv::Rule::Tolerance(0.01));
//! let outcome = subdiv::convert(&solid, &settings, &())?;
//! assert!(outcome.report.largest_deviation < Some(0.01));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![expect(
    clippy::cast_possible_truncation,
    reason = "indices are 32 bits wide on purpose; the limit on cells keeps them in range"
)]

mod arrange;
mod balance;
mod barycentric;
mod bernstein;
mod blossom;
mod certify;
mod classify;
mod convert;
mod deviation;
mod direction;
mod error;
mod extract;
mod fragments;
pub mod functions;
mod halving;
mod harvest;
mod hessian;
mod kernel;
mod lattice;
mod leaf;
mod leaf_formula;
mod limits;
mod lipschitz;
mod margin;
mod mesh;
pub mod methods;
mod patterns;
mod pieces;
mod polygon;
mod predicates;
mod prove;
pub mod rays;
mod remainder;
mod rounding;
pub mod sectors;
mod settings;
mod sheets;
mod simplex;
mod snap;
mod specks;
mod topology;
mod trail;
mod untangle;
mod vertices;
mod volume;
mod walk;

pub use classify::Criterion;
pub use convert::{Outcome, convert};
pub use error::Error;
pub use fragments::{Fragments, Triangle, VertexKind};
pub use lattice::MAX_LEVEL;
pub use settings::{MAX_SPOTS, Observer, Reason, Report, Rule, Settings, Spot};
