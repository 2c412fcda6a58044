//! Meshes of files as they are, sound or not: OBJ, GLB, STL, 3MF and PLY.
//!
//! Nothing is repaired and nothing is judged here; a vertex number that does not exist stays so
//! ([`NO_VERTEX`]), a position that is not a number too. Only what cannot be understood is an
//! error. Hostile files cost no more than their own size: counts are checked against the bytes
//! that are there before anything is allocated, and what unfolds (archives, instances) is bounded
//! by [`Limits`].

mod error;
mod glb;
mod obj;
mod ply;
mod stl;
mod threemf;

pub use error::MeshError;
use glam::{DAffine3, DVec3};
use std::path::Path;

/// Stands for a vertex that does not exist.
pub const NO_VERTEX: u32 = u32::MAX;

/// A format of meshes that can be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum MeshFormat {
    /// Wavefront OBJ; polygons are cut into fans from their first corner.
    Obj,
    /// Binary glTF 2.0.
    Glb,
    /// STL, text or binary.
    Stl,
    /// 3D Manufacturing Format, core and production specifications.
    Threemf,
    /// PLY, text or binary.
    Ply,
}

impl MeshFormat {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Obj, Self::Glb, Self::Stl, Self::Threemf, Self::Ply];

    /// The name, which is the usual extension too.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Glb => "glb",
            Self::Stl => "stl",
            Self::Threemf => "3mf",
            Self::Ply => "ply",
        }
    }
}

/// What says which corners are one vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Joining {
    /// The file's vertex numbers.
    Indices,
    /// `EXT_mesh_manifold` of glTF.
    Extension,
    /// Nothing in the format: readers join vertices of exactly equal position.
    Positions,
}

/// How much may be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Limits {
    /// Vertices and triangles together, below 2³².
    pub elements: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            elements: 50_000_000,
        }
    }
}

/// A run of triangles with a name of their own in the file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Part {
    /// Such as `object 2`; empty in formats of one mesh.
    pub label: String,
    /// Index of its first triangle.
    pub first_triangle: usize,
}

/// The triangles of a file.
#[derive(Clone, PartialEq, Debug)]
pub struct Mesh {
    /// Where they are from.
    pub format: MeshFormat,
    /// Vertices, possibly not finite; instances are moved to their places.
    pub positions: Vec<DVec3>,
    /// Corners, counter-clockwise seen from outside, or [`NO_VERTEX`].
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the number that the file knows it by, see [`place`](Self::place).
    pub numbers: Vec<u32>,
    /// What `numbers` count: `line` from 1, `face` or `triangle` from 0.
    pub counted: &'static str,
    /// Runs of triangles, in order.
    pub parts: Vec<Part>,
    /// The first vertex of each mesh or instance, in order: vertices of different ones are never
    /// joined.
    pub bodies: Vec<u32>,
    /// What says which corners are one vertex.
    pub joining: Joining,
    /// Name of the length unit, if the format says it.
    pub unit: Option<String>,
    /// What was left out or taken in a way that may surprise.
    pub notes: Vec<String>,
    room: usize,
}

/// The format of a mesh file, by its content and then by its name's extension; `None` if it seems
/// to be no mesh.
#[must_use]
pub fn sniff(bytes: &[u8], name: &str) -> Option<MeshFormat> {
    let text = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    if bytes.starts_with(b"glTF") {
        return Some(MeshFormat::Glb);
    }
    if bytes.starts_with(b"PK\x03\x04") {
        return Some(MeshFormat::Threemf);
    }
    if bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r") {
        return Some(MeshFormat::Ply);
    }
    if stl::is_stl(bytes) {
        return Some(MeshFormat::Stl);
    }
    let extension = Path::new(name)
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let named = MeshFormat::ALL
        .into_iter()
        .find(|format| extension.as_deref() == Some(format.name()));
    named.or_else(|| obj::looks_like_obj(text).then_some(MeshFormat::Obj))
}

