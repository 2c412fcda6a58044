//! Constructive solid geometry: polynomials, primitives, formulas.

mod aabb;
mod bounded;
mod bounds;
mod build;
mod domain;
mod error;
mod extent;
mod formula;
mod formula_eval;
mod intern;
mod lower;
mod matrix;
mod model;
mod polynomial;
mod shape;
mod shapes;
mod simplify;
mod solid;
mod survey;
mod ternary;
mod transform;
mod walk;

pub use aabb::Aabb;
pub use domain::Domain;
pub use error::Error;
pub use formula::{Formula, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
pub use model::{Model, ModelBuilder, Node, NodeId};
pub use polynomial::{Axis, MAX_DEGREE, Polynomial};
pub use shape::Shape;
pub use shapes::{
    Block, ConvexPolyhedron, Cylinder, Ellipsoid, Frustum, HalfSpace, Helicoid, Prism, Quadric,
    Torus,
};
pub use solid::{Material, NearlyEqual, Primitive, Solid};
pub use ternary::{LocalizeScratch, Ternary, localize};
pub use transform::Transform;
