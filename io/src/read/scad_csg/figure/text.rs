//! `text(text, size, font, …)`: outlines of letters, as OpenSCAD 2021.01 places them.
//!
//! Letters are shaped as HarfBuzz does it, with kerning and ligatures. Curves become chords, as
//! many as OpenSCAD takes.

use super::super::arguments::Arguments;
use super::super::complaints::{Complaints, Reported};
use super::Region;
use crate::read::Files;
use glam::DVec2;
use rustybuzz::ttf_parser::{GlyphId, OutlineBuilder};
use rustybuzz::{Direction, Face, UnicodeBuffer};

/// Characters of one text, at most.
const MAX_CHARACTERS: usize = 10_000;

/// A letter's height over `size`: sizes are points at 100 dots an inch.
const EM: f64 = 100.0 / 72.0;

/// OpenSCAD measures outlines in thousandths, advances and heights in 1024ths.
const ADVANCE: f64 = 1000.0 / 1024.0;

/// How a text is laid out.
struct Layout<'a> {
    size: f64,
    spacing: f64,
    /// Chords that stand for each curve.
    chords: u32,
    halign: &'a str,
    valign: &'a str,
    direction: Option<Direction>,
}

/// Reads a text; nothing if it shows nothing.
pub(in super::super) fn text(
    arguments: &Arguments<'_>,
    files: &dyn Files,
    complaints: &mut Complaints<'_>,
) -> Result<Vec<Region>, Reported> {
    let Some(given) = arguments.string("text", complaints)? else {
        return Ok(Vec::new());
    };
    let text = plain(given.value);
    if text.chars().count() > MAX_CHARACTERS {
        let message = format!("a text of more than {MAX_CHARACTERS} characters is too long");
        let remedy = "split it into several".to_owned();
        return Err(complaints.error(given.at, message, remedy));
    }
    let layout = layout(arguments, complaints)?;
    if text.trim().is_empty() || layout.size <= 0.0 {
        return Ok(Vec::new());
    }
    let wanted = arguments.string("font", complaints)?;
    let wanted = wanted.map_or(String::new(), |f| plain(f.value));
    let font = files.font(&wanted).map_err(|refusal| {
        let message = format!("`text` needs a font: {}", refusal.message);
        complaints.error_once(
            &refusal.message,
            arguments.name,
            message,
            Some(refusal.remedy),
        );
        Reported
    })?;
    if font.is_substitute {
        let message = format!(
            "the font \"{}\" is not on this machine; {} is taken, which looks different",
            shown(&wanted),
            font.name
        );
        let remedy = "install it, or let OpenSCAD make a mesh of the extruded text, as in \
                      openscad -o text.off text.scad, and write import(\"text.off\") in its place";
        complaints.warn_once(
            &message,
            arguments.name,
            message.clone(),
            Some(remedy.to_owned()),
        );
    }
    let Some(face) = Face::from_slice(&font.bytes, font.index) else {
        let message = format!("the font {} cannot be read", font.name);
        let remedy = "install another one, or name another in `font`".to_owned();
        return Err(complaints.error(arguments.name, message, remedy));
    };
    let (letters, missing) = letters(&face, &text, &layout);
    if missing > 0 {
        let message = format!(
            "{} has no letters for {missing} of the characters",
            font.name
        );
        complaints.warn(given.at, message, "name a font that has".to_owned());
    }
    Ok(letters)
}

fn layout<'a>(
    arguments: &Arguments<'a>,
    complaints: &mut Complaints<'_>,
) -> Result<Layout<'a>, Reported> {
    let mut number = |name: &str, usual: f64| -> Result<f64, Reported> {
        let given = arguments.number(name, complaints)?;
        let value = given.as_ref().map_or(usual, |g| g.value);
        if value.is_finite() && value.abs() <= super::read::MAX_SIZE {
            return Ok(value);
        }
        let at = given.map_or(arguments.name, |g| g.at);
        Err(complaints.error(at, format!("a text with `{name}` {value} is none"), None))
    };
    let (size, spacing) = (number("size", 10.0)?, number("spacing", 1.0)?);
    let mut word = |name: &str, usual: &'a str| -> Result<&'a str, Reported> {
        let given = arguments.string(name, complaints)?;
        Ok(given.map_or(usual, |g| g.value))
    };
    let (halign, valign) = (word("halign", "left")?, word("valign", "baseline")?);
    let direction = word("direction", "")?.parse().ok();
    Ok(Layout {
        size,
        spacing,
        chords: chords(size, arguments.fragments()),
        halign,
        valign,
        direction,
    })
}

