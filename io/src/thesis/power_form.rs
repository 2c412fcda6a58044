//! From Bézier coefficients in simplices back to polynomials in space.

use super::Problem;
use super::sectors::{Sector, SectorPrimitive, Sectors};
use super::solid::material_color;
use csg::{Error, Material, Model, Node, Polynomial, Shape};
use glam::DMat4;
use std::collections::HashMap;

/// By how much the coefficients of one polynomial may differ from sector to sector, relative to
/// the largest one: rounding of degrees that the thesis' programs reach.
const AGREEMENT: f64 = 1e-6;

/// The model of a `.cspg` file: its polynomials hold in all of space, as those of `.CSG` files do.
/// Materials get the colours that they have there.
///
/// # Errors
/// [`Problem::Pieces`] when a primitive is not one polynomial; [`Problem::Shape`].
pub fn to_model(solid: &Sectors) -> Result<Model, Problem> {
    let mut polynomials: HashMap<i32, (i32, Polynomial)> = HashMap::new();
    for (number, sector) in solid.sectors.iter().enumerate() {
        for primitive in &sector.primitives {
            let form = in_barycentric(primitive)?;
            match polynomials.get(&primitive.name) {
                None => {
                    let polynomial = form.substituted(&to_barycentric(sector))?;
                    polynomials.insert(primitive.name, (primitive.material, polynomial));
                }
                Some((_, first)) if agrees(first, &form, sector)? => {}
                Some(_) => {
                    let (name, sector) = (primitive.name, number + 1);
                    return Err(Problem::Pieces { name, sector });
                }
            }
        }
    }
    solid.tree.to_model(|builder, name| {
        let Some((material, polynomial)) = polynomials.get(name) else {
            let (name, times) = (*name, 0);
            return Err(Problem::Name { name, times });
        };
        let polynomial = polynomial.clone().without_w_factors();
        let shape = builder.add(Node::Shape(Shape::Polynomial(polynomial)));
        let color = material_color(*material);
        let material = builder.material(Material { color });
        Ok(builder.add(Node::Painted(material, shape)))
    })
}

/// A form in the barycentric coordinates of its simplex: b · n!/(i! j! k! l!).
fn in_barycentric(primitive: &SectorPrimitive) -> Result<Polynomial, Error> {
    let plain = Polynomial::new(primitive.degree, primitive.coefficients.clone())?;
    let scaled = plain
        .terms()
        .map(|(exponents, b)| b * multinomial(exponents));
    Polynomial::new(primitive.degree, scaled.collect())
}

fn multinomial(exponents: [usize; 4]) -> f64 {
    let mut value = 1.0;
    let mut drawn = 0.0;
    for exponent in exponents {
        for t in 1..=exponent {
            drawn += 1.0;
            value *= drawn / t as f64;
        }
    }
    value.round()
}

/// Rows v0 … v3: barycentric coordinates times these are a point.
fn corners(sector: &Sector) -> [[f64; 4]; 4] {
    sector.vertices.map(|[x, y, z]| [x, y, z, 1.0])
}

/// The matrix that takes points, as rows, to their barycentric coordinates.
fn to_barycentric(sector: &Sector) -> [[f64; 4]; 4] {
    // As columns the rows are transposed, and so is the inverse.
    DMat4::from_cols_array_2d(&corners(sector))
        .inverse()
        .to_cols_array_2d()
}

/// Whether a polynomial has this form in a sector.
fn agrees(polynomial: &Polynomial, form: &Polynomial, sector: &Sector) -> Result<bool, Error> {
    let again = polynomial.substituted(&corners(sector))?;
    let most = AGREEMENT * form.max_abs();
    let mut pairs = again.coefficients().iter().zip(form.coefficients());
    Ok(again.degree() == form.degree() && pairs.all(|(a, b)| (a - b).abs() <= most))
}
