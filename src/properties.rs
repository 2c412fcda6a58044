//! `csg2brep properties IN`: area, volume, centroid and inertia, of each solid and of all.

mod json;

use crate::args::PropertiesArgs;
use crate::convert::new_report;
use crate::failure::Failure;
use crate::input::Input;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::report::Report;
use crate::run::{Job, Target};
use crate::summary::{counted, number, triple};
use crate::talk::Talk;
use crate::{mesh_file, output};
use brep::{Brep, Properties, ShellId, Shells, Valid};
use io::read::mesh;
pub(crate) use json::PropertiesReport;

/// Converts if need be, measures, and prints on standard output.
pub(crate) fn run(args: PropertiesArgs, talk: Talk) -> Result<(), Failure> {
    let mut job = Job::new(args.input, &args.model)?;
    // A mesh is measured as it is; its format is told before that of a model.
    let bytes = job.input.bytes()?;
    let name = job.input.name();
    let measured = if let Some(format) = mesh::sniff(&bytes, &name) {
        let mesh = mesh_file::parse(&bytes, format, &name, job.max_memory_bytes)?;
        let (brep, notes) = mesh_file::boundary(&mesh, &name)?;
        for note in &notes {
            talk.warn(&format!("{name}: {note}"));
        }
        let source = Source {
            name,
            format: Some(format.name()),
            unit: mesh.unit.clone(),
            origin: String::new(),
            warnings: notes,
            report: None,
        };
        Measured::new(&brep, source)
    } else {
        job.input = Input::Read { name, bytes };
        let mut report = new_report(&job);
        let progress = Progress::new(talk.is_quiet());
        let Boundary { brep, .. } = pipeline::run(&job, None, talk, &progress, &mut report)?;
        let source = Source {
            name: report.input.name.clone(),
            format: report.input.format,
            unit: None,
            origin: origin(&report),
            warnings: report.warnings.clone(),
            report: Some(report),
        };
        Measured::new(&brep, source)
    };
    let text = if args.json {
        let json = serde_json::to_string_pretty(&PropertiesReport::of(&measured));
        json.map_err(|error| Failure::Bug(error.to_string()))? + "\n"
    } else {
        measured.to_text()
    };
    output::write_bytes(&Target::Stdout, text.as_bytes())
}

/// What was measured.
struct Source {
    name: String,
    format: Option<&'static str>,
    /// Of a mesh whose format says it.
    unit: Option<String>,
    /// How far the triangles are from the model; empty where that is not known.
    origin: String,
    warnings: Vec<String>,
    /// Of a model that was converted.
    report: Option<Report>,
}

struct Measured {
    source: Source,
    triangles: u64,
    total: Properties,
    /// As many as the shells' solids.
    solids: Vec<Properties>,
    shells: Shells,
}

/// How far the triangles are from the model.
fn origin(report: &Report) -> String {
    let mut facts = Vec::new();
    facts.extend(report.deviation());
    if report.uncertified_count > 0 {
        let cells = counted(report.uncertified_count, "cell");
        facts.push(format!("{cells} not certified"));
    }
    facts.join(", ")
}

impl Measured {
    fn new(brep: &Valid<Brep>, source: Source) -> Self {
        let shells = Shells::of(brep);
        Self {
            source,
            triangles: brep.facet_count() as u64,
            total: Properties::of(brep),
            solids: Properties::of_solids(brep, &shells),
            shells,
        }
    }

    fn to_text(&self) -> String {
        let Source {
            name, origin, unit, ..
        } = &self.source;
        if self.triangles == 0 {
            return format!("{name}: the solid is empty\n");
        }
        let mut facts = vec![format!(
            "measured on {}",
            counted(self.triangles, "triangle")
        )];
        if self.source.report.is_none() || !origin.is_empty() {
            facts.push(origin.clone());
        }
        facts.extend(unit.as_ref().map(|unit| format!("lengths in {unit}")));
        let mut lines = vec![format!("{name}: {}", facts.join(", "))];
        if let [_] = self.solids.as_slice() {
            lines.push(self.title(0));
        } else {
            lines.push(counted(self.solids.len() as u64, "solid") + " together");
        }
        let interval = self
            .source
            .report
            .as_ref()
            .and_then(|report| report.volume_interval);
        lines.extend(measures(&self.total, interval));
        if self.solids.len() > 1 {
            for (at, solid) in self.solids.iter().enumerate() {
                lines.push(self.title(at));
                lines.extend(measures(solid, None));
            }
        }
        lines.join("\n") + "\n"
    }

    /// `solid 1: 2 shells, genus 0`.
    fn title(&self, at: usize) -> String {
        let shells = counted(self.shells_of(at).count() as u64, "shell");
        format!("solid {}: {shells}, genus {}", at + 1, self.genus(at))
    }

    fn shells_of(&self, at: usize) -> impl Iterator<Item = ShellId> {
        let solid = &self.shells.solids[at];
        std::iter::once(solid.outer).chain(solid.voids.iter().copied())
    }

    fn genus(&self, at: usize) -> u64 {
        let shells = self.shells_of(at);
        shells
            .map(|shell| self.shells.shells[shell.0 as usize].genus)
            .sum()
    }
}

fn measures(of: &Properties, volume_interval: Option<[f64; 2]>) -> Vec<String> {
    let size = of.bounds.min.abs().max(of.bounds.max.abs()).max_element();
    let inertia = of.inertia;
    let largest = inertia.to_cols_array().into_iter();
    let largest = largest.fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    let proved = volume_interval.map_or_else(String::new, |[low, high]| {
        let [low, high] = outward(low, high).map(|bound| number(bound, 0.0));
        format!(" (proved: {low} to {high})")
    });
    let [min, max] = [of.bounds.min, of.bounds.max].map(|corner| triple(corner, size));
    vec![
        format!("  area      {}", number(of.area, 0.0)),
        format!("  volume    {}{proved}", number(of.volume, 0.0)),
        format!("  centroid  {}", triple(of.centroid, size)),
        format!("  inertia   {}", triple(inertia.row(0), largest)),
        format!("            {}", triple(inertia.row(1), largest)),
        format!("            {}", triple(inertia.row(2), largest)),
        format!("  box       {min} to {max}"),
    ]
}

/// Bounds that stay bounds when they are rounded to nine digits.
fn outward(low: f64, high: f64) -> [f64; 2] {
    const MARGIN: f64 = 1e-8;
    [low - MARGIN * low.abs(), high + MARGIN * high.abs()]
}
