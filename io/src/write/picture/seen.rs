//! What is seen at each sample of a block: the mesh here, the true solid in [`super::truth`].

use super::camera::Camera;
use super::raster::{Block, Prepared};
use super::scene::Scene;
use glam::{Vec2, Vec3};
use std::ops::Range;

/// A surface as lines see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Patch {
    /// The face that it belongs to.
    pub face: u32,
    /// Unit normal of the plane in which it lies around the sample.
    pub normal: Vec3,
}

/// What light falls on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface {
    /// The place.
    pub point: Vec3,
    /// Unit normal, smooth.
    pub normal: Vec3,
    /// Diffuse colour, linear light.
    pub color: Vec3,
}

/// A block of samples.
pub(super) trait Seen {
    /// Its columns and rows.
    fn extent(&self) -> [&Range<i64>; 2];
    /// Number of the piece at a sample, without lines inside; [`NOTHING`] for none.
    fn piece(&self, at: [i64; 2]) -> u32;
    /// Depth at a sample; −∞ for nothing.
    fn depth(&self, at: [i64; 2]) -> f32;
    /// Depth of the plane that a sample shows, at another one; not a number for nothing.
    fn predicted(&self, from: [i64; 2], at: [i64; 2]) -> f32;
    /// What lines need to know.
    fn patch(&self, at: [i64; 2]) -> Option<Patch>;
    /// What light needs to know.
    fn surface(&self, at: [i64; 2]) -> Option<Surface>;
}

/// The mesh's facets.
pub(super) struct Mesh<'a> {
    pub scene: &'a Scene,
    pub camera: &'a Camera,
    pub prepared: &'a [Option<Prepared>],
    pub block: Block,
}

impl<'a> Mesh<'a> {
    /// Draws the facets that touch a block.
    pub(super) fn draw(
        scene: &'a Scene,
        camera: &'a Camera,
        prepared: &'a [Option<Prepared>],
        columns: Range<i64>,
        rows: Range<i64>,
    ) -> Self {
        let mut block = Block::new(columns, rows);
        for (number, prepared) in (0..).zip(prepared) {
            let Some(prepared) = prepared else { continue };
            let touched = prepared.rows();
            if touched.start < block.rows.end && touched.end > block.rows.start {
                block.draw(number, prepared);
            }
        }
        Self {
            scene,
            camera,
            prepared,
            block,
        }
    }

    fn facet(&self, [column, row]: [i64; 2]) -> Option<(usize, &Prepared)> {
        let number = self.block.triangle(column, row) as usize;
        let prepared = self.prepared.get(number)?.as_ref()?;
        Some((number, prepared))
    }
}

impl Seen for Mesh<'_> {
    fn extent(&self) -> [&Range<i64>; 2] {
        [&self.block.columns, &self.block.rows]
    }

    fn piece(&self, [column, row]: [i64; 2]) -> u32 {
        self.block.triangle(column, row)
    }

    fn depth(&self, [column, row]: [i64; 2]) -> f32 {
        self.block.depth(column, row)
    }

    fn predicted(&self, from: [i64; 2], [column, row]: [i64; 2]) -> f32 {
        let facet = self.facet(from);
        facet.map_or(f32::NAN, |(_, p)| p.plane_depth(column as f32, row as f32))
    }

    fn patch(&self, at: [i64; 2]) -> Option<Patch> {
        let (number, _) = self.facet(at)?;
        let triangle = &self.scene.triangles[number];
        Some(Patch {
            face: triangle.face,
            normal: triangle.normal,
        })
    }

    fn surface(&self, at: [i64; 2]) -> Option<Surface> {
        let (number, prepared) = self.facet(at)?;
        let triangle = &self.scene.triangles[number];
        let [a, b, c] = triangle
            .corners
            .map(|corner| self.scene.normals[corner as usize]);
        let weights = prepared.barycentric(at[0], at[1]);
        let normal = a * weights.x + b * weights.y + c * weights.z;
        Some(Surface {
            point: self.camera.unproject(centre(at), self.depth(at)),
            normal: normal.try_normalize().unwrap_or(triangle.normal),
            color: triangle.color,
        })
    }
}

/// The middle of a sample on the grid.
pub(super) fn centre([column, row]: [i64; 2]) -> Vec2 {
    Vec2::new(column as f32 + 0.5, row as f32 + 0.5)
}
