//! Edges of the B-Rep and outlines, found between neighbouring samples.
//!
//! A line runs where two neighbouring samples show different faces, or the same face at depths
//! that its facets' planes do not explain. What is hidden is not in the samples, so lines are as
//! correct as the hidden surfaces are.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "offsets within a block of samples"
)]

use super::raster::{Block, NOTHING, Prepared};
use super::scene::Scene;
use std::ops::Range;

/// Depth step between neighbouring samples that makes an outline, in radii of the scene.
const STEP: f32 = 0.012;

/// Darkness of an edge between faces that meet smoothly, or at an angle.
const SMOOTH: u8 = 70;
const SHARP: u8 = 215;

/// How strongly lines cover the samples of some rows, 0 to 255; row by row.
pub(super) fn trace(
    scene: &Scene,
    prepared: &[Option<Prepared>],
    block: &Block,
    rows: &Range<i64>,
    radius: f32,
) -> Vec<u8> {
    let width = block.columns.end - block.columns.start;
    let mut darkness = vec![0_u8; (width * (rows.end - rows.start)) as usize];
    if radius <= 0.0 {
        return darkness;
    }
    let reach = radius.ceil() as i64;
    let disc: Vec<(i64, i64)> = (-reach..=reach)
        .flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)))
        .filter(|&(dx, dy)| (dx * dx + dy * dy) as f32 <= radius * radius)
        .collect();
    for row in block.rows.clone() {
        for column in block.columns.clone() {
            for (other_column, other_row) in [(column + 1, row), (column, row + 1)] {
                if other_column >= block.columns.end || other_row >= block.rows.end {
                    continue;
                }
                let strength = boundary(
                    scene,
                    prepared,
                    block,
                    [column, row],
                    [other_column, other_row],
                );
                if strength == 0 {
                    continue;
                }
                // The nearer of the two owns the line.
                let near = block.depth(column, row) >= block.depth(other_column, other_row);
                let (x, y) = if near {
                    (column, row)
                } else {
                    (other_column, other_row)
                };
                for (dx, dy) in &disc {
                    let (x, y) = (x + dx - block.columns.start, y + dy);
                    if (0..width).contains(&x) && rows.contains(&y) {
                        let at = ((y - rows.start) * width + x) as usize;
                        darkness[at] = darkness[at].max(strength);
                    }
                }
            }
        }
    }
    darkness
}

fn boundary(
    scene: &Scene,
    prepared: &[Option<Prepared>],
    block: &Block,
    [column, row]: [i64; 2],
    [other_column, other_row]: [i64; 2],
) -> u8 {
    let first = block.triangle(column, row);
    let second = block.triangle(other_column, other_row);
    if first == second {
        return 0;
    }
    if first == NOTHING || second == NOTHING {
        return SHARP;
    }
    let step = {
        let depths = [
            block.depth(column, row),
            block.depth(other_column, other_row),
        ];
        let predicted = |triangle: u32, column: i64, row: i64| {
            let prepared = prepared[triangle as usize].as_ref();
            prepared.map_or(f32::NAN, |p| p.plane_depth(column as f32, row as f32))
        };
        let errors = [
            (predicted(first, other_column, other_row) - depths[1]).abs(),
            (predicted(second, column, row) - depths[0]).abs(),
        ];
        errors[0].min(errors[1]) > STEP
    };
    if step {
        return SHARP;
    }
    let [a, b] = [first, second].map(|triangle| scene.triangles[triangle as usize]);
    if a.face == b.face {
        return 0;
    }
    // 12 degrees, as far as facets tell.
    if a.normal.dot(b.normal) > 0.978 {
        SMOOTH
    } else {
        SHARP
    }
}
