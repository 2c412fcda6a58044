//! Triangles to samples: exact coverage, nearest depth.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "grids have at most 2^17 samples on an axis, and indices are clipped to them"
)]

use glam::Vec3;
use std::ops::Range;

/// Steps of the fixed-point coordinates in one sample.
const STEPS: f32 = 256.0;
const STEP: i64 = 256;

/// A corner on the grid: fixed-point position and depth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    x: i64,
    y: i64,
    depth: f32,
}

impl Corner {
    /// From a position in samples, x right and y down, and a depth.
    pub(super) fn new(projected: Vec3) -> Self {
        Self {
            x: (projected.x * STEPS).round() as i64,
            y: (projected.y * STEPS).round() as i64,
            depth: projected.z,
        }
    }
}

/// A triangle ready to be drawn; on a grid whose y runs down, front faces are clockwise.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prepared {
    corners: [Corner; 3],
    area: i64,
    /// Depth gradient in x and y, a sample.
    slope: [f32; 2],
    /// Smallest and largest depth.
    depths: [f32; 2],
}

impl Prepared {
    /// `None` for triangles that face away or have no area on the grid.
    pub(super) fn new(corners: [Corner; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let (abx, aby, acx, acy) = (b.x - a.x, b.y - a.y, c.x - a.x, c.y - a.y);
        let area = acx * aby - abx * acy;
        if area <= 0 {
            return None;
        }
        let (db, dc) = (f64::from(b.depth - a.depth), f64::from(c.depth - a.depth));
        let per_sample = STEP as f64 / area as f64;
        let slope_x = (dc * aby as f64 - db * acy as f64) * per_sample;
        let slope_y = (db * acx as f64 - dc * abx as f64) * per_sample;
        Some(Self {
            corners,
            area,
            slope: [slope_x as f32, slope_y as f32],
            depths: [
                a.depth.min(b.depth).min(c.depth),
                a.depth.max(b.depth).max(c.depth),
            ],
        })
    }

    /// Rows of samples that it may touch.
    pub(super) fn rows(&self) -> Range<i64> {
        let [a, b, c] = self.corners.map(|corner| corner.y);
        sample_range(a.min(b).min(c), a.max(b).max(c))
    }

    fn columns(&self) -> Range<i64> {
        let [a, b, c] = self.corners.map(|corner| corner.x);
        sample_range(a.min(b).min(c), a.max(b).max(c))
    }

    /// Depth of its plane at a sample, also outside of it.
    pub(super) fn plane_depth(&self, column: f32, row: f32) -> f32 {
        let a = self.corners[0];
        let dx = column + 0.5 - a.x as f32 / STEPS;
        let dy = row + 0.5 - a.y as f32 / STEPS;
        a.depth + self.slope[0] * dx + self.slope[1] * dy
    }

    /// Depth at a sample that it covers; the clamp tames slivers' steep planes.
    pub(super) fn depth(&self, column: i64, row: i64) -> f32 {
        self.plane_depth(column as f32, row as f32)
            .clamp(self.depths[0], self.depths[1])
    }

    /// Barycentric coordinates of a sample, clamped to the triangle.
    pub(super) fn barycentric(&self, column: i64, row: i64) -> Vec3 {
        let (x, y) = centre(column, row);
        let [a, b, c] = self.corners;
        let area = self.area as f32;
        let weights = Vec3::new(
            edge(b, c, x, y) as f32 / area,
            edge(c, a, x, y) as f32 / area,
            edge(a, b, x, y) as f32 / area,
        );
        let weights = weights.max(Vec3::ZERO);
        weights / weights.element_sum().max(f32::MIN_POSITIVE)
    }

    /// Calls `visit(column, row)` for all samples covered, each sample on a shared edge for one of
    /// the two triangles only.
    pub(super) fn cover(
        &self,
        columns: &Range<i64>,
        rows: &Range<i64>,
        mut visit: impl FnMut(i64, i64),
    ) {
        let own = self.columns();
        let columns = own.start.max(columns.start)..own.end.min(columns.end);
        let own = self.rows();
        let rows = own.start.max(rows.start)..own.end.min(rows.end);
        let [a, b, c] = self.corners;
        let edges = [(b, c), (c, a), (a, b)];
        // Samples exactly on an edge belong to it when it is a left or top one.
        let bias = edges.map(|(p, q)| {
            let owns = q.y < p.y || (q.y == p.y && q.x < p.x);
            i64::from(!owns)
        });
        let step = edges.map(|(p, q)| (q.y - p.y) * STEP);
        for row in rows {
            let (x, y) = centre(columns.start, row);
            let mut values: [i64; 3] =
                std::array::from_fn(|at| edge(edges[at].0, edges[at].1, x, y) - bias[at]);
            let mut entered = false;
            for column in columns.clone() {
                if values.iter().all(|&value| value >= 0) {
                    entered = true;
                    visit(column, row);
                } else if entered {
                    break;
                }
                for (value, step) in values.iter_mut().zip(step) {
                    *value += step;
                }
            }
        }
    }
}

/// Samples whose centres lie in a closed interval of fixed-point coordinates.
fn sample_range(min: i64, max: i64) -> Range<i64> {
    (min - STEP / 2).div_euclid(STEP)..(max - STEP / 2).div_euclid(STEP) + 1
}

fn centre(column: i64, row: i64) -> (i64, i64) {
    (column * STEP + STEP / 2, row * STEP + STEP / 2)
}

/// Twice the area of (p, q, sample), positive when the sample is inside a front face's edge.
fn edge(p: Corner, q: Corner, x: i64, y: i64) -> i64 {
    (q.y - p.y) * (x - p.x) - (q.x - p.x) * (y - p.y)
}

/// Depths and triangle numbers of a block of samples.
#[derive(Clone, Debug)]
pub(super) struct Block {
    pub columns: Range<i64>,
    pub rows: Range<i64>,
    depths: Vec<f32>,
    triangles: Vec<u32>,
}

/// No triangle.
pub(super) const NOTHING: u32 = u32::MAX;

impl Block {
    pub(super) fn new(columns: Range<i64>, rows: Range<i64>) -> Self {
        let len = ((columns.end - columns.start) * (rows.end - rows.start)).max(0) as usize;
        Self {
            columns,
            rows,
            depths: vec![f32::NEG_INFINITY; len],
            triangles: vec![NOTHING; len],
        }
    }

