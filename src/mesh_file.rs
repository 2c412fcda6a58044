//! Mesh files as they are: reading, and joining vertices of equal position.

use crate::args::MeshInputFormat;
use crate::failure::Failure;
use crate::input::Input;
use brep::{Brep, Inspection, Shells, Valid};
use csg::{MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use io::read::mesh::{self, Joining, Limits, Mesh, MeshFormat};
use subdiv::{Fragments, Triangle, VertexKind};

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

/// The boundary of the solids that a mesh encloses, and what to say about it.
///
/// Triangles are joined as the format says. Where that is no closed manifold, equal positions are
/// joined, which closes what was written with doubled vertices; solids that touch stay apart.
pub(crate) fn boundary(mesh: &Mesh, name: &str) -> Result<(Valid<Brep>, Vec<String>), Failure> {
    let mut notes = mesh.notes.clone();
    let limit = |error: brep::Error| Failure::Limit(format!("{name}: {error}"));
    let (welded, _) = welded(mesh);
    let mut triangles = match mesh.joining {
        Joining::Positions => welded,
        Joining::Indices | Joining::Extension => mesh.triangles.clone(),
    };
    let found = Inspection::of(&mesh.positions, &triangles).map_err(limit)?;
    let is_inverted = found.volume.is_some_and(|volume| volume < 0.0);
    if is_inverted {
        notes.push("all triangles face inward: measured as if turned over".to_owned());
        for corners in &mut triangles {
            corners.swap(1, 2);
        }
    }
    let fragments = if found.is_sound() {
        plain(&mesh.positions, &triangles)
    } else {
        let at = |v: u32| mesh.positions.get(v as usize).copied();
        let corners = triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(at);
            Some([a?, b?, c?]).filter(|corners| corners.iter().all(|p| p.is_finite()))
        });
        let corners: Option<Vec<[DVec3; 3]>> = corners.collect();
        let open = || {
            let text = format!(
                "{name}: the triangles do not enclose a solid (csg2brep check {name} tells where and why)"
            );
            Failure::BadInput(text)
        };
        let corners = corners.ok_or_else(open)?;
        let fragments = brep::weld(&corners, |_| label([0; 3])).map_err(|_| open())?;
        notes.push(
            "not a closed manifold as it is: measured with equal positions joined".to_owned(),
        );
        fragments
    };
    let bug = |error: &dyn std::fmt::Display| Failure::Bug(error.to_string());
    let brep = brep::stitch(&fragments).map_err(|error| bug(&error))?;
    let brep = brep.validate().map_err(|error| bug(&error))?;
    let stray = Shells::of(&brep).stray_voids.len();
    if stray > 0 {
        notes.push(format!(
            "{stray} of its closed surfaces face inward and lie in no solid: they count in the total only"
        ));
    }
    Ok((brep, notes))
}

/// Named as they are numbered.
fn plain(positions: &[DVec3], triangles: &[[u32; 3]]) -> Fragments {
    Fragments {
        positions: positions.to_vec(),
        kinds: vec![VertexKind::Interior; positions.len()],
        triangles: triangles.iter().copied().map(label).collect(),
    }
}

/// Nothing is known of the surfaces.
fn label(vertices: [u32; 3]) -> Triangle {
    Triangle {
        vertices,
        primitive: PrimitiveId(0),
        sense: Sense::Inside,
        material: MaterialId(0),
    }
}
