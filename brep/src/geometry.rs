//! Numbers read off the mesh: corners of facets, area vectors, boxes.

use crate::{Brep, FacetView, HalfEdgeView, VertexView};
use csg::Aabb;
use glam::DVec3;

impl Brep {
    /// The smallest box that holds all vertices; [`Aabb::EMPTY`] without any.
    pub fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for vertex in self.vertices.values() {
            bounds.min = bounds.min.min(vertex.position);
            bounds.max = bounds.max.max(vertex.position);
        }
        bounds
    }
}

impl FacetView<'_> {
    /// Its corners, counter-clockwise seen from outside.
    pub fn positions(self) -> [DVec3; 3] {
        self.vertices().map(VertexView::position)
    }

    /// The outward normal, as long as twice the area.
    pub fn area_vector(self) -> DVec3 {
        let [a, b, c] = self.positions();
        (b - a).cross(c - a)
    }
}

impl HalfEdgeView<'_> {
    /// From origin to target.
    pub fn vector(self) -> DVec3 {
        self.target().position() - self.origin().position()
    }
}
