//! From samples to pixels.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "sample numbers below 2^20, and colours clamped to bytes"
)]

use super::camera::{Axes, Camera};
use super::light::{GROUPS, Light, Lights};
use super::raster::{Corner, Prepared};
use super::scene::Scene;
use super::seen::{Mesh, Seen, Surface, centre};
use super::truth::Truth;
use super::{Options, lines};
use crate::write::appearance::{linear, srgb};
use glam::{Vec2, Vec3};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of pixels that are rendered together.
const BAND: u32 = 16;

/// Free space around the solid, as a part of the picture.
const MARGIN: f32 = 0.09;

/// Colour of lines, linear light.
const INK: Vec3 = Vec3::new(0.012, 0.016, 0.024);

/// Renders to RGB bytes, sRGB, row by row; with a truth, the scene only gives the frame and what
/// keeps light away.
pub(super) fn render(
    scene: &Scene,
    truth: Option<&Truth>,
    options: &Options,
) -> Result<Vec<u8>, subdiv::Error> {
    let samples = options.samples.clamp(1, 8);
    let axes = Axes::of_view(options.view);
    let size = Vec2::new(options.width as f32, options.height as f32) * samples as f32;
    let camera = Camera::fit(axes, &scene.positions, size, MARGIN);
    let corners: Vec<Corner> = scene
        .positions
        .par_iter()
        .map(|&point| Corner::new(camera.project(point)))
        .collect();
    let prepared: Vec<Option<Prepared>> = scene
        .triangles
        .par_iter()
        .map(|triangle| Prepared::new(triangle.corners.map(|corner| corners[corner as usize])))
        .collect();
    let lights = if scene.triangles.is_empty() {
        Lights {
            sky: Vec::new(),
            lamp: Vec::new(),
        }
    } else {
        Lights::new(scene, &axes)
    };
    let renderer = Renderer {
        scene,
        truth,
        options,
        samples: i64::from(samples),
        camera,
        prepared,
        ground: (options.ground && axes.toward.z > 0.08 && !scene.triangles.is_empty())
            .then(|| Ground::new(scene, &lights, &camera, options)),
        background: options
            .background
            .map(|rgb| Vec3::from_array(rgb.map(|channel| linear(f32::from(channel) / 255.0)))),
        lights,
    };
    let row_bytes = 3 * options.width as usize;
    let mut pixels = vec![0; row_bytes * options.height as usize];
    pixels
        .par_chunks_mut(row_bytes * BAND as usize)
        .enumerate()
        .try_for_each(|(band, pixels)| {
            renderer.render_band(band as i64 * i64::from(BAND), pixels)
        })?;
    Ok(pixels)
}

/// How much light reaches the plane on which the solid stands, on a grid over the picture.
struct Ground {
    columns: usize,
    /// 1 where nothing keeps light away.
    light: Vec<f32>,
}

impl Ground {
    /// Pixels between grid points: shadows are soft.
    const SPACING: usize = 2;

    /// `camera` counts in samples.
    fn new(scene: &Scene, lights: &Lights, camera: &Camera, options: &Options) -> Self {
        let [columns, rows] =
            [options.width, options.height].map(|pixels| pixels as usize / Self::SPACING + 2);
        let spacing = Self::SPACING as f32 * options.samples.clamp(1, 8) as f32;
        let all = || {
            lights
                .sky
                .iter()
                .map(|light| (light, SKY / lights.sky.len() as f32))
                .chain(
                    lights
                        .lamp
                        .iter()
                        .map(|light| (light, LAMP / lights.lamp.len() as f32)),
                )
                .map(|(light, share)| (light, share * light.toward().z.max(0.0)))
                .filter(|(_, weight)| *weight > 0.0)
        };
        let free: f32 = all().map(|(_, weight)| weight).sum();
        let eye = camera.axes.toward;
        let mut light = vec![1.0; columns * rows];
        light
            .par_chunks_mut(columns)
            .enumerate()
            .for_each(|(row, line)| {
                for (column, value) in line.iter_mut().enumerate() {
                    // Where the line of sight meets the ground.
                    let place = Vec2::new(column as f32, row as f32) * spacing;
                    let start = camera.unproject(place, 0.0);
                    let point = start + eye * ((scene.floor - start.z) / eye.z);
                    let sum: f32 = all()
                        .map(|(light, weight)| weight * light.visibility(point, Vec3::Z))
                        .sum();
                    *value = sum / free.max(f32::MIN_POSITIVE);
                }
            });
        Self {
            columns,
            light: smoothed(&smoothed(&light, columns), columns),
        }
    }

