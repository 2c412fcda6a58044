//! Curves of a figure as surfaces of revolution: x becomes the distance ρ from the z axis and
//! y becomes z.

use super::Curve;
use super::taper::shape;
use csg::{Axis, Error, ModelBuilder, Node, NodeId, Polynomial, Shape, Transform};
use glam::{DVec2, DVec3};

/// A full turn of a figure with x ≥ 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Lowest and highest z between which the result counts.
    pub(super) range: [f64; 2],
}

impl Turn {
    /// The points (ρ, z) beyond a curve.
    ///
    /// With P the terms even in ρ and ρ Q the odd ones, P + ρ Q ≤ 0 is equivalent to
    /// (P ≤ 0 ∧ Q ≤ 0) ∨ (P ≤ 0 ∧ G ≥ 0) ∨ (Q ≤ 0 ∧ G ≤ 0), where G = P² − ρ² Q²
    /// is a polynomial in x² + y² and z.
    pub(super) fn side(&self, curve: &Curve, builder: &mut ModelBuilder) -> Result<NodeId, Error> {
        if let Some([r, z]) = circle_beside_the_axis(curve) {
            let [a, _, _, _, _, f] = curve.0;
            let tube = (r * r + z * z - f / a).sqrt();
            let mut node = builder.add(Node::Shape(Shape::torus(r, tube)?));
            if z != 0.0 {
                let up = Transform::translation(DVec3::Z * z)?;
                node = builder.add(Node::Instance(up, node));
            }
            return Ok(node);
        }
        let [xx, xy, yy, x, y, one] = curve.0;
        let affine =
            |slope: f64, at_zero: f64| Polynomial::affine(DVec3::new(0.0, 0.0, slope), -at_zero);
        let z = Polynomial::variable(Axis::Z);
        let squares = Polynomial::from_terms(2, &[([2, 0, 0], 1.0), ([0, 2, 0], 1.0)])?;
        let mut even = affine(y, one)?;
        if xx != 0.0 {
            even = even.sum(&squares.clone().scaled(xx)?)?;
        }
        if yy != 0.0 {
            even = even.sum(&z.product(&z)?.scaled(yy)?)?;
        }
        let odd = affine(xy, x)?;
        let add = |polynomial: Polynomial, builder: &mut ModelBuilder| {
            let polynomial = polynomial.without_w_factors();
            Ok(match polynomial.coefficients() {
                [value] if polynomial.degree() == 0 => constant(*value <= 0.0, builder),
                _ => builder.add(Node::Shape(shape(polynomial)?)),
            })
        };
        if xy == 0.0 && x == 0.0 {
            return add(even, builder);
        }
        let mixed = even
            .product(&even)?
            .difference(&squares.product(&odd.product(&odd)?)?)?;
        if xy != 0.0 {
            let (p, q, g) = (
                add(even, builder)?,
                add(odd, builder)?,
                add(mixed, builder)?,
            );
            let beyond = builder.add(Node::Complement(g));
            let all = [vec![p, q], vec![p, beyond], vec![q, g]]
                .map(|both| builder.add(Node::Intersection(both)));
            return Ok(builder.add(Node::Union(all.to_vec())));
        }
        // Q is the constant x.
        let sign = self.sign(curve);
        Ok(match (x > 0.0, sign) {
            (true, Some(true)) => constant(false, builder),
            (false, Some(false)) => constant(true, builder),
            (true, _) => {
                let inside = add(mixed.negated(), builder)?;
                if sign.is_some() {
                    return Ok(inside);
                }
                let below = add(even, builder)?;
                builder.add(Node::Intersection(vec![below, inside]))
            }
            (false, _) => {
                let outside = add(mixed, builder)?;
                if sign.is_some() {
                    return Ok(outside);
                }
                let below = add(even, builder)?;
                builder.add(Node::Union(vec![below, outside]))
            }
        })
    }

    /// Whether P is positive or negative for all ρ ≥ 0 and z in the range, if that is plain.
    fn sign(&self, curve: &Curve) -> Option<bool> {
        let [xx, _, yy, _, y, one] = curve.0;
        let value = |z: f64| (yy * z + y) * z + one;
        let [low, high] = self.range.map(value);
        let lowest = if yy > 0.0 {
            one - y * y / (4.0 * yy)
        } else {
            low.min(high)
        };
        if xx >= 0.0 && yy >= 0.0 && lowest > 0.0 {
            return Some(true);
        }
        (xx <= 0.0 && yy == 0.0 && low.max(high) < 0.0).then_some(false)
    }
}

/// The centre (R, z), R > 0, of a disc.
#[expect(clippy::float_cmp, reason = "only exact circles make tori")]
fn circle_beside_the_axis(curve: &Curve) -> Option<[f64; 2]> {
    let [a, b, c, d, e, f] = curve.0;
    if !(a > 0.0 && a == c && b == 0.0) {
        return None;
    }
    let (r, z) = (-d / (2.0 * a), -e / (2.0 * a));
    (r > 0.0 && r * r + z * z > f / a).then_some([r, z])
}

/// All of space, or nothing.
pub(super) fn constant(all: bool, builder: &mut ModelBuilder) -> NodeId {
    let nothing = builder.add(Node::Union(Vec::new()));
    if all {
        builder.add(Node::Complement(nothing))
    } else {
        nothing
    }
}

/// A curve's sweep across one plane sector: ρ becomes the distance along a direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sector {
    /// ρ as a linear form in x and y.
    pub(super) rho: DVec2,
}

impl Sector {
    /// The points beyond a curve.
    pub(super) fn side(&self, curve: &Curve) -> Result<Shape, Error> {
        let [xx, xy, yy, x, y, one] = curve.0;
        let plane = Polynomial::affine(DVec3::new(self.rho.x * x, self.rho.y * x, y), -one)?;
        if curve.is_line() {
            return shape(plane);
        }
        let rho = Polynomial::affine(self.rho.extend(0.0), 0.0)?;
        let z = Polynomial::variable(Axis::Z);
        let polynomial = rho
            .product(&rho)?
            .scaled(xx)?
            .sum(&rho.product(&z)?.scaled(xy)?)?
            .sum(&z.product(&z)?.scaled(yy)?)?
            .sum(&plane)?;
        shape(polynomial)
    }
}

/// The sector from one direction to another, counter-clockwise, in degrees; `None` if it is all.
#[expect(
    clippy::float_cmp,
    reason = "only an exact half turn ends in one plane"
)]
pub(super) fn wedge(
    start: f64,
    angle: f64,
    builder: &mut ModelBuilder,
) -> Result<Option<NodeId>, Error> {
    if angle >= 360.0 {
        return Ok(None);
    }
    let direction = |degrees: f64| {
        let (sine, cosine) = super::super::motion::sin_cos_degrees(degrees);
        DVec2::new(cosine, sine)
    };
    let (from, to) = (direction(start), direction(start + angle));
    // Left of the first direction, right of the second.
    let sides = [-from.perp(), to.perp()];
    let mut nodes = Vec::with_capacity(2);
    for normal in sides {
        let shape = Shape::half_space(normal.extend(0.0), 0.0)?;
        nodes.push(builder.add(Node::Shape(shape)));
    }
    if angle == 180.0 {
        nodes.truncate(1);
    }
    let node = if angle > 180.0 {
        Node::Union(nodes)
    } else {
        Node::Intersection(nodes)
    };
    Ok(Some(builder.add(node)))
}
