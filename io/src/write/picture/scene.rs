//! The boundary as flat arrays of 32-bit numbers, moved and scaled into the unit sphere.

use crate::write::appearance;
use brep::{Brep, Shading, Valid};
use csg::Material;
use glam::{DVec3, Vec3};

/// A triangle to draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// Indices of its corners, counter-clockwise seen from outside.
    pub corners: [u32; 3],
    /// The B-Rep face it belongs to.
    pub face: u32,
    /// Unit normal, outward; zero without area.
    pub normal: Vec3,
    /// Diffuse colour, linear light.
    pub color: Vec3,
}

/// What to draw, inside the unit sphere around the origin.
#[derive(Clone, Debug, Default)]
pub(super) struct Scene {
    pub positions: Vec<Vec3>,
    /// Smooth normals, parallel to `positions`.
    pub normals: Vec<Vec3>,
    pub triangles: Vec<Triangle>,
    /// Height of the lowest point.
    pub floor: f32,
    /// Where its origin is, in model units.
    pub origin: DVec3,
    /// How long its unit is, in model units.
    pub unit: f64,
}

impl Scene {
    pub(super) fn new(brep: &Valid<Brep>, shading: &Shading, materials: &[Material]) -> Self {
        let bounds = brep.bounds();
        if brep.is_empty() {
            return Self::default();
        }
        let Shading { groups, corners } = shading;
        let centre = bounds.min + (bounds.max - bounds.min) * 0.5;
        let radius = (bounds.diagonal() / 2.0).max(f64::MIN_POSITIVE);
        let fit = |position: DVec3| ((position - centre) / radius).as_vec3();
        let triangles = brep.facets().map(|facet| {
            let [red, green, blue, _] = appearance::color(materials, facet.material());
            Triangle {
                corners: facet
                    .half_edges()
                    .map(|half_edge| corners.corner_of[half_edge.key()].0),
                face: groups.face_of[facet.key()].0,
                normal: facet.area_vector().normalize_or_zero().as_vec3(),
                color: Vec3::new(red, green, blue).map(appearance::linear),
            }
        });
        let list = &corners.corners;
        Self {
            triangles: triangles.collect(),
            positions: list
                .iter()
                .map(|c| fit(brep.vertex(c.vertex).position()))
                .collect(),
            normals: list.iter().map(|corner| corner.normal.as_vec3()).collect(),
            floor: fit(bounds.min).z,
            origin: centre,
            unit: radius,
        }
    }
}
