//! The JSON report and its published schema, `docs/report.schema.json`.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn csg2brep() -> assert_cmd::Command {
    assert_cmd::cargo::cargo_bin_cmd!("csg2brep")
}

fn schema() -> PathBuf {
    Path::new(ROOT).join("docs/report.schema.json")
}

/// After an intended change: `cargo run -- report-schema > docs/report.schema.json`.
#[test]
fn the_published_schema_is_up_to_date() {
    let printed = csg2brep().arg("report-schema").assert().success();
    let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
    assert_eq!(printed, fs::read_to_string(schema()).unwrap());
}

/// Writes reports into a folder and lets the PyPI package `jsonschema` judge them.
fn validate(folder: &Path) -> (bool, String) {
    let script = Path::new(ROOT).join("tests/python/validate_reports.py");
    let mut command = Command::new(support::validators());
    let output = command
        .arg(script)
        .arg(schema())
        .arg(folder)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let errors = String::from_utf8_lossy(&output.stderr);
    (output.status.success(), format!("{text}{errors}"))
}

#[test]
fn every_fixtures_report_follows_the_schema() {
    let folder = tempfile::tempdir().unwrap();
    let report = |name: &str| folder.path().join(format!("{name}.json"));
    let mut count = 0;
    for group in [
        "solids",
        "models",
        "third_party/openscad",
        "third_party/openscad_more",
    ] {
        for entry in fs::read_dir(Path::new(ROOT).join("fixtures").join(group)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|end| end != "csg") {
                continue;
            }
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            let mut command = csg2brep();
            command.arg(&path).args(["-q", "--tolerance", "3%", "-o"]);
            command.arg(folder.path().join("out.stl"));
            command
                .arg("--report")
                .arg(report(&name))
                .assert()
                .success();
            count += 1;
        }
    }
    assert!(count >= 50, "{count} fixtures");
    // Reports of failures and of other settings follow it, too.
    let text = |name: &str, text: &str| {
        let path = folder.path().join(format!("{name}.csg"));
        fs::write(&path, text).unwrap();
        path
    };
    let run = |name: &str, model: &Path, options: &[&str]| {
        let mut command = csg2brep();
        command.arg(model).arg("-q").args(options).arg("-o");
        command.arg(folder.path().join("out.stl"));
        command.arg("--report").arg(report(name)).assert()
    };
    run("unreadable", &text("bad", "cube(;"), &[]).code(1);
    run(
        "unbounded",
        &text("half", "halfspace(n=[1,0,0], d=0);"),
        &[],
    )
    .code(1);
    let clip = ["--box", "-1", "-1", "-1", "1", "1", "1", "--level", "6"];
    run(
        "clipped",
        &text("half2", "halfspace(n=[1,0,0], d=0);"),
        &clip,
    )
    .success();
    run(
        "crowded",
        &text("ball", "sphere(r=1);"),
        &["--max-cells", "10"],
    )
    .code(4);
    fs::remove_file(folder.path().join("out.stl")).unwrap();

    let (sound, text) = validate(folder.path());
    assert!(
        sound && text.contains(&format!("{} reports", count + 4)),
        "{text}"
    );

    // The judge must be able to say no.
    let broken = fs::read_to_string(report("clipped")).unwrap();
    fs::write(report("broken"), broken.replace("\"genus\"", "\"gender\"")).unwrap();
    let (sound, text) = validate(folder.path());
    assert!(
        !sound && text.contains("broken.json") && text.contains("genus"),
        "{text}"
    );
}
