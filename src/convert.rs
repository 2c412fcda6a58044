//! `csg2brep IN -o OUT`: convert, write, report.

use crate::args::OutputFormat;
use crate::failure::Failure;
use crate::memory;
use crate::output;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::report::{InputReport, Report};
use crate::run::{Conversion, Job, Output, Target};
use crate::summary::{counted, grouped, significant, summary};
use crate::talk::Talk;
use crate::true_surfaces;
use std::time::Instant;

/// Converts, writes all outputs and the report, and says what came out.
pub(crate) fn run(conversion: &Conversion, talk: Talk) -> Result<(), Failure> {
    let start = Instant::now();
    let mut report = new_report(&conversion.job);
    let result = convert(conversion, talk, &mut report);
    report.total_seconds = start.elapsed().as_secs_f64();
    report.peak_memory_bytes = memory::peak_bytes();
    report.error = result.as_ref().err().map(ToString::to_string);
    // A report of a failed run tells how far it came; the failure itself matters more.
    let reported = match &conversion.report {
        Some(target) => write_report(&report, target),
        None => Ok(()),
    };
    result?;
    reported?;

    talk.explain(|| details(&report));
    let names: Vec<String> = conversion.outputs.iter().map(|o| o.target.name()).collect();
    talk.say(&summary(&report, &names));
    if conversion.strict && report.uncertified_count == 0 && report.one_way_cells > 0 {
        return Err(Failure::NotCertified(format!(
            "{} cells are certified one way only: the mesh is near the true boundary there, the \
             reverse is not proved (--strict)",
            grouped(report.one_way_cells)
        )));
    }
    if conversion.strict
        && let Some(step) = &report.step
        && !step.faceted.is_empty()
    {
        let solids = counted(step.faceted.len() as u64, "solid");
        return Err(Failure::NotCertified(format!(
            "{solids} without true surfaces in STEP (--strict)"
        )));
    }
    if conversion.strict && report.uncertified_count > 0 {
        let what = if report.settings.topology_only {
            "leave the topology open"
        } else {
            "are not certified to the tolerance"
        };
        return Err(Failure::NotCertified(format!(
            "{} cells {what} (--strict)",
            grouped(report.uncertified_count)
        )));
    }
    Ok(())
}

/// A report of a job that has not begun.
pub(crate) fn new_report(job: &Job) -> Report {
    let input = InputReport {
        name: job.input.name(),
        format: None,
    };
    Report::new(input, job.report())
}

fn convert(conversion: &Conversion, talk: Talk, report: &mut Report) -> Result<(), Failure> {
    let progress = Progress::new(talk.is_quiet());
    let Conversion { job, from, .. } = conversion;
    let boundary = pipeline::run(job, *from, talk, &progress, report)?;
    if conversion.strict && !report.warnings.is_empty() {
        let count = report.warnings.len();
        let text = format!("{count} warnings are errors (--strict); nothing was written");
        return Err(Failure::BadInput(text));
    }
    for output in &conversion.outputs {
        let remark = write(output, &boundary, conversion, &progress, report)?;
        if let Some(text) = remark {
            let remark = format!("{}: {text}", output.target.name());
            progress.hidden_while(|| talk.warn(&remark));
            report.warnings.push(remark);
        }
    }
    Ok(())
}

/// Writes one file; returns what the user should know of it.
fn write(
    output: &Output,
    boundary: &Boundary,
    conversion: &Conversion,
    progress: &Progress,
    report: &mut Report,
) -> Result<Option<String>, Failure> {
    let needs_solid = matches!(
        output.format,
        OutputFormat::ThesisCsg | OutputFormat::Cspg | OutputFormat::Step
    );
    if needs_solid && boundary.is_mesh {
        let text =
            "the input is a mesh, which has lost its set operations: only a mesh can be written";
        return Err(Failure::BadInput(text.to_owned()));
    }
    if output.format == OutputFormat::Step {
        return true_surfaces::write(&output.target, boundary, conversion, progress, report);
    }
    progress.begin("writing");
    let Conversion { job, unit, .. } = conversion;
    report.timed("writing", || {
        output::write(output, boundary, *unit, job.dialect)
    })
}

fn write_report(report: &Report, target: &Target) -> Result<(), Failure> {
    let json = report
        .to_json()
        .map_err(|error| Failure::Bug(error.to_string()))?;
    output::write_bytes(target, json.as_bytes())
}

/// Stages with their times, counts, and places without proof.
fn details(report: &Report) -> String {
    let mut lines: Vec<String> = Vec::new();
    for stage in &report.stages {
        lines.push(format!("{:>12}: {:.3} s", stage.name, stage.seconds));
    }
    let counts = &report.counts;
    lines.push(format!(
        "{:>12}: {} leaves, {} bisections",
        "cells",
        grouped(counts.leaves),
        grouped(counts.bisections)
    ));
    lines.push(format!(
        "{:>12}: {} faces, {} edges, {} vertices",
        "boundary",
        grouped(counts.brep_faces),
        grouped(counts.brep_edges),
        grouped(counts.brep_vertices)
    ));
    if counts.merged_faces > 0 {
        lines.push(format!(
            "{:>12}: {} planar faces merged, {} triangles before, {} after",
            "merging",
            grouped(counts.merged_faces),
            grouped(counts.leaf_facets),
            grouped(counts.facets)
        ));
    }
    if let Some(quality) = &report.quality {
        lines.push(format!(
            "{:>12}: smallest angle {} deg, mean {:.1} deg, {} below 1 deg, largest aspect {}",
            "facets",
            significant(quality.smallest_angle_deg, 3),
            quality.mean_angle_deg,
            grouped(quality.slivers),
            quality
                .largest_aspect
                .map_or_else(|| "infinite".to_owned(), |aspect| significant(aspect, 3)),
        ));
    }
    if let Some(bytes) = report.peak_memory_bytes {
        lines.push(format!("{:>12}: {} MiB", "memory", grouped(bytes >> 20)));
    }
    for pair in &report.nearly_equal_primitives {
        let [a, b] = pair.primitives;
        let difference = pair.difference;
        lines.push(format!(
            "surfaces {a} and {b} are nearly equal (difference {difference:e})"
        ));
    }
    for place in report.uncertified.iter().take(LISTED_PLACES) {
        let [x, y, z] = place.position;
        let (size, reason) = (place.size, place.reason);
        lines.push(format!(
            "not certified: near ({x}, {y}, {z}), size {size:.3e}, {reason}"
        ));
    }
    lines.join("\n")
}

/// The report lists more of them.
const LISTED_PLACES: usize = 20;
