//! The tree of simplices that subdivision visits: the letter `S`, and for each sector its corners
//! and a binary tree whose leaves are full, empty or carry what is left of the solid in them
//! (thesis A.3.3.2).

use super::bytes::{Cursor, Encoder, in_either_order};
use super::sectors::{SectorPrimitive, read_polynomial, volume, write_primitive};
use super::tree::{Operators, Tree};
use super::{ByteOrder, Decoded, Error, Problem};
use std::io::Write;

/// A sector's simplex and its bintree.
#[derive(Clone, PartialEq, Debug)]
pub struct Subdivision {
    /// The corners v0 … v3.
    pub vertices: [[f64; 3]; 4],
    /// The bintree in prefix order.
    pub nodes: Vec<Node>,
}

/// What a simplex is to the solid.
#[derive(Clone, PartialEq, Debug)]
pub enum Node {
    /// It lies inside.
    Full,
    /// It lies outside.
    Empty,
    /// It was bisected; the child holding v0 and then the one holding v3 follow.
    Mixed,
    /// It was not bisected, although the boundary may pass: the pruned tree, with Bézier
    /// coefficients in the simplex itself.
    Front(Tree<SectorPrimitive>),
}

/// Reads a subdivision.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(bytes: &[u8], operators: Operators) -> Result<Decoded<Vec<Subdivision>>, Error> {
    in_either_order(bytes, |cursor| {
        cursor.mark('S', "a subdivision")?;
        let count = cursor.count("sectors", 12 * 8 + 4)?;
        (0..count).map(|_| read_one(cursor, operators)).collect()
    })
}

fn read_one(cursor: &mut Cursor<'_>, operators: Operators) -> Result<Subdivision, Error> {
    let start = *cursor;
    let vertices = cursor.points("a vertex of a simplex")?;
    if volume(&vertices) == 0.0 {
        return Err(start.error(Problem::FlatSimplex));
    }
    let mut nodes = Vec::new();
    let mut open = 1_usize;
    while open > 0 {
        let start = *cursor;
        open -= 1;
        nodes.push(match cursor.int("a simplex' type")? {
            0 => Node::Full,
            1 => Node::Empty,
            2 => {
                open += 2;
                Node::Mixed
            }
            3 => Node::Front(Tree::read(cursor, operators, |c| {
                let name = c.int("a primitive's name")?;
                Ok(SectorPrimitive {
                    name,
                    ..read_polynomial(c)?
                })
            })?),
            code => {
                let what = "simplex";
                let known = "0 full, 1 empty, 2 mixed, 3 front";
                return Err(start.error(Problem::Code { what, code, known }));
            }
        });
    }
    Ok(Subdivision { vertices, nodes })
}

/// Writes a subdivision.
///
/// # Errors
/// Those of `out`, and counts beyond 32 bits.
pub fn write(
    sectors: &[Subdivision],
    operators: Operators,
    order: ByteOrder,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let mut encoder = Encoder { out, order };
    encoder.byte(b'S')?;
    encoder.count(sectors.len())?;
    for sector in sectors {
        encoder.doubles(sector.vertices.as_flattened())?;
        for node in &sector.nodes {
            match node {
                Node::Full => encoder.int(0)?,
                Node::Empty => encoder.int(1)?,
                Node::Mixed => encoder.int(2)?,
                Node::Front(tree) => {
                    encoder.int(3)?;
                    tree.write(&mut encoder, operators, write_primitive)?;
                }
            }
        }
    }
    Ok(())
}
