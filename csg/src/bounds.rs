//! Bounding boxes of images of shapes, from their support functions.

mod planes;
mod quadric;

pub(crate) use planes::of_half_spaces;
pub(crate) use quadric::{quadric_support, symmetric_eigen};

use crate::Aabb;
use crate::matrix::{IDENTITY, Rows};
use crate::transform::{apply_rows, is_affine};
use glam::DVec3;

/// The support function of a set: h(d) = sup d · x over its points, possibly infinite.
pub(crate) struct Support<'a> {
    value: Box<dyn Fn(DVec3) -> f64 + 'a>,
    empty: bool,
}

/// Sine of the largest angle between directions that count as parallel. The tilt moves a plane
/// by less than rounding does.
const PARALLEL: f64 = 1e-14;

impl<'a> Support<'a> {
    /// A bounded set.
    pub(crate) fn finite(value: impl Fn(DVec3) -> f64 + 'a) -> Self {
        Self {
            value: Box::new(value),
            empty: false,
        }
    }

    /// All of space.
    pub(crate) fn everywhere() -> Self {
        Self::finite(|_| f64::INFINITY)
    }

    /// The empty set.
    pub(crate) fn empty() -> Self {
        Self {
            value: Box::new(|_| f64::NEG_INFINITY),
            empty: true,
        }
    }

    /// `normal · x ≤ offset`.
    pub(crate) fn half_space(normal: DVec3, offset: f64) -> Self {
        Self::finite(move |d| {
            let along = d.dot(normal);
            let across = d.cross(normal).length();
            if along > 0.0 && across <= PARALLEL * along {
                along / normal.length_squared() * offset
            } else {
                f64::INFINITY
            }
        })
    }
}

/// Bounding box of the image of a set under a map for row vectors.
pub(crate) fn of_image(support: &Support<'_>, rows: &Rows) -> Aabb {
    if support.empty {
        return Aabb::EMPTY;
    }
    if is_affine(rows) {
        let mut image = Aabb::EVERYWHERE;
        for axis in 0..3 {
            let w = rows[3][3];
            let direction = DVec3::new(rows[0][axis], rows[1][axis], rows[2][axis]);
            image.min[axis] = (rows[3][axis] - (support.value)(-direction)) / w;
            image.max[axis] = (rows[3][axis] + (support.value)(direction)) / w;
        }
        return image;
    }
    of_box_image(&of_image(support, &IDENTITY), rows)
}

/// Bounding box of the image of a box under any map.
///
/// A map without points at infinity in the box preserves convexity, so the corners suffice.
pub(crate) fn of_box_image(set: &Aabb, rows: &Rows) -> Aabb {
    if set.is_empty() {
        return Aabb::EMPTY;
    }
    if !set.is_finite() {
        return Aabb::EVERYWHERE;
    }
    let corner = |at: usize| {
        let pick = |axis: usize| if at >> axis & 1 == 1 { set.max } else { set.min }[axis];
        apply_rows(rows, DVec3::new(pick(0), pick(1), pick(2)))
    };
    let corners: [[f64; 4]; 8] = std::array::from_fn(corner);
    let positive = corners[0][3] > 0.0;
    let mut image = Aabb::EMPTY;
    for [x, y, z, w] in corners {
        let at = DVec3::new(x, y, z) / w;
        if w == 0.0 || (w > 0.0) != positive || !at.is_finite() {
            return Aabb::EVERYWHERE;
        }
        image.min = image.min.min(at);
        image.max = image.max.max(at);
    }
    image
}
