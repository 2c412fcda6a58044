//! Cones anywhere. Where its sheets meet in the apex nothing can be proved, but a cone is one body
//! with two faces and one edge all the same.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;
mod trees;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use rayon::prelude::*;
use std::f64::consts::PI;
use trees::{number, runner};

/// Height, radius, turns about the axes in degrees and place of a cone no flatter than 45° and no sharper than 11°.
fn cones(count: u64) -> Vec<(f64, f64, [f64; 3], [f64; 3])> {
    let mut runner = runner(1);
    let strategy = (
        0.2..3.0,
        0.2..1.0,
        [0.0..360.0, 0.0..360.0, 0.0..360.0],
        [-3.0..3.0, -3.0..3.0, -3.0..3.0],
    );
    (0..count)
        .map(|_| {
            let (h, slope, turns, place) = strategy.new_tree(&mut runner).unwrap().current();
            (h, h * slope, turns, place)
        })
        .collect()
}

#[test]
fn a_cone_is_one_body_wherever_it_stands() {
    let cones = cones(number("CSG2BREP_CONES", 200));
    cones.par_iter().for_each(|&(h, r, turns, place)| {
        let source = format!(
            "translate({place:?}) rotate({turns:?}) cylinder(h = {h:?}, r1 = {r:?}, r2 = 0);"
        );
        for part in [0.02, 0.004] {
            let tolerance = part * h.max(2.0 * r);
            let cone = stages::convert(&source, tolerance);
            assert_eq!(cone.shells.shells.len(), 1, "{source} at {tolerance}");
            assert_eq!(cone.shells.shells[0].genus, 0, "{source}");
            assert_eq!(cone.groups.faces.len(), 2, "{source} at {tolerance}");

            let volume = PI * r * r * h / 3.0;
            let [low, high] = cone.report.volume_interval.unwrap();
            assert!(low <= volume && volume <= high, "{source}: [{low}, {high}]");
            let layer = tolerance * cone.properties.area;
            let found = cone.properties.volume;
            assert!(
                (found - volume).abs() <= layer,
                "{source}: {found} {volume}"
            );
        }
    });
}
