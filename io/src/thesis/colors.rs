//! Colours of materials: `tabcor.dat`, lines of an index and red, green and blue (thesis A.4.4).

use super::Error;
use super::text::{end, words};

/// A colour for each material; that of index 0 is the background's.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Colors {
    entries: [[u8; 3]; 256],
}

impl Default for Colors {
    /// Without a file: a black background, material 1 white, and hues that tell the others apart.
    fn default() -> Self {
        let mut entries = [[255; 3]; 256];
        entries[0] = [0; 3];
        for (material, entry) in entries.iter_mut().enumerate().skip(2) {
            *entry = hue(material as f64 * GOLDEN_TURN);
        }
        Self { entries }
    }
}

/// Multiples of this part of a turn stay apart.
const GOLDEN_TURN: f64 = 0.618_034;

/// A light colour of this hue, in turns.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 75 and 255"
)]
fn hue(turns: f64) -> [u8; 3] {
    [0.0, 1.0, 2.0].map(|channel| {
        let angle = std::f64::consts::TAU * (turns + channel / 3.0);
        (165.0 + 90.0 * angle.cos()) as u8
    })
}

impl Colors {
    /// The background's colour.
    #[must_use]
    pub fn background(&self) -> [u8; 3] {
        self.entries[0]
    }

    /// A material's colour; materials beyond the table have that of its last entry.
    #[must_use]
    pub fn of(&self, material: i32) -> [u8; 3] {
        self.entries[place(material)]
    }
}

/// Indices beyond the table mean its last entry, as in the thesis, whose table had 128.
fn place(index: i32) -> usize {
    usize::try_from(index).map_or(255, |at| at.min(255))
}

/// Reads a table; entries that it does not define are white, the background, too.
///
/// # Errors
/// What is missing or no number, with its place.
pub fn read(text: &str) -> Result<Colors, Error> {
    let mut entries = [[255; 3]; 256];
    let mut found = words(text);
    while let Some(word) = found.next() {
        let entry = &mut entries[place(word.parse("an index of a colour")?)];
        for channel in entry {
            let word = found.next().unwrap_or(end(text));
            *channel = word.parse("red, green or blue from 0 to 255")?;
        }
    }
    Ok(Colors { entries })
}

/// The file's text: all entries that are not white.
#[must_use]
pub fn write(colors: &Colors) -> String {
    let mut text = String::new();
    for (at, [r, g, b]) in colors.entries.iter().enumerate() {
        if [*r, *g, *b] != [255; 3] {
            text = format!("{text}{at} {r} {g} {b}\n");
        }
    }
    text
}
