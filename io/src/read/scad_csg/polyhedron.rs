//! `polyhedron(points, faces)`: an intersection of half-spaces if it is convex, else a Boolean
//! formula of them.

mod faces;
mod given;
mod partition;

use super::arguments::Arguments;
use super::combine;
use super::complaints::{Complaints, Reported};
use super::shapes::{Volume, finish};
use super::token::Span;
use csg::{Error, Facets, ModelBuilder, NodeId, Shape};
use faces::Faces;
pub(super) use faces::Unsound;
use glam::DVec3;
use partition::Piece;

/// More faces are not tried as a convex body: all their planes would stand in one intersection,
/// of which many matter in each place.
const MAX_CONVEX: usize = 100;

/// Polyhedra with more faces are meshes of curved bodies.
pub(super) const MAX_FACES: usize = 100_000;

/// Distance of the box around a formula from the polyhedron, in sizes of it.
const MARGIN: f64 = 0.05;

/// A part of a formula of half-spaces in prefix order.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Part {
    /// An operator begins.
    Open { union: bool },
    /// The innermost operator ends.
    Close,
    /// The points in a shape, or those outside it.
    Shape { shape: Shape, inside: bool },
}

/// Reads a polyhedron; unsound ones are refused, saying why.
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
        return Err(too_large(faces.value.len(), at, complaints));
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
    if corners.len() <= MAX_CONVEX {
        match Shape::convex_polyhedron(&vertices, &corners) {
            // One that is open, dented or too flat to tell is looked at again.
            Err(Error::NotConvex { .. } | Error::OpenPolyhedron | Error::FlatFace { .. }) => {}
            shape => return finish(shape, size, at, complaints),
        }
    }
    let mut polygons = Vec::with_capacity(corners.len());
    for face in &corners {
        let positions: Option<Vec<DVec3>> =
            face.iter().map(|v| vertices.get(*v).copied()).collect();
        let Some(polygon) = positions else {
            let message = format!(
                "a face names a vertex beyond the last, {}",
                vertices.len() - 1
            );
            return Err(complaints.error(faces.at, message, None));
        };
        polygons.push(polygon);
    }
    of_polygons(polygons, at, complaints)
}

/// The polyhedron with these faces, given as lists of positions in one sense of rotation.
pub(super) fn of_polygons(
    polygons: Vec<Vec<DVec3>>,
    at: Span,
    complaints: &mut Complaints<'_>,
) -> Result<Volume, Reported> {
    let numbers = polygons.iter().flatten().flat_map(DVec3::to_array);
    let size = numbers.fold(0.0_f64, |size, c| size.max(c.abs()));
    if size > super::shapes::MAX_SIZE {
        return finish(Shape::sphere(1.0), size, at, complaints);
    }
    if polygons.len() > MAX_FACES {
        return Err(too_large(polygons.len(), at, complaints));
    }
    match dented(polygons) {
        Ok(polyhedron) => Ok(Volume::Polyhedron(polyhedron)),
        Err(Fault::Numbers(error)) => Err(complaints.error(at, error.to_string(), None)),
        Err(Fault::Unsound(why)) => Err(refuse(&why, at, complaints)),
    }
}

fn too_large(faces: usize, at: Span, complaints: &mut Complaints<'_>) -> Reported {
    let message = format!("a polyhedron of {faces} faces is too large");
    let remedy = format!(
        "polyhedra of up to {MAX_FACES} faces are read; start from the model that this mesh was made of"
    );
    complaints.error(at, message, remedy)
}

/// Why a polyhedron has no formula.
pub(super) enum Fault {
    Unsound(Unsound),
    Numbers(Error),
}

impl From<Unsound> for Fault {
    fn from(why: Unsound) -> Self {
        Self::Unsound(why)
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self::Numbers(error)
    }
}

/// A polyhedron as a formula and, where its faces do not pass through each other, their mesh.
pub(super) struct Polyhedron {
    parts: Vec<Part>,
    facets: Option<Facets>,
}

impl Polyhedron {
    /// The node that it becomes.
    pub(super) fn add_to(self, builder: &mut ModelBuilder) -> NodeId {
        let node = combine::formula(self.parts, builder);
        if let Some(facets) = self.facets {
            builder.bound(node, facets);
        }
        node
    }
}

/// The formula of a polyhedron that need not be convex.
pub(super) fn dented(polygons: Vec<Vec<DVec3>>) -> Result<Polyhedron, Fault> {
    let mut faces = Faces::new(polygons)?;
    let facets = given::facets(&faces);
    let margin = DVec3::splat(MARGIN * faces.size);
    let around = [faces.min - margin, faces.max + margin];
    let parts = within(&mut faces, around)?;
    Ok(Polyhedron { parts, facets })
}

/// The formula of walls that separate inside from outside between two heights, the lowest and
/// the highest of their corners.
pub(super) fn walls(triangles: Vec<[DVec3; 3]>) -> Result<Vec<Part>, Fault> {
    let mut faces = Faces::open(triangles);
    let margin = DVec3::new(1.0, 1.0, 0.0) * (MARGIN * faces.size);
    let around = [faces.min - margin, faces.max + margin];
    within(&mut faces, around)
}

/// The formula of faces in a box.
fn within(faces: &mut Faces, [min, max]: [DVec3; 2]) -> Result<Vec<Part>, Fault> {
    let pieces = partition::formula(faces)?;
    if !partition::is_bounded_by(&pieces, faces) {
        return Err(Unsound::Crossing.into());
    }
    let around = Shape::block(min, max)?;
    let mut parts = vec![
        Part::Open { union: false },
        Part::Shape {
            shape: around,
            inside: true,
        },
    ];
    for piece in pieces {
        parts.push(match piece {
            Piece::Open { union } => Part::Open { union },
            Piece::Close => Part::Close,
            Piece::Side { plane, inside } => {
                let Some(plane) = faces.planes.get(plane) else {
                    continue;
                };
                Part::Shape {
                    shape: Shape::half_space(plane.normal, plane.offset)?,
                    inside,
                }
            }
        });
    }
    parts.push(Part::Close);
    Ok(parts)
}

fn refuse(why: &Unsound, at: Span, complaints: &mut Complaints<'_>) -> Reported {
    let (message, remedy) = match why {
        Unsound::Edge(a, b) => (
            format!(
                "the polyhedron is open, or its faces turn different ways: the edge from {a} to {b} does not join two faces"
            ),
            "list the vertices of all faces clockwise as seen from outside, and close all holes",
        ),
        Unsound::Flat => (
            "the polyhedron encloses no volume".to_owned(),
            "remove it, or move its vertices out of the common plane",
        ),
        Unsound::Crossing => (
            "faces of the polyhedron cross or cover each other".to_owned(),
            "write it as a union of polyhedra that do not",
        ),
        Unsound::Large => (
            "the polyhedron is too intricate".to_owned(),
            "write it as a union of simpler ones",
        ),
    };
    complaints.error(at, message, remedy.to_owned())
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
