//! 3MF: the objects that the build names, at their places.
//!
//! Source: 3MF core specification 1.3; of the production extension the paths that put objects
//! into parts of their own.

mod metered;
mod model;

use super::{Limits, Mesh, MeshError, MeshFormat};
use glam::DAffine3;
use metered::Metered;
use model::{Model, Reference};
use std::collections::BTreeMap;
use std::io::{BufReader, Cursor, Read as _};
use zip::ZipArchive;

/// The deepest nesting of components.
const DEEPEST: usize = 64;
/// The most objects with components or triangles that a build may come to.
const MOST_INSTANCES: usize = 1_000_000;
/// Text of one vertex or triangle, generously.
const BYTES_PER_ELEMENT: u64 = 256;
const RELATION: &str = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
const RELATIONS: &str = "_rels/.rels";

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::new(MeshFormat::Threemf, "triangle", limits);
    mesh.bodies.clear();
    let mut archive = ZipArchive::new(Cursor::new(bytes))
        .map_err(|error| MeshError::damaged("", format!("no readable zip archive: {error}")))?;
    let start = start_part(&mut archive)?;
    let mut package = Package {
        archive,
        parts: BTreeMap::new(),
        // Reading takes room too: what is kept of all parts is as large as what is built of them.
        elements: limits.elements,
    };
    package.load(&start)?;
    let Some(model) = package.parts.get(&start) else {
        return Err(MeshError::damaged(start, "there is no such part"));
    };
    mesh.unit = Some(model.unit.clone());
    let items = model.items.clone();

    let mut built = std::collections::BTreeSet::new();
    let mut instances = 0;
    let mut stack: Vec<(String, Reference, DAffine3, usize)> = Vec::new();
    let items = items.into_iter().rev();
    stack.extend(items.map(|item| (start.clone(), item, DAffine3::IDENTITY, 0)));
    while let Some((part, reference, above, depth)) = stack.pop() {
        let place = format!("object {}", reference.object);
        let part = reference.path.clone().unwrap_or(part);
        instances += 1;
        if depth > DEEPEST || instances > MOST_INSTANCES {
            let message = "its components unfold without end";
            let remedy = "components must not contain themselves, nor more than a million objects";
            return Err(MeshError::new(place, message, remedy));
        }
        package.load(&part)?;
        let objects = package.parts.get(&part).map(|model| &model.objects);
        let Some(object) = objects.and_then(|objects| objects.get(&reference.object)) else {
            return Err(MeshError::damaged(place, "there is no such object"));
        };
        built.insert((part.clone(), reference.object));
        let transform = above * reference.transform;
        if !object.triangles.is_empty() || !object.positions.is_empty() {
            mesh.instance(&object.positions, &object.triangles, &transform, place)?;
        }
        let components = object.components.iter().rev();
        stack.extend(components.map(|c| (part.clone(), c.clone(), transform, depth + 1)));
    }
    let all: usize = package
        .parts
        .values()
        .map(|model| model.objects.len())
        .sum();
    if all > built.len() {
        let text = format!(
            "{} objects are not built and not looked at",
            all - built.len()
        );
        mesh.notes.push(text);
    }
    Ok(mesh)
}

/// The parts that were read, by their names in the archive.
struct Package<'a> {
    archive: Archive<'a>,
    parts: BTreeMap<String, Model>,
    elements: usize,
}

impl Package<'_> {
    fn load(&mut self, part: &str) -> Result<(), MeshError> {
        if self.parts.contains_key(part) {
            return Ok(());
        }
        let entry = self.archive.by_name(part);
        let entry = entry.map_err(|error| MeshError::damaged(part, error.to_string()))?;
        let most = BYTES_PER_ELEMENT
            .saturating_mul(self.elements as u64)
            .max(1 << 20);
        let source = Metered::new(BufReader::new(entry), most);
        let model = model::parse(source, part, &mut self.elements)?;
        self.parts.insert(part.to_owned(), model);
        Ok(())
    }
}

/// The name of the part that the package starts with.
fn start_part(archive: &mut Archive<'_>) -> Result<String, MeshError> {
    const MOST: u64 = 1 << 20;
    let mut text = String::new();
    let entry = archive.by_name(RELATIONS).map_err(|_| {
        let message = "the archive has no _rels/.rels, so it is no 3MF package";
        MeshError::new("", message, "unpack it if it is a plain zip archive")
    })?;
    let read = entry.take(MOST).read_to_string(&mut text);
    read.map_err(|error| MeshError::damaged(RELATIONS, error.to_string()))?;
    let target = model::relation(&text, RELATION)
        .map_err(|message| MeshError::damaged(RELATIONS, message))?;
    let target = target.ok_or_else(|| {
        let message = "no relationship leads to a 3D model";
        MeshError::new(RELATIONS, message, "is this a 3MF file?")
    })?;
    Ok(target.trim_start_matches('/').to_owned())
}
