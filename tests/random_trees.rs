//! Random CSG trees (`tests/trees/`): every one must come out as a closed, oriented 2-manifold, in
//! our own validation and in manifold3d's, with the volume that counting random points gives.
//!
//! `CSG2BREP_TREES=10000 CSG2BREP_SEED=1 cargo test --release --test random_trees` runs others
//! than the 1,000 of a normal test run; `docs/reliability.md` lists what has been run.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod support;
mod trees;

use brep::{Brep, Valid};
use glam::DVec3;
use proptest::prelude::RngExt as _;
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;
use subdiv::{Rule, Settings};
use trees::membership::contains;
use trees::{Setting, Tree, number, runner, trees};

/// The largest proved distance between mesh and boundary.
const TOLERANCE: f64 = 0.05;

/// Counts random points of the solid's box that the tree holds.
///
/// The mesh is within the tolerance of the boundary: volumes differ by at most area · tolerance
/// over curved faces. The count is binomial: 5 standard deviations, one in 1.7 million.
fn check_volume(at: usize, tree: &Tree, solid: &csg::Solid, volume: f64, brep: &Valid<Brep>) {
    const POINTS: u32 = 4000;
    let (min, size) = if solid.extent.is_empty() {
        (DVec3::splat(-3.0), DVec3::splat(6.0))
    } else {
        (solid.extent.min, solid.extent.max - solid.extent.min)
    };
    let mut rng = runner(at as u64).new_rng();
    let mut inside = 0;
    for _ in 0..POINTS {
        let point = DVec3::from([0; 3].map(|_: u8| rng.random::<f64>())) * size + min;
        inside += u32::from(contains(tree, point));
    }
    let curved = |p: csg::PrimitiveId| solid.primitives[p.0 as usize].polynomial.degree() > 1;
    let area: f64 = brep
        .facets()
        .filter(|facet| curved(facet.primitive()))
        .map(|facet| 0.5 * facet.area_vector().length())
        .sum();
    let share = f64::from(inside) / f64::from(POINTS);
    let cube = size.element_product();
    // Of a share of zero or one the deviation is that of a single point.
    let spread = (share * (1.0 - share)).max(1.0 / f64::from(POINTS));
    let deviation = cube * (spread / f64::from(POINTS)).sqrt();
    let difference = (volume - share * cube).abs();
    let allowed = 5.0 * deviation + 1.05 * area * TOLERANCE;
    assert!(
        difference <= allowed,
        "tree {at}: volume {volume}, {} by points, more than {allowed} apart\n{tree:?}",
        share * cube
    );
}

#[test]
fn random_trees_are_manifold() {
    let (count, seed) = (number("CSG2BREP_TREES", 1000), number("CSG2BREP_SEED", 0));
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
                ..Settings::new(Rule::Tolerance(TOLERANCE))
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
            let volume = if brep.is_empty() {
                0.0
            } else {
                brep::Properties::of(&brep).volume
            };
            check_volume(at, tree, &solid, volume, &brep);
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
        let sample: Vec<&PathBuf> = chunk.iter().step_by(8).collect();
        for report in support::intersection_report(&sample) {
            assert_eq!(report.crossings, 0, "{report:?}");
        }
        for path in chunk {
            fs::remove_file(path).unwrap();
        }
    }
}
