//! Random CSG trees (`tests/trees/`): every one must come out as a closed, oriented 2-manifold, in
//! our own validation and in manifold3d's.
//!
//! `CSG2BREP_TREES=10000 CSG2BREP_SEED=1 cargo test --release --test random_trees` runs others
//! than the 500 of a normal test run; `docs/reliability.md` lists what has been run.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;
mod trees;

use rayon::prelude::*;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;
use subdiv::{Rule, Settings};
use trees::{Setting, number, trees};

#[test]
fn random_trees_are_manifold() {
    let (count, seed) = (number("CSG2BREP_TREES", 500), number("CSG2BREP_SEED", 0));
    let models = trees(count, seed, Setting::Grid);

    let folder = tempfile::tempdir().unwrap();
    let results: Vec<(Option<PathBuf>, u64)> = models
        .par_iter()
        .enumerate()
        .map(|(at, (tree, model))| {
            let solid = csg::Solid::build(model, None)
                .unwrap_or_else(|error| panic!("tree {at}: {error}\n{tree:?}"));
            let settings = Settings {
                max_level: Some(24),
                threads: Some(1),
                ..Settings::new(Rule::Tolerance(0.05))
            };
            let (fragments, report) = if solid.primitives.is_empty() {
                Default::default()
            } else {
                let outcome = subdiv::convert(&solid, &settings, &()).unwrap();
                (outcome.fragments, outcome.report)
            };
            let brep = brep::stitch(&fragments)
                .unwrap_or_else(|error| panic!("tree {at}: {error}\n{tree:?}"))
                .validate()
                .unwrap_or_else(|defects| panic!("tree {at}: {defects}\n{tree:?}"));
            if brep.is_empty() {
                return (None, 0);
            }
            let path = folder.path().join(format!("{at}.obj"));
            let mut file = BufWriter::new(File::create(&path).unwrap());
            io::write::obj::write(&brep, &io::write::obj::Options::default(), &mut file).unwrap();
            (Some(path), report.split_vertices)
        })
        .collect();

    let split = results.iter().filter(|r| r.1 > 0).count();
    let paths: Vec<PathBuf> = results.into_iter().filter_map(|r| r.0).collect();
    // The generator must reach what it is made for.
    assert!(paths.len() as u64 * 2 > count, "mostly empty solids");
    assert!(
        split as u64 * 50 > count,
        "too few touching solids: {split}"
    );
    println!(
        "{count} trees, seed {seed}: {} not empty, {split} touch",
        paths.len()
    );
    for chunk in paths.chunks(500) {
        let reports = support::manifold_report(chunk);
        for (path, report) in chunk.iter().zip(&reports) {
            assert_eq!(report.status, "NoError", "{}", path.display());
        }
        // Exact arithmetic on all of them would take most of the test's time.
        let sample: Vec<&PathBuf> = chunk.iter().step_by(4).collect();
        for report in support::intersection_report(&sample) {
            assert_eq!(report.crossings, 0, "{report:?}");
        }
        for path in chunk {
            fs::remove_file(path).unwrap();
        }
    }
}
