//! From triangles or a mesh of the thesis to fragments, by the positions of their corners.

use crate::failure::Failure;
use crate::run::Job;
use csg::{Aabb, Domain, Formula, FormulaNode, Material, MaterialId, PrimitiveId, Sense, Solid};
use glam::DVec3;
use io::read::format::Format;
use io::thesis::solid::material_color;
use io::thesis::{approximation, wireframe};
use subdiv::{Fragments, Triangle};

/// Reads and welds; also what takes the place of the solid, which has materials only.
pub(crate) fn read(job: &Job, bytes: &[u8], format: Format) -> Result<(Fragments, Solid), Failure> {
    let name = job.input.name();
    let wrong = |text: String| Failure::BadInput(format!("{name}: {text}"));
    if job.clip.is_some() {
        return Err(Failure::Usage("--box: a mesh cannot be clipped".to_owned()));
    }
    let faces = match format {
        Format::ThesisWfr => wireframe::read(bytes).map(|mesh| mesh.value.triangles()),
        _ => approximation::read(bytes).map(|faces| faces.value),
    };
    let faces = faces.map_err(|error| wrong(error.to_string()))?;
    let mut materials: Vec<i32> = faces.iter().map(|face| face.material).collect();
    materials.sort_unstable();
    materials.dedup();
    let corners: Vec<[DVec3; 3]> = faces.iter().map(|f| f.corners.map(DVec3::from)).collect();
    let fragments = brep::weld(&corners, |at| {
        let found = materials.binary_search(&faces[at].material);
        let number = found.ok().and_then(|at| u32::try_from(at).ok());
        let number = number.unwrap_or_default();
        Triangle {
            vertices: [0; 3],
            // No surface is known; faces then are what has one material.
            primitive: PrimitiveId(number),
            sense: Sense::Inside,
            material: MaterialId(number),
        }
    });
    let fragments = fragments.map_err(|error| {
        wrong(format!(
            "the triangles do not close: {error} (subsimpl closes them without -M and -P)"
        ))
    })?;
    let mut extent = Aabb {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };
    for corner in corners.as_flattened() {
        extent.min = extent.min.min(*corner);
        extent.max = extent.max.max(*corner);
    }
    let around = if extent.min.is_finite() {
        extent
    } else {
        Aabb {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        }
    };
    let empty = Formula::new(vec![FormulaNode::Union { len: 0 }]);
    let formula = empty.ok_or_else(|| Failure::Bug("no empty formula".to_owned()))?;
    let solid = Solid {
        domain: Domain::around(&around),
        extent,
        primitives: Vec::new(),
        formula,
        materials: materials
            .into_iter()
            .map(|material| Material {
                color: material_color(material),
            })
            .collect(),
        clipped: false,
        nearly_equal: Vec::new(),
        imprecise: Vec::new(),
        known_boundary: None,
    };
    Ok((fragments, solid))
}
