//! `csg2brep properties` of mesh files, against what trimesh measures of the same files.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn python(script: &str, arguments: &[&Path]) -> Value {
    let script = Path::new(ROOT).join("tests/python").join(script);
    let mut command = Command::new(support::validators());
    let output = command.arg(script).args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn properties(path: &Path) -> assert_cmd::assert::Assert {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("csg2brep");
    command
        .args(["properties", "--json", "-q"])
        .arg(path)
        .assert()
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(list) => list.iter().flat_map(numbers).collect(),
        value => vec![value.as_f64().unwrap()],
    }
}

#[test]
fn meshes_of_every_format_measure_as_in_trimesh() {
    let folder = tempfile::tempdir().unwrap();
    let written = python("broken_meshes.py", &[folder.path()]);
    let good = ["cube", "torus", "two", "cavity"];
    let is_good = |file: &&Value| good.contains(&file["case"].as_str().unwrap());
    let files = written.as_array().unwrap().iter().filter(is_good);
    let files = files.map(|file| PathBuf::from(file["file"].as_str().unwrap()));
    let files: Vec<PathBuf> = files.collect();
    assert_eq!(files.len(), good.len() * 8);
    let paths: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    let expected = python("mesh_properties.py", &paths);
    for (path, expected) in files.iter().zip(expected.as_array().unwrap()) {
        let found = properties(path).success();
        let found: Value = serde_json::from_slice(&found.get_output().stdout).unwrap();
        let (name, total) = (path.display(), &found["total"]);
        for key in ["area", "volume", "centroid", "inertia"] {
            let (ours, theirs) = (numbers(&total[key]), numbers(&expected[key]));
            assert_eq!(ours.len(), theirs.len(), "{name}: {key}");
            let size = theirs.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
            for (ours, theirs) in ours.iter().zip(&theirs) {
                // Both compute in 64 bits; trimesh sums about the origin, up to 40 away.
                assert!(
                    (ours - theirs).abs() < 1e-9 * size,
                    "{name}: {key}: {found}"
                );
            }
        }
        let solids = found["solids"].as_array().unwrap();
        let shells: u64 = solids.iter().map(|s| s["shells"].as_u64().unwrap()).sum();
        assert_eq!(shells, expected["solids"], "{name}");
        let volume: f64 = solids.iter().map(|s| s["volume"].as_f64().unwrap()).sum();
        let all = total["volume"].as_f64().unwrap();
        assert!((volume - all).abs() < 1e-12 * all, "{name}");
    }
}

#[test]
fn touching_solids_are_told_apart_and_open_meshes_refused() {
    let folder = tempfile::tempdir().unwrap();
    python("broken_meshes.py", &[folder.path()]);
    for case in ["corner", "edge"] {
        for end in ["obj", "text.stl", "glb"] {
            let path = folder.path().join(format!("{case}.{end}"));
            let found = properties(&path).success();
            let found: Value = serde_json::from_slice(&found.get_output().stdout).unwrap();
            let solids = found["solids"].as_array().unwrap();
            let volumes = solids.iter().map(|solid| solid["volume"].as_f64().unwrap());
            assert_eq!(volumes.collect::<Vec<f64>>(), [8.0, 8.0], "{case}.{end}");
        }
    }
    for case in ["hole", "turned", "strange", "missing"] {
        let path = folder.path().join(format!("{case}.obj"));
        let refused = properties(&path).code(1);
        let text = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
        assert!(
            text.contains("do not enclose a solid (csg2brep check"),
            "{text}"
        );
    }
}
