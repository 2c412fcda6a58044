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

use super::raster::NOTHING;
use super::seen::Seen;
use std::ops::Range;

/// Depth step between neighbouring samples that makes an outline, in radii of the scene.
const STEP: f32 = 0.012;

/// Darkness of an edge between faces that meet smoothly, or at an angle.
const SMOOTH: u8 = 70;
const SHARP: u8 = 215;

/// How strongly lines cover the samples of some rows, 0 to 255; row by row.
pub(super) fn trace(seen: &impl Seen, rows: &Range<i64>, radius: f32) -> Vec<u8> {
    let [columns, all_rows] = seen.extent();
    let width = columns.end - columns.start;
    let mut darkness = vec![0_u8; (width * (rows.end - rows.start)) as usize];
    if radius <= 0.0 {
        return darkness;
    }
    let reach = radius.ceil() as i64;
    let disc: Vec<(i64, i64)> = (-reach..=reach)
        .flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)))
        .filter(|&(dx, dy)| (dx * dx + dy * dy) as f32 <= radius * radius)
        .collect();
    for row in all_rows.clone() {
        for column in columns.clone() {
            for (other_column, other_row) in [(column + 1, row), (column, row + 1)] {
                if other_column >= columns.end || other_row >= all_rows.end {
                    continue;
                }
                let strength = boundary(seen, [column, row], [other_column, other_row]);
                if strength == 0 {
                    continue;
                }
                // The nearer of the two owns the line.
                let near = seen.depth([column, row]) >= seen.depth([other_column, other_row]);
                let (x, y) = if near {
                    (column, row)
                } else {
                    (other_column, other_row)
                };
                for (dx, dy) in &disc {
                    let (x, y) = (x + dx - columns.start, y + dy);
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

fn boundary(seen: &impl Seen, first: [i64; 2], second: [i64; 2]) -> u8 {
    let pieces = [seen.piece(first), seen.piece(second)];
    if pieces[0] == pieces[1] {
        return 0;
    }
    if pieces.contains(&NOTHING) {
        return SHARP;
    }
    let errors = [
        (seen.predicted(first, second) - seen.depth(second)).abs(),
        (seen.predicted(second, first) - seen.depth(first)).abs(),
    ];
    let step = errors[0].min(errors[1]) > STEP;
    if step {
        return SHARP;
    }
    let (Some(a), Some(b)) = (seen.patch(first), seen.patch(second)) else {
        return SHARP;
    };
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
