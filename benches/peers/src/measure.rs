//! How far a mesh is from the true boundary, in both directions.

use crate::truth::Truth;
use glam::DVec3;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::TriMesh;
use rayon::prelude::*;

/// An indexed triangle mesh.
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Positions, model units, finite.
    pub positions: Vec<DVec3>,
    /// Indices of corners.
    pub triangles: Vec<[u32; 3]>,
    /// Vertices that were not numbers; they and their triangles are left out.
    pub not_numbers: usize,
}

impl Mesh {
    /// Leaves out what is not finite.
    pub fn new(mut positions: Vec<DVec3>, mut triangles: Vec<[u32; 3]>) -> Self {
        triangles.retain(|t| t.iter().all(|&i| positions[i as usize].is_finite()));
        let not_numbers = positions.iter().filter(|p| !p.is_finite()).count();
        for p in positions.iter_mut().filter(|p| !p.is_finite()) {
            *p = DVec3::ZERO; // in no triangle
        }
        Self {
            positions,
            triangles,
            not_numbers,
        }
    }
}

/// Distances, model units.
#[derive(Clone, Copy, Debug)]
pub struct Distances {
    /// From the mesh's vertices, edge midpoints and centroids to the boundary.
    pub to_boundary: Spread,
    /// From the boundary's samples to the mesh.
    pub to_mesh: Spread,
}

/// The upper end of many distances.
#[derive(Clone, Copy, Debug)]
pub struct Spread {
    /// The largest.
    pub worst: f64,
    /// The largest but for one in a thousand.
    pub usual: f64,
}

impl Spread {
    fn of(mut all: Vec<f64>) -> Self {
        let worst = all.iter().copied().fold(0.0, f64::max);
        let rank = all.len() / 1000;
        let (_, usual, _) = all.select_nth_unstable_by(rank, |a, b| b.total_cmp(a));
        let usual = *usual;
        Self { worst, usual }
    }
}

/// Measures a mesh; `None` for one without triangles.
pub fn measure(mesh: &Mesh, truth: &Truth<'_>) -> Option<Distances> {
    let at = |index: u32| mesh.positions[index as usize];
    let on_triangle = |&[a, b, c]: &[u32; 3]| {
        // Each edge occurs in both directions.
        let edges = [[a, b], [b, c], [c, a]].into_iter().filter(|[i, j]| i < j);
        let middles = edges.map(move |[i, j]| (at(i) + at(j)) * 0.5);
        middles.chain([(at(a) + at(b) + at(c)) / 3.0])
    };
    let mut used = vec![false; mesh.positions.len()];
    for index in mesh.triangles.iter().flatten() {
        used[*index as usize] = true;
    }
    let vertices = mesh.positions.par_iter().zip(&used);
    let vertices = vertices.filter(|(_, used)| **used).map(|(p, _)| *p);
    let points = mesh
        .triangles
        .par_iter()
        .flat_map_iter(on_triangle)
        .chain(vertices);
    let to_boundary = points.map(|p| truth.distance(p)).collect();

    let point = |p: &DVec3| Vector::new(p.x, p.y, p.z);
    let positions = mesh.positions.iter().map(point).collect();
    let shape = TriMesh::new(positions, mesh.triangles.clone()).ok()?;
    let to_mesh = |p: &DVec3| {
        let (foot, _) = shape.project_local_point_and_get_location(point(p), false);
        (foot.point - point(p)).length()
    };
    Some(Distances {
        to_boundary: Spread::of(to_boundary),
        to_mesh: Spread::of(truth.samples.par_iter().map(to_mesh).collect()),
    })
}
