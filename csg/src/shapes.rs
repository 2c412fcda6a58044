//! The shapes, one per file, each with its validating constructor.

mod block;
mod convex_polyhedron;
mod cylinder;
mod ellipsoid;
mod frustum;
mod half_space;
mod helicoid;
mod prism;
mod quadric;
mod torus;

pub use block::Block;
pub use convex_polyhedron::ConvexPolyhedron;
pub use cylinder::Cylinder;
pub use ellipsoid::Ellipsoid;
pub use frustum::Frustum;
pub use half_space::HalfSpace;
pub use helicoid::Helicoid;
pub use prism::Prism;
pub use quadric::Quadric;
pub use torus::Torus;

use crate::Polynomial;
use crate::error::Error;
use glam::DVec3;

/// The half-spaces z ≥ z0 and z ≤ z1.
fn slab(z0: f64, z1: f64) -> Result<[Polynomial; 2], Error> {
    Ok([
        Polynomial::affine(-DVec3::Z, -z0)?,
        Polynomial::affine(DVec3::Z, z1)?,
    ])
}
