//! What the subdivision hands on: facets whose vertices were named combinatorially.

use csg::{MaterialId, PrimitiveId, Sense};
use glam::DVec3;

/// Where a mesh vertex lives in the subdivision; together with its primitives this is its name.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum VertexKind {
    /// On an edge of the subdivision: one primitive changes sign there.
    Edge,
    /// In a facet of the subdivision: two primitives cross there (a crease passes).
    Facet,
    /// Inside a simplex: three primitives meet there (a corner), or a vertex that only serves
    /// the triangulation.
    Interior,
}

/// A triangle of the boundary on one primitive.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Triangle {
    /// Indices into [`Fragments::positions`], counter-clockwise seen from outside the solid.
    pub vertices: [u32; 3],
    /// The primitive on which it lies.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
}

/// The solid's boundary as oriented triangles over combinatorially identified vertices.
///
/// Two triangles share an edge exactly when they name the same two vertices; no coordinate was
/// ever compared to find that out. Vertices whose neighbourhood would not be a disc have one
/// copy per sheet, so positions may repeat.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Fragments {
    /// Positions in model units.
    pub positions: Vec<DVec3>,
    /// Kind of each vertex, parallel to `positions`.
    pub kinds: Vec<VertexKind>,
    /// The boundary, in traversal order (the same for any number of threads).
    pub triangles: Vec<Triangle>,
}

impl Fragments {
    /// Bounds on the volume of a solid whose boundary is these triangles, each corner of which may
    /// be displaced by `rounding`, in model units.
    pub(crate) fn volume_interval(&self, rounding: f64) -> [f64; 2] {
        let at = |v: u32| self.positions.get(v as usize).copied().unwrap_or_default();
        let apex = self.positions.first().copied().unwrap_or_default();
        let (mut volume, mut error) = (0.0, 0.0);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.vertices.map(|v| at(v) - apex);
            let doubled_area = (b - a).cross(c - a).length();
            let sextuple = a.dot(b.cross(c));
            volume += sextuple;
            // A displaced corner sweeps a third of the area for each unit; products of three
            // differences round by some ulps, and so does the sum.
            let size = a.length() * b.length() * c.length();
            error += 3.0 * rounding * doubled_area + f64::EPSILON * (16.0 * size + volume.abs());
        }
        [(volume - error) / 6.0, (volume + error) / 6.0]
    }
}
