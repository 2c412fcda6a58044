//! Constructive solid geometry: from shapes and set operations to one formula over polynomials.
//!
//! A *solid* here is a regularized Boolean formula over half-spaces `p(x, y, z) ≤ 0`, p any
//! polynomial of degree up to [`MAX_DEGREE`]; negative is inside. A [`Model`] is what a user
//! describes: a tree of [`Shape`]s, unions, intersections, differences, complements, affine or
//! projective [`Transform`]s and materials. [`Solid::build`] turns it into what the subdivision
//! works on.
//!
//! Guaranteed of a [`Solid`]:
//! - it holds the same points as the model, but for rounding of coefficients, whose bound each
//!   [`Primitive`] carries;
//! - half-spaces that are equal up to a factor are one primitive, so flush and shared faces and
//!   A \\ A cancel by logic, not by luck;
//! - it lies in its extent and the extent in its domain; unbounded solids are clipped or refused;
//! - models of any depth and width are built without recursion and in near linear time.
//!
//! Not guaranteed: that the extent is tight for differences and intersections, that a solid is
//! recognised as empty when only geometry shows it, or that planes meant to be equal but written
//! with different digits are found equal ([`Solid::nearly_equal`] lists them).
//!
//! ```
//! use csg::{ModelBuilder, Node, Shape, Solid};
//! use glam::DVec3;
//!
//! let mut builder = ModelBuilder::new();
//! let ball = builder.add(Node::Shape(Shape::sphere(1.0)?));
//! let hole = builder.add(Node::Shape(Shape::cylinder(0.5, -2.0, 2.0)?));
//! let root = builder.add(Node::Difference(vec![ball, hole]));
//! let solid = Solid::build(&builder.finish(root), None)?;
//!
//! assert_eq!(solid.primitives.len(), 4); // a sphere, a cylinder, two planes
//! assert_eq!(solid.extent.max, DVec3::ONE);
//! assert!(solid.contains(DVec3::X * 0.75));
//! assert!(!solid.contains(DVec3::ZERO));
//! # Ok::<(), csg::Error>(())
//! ```

mod aabb;
mod bounded;
mod bounds;
mod build;
mod domain;
mod error;
mod extent;
mod facets;
mod formula;
mod formula_eval;
mod intern;
mod lower;
mod matrix;
mod model;
mod polynomial;
mod precision;
mod propagate;
mod shape;
mod shapes;
mod simplify;
mod solid;
mod surface;
mod survey;
mod ternary;
mod transform;
mod walk;

pub use aabb::Aabb;
pub use domain::{Domain, DomainFit};
pub use error::Error;
pub use facets::{FacetOnPlane, Facets, KnownBoundary, KnownFacet};
pub use formula::{Formula, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
pub use model::{Model, ModelBuilder, Node, NodeId};
pub use polynomial::{Axis, MAX_DEGREE, Polynomial};
pub use shape::Shape;
pub use shapes::{
    Block, ConvexPolyhedron, Cylinder, Ellipsoid, Frustum, HalfSpace, Helicoid, Prism, Quadric,
    Torus,
};
pub use solid::{Imprecise, Material, NearlyEqual, Primitive, Solid};
pub use surface::{QuadricForm, QuadricKind, Surface};
pub use ternary::{LocalizeScratch, Ternary, localize};
pub use transform::Transform;
