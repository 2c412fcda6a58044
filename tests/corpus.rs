//! Real OpenSCAD dumps against the values that other programs computed for them, and what is said
//! about those that are refused.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use serde_json::Value;
use stages::convert_model;
use std::fs;
use subdiv::Rule;

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures");

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/third_party");

/// Meshes of the reference fell into slivers where surfaces touch; their bodies are not counted.
const SLIVERS: [&str; 1] = ["nopscadlib_rod_ends.csg"];

/// Bodies that touch themselves: joined there in the reference's meshes, apart in ours, or as the
/// rounding of the file's six digits has it.
const OTHER_GENUS: [&str; 3] = [
    "example017.csg",
    "module-recursion.csg",
    "rotate_extrude-touch-vertex.csg",
];

/// Compares all files of a folder that have a reference.
fn compare(folder: &str, count: usize) {
    let folder = format!("{FIXTURES}/{folder}");
    let text = fs::read_to_string(format!("{folder}/reference.json")).unwrap();
    let references: Value = serde_json::from_str(&text).unwrap();
    let references = references.as_object().unwrap();
    assert_eq!(references.len(), count);
    for (file, reference) in references {
        let source = fs::read_to_string(format!("{folder}/{file}")).unwrap();
        let number = |key: &str| reference[key].as_f64();
        let expected = number("volume").unwrap();
        let model = stages::read(&source);
        if expected == 0.0 {
            let converted = convert_model(&model, Rule::Tolerance(1.0));
            assert_eq!(converted.brep.facet_count(), 0, "{file}");
            continue;
        }
        let bounds: Vec<f64> = reference["bbox"]
            .as_array()
            .unwrap()
            .iter()
            .map(|x| x.as_f64().unwrap())
            .collect();
        let size = (0..3)
            .map(|a| bounds[a + 3] - bounds[a])
            .fold(0.0, f64::max);
        let tolerance = 1e-3 * size;
        let converted = convert_model(&model, Rule::Tolerance(tolerance));
        let properties = &converted.properties;

        // Every point of the mesh is within the tolerance of the true boundary: the volume is
        // within the area times that, and planes contribute nothing.
        let has_planes_only = reference["planes"].as_bool() == Some(true);
        let facets = if has_planes_only {
            0.0
        } else {
            1.1 * properties.area * tolerance
        };
        let allowed = number("volume_tol").unwrap() + facets;
        let difference = (properties.volume - expected).abs();
        assert!(difference <= allowed, "{file}: volume off by {difference}");

        let allowed = number("bbox_tol").unwrap() + tolerance;
        let found = [properties.bounds.min, properties.bounds.max];
        for axis in 0..3 {
            for (side, corner) in found.iter().enumerate() {
                let off = (corner[axis] - bounds[3 * side + axis]).abs();
                assert!(
                    off <= allowed,
                    "{file}: box off by {off} > {allowed}, axis {axis}, side {side}: {corner}"
                );
            }
        }
        if SLIVERS.contains(&file.as_str()) {
            continue;
        }
        let bodies = reference["bodies"].as_u64().unwrap();
        assert_eq!(converted.shells.solids.len() as u64, bodies, "{file}");
        if !OTHER_GENUS.contains(&file.as_str()) {
            // The reference sums genus over bodies as 1 − χ/2 of the whole.
            let Some(genus) = reference["genus"].as_i64() else {
                continue;
            };
            let shells = i64::try_from(converted.shells.shells.len()).unwrap();
            let found = converted.shells.genus().cast_signed() - shells + 1;
            assert_eq!(found, genus, "{file}");
        }
    }
}

#[test]
fn core_dumps_have_their_reference_values() {
    compare("third_party/openscad", 31);
}

#[test]
fn odd_dumps_are_what_openscad_makes_of_them() {
    compare("openscad", 40);
}

#[test]
fn other_dumps_have_their_reference_values() {
    compare("third_party/openscad_more", 25);
}

/// Every other dump is a sound solid, too.
#[test]
fn dumps_without_reference_convert() {
    let folder = format!("{FOLDER}/openscad_more");
    let text = fs::read_to_string(format!("{folder}/reference.json")).unwrap();
    let references: Value = serde_json::from_str(&text).unwrap();
    let mut count = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let is_dump = path.extension().is_some_and(|e| e == "csg");
        if is_dump && references.get(&name).is_none() {
            let source = fs::read_to_string(&path).unwrap();
            let converted = convert_model(&stages::read(&source), Rule::Tolerance(0.3));
            assert!(converted.properties.volume > 0.0, "{name}");
            count += 1;
        }
    }
    assert_eq!(count, 8);
}

/// What no solid can be made of is refused with its name, line and reason.
#[test]
fn refused_dumps_say_why() {
    for (file, expected) in [
        (
            "fill2-tests.csg",
            ":41:4: `text` needs a font: no fonts are read here",
        ),
        (
            "hull2-tests.csg",
            "the model is 2-D only: `circle` has no volume",
        ),
        (
            "minkowski2-tests.csg",
            "the model is 2-D only: `square` has no volume",
        ),
        (
            "polygon-tests.csg",
            "the model is 2-D only: `polygon` has no volume",
        ),
        ("roof.csg", ":1:1: `roof` is not supported"),
        (
            "surface-simple.csg",
            ":1:1: cannot read \"surface-simple.dat\"",
        ),
    ] {
        let source = fs::read_to_string(format!("{FOLDER}/openscad_refused/{file}")).unwrap();
        let options = io::read::ReadOptions::default();
        let refused = io::read::scad_csg::read(&source, file, &options);
        let told = refused.expect_err(file).as_slice()[0].to_string();
        assert!(told.contains(expected), "{told}");
    }
}

/// A Menger sponge of 221 cubes: where many planes crowd in a leaf, pieces must not fold over
/// each other. manifold3d's area of it, to all digits that the reference gives, is 130468.34.
#[test]
fn crowded_pieces_do_not_fold() {
    let source = fs::read_to_string(format!("{FOLDER}/openscad/example024.csg")).unwrap();
    let converted = convert_model(&stages::read(&source), Rule::Tolerance(0.1));
    let area = converted.properties.area;
    assert!((area - 130_468.34).abs() <= 0.005, "{area}");
}
