//! Normals for display: smooth within a face, split at creases.

use crate::group::Groups;
use crate::topology::{Brep, HalfEdgeKey, HalfEdgeView, VertexKey};
use crate::validate::Valid;
use csg::{Sense, Solid};
use glam::DVec3;
use slotmap::SecondaryMap;

/// Index of a corner in [`Corners::corners`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct CornerId(pub u32);

/// A vertex as one face sees it: the facets around the vertex between two creases.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Corner {
    /// The mesh vertex.
    pub vertex: VertexKey,
    /// A half-edge that starts at the vertex, in one of the corner's facets.
    pub half_edge: HalfEdgeKey,
    /// Unit normal, outward.
    pub normal: DVec3,
}

/// A mesh vertex has one corner for each sector between creases, and at least one.
#[derive(Clone, Debug)]
pub struct Corners {
    /// All corners; those of one vertex stand together, vertices in mesh order.
    pub corners: Vec<Corner>,
    /// The corner at the origin of each half-edge, in that half-edge's facet.
    pub corner_of: SecondaryMap<HalfEdgeKey, CornerId>,
}

impl Corners {
    /// Finds corners and their normals: the facets' area vectors weighted with their angles, so
    /// that neither slivers nor the choice of diagonals matter. Cost: linear.
    pub fn of(brep: &Valid<Brep>, groups: &Groups) -> Self {
        let mut this = Self {
            corners: Vec::with_capacity(brep.vertex_count()),
            corner_of: SecondaryMap::with_capacity(brep.half_edges.capacity()),
        };
        for vertex in brep.vertices() {
            let start = vertex.ring().find(|&half_edge| groups.is_crease(half_edge));
            let start = start.unwrap_or_else(|| vertex.outgoing());
            let mut sum = DVec3::ZERO;
            let mut first = start;
            for half_edge in start.ring() {
                if half_edge.key() != start.key() && groups.is_crease(half_edge) {
                    this.close(sum, first);
                    first = half_edge;
                    sum = DVec3::ZERO;
                }
                // Corners are at most as many as half-edges, which 32-bit keys number.
                let id = CornerId(u32::try_from(this.corners.len()).unwrap_or(u32::MAX));
                this.corner_of.insert(half_edge.key(), id);
                sum += weighted_normal(half_edge);
            }
            this.close(sum, first);
        }
        this
    }

    /// Ends a sector that begins at `spoke`; one without area takes the normal of the whole vertex.
    fn close(&mut self, sum: DVec3, spoke: HalfEdgeView<'_>) {
        let normal = sum
            .try_normalize()
            .or_else(|| {
                let around = spoke
                    .ring()
                    .map(|half_edge| half_edge.facet().area_vector());
                around.sum::<DVec3>().try_normalize()
            })
            .unwrap_or(DVec3::Z);
        let vertex = spoke.origin().key();
        let half_edge = spoke.key();
        self.corners.push(Corner {
            vertex,
            half_edge,
            normal,
        });
    }
}

/// What it takes to draw a boundary smoothly.
#[derive(Clone, Debug)]
pub struct Shading {
    /// Its faces, edges and vertices.
    pub groups: Groups,
    /// Its corners with their normals.
    pub corners: Corners,
}

impl Shading {
    /// Normals from the facets alone.
    pub fn of(brep: &Valid<Brep>) -> Self {
        let groups = Groups::of(brep);
        let corners = Corners::of(brep, &groups);
        Self { groups, corners }
    }

    /// Normals from the primitives' gradients: smooth also where facets are few and uneven.
    ///
    /// Where a gradient vanishes or contradicts the facets by more than 60° (near singular points
    /// and on uncertified cells), the facets' normal stays. `solid` is what the boundary was made
    /// from.
    pub fn on_surfaces(brep: &Valid<Brep>, solid: &Solid) -> Self {
        const COS_60: f64 = 0.5;
        let mut shading = Self::of(brep);
        for corner in &mut shading.corners.corners {
            let facet = brep.half_edge(corner.half_edge).facet();
            let Some(primitive) = solid.primitives.get(facet.primitive().0 as usize) else {
                continue;
            };
            // The domain is a cube: directions are the same in its coordinates.
            let position = solid
                .domain
                .to_centered(brep.vertex(corner.vertex).position());
            let gradient = primitive.polynomial.gradient(position);
            let outward = match facet.sense() {
                Sense::Inside => gradient,
                Sense::Outside => -gradient,
            };
            match outward.try_normalize() {
                Some(normal) if normal.dot(corner.normal) > COS_60 => corner.normal = normal,
                _ => {}
            }
        }
        shading
    }
}

