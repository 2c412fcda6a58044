//! `csg2brep check`: good and deliberately broken files of every format, in the eyes of other
//! programs; hostile files; the published schema.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn csg2brep() -> assert_cmd::Command {
    assert_cmd::cargo::cargo_bin_cmd!("csg2brep")
}

/// What the program says of a file, and its exit code.
fn check(path: &Path, options: &[&str]) -> (Value, i32) {
    let mut command = csg2brep();
    let output = command.args(["check", "--json"]).args(options).arg(path);
    let output = output.output().unwrap();
    let code = output.status.code().unwrap();
    let report = serde_json::from_slice(&output.stdout);
    let errors = String::from_utf8_lossy(&output.stderr);
    (
        report.unwrap_or_else(|_| panic!("{}: {errors}", path.display())),
        code,
    )
}

fn count(report: &Value, kind: &str) -> u64 {
    let defects = report["defects"].as_array().unwrap();
    let found = defects.iter().find(|defects| defects["kind"] == kind);
    found.map_or(0, |defects| defects["count"].as_u64().unwrap())
}

fn broken_meshes(folder: &Path) -> Vec<Value> {
    let script = Path::new(ROOT).join("tests/python/broken_meshes.py");
    let mut command = Command::new(support::validators());
    let output = command.arg(script).arg(folder).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn schema() -> PathBuf {
    Path::new(ROOT).join("docs/check.schema.json")
}

/// After an intended change: `cargo run -- report-schema check > docs/check.schema.json`.
#[test]
fn the_published_schema_is_up_to_date() {
    let printed = csg2brep()
        .args(["report-schema", "check"])
        .output()
        .unwrap();
    let printed = String::from_utf8(printed.stdout).unwrap();
    assert_eq!(printed, fs::read_to_string(schema()).unwrap());
}

/// Lets the PyPI package `jsonschema` judge the reports in a folder.
fn follows_schema(folder: &Path) -> (bool, String) {
    let script = Path::new(ROOT).join("tests/python/validate_reports.py");
    let mut command = Command::new(support::validators());
    let output = command.arg(script).arg(schema()).arg(folder).output();
    let output = output.unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    (output.status.success(), text)
}

/// Everything that we write is sound when read back, also where solids touch.
#[test]
fn what_csg2brep_writes_passes() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let models = [
        ("S2_demo.csg", "1%", 1_u64),
        ("S6_plate64.csg", "1%", 1),
        ("S5_ring128.csg", "2%", 1),
    ];
    for (model, tolerance, components) in models {
        let mut command = csg2brep();
        command.arg(Path::new(ROOT).join("fixtures/solids").join(model));
        command.args(["-q", "--tolerance", tolerance]);
        for end in ["obj", "glb", "stl", "3mf", "ply"] {
            command.arg("-o").arg(path(&format!("x.{end}")));
        }
        command.args(["--report"]).arg(path("report.json"));
        command.assert().success();
        let report = fs::read_to_string(path("report.json")).unwrap();
        let report: Value = serde_json::from_str(&report).unwrap();
        for (end, joined_by) in [
            ("obj", "indices"),
            ("glb", "ext_mesh_manifold"),
            ("stl", "positions"),
            ("3mf", "indices"),
            ("ply", "indices"),
        ] {
            let (found, code) = check(&path(&format!("x.{end}")), &[]);
            assert_eq!(code, 0, "{model} {end}: {found}");
            assert_eq!(found["joined_by"], joined_by, "{model} {end}");
            assert_eq!(found["counts"]["triangles"], report["counts"]["facets"]);
            assert_eq!(found["counts"]["components"], components, "{model} {end}");
            assert_eq!(found["genus"], report["genus"], "{model} {end}");
            let volume = report["volume"].as_f64().unwrap();
            let difference = found["volume"].as_f64().unwrap() - volume;
            assert!(difference.abs() < 1e-5 * volume, "{model} {end}: {found}");
        }
    }
}

#[test]
fn every_defect_is_counted_in_every_format_as_others_count_it() {
    let folder = tempfile::tempdir().unwrap();
    let cases = broken_meshes(folder.path());
    let reports = tempfile::tempdir().unwrap();
    let mut kinds = BTreeSet::new();
    for expected in &cases {
        let path = PathBuf::from(expected["file"].as_str().unwrap());
        let (found, code) = check(&path, &[]);
        let name = path.display();
        let copy = path.file_name().unwrap().to_string_lossy().into_owned() + ".json";
        fs::write(reports.path().join(copy), found.to_string()).unwrap();
        for (kind, key) in [
            ("vertex_not_finite", "not_finite"),
            ("vertex_out_of_range", "out_of_range"),
            ("degenerate_triangle", "degenerate"),
            ("duplicate_triangle", "duplicate"),
            ("open_edge", "open"),
            ("open_edge", "boundary"),
            ("edge_of_three_or_more_triangles", "crowded"),
            ("edge_twice_in_one_direction", "one_way"),
            ("vertex_of_several_fans", "pinched"),
        ] {
            assert_eq!(count(&found, kind), expected[key], "{name}: {key}: {found}");
        }
        assert_eq!(
            found["counts"]["components"], expected["components"],
            "{name}"
        );
        let defects = found["defects"].as_array().unwrap();
        for defect in defects {
            kinds.insert(defect["kind"].as_str().unwrap().to_owned());
            let first = defect["first"].as_array().unwrap();
            assert!(
                !first.is_empty() && !defect["remedy"].as_str().unwrap().is_empty(),
                "{name}"
            );
        }
        let sound = found["is_closed_oriented_manifold"].as_bool().unwrap();
        assert_eq!(sound, defects.is_empty(), "{name}");
        assert_eq!(code, if sound { 0 } else { 3 }, "{name}");
        verdicts_agree(&found, expected, sound);
    }
    assert_eq!(kinds.len(), 8, "{kinds:?}");
    let (follow, text) = follows_schema(reports.path());
    let all = format!("{} reports", cases.len());
    assert!(follow && text.contains(&all), "{text}");
}

/// Manifold and trimesh say the same of the same arrays, as far as they look.
fn verdicts_agree(found: &Value, expected: &Value, sound: bool) {
    let case = expected["case"].as_str().unwrap();
    // Manifold splits where surfaces touch, and drops triangles that have collapsed.
    let lenient = ["corner", "edge", "degenerate"].contains(&case);
    if let Some(status) = expected["manifold"].as_str()
        && !lenient
    {
        assert_eq!(status == "NoError", sound, "{case}: {status}");
    }
    if sound {
        assert_eq!(expected["watertight"], true, "{case}");
    }
    if let (Some(volume), true) = (expected["volume"].as_f64(), !found["volume"].is_null()) {
        let size = volume.abs().max(1.0);
        let difference = found["volume"].as_f64().unwrap() - volume;
        assert!(difference.abs() < 1e-5 * size, "{case}: {found}");
    }
    if let Some(area) = expected["area"].as_f64() {
        let difference = found["area"].as_f64().unwrap() - area;
        assert!(difference.abs() < 1e-5 * area, "{case}: {found}");
    }
}
