//! Shapes: what a user calls a solid primitive, and the polynomial half-spaces it is made of.

use crate::bounds::{self, Support};
use crate::error::Error;
use crate::shapes::{
    Block, ConvexPolyhedron, Cylinder, Ellipsoid, Frustum, HalfSpace, Helicoid, Prism, Quadric,
    Torus,
};
use crate::{Aabb, Polynomial, Transform};
use glam::DVec3;

/// A shape in its own coordinates; place it with [`Node::Instance`](crate::Node::Instance).
#[derive(Clone, PartialEq, Debug)]
pub enum Shape {
    /// Axis-parallel box.
    Block(Block),
    /// Ellipsoid or sphere about the origin.
    Ellipsoid(Ellipsoid),
    /// Circular cylinder about the z axis.
    Cylinder(Cylinder),
    /// Circular cone or frustum about the z axis.
    Frustum(Frustum),
    /// Torus about the z axis.
    Torus(Torus),
    /// All points on one side of a plane.
    HalfSpace(HalfSpace),
    /// All points where a quadratic form is not positive.
    Quadric(Quadric),
    /// All points where a polynomial is not positive.
    Polynomial(Polynomial),
    /// The thesis' helicoid.
    Helicoid(Helicoid),
    /// Regular polygonal prism, pyramid or frustum of one about the z axis.
    Prism(Prism),
    /// Convex polyhedron.
    ConvexPolyhedron(ConvexPolyhedron),
}

impl Shape {
    /// See [`Block::new`].
    ///
    /// # Errors
    /// Those of [`Block::new`].
    pub fn block(min: DVec3, max: DVec3) -> Result<Self, Error> {
        Block::new(min, max).map(Self::Block)
    }

    /// A ball about the origin.
    ///
    /// # Errors
    /// Those of [`Ellipsoid::new`].
    pub fn sphere(radius: f64) -> Result<Self, Error> {
        Self::ellipsoid(DVec3::splat(radius))
    }

    /// See [`Ellipsoid::new`].
    ///
    /// # Errors
    /// Those of [`Ellipsoid::new`].
    pub fn ellipsoid(radii: DVec3) -> Result<Self, Error> {
        Ellipsoid::new(radii).map(Self::Ellipsoid)
    }

    /// See [`Cylinder::new`].
    ///
    /// # Errors
    /// Those of [`Cylinder::new`].
    pub fn cylinder(radius: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        Cylinder::new(radius, z0, z1).map(Self::Cylinder)
    }

    /// See [`Frustum::new`]; equal radii make a [`Cylinder`].
    ///
    /// # Errors
    /// Those of [`Frustum::new`].
    #[expect(clippy::float_cmp, reason = "only exactly equal radii make a cylinder")]
    pub fn frustum(r0: f64, r1: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        if r0 == r1 && r0 > 0.0 {
            return Self::cylinder(r0, z0, z1);
        }
        Frustum::new(r0, r1, z0, z1).map(Self::Frustum)
    }

    /// See [`Torus::new`].
    ///
    /// # Errors
    /// Those of [`Torus::new`].
    pub fn torus(ring: f64, tube: f64) -> Result<Self, Error> {
        Torus::new(ring, tube).map(Self::Torus)
    }

    /// See [`HalfSpace::new`].
    ///
    /// # Errors
    /// Those of [`HalfSpace::new`].
    pub fn half_space(normal: DVec3, offset: f64) -> Result<Self, Error> {
        HalfSpace::new(normal, offset).map(Self::HalfSpace)
    }

    /// See [`Quadric::new`].
    ///
    /// # Errors
    /// Those of [`Quadric::new`].
    pub fn quadric(matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        Quadric::new(matrix).map(Self::Quadric)
    }

    /// The thesis' helicoid.
    #[must_use]
    pub fn helicoid() -> Self {
        Self::Helicoid(Helicoid)
    }

    /// See [`Prism::new`].
    ///
    /// # Errors
    /// Those of [`Prism::new`].
    pub fn prism(sides: u32, r0: f64, r1: f64, z0: f64, z1: f64) -> Result<Self, Error> {
        Prism::new(sides, r0, r1, z0, z1).map(Self::Prism)
    }

