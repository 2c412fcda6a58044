//! All stages in a row, as the program runs them, for tests.

#![allow(dead_code, reason = "each test uses its own part")]

use brep::{Brep, Groups, Properties, Shells, Valid};
use csg::{Model, Solid};
use std::fs;
use std::path::{Path, PathBuf};
use subdiv::{Report, Rule, Settings};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// Every model in `fixtures/`, sorted.
pub(crate) fn models() -> Vec<PathBuf> {
    let folders = [
        "fixtures/solids",
        "fixtures/models",
        "fixtures/thesis",
        "fixtures/third_party/openscad",
    ];
    let mut models: Vec<PathBuf> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(Path::new(ROOT).join(folder)).expect("a folder"))
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|end| end == "csg"))
        .collect();
    models.sort();
    models
}

/// A converted model.
pub(crate) struct Converted {
    pub(crate) solid: Solid,
    pub(crate) brep: Valid<Brep>,
    pub(crate) report: Report,
    pub(crate) properties: Properties,
    pub(crate) shells: Shells,
    pub(crate) groups: Groups,
}

/// Converts the text of a `.csg` file with the tolerance in model units.
pub(crate) fn convert(source: &str, tolerance: f64) -> Converted {
    convert_model(&read(source), Rule::Tolerance(tolerance))
}

/// Reads the text of a `.csg` file.
pub(crate) fn read(source: &str) -> Model {
    let options = io::read::ReadOptions::default();
    io::read::scad_csg::read(source, "test.csg", &options)
        .expect("a readable model")
        .model
}

/// Converts a model.
pub(crate) fn convert_model(model: &Model, rule: Rule) -> Converted {
    let solid = Solid::build(model, None).expect("a bounded solid");
    convert_solid(solid, &Settings::new(rule))
}

/// Converts a solid.
pub(crate) fn convert_solid(solid: Solid, settings: &Settings) -> Converted {
    let (fragments, report) = if solid.primitives.is_empty() {
        Default::default()
    } else {
        let outcome = subdiv::convert(&solid, settings, &()).expect("a subdivision");
        (outcome.fragments, outcome.report)
    };
    let stitched = brep::stitch(&fragments).expect("paired half-edges");
    let brep = stitched.validate().expect("a manifold");
    let brep = match settings.rule {
        Rule::Tolerance(tolerance) => brep::dissolve_ghosts(brep, &solid, tolerance).0,
        Rule::Topology { .. } | Rule::Level(_) => brep,
    };
    Converted {
        properties: Properties::of(&brep),
        shells: Shells::of(&brep),
        groups: Groups::of(&brep),
        solid,
        brep,
        report,
    }
}
