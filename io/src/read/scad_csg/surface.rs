//! `surface(file)`: a field of heights beside the model, as a polyhedron.
//!
//! Four triangles stand over each square of neighbouring heights and meet in its middle at their
//! mean. The bottom is 1 below the lowest height, but not above −1, as in OpenSCAD 2021.01.

use super::arguments::Arguments;
use super::complaints::{Complaints, Reported};
use super::import::{content, file};
use super::polyhedron::{self, MAX_FACES};
use super::shapes::Volume;
use crate::read::Files;
use glam::DVec3;
use std::io::Cursor;

/// Faces for each square: four above, one below.
const FACES: usize = 5;

/// Heights above a grid of unit squares.
struct Heights {
    /// Along x.
    columns: usize,
    /// Along y.
    rows: usize,
    /// Row by row.
    values: Vec<f64>,
}

/// Reads a field of heights.
pub(super) fn read(
    arguments: &Arguments<'_>,
    files: &dyn Files,
    complaints: &mut Complaints<'_>,
) -> Result<Volume, Reported> {
    let Some(path) = file(arguments, complaints)? else {
        return Ok(Volume::Nothing);
    };
    let center = arguments.flag("center", complaints)?;
    let invert = arguments.flag("invert", complaints)?;
    let bytes = content(path, files, arguments, complaints)?;
    let at = arguments.name;
    let heights = if bytes.starts_with(b"\x89PNG") {
        picture(&bytes, invert)
    } else {
        table(&String::from_utf8_lossy(&bytes))
    };
    let heights = heights.map_err(|wrong| {
        let remedy = "a surface is a PNG picture, or lines of numbers";
        complaints.error(
            at,
            format!("cannot read \"{path}\": {wrong}"),
            remedy.to_owned(),
        )
    })?;
    if heights.rows < 2 || heights.columns < 2 {
        let message = format!(
            "\"{path}\" has {} rows of {} heights, which enclose no volume; it is left out",
            heights.rows, heights.columns
        );
        complaints.warn(at, message, None);
        return Ok(Volume::Nothing);
    }
    polyhedron::of_polygons(heights.polygons(center), at, complaints)
}

fn too_many(rows: usize, columns: usize) -> String {
    format!(
        "{rows} × {columns} heights are more than {}",
        MAX_FACES / FACES
    )
}

/// Lines of numbers; `#` begins a comment. Where a line is short, heights are 0.
fn table(text: &str) -> Result<Heights, String> {
    let mut lines = Vec::new();
    let mut columns = 0;
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim_start_matches('\u{feff}').trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let mut row = Vec::new();
        for word in line.split_ascii_whitespace() {
            let value = word.parse::<f64>().ok().filter(|v| v.is_finite());
            row.push(value.ok_or_else(|| {
                let shown: String = word.chars().take(20).collect();
                format!("line {number}: \"{shown}\" is no number")
            })?);
        }
        columns = columns.max(row.len());
        lines.push(row);
    }
    let rows = lines.len();
    if rows.saturating_mul(columns) > MAX_FACES / FACES {
        return Err(too_many(rows, columns));
    }
    let mut values = Vec::with_capacity(rows * columns);
    for mut row in lines {
        row.resize(columns, 0.0);
        values.extend(row);
    }
    Ok(Heights {
        columns,
        rows,
        values,
    })
}

/// The luminance of a picture's pixels, white being 100; the picture's last row is the first
/// along y.
fn picture(bytes: &[u8], invert: bool) -> Result<Heights, String> {
    let mut decoder = png::Decoder::new(Cursor::new(bytes));
    decoder.set_transformations(png::Transformations::normalize_to_color8());
    let mut reader = decoder.read_info().map_err(|error| error.to_string())?;
    let (columns, rows) = (reader.info().width as usize, reader.info().height as usize);
    if rows.saturating_mul(columns) > MAX_FACES / FACES {
        return Err(too_many(rows, columns));
    }
    let size = reader
        .output_buffer_size()
        .ok_or("the picture is too large")?;
    let mut pixels = vec![0; size];
    let frame = reader
        .next_frame(&mut pixels)
        .map_err(|error| error.to_string())?;
    let samples = frame.color_type.samples();
    let mut values = Vec::with_capacity(rows * columns);
    for row in pixels.chunks_exact(frame.line_size).take(rows).rev() {
        for pixel in row.chunks_exact(samples) {
            let luminance = match *pixel {
                [gray] | [gray, _] => f64::from(gray),
                [red, green, blue, ..] => {
                    0.2126 * f64::from(red) + 0.7152 * f64::from(green) + 0.0722 * f64::from(blue)
                }
                [] => 0.0,
            };
            // OpenSCAD's own formula, which takes 1 for white here.
            let shown = if invert { 1.0 - luminance } else { luminance };
            values.push(shown * 100.0 / 255.0);
        }
    }
    Ok(Heights {
        columns,
        rows,
        values,
    })
}

impl Heights {
    fn at(&self, column: usize, row: usize) -> f64 {
        let index = row * self.columns + column;
        self.values.get(index).copied().unwrap_or_default()
    }

    fn polygons(&self, center: bool) -> Vec<Vec<DVec3>> {
        let lowest = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let bottom = (lowest - 1.0).min(0.0);
        let (columns, rows) = (self.columns, self.rows);
        let shift = if center {
            DVec3::new((columns - 1) as f64, (rows - 1) as f64, 0.0) * -0.5
        } else {
            DVec3::ZERO
        };
        let point = |x: usize, y: usize, z: f64| DVec3::new(x as f64, y as f64, z) + shift;
        let top = |(x, y): (usize, usize)| point(x, y, self.at(x, y));
        let below = |(x, y): (usize, usize)| point(x, y, bottom);
        let mut polygons = Vec::new();
        for y in 0..rows - 1 {
            for x in 0..columns - 1 {
                // Counter-clockwise seen from above.
                let ring = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
                let middle = ring.map(top).iter().sum::<DVec3>() * 0.25;
                let next = ring.into_iter().cycle().skip(1);
                for (a, b) in ring.into_iter().zip(next) {
                    polygons.push(vec![top(a), top(b), middle]);
                }
                polygons.push(ring.into_iter().rev().map(below).collect());
            }
        }
        let mut wall = |a, b| polygons.push(vec![below(a), below(b), top(b), top(a)]);
        for x in 0..columns - 1 {
            wall((x, 0), (x + 1, 0));
            wall((x + 1, rows - 1), (x, rows - 1));
        }
        for y in 0..rows - 1 {
            wall((0, y + 1), (0, y));
            wall((columns - 1, y), (columns - 1, y + 1));
        }
        polygons
    }
}