/// Reads a file's content.
///
/// # Errors
/// What cannot be understood, with its place; a limit that is reached.
pub fn read(bytes: &[u8], format: MeshFormat, limits: Limits) -> Result<Mesh, MeshError> {
    match format {
        MeshFormat::Obj => obj::read(bytes, limits),
        MeshFormat::Glb => glb::read(bytes, limits),
        MeshFormat::Stl => stl::read(bytes, limits),
        MeshFormat::Threemf => threemf::read(bytes, limits),
        MeshFormat::Ply => ply::read(bytes, limits),
    }
}

impl Mesh {
    fn new(format: MeshFormat, counted: &'static str, limits: Limits) -> Self {
        Self {
            format,
            positions: Vec::new(),
            triangles: Vec::new(),
            numbers: Vec::new(),
            counted,
            parts: Vec::new(),
            bodies: vec![0],
            joining: Joining::Indices,
            unit: None,
            notes: Vec::new(),
            room: limits.elements.min(NO_VERTEX as usize - 1),
        }
    }

    /// What the file calls a triangle, such as `line 12` or `object 2, triangle 0`.
    #[must_use]
    pub fn place(&self, triangle: usize) -> String {
        let number = self.numbers.get(triangle).copied().unwrap_or_default();
        let after = self
            .parts
            .partition_point(|part| part.first_triangle <= triangle);
        let part = after.checked_sub(1).and_then(|at| self.parts.get(at));
        match part.filter(|part| !part.label.is_empty()) {
            Some(part) => format!("{}, {} {number}", part.label, self.counted),
            None => format!("{} {number}", self.counted),
        }
    }

    /// Takes room for this many vertices or triangles.
    fn take(&mut self, elements: usize) -> Result<(), MeshError> {
        self.room = self
            .room
            .checked_sub(elements)
            .ok_or_else(MeshError::too_large)?;
        Ok(())
    }

    /// The number of the vertex that comes next.
    fn next_vertex(&self) -> u32 {
        // The room is below 2³² − 1.
        u32::try_from(self.positions.len()).unwrap_or(NO_VERTEX)
    }

    fn vertex(&mut self, position: DVec3) -> Result<(), MeshError> {
        self.take(1)?;
        self.positions.push(position);
        Ok(())
    }

    fn triangle(&mut self, corners: [u32; 3], number: u32) -> Result<(), MeshError> {
        self.take(1)?;
        self.triangles.push(corners);
        self.numbers.push(number);
        Ok(())
    }

    /// A polygon as a fan; fewer than three corners make one degenerate triangle.
    fn polygon(&mut self, corners: &[u32], number: u32) -> Result<(), MeshError> {
        match *corners {
            [] => self.triangle([NO_VERTEX; 3], number),
            [a] => self.triangle([a; 3], number),
            [a, b] => self.triangle([a, b, b], number),
            [a, ref others @ ..] => others.windows(2).try_for_each(|pair| match *pair {
                [b, c] => self.triangle([a, b, c], number),
                _ => Ok(()),
            }),
        }
    }

    /// Copies vertices and triangles of a mesh that is placed by `transform`; mirrored ones are
    /// turned over, so that the outside stays outside.
    fn instance(
        &mut self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        transform: &DAffine3,
        label: String,
    ) -> Result<(), MeshError> {
        self.take(positions.len() + triangles.len())?;
        let first = self.next_vertex();
        self.bodies.push(first);
        self.parts.push(Part {
            label,
            first_triangle: self.triangles.len(),
        });
        let place = |p: &DVec3| transform.transform_point3(*p);
        self.positions.extend(positions.iter().map(place));
        let exists = |v: u32| (v as usize) < positions.len();
        let number = |v: u32| if exists(v) { v + first } else { NO_VERTEX };
        let is_mirrored = transform.matrix3.determinant() < 0.0;
        for (at, corners) in (0_u32..).zip(triangles) {
            let [a, b, c] = corners.map(number);
            self.triangles
                .push(if is_mirrored { [a, c, b] } else { [a, b, c] });
            self.numbers.push(at);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
