//! Real OpenSCAD dumps against the values that other programs computed for them.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use serde_json::Value;
use stages::convert_model;
use std::fs;
use subdiv::Rule;

const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/third_party/openscad");

#[test]
fn core_dumps_have_their_reference_values() {
    let text = fs::read_to_string(format!("{FOLDER}/reference.json")).unwrap();
    let references: Value = serde_json::from_str(&text).unwrap();
    let references = references.as_object().unwrap();
    assert_eq!(references.len(), 31);
    let mut compared = 0;
    for (file, reference) in references {
        let source = fs::read_to_string(format!("{FOLDER}/{file}")).unwrap();
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
        let allowed = number("volume_tol").unwrap() + 1.1 * properties.area * tolerance;
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
        let bodies = reference["bodies"].as_u64().unwrap();
        assert_eq!(converted.shells.solids.len() as u64, bodies, "{file}");
        // Where surfaces only touch, rounding of the file's six digits decides how many handles
        // there are; everywhere else the topology is the reference's, which sums genus over
        // bodies as 1 − χ/2 of the whole.
        if converted.report.uncertified_leaves == 0 {
            let genus = reference["genus"].as_i64().unwrap();
            let shells = i64::try_from(converted.shells.shells.len()).unwrap();
            assert_eq!(
                converted.shells.genus().cast_signed() - shells + 1,
                genus,
                "{file}"
            );
            compared += 1;
        }
    }
    assert!(compared >= 20, "genus compared for {compared} files only");
}

/// A Menger sponge of 221 cubes: where many planes crowd in a leaf, pieces must not fold over
/// each other. manifold3d's area of it, to all digits that the reference gives, is 130468.34.
#[test]
fn crowded_pieces_do_not_fold() {
    let source = fs::read_to_string(format!("{FOLDER}/example024.csg")).unwrap();
    let converted = convert_model(&stages::read(&source), Rule::Tolerance(0.1));
    let area = converted.properties.area;
    assert!((area - 130_468.34).abs() <= 0.005, "{area}");
}
