//! The piecewise linear approximation of a boundary: `.apl`, the letter `A` and then triangles
//! until the end of the file, each a material and three points in model units (thesis A.3.3.1).

use super::bytes::{Cursor, Encoder, further, in_either_order, is_ordinary};
use super::{ByteOrder, Decoded, Error, Problem};
use std::io::Write;

/// The material of triangles in whose cell several primitives make the boundary.
pub const HYBRID: i32 = 255;

/// Bytes of a triangle.
const SIZE: usize = 4 + 9 * 8;

/// A triangle.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Face {
    /// Index of its material.
    pub material: i32,
    /// Its corners, counter-clockwise seen from outside.
    pub corners: [[f64; 3]; 3],
}

/// Reads triangles.
///
/// There is no count that would tell the byte order: of two possible readings the one is taken
/// whose numbers look like coordinates, big-endian if both do.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(bytes: &[u8]) -> Result<Decoded<Vec<Face>>, Error> {
    let read = |plausible| in_either_order(bytes, |cursor| faces(cursor, plausible));
    // Strange numbers are legal all the same.
    read(true).or_else(|strict| read(false).map_err(|error| further(strict, error)))
}

fn faces(cursor: &mut Cursor<'_>, plausible: bool) -> Result<Vec<Face>, Error> {
    cursor.mark('A', "a linear approximation")?;
    let mut faces = Vec::with_capacity(cursor.left() / SIZE);
    while cursor.left() > 0 {
        let start = *cursor;
        let wrong = |code| {
            Err(start.error(Problem::Code {
                what: "material",
                code,
                known: "0 to 65535",
            }))
        };
        let material = cursor.int("a face's material")?;
        if !(0..1 << 16).contains(&material) {
            return wrong(material);
        }
        let corners = cursor.points("a face's corner")?;
        if plausible && !corners.iter().flatten().all(|x| is_ordinary(*x)) {
            return wrong(material);
        }
        faces.push(Face { material, corners });
    }
    Ok(faces)
}

/// Writes triangles.
///
/// # Errors
/// Those of `out`.
pub fn write(
    faces: impl IntoIterator<Item = Face>,
    order: ByteOrder,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let mut encoder = Encoder { out, order };
    encoder.byte(b'A')?;
    for face in faces {
        encoder.int(face.material)?;
        encoder.doubles(face.corners.as_flattened())?;
    }
    Ok(())
}
