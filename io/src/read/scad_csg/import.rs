//! `import(file)`: a mesh beside the model, as a polyhedron.

mod amf;
mod off;

use super::arguments::Arguments;
use super::complaints::{Complaints, Reported};
use super::polyhedron;
use super::shapes::Volume;
use crate::read::Files;
use crate::read::mesh::{self, MeshFormat};
use glam::DVec3;
use std::path::Path;

/// Faces, each a list of positions in one sense of rotation.
type Polygons = Vec<Vec<DVec3>>;

/// The text of an argument that names a file; `None` if it names none.
pub(super) fn file<'a>(
    arguments: &Arguments<'a>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<&'a str>, Reported> {
    let given = arguments.string("file", complaints)?;
    let given = match given {
        Some(given) => Some(given),
        None => arguments.string("filename", complaints)?,
    };
    match given {
        Some(given) if !given.value.is_empty() => Ok(Some(given.value)),
        _ => {
            let name = arguments.node();
            let message = format!("`{name}` names no file; it is left out, as in OpenSCAD");
            complaints.warn(arguments.name, message, None);
            Ok(None)
        }
    }
}

/// The content of a file, or the complaint that it cannot be had.
pub(super) fn content(
    path: &str,
    files: &dyn Files,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Vec<u8>, Reported> {
    files.read(path).map_err(|refusal| {
        let shown = path.replace(char::is_control, "\u{fffd}");
        let message = format!("cannot read \"{shown}\": {}", refusal.message);
        // Once for all files that are refused alike.
        complaints.error_once(
            &refusal.message,
            arguments.name,
            message,
            Some(refusal.remedy),
        );
        Reported
    })
}

/// Reads a mesh file.
pub(super) fn read(
    arguments: &Arguments<'_>,
    files: &dyn Files,
    complaints: &mut Complaints<'_>,
) -> Result<Volume, Reported> {
    let Some(path) = file(arguments, complaints)? else {
        return Ok(Volume::Nothing);
    };
    let extension = Path::new(path).extension();
    let extension = extension.map(|e| e.to_string_lossy().to_ascii_lowercase());
    let at = arguments.name;
    let parse: &dyn Fn(&[u8]) -> Result<Polygons, String> = match extension.as_deref() {
        Some("stl") => &|bytes| triangles(bytes, MeshFormat::Stl),
        Some("obj") => &|bytes| triangles(bytes, MeshFormat::Obj),
        Some("3mf") => &|bytes| triangles(bytes, MeshFormat::Threemf),
        Some("off") => &off::read,
        Some("amf") => &amf::read,
        Some("dxf" | "svg") => {
            let message = format!("\"{path}\" is a drawing, which is not read");
            let remedy = "let OpenSCAD make a mesh of what is extruded from it, as in \
                          openscad -o part.off part.scad, and import that";
            return Err(complaints.error(at, message, remedy.to_owned()));
        }
        _ => {
            let message = format!("\"{path}\" is no mesh that can be imported");
            let remedy = "STL, OFF, AMF, OBJ and 3MF are read";
            return Err(complaints.error(at, message, remedy.to_owned()));
        }
    };
    let bytes = content(path, files, arguments, complaints)?;
    let polygons = parse(&bytes).map_err(|wrong| {
        let remedy = "write the mesh again with the program that made it".to_owned();
        complaints.error(at, format!("cannot read \"{path}\": {wrong}"), remedy)
    })?;
    polyhedron::of_polygons(polygons, at, complaints)
}

/// The triangles of a mesh in one of the formats that are also read by themselves.
fn triangles(bytes: &[u8], format: MeshFormat) -> Result<Polygons, String> {
    let mesh = mesh::read(bytes, format, mesh::Limits::default()).map_err(|e| e.to_string())?;
    let polygons = mesh.triangles.iter().enumerate().map(|(at, corners)| {
        let position = |v: &u32| mesh.positions.get(*v as usize).copied();
        let positions: Option<Vec<DVec3>> = corners.iter().map(position).collect();
        let finite = positions.filter(|all| all.iter().all(|p| p.is_finite()));
        finite.ok_or_else(|| format!("{} has no corner", mesh.place(at)))
    });
    polygons.collect()
}
