//! Where light comes from and where it does not reach: one depth map a direction.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "texels and depths are clamped to their ranges before they become integers"
)]

use super::camera::{Axes, Camera};
use super::raster::{Corner, Prepared};
use super::scene::Scene;
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::f32::consts::{PI, TAU};

/// Light from one direction, with the depth of what it meets first.
#[derive(Clone, Debug)]
pub(super) struct Light {
    camera: Camera,
    size: i64,
    /// Depth of the surface nearest to the light, 0 for none: [−1, 1] scaled to 1 ‥ 65535.
    depths: Vec<u16>,
    /// Radiance that arrives from it, white being 1.
    pub color: Vec3,
}

impl Light {
    fn new(scene: &Scene, toward: Vec3, color: Vec3, size: u16) -> Self {
        let axes = Axes::looking_from(toward, Vec3::Z);
        let sphere = [Vec3::ONE, Vec3::NEG_ONE].map(|corner| axes.point(corner));
        let grid = Vec2::splat(f32::from(size));
        let camera = Camera::fit(axes, &sphere, grid, 2.0 / f32::from(size));
        let mut light = Self {
            camera,
            size: i64::from(size),
            depths: vec![0; usize::from(size) * usize::from(size)],
            color,
        };
        let corners: Vec<Corner> = scene
            .positions
            .iter()
            .map(|&point| Corner::new(camera.project(point)))
            .collect();
        let all = 0..light.size;
        for triangle in &scene.triangles {
            let corners = triangle.corners.map(|corner| corners[corner as usize]);
            let Some(prepared) = Prepared::new(corners) else {
                continue;
            };
            prepared.cover(&all, &all, |column, row| {
                let depth = quantise(prepared.depth(column, row));
                let at = (row * light.size + column) as usize;
                light.depths[at] = light.depths[at].max(depth);
            });
        }
        light
    }

    pub(super) fn toward(&self) -> Vec3 {
        self.camera.axes.toward
    }

    /// How much of the light reaches a point with this surface normal: 0 to 1.
    pub(super) fn visibility(&self, point: Vec3, normal: Vec3) -> f32 {
        let cosine = normal.dot(self.toward());
        if cosine <= 0.0 {
            return 0.0;
        }
        // A texel's depth is right at its centre only: step off the surface by about a texel, the
        // more the flatter the light.
        let texel = 1.0 / self.camera.scale;
        let slope = ((1.0 - cosine * cosine).max(0.0).sqrt() / cosine).min(4.0);
        let start = point + normal * (1.2 * texel);
        let projected = self.camera.project(start);
        let depth = quantise(projected.z + texel * (0.6 + 0.6 * slope));
        let corner = projected.truncate() - Vec2::splat(0.5);
        let base = corner.floor();
        let Vec2 { x, y } = corner - base;
        let (column, row) = (base.x as i64, base.y as i64);
        let free = |dc: i64, dr: i64| -> f32 {
            let (column, row) = (column + dc, row + dr);
            let inside = (0..self.size).contains(&column) && (0..self.size).contains(&row);
            let blocked = inside && self.depths[(row * self.size + column) as usize] > depth;
            f32::from(u8::from(!blocked))
        };
        let top = free(0, 0) * (1.0 - x) + free(1, 0) * x;
        let bottom = free(0, 1) * (1.0 - x) + free(1, 1) * x;
        top * (1.0 - y) + bottom * y
    }
}

fn quantise(depth: f32) -> u16 {
    (((depth + 1.0) * 0.5).clamp(0.0, 1.0) * 65534.0) as u16 + 1
}

/// All light of a scene.
#[derive(Clone, Debug)]
pub(super) struct Lights {
    /// Evenly spread over the sphere: bright above, dim below.
    pub sky: Vec<Light>,
    /// A broad lamp beside the eye.
    pub lamp: Vec<Light>,
}

/// Both kinds of lights come in multiples of this: so many samples of a pixel share them out.
pub(super) const GROUPS: usize = 16;

impl Lights {
    pub(super) fn new(scene: &Scene, eye: &Axes) -> Self {
        // Maps cost time in proportion to the triangles: about 2·10⁷ triangles altogether.
        let rounds = (2e7 / (GROUPS * scene.triangles.len().max(1)) as f32) as usize;
        let sky_count = GROUPS * rounds.clamp(4, 14);
        let lamp_count = GROUPS;
        let main = eye.toward * 0.55 - eye.right * 0.75 + Vec3::Z * 0.95;
        let sky: Vec<(Vec3, Vec3)> = (0..sky_count)
            .map(|at| {
                let toward = spiral(at, sky_count, 1.0, -1.0);
                (toward, sky_color(toward))
            })
            .collect();
        let around = Axes::looking_from(main, Vec3::Z);
        let lamp: Vec<(Vec3, Vec3)> = (0..lamp_count)
            .map(|at| {
                // A cone of half-angle 7°.
                let toward = around.point(spiral(at, lamp_count, 1.0, 0.9925));
                (toward, Vec3::new(1.0, 0.97, 0.92))
            })
            .collect();
        let maps = |directions: Vec<(Vec3, Vec3)>, size| {
            directions
                .into_par_iter()
                .map(|(toward, color)| Light::new(scene, toward, color, size))
                .collect()
        };
        Self {
            sky: maps(sky, 400),
            lamp: maps(lamp, 1200),
        }
    }
}

/// Points of a golden spiral on the unit sphere between two heights, evenly spread by area.
fn spiral(at: usize, count: usize, top: f32, bottom: f32) -> Vec3 {
    let height = top + (bottom - top) * (at as f32 + 0.5) / count as f32;
    let radius = (1.0 - height * height).max(0.0).sqrt();
    let golden = PI * (3.0 - 5.0_f32.sqrt());
    let angle = (at as f32 * golden).rem_euclid(TAU);
    Vec3::new(radius * angle.cos(), radius * angle.sin(), height)
}

fn sky_color(toward: Vec3) -> Vec3 {
    let zenith = Vec3::new(0.93, 0.97, 1.06);
    let horizon = Vec3::new(0.80, 0.82, 0.85);
    let ground = Vec3::new(0.42, 0.41, 0.40);
    if toward.z >= 0.0 {
        horizon.lerp(zenith, toward.z.sqrt())
    } else {
        horizon.lerp(ground, (-toward.z * 2.5).min(1.0))
    }
}
