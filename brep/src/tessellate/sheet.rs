//! The true surface of a face, to measure and to project onto.

use csg::{Domain, Polynomial, Primitive, Surface};
use glam::{DMat3, DVec3};

/// A surface in model units.
#[derive(Clone, Debug)]
pub(super) enum Sheet<'a> {
    /// A plane.
    Plane { normal: DVec3, offset: f64 },
    /// A sphere.
    Sphere { center: DVec3, radius: f64 },
    /// A circular cylinder.
    Cylinder {
        point: DVec3,
        axis: DVec3,
        radius: f64,
    },
    /// A circular double cone, with the cosine and sine of its half-angle.
    Cone {
        apex: DVec3,
        axis: DVec3,
        cos: f64,
        sin: f64,
    },
    /// A torus.
    Torus {
        center: DVec3,
        axis: DVec3,
        ring: f64,
        tube: f64,
    },
    /// Where a polynomial over the domain's coordinates is zero.
    Implicit {
        polynomial: &'a Polynomial,
        domain: &'a Domain,
    },
}

/// Newton's steps onto a surface, at most. They double the digits each time.
const STEPS: usize = 12;

impl<'a> Sheet<'a> {
    pub(super) fn of(primitive: &'a Primitive, domain: &'a Domain) -> Self {
        match primitive.surface(domain) {
            Surface::Plane { normal, offset } => Self::Plane { normal, offset },
            Surface::Sphere { center, radius } => Self::Sphere { center, radius },
            Surface::Cylinder {
                point,
                axis,
                radius,
            } => Self::Cylinder {
                point,
                axis,
                radius,
            },
            Surface::Cone {
                apex,
                axis,
                half_angle_rad,
            } => Self::Cone {
                apex,
                axis,
                cos: half_angle_rad.cos(),
                sin: half_angle_rad.sin(),
            },
            Surface::Torus {
                center,
                axis,
                ring,
                tube,
            } => Self::Torus {
                center,
                axis,
                ring,
                tube,
            },
            _ => Self::Implicit {
                polynomial: &primitive.polynomial,
                domain,
            },
        }
    }

    pub(super) fn is_plane(&self) -> bool {
        matches!(self, Self::Plane { .. })
    }

    /// Whether distances along a chord follow a parabola.
    pub(super) fn is_quadric(&self) -> bool {
        match self {
            Self::Plane { .. }
            | Self::Sphere { .. }
            | Self::Cylinder { .. }
            | Self::Cone { .. } => true,
            Self::Torus { .. } => false,
            Self::Implicit { polynomial, .. } => polynomial.degree() <= 2,
        }
    }

    /// Distance from the surface, signed, and the unit normal there (to the first order for
    /// implicit surfaces). The normal is zero where there is none.
    #[inline]
    pub(super) fn at(&self, p: DVec3) -> (f64, DVec3) {
        match *self {
            Self::Plane { normal, offset } => (normal.dot(p) - offset, normal),
            Self::Sphere { center, radius } => {
                let out = p - center;
                let length = out.length();
                (length - radius, out / length)
            }
            Self::Cylinder {
                point,
                axis,
                radius,
            } => {
                let out = (p - point).reject_from_normalized(axis);
                let length = out.length();
                (length - radius, out / length)
            }
            Self::Cone {
                apex,
                axis,
                cos,
                sin,
            } => {
                let from_apex = p - apex;
                let height = from_apex.dot(axis);
                let out = from_apex - height * axis;
                let length = out.length();
                let distance = length * cos - height.abs() * sin;
                if length <= 1e-12 * apex.abs().max_element() {
                    return (distance, DVec3::ZERO);
                }
                let normal = out * (cos / length) - axis * (sin * height.signum());
                (distance, normal)
            }
            Self::Torus {
                center,
                axis,
                ring,
                tube,
            } => {
                let from_center = p - center;
                let height = from_center.dot(axis);
                let out = from_center - height * axis;
                let toward = out.normalize_or_zero() * ring;
                let from_ring = from_center - toward;
                let length = from_ring.length();
                (length - tube, from_ring / length)
            }
            Self::Implicit { polynomial, domain } => {
                let at = domain.to_centered(p);
                let gradient = polynomial.gradient(at);
                let slope = gradient.length();
                if slope == 0.0 {
                    return (f64::INFINITY, DVec3::ZERO);
                }
                let value = polynomial.evaluate(at);
                (value / slope * domain.half_size(), gradient / slope)
            }
        }
    }

