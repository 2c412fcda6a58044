//! Meshes and bytes to files and standard output.

use crate::args::OutputFormat;
use crate::failure::Failure;
use crate::pipeline::Boundary;
use crate::run::{Output, Target};
use crate::thesis::csg2cspg::sectors_of;
use crate::thesis::pipe::DialectArgs;
use brep::{Brep, Shading};
use csg::Material;
use io::thesis::ByteOrder;
use io::thesis::approximation::{self, Face};
use io::thesis::sectors;
use io::thesis::solid;
use io::thesis::wireframe::{self, Wireframe};
use io::write::{Error, Unit, atomic, gltf, obj, ply, stl, threemf};
use std::io::{BufWriter, Write};
use std::path::Path;

/// Writes a boundary; a failed run leaves the old file as it was. Returns what the user should
/// know about the file.
pub(crate) fn write(
    output: &Output,
    boundary: &Boundary,
    unit: Option<Unit>,
    dialect: DialectArgs,
) -> Result<Option<String>, Failure> {
    let library = match (output.format, &output.target) {
        (OutputFormat::Obj, Target::File(path)) if is_painted(&boundary.solid.materials) => {
            Some(path.with_extension("mtl"))
        }
        _ => None,
    };
    let mut remark = None;
    let reference = library.as_deref().and_then(Path::file_name);
    let reference = reference.map(|name| name.to_string_lossy().into_owned());
    to_target(&output.target, |out| {
        remark = mesh(output.format, boundary, unit, reference, dialect, out)?;
        Ok(())
    })?;
    if let Some(library) = library {
        let Boundary { brep, solid, .. } = boundary;
        let target = Target::File(library);
        to_target(&target, |mut out| {
            obj::write_materials(brep, &solid.materials, &mut out)
        })?;
    }
    Ok(remark)
}

/// Writes bytes that are all there already.
pub(crate) fn write_bytes(target: &Target, bytes: &[u8]) -> Result<(), Failure> {
    to_target(target, |out| Ok(out.write_all(bytes)?))
}

/// Writes a file beside its target and renames it, or writes to standard output.
pub(crate) fn to_target(
    target: &Target,
    contents: impl FnOnce(&mut dyn Write) -> Result<(), Error>,
) -> Result<(), Failure> {
    let result = match target {
        Target::Stdout => {
            let mut out = BufWriter::new(std::io::stdout().lock());
            contents(&mut out).and_then(|()| Ok(out.flush()?))
        }
        Target::File(path) => atomic::write(path, |out| contents(out)),
    };
    result.map_err(|error| Failure::from_writer(&target.name(), error))
}

fn mesh(
    format: OutputFormat,
    boundary: &Boundary,
    unit: Option<Unit>,
    material_library: Option<String>,
    dialect: DialectArgs,
    mut out: &mut dyn Write,
) -> Result<Option<String>, Error> {
    let Boundary { brep, solid, .. } = boundary;
    match format {
        OutputFormat::Obj => {
            let options = obj::Options {
                material_library,
                unit,
            };
            let shading = Shading::on_surfaces(brep, solid);
            obj::write_shaded(brep, &shading, &options, &mut out)?;
        }
        OutputFormat::Glb => {
            let shading = Shading::on_surfaces(brep, solid);
            let options = gltf::Options {
                metres_per_unit: unit.map_or(1.0, Unit::metres),
            };
            gltf::write_shaded(brep, &shading, &solid.materials, &options, &mut out)?;
        }
        OutputFormat::Threemf => {
            let options = threemf::Options {
                unit: unit.unwrap_or_default(),
            };
            threemf::write(brep, &solid.materials, &options, &mut out)?;
        }
        OutputFormat::Ply => {
            let options = ply::Options { unit };
            ply::write(brep, &solid.materials, &options, &mut out)?;
        }
        OutputFormat::Stl => {
            let outcome = stl::write(brep, &mut out)?;
            if let stl::Welding::Broken { .. } = outcome.welding {
                let text = "the 32-bit numbers of STL make different vertices equal: programs that \
                            join equal vertices will not find the mesh closed; 3MF, PLY, GLB and OBJ have no \
                            such problem";
                return Ok(Some(text.to_owned()));
            }
        }
        // Not a mesh: `crate::true_surfaces`.
        OutputFormat::Step => {}
        OutputFormat::ThesisCsg => {
            let tree = solid::from_solid(&boundary.solid, dialect.form());
            solid::write(&tree, dialect.operators(), ByteOrder::Big, &mut out)?;
        }
        OutputFormat::Cspg => {
            let sectors = sectors_of(&boundary.solid);
            sectors::write(&sectors, dialect.operators(), ByteOrder::Big, &mut out)?;
        }
        OutputFormat::Apl => approximation::write(faces(brep), ByteOrder::Big, &mut out)?,
        OutputFormat::Wfr => {
            let mesh = Wireframe::from_faces(&faces(brep))?;
            wireframe::write(&mesh, ByteOrder::Big, &mut out)?;
        }
    }
    Ok(None)
}

/// The facets as the thesis writes them; one whose leaf held several surfaces is not told apart.
fn faces(brep: &Brep) -> Vec<Face> {
    let facets = brep.facets();
    facets
        .map(|facet| Face {
            material: solid::material_number(facet.material()),
            corners: facet.vertices().map(|v| v.position().to_array()),
        })
        .collect()
}

/// Whether any part has a colour.
fn is_painted(materials: &[Material]) -> bool {
    materials.iter().any(|material| material.color.is_some())
}
