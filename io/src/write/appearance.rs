//! How materials look.

use csg::{Material, MaterialId};

/// What parts without a colour get: a light, slightly warm grey (sRGB).
pub(super) const DEFAULT_COLOR: [f32; 4] = [0.80, 0.80, 0.78, 1.0];

/// Colour of a material as sRGB with alpha, each in [0, 1].
pub(super) fn color(materials: &[Material], id: MaterialId) -> [f32; 4] {
    let material = materials.get(id.0 as usize);
    let color = material
        .and_then(|material| material.color)
        .unwrap_or(DEFAULT_COLOR);
    color.map(|channel| {
        if channel.is_nan() {
            0.0
        } else {
            channel.clamp(0.0, 1.0)
        }
    })
}

/// Colour of a material as sRGB with alpha, in bytes.
pub(super) fn bytes(materials: &[Material], id: MaterialId) -> [u8; 4] {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "channels are in [0, 1]"
    )]
    color(materials, id).map(|channel| (channel * 255.0).round() as u8)
}

/// From sRGB to linear light. Source: IEC 61966-2-1.
pub(super) fn linear(channel: f32) -> f32 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        ((channel + 0.055) / 1.055).powf(2.4)
    }
}

/// From linear light to sRGB.
pub(super) fn srgb(channel: f32) -> f32 {
    if channel <= 0.003_130_8 {
        channel * 12.92
    } else {
        1.055 * channel.powf(1.0 / 2.4) - 0.055
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_inverts_linear() {
        for step in 0..=255_u8 {
            let channel = f32::from(step) / 255.0;
            assert!((srgb(linear(channel)) - channel).abs() < 1e-5);
        }
    }

    #[test]
    fn unknown_materials_look_like_uncoloured_ones() {
        let materials = [Material { color: None }];
        let bits = |color: [f32; 4]| color.map(f32::to_bits);
        for id in [0, 7] {
            assert_eq!(bits(color(&materials, MaterialId(id))), bits(DEFAULT_COLOR));
        }
    }

    #[test]
    fn colours_are_brought_into_range() {
        let materials = [Material {
            color: Some([-1.0, 2.0, f32::NAN, 0.5]),
        }];
        let bits = |color: [f32; 4]| color.map(f32::to_bits);
        assert_eq!(
            bits(color(&materials, MaterialId(0))),
            bits([0.0, 1.0, 0.0, 0.5])
        );
    }
}
