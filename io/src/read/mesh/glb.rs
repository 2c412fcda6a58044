//! Binary glTF 2.0: the meshes that the scene shows, at their places.
//!
//! A mesh with `EXT_mesh_manifold` is joined by what the extension says. Without it normals and
//! colours force writers to double vertices, so that only equal positions can be joined.
//! Positions are those of the scene: in metres, y up.

mod accessor;

use super::error::DAMAGED;
use super::{Joining, Limits, Mesh, MeshError, MeshFormat, NO_VERTEX};
use accessor::Buffers;
use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf_json as json;
use json::mesh::{Mode, Semantic};
use json::validation::Checked;
use json::{Index, Root};
use std::collections::HashMap;

const EXTENSION: &str = "EXT_mesh_manifold";
/// Extensions that a file may require and that do not change where triangles are.
const UNDERSTOOD: [&str; 6] = [
    EXTENSION,
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_materials_specular",
];

pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Mesh, MeshError> {
    let (text, binary) = chunks(bytes)?;
    let root = Root::from_slice(text).map_err(|error| {
        let place = format!("JSON line {}", error.line());
        MeshError::damaged(place, format!("no glTF description: {error}"))
    })?;
    let mut required = root.extensions_required.iter();
    if let Some(name) = required.find(|name| !UNDERSTOOD.contains(&name.as_str())) {
        let message = format!(
            "the file requires the extension {}",
            super::obj::shortened(name)
        );
        let remedy = "save it without compression and other required extensions";
        return Err(MeshError::new("extensionsRequired", message, remedy));
    }
    let mut file = Reader {
        buffers: Buffers::new(&root, binary),
        root: &root,
        mesh: Mesh::new(MeshFormat::Glb, "triangle", limits),
        joined_by_extension: 0,
        joined_by_position: 0,
        skipped: 0,
    };
    file.mesh.bodies.clear();
    for (index, transform) in file.shown()? {
        file.add(index, &transform)?;
    }
    let Reader {
        mut mesh,
        joined_by_extension,
        joined_by_position,
        skipped,
        ..
    } = file;
    if skipped > 0 {
        let text = format!("{skipped} primitives of points or lines are not looked at");
        mesh.notes.push(text);
    }
    mesh.joining = match (joined_by_extension, joined_by_position) {
        (_, 0) => Joining::Extension,
        (0, _) => Joining::Positions,
        _ => {
            let text = "some meshes have EXT_mesh_manifold, others not: all are joined by position";
            mesh.notes.push(text.to_owned());
            Joining::Positions
        }
    };
    mesh.unit = Some("metre".to_owned());
    Ok(mesh)
}

/// The chunks of a GLB file: JSON, and binary if there is one.
fn chunks(bytes: &[u8]) -> Result<(&[u8], &[u8]), MeshError> {
    let number = |at: usize| {
        let field: [u8; 4] = bytes.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(field))
    };
    let version = number(4);
    if version != Some(2) {
        let message = match version {
            Some(version) => format!("version {version}, expected 2"),
            None => "the header is cut off".to_owned(),
        };
        return Err(MeshError::damaged("byte 4", message));
    }
    let stated = number(8).unwrap_or_default() as usize;
    if stated > bytes.len() {
        let message = format!(
            "the header announces {stated} bytes, the file has {}",
            bytes.len()
        );
        return Err(MeshError::damaged("byte 8", message));
    }
    let chunk = |at: usize| {
        let length = number(at)? as usize;
        let data = bytes.get(at + 8..at.checked_add(8)?.checked_add(length)?)?;
        Some((number(at + 4)?.to_le_bytes(), data))
    };
    let Some((kind, text)) = chunk(12).filter(|(kind, _)| kind == b"JSON") else {
        return Err(MeshError::damaged(
            "byte 12",
            "there is no whole JSON chunk",
        ));
    };
    let _ = kind;
    let next = 20 + text.len();
    if next + 8 > bytes.len() {
        return Ok((text, &[]));
    }
    match chunk(next) {
        Some((kind, data)) if &kind == b"BIN\0" => Ok((text, data)),
        Some(_) => Ok((text, &[])),
        None => Err(MeshError::damaged(
            format!("byte {next}"),
            "the binary chunk is cut off",
        )),
    }
}

