//! What `color` paints with.

use super::arguments::Arguments;
use super::complaints::{Complaints, Reported};
use csg::Material;

/// The material of a `color` node, `None` if it leaves the colour open.
pub(super) fn read(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<Material>, Reported> {
    let mut color = if arguments.is_string("c") {
        let Some(given) = arguments.string("c", complaints)? else {
            return Ok(None);
        };
        let Ok(color) = csscolorparser::parse(given.value) else {
            let message = format!("unknown colour `{}`; it is ignored", given.value);
            let remedy = "write [red, green, blue] with numbers from 0 to 1".to_owned();
            complaints.warn(given.at, message, remedy);
            return Ok(None);
        };
        color.to_array()
    } else {
        let Some(given) = arguments.numbers("c", 3, 4, complaints)? else {
            return Ok(None);
        };
        let mut color = [0.0, 0.0, 0.0, 1.0];
        for (part, given) in color.iter_mut().zip(&given.value) {
            // Single precision is what colours are kept in; out-of-range parts are clamped below.
            #[expect(clippy::cast_possible_truncation, reason = "eight bits would do")]
            let value = *given as f32;
            *part = value;
        }
        // OpenSCAD writes [-1, -1, -1, 1] for a colour that it was not told.
        if color[..3].iter().any(|part| *part < 0.0) {
            return Ok(None);
        }
        color
    };
    if let Some(alpha) = arguments.number("alpha", complaints)? {
        #[expect(clippy::cast_possible_truncation, reason = "eight bits would do")]
        let value = alpha.value as f32;
        color[3] = value;
    }
    let known = color.map(|part| {
        if part.is_nan() {
            1.0
        } else {
            part.clamp(0.0, 1.0)
        }
    });
    Ok(Some(Material { color: Some(known) }))
}
