//! The true solid at each sample, by rays (thesis 6.4).

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "offsets within a block of samples"
)]

use super::camera::Camera;
use super::raster::NOTHING;
use super::scene::Scene;
use super::seen::{Patch, Seen, Surface, centre};
use crate::write::appearance;
use csg::{Material, Solid};
use glam::{DVec3, Vec3};
use std::ops::Range;
use subdiv::rays::{Hit, Tracer};

/// A solid, where the scene has it.
pub(super) struct Truth<'a> {
    tracer: Tracer<'a>,
    materials: &'a [Material],
    /// Where the scene's origin is, and how long its unit, in model units.
    origin: DVec3,
    unit: f64,
}

/// Columns and rows of samples whose rays descend together.
const TILE: i64 = 64;

impl<'a> Truth<'a> {
    pub(super) fn new(solid: &'a Solid, scene: &Scene) -> Self {
        Self {
            tracer: Tracer::new(solid),
            materials: &solid.materials,
            origin: scene.origin,
            unit: scene.unit,
        }
    }

    /// Traces a block of samples.
    pub(super) fn look(
        &self,
        camera: &Camera,
        columns: Range<i64>,
        rows: Range<i64>,
    ) -> Result<View, subdiv::Error> {
        let width = columns.end - columns.start;
        let mut spots = vec![None; (width * (rows.end - rows.start)) as usize];
        let toward = camera.axes.toward;
        let mut origins = Vec::new();
        for top in rows.clone().step_by(TILE as usize) {
            for left in columns.clone().step_by(TILE as usize) {
                let [right, bottom] = [(left + TILE).min(columns.end), (top + TILE).min(rows.end)];
                let tile = || (top..bottom).flat_map(|y| (left..right).map(move |x| [x, y]));
                origins.clear();
                origins.extend(tile().map(|at| {
                    let [x, y] = camera.coordinates_of(centre(at));
                    let axes = &camera.axes;
                    let place = axes.right.as_dvec3() * x + axes.up.as_dvec3() * y;
                    self.origin + place * self.unit
                }));
                let hits = self.tracer.first_hits(-toward.as_dvec3(), &origins)?;
                for ([x, y], hit) in tile().zip(hits) {
                    let at = ((y - rows.start) * width + x - columns.start) as usize;
                    spots[at] = hit.map(|hit| self.spot(&hit, camera));
                }
            }
        }
        Ok(View {
            columns,
            rows,
            camera: *camera,
            spots,
        })
    }

    fn spot(&self, hit: &Hit, camera: &Camera) -> Spot {
        let point = ((hit.position - self.origin) / self.unit).as_vec3();
        let [red, green, blue, _] = appearance::color(self.materials, hit.material);
        let materials = self.materials.len().max(1) as u32;
        Spot {
            point,
            depth: camera.axes.coordinates(point).z,
            normal: hit.normal.as_vec3(),
            face: hit.primitive.0.wrapping_mul(materials) + hit.material.0,
            color: Vec3::new(red, green, blue).map(appearance::linear),
        }
    }
}

/// Where one ray ends.
#[derive(Clone, Copy, Debug)]
struct Spot {
    point: Vec3,
    depth: f32,
    normal: Vec3,
    face: u32,
    color: Vec3,
}

/// What the rays of a block saw.
pub(super) struct View {
    columns: Range<i64>,
    rows: Range<i64>,
    camera: Camera,
    spots: Vec<Option<Spot>>,
}

impl View {
    fn index(&self, [column, row]: [i64; 2]) -> Option<usize> {
        let inside = self.columns.contains(&column) && self.rows.contains(&row);
        let width = self.columns.end - self.columns.start;
        inside.then(|| ((row - self.rows.start) * width + column - self.columns.start) as usize)
    }

    fn spot(&self, at: [i64; 2]) -> Option<Spot> {
        self.spots[self.index(at)?]
    }
}

impl Seen for View {
    fn extent(&self) -> [&Range<i64>; 2] {
        [&self.columns, &self.rows]
    }

    /// Each sample is a piece of its own.
    fn piece(&self, at: [i64; 2]) -> u32 {
        let found = self.index(at).filter(|index| self.spots[*index].is_some());
        found.map_or(NOTHING, |index| index as u32)
    }

    fn depth(&self, at: [i64; 2]) -> f32 {
        self.spot(at).map_or(f32::NEG_INFINITY, |spot| spot.depth)
    }

    fn predicted(&self, from: [i64; 2], at: [i64; 2]) -> f32 {
        let Some(spot) = self.spot(from) else {
            return f32::NAN;
        };
        let normal = self.camera.axes.coordinates(spot.normal);
        let step = (centre(at) - centre(from)) / self.camera.scale;
        // On the grid y runs downward.
        spot.depth - (normal.x * step.x - normal.y * step.y) / normal.z
    }

    fn patch(&self, at: [i64; 2]) -> Option<Patch> {
        self.spot(at).map(|spot| Patch {
            face: spot.face,
            normal: spot.normal,
        })
    }

    fn surface(&self, at: [i64; 2]) -> Option<Surface> {
        self.spot(at).map(|spot| Surface {
            point: spot.point,
            normal: spot.normal,
            color: spot.color,
        })
    }
}
