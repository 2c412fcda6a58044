//! The closing line: what came out, in words and round numbers.

use crate::report::{Report, StepReport};
use glam::DVec3;

/// `part.csg -> part.glb: 12,340 triangles, 1 solid, genus 5, volume 18729.7, watertight, …`.
pub(crate) fn summary(report: &Report, outputs: &[String]) -> String {
    let name = &report.input.name;
    let arrow = if outputs.is_empty() {
        name.clone()
    } else {
        format!("{name} -> {}", outputs.join(", "))
    };
    format!("{arrow}: {}", facts(report).join(", "))
}

fn facts(report: &Report) -> Vec<String> {
    let seconds = format!("{:.2} s", report.total_seconds);
    let counts = &report.counts;
    if counts.facets == 0 {
        return vec!["the solid is empty".to_owned(), seconds];
    }
    // Without a mesh to write there was but a coarse one, of which nobody wants to know.
    let step_only = report.step.as_ref().filter(|step| step.is_alone);
    let mut facts = match step_only {
        Some(step) => vec![counted(step.solids, "solid")],
        None => vec![
            counted(counts.facets, "triangle"),
            counted(counts.solids, "solid"),
        ],
    };
    let voids = counts.shells.saturating_sub(counts.solids);
    if voids > 0 {
        facts.push(match voids {
            1 => "1 cavity".to_owned(),
            more => format!("{} cavities", grouped(more)),
        });
    }
    if let Some(genus) = report.genus {
        facts.push(format!("genus {}", grouped(genus)));
    }
    if step_only.is_none() {
        facts.extend(
            report
                .volume
                .map(|volume| format!("volume {}", significant(volume, 6))),
        );
        facts.push("watertight".to_owned());
    }
    facts.extend(report.step.iter().flat_map(true_surfaces));
    facts.extend(report.deviation());
    if report.proved_topology {
        facts.push("topology proved".to_owned());
    }
    let quality = report.quality.filter(|_| step_only.is_none());
    if let Some(quality) = quality.filter(|quality| quality.slivers > 0) {
        facts.push(counted(quality.slivers, "sliver"));
    }
    if report.uncertified_count > 0 {
        facts.push(format!(
            "{} not certified",
            counted(report.uncertified_count, "cell")
        ));
    }
    if report.clipped {
        facts.push("clipped to the box".to_owned());
    }
    facts.push(seconds);
    facts
}

/// What is in a STEP file.
fn true_surfaces(step: &StepReport) -> Vec<String> {
    let mut facts = Vec::new();
    if step.faces > 0 {
        facts.push(format!("{} on true surfaces", counted(step.faces, "face")));
    }
    if step.spline_edges > 0 {
        facts.push(format!(
            "{} within {}",
            counted(step.spline_edges, "spline edge"),
            rounded_up(step.accuracy)
        ));
    }
    let crumbs = step.crumb_edges + step.crumb_faces + step.slivers;
    if crumbs > 0 {
        facts.push(format!("{} merged", counted(crumbs, "crumb")));
    }
    if !step.faceted.is_empty() {
        let count = counted(step.faceted.len() as u64, "solid");
        facts.push(format!("{count} in plane facets"));
    }
    facts
}

/// A number of things: `1 solid`, `12,340 triangles`.
pub(crate) fn counted(count: u64, thing: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{} {thing}{plural}", grouped(count))
}

/// With commas between groups of three digits.
pub(crate) fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut out = String::with_capacity(digits.len() * 4 / 3);
    for (at, digit) in digits.chars().enumerate() {
        if at > 0 && (digits.len() - at).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// With this many significant digits, without trailing zeros: `18729.7`, `1e-9`.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    let scientific = format!("{value:.*e}", digits.saturating_sub(1));
    let rounded: f64 = scientific.parse().unwrap_or(value);
    if rounded == 0.0 || (1e-4..1e9).contains(&rounded.abs()) {
        format!("{rounded}")
    } else {
        format!("{rounded:e}")
    }
}

/// With nine digits, and zero for what rounding made of it beside numbers as large as `scale`.
pub(crate) fn number(value: f64, scale: f64) -> String {
    const NOISE: f64 = 1e-12;
    let is_noise = value.abs() < NOISE * scale;
    significant(if is_noise { 0.0 } else { value }, 9)
}

/// Three such numbers: `(0, 0.5, -1)`.
pub(crate) fn triple(vector: DVec3, scale: f64) -> String {
    let [x, y, z] = vector.to_array().map(|value| number(value, scale));
    format!("({x}, {y}, {z})")
}

/// A bound with two digits must not become smaller by rounding.
pub(crate) fn rounded_up(bound: f64) -> String {
    if bound <= 0.0 {
        return significant(bound, 2);
    }
    let unit = 10_f64.powf(bound.log10().floor() - 1.0);
    let up = unit * (bound / unit).ceil();
    // 0.07 · 1.0 may print as 0.07000000000000001.
    significant(up, 2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_rounded_for_reading() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(12_340), "12,340");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(significant(18_729.747_8, 6), "18729.7");
        assert_eq!(significant(0.001_5, 6), "0.0015");
        assert_eq!(significant(-4.0, 6), "-4");
        assert_eq!(significant(1.5e-9, 6), "1.5e-9");
        assert_eq!(significant(0.0, 6), "0");
    }

    #[test]
    fn bounds_are_rounded_up() {
        assert_eq!(rounded_up(0.0512), "0.052");
        assert_eq!(rounded_up(0.05), "0.05");
        assert_eq!(rounded_up(9.99), "10");
        assert_eq!(rounded_up(123.4), "130");
        assert_eq!(rounded_up(0.0), "0");
    }
}