    /// At a place in the picture, in pixels.
    fn light(&self, place: Vec2) -> f32 {
        let place = place / Self::SPACING as f32;
        let (column, row) = (place.x as usize, place.y as usize);
        let (x, y) = (place.x.fract(), place.y.fract());
        let at = |column, row| {
            self.light
                .get(row * self.columns + column)
                .copied()
                .unwrap_or(1.0)
        };
        let top = at(column, row) * (1.0 - x) + at(column + 1, row) * x;
        let bottom = at(column, row + 1) * (1.0 - x) + at(column + 1, row + 1) * x;
        top * (1.0 - y) + bottom * y
    }
}

/// Averages each grid value with its neighbours, so that the single lights' shadows blend.
fn smoothed(grid: &[f32], columns: usize) -> Vec<f32> {
    let rows = grid.len() / columns;
    let near = |at: usize, len: usize| at.saturating_sub(2)..(at + 3).min(len);
    let mut lines = vec![0.0; grid.len()];
    for (row, line) in lines.chunks_exact_mut(columns).enumerate() {
        for (column, value) in line.iter_mut().enumerate() {
            let range = near(column, columns);
            let count = range.len() as f32;
            *value = range.map(|other| grid[row * columns + other]).sum::<f32>() / count;
        }
    }
    let mut smooth = vec![0.0; grid.len()];
    for (row, line) in smooth.chunks_exact_mut(columns).enumerate() {
        let range = near(row, rows);
        let count = range.len() as f32;
        for (column, value) in line.iter_mut().enumerate() {
            *value = range
                .clone()
                .map(|other| lines[other * columns + column])
                .sum::<f32>()
                / count;
        }
    }
    smooth
}

/// Brightness of a white surface under an open sky of radiance 1 all around.
const SKY: f32 = 0.56 * 4.0;

/// Brightness of a white surface that faces the lamp.
const LAMP: f32 = 0.62;

/// Every so many-th light.
#[derive(Clone, Copy)]
struct Group {
    first: usize,
    step: usize,
}

struct Renderer<'a> {
    scene: &'a Scene,
    truth: Option<&'a Truth<'a>>,
    options: &'a Options,
    samples: i64,
    camera: Camera,
    prepared: Vec<Option<Prepared>>,
    lights: Lights,
    ground: Option<Ground>,
    /// Top and bottom, linear light.
    background: [Vec3; 2],
}

