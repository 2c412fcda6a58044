//! Every model in `fixtures/`, in every mesh format: closed in manifold3d's eyes, without
//! self-intersections in CGAL's, and the same bytes for any number of threads.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;
mod support;

use io::write::{gltf, obj, stl};
use stages::{Converted, convert_solid, models, read};
use std::fs;
use std::path::Path;
use subdiv::{Rule, Settings};

/// Converts at a tolerance of 1 % of the diagonal.
fn convert_file(path: &Path, threads: usize) -> Converted {
    let model = read(&fs::read_to_string(path).unwrap());
    let solid = csg::Solid::build(&model, None).unwrap();
    let tolerance = if solid.extent.is_empty() {
        1.0
    } else {
        0.01 * solid.extent.diagonal()
    };
    let settings = Settings {
        threads: Some(threads),
        ..Settings::new(Rule::Tolerance(tolerance))
    };
    convert_solid(solid, &settings)
}

fn files(converted: &Converted) -> [(&'static str, Vec<u8>); 3] {
    let brep = &converted.brep;
    let materials = &converted.solid.materials;
    let mut bytes = [Vec::new(), Vec::new(), Vec::new()];
    obj::write(brep, &obj::Options::default(), &mut bytes[0]).unwrap();
    gltf::write(brep, materials, &gltf::Options::default(), &mut bytes[1]).unwrap();
    stl::write(brep, &mut bytes[2]).unwrap();
    let [obj, glb, stl] = bytes;
    [("obj", obj), ("glb", glb), ("stl", stl)]
}

#[test]
fn every_fixture_is_manifold() {
    let folder = tempfile::tempdir().unwrap();
    let mut paths = Vec::new();
    for model in models() {
        let converted = convert_file(&model, 2);
        let name = model.file_stem().unwrap().to_string_lossy().into_owned();
        if converted.brep.is_empty() {
            assert!(name.starts_with("nullspace"), "{name} is empty");
            continue;
        }
        for (end, bytes) in files(&converted) {
            // STL has no indices for manifold3d to judge.
            if end != "stl" {
                let path = folder.path().join(format!("{name}.{end}"));
                fs::write(&path, bytes).unwrap();
                paths.push(path);
            }
        }
    }
    assert!(paths.len() >= 70, "{} files", paths.len());
    for (path, report) in paths.iter().zip(support::manifold_report(&paths)) {
        assert_eq!(report.status, "NoError", "{}", path.display());
    }
    paths.retain(|path| path.extension().is_some_and(|end| end == "obj"));
    for report in support::intersection_report(&paths) {
        assert_eq!(report.crossings, 0, "{report:?}");
    }
}

/// The check sees what it is made for: two cubes, one moved into the other, as one file.
#[test]
fn crossing_triangles_are_found() {
    let cube = convert_solid(
        csg::Solid::build(&read("cube(1);"), None).unwrap(),
        &Settings::new(Rule::Tolerance(0.1)),
    );
    let mut text = String::from_utf8(files(&cube)[0].1.clone()).unwrap();
    let count = text.lines().filter(|line| line.starts_with("v ")).count();
    let moved: Vec<String> = text
        .lines()
        .filter(|line| line.starts_with("v ") || line.starts_with("f "))
        .map(|line| {
            let mut words = line.split(' ');
            let kind = words.next().unwrap();
            let words = words.map(|word| {
                if kind == "v" {
                    (word.parse::<f64>().unwrap() * 0.5 + 0.25 + f64::from(u8::from(word == "1")))
                        .to_string()
                } else {
                    let index = word.split('/').next().unwrap();
                    (index.parse::<usize>().unwrap() + count).to_string()
                }
            });
            format!("{kind} {}", words.collect::<Vec<_>>().join(" "))
        })
        .collect();
    text.push_str(&moved.join("\n"));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("crossing.obj");
    fs::write(&path, text).unwrap();
    let report = &support::intersection_report(&[path])[0];
    assert!(report.crossings > 0 && report.depth > 0.1, "{report:?}");
}

#[test]
fn bytes_do_not_depend_on_threads() {
    for name in ["solids/S2_demo", "solids/S5_ring128", "models/tee"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("fixtures/{name}.csg"));
        let expected = files(&convert_file(&path, 1));
        for threads in [2, 7] {
            let found = files(&convert_file(&path, threads));
            for ((end, a), (_, b)) in expected.iter().zip(&found) {
                assert!(a == b, "{name}.{end} differs with {threads} threads");
            }
        }
    }
}
