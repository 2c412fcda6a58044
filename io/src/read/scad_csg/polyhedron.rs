//! `polyhedron(points, faces)`, as far as it is convex.

use super::arguments::Arguments;
use super::complaints::{Complaints, Reported};
use super::shapes::{Volume, finish};
use csg::{Error, Shape};
use glam::DVec3;

/// Convex bodies with more faces are meshes of curved ones; each face would be a half-space, and
/// finding the coplanar ones takes quadratic time.
const MAX_FACES: usize = 2000;

/// Reads a convex polyhedron; others are refused, saying why.
pub(super) fn read(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Volume, Reported> {
    let example = "points = [[0, 0, 0], ...], faces = [[0, 1, 2], ...]";
    let Some(points) = arguments.rows("points", 3..=3, complaints)? else {
        return Err(arguments.missing("points", example, complaints));
    };
    let faces = match arguments.rows("faces", 0..=usize::MAX, complaints)? {
        Some(faces) => faces,
        // The name until 2014.
        None => match arguments.rows("triangles", 0..=usize::MAX, complaints)? {
            Some(faces) => faces,
            None => return Err(arguments.missing("faces", example, complaints)),
        },
    };
    if points.value.is_empty() || faces.value.is_empty() {
        let message = "a polyhedron without faces has no volume; it is left out, as in OpenSCAD";
        complaints.warn(arguments.name, message, None);
        return Ok(Volume::Nothing);
    }
    let at = arguments.name;
    if faces.value.len() > MAX_FACES {
        let found = faces.value.len();
        let message = format!("a polyhedron of {found} faces is not supported yet");
        let remedy = format!("convex ones of up to {MAX_FACES} faces are");
        return Err(complaints.error(at, message, remedy));
    }
    let vertices: Vec<DVec3> = points.value.iter().map(|p| DVec3::from_slice(p)).collect();
    let mut corners = Vec::with_capacity(faces.value.len());
    for face in &faces.value {
        let Some(face) = face
            .iter()
            .map(|v| index(*v))
            .collect::<Option<Vec<usize>>>()
        else {
            let message =
                "the faces of a polyhedron must list indices of its points, counted from 0";
            return Err(complaints.error(faces.at, message, None));
        };
        corners.push(face);
    }
    let size = vertices
        .iter()
        .fold(0.0, |size, v| v.abs().max_element().max(size));
    match Shape::convex_polyhedron(&vertices, &corners) {
        Err(Error::NotConvex { face, vertex }) => Err(complaints.error(
            at,
            format!(
                "a polyhedron that is not convex is not supported yet: vertex {vertex} lies beyond face {face}"
            ),
            "write it as a union of convex ones".to_owned(),
        )),
        shape => finish(shape, size, at, complaints),
    }
}

/// A whole number that can be an index.
fn index(value: f64) -> Option<usize> {
    let is_index = value >= 0.0 && value < f64::from(u32::MAX) && value.fract() == 0.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked just before"
    )]
    is_index.then_some(value as usize)
}
