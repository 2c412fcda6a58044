//! Curves of a figure as surfaces that run along z, tapering or not.

use super::Curve;
use csg::{Axis, Error, Polynomial, Shape};
use glam::{DVec2, DVec3};

/// The section at height z is the figure scaled by a(z) in x and b(z) in y, both linear.
#[derive(Clone, Debug)]
pub(super) struct Taper {
    a: Polynomial,
    b: Polynomial,
    uniform: bool,
}

impl Taper {
    /// Scale 1 at z0 and `scale` at z1.
    #[expect(clippy::float_cmp, reason = "only exactly equal scales are uniform")]
    pub(super) fn new(z0: f64, z1: f64, scale: DVec2) -> Result<Self, Error> {
        let factor = |end: f64| {
            let slope = (end - 1.0) / (z1 - z0);
            Polynomial::affine(DVec3::new(0.0, 0.0, slope), z0 * slope - 1.0)
        };
        Ok(Self {
            a: factor(scale.x)?,
            b: factor(scale.y)?,
            uniform: scale.x == scale.y,
        })
    }

    /// The solid beyond the curve: with x/a for x and y/b for y, multiplied by the denominators,
    /// which are nowhere negative between the ends.
    ///
    /// Lines are planes if they are parallel to an axis or a = b, else of degree 2; conics are of
    /// degree 2 if a = b, else of degree 4.
    pub(super) fn side(&self, curve: &Curve) -> Result<Shape, Error> {
        let [xx, xy, yy, x, y, one] = curve.0;
        let (ax, ay) = (Polynomial::variable(Axis::X), Polynomial::variable(Axis::Y));
        let (a, b) = (&self.a, &self.b);
        let sum = |terms: Vec<Polynomial>| {
            let zero = Polynomial::constant(0.0)?;
            terms.iter().try_fold(zero, |sum, term| sum.sum(term))
        };
        let polynomial = if curve.is_line() {
            if self.uniform || y == 0.0 {
                sum(vec![ax.scaled(x)?, ay.scaled(y)?, a.clone().scaled(one)?])?
            } else if x == 0.0 {
                sum(vec![ay.scaled(y)?, b.clone().scaled(one)?])?
            } else {
                sum(vec![
                    ax.product(b)?.scaled(x)?,
                    ay.product(a)?.scaled(y)?,
                    a.product(b)?.scaled(one)?,
                ])?
            }
        } else {
            let (u, v, w) = if self.uniform {
                (ax, ay, a.clone())
            } else {
                (ax.product(b)?, ay.product(a)?, a.product(b)?)
            };
            sum(vec![
                u.product(&u)?.scaled(xx)?,
                u.product(&v)?.scaled(xy)?,
                v.product(&v)?.scaled(yy)?,
                u.product(&w)?.scaled(x)?,
                v.product(&w)?.scaled(y)?,
                w.product(&w)?.scaled(one)?,
            ])?
        };
        shape(polynomial.without_w_factors())
    }
}

/// A shape of a polynomial, a half-space if it is linear.
pub(super) fn shape(polynomial: Polynomial) -> Result<Shape, Error> {
    if polynomial.degree() != 1 {
        return Ok(Shape::Polynomial(polynomial));
    }
    let normal = polynomial.gradient(DVec3::ZERO);
    let offset = -polynomial.evaluate(DVec3::ZERO);
    Shape::half_space(normal, offset)
}