    pub(super) fn draw(&mut self, number: u32, triangle: &Prepared) {
        let Self {
            columns,
            rows,
            depths,
            triangles,
        } = self;
        let width = columns.end - columns.start;
        let (left, top) = (columns.start, rows.start);
        triangle.cover(columns, rows, |column, row| {
            let at = ((row - top) * width + column - left) as usize;
            let depth = triangle.depth(column, row);
            if depth > depths[at] {
                depths[at] = depth;
                triangles[at] = number;
            }
        });
    }

    fn index(&self, column: i64, row: i64) -> Option<usize> {
        let inside = self.columns.contains(&column) && self.rows.contains(&row);
        let width = self.columns.end - self.columns.start;
        inside.then(|| ((row - self.rows.start) * width + column - self.columns.start) as usize)
    }

    /// The nearest triangle at a sample; [`NOTHING`] also outside of the block.
    pub(super) fn triangle(&self, column: i64, row: i64) -> u32 {
        self.index(column, row)
            .map_or(NOTHING, |at| self.triangles[at])
    }

    /// Depth of the nearest triangle at a sample; −∞ without any.
    pub(super) fn depth(&self, column: i64, row: i64) -> f32 {
        self.index(column, row)
            .map_or(f32::NEG_INFINITY, |at| self.depths[at])
    }
}
