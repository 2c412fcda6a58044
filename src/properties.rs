//! `csg2brep properties IN`: area, volume, centroid and inertia, of each solid and of all.

use crate::args::PropertiesArgs;
use crate::convert::new_report;
use crate::failure::Failure;
use crate::output;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::report::Report;
use crate::run::{Job, Target};
use crate::summary::{counted, number, rounded_up, triple};
use crate::talk::Talk;
use brep::{Properties, ShellId, Shells};
use serde_json::{Value, json};

/// Converts, measures, and prints on standard output.
pub(crate) fn run(args: PropertiesArgs, talk: Talk) -> Result<(), Failure> {
    let job = Job::new(args.input, &args.model)?;
    let mut report = new_report(&job);
    let progress = Progress::new(talk.is_quiet());
    let Boundary { brep, .. } = pipeline::run(&job, None, talk, &progress, &mut report)?;
    let shells = Shells::of(&brep);
    let measured = Measured {
        total: Properties::of(&brep),
        solids: Properties::of_solids(&brep, &shells),
        shells,
        report,
    };
    drop(progress);
    let text = if args.json {
        let json = serde_json::to_string_pretty(&measured.to_json());
        json.map_err(|error| Failure::Bug(error.to_string()))? + "\n"
    } else {
        measured.to_text()
    };
    output::write_bytes(&Target::Stdout, text.as_bytes())
}

struct Measured {
    total: Properties,
    /// As many as the shells' solids.
    solids: Vec<Properties>,
    shells: Shells,
    report: Report,
}

impl Measured {
    fn to_text(&self) -> String {
        let name = &self.report.input.name;
        if self.solids.is_empty() {
            return format!("{name}: the solid is empty\n");
        }
        let mut lines = vec![format!("{name}: {}", self.origin())];
        if let [_] = self.solids.as_slice() {
            lines.push(self.title(0));
        } else {
            lines.push(counted(self.solids.len() as u64, "solid") + " together");
        }
        lines.extend(measures(&self.total, self.report.volume_interval));
        if self.solids.len() > 1 {
            for (at, solid) in self.solids.iter().enumerate() {
                lines.push(self.title(at));
                lines.extend(measures(solid, None));
            }
        }
        lines.join("\n") + "\n"
    }

    /// Of what the numbers are, and how far that is from the model.
    fn origin(&self) -> String {
        let report = &self.report;
        let facets = counted(report.counts.facets, "triangle");
        let mut facts = vec![format!("measured on {facets}")];
        facts.extend(report.proved_distance.map(|distance| {
            if distance == 0.0 {
                "exact".to_owned()
            } else {
                format!("deviation <= {}", rounded_up(distance))
            }
        }));
        let measured = report.largest_deviation.map(rounded_up);
        facts.extend(measured.map(|distance| format!("deviation {distance} (measured)")));
        if report.uncertified_count > 0 {
            let cells = counted(report.uncertified_count, "cell");
            facts.push(format!("{cells} not certified"));
        }
        facts.join(", ")
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

    fn to_json(&self) -> Value {
        let solids = self.solids.iter().enumerate().map(|(at, properties)| {
            let mut value = values(properties);
            value["shells"] = json!(self.shells_of(at).count());
            value["genus"] = json!(self.genus(at));
            value
        });
        let solids: Vec<Value> = solids.collect();
        let mut total = values(&self.total);
        total["volume_interval"] = json!(self.report.volume_interval);
        json!({
            "schema_version": 1,
            "name": self.report.input.name,
            "triangles": self.report.counts.facets,
            "proved_distance": self.report.proved_distance,
            "largest_deviation": self.report.largest_deviation,
            "uncertified_count": self.report.uncertified_count,
            "warnings": self.report.warnings,
            "total": total,
            "solids": solids,
        })
    }
}

fn measures(of: &Properties, volume_interval: Option<[f64; 2]>) -> Vec<String> {
    let size = of.bounds.min.abs().max(of.bounds.max.abs()).max_element();
    let inertia = of.inertia;
    let largest = inertia.to_cols_array().into_iter();
    let largest = largest.fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
    let proved = volume_interval.map_or_else(String::new, |[low, high]| {
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

/// Numbers that JSON does not have become null.
fn values(of: &Properties) -> Value {
    let rows = [0, 1, 2].map(|row| of.inertia.row(row).to_array());
    let is_empty = of.bounds.is_empty();
    let corners = (!is_empty).then(|| [of.bounds.min.to_array(), of.bounds.max.to_array()]);
    json!({
        "area": of.area,
        "volume": of.volume,
        "centroid": (!is_empty).then(|| of.centroid.to_array()),
        "inertia": rows,
        "box": corners,
    })
}
