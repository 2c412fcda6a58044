//! Mesh files as they are: reading, and joining vertices of equal position.

use crate::args::MeshInputFormat;
use crate::failure::Failure;
use crate::input::Input;
use io::read::mesh::{self, Limits, Mesh, MeshFormat};

/// Bytes that a vertex or a triangle may take while it is looked at.
const BYTES_PER_ELEMENT: u64 = 200;

/// The formats, for messages.
pub(crate) const KNOWN: &str = "known: .obj, .glb, .stl, .3mf, .ply";

/// Reads a mesh file, `from` or by its content.
pub(crate) fn read(
    input: &Input,
    from: Option<MeshInputFormat>,
    memory_bytes: u64,
) -> Result<Mesh, Failure> {
    let name = input.name();
    let bytes = input.bytes()?;
    let format = match from {
        Some(MeshInputFormat::Obj) => MeshFormat::Obj,
        Some(MeshInputFormat::Glb) => MeshFormat::Glb,
        Some(MeshInputFormat::Stl) => MeshFormat::Stl,
        Some(MeshInputFormat::Threemf) => MeshFormat::Threemf,
        Some(MeshInputFormat::Ply) => MeshFormat::Ply,
        None => mesh::sniff(&bytes, &name).ok_or_else(|| {
            let text = format!(
                "{name}: this is no mesh file ({KNOWN}; a CSG model is converted first, as in \
                 csg2brep IN -o part.stl)"
            );
            Failure::BadInput(text)
        })?,
    };
    parse(&bytes, format, &name, memory_bytes)
}

/// The mesh in a file's content.
pub(crate) fn parse(
    bytes: &[u8],
    format: MeshFormat,
    name: &str,
    memory_bytes: u64,
) -> Result<Mesh, Failure> {
    let elements = usize::try_from(memory_bytes / BYTES_PER_ELEMENT).unwrap_or(usize::MAX);
    mesh::read(bytes, format, Limits { elements }).map_err(|error| {
        let text = format!("{name}: {error}");
        if error.is_limit {
            Failure::Limit(text)
        } else {
            Failure::BadInput(text)
        }
    })
}

/// The triangles over the first vertex of each position, and how many vertices that leaves out.
pub(crate) fn welded(mesh: &Mesh) -> (Vec<[u32; 3]>, usize) {
    let first = brep::join_equal(&mesh.positions, &mesh.bodies);
    let merged = (0_u32..)
        .zip(&first)
        .filter(|(v, first)| v != *first)
        .count();
    let name = |v: u32| first.get(v as usize).copied().unwrap_or(v);
    let triangles = mesh.triangles.iter().map(|corners| corners.map(name));
    (triangles.collect(), merged)
}
