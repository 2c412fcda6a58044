//! The stages in order: text, model, solid, fragments, boundary.

use crate::args::{InputFormat, MeshKind};
use crate::failure::Failure;
use crate::input::Loaded;
use crate::loose;
use crate::progress::{self, Progress};
use crate::report::Report;
use crate::run::Job;
use crate::summary::{counted, significant};
use crate::talk::Talk;
use brep::simplify::{contract_knots, remove_degenerate};
use brep::{
    Brep, Demand, Groups, IfTroubled, Proof, Properties, Quality, Retriangulated, Shells, Valid,
};
use csg::{PrimitiveId, Solid};
use io::read::format::Format;
use subdiv::{Fragments, Rule};

/// A solid's boundary, ready to be written.
pub(crate) struct Boundary {
    pub(crate) brep: Valid<Brep>,
    /// The proved mesh for true surfaces, of which only faces, edges and vertices matter, where
    /// it is not `brep`.
    pub(crate) topology: Option<Valid<Brep>>,
    pub(crate) solid: Solid,
    /// Whether a mesh was read, so that nothing is known of the solid but its boundary.
    pub(crate) is_mesh: bool,
}

/// Runs all stages; `report` learns what each one did, also when a later one fails.
pub(crate) fn run(
    job: &Job,
    from: Option<InputFormat>,
    talk: Talk,
    progress: &Progress,
    report: &mut Report,
) -> Result<Boundary, Failure> {
    progress.begin("reading");
    let (bytes, format) = job.input.open(from)?;
    if matches!(format, Format::ThesisApl | Format::ThesisWfr) {
        report.input.format = Some(format.name());
        let (fragments, solid) = report.timed("reading", || loose::read(job, &bytes, format))?;
        progress.begin("stitching");
        let (brep, _) = report.timed("stitching", || stitch(&fragments))?;
        let is_mesh = true;
        let topology = None;
        let boundary = Boundary {
            brep,
            topology,
            solid,
            is_mesh,
        };
        return Ok(measured(boundary, progress, report));
    }
    let loaded = report.timed("reading", || {
        job.input.parse(bytes, format, job.read, job.dialect)
    })?;
    report.input.format = Some(loaded.format.name());
    report.approximated_nodes = loaded.approximated_nodes;
    progress.hidden_while(|| warn(&loaded, talk, report));

    progress.begin("preparing");
    let solid = report.timed("preparing", || Solid::build(&loaded.model, job.clip));
    let solid = solid.map_err(|error| Failure::from(error).of_input(&job.input.name()))?;
    drop(loaded);
    report.add_solid(&solid);
    for warning in doubts(report) {
        talk.warn(&warning);
        report.warnings.push(warning);
    }

    let (brep, topology) = mesh(&solid, job, progress, report)?;
    if let Some(warning) = too_coarse(report) {
        talk.warn(&warning);
        report.warnings.push(warning);
    }
    let is_mesh = false;
    Ok(measured(
        Boundary {
            brep,
            topology,
            solid,
            is_mesh,
        },
        progress,
        report,
    ))
}

/// The boundary with its measures in the report.
fn measured(boundary: Boundary, progress: &Progress, report: &mut Report) -> Boundary {
    progress.begin("measuring");
    let brep = &boundary.brep;
    let (groups, shells, properties, quality) = report.timed("measuring", || {
        let (groups, shells) = (Groups::of(brep), Shells::of(brep));
        (groups, shells, Properties::of(brep), Quality::of(brep))
    });
    report.add_boundary(brep, &groups, &shells, &properties);
    report.add_quality(quality.as_ref());
    boundary
}

/// The boundary, with the facets that were asked for, and its topology, if that is another one.
fn mesh(
    solid: &Solid,
    job: &Job,
    progress: &Progress,
    report: &mut Report,
) -> Result<(Valid<Brep>, Option<Valid<Brep>>), Failure> {
    let rule = job.rule(solid.extent.diagonal());
    if job.is_step_only {
        let brep = subdivided(solid, job, rule, progress, report)?;
        return Ok((brep, None));
    }
    let is_from_surfaces = job.mesh == MeshKind::Surfaces;
    let (refine, keep) = (IfTroubled::Refine, IfTroubled::Keep);
    let (mut topology, mut own) = (None, None);
    if (is_from_surfaces || job.has_step)
        && let Rule::Tolerance(tolerance) | Rule::Topology { finest: tolerance } = rule
    {
        let coarse = Rule::Topology { finest: tolerance };
        let brep = subdivided(solid, job, coarse, progress, report)?;
        let mut facets = None;
        if is_from_surfaces {
            facets = tessellated(&brep, solid, job, tolerance, refine, progress, report)?;
        }
        topology = Some(brep);
        if is_from_surfaces && facets.is_none() {
            let rule = Rule::Tolerance(tolerance);
            let brep = subdivided(solid, job, rule, progress, report)?;
            facets = tessellated(&brep, solid, job, tolerance, keep, progress, report)?;
            own = Some(brep);
        }
        if let Some(facets) = facets {
            return Ok((facets, topology));
        }
    }
    let brep = match own {
        Some(brep) => brep,
        None => subdivided(solid, job, rule, progress, report)?,
    };
    if job.mesh == MeshKind::Leaves {
        report.counts.leaf_facets = brep.facet_count() as u64;
        return Ok((brep, topology));
    }
    progress.begin("merging");
    let (brep, counts, moved) = report.timed("merging", || merge(brep, solid))?;
    report.add_merging(&counts);
    report.add_deviation(moved);
    stop_if_interrupted()?;
    Ok((brep, topology))
}