    /// See [`ConvexPolyhedron::from_faces`].
    ///
    /// # Errors
    /// Those of [`ConvexPolyhedron::from_faces`].
    pub fn convex_polyhedron(vertices: &[DVec3], faces: &[Vec<usize>]) -> Result<Self, Error> {
        ConvexPolyhedron::from_faces(vertices, faces).map(Self::ConvexPolyhedron)
    }

    /// See [`ConvexPolyhedron::from_hull`].
    ///
    /// # Errors
    /// Those of [`ConvexPolyhedron::from_hull`].
    pub fn convex_hull(vertices: &[DVec3], triangles: &[Vec<usize>]) -> Result<Self, Error> {
        ConvexPolyhedron::from_hull(vertices, triangles).map(Self::ConvexPolyhedron)
    }

    /// The shape as a union of intersections of half-spaces `p ≤ 0`, in its own coordinates.
    ///
    /// All shapes but a self-crossing torus are a single intersection.
    ///
    /// # Errors
    /// [`Error::NonFinite`] when a coefficient overflows.
    pub fn half_spaces(&self) -> Result<Vec<Vec<Polynomial>>, Error> {
        Ok(vec![match self {
            Self::Block(s) => s.half_spaces()?,
            Self::Ellipsoid(s) => vec![s.polynomial()?],
            Self::Cylinder(s) => s.half_spaces()?,
            Self::Frustum(s) => s.half_spaces()?,
            Self::Torus(s) => return s.half_spaces(),
            Self::HalfSpace(s) => vec![s.polynomial()?],
            Self::Quadric(s) => vec![s.polynomial().clone()],
            Self::Polynomial(p) => vec![p.clone()],
            Self::Helicoid(_) => Helicoid::half_spaces()?,
            Self::Prism(s) => s.half_spaces()?,
            Self::ConvexPolyhedron(s) => s.half_spaces()?,
        }])
    }

    /// Number of half-spaces that the shape is made of.
    #[must_use]
    pub fn half_space_count(&self) -> usize {
        match self {
            Self::Block(_) => 6,
            Self::Ellipsoid(_) | Self::HalfSpace(_) | Self::Quadric(_) | Self::Polynomial(_) => 1,
            Self::Cylinder(_) | Self::Frustum(_) => 3,
            Self::Torus(s) => s.half_space_count(),
            Self::Helicoid(_) => 4,
            Self::Prism(s) => s.sides() as usize + 2,
            Self::ConvexPolyhedron(s) => s.planes().len(),
        }
    }

    /// Bounding box of the shape moved by a transform.
    ///
    /// Exact up to rounding for affine transforms; for projective ones the box of the image of
    /// the shape's own box. Polynomials of degree above 2 are not analysed here: their box is
    /// infinite.
    #[must_use]
    pub fn bounds(&self, transform: &Transform) -> Aabb {
        bounds::of_image(&self.support(), &transform.to_rows())
    }

    /// Bounding box of everything outside the shape, moved by a transform.
    #[must_use]
    pub fn complement_bounds(&self, transform: &Transform) -> Aabb {
        bounds::of_image(&self.complement_support(), &transform.to_rows())
    }

    /// How far the shape extends in each direction.
    pub(crate) fn support(&self) -> Support<'_> {
        match self {
            Self::Block(s) => Support::finite(move |d| s.support(d)),
            Self::Ellipsoid(s) => Support::finite(move |d| s.support(d)),
            Self::Cylinder(s) => Support::finite(move |d| s.support(d)),
            Self::Frustum(s) => Support::finite(move |d| s.support(d)),
            Self::Torus(s) => Support::finite(move |d| s.support(d)),
            Self::HalfSpace(s) => s.support(),
            Self::Quadric(s) => bounds::quadric_support(s.polynomial()),
            Self::Polynomial(p) => bounds::quadric_support(p),
            Self::Helicoid(_) => Support::finite(Helicoid::support),
            Self::Prism(s) => Support::finite(move |d| s.support(d)),
            Self::ConvexPolyhedron(s) => Support::finite(move |d| s.support(d)),
        }
    }

    /// How far the shape's complement extends in each direction.
    pub(crate) fn complement_support(&self) -> Support<'_> {
        match self {
            Self::HalfSpace(s) => s.complement_support(),
            Self::Quadric(s) => bounds::quadric_support(&s.polynomial().clone().negated()),
            Self::Polynomial(p) => bounds::quadric_support(&p.clone().negated()),
            _ => Support::everywhere(),
        }
    }
}

#[cfg(test)]
mod tests;
