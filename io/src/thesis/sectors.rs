//! A solid as Bézier coefficients in a few simplices: `.cspg`, what CSG2CSPG writes and SUBSIMPL
//! reads (thesis A.3.1).

use super::bytes::{Cursor, Encoder, in_either_order};
use super::tree::{Operators, Tree};
use super::{ByteOrder, Decoded, Error, Problem};
use std::io::Write;

/// A Boolean tree over named primitives, and their polynomials in each of the sectors.
#[derive(Clone, PartialEq, Debug)]
pub struct Sectors {
    /// The tree; its leaves are names of primitives.
    pub tree: Tree<i32>,
    /// The simplices with which subdivision begins.
    pub sectors: Vec<Sector>,
}

/// A simplex with the polynomials of all primitives.
#[derive(Clone, PartialEq, Debug)]
pub struct Sector {
    /// Its corners v0 … v3, the refinement edge being v0–v3.
    pub vertices: [[f64; 3]; 4],
    /// Every primitive once.
    pub primitives: Vec<SectorPrimitive>,
}

/// A polynomial half-space `p ≤ 0` in a simplex.
#[derive(Clone, PartialEq, Debug)]
pub struct SectorPrimitive {
    /// Its name in the tree.
    pub name: i32,
    /// Its material.
    pub material: i32,
    /// Its degree n.
    pub degree: usize,
    /// (n+1)(n+2)(n+3)/6 Bézier coefficients, by descending exponents of v0 … v3.
    pub coefficients: Vec<f64>,
}

/// Reads a solid.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(bytes: &[u8], operators: Operators) -> Result<Decoded<Sectors>, Error> {
    in_either_order(bytes, |cursor| read_all(cursor, operators))
}

fn read_all(cursor: &mut Cursor<'_>, operators: Operators) -> Result<Sectors, Error> {
    // A leaf of the tree and a primitive of a sector take five bytes and more.
    let count = cursor.count("primitives", 5)?;
    let tree = Tree::read(cursor, operators, |c| c.int("a primitive's name"))?;
    let mut names: Vec<i32> = tree.leaves().copied().collect();
    names.sort_unstable();
    names.dedup();
    let size = 12 * 8 + count * 20;
    let sector_count = cursor.count("sectors", size)?;
    let mut sectors = Vec::with_capacity(sector_count);
    for _ in 0..sector_count {
        let start = *cursor;
        let vertices = cursor.points("a vertex of a simplex")?;
        if volume(&vertices) == 0.0 {
            return Err(start.error(Problem::FlatSimplex));
        }
        let mut primitives = Vec::with_capacity(count);
        for _ in 0..count {
            primitives.push(SectorPrimitive {
                name: cursor.int("a primitive's name")?,
                ..read_polynomial(cursor)?
            });
        }
        let mut listed: Vec<i32> = primitives.iter().map(|p| p.name).collect();
        listed.sort_unstable();
        for &name in &names {
            let end = listed.partition_point(|x| *x <= name);
            let times = end - listed.partition_point(|x| *x < name);
            if times != 1 {
                return Err(start.error(Problem::Name { name, times }));
            }
        }
        sectors.push(Sector {
            vertices,
            primitives,
        });
    }
    Ok(Sectors { tree, sectors })
}

/// Material, degree and coefficients; the name is 0.
pub(super) fn read_polynomial(cursor: &mut Cursor<'_>) -> Result<SectorPrimitive, Error> {
    let material = cursor.int("a primitive's material")?;
    let (degree, count) = cursor.degree(8)?;
    Ok(SectorPrimitive {
        name: 0,
        material,
        degree,
        coefficients: cursor.doubles("a Bézier coefficient", count)?,
    })
}

/// Six times the volume of a simplex, with a sign.
#[must_use]
pub fn volume(vertices: &[[f64; 3]; 4]) -> f64 {
    let [o, a, b, c] = vertices.map(glam::DVec3::from);
    (a - o).cross(b - o).dot(c - o)
}

/// Writes a solid.
///
/// # Errors
/// Those of `out`, and counts beyond 32 bits.
pub fn write(
    solid: &Sectors,
    operators: Operators,
    order: ByteOrder,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let mut encoder = Encoder { out, order };
    encoder.count(solid.sectors.first().map_or(0, |s| s.primitives.len()))?;
    solid
        .tree
        .write(&mut encoder, operators, |name, e| e.int(*name))?;
    encoder.count(solid.sectors.len())?;
    for sector in &solid.sectors {
        encoder.doubles(sector.vertices.as_flattened())?;
        for primitive in &sector.primitives {
            write_primitive(primitive, &mut encoder)?;
        }
    }
    Ok(())
}

pub(super) fn write_primitive<W: Write>(
    primitive: &SectorPrimitive,
    encoder: &mut Encoder<'_, W>,
) -> std::io::Result<()> {
    encoder.int(primitive.name)?;
    encoder.int(primitive.material)?;
    encoder.count(primitive.degree)?;
    encoder.doubles(&primitive.coefficients)
}
