//! The thesis' shapes as formulas over polynomial half-spaces (A.2.3, Fig. A.2).

use csg::{Error, Polynomial};
use io::thesis::solid::{Instance, Kind, MatrixForm};

/// The half-spaces whose intersection an instance is, in the scene's coordinates; the torus whose
/// tube is wider than its ring is their union.
pub(super) struct HalfSpaces {
    pub(super) polynomials: Vec<Polynomial>,
    pub(super) is_union: bool,
}

impl HalfSpaces {
    pub(super) fn of(instance: &Instance, form: MatrixForm) -> Result<Self, Error> {
        let (own, is_union) = basic(&instance.shape)?;
        // p'(q) = p(q M⁻¹).
        let inverse = instance.transform(form)?.inverse().to_rows();
        let moved = own.iter().map(|p| p.substituted(&inverse));
        Ok(Self {
            polynomials: moved.collect::<Result<_, _>>()?,
            is_union,
        })
    }
}

/// SEPX0 … SEHEL in the shape's own coordinates.
fn basic(shape: &Kind) -> Result<(Vec<Polynomial>, bool), Error> {
    let from = |degree, terms: &[([usize; 3], f64)]| Polynomial::from_terms(degree, terms);
    let one = [0, 0, 0];
    let unit = |axis: usize| std::array::from_fn(|at| usize::from(at == axis));
    let low = |axis| from(1, &[(unit(axis), -1.0)]);
    let high = |axis| from(1, &[(unit(axis), 1.0), (one, -1.0)]);
    let [xx, yy, zz] = [[2, 0, 0], [0, 2, 0], [0, 0, 2]];
    let cylinder = || from(2, &[(xx, 1.0), (yy, 1.0), (one, -1.0)]);
    let intersection = match shape {
        Kind::Block => vec![low(0)?, high(0)?, low(1)?, high(1)?, low(2)?, high(2)?],
        Kind::Sphere => vec![from(2, &[(xx, 1.0), (yy, 1.0), (zz, 1.0), (one, -1.0)])?],
        Kind::Cylinder => vec![cylinder()?, low(2)?, high(2)?],
        Kind::Plane => vec![low(2)?],
        Kind::Cone => vec![
            from(2, &[(xx, 1.0), (yy, 1.0), (zz, -1.0)])?,
            low(2)?,
            high(2)?,
        ],
        Kind::Torus(tube) => return torus(f64::from(*tube)),
        Kind::Polynomial {
            degree,
            coefficients,
        } => {
            let wide = coefficients.iter().copied().map(f64::from).collect();
            vec![Polynomial::new(*degree, wide)?]
        }
        Kind::Helicoid => vec![helicoid()?, cylinder()?, low(2)?, high(2)?],
    };
    Ok((intersection, false))
}

/// SETRD with the sign of 1 that the thesis misprints; where the tube is wider than the ring, the
/// quartic is positive in the core, which a ball fills.
fn torus(tube: f64) -> Result<(Vec<Polynomial>, bool), Error> {
    let squares = |constant: f64| {
        let terms = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|e| (e, 1.0));
        let [x, y, z] = terms;
        Polynomial::from_terms(2, &[x, y, z, ([0, 0, 0], constant)])
    };
    let across = Polynomial::from_terms(2, &[([2, 0, 0], 4.0), ([0, 2, 0], 4.0)])?;
    let quartic = squares(1.0 - tube * tube)?.power(2)?.difference(&across)?;
    if tube > 1.0 {
        return Ok((vec![quartic, squares(1.0 - tube * tube)?], true));
    }
    Ok((vec![quartic], false))
}

/// SEHEL: x (4u² − 1) + y u (2.2654816 u² − π) with u = z − ½.
fn helicoid() -> Result<Polynomial, Error> {
    let u = Polynomial::from_terms(1, &[([0, 0, 1], 1.0), ([0, 0, 0], -0.5)])?;
    let [x, y] = [csg::Axis::X, csg::Axis::Y].map(Polynomial::variable);
    let squared = u.power(2)?;
    let along = squared.clone().scaled(4.0)?;
    let along = along.difference(&Polynomial::constant(1.0)?)?;
    let turning = squared.scaled(2.265_481_6)?;
    let turning = turning.difference(&Polynomial::constant(std::f64::consts::PI)?)?;
    x.product(&along)?.sum(&y.product(&u)?.product(&turning)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn at(shape: Kind, point: [f64; 3]) -> Vec<f64> {
        let mut matrix = [[0.0; 4]; 4];
        for (at, row) in matrix.iter_mut().enumerate() {
            row[at] = 2.0;
        }
        matrix[3] = [1.0, 0.0, 0.0, 1.0];
        let material = 0;
        let instance = Instance {
            material,
            shape,
            matrix,
        };
        let spaces = HalfSpaces::of(&instance, MatrixForm::Rows).unwrap();
        // Twice as large, moved by 1 along x.
        let place = DVec3::from(point) * 2.0 + DVec3::X;
        spaces
            .polynomials
            .iter()
            .map(|p| p.evaluate(place))
            .collect()
    }

    /// Points by hand: the outer equator of the torus, a rim point of the cylinder, a corner.
    #[test]
    fn surfaces_pass_where_the_thesis_says() {
        let zero = |values: &[f64]| values.iter().any(|v| v.abs() < 1e-6);
        assert!(zero(&at(Kind::Torus(0.25), [1.25, 0.0, 0.0])));
        assert!(at(Kind::Torus(0.25), [1.0, 0.0, 0.2])[0] < 0.0);
        assert!(at(Kind::Torus(0.25), [0.0, 0.0, 0.0])[0] > 0.0);
        assert!(at(Kind::Torus(2.0), [0.0, 0.0, 0.0])[1] < 0.0);
        assert!(zero(&at(Kind::Cylinder, [0.6, 0.8, 0.5])));
        assert!(at(Kind::Block, [0.5; 3]).iter().all(|v| *v < 0.0));
        assert!(at(Kind::Plane, [9.0, -9.0, 1.0])[0] < 0.0);
        assert!(at(Kind::Cone, [0.3, 0.0, 0.5])[0] < 0.0);
        // At half height u is 0 and the surface is the plane x = 0, the solid at x > 0.
        assert!(at(Kind::Helicoid, [0.5, 0.0, 0.5]).iter().all(|v| *v < 0.0));
    }
}
