//! What VISUAL shows: triangles as wires or filled with a depth buffer, in a projective system and
//! with a table of colours (thesis A.4).

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "pixels are clipped to the picture, which has at most 2^26 of them"
)]

use super::approximation::Face;
use super::colors::Colors;
use super::projection::Projection;
use crate::write::Error;
use glam::{DVec2, DVec3};
use std::io::Write;

/// How triangles are shown.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Mode {
    /// Edges of all triangles, hidden ones, too.
    #[default]
    Wireframe,
    /// Triangles filled with the colour of their material, the nearest in front (SÓLIDO).
    Flat,
    /// The same, darker the more a triangle turns away from the eye.
    Shaded,
}

/// A picture in the making; several approximations may be drawn one over the other.
#[derive(Clone, Debug)]
pub struct Display {
    width: u32,
    height: u32,
    camera: Camera,
    pixels: Vec<[u8; 3]>,
    /// Reciprocal distance of the nearest surface so far; 0 at infinity.
    nearness: Vec<f64>,
}

/// Most pixels of a picture.
const MAX_PIXELS: u64 = 1 << 26;

/// The projective system as a frame.
#[derive(Clone, Copy, Debug)]
struct Camera {
    eye: DVec3,
    right: DVec3,
    up: DVec3,
    forward: DVec3,
    distance: f64,
    window: [f64; 4],
    size: DVec2,
}

impl Camera {
    /// The window stands upright: its vertical is that of space, or y when one looks along z.
    fn new(system: &Projection, size: DVec2) -> Self {
        let forward = system.direction.normalize();
        let side = forward.cross(DVec3::Z);
        let right = side.try_normalize().unwrap_or(DVec3::X);
        Self {
            eye: system.reference - forward * system.distance,
            right,
            up: right.cross(forward),
            forward,
            distance: system.distance,
            window: system.window,
            size,
        }
    }

    /// Coordinates to the right, up and forward, from the eye.
    fn view(&self, point: DVec3) -> DVec3 {
        let arm = point - self.eye;
        DVec3::new(arm.dot(self.right), arm.dot(self.up), arm.dot(self.forward))
    }

    /// Place in the picture, y down, and reciprocal distance, of a point in front of the eye.
    fn project(&self, view: DVec3) -> DVec3 {
        let [x0, y0, x1, y1] = self.window;
        let scale = self.distance / view.z;
        let x = (view.x * scale - x0) / (x1 - x0) * self.size.x;
        let y = (y1 - view.y * scale) / (y1 - y0) * self.size.y;
        DVec3::new(x, y, 1.0 / view.z)
    }

    /// What is nearer is cut away: a thousandth of the distance to the projection plane.
    fn nearest(&self) -> f64 {
        1e-3 * self.distance
    }
}

impl Display {
    /// A picture of the background alone.
    ///
    /// # Errors
    /// [`Error::PictureSize`].
    pub fn new(
        width: u32,
        height: u32,
        system: &Projection,
        colors: &Colors,
    ) -> Result<Self, Error> {
        let count = u64::from(width) * u64::from(height);
        if count == 0 || count > MAX_PIXELS {
            return Err(Error::PictureSize { width, height });
        }
        let size = DVec2::new(width.into(), height.into());
        Ok(Self {
            width,
            height,
            camera: Camera::new(system, size),
            pixels: vec![colors.background(); count as usize],
            nearness: vec![0.0; count as usize],
        })
    }

    /// Draws triangles over what is there.
    pub fn draw(&mut self, faces: &[Face], mode: Mode, colors: &Colors) {
        for face in faces {
            let view = face.corners.map(|c| self.camera.view(DVec3::from(c)));
            let color = colors.of(face.material);
            match mode {
                Mode::Wireframe => {
                    for (from, to) in [(0, 1), (1, 2), (2, 0)] {
                        self.line(view[from], view[to], color);
                    }
                }
                Mode::Flat => self.fill(view, color),
                Mode::Shaded => self.fill(view, shaded(view, color)),
            }
        }
    }

    /// Draws the axes of space, from the origin: x red, y green, z blue, `length` long.
    pub fn draw_axes(&mut self, length: f64) {
        let origin = self.camera.view(DVec3::ZERO);
        let colors = [[230, 60, 60], [60, 180, 60], [80, 110, 255]];
        for (axis, color) in DVec3::AXES.into_iter().zip(colors) {
            let end = self.camera.view(axis * length);
            self.line(origin, end, color);
        }
    }

