//! STEP files: true surfaces, and what is said where there are none.

use crate::failure::Failure;
use crate::input::Input;
use crate::output::to_target;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::report::{Report, StepReport};
use crate::run::{Conversion, Job, Target};
use crate::summary::counted;
use brep::{Brep, Valid};
use io::write::step::{Options, Outcome, Plan};
use subdiv::Rule;

/// How often a finer subdivision is tried where faces or edges were not told apart.
const ATTEMPTS: usize = 2;
/// How much finer, each time.
const FINER: f64 = 0.125;
/// Most cells of these: beyond them, facets are what a user would rather wait for.
const MAX_CELLS: u64 = 1_000_000;

/// Writes a STEP file. The report learns what became of the solids; returned is what the user
/// should know.
pub(crate) fn write(
    target: &Target,
    boundary: &Boundary,
    conversion: &Conversion,
    progress: &Progress,
    report: &mut Report,
) -> Result<Option<String>, Failure> {
    let job = &conversion.job;
    let Boundary { brep, solid, .. } = boundary;
    let topology = boundary.topology.as_ref().unwrap_or(brep);
    let options = options(conversion, solid.extent.diagonal());
    let (accuracy, crumb_size) = (options.tolerance, options.crumb_size);
    let plan_of = |topology: &Valid<Brep>, crumb_size, report: &mut Report| {
        progress.begin("true surfaces");
        let options = Options {
            crumb_size,
            ..options.clone()
        };
        let plan = report.timed("true surfaces", || Plan::of(solid, topology, options));
        plan.map_err(|error| Failure::from_writer(&target.name(), error))
    };
    let mut plan = plan_of(topology, crumb_size, report)?;
    let is_free = !matches!(job.rule(solid.extent.diagonal()), Rule::Level(_));
    let mut finest = crumb_size;
    let mut replacement = None;
    for _ in 0..ATTEMPTS {
        if plan.unresolved() == 0 || !is_free {
            break;
        }
        finest *= FINER;
        let Some((finer, mut aside)) = pipeline::finer(solid, job, finest, MAX_CELLS, progress)?
        else {
            break;
        };
        let candidate = plan_of(&finer.brep, finest, &mut aside)?;
        report.stages.append(&mut aside.stages);
        if candidate.unresolved() < plan.unresolved() {
            plan = candidate;
            replacement = Some(aside);
        }
    }
    if let Some(aside) = replacement
        && job.is_step_only
    {
        report.replace_boundary(aside);
    }
    let mut facets = None;
    if plan.needs_facets() && job.is_step_only {
        let mut aside = crate::convert::new_report(job);
        facets = Some(pipeline::facets(
            boundary, job, crumb_size, progress, &mut aside,
        )?);
        report.stages.append(&mut aside.stages);
    }
    progress.begin("writing");
    let mut outcome = Outcome::default();
    report.timed("writing", || {
        to_target(target, |mut out| {
            outcome = plan.write(facets.as_ref().unwrap_or(brep), &mut out)?;
            Ok(())
        })
    })?;
    let remark = remark(&outcome);
    report.step = Some(StepReport::new(outcome, accuracy, job.is_step_only));
    Ok(remark)
}

fn options(conversion: &Conversion, diagonal: f64) -> Options {
    /// Accuracy of spline curves, relative to the tolerance.
    const ACCURACY: f64 = 1e-4;
    /// Limits of it, relative to the solid: rounding, and what STEP readers take for equal.
    const LIMITS: [f64; 2] = [1e-9, 1e-6];
    /// Tolerance of a subdivision to a fixed level, relative to the solid.
    const DEFAULT: f64 = 1e-3;
    let job = &conversion.job;
    let finest = match job.rule(diagonal) {
        Rule::Tolerance(finest) | Rule::Topology { finest } => finest,
        Rule::Level(_) => DEFAULT * diagonal,
    };
    let [low, high] = LIMITS.map(|limit| limit * diagonal);
    Options {
        millimetres_per_unit: conversion.unit.unwrap_or_default().millimetres(),
        tolerance: (ACCURACY * finest).clamp(low, high),
        crumb_size: finest,
        name: part_name(job),
    }
}

/// The input file's name without its extension.
fn part_name(job: &Job) -> String {
    let Input::File(path) = &job.input else {
        return "part".to_owned();
    };
    let stem = path.file_stem().map(|stem| stem.to_string_lossy());
    stem.map_or_else(|| "part".to_owned(), std::borrow::Cow::into_owned)
}

fn remark(outcome: &Outcome) -> Option<String> {
    let first = outcome.faceted.first()?;
    let (count, all) = (outcome.faceted.len() as u64, outcome.solids as u64);
    let are = if count == 1 { "is" } else { "are" };
    let solids = if count == all {
        counted(count, "solid")
    } else {
        format!("{count} of {}", counted(all, "solid"))
    };
    Some(format!(
        "{solids} {are} written as plane facets, not true surfaces; {}: {}",
        first.name, first.reason
    ))
}