impl Renderer<'_> {
    fn render_band(&self, first_row: i64, pixels: &mut [u8]) -> Result<(), subdiv::Error> {
        let width = i64::from(self.options.width);
        let samples = self.samples;
        let row_count = pixels.len() as i64 / (3 * width);
        let rows = first_row * samples..(first_row + row_count) * samples;
        let radius = self.options.line_width.max(0.0) * 0.5 * samples as f32;
        // Lines reach into the band from rows beside it.
        let halo = radius.ceil() as i64 + 1;
        let columns = 0..width * samples;
        let with_halo = rows.start - halo..rows.end + halo;
        if let Some(truth) = self.truth {
            let seen = truth.look(&self.camera, columns, with_halo)?;
            self.color_band(&seen, &rows, radius, pixels);
        } else {
            let (scene, prepared) = (self.scene, &self.prepared);
            let seen = Mesh::draw(scene, &self.camera, prepared, columns, with_halo);
            self.color_band(&seen, &rows, radius, pixels);
        }
        Ok(())
    }

    /// `radius`: half the width of lines, in samples.
    fn color_band(&self, seen: &impl Seen, rows: &Range<i64>, radius: f32, pixels: &mut [u8]) {
        let width = i64::from(self.options.width);
        let samples = self.samples;
        let darkness = lines::trace(seen, rows, radius);
        for (at, pixel) in (0..).zip(pixels.chunks_exact_mut(3)) {
            let (x, y) = (at % width, at / width);
            let mut sum = Vec3::ZERO;
            for sub in 0..samples * samples {
                let column = x * samples + sub % samples;
                let row = rows.start + y * samples + sub / samples;
                let color = self.sample(seen, [column, row], sub);
                let line = darkness[((row - rows.start) * width * samples + column) as usize];
                sum += color.lerp(INK, f32::from(line) / 255.0);
            }
            let color = sum / (samples * samples) as f32;
            for (byte, channel) in pixel.iter_mut().zip(color.to_array()) {
                *byte = (srgb(channel.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8;
            }
        }
    }

    /// Colour at a sample, linear light.
    fn sample(&self, seen: &impl Seen, at: [i64; 2], sub: i64) -> Vec3 {
        // The samples of a pixel share the lights out among themselves.
        let groups = match self.samples {
            1 => 1,
            2 => 4,
            3 => 8,
            _ => GROUPS,
        };
        let group = Group {
            first: sub as usize % groups,
            step: groups,
        };
        match seen.surface(at) {
            Some(surface) => self.lit(&surface, group),
            None => self.backdrop(centre(at)),
        }
    }

    fn lit(&self, surface: &Surface, group: Group) -> Vec3 {
        let Surface {
            point,
            normal,
            color,
        } = *surface;
        let eye = self.camera.axes.toward;
        let share = |list: &[Light]| group.step as f32 / list.len().max(1) as f32;
        let own = |list: &'_ [Light]| (group.first..list.len()).step_by(group.step);
        let mut light = Vec3::ZERO;
        for at in own(&self.lights.sky) {
            let sky = &self.lights.sky[at];
            let cosine = normal.dot(sky.toward()).max(0.0);
            light += sky.color * (cosine * sky.visibility(point, normal));
        }
        light *= SKY * share(&self.lights.sky);
        let mut shine = 0.0;
        for at in own(&self.lights.lamp) {
            let lamp = &self.lights.lamp[at];
            let visible = lamp.visibility(point, normal) * share(&self.lights.lamp);
            light += lamp.color * (LAMP * visible * normal.dot(lamp.toward()).max(0.0));
            let half = (lamp.toward() + eye).normalize_or_zero();
            shine += visible * normal.dot(half).max(0.0).powi(60);
        }
        let facing = normal.dot(eye).clamp(0.0, 1.0);
        // Fresnel's rise toward the outline, after Schlick.
        let rim = 0.10 * (1.0 - facing).powi(5) * light;
        shoulder(color * light + rim + Vec3::splat(0.10 * shine))
    }

    /// Background, darkened where the solid keeps light from the ground.
    fn backdrop(&self, place: Vec2) -> Vec3 {
        let pixel = place / self.samples as f32;
        let [top, bottom] = self.background;
        let height = self.options.height as f32;
        let color = top.lerp(bottom, (pixel.y / height).clamp(0.0, 1.0));
        match &self.ground {
            Some(ground) => color * (0.25 + 0.75 * ground.light(pixel)),
            None => color,
        }
    }
}

/// Leaves dark and middle tones as they are and bends highlights below 1.
fn shoulder(color: Vec3) -> Vec3 {
    const KNEE: f32 = 0.75;
    color.map(|channel| {
        if channel <= KNEE {
            channel
        } else {
            let over = (channel - KNEE) / (1.0 - KNEE);
            KNEE + (1.0 - KNEE) * (over / (1.0 + over))
        }
    })
}
