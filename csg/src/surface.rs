//! What surface a polynomial describes: the inverse of the shapes' constructions.
//!
//! Quadrics are told apart by their principal axes: the eigenvalues of the quadratic part, then
//! what is left after completing squares. A number that is larger than what the polynomial's own
//! coefficient error can make of zero has its sign for certain; a smaller one counts as zero. So
//! classes that no small change of coefficients can leave (ellipsoids, hyperboloids) are proved,
//! and of the others (cones, cylinders, spheres, planes …) it is proved that the coefficients
//! agree with such a surface within their error.

mod quadric;
mod quadric_form;
mod torus;

pub use quadric_form::QuadricForm;

use crate::{Domain, Polynomial, Primitive};
use glam::DVec3;

/// A surface in model units. Directions and normals have length 1; their signs are arbitrary but
/// for a plane's normal, which points to where the polynomial is positive.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub enum Surface {
    /// All points p with `normal · p = offset`.
    Plane {
        /// Its normal.
        normal: DVec3,
        /// Signed distance from the origin along the normal.
        offset: f64,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A circular cylinder.
    Cylinder {
        /// The point of its axis nearest to the origin.
        point: DVec3,
        /// Direction of its axis.
        axis: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A circular double cone.
    Cone {
        /// Where its nappes meet.
        apex: DVec3,
        /// Direction of its axis.
        axis: DVec3,
        /// Angle between axis and surface, in (0, π/2).
        half_angle_rad: f64,
    },
    /// A torus; it crosses itself if `ring` < `tube`.
    Torus {
        /// Its centre.
        center: DVec3,
        /// Direction of its axis.
        axis: DVec3,
        /// Radius of the circle that the tube follows.
        ring: f64,
        /// Radius of the tube.
        tube: f64,
    },
    /// Any other surface of degree 2.
    Quadric(QuadricForm),
    /// Any other surface of this degree.
    Algebraic {
        /// Degree of the polynomial.
        degree: usize,
    },
    /// No surface: a polynomial that does not change, within its error.
    Constant,
}

/// The classes of quadrics that have no [`Surface`] of their own; their equations are in
/// [`QuadricForm`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum QuadricKind {
    /// An ellipsoid that is no sphere.
    Ellipsoid,
    /// A cylinder over an ellipse that is no circle.
    EllipticCylinder,
    /// A cone over an ellipse that is no circle.
    EllipticCone,
    /// A cylinder over a hyperbola.
    HyperbolicCylinder,
    /// A cylinder over a parabola.
    ParabolicCylinder,
    /// A bowl.
    EllipticParaboloid,
    /// A saddle.
    HyperbolicParaboloid,
    /// A hyperboloid in one piece.
    HyperboloidOfOneSheet,
    /// A hyperboloid in two pieces.
    HyperboloidOfTwoSheets,
    /// Two planes that cross.
    CrossingPlanes,
    /// Two parallel planes.
    ParallelPlanes,
    /// One plane, twice.
    DoublePlane,
    /// A single line, where two imaginary planes cross.
    Line,
    /// A single point, the apex of an imaginary cone.
    Point,
    /// No real point: the sum of three squares is negative.
    ImaginaryEllipsoid,
    /// No real point: the sum of two squares is negative.
    ImaginaryCylinder,
    /// No real point: a square is negative.
    ImaginaryPlanes,
}

impl Primitive {
    /// The surface on which the polynomial is zero, in model units; `domain` is that of the
    /// solid to which the primitive belongs.
    ///
    /// Cost: constant up to degree 4, and for degrees above.
    #[must_use]
    pub fn surface(&self, domain: &Domain) -> Surface {
        let error = self.coefficient_error + f64::EPSILON * self.polynomial.max_abs();
        let unit = match self.polynomial.degree() {
            0 => Surface::Constant,
            1 => plane(&self.polynomial),
            2 => quadric::classify(&self.polynomial, error),
            4 => torus::recognise(&self.polynomial, error)
                .unwrap_or(Surface::Algebraic { degree: 4 }),
            degree => Surface::Algebraic { degree },
        };
        unit.in_model(domain)
    }
}

fn plane(p: &Polynomial) -> Surface {
    let c = p.coefficients();
    let normal = DVec3::new(c[0], c[1], c[2]);
    let length = normal.length();
    if length == 0.0 {
        return Surface::Constant;
    }
    Surface::Plane {
        normal: normal / length,
        offset: -c[3] / length,
    }
}

impl Surface {
    /// The surface given in a domain's centred coordinates, in model units: moved and scaled.
    fn in_model(self, domain: &Domain) -> Self {
        let (at, size) = (|p| domain.from_centered(p), domain.half_size());
        match self {
            Self::Plane { normal, offset } => Self::Plane {
                normal,
                offset: offset * size + normal.dot(domain.center()),
            },
            Self::Sphere { center, radius } => Self::Sphere {
                center: at(center),
                radius: radius * size,
            },
            Self::Cylinder {
                point,
                axis,
                radius,
            } => Self::Cylinder {
                point: at(point).reject_from_normalized(axis),
                axis,
                radius: radius * size,
            },
            Self::Cone {
                apex,
                axis,
                half_angle_rad,
            } => Self::Cone {
                apex: at(apex),
                axis,
                half_angle_rad,
            },
            Self::Torus {
                center,
                axis,
                ring,
                tube,
            } => Self::Torus {
                center: at(center),
                axis,
                ring: ring * size,
                tube: tube * size,
            },
            Self::Quadric(form) => Self::Quadric(form.in_model(domain)),
            Self::Algebraic { .. } | Self::Constant => self,
        }
    }
}

#[cfg(test)]
mod tests;
