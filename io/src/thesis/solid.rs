//! A solid as the thesis' language compiler writes it: `.CSG`, a Boolean tree over instances of
//! eight shapes (thesis A.2.1).
//!
//! What the thesis leaves open is read so: PLANO is z ≥ 0, the bounded CILINDRO, CONE and
//! HELICÓIDE stand between z = 0 and z = 1, BLOCO is the unit cube in the first octant, and the
//! matrix multiplies row vectors, with the translation in its last row.

use super::bytes::{Cursor, Encoder, further, in_either_order, is_ordinary};
use super::tree::{Operators, Tree};
use super::{ByteOrder, Decoded, Error, Problem};
use csg::{Material, MaterialId, Model, Node, Polynomial, Sense, Shape, Solid, Transform};
use glam::DVec3;
use std::io::Write;

/// A shape, where it is and what it is made of.
#[derive(Clone, PartialEq, Debug)]
pub struct Instance {
    /// Index of its material.
    pub material: i32,
    /// The shape.
    pub shape: Kind,
    /// Rows of the matrix from the shape's to the scene's coordinates, for row vectors.
    pub matrix: [[f32; 4]; 4],
}

/// The thesis' shapes, with their numbers in the file.
#[derive(Clone, PartialEq, Debug)]
pub enum Kind {
    /// 0 BLOCO: 0 ≤ x, y, z ≤ 1.
    Block,
    /// 1 ESFERA: x² + y² + z² ≤ 1.
    Sphere,
    /// 2 CILINDRO: x² + y² ≤ 1, 0 ≤ z ≤ 1.
    Cylinder,
    /// 3 PLANO: z ≥ 0.
    Plane,
    /// 4 CONE: x² + y² ≤ z², 0 ≤ z ≤ 1.
    Cone,
    /// 5 TORO: ring radius 1 and this tube radius, about the z axis.
    Torus(f32),
    /// 6 POLINOMIAL: p ≤ 0.
    Polynomial {
        /// Its degree.
        degree: usize,
        /// Its coefficients by descending exponents of x, y, z and 1.
        coefficients: Vec<f32>,
    },
    /// 7 HELICÓIDE: half of the unit cylinder, turning.
    Helicoid,
}

/// Which vectors an instance's matrix multiplies.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum MatrixForm {
    /// Rows: the translation is the last row.
    #[default]
    Rows,
    /// Columns: the translation is the last column.
    Columns,
}

impl Instance {
    /// The map from the shape's to the scene's coordinates.
    ///
    /// # Errors
    /// [`csg::Error::SingularTransform`] and those of numbers that are not finite.
    pub fn transform(&self, form: MatrixForm) -> Result<Transform, csg::Error> {
        let matrix = self.matrix.map(|row| row.map(f64::from));
        match form {
            MatrixForm::Rows => Transform::from_rows(&matrix),
            MatrixForm::Columns => Transform::from_columns(&matrix),
        }
    }

    fn shape(&self) -> Result<Shape, csg::Error> {
        match &self.shape {
            Kind::Block => Shape::block(DVec3::ZERO, DVec3::ONE),
            Kind::Sphere => Shape::sphere(1.0),
            Kind::Cylinder => Shape::cylinder(1.0, 0.0, 1.0),
            Kind::Plane => Shape::half_space(-DVec3::Z, 0.0),
            Kind::Cone => Shape::frustum(0.0, 1.0, 0.0, 1.0),
            Kind::Torus(tube) => Shape::torus(1.0, f64::from(*tube)),
            Kind::Polynomial {
                degree,
                coefficients,
            } => {
                let wide = coefficients.iter().copied().map(f64::from).collect();
                Polynomial::new(*degree, wide).map(Shape::Polynomial)
            }
            Kind::Helicoid => Ok(Shape::helicoid()),
        }
    }
}

/// Reads a solid; shapes and matrices are checked, too.
///
/// Type 0, BLOCO, does not tell the byte order: of two possible readings the one is taken whose
/// numbers look as if somebody wrote them, big-endian if both do.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(
    bytes: &[u8],
    operators: Operators,
    form: MatrixForm,
) -> Result<Decoded<Tree<Instance>>, Error> {
    let tree = |plausible| {
        in_either_order(bytes, |cursor| {
            Tree::read(cursor, operators, |c| read_instance(c, form, plausible))
        })
    };
    // Strange numbers are legal all the same.
    tree(true).or_else(|strict| tree(false).map_err(|error| further(strict, error)))
}

