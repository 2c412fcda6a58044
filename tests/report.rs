//! The JSON report and what `properties --json` prints, and their published schemas in `docs/`.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

fn csg2brep() -> assert_cmd::Command {
    assert_cmd::cargo::cargo_bin_cmd!("csg2brep")
}

fn schema(name: &str) -> PathBuf {
    Path::new(ROOT).join(format!("docs/{name}.schema.json"))
}

/// After an intended change: `cargo run -- report-schema convert > docs/report.schema.json`, and
/// likewise `properties`.
#[test]
fn the_published_schemas_are_up_to_date() {
    for (of, name) in [("convert", "report"), ("properties", "properties")] {
        let printed = csg2brep().args(["report-schema", of]).assert().success();
        let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
        assert_eq!(printed, fs::read_to_string(schema(name)).unwrap());
    }
}

/// Lets the PyPI package `jsonschema` judge the JSON files in a folder by the schema of this name.
fn validate(name: &str, folder: &Path) -> (bool, String) {
    let script = Path::new(ROOT).join("tests/python/validate_reports.py");
    let mut command = Command::new(support::validators());
    let output = command
        .arg(script)
        .arg(schema(name))
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

    let (sound, text) = validate("report", folder.path());
    assert!(
        sound && text.contains(&format!("{} reports", count + 4)),
        "{text}"
    );

    // The judge must be able to say no.
    let broken = fs::read_to_string(report("clipped")).unwrap();
    fs::write(report("broken"), broken.replace("\"genus\"", "\"gender\"")).unwrap();
    let (sound, text) = validate("report", folder.path());
    assert!(
        !sound && text.contains("broken.json") && text.contains("genus"),
        "{text}"
    );
}

#[test]
fn properties_follow_their_schema() {
    let folder = tempfile::tempdir().unwrap();
    let fixture = |name: &str| Path::new(ROOT).join("fixtures").join(name);
    let mesh = folder.path().join("ball.glb");
    let mut command = csg2brep();
    command.arg(fixture("solids/S1_sphere.csg")).arg("-o");
    command.arg(&mesh).assert().success();
    let models = [
        mesh.clone(),
        fixture("solids/S4_64_spheres.csg"),
        fixture("third_party/openscad/cylinder-tests.csg"),
        fixture("third_party/openscad/nullspace-difference.csg"),
    ];
    for (at, model) in models.iter().enumerate() {
        let mut command = csg2brep();
        command.args(["properties", "--json", "-q", "--tolerance", "3%"]);
        let printed = command.arg(model).assert().success();
        let path = folder.path().join(format!("{at}.json"));
        fs::write(path, &printed.get_output().stdout).unwrap();
    }
    fs::remove_file(mesh).unwrap();
    let (sound, text) = validate("properties", folder.path());
    assert!(sound && text.contains("4 reports"), "{text}");
    // A name that does not exist is no report.
    fs::write(folder.path().join("5.json"), "{\"volume\": 1}").unwrap();
    assert!(!validate("properties", folder.path()).0);
}