fn weighted_normal(half_edge: HalfEdgeView<'_>) -> DVec3 {
    let out = half_edge.vector();
    let back = -half_edge.prev().vector();
    let area = out.cross(back);
    let angle_rad = area.length().atan2(out.dot(back));
    area * angle_rad
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, sphere};
    use crate::stitch;
    use csg::{Aabb, Domain, Formula, FormulaNode, Polynomial, Primitive};
    use subdiv::Fragments;

    fn corners(fragments: &Fragments) -> (Valid<Brep>, Corners) {
        let brep = stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let corners = Corners::of(&brep, &Groups::of(&brep));
        (brep, corners)
    }

    #[test]
    fn a_cube_has_three_corners_a_vertex_with_exact_normals() {
        let (brep, corners) = corners(&cube([1.0; 3], 1.0));
        assert_eq!(corners.corners.len(), 24);
        for half_edge in brep.half_edges() {
            let corner = corners.corners[corners.corner_of[half_edge.key()].0 as usize];
            assert_eq!(corner.vertex, half_edge.origin().key());
            let facet_normal = half_edge.facet().area_vector().normalize();
            assert!((corner.normal - facet_normal).length() < 1e-15);
        }
    }

    #[test]
    fn a_sphere_is_smooth_everywhere() {
        let (brep, corners) = corners(&sphere(4));
        assert_eq!(corners.corners.len(), brep.vertex_count());
        // A facet's normal runs through its circumcentre, off by its circumradius at a vertex.
        let facet_error = |facet: crate::FacetView<'_>| {
            let [a, ..] = facet.positions();
            facet.area_vector().angle_between(a)
        };
        let worst_facet = brep.facets().map(facet_error).fold(0.0, f64::max);
        for corner in &corners.corners {
            let radial = brep.vertex(corner.vertex).position();
            assert!(corner.normal.angle_between(radial) < worst_facet / 3.0);
        }
    }

    #[test]
    fn gradients_make_a_coarse_sphere_exact() {
        let extent = Aabb {
            min: DVec3::NEG_ONE,
            max: DVec3::ONE,
        };
        let domain = Domain::around(&extent);
        // In the domain's own coordinates: |origin + size u|² − 1.
        let (o, s) = (domain.center(), domain.half_size());
        let mut matrix = [[0.0; 4]; 4];
        for axis in 0..3 {
            matrix[axis][axis] = s * s;
            matrix[axis][3] = s * o[axis];
            matrix[3][axis] = s * o[axis];
        }
        matrix[3][3] = o.length_squared() - 1.0;
        let polynomial = Polynomial::quadric(&matrix).expect("a quadric");
        let solid = |polynomial| Solid {
            domain,
            extent,
            primitives: vec![Primitive {
                polynomial,
                coefficient_error: 0.0,
            }],
            formula: Formula::new(vec![FormulaNode::Union { len: 0 }]).expect("a formula"),
            materials: Vec::new(),
            clipped: false,
            nearly_equal: Vec::new(),
            imprecise: Vec::new(),
            known_boundary: None,
        };
        let brep = stitch(&sphere(1))
            .expect("closed")
            .validate()
            .expect("valid");
        let error = |shading: Shading| {
            let off = |corner: &Corner| {
                let radial = brep.vertex(corner.vertex).position();
                corner.normal.angle_between(radial)
            };
            shading.corners.corners.iter().map(off).fold(0.0, f64::max)
        };
        assert!(error(Shading::on_surfaces(&brep, &solid(polynomial))) < 1e-7);
        // A primitive that contradicts the facets, or has no gradient, is not believed.
        let plain = error(Shading::of(&brep));
        let constant = Polynomial::constant(1.0).expect("a constant");
        assert!((error(Shading::on_surfaces(&brep, &solid(constant))) - plain).abs() < 1e-12);
    }

    #[test]
    fn facets_without_area_still_have_unit_normals() {
        let mut fragments = cube([0.0; 3], 1.0);
        fragments.positions.fill(DVec3::ONE);
        let (_, corners) = corners(&fragments);
        assert!(
            corners
                .corners
                .iter()
                .all(|corner| corner.normal.is_normalized())
        );
    }
}