    /// The distance that [`Self::at`] gives, without the normal.
    pub(super) fn distance(&self, p: DVec3) -> f64 {
        self.at(p).0
    }

    /// The point of the surface below or above `p`, along its normals.
    pub(super) fn project(&self, mut p: DVec3, rounding: f64) -> Option<DVec3> {
        for _ in 0..STEPS {
            let (distance, normal) = self.at(p);
            if !distance.is_finite() || !normal.is_finite() {
                return None;
            }
            p -= distance * normal;
            if distance.abs() <= rounding {
                return Some(p);
            }
        }
        None
    }

    /// Largest distance of a chord from the surface on which its ends lie. A quadric's deviation
    /// along a chord is a parabola, so that its middle says all; others are looked at thrice.
    pub(super) fn chord_error(&self, a: DVec3, b: DVec3) -> f64 {
        let at = |t: f64| self.distance(a.lerp(b, t)).abs();
        if self.is_plane() {
            0.0
        } else if self.is_quadric() {
            at(0.5)
        } else {
            at(0.5).max(at(0.25)).max(at(0.75))
        }
    }
}

/// The point on both surfaces that is nearest to `p`, to the first order in each step; `None`
/// where they are tangent or far away.
pub(super) fn project_on_both(
    sheets: [&Sheet<'_>; 2],
    mut p: DVec3,
    rounding: f64,
) -> Option<DVec3> {
    for _ in 0..STEPS {
        let [(d0, n0), (d1, n1)] = sheets.map(|sheet| sheet.at(p));
        let cos = n0.dot(n1);
        // The squared sine of the angle between the normals; below 0.06° Newton gains nothing.
        let sin2 = 1.0 - cos * cos;
        if sin2 <= 1e-6 || !sin2.is_finite() || !d0.is_finite() || !d1.is_finite() {
            return None;
        }
        p += ((cos * d1 - d0) * n0 + (cos * d0 - d1) * n1) / sin2;
        if d0.abs().max(d1.abs()) <= rounding {
            return Some(p);
        }
    }
    None
}

/// The point on three or more surfaces near `p`; `None` where they do not meet in one point.
pub(super) fn project_on_all(sheets: &[&Sheet<'_>], mut p: DVec3, rounding: f64) -> Option<DVec3> {
    for _ in 0..STEPS {
        let mut square = DMat3::ZERO;
        let mut right = DVec3::ZERO;
        let mut farthest = 0.0f64;
        for sheet in sheets {
            let (distance, normal) = sheet.at(p);
            square += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z);
            right += distance * normal;
            farthest = farthest.max(distance.abs());
        }
        let volume = square.determinant();
        if volume <= 1e-9 || !volume.is_finite() || !farthest.is_finite() {
            return None;
        }
        p -= square.inverse() * right;
        if farthest <= rounding {
            return Some(p);
        }
    }
    None
}

/// Largest deviation of a triangle whose edges deviate by these amounts in their middles: the
/// maximum over the triangle of the quadratic that vanishes in its corners.
pub(super) fn facet_error([a, b, c]: [f64; 3]) -> f64 {
    // λᵀMλ with M's entries 2a, 2b, 2c: stationary inside only under the triangle inequality.
    let inside = a + b > c && b + c > a && c + a > b;
    if inside {
        4.0 * a * b * c / (2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c)
    } else {
        a.max(b).max(c)
    }
}