struct Reader<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
    mesh: Mesh,
    joined_by_extension: usize,
    joined_by_position: usize,
    skipped: usize,
}

impl Reader<'_> {
    /// The meshes of the scene, each with its place; without scenes all meshes where they are.
    fn shown(&self) -> Result<Vec<(usize, DAffine3)>, MeshError> {
        let scene = self.root.scene.map_or(0, |scene| scene.value());
        let Some(scene) = self.root.scenes.get(scene) else {
            let all = 0..self.root.meshes.len();
            return Ok(all.map(|at| (at, DAffine3::IDENTITY)).collect());
        };
        let mut shown = Vec::new();
        let mut visited = vec![false; self.root.nodes.len()];
        let mut stack: Vec<(Index<json::Node>, DAffine3)> = Vec::new();
        let roots = scene.nodes.iter().rev();
        stack.extend(roots.map(|node| (*node, DAffine3::IDENTITY)));
        while let Some((index, above)) = stack.pop() {
            let place = format!("node {}", index.value());
            let Some(node) = self.root.get(index) else {
                return Err(MeshError::damaged(place, "there is no such node"));
            };
            // Nodes are trees; without this a cycle would never end.
            let is_again = visited.get_mut(index.value());
            if is_again.is_none_or(|visited| std::mem::replace(visited, true)) {
                let remedy = "each node may be shown once only: save the file again";
                return Err(MeshError::new(place, "the node occurs twice", remedy));
            }
            let transform = above * local(node);
            if let Some(mesh) = node.mesh {
                shown.push((mesh.value(), transform));
            }
            let children = node.children.iter().flatten().rev();
            stack.extend(children.map(|child| (*child, transform)));
        }
        Ok(shown)
    }

    /// Adds the triangles of a mesh.
    fn add(&mut self, index: usize, transform: &DAffine3) -> Result<(), MeshError> {
        let Some(mesh) = self.root.meshes.get(index) else {
            let place = format!("mesh {index}");
            return Err(MeshError::damaged(place, "there is no such mesh"));
        };
        let extensions = mesh.extensions.as_ref();
        let extension = extensions.and_then(|all| all.others.get(EXTENSION));
        let mut positions = Vec::new();
        let mut known = HashMap::new();
        if let Some(extension) = extension {
            let place = format!("mesh {index}, {EXTENSION}");
            let primitive = extension.get("manifoldPrimitive").cloned();
            let primitive = primitive.and_then(|value| serde_json::from_value(value).ok());
            let primitive: json::mesh::Primitive = primitive.ok_or_else(|| {
                MeshError::damaged(place.as_str(), "there is no manifoldPrimitive")
            })?;
            let triangles = self.triangles(&primitive, &place, &mut positions, &mut known)?;
            self.check_merges(&primitive, &place, &positions)?;
            self.joined_by_extension += 1;
            let label = format!("mesh {index}");
            return self.mesh.instance(&positions, &triangles, transform, label);
        }
        self.joined_by_position += 1;
        let mut all = Vec::new();
        for (at, primitive) in mesh.primitives.iter().enumerate() {
            let place = format!("mesh {index}, primitive {at}");
            all.push((
                place.clone(),
                self.triangles(primitive, &place, &mut positions, &mut known)?,
            ));
        }
        // One body, whose triangles are named by their primitives.
        let first = self.mesh.triangles.len();
        let mut start = 0;
        let triangles: Vec<[u32; 3]> = all.iter().flat_map(|(_, list)| list).copied().collect();
        self.mesh
            .instance(&positions, &triangles, transform, String::new())?;
        self.mesh.parts.pop();
        for (label, triangles) in all {
            let first_triangle = first + start;
            self.mesh.parts.push(super::Part {
                label,
                first_triangle,
            });
            let numbers = self.mesh.numbers.iter_mut().skip(first_triangle);
            numbers.zip(0..).for_each(|(number, at)| *number = at);
            start += triangles.len();
        }
        Ok(())
    }

    /// The triangles of a primitive; its positions are appended, those of one accessor once.
    fn triangles(
        &mut self,
        primitive: &json::mesh::Primitive,
        place: &str,
        positions: &mut Vec<DVec3>,
        known: &mut HashMap<usize, (u32, u32)>,
    ) -> Result<Vec<[u32; 3]>, MeshError> {
        let mode = match primitive.mode {
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(MeshError::damaged(place, "its mode is not known")),
        };
        if !matches!(
            mode,
            Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan
        ) {
            self.skipped += 1;
            return Ok(Vec::new());
        }
        let accessor = primitive
            .attributes
            .get(&Checked::Valid(Semantic::Positions));
        let Some(accessor) = accessor else {
            return Err(MeshError::damaged(place, "there is no POSITION"));
        };
        let (first, count) = if let Some(found) = known.get(&accessor.value()) {
            *found
        } else {
            let found = self
                .buffers
                .positions(accessor.value(), place, self.mesh.room)?;
            self.mesh.take(found.len())?;
            self.mesh.room += found.len();
            let first = u32::try_from(positions.len()).unwrap_or(NO_VERTEX);
            let count = u32::try_from(found.len()).unwrap_or(NO_VERTEX);
            positions.extend(found);
            known.insert(accessor.value(), (first, count));
            (first, count)
        };
        let indices = match primitive.indices {
            Some(indices) => self
                .buffers
                .indices(indices.value(), place, 3 * self.mesh.room)?,
            None => (0..count).collect(),
        };
        let number = |v: u32| if v < count { first + v } else { NO_VERTEX };
        let indices: Vec<u32> = indices.into_iter().map(number).collect();
        if mode == Mode::Triangles {
            let (triangles, rest) = indices.as_chunks::<3>();
            if !rest.is_empty() {
                let message = format!("{} indices are no whole number of triangles", indices.len());
                return Err(MeshError::damaged(place, message));
            }
            return Ok(triangles.to_vec());
        }
        let first = indices.first().copied().unwrap_or(NO_VERTEX);
        let triples = (0..).zip(indices.windows(3));
        let corners = triples.filter_map(|(at, triple)| {
            let [a, b, c] = *triple.as_array()?;
            Some(match mode {
                Mode::TriangleFan => [first, b, c],
                _ if at % 2 == 0 => [a, b, c],
                _ => [b, a, c],
            })
        });
        Ok(corners.collect())
    }

    /// The extension may join vertices of one position only.
    fn check_merges(
        &mut self,
        primitive: &json::mesh::Primitive,
        place: &str,
        positions: &[DVec3],
    ) -> Result<(), MeshError> {
        let Some(indices) = primitive.indices else {
            let message = "its triangles have no indices";
            return Err(MeshError::damaged(place, message));
        };
        let limit = 3 * self.mesh.room;
        let joined = self.buffers.indices(indices.value(), place, limit)?;
        let drawn = self
            .buffers
            .indices_without_sparse(indices.value(), place, limit)?;
        let at = |v: u32| positions.get(v as usize);
        let mut both = joined.iter().zip(&drawn);
        if let Some((a, b)) = both.find(|(a, b)| at(**a) != at(**b)) {
            let message =
                format!("it makes vertices {a} and {b} one, which are at different places");
            let remedy = "the writer of the file is at fault; --weld ignores the extension";
            return Err(MeshError::new(place, message, remedy));
        }
        Ok(())
    }
}

/// A node's own transform, from matrix or from parts.
fn local(node: &json::Node) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        let matrix = matrix.map(f64::from);
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix));
    }
    let vector = |list: [f32; 3]| DVec3::from(list.map(f64::from));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |unit| {
        let turn = DQuat::from_array(unit.0.map(f64::from));
        // Unit only to 32 bits.
        if turn.length() > 0.0 {
            turn.normalize()
        } else {
            DQuat::IDENTITY
        }
    });
    DAffine3::from_scale_rotation_translation(
        node.scale.map_or(DVec3::ONE, vector),
        rotation,
        node.translation.map_or(DVec3::ZERO, vector),
    )
}

/// An accessor, view or buffer that does not exist or is too short.
fn broken(place: &str, what: &str) -> MeshError {
    MeshError::new(place, what, DAMAGED)
}