    /// A line, one pixel wide, where no filled triangle is nearer.
    fn line(&mut self, from: DVec3, to: DVec3, color: [u8; 3]) {
        let near = self.camera.nearest();
        let (mut a, mut b) = (from, to);
        if a.z < near && b.z < near {
            return;
        }
        if a.z < near {
            a = cut(a, b, near);
        } else if b.z < near {
            b = cut(b, a, near);
        }
        let (a, b) = (self.camera.project(a), self.camera.project(b));
        let (start, way) = (a, b - a);
        let Some((a, b)) = clip(a.truncate(), b.truncate(), self.camera.size) else {
            return;
        };
        let length_squared = way.truncate().length_squared().max(f64::MIN_POSITIVE);
        let steps = (b - a).abs().max_element().ceil().max(1.0);
        for step in 0..=steps as u32 {
            let p = a.lerp(b, f64::from(step) / steps);
            // Reciprocal distances are linear in the picture.
            let part = (p - start.truncate()).dot(way.truncate()) / length_squared;
            let nearness = start.z + way.z * part;
            self.put(p.x.floor() as i64, p.y.floor() as i64, nearness, color);
        }
    }

    fn put(&mut self, x: i64, y: i64, nearness: f64, color: [u8; 3]) {
        if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
            && x < self.width
            && y < self.height
        {
            let at = y as usize * self.width as usize + x as usize;
            if nearness >= self.nearness[at] {
                self.pixels[at] = color;
            }
        }
    }

    /// A triangle in view coordinates, cut at the nearest plane.
    fn fill(&mut self, view: [DVec3; 3], color: [u8; 3]) {
        let near = self.camera.nearest();
        let mut polygon = Vec::with_capacity(4);
        for at in 0..3 {
            let (p, q) = (view[at], view[(at + 1) % 3]);
            if p.z >= near {
                polygon.push(p);
            }
            if (p.z >= near) != (q.z >= near) {
                polygon.push(cut(p, q, near));
            }
        }
        let corners: Vec<DVec3> = polygon.iter().map(|p| self.camera.project(*p)).collect();
        for at in 2..corners.len() {
            self.fill_projected([corners[0], corners[at - 1], corners[at]], color);
        }
    }

    /// Every pixel whose centre is covered and where nothing nearer was drawn.
    fn fill_projected(&mut self, [a, b, c]: [DVec3; 3], color: [u8; 3]) {
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        if area == 0.0 || !area.is_finite() {
            return;
        }
        let range = |low: f64, high: f64, end: u32| {
            let clip = |x: f64| x.clamp(0.0, f64::from(end)) as u32;
            clip((low - 0.5).ceil())..clip((high - 0.5).floor() + 1.0)
        };
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        for row in range(low.y, high.y, self.height) {
            for column in range(low.x, high.x, self.width) {
                let p = DVec2::new(f64::from(column) + 0.5, f64::from(row) + 0.5);
                let weight = |from: DVec3, to: DVec3| {
                    (to.truncate() - from.truncate()).perp_dot(p - from.truncate()) / area
                };
                let (u, v, w) = (weight(b, c), weight(c, a), weight(a, b));
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let nearness = u * a.z + v * b.z + w * c.z;
                let at = row as usize * self.width as usize + column as usize;
                if nearness > self.nearness[at] {
                    self.nearness[at] = nearness;
                    self.pixels[at] = color;
                }
            }
        }
    }

    /// The colour of a pixel, rows from above; `None` outside.
    #[must_use]
    pub fn pixel(&self, column: u32, row: u32) -> Option<[u8; 3]> {
        let inside = column < self.width && row < self.height;
        let at = row as usize * self.width as usize + column as usize;
        inside.then(|| self.pixels[at])
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// [`Error::Png`].
    pub fn write_png(&self, out: &mut impl Write) -> Result<(), Error> {
        let mut encoder = png::Encoder::new(out, self.width, self.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(self.pixels.as_flattened())?;
        Ok(writer.finish()?)
    }
}

/// The light that stays on a triangle seen edge-on.
const AMBIENT: f64 = 0.25;

/// A colour in the light of a lamp at the eye; either side of a triangle is lit.
fn shaded([a, b, c]: [DVec3; 3], color: [u8; 3]) -> [u8; 3] {
    let normal = (b - a).cross(c - a).normalize_or_zero();
    let sight = (a + b + c).normalize_or_zero();
    let light = AMBIENT + (1.0 - AMBIENT) * normal.dot(sight).abs();
    color.map(|channel| (f64::from(channel) * light).round() as u8)
}

/// Where the line from `p` to `q` reaches the depth `z`.
fn cut(p: DVec3, q: DVec3, z: f64) -> DVec3 {
    p.lerp(q, (z - p.z) / (q.z - p.z))
}

/// The part of a line inside the picture (Liang and Barsky).
fn clip(a: DVec2, b: DVec2, size: DVec2) -> Option<(DVec2, DVec2)> {
    let d = b - a;
    let (mut start, mut end) = (0.0_f64, 1.0_f64);
    for (slope, room) in [
        (-d.x, a.x),
        (d.x, size.x - a.x),
        (-d.y, a.y),
        (d.y, size.y - a.y),
    ] {
        if slope == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if slope < 0.0 {
            start = start.max(room / slope);
        } else {
            end = end.min(room / slope);
        }
    }
    (start <= end && start.is_finite()).then(|| (a + d * start, a + d * end))
}
