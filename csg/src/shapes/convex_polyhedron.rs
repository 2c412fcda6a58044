//! Convex polyhedra.

use crate::Polynomial;
use crate::error::{Error, finite};
use crate::shapes::HalfSpace;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A convex polyhedron: the intersection of the half-spaces of its faces.
///
/// Coplanar faces are one half-space.
#[derive(Clone, PartialEq, Debug)]
pub struct ConvexPolyhedron {
    vertices: Vec<DVec3>,
    planes: Vec<HalfSpace>,
}

/// Longest side of a polygon.
fn longest_side(vertices: &[DVec3], corners: &[usize]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let sides = corners.iter().zip(next);
    let sides = sides.map(|(a, b)| vertices[*a].distance(vertices[*b]));
    sides.fold(0.0, f64::max)
}

/// How far a vertex may lie from a plane to count as lying in it, in diagonals of the polyhedron.
///
/// OpenSCAD writes coordinates with six digits, so faces with four and more vertices are planar
/// to no more than that. The polyhedron is changed by at most so much.
const FLATNESS: f64 = 2e-6;

/// Cosine of the largest angle between the normals of faces that are taken for coplanar.
const PARALLEL: f64 = 0.9999;

impl ConvexPolyhedron {
    /// Takes the vertices and for each face the indices of its vertices, in either sense of
    /// rotation, three or more.
    ///
    /// # Errors
    /// [`Error::NonFinite`], [`Error::MissingVertex`], [`Error::FlatFace`],
    /// [`Error::NotConvex`], [`Error::OpenPolyhedron`] unless every edge joins two faces and
    /// they enclose a volume.
    pub fn from_faces(vertices: &[DVec3], faces: &[Vec<usize>]) -> Result<Self, Error> {
        Self::build(vertices, faces, false)
    }

    /// Takes the triangles of a convex hull, of which some may be thin for want of digits: such
    /// ones, no higher than a vertex may lie from its plane, bound nothing.
    ///
    /// # Errors
    /// Those of [`ConvexPolyhedron::from_faces`] but [`Error::FlatFace`].
    pub fn from_hull(vertices: &[DVec3], triangles: &[Vec<usize>]) -> Result<Self, Error> {
        Self::build(vertices, triangles, true)
    }

    fn build(vertices: &[DVec3], faces: &[Vec<usize>], may_be_thin: bool) -> Result<Self, Error> {
        for v in vertices {
            finite("vertex", v.length())?;
        }
        check_faces(vertices, faces)?;
        let low = vertices.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = vertices.iter().copied().fold(-DVec3::INFINITY, DVec3::max);
        let flat = FLATNESS * low.distance(high);
        let center = vertices.iter().sum::<DVec3>() / vertices.len() as f64;

        // The largest of coplanar faces knows its plane best.
        let mut areas: Vec<(usize, DVec3)> = Vec::with_capacity(faces.len());
        for (face, corners) in faces.iter().enumerate() {
            areas.push((face, vector_area(vertices, corners)));
        }
        areas.sort_by(|a, b| b.1.length_squared().total_cmp(&a.1.length_squared()));
        let mut planes: Vec<(DVec3, f64)> = Vec::new();
        for (face, area) in areas {
            let corners = &faces[face];
            if may_be_thin && area.length() <= 2.0 * flat * longest_side(vertices, corners) {
                continue;
            }
            let normal = area.try_normalize().ok_or(Error::FlatFace { face })?;
            let mean = corners.iter().map(|&v| vertices[v]).sum::<DVec3>() / corners.len() as f64;
            let outward = if normal.dot(mean - center) < 0.0 {
                -normal
            } else {
                normal
            };
            let known = planes.iter().any(|&(n, offset)| {
                n.dot(outward) > PARALLEL
                    && corners
                        .iter()
                        .all(|&v| (n.dot(vertices[v]) - offset).abs() <= flat)
            });
            if known {
                continue;
            }
            let offset = outward.dot(mean);
            if let Some(vertex) = vertices
                .iter()
                .position(|v| outward.dot(*v) - offset > flat)
            {
                return Err(Error::NotConvex { face, vertex });
            }
            if outward.dot(center) - offset > -flat {
                return Err(Error::OpenPolyhedron);
            }
            planes.push((outward, offset));
        }
        let half_space = |(normal, offset)| HalfSpace::new(normal, offset);
        Ok(Self {
            vertices: vertices.to_vec(),
            planes: planes
                .into_iter()
                .map(half_space)
                .collect::<Result<_, _>>()?,
        })
    }

    /// The vertices, as given.
    #[must_use]
    pub fn vertices(&self) -> &[DVec3] {
        &self.vertices
    }

    /// The half-spaces whose intersection it is, largest face first.
    #[must_use]
    pub fn planes(&self) -> &[HalfSpace] {
        &self.planes
    }

    pub(crate) fn half_spaces(&self) -> Result<Vec<Polynomial>, Error> {
        self.planes.iter().map(HalfSpace::polynomial).collect()
    }

    pub(crate) fn support(&self, direction: DVec3) -> f64 {
        let along = self.vertices.iter().map(|v| v.dot(direction));
        along.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// Checks that the faces name vertices and that each edge joins two of them.
fn check_faces(vertices: &[DVec3], faces: &[Vec<usize>]) -> Result<(), Error> {
    let mut first_at: FxHashMap<[u64; 3], usize> = FxHashMap::default();
    // Adding 0 turns −0 into 0.
    let mut weld = |at: usize| {
        let key = (vertices[at] + DVec3::ZERO).to_array().map(f64::to_bits);
        *first_at.entry(key).or_insert(at)
    };
    let mut uses: FxHashMap<(usize, usize), usize> = FxHashMap::default();
    for (face, corners) in faces.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&v| v >= vertices.len()) {
            let vertices = vertices.len();
            return Err(Error::MissingVertex {
                face,
                vertex,
                vertices,
            });
        }
        if corners.len() < 3 {
            return Err(Error::FlatFace { face });
        }
        for at in 0..corners.len() {
            let a = weld(corners[at]);
            let b = weld(corners[(at + 1) % corners.len()]);
            if a != b {
                *uses.entry((a.min(b), a.max(b))).or_default() += 1;
            }
        }
    }
    if faces.len() < 4 || uses.values().any(|&count| count != 2) {
        return Err(Error::OpenPolyhedron);
    }
    Ok(())
}

/// Twice the vector area of a polygon, whose direction is the normal that fits it best.
fn vector_area(vertices: &[DVec3], corners: &[usize]) -> DVec3 {
    let origin = vertices[corners[0]];
    let spokes = corners.windows(2).map(|w| {
        let (a, b) = (vertices[w[0]] - origin, vertices[w[1]] - origin);
        a.cross(b)
    });
    spokes.sum()
}
