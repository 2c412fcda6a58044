//! Values on the command line: each has one spelling, one range and one complaint.

use glam::DVec3;
use std::num::NonZeroU32;
use std::str::FromStr;

/// How far the result may be from the true boundary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Tolerance {
    /// A length in model units, above 0.
    Length(f64),
    /// A fraction of the diagonal of the model's bounding box, above 0.
    OfDiagonal(f64),
}

impl Default for Tolerance {
    fn default() -> Self {
        Self::OfDiagonal(1e-3)
    }
}

impl Tolerance {
    /// In model units, for a model whose bounding box has this diagonal.
    pub(crate) fn length(self, diagonal: f64) -> f64 {
        match self {
            Self::Length(length) => length,
            Self::OfDiagonal(fraction) => fraction * diagonal,
        }
    }
}

impl FromStr for Tolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, is_percent) = match text.strip_suffix('%') {
            Some(number) => (number, true),
            None => (text, false),
        };
        let wrong = "expected a length such as 0.01, or a percentage such as 0.1%";
        let value: f64 = number.trim().parse().map_err(|_| wrong.to_owned())?;
        if !(value > 0.0 && value.is_finite()) {
            return Err("it must be above 0".to_owned());
        }
        Ok(if is_percent {
            Self::OfDiagonal(value / 100.0)
        } else {
            Self::Length(value)
        })
    }
}

/// An amount of memory in bytes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Bytes(pub(crate) u64);

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "expected an amount such as 4G or 500M".to_owned();
        let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
        let unit = text.get(digits.len()..).unwrap_or_default();
        let exponent = match unit.to_ascii_uppercase().as_str() {
            "" | "B" => 0,
            "K" | "KB" | "KIB" => 1,
            "M" | "MB" | "MIB" => 2,
            "G" | "GB" | "GIB" => 3,
            "T" | "TB" | "TIB" => 4,
            _ => return Err(wrong()),
        };
        let number: f64 = digits.trim().parse().map_err(|_| wrong())?;
        let bytes = number * 1024_f64.powi(exponent);
        if !(1.0..1e18).contains(&bytes) {
            return Err(wrong());
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked just before"
        )]
        Ok(Self(bytes as u64))
    }
}

/// The size of a picture in pixels.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct PictureSize {
    pub(crate) width: NonZeroU32,
    pub(crate) height: NonZeroU32,
}

/// Larger pictures are not drawn.
const MAX_PIXELS: u64 = io::write::picture::Options::MAX_PIXELS;

impl FromStr for PictureSize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || "expected width and height such as 1200x900".to_owned();
        let (width, height) = text.split_once(['x', 'X']).ok_or_else(wrong)?;
        let pixels = |text: &str| text.parse::<NonZeroU32>().map_err(|_| wrong());
        let (width, height) = (pixels(width)?, pixels(height)?);
        if u64::from(width.get()) * u64::from(height.get()) > MAX_PIXELS {
            return Err(format!("at most {MAX_PIXELS} pixels are possible"));
        }
        Ok(Self { width, height })
    }
}

/// Where the viewer of a picture stands: a direction from the model, not zero.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Viewpoint(pub(crate) DVec3);

impl FromStr for Viewpoint {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let named = match text {
            "iso" => Some(DVec3::new(1.0, -1.0, 1.0)),
            "front" => Some(DVec3::NEG_Y),
            "back" => Some(DVec3::Y),
            "left" => Some(DVec3::NEG_X),
            "right" => Some(DVec3::X),
            "top" => Some(DVec3::Z),
            "bottom" => Some(DVec3::NEG_Z),
            _ => None,
        };
        if let Some(direction) = named {
            return Ok(Self(direction));
        }
        let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
        let direction = numbers
            .ok()
            .and_then(|list| <[f64; 3]>::try_from(list).ok());
        let direction = direction.and_then(|list| DVec3::from(list).try_normalize());
        direction.map(Self).ok_or_else(|| {
            "expected iso, front, back, left, right, top, bottom, or a direction such as 1,-2,0.5"
                .to_owned()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tolerances_are_lengths_or_percentages() {
        assert_eq!("0.01".parse(), Ok(Tolerance::Length(0.01)));
        assert_eq!("0.1%".parse(), Ok(Tolerance::OfDiagonal(0.001)));
        for wrong in ["", "0", "-1", "nan", "inf", "1e999", "%", "1 mm", "0%"] {
            assert!(wrong.parse::<Tolerance>().is_err(), "{wrong}");
        }
        assert!((Tolerance::default().length(200.0) - 0.2).abs() < 1e-15);
    }

    #[test]
    fn amounts_of_memory_have_binary_units() {
        assert_eq!("4G".parse(), Ok(Bytes(4 << 30)));
        assert_eq!("1.5k".parse(), Ok(Bytes(1536)));
        assert_eq!("100MiB".parse(), Ok(Bytes(100 << 20)));
        assert_eq!("17".parse(), Ok(Bytes(17)));
        for wrong in ["", "G", "0", "-4G", "4X", "1e30", "nan"] {
            assert!(wrong.parse::<Bytes>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn viewpoints_are_sides_or_directions() {
        assert_eq!("top".parse(), Ok(Viewpoint(DVec3::Z)));
        assert_eq!("0,-3,0".parse(), Ok(Viewpoint(DVec3::NEG_Y)));
        for wrong in ["", "up", "0,0,0", "1,2", "1,2,3,4", "nan,0,1", "1,,2"] {
            assert!(wrong.parse::<Viewpoint>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn picture_sizes_are_positive_and_bounded() {
        let size: PictureSize = "1200x900".parse().unwrap();
        assert_eq!((size.width.get(), size.height.get()), (1200, 900));
        for wrong in ["", "1200", "0x10", "10x", "1e3x5", "99999x99999"] {
            assert!(wrong.parse::<PictureSize>().is_err(), "{wrong}");
        }
    }
}