/// OpenSCAD's number of chords for each curve of a letter, at its usual `$fa` and `$fs` unless
/// `$fn` is given.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "between 2 and 100"
)]
fn chords(size: f64, fragments: f64) -> u32 {
    let around = if fragments > 0.0 {
        fragments.max(3.0).floor()
    } else {
        (size * std::f64::consts::PI).clamp(5.0, 30.0).ceil()
    };
    ((around / 8.0).floor() + 1.0).clamp(2.0, 100.0) as u32
}

/// The letters' regions, and the number of characters that the font lacks.
fn letters(face: &Face<'_>, text: &str, layout: &Layout<'_>) -> (Vec<Region>, usize) {
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(text);
    if let Some(direction) = layout.direction {
        buffer.set_direction(direction);
    }
    buffer.guess_segment_properties();
    let shaped = rustybuzz::shape(face, &[], buffer);
    let unit = layout.size * EM / f64::from(face.units_per_em());
    let (mut pen, mut ascent, mut descent) = (DVec2::ZERO, 0.0_f64, 0.0_f64);
    let (mut outlines, mut missing) = (Vec::new(), 0);
    for (info, position) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
        missing += usize::from(info.glyph_id == 0);
        let offset = DVec2::new(position.x_offset.into(), position.y_offset.into());
        let at = pen + offset * unit * ADVANCE;
        let Ok(glyph) = u16::try_from(info.glyph_id) else {
            continue;
        };
        let mut outline = Outline {
            loops: Vec::new(),
            chords: layout.chords,
        };
        if let Some(bounds) = face.outline_glyph(GlyphId(glyph), &mut outline) {
            ascent = ascent.max(f64::from(bounds.y_max) * unit * ADVANCE);
            descent = descent.max(-f64::from(bounds.y_min) * unit * ADVANCE);
        }
        outlines.push((at, outline.loops));
        let step = DVec2::new(position.x_advance.into(), position.y_advance.into());
        pen += step * unit * ADVANCE * layout.spacing;
    }
    let width = pen.x;
    let x = match layout.halign {
        "right" => -width,
        "center" => -0.5 * width,
        _ => 0.0,
    };
    let y = match layout.valign {
        "top" => -ascent,
        "center" => 0.5 * (descent - ascent),
        "bottom" => descent,
        _ => 0.0,
    };
    let regions = outlines.into_iter().filter_map(|(at, loops)| {
        let placed = |p: DVec2| p * unit + at + DVec2::new(x, y);
        let loops: Vec<Vec<DVec2>> = (loops.into_iter())
            .map(|one| one.into_iter().map(placed).collect())
            .collect();
        Region::polygon(&loops)
    });
    (regions.collect(), missing)
}

/// A letter's loops in the font's units.
struct Outline {
    loops: Vec<Vec<DVec2>>,
    chords: u32,
}

impl Outline {
    fn last(&self) -> DVec2 {
        let loop_ = self.loops.last();
        loop_.and_then(|l| l.last()).copied().unwrap_or_default()
    }

    fn curve(&mut self, at: impl Fn(f64) -> DVec2) {
        let points = (1..=self.chords).map(|i| at(f64::from(i) / f64::from(self.chords)));
        let points: Vec<DVec2> = points.collect();
        if let Some(loop_) = self.loops.last_mut() {
            loop_.extend(points);
        }
    }
}

fn point(x: f32, y: f32) -> DVec2 {
    DVec2::new(x.into(), y.into())
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.loops.push(vec![point(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        if let Some(loop_) = self.loops.last_mut() {
            loop_.push(point(x, y));
        }
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let (a, b, c) = (self.last(), point(x1, y1), point(x, y));
        self.curve(|t| a.lerp(b, t).lerp(b.lerp(c, t), t));
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let (a, b, c, d) = (self.last(), point(x1, y1), point(x2, y2), point(x, y));
        self.curve(|t| {
            let (p, q, r) = (a.lerp(b, t), b.lerp(c, t), c.lerp(d, t));
            p.lerp(q, t).lerp(q.lerp(r, t), t)
        });
    }

    fn close(&mut self) {
        if let Some(loop_) = self.loops.last_mut()
            && loop_.first() == loop_.last()
        {
            loop_.pop();
        }
    }
}

/// A text for a message.
fn shown(text: &str) -> String {
    text.chars()
        .take(80)
        .map(|c| if c.is_control() { '\u{fffd}' } else { c })
        .collect()
}

/// What a string literal says. OpenSCAD 2021 writes all characters as they are.
fn plain(literal: &str) -> String {
    literal.replace("\\\"", "\"")
}
