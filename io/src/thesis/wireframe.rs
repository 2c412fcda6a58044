//! The polygon mesh of LCGRENDERER: `.wfr`, vertices as `float` and faces as lists of indices
//! (thesis A.5.2).

use super::approximation::Face;
use super::bytes::{Encoder, in_either_order};
use super::{ByteOrder, Decoded, Error, Problem};
use std::collections::HashMap;
use std::io::Write;

/// A polygon mesh.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Wireframe {
    /// The field "Info", whose meaning the thesis does not tell; 0 here.
    pub info: i32,
    /// The vertices.
    pub vertices: Vec<[f32; 3]>,
    /// The faces, as indices of vertices.
    pub faces: Vec<Vec<u32>>,
}

impl Wireframe {
    /// Its faces as triangles around their first vertices, of material 1.
    #[must_use]
    pub fn triangles(&self) -> Vec<Face> {
        let corner = |index: u32| self.vertices.get(index as usize).copied();
        let corner = |index: u32| corner(index).unwrap_or_default().map(f64::from);
        let fan = |face: &Vec<u32>| {
            let (first, rest) = face.split_first()?;
            let triangles = rest.windows(2).map(|pair| Face {
                material: 1,
                corners: [*first, pair[0], pair[1]].map(corner),
            });
            Some(triangles.collect::<Vec<Face>>())
        };
        self.faces.iter().filter_map(fan).flatten().collect()
    }

    /// Joins corners of exactly equal position.
    ///
    /// # Errors
    /// The first position beyond the range of `float`.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the format has 32-bit numbers; infinite ones are refused, and indices are checked on writing"
    )]
    pub fn from_faces(faces: &[Face]) -> Result<Self, super::super::write::Error> {
        let mut mesh = Self::default();
        let mut known: HashMap<[u64; 3], u32> = HashMap::new();
        for face in faces {
            let mut corners = Vec::with_capacity(3);
            for corner in face.corners {
                // Adding zero turns −0 into 0.
                let key = corner.map(|x| (x + 0.0).to_bits());
                let next = mesh.vertices.len() as u32;
                let index = *known.entry(key).or_insert(next);
                if index == next {
                    let single = corner.map(|x| x as f32);
                    if !single.iter().all(|x| x.is_finite()) {
                        let position = corner.into();
                        return Err(super::super::write::Error::BeyondSinglePrecision { position });
                    }
                    mesh.vertices.push(single);
                }
                corners.push(index);
            }
            mesh.faces.push(corners);
        }
        Ok(mesh)
    }
}

/// Reads a mesh.
///
/// # Errors
/// The first thing that is wrong, with its place.
pub fn read(bytes: &[u8]) -> Result<Decoded<Wireframe>, Error> {
    in_either_order(bytes, |cursor| {
        let start = *cursor;
        let count = cursor.int("the number of vertices")?;
        let info = cursor.int("the information field")?;
        let most = cursor.left() / 12;
        let Some(vertex_count) = usize::try_from(count).ok().filter(|n| *n <= most) else {
            let (what, left) = ("vertices", cursor.left());
            return Err(start.error(Problem::Count {
                what,
                count,
                left,
                most,
            }));
        };
        let mut vertices = vec![[0.0; 3]; vertex_count];
        for number in vertices.iter_mut().flatten() {
            *number = cursor.float("a coordinate")?;
        }
        let face_count = cursor.count("faces", 4)?;
        let mut faces = Vec::with_capacity(face_count);
        for _ in 0..face_count {
            let corners = cursor.count("vertices of a face", 4)?;
            let mut face = Vec::with_capacity(corners);
            for _ in 0..corners {
                let start = *cursor;
                let index = cursor.int("a vertex index")?;
                let valid = u32::try_from(index).ok();
                let Some(valid) = valid.filter(|i| (*i as usize) < vertex_count) else {
                    let count = vertex_count;
                    return Err(start.error(Problem::Vertex { index, count }));
                };
                face.push(valid);
            }
            faces.push(face);
        }
        Ok(Wireframe {
            info,
            vertices,
            faces,
        })
    })
}

/// Writes a mesh.
///
/// # Errors
/// Those of `out`, and counts beyond 32 bits.
pub fn write(mesh: &Wireframe, order: ByteOrder, out: &mut impl Write) -> std::io::Result<()> {
    let mut encoder = Encoder { out, order };
    encoder.count(mesh.vertices.len())?;
    encoder.int(mesh.info)?;
    for number in mesh.vertices.iter().flatten() {
        encoder.float(*number)?;
    }
    encoder.count(mesh.faces.len())?;
    for face in &mesh.faces {
        encoder.count(face.len())?;
        for index in face {
            encoder.count(*index as usize)?;
        }
    }
    Ok(())
}