/// Facets of a solid of which only the topology was proved so far, within `tolerance` of its
/// surfaces.
pub(crate) fn facets(
    boundary: &Boundary,
    job: &Job,
    tolerance: f64,
    progress: &Progress,
    report: &mut Report,
) -> Result<Valid<Brep>, Failure> {
    let Boundary { brep, solid, .. } = boundary;
    let refine = IfTroubled::Refine;
    if let Some(brep) = tessellated(brep, solid, job, tolerance, refine, progress, report)? {
        return Ok(brep);
    }
    let fine = subdivided(solid, job, Rule::Tolerance(tolerance), progress, report)?;
    let keep = IfTroubled::Keep;
    if let Some(brep) = tessellated(&fine, solid, job, tolerance, keep, progress, report)? {
        return Ok(brep);
    }
    let (brep, ..) = report.timed("merging", || merge(fine, solid))?;
    Ok(brep)
}

/// The boundary once more, with cells no larger than `finest` where nothing is proved, and what
/// was measured on it; `None` if that takes more than `max_cells`.
pub(crate) fn finer(
    solid: &Solid,
    job: &Job,
    finest: f64,
    max_cells: u64,
    progress: &Progress,
) -> Result<Option<(Boundary, Report)>, Failure> {
    let job = Job {
        max_cells: job.max_cells.min(max_cells),
        ..job.clone()
    };
    let mut report = crate::convert::new_report(&job);
    let rule = Rule::Topology { finest };
    let brep = match subdivided(solid, &job, rule, progress, &mut report) {
        Ok(brep) => brep,
        Err(Failure::Limit(_)) => return Ok(None),
        Err(failure) => return Err(failure),
    };
    let boundary = Boundary {
        brep,
        topology: None,
        solid: solid.clone(),
        is_mesh: false,
    };
    let boundary = measured(boundary, progress, &mut report);
    Ok(Some((boundary, report)))
}

/// Facets from the true surfaces, where that is possible.
fn tessellated(
    topology: &Valid<Brep>,
    solid: &Solid,
    job: &Job,
    tolerance: f64,
    if_troubled: IfTroubled,
    progress: &Progress,
    report: &mut Report,
) -> Result<Option<Valid<Brep>>, Failure> {
    progress.begin("tessellation");
    let components = topology.component_count();
    let proof = if report.has_proved_manifold() {
        Proof::BothWays { components }
    } else {
        Proof::OneWay
    };
    let demand = Demand {
        tolerance,
        fit: job.fit,
        if_troubled,
        proof,
    };
    let tessellated = report.timed("tessellation", || brep::tessellate(topology, solid, demand));
    stop_if_interrupted()?;
    let Some((brep, mut counts)) = tessellated else {
        return Ok(None);
    };
    if counts.kept_faces == 0 {
        report.add_tessellation(&counts);
        return Ok(Some(brep));
    }
    let (brep, ..) = report.timed("merging", || merge(brep, solid))?;
    // Facets of planes have changed.
    let limit = counts.enclosure.map_or(0.0, |of| 2.0 * of.distance);
    counts.enclosure = report.timed("proof", || brep::enclose(&brep, solid, None, limit).ok());
    report.add_tessellation(&counts);
    Ok(Some(brep))
}

/// The boundary with the facets of the subdivision.
fn subdivided(
    solid: &Solid,
    job: &Job,
    rule: Rule,
    progress: &Progress,
    report: &mut Report,
) -> Result<Valid<Brep>, Failure> {
    let fragments = subdivide(solid, job, rule, progress, report)?;
    stop_if_interrupted()?;
    progress.begin("stitching");
    let (brep, moved, ghosts) = report.timed("stitching", || {
        let (brep, moved) = stitch(&fragments)?;
        let (brep, ghosts) = match rule {
            Rule::Tolerance(tolerance) => brep::dissolve_ghosts(brep, solid, tolerance),
            // What takes its faces from coarse cells has its own rules for what is small.
            Rule::Topology { .. } | Rule::Level(_) => (brep, 0),
        };
        Ok::<_, Failure>((brep, moved, ghosts))
    })?;
    stop_if_interrupted()?;
    report.add_deviation(moved);
    report.ghost_faces = ghosts as u64;
    Ok(brep)
}

