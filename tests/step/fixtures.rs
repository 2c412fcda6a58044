//! Every model in `fixtures/` as the program writes it.

use crate::opencascade::{StepFile, python};
use rayon::prelude::*;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
const FOLDERS: [&str; 4] = [
    "solids",
    "models",
    "third_party/openscad",
    "third_party/openscad_more",
];
/// Files that take longer than all others together, to write or to read; `STEP_FIXTURES=all` has them, too.
const SLOW: [&str; 8] = [
    "example024",
    "hull",
    "linear_extrude-tests",
    "module-recursion",
    "nopscadlib_carriers",
    "nopscadlib_rod_ends",
    "nopscadlib_rounded_triangle",
    "S5_ring128",
];
/// Files with solids that have no true form.
const FACETED: [&str; 7] = [
    "S7_heart",
    // A face touches itself along an edge since strips are merged into their neighbours.
    "allmodules",
    "animation",
    "example017",
    "linear_extrude_invisible-tests",
    "nopscadlib_rounded_triangle",
    "offset",
];
/// Files with such solids, the facets of which are too thin: nothing is written.
const REFUSED: [&str; 2] = ["hull", "module-recursion"];

fn fixtures() -> Vec<PathBuf> {
    let is_whole = std::env::var("STEP_FIXTURES").is_ok_and(|value| value == "all");
    let files =
        |folder: &&str| fs::read_dir(Path::new(ROOT).join("fixtures").join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = FOLDERS
        .iter()
        .flat_map(files)
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "csg"))
        .filter(|path| is_whole || !SLOW.contains(&name(path).as_str()))
        .collect();
    paths.sort();
    paths
}

fn name(path: &Path) -> String {
    path.file_stem().unwrap().to_string_lossy().into_owned()
}

/// Writes a STEP file, and returns its path and the report; `None` if the program says that it cannot.
fn write(model: &Path, folder: &Path) -> Option<(PathBuf, Value)> {
    let step = folder.join(name(model)).with_extension("step");
    let report = step.with_extension("json");
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("csg2brep");
    command.arg(model).args(["-q", "--tolerance", "0.5%", "-o"]);
    command.arg(&step).arg("--report").arg(&report);
    let result = command.assert();
    if REFUSED.contains(&name(model).as_str()) {
        let said = String::from_utf8_lossy(&result.get_output().stderr).into_owned();
        assert!(said.contains("facets are thinner than"), "{said}");
        result.code(4);
        assert!(!step.exists());
        return None;
    }
    result.success();
    let report = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
    Some((step, report))
}

#[test]
fn every_fixture_is_valid() {
    let folder = tempfile::tempdir().unwrap();
    let models = fixtures();
    assert!(models.len() >= 60, "{} fixtures", models.len());
    let written: Vec<(PathBuf, Value)> = models
        .par_iter()
        .filter_map(|model| write(model, folder.path()))
        .collect();
    let mut arguments = vec!["--quick"];
    arguments.extend(written.iter().map(|(path, _)| path.to_str().unwrap()));
    let read = python::<StepFile>(&arguments);
    for ((path, report), file) in written.iter().zip(&read) {
        let name = name(path);
        assert_eq!(file.error, None, "{name}");
        let solids = report["step"]["solids"].as_u64().unwrap();
        let left_out = report["step"]["specks"].as_u64().unwrap();
        assert_eq!(file.solids.len() as u64, solids, "{name}");
        assert_eq!(report["counts"]["solids"], solids + left_out, "{name}");
        assert_eq!(file.loose, 0, "{name}");
        let invalid = file.solids.iter().filter(|solid| !solid.valid).count();
        assert_eq!(invalid, 0, "{name}: {report}");
        let faceted = report["step"]["faceted"].as_array().unwrap();
        assert!(
            faceted.is_empty() || FACETED.contains(&name.as_str()),
            "{name}: {faceted:?}"
        );
        // The bounds are those of a coarse subdivision, or of none where that gave up.
        let bounds = report["volume_interval"].as_array();
        let bounds = bounds.map(|bounds| [0, 1].map(|at| bounds[at].as_f64().unwrap()));
        if let Some([low, high]) = bounds {
            let volume: f64 = file.solids.iter().map(|solid| solid.volume).sum();
            let slack = if faceted.is_empty() { 1e-6 } else { 1e-2 } * high;
            assert!(
                volume >= low - slack && volume <= high + slack,
                "{name}: {low} to {high}, {volume}"
            );
        }
    }
}