fn read_instance(
    cursor: &mut Cursor<'_>,
    form: MatrixForm,
    plausible: bool,
) -> Result<Instance, Error> {
    let material = cursor.int("a material")?;
    let start = *cursor;
    let shape = match cursor.int("a type of primitive")? {
        0 => Kind::Block,
        1 => Kind::Sphere,
        2 => Kind::Cylinder,
        3 => Kind::Plane,
        4 => Kind::Cone,
        5 => Kind::Torus(cursor.float("the smaller radius of a torus")?),
        6 => {
            let (degree, count) = cursor.degree(4)?;
            let coefficients: Result<_, _> =
                (0..count).map(|_| cursor.float("a coefficient")).collect();
            Kind::Polynomial {
                degree,
                coefficients: coefficients?,
            }
        }
        7 => Kind::Helicoid,
        code => {
            let what = "primitive";
            let known = "0 to 7";
            return Err(start.error(Problem::Code { what, code, known }));
        }
    };
    let at_matrix = *cursor;
    let mut matrix = [[0.0; 4]; 4];
    for entry in matrix.iter_mut().flatten() {
        let before = *cursor;
        *entry = cursor.float("an entry of a matrix")?;
        let value = f64::from(*entry);
        if plausible && !is_ordinary(value) {
            let what = "an entry of a matrix";
            return Err(before.error(Problem::NotFinite { what, value }));
        }
    }
    let instance = Instance {
        material,
        shape,
        matrix,
    };
    instance.shape().map_err(|e| start.error(e.into()))?;
    let transform = instance.transform(form);
    transform.map_err(|e| at_matrix.error(e.into()))?;
    Ok(instance)
}

/// Writes a solid.
///
/// # Errors
/// Those of `out`.
pub fn write(
    tree: &Tree<Instance>,
    operators: Operators,
    order: ByteOrder,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let mut encoder = Encoder { out, order };
    tree.write(&mut encoder, operators, |instance, e| {
        e.int(instance.material)?;
        match &instance.shape {
            Kind::Block => e.int(0)?,
            Kind::Sphere => e.int(1)?,
            Kind::Cylinder => e.int(2)?,
            Kind::Plane => e.int(3)?,
            Kind::Cone => e.int(4)?,
            Kind::Torus(tube) => {
                e.int(5)?;
                e.float(*tube)?;
            }
            Kind::Polynomial {
                degree,
                coefficients,
            } => {
                e.int(6)?;
                e.count(*degree)?;
                for coefficient in coefficients {
                    e.float(*coefficient)?;
                }
            }
            Kind::Helicoid => e.int(7)?,
        }
        for entry in instance.matrix.as_flattened() {
            e.float(*entry)?;
        }
        Ok(())
    })
}

/// The model that a tree describes; materials other than 0 and 1 get colours that differ.
///
/// # Errors
/// Those of shapes and transforms, which [`read`] has checked already.
pub fn to_model(tree: &Tree<Instance>, form: MatrixForm) -> Result<Model, csg::Error> {
    tree.to_model(|builder, instance| {
        let shape = builder.add(Node::Shape(instance.shape()?));
        let placed = builder.add(Node::Instance(instance.transform(form)?, shape));
        let color = material_color(instance.material);
        let material = builder.material(Material { color });
        Ok(builder.add(Node::Painted(material, placed)))
    })
}

/// The number in the thesis' files of a material of ours: 0 is taken, as the background's colour.
#[must_use]
pub fn material_number(material: MaterialId) -> i32 {
    i32::try_from(material.0.saturating_add(1)).unwrap_or(i32::MAX)
}

/// A colour for a material of the thesis' files: hues a golden angle apart, none for 0 and 1.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "colours need no more digits"
)]
pub fn material_color(material: i32) -> Option<[f32; 4]> {
    if material == 0 || material == 1 {
        return None;
    }
    let hue = (f64::from(material) * 0.618_033_988_749_895).rem_euclid(1.0) * 6.0;
    let channel = |shift: f64| {
        let distance = ((hue + shift).rem_euclid(6.0) - 3.0).abs() - 1.0;
        (0.25 + 0.6 * distance.clamp(0.0, 1.0)) as f32
    };
    Some([channel(0.0), channel(4.0), channel(2.0), 1.0])
}

/// Any solid as a tree of POLINOMIAL leaves in the domain's centred coordinates, complements negated as in
/// thesis A.2.2. The format's `float` numbers keep seven digits.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "the format has 32-bit numbers; coefficients are at most 1, and a matrix out of range is refused by readers"
)]
pub fn from_solid(solid: &Solid, form: MatrixForm) -> Tree<Instance> {
    let half = solid.domain.half_size() as f32;
    let [x, y, z] = solid.domain.center().to_array().map(|c| c as f32);
    let rows = [
        [half, 0.0, 0.0, 0.0],
        [0.0, half, 0.0, 0.0],
        [0.0, 0.0, half, 0.0],
        [x, y, z, 1.0],
    ];
    let matrix = match form {
        MatrixForm::Rows => rows,
        MatrixForm::Columns => std::array::from_fn(|i| rows.map(|row| row[i])),
    };
    let leaf = |material, degree, coefficients| Instance {
        material,
        shape: Kind::Polynomial {
            degree,
            coefficients,
        },
        matrix,
    };
    let constant = |all| leaf(0, 0, vec![if all { -1.0 } else { 1.0 }]);
    Tree::from_formula(
        solid.formula.nodes(),
        |literal| {
            let Some(primitive) = solid.primitives.get(literal.primitive.0 as usize) else {
                return constant(false);
            };
            let sign = match literal.sense {
                Sense::Inside => 1.0,
                Sense::Outside => -1.0,
            };
            let polynomial = &primitive.polynomial;
            let coefficients = polynomial.coefficients().iter();
            leaf(
                material_number(literal.material),
                polynomial.degree(),
                coefficients.map(|c| (sign * c) as f32).collect(),
            )
        },
        constant,
    )
}