fn warn(loaded: &Loaded, talk: Talk, report: &mut Report) {
    for warning in &loaded.warnings {
        talk.warn_about(warning, &loaded.source);
        report.warnings.push(warning.to_string());
    }
}

fn subdivide(
    solid: &Solid,
    job: &Job,
    rule: Rule,
    progress: &Progress,
    report: &mut Report,
) -> Result<Fragments, Failure> {
    if solid.primitives.is_empty() {
        return Ok(Fragments::default());
    }
    let settings = job.settings(rule);
    if let Rule::Tolerance(tolerance) | Rule::Topology { finest: tolerance } = settings.rule {
        report.settings.tolerance = Some(tolerance);
    }
    let outcome = subdiv::convert(solid, &settings, progress);
    let outcome = outcome.map_err(|error| Failure::from(error).of_input(&job.input.name()))?;
    report.add_subdivision(&outcome.report);
    Ok(outcome.fragments)
}

/// Whether cells that prove nothing are larger than was asked for: a part may hide in them.
fn too_coarse(report: &Report) -> Option<String> {
    let (size, asked) = (report.largest_uncertified()?, report.settings.tolerance?);
    (size > asked * (1.0 + 1e-9)).then(|| {
        format!(
            "parts smaller than {} may be missing in {} that are not certified: cells cannot be \
             as small as the tolerance beside a model of this size",
            significant(size, 2),
            counted(report.uncertified_count, "cell")
        )
    })
}

/// What about the surfaces may not be meant.
fn doubts(report: &Report) -> Vec<String> {
    const NAMED: usize = 5;
    let mut doubts = Vec::new();
    let pairs = &report.nearly_equal_primitives;
    if !pairs.is_empty() {
        let named = pairs.iter().take(NAMED).map(|pair| {
            let [a, b] = pair.primitives;
            format!("{a} and {b} (by {})", significant(pair.difference, 2))
        });
        let named: Vec<String> = named.collect();
        let more = match pairs.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {more} more pairs"),
        };
        doubts.push(format!(
            "surfaces are nearly but not quite equal: {}{more}; gaps and walls that thin are kept \
             (`csg2brep info` describes surfaces)",
            named.join(", ")
        ));
    }
    for of in &report.imprecise_primitives {
        doubts.push(format!(
            "surface {} has lost digits: its values are uncertain by {} of their usual size \
             (write it about the part's middle, as products, or with a lower degree)",
            of.primitive,
            significant(of.uncertainty, 2)
        ));
    }
    doubts
}

/// A subdivision that does not close is this program's fault, never the model's.
///
/// Also returns how far vertices moved.
fn stitch(fragments: &Fragments) -> Result<(Valid<Brep>, f64), Failure> {
    let stitched = brep::stitch(fragments).map_err(|error| match error {
        brep::Error::TooManyTriangles { .. } => Failure::Limit(error.to_string()),
        _ => Failure::Bug(error.to_string()),
    })?;
    without_degenerate(stitched.validate().map_err(|defects| bug(&defects))?)
}

/// A plane needs no facets but those between its edges; then more edges without length may go.
///
/// Also returns how far vertices moved.
fn merge(brep: Valid<Brep>, solid: &Solid) -> Result<(Valid<Brep>, Retriangulated, f64), Failure> {
    let (brep, counts) = brep::retriangulate(brep, |PrimitiveId(at)| {
        let primitive = solid.primitives.get(at as usize);
        primitive.is_some_and(|primitive| primitive.polynomial.degree() == 1)
    });
    let (brep, moved) = without_degenerate(brep)?;
    Ok((brep, counts, moved))
}

fn without_degenerate(brep: Valid<Brep>) -> Result<(Valid<Brep>, f64), Failure> {
    let (clean, counts) = remove_degenerate(brep).map_err(|defects| bug(&defects))?;
    if counts.remaining_edges == 0 {
        return Ok((clean, counts.longest_collapsed));
    }
    let (plain, _) = contract_knots(clean).map_err(|defects| bug(&defects))?;
    Ok((plain, counts.longest_collapsed))
}

fn bug(defects: &brep::Defects) -> Failure {
    Failure::Bug(defects.to_string())
}

fn stop_if_interrupted() -> Result<(), Failure> {
    if progress::cancelled() {
        Err(Failure::Cancelled)
    } else {
        Ok(())
    }
}
