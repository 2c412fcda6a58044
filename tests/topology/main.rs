//! The topological rule: against exact topology, against the metric rule, and against itself in
//! other positions of the domain.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod agreement;
mod lost;
mod polynomials;
#[path = "../stages/mod.rs"]
mod stages;
#[path = "../trees/mod.rs"]
mod trees;

use agreement::{Verdict, compare};
use csg::Solid;
use rayon::prelude::*;
use stages::{Converted, convert_solid, read};
use std::collections::BTreeMap;
use subdiv::{Rule, Settings};
use trees::{Setting, number, trees};

/// What conversions of one solid must agree on.
#[derive(Clone, PartialEq, Eq, Debug)]
struct Structure {
    /// Genus of each shell, ascending.
    genera: Vec<u64>,
    /// Number of faces on each primitive.
    patches: BTreeMap<u32, usize>,
    edges: usize,
    vertices: usize,
}

impl Structure {
    fn of(converted: &Converted) -> Self {
        let mut genera: Vec<u64> = converted.shells.shells.iter().map(|s| s.genus).collect();
        genera.sort_unstable();
        let mut patches = BTreeMap::new();
        for face in &converted.groups.faces {
            *patches.entry(face.primitive.0).or_default() += 1;
        }
        Self {
            genera,
            patches,
            edges: converted.groups.edges.len(),
            vertices: converted.groups.vertices.len(),
        }
    }
}

/// Settings for one thread.
fn settings(rule: Rule) -> Settings {
    Settings {
        threads: Some(1),
        ..Settings::new(rule)
    }
}

/// By the topological rule; `finest`, as `tolerance` below, is a fraction of the diagonal.
fn topology(solid: Solid, finest: f64) -> Converted {
    let finest = finest * solid.extent.diagonal();
    convert_solid(solid, &settings(Rule::Topology { finest }))
}

fn metric(solid: Solid, tolerance: f64) -> Converted {
    let tolerance = tolerance * solid.extent.diagonal();
    convert_solid(solid, &settings(Rule::Tolerance(tolerance)))
}

fn fixture(name: &str) -> Solid {
    let source = std::fs::read_to_string(format!("fixtures/solids/{name}.csg")).unwrap();
    Solid::build(&read(&source), None).unwrap()
}

/// Genera by hand: three crossing bores through a cube make a body of genus 5; the ring of balls
/// is a torus; each hole of the plate is a handle.
#[test]
fn known_solids_are_proved() {
    let expected: [(&str, Vec<u64>); 6] = [
        ("S1_sphere", vec![0]),
        ("S2_demo", vec![5]),
        ("S3_torus_sphere", vec![0, 1]),
        ("S4_64_spheres", vec![0; 64]),
        ("S5_ring128", vec![1]),
        ("S6_plate64", vec![64]),
    ];
    for (name, genera) in expected {
        let coarse = topology(fixture(name), 1e-6);
        assert_eq!(coarse.report.proved_topology, Some(true), "{name}");
        let structure = Structure::of(&coarse);
        assert_eq!(structure.genera, genera, "{name}");
        let fine = metric(fixture(name), 2e-3);
        assert_eq!(structure, Structure::of(&fine), "{name}");
        let (few, many) = (coarse.report.leaves, fine.report.leaves);
        println!("{name}: {few} leaves, by the metric rule {many}");
    }
}

fn compare_trees(count: u64, seed: u64, setting: Setting, finest: f64) -> Vec<Verdict> {
    trees(count, seed, setting)
        .par_iter()
        .enumerate()
        .map(|(at, (tree, model))| compare(model, finest, &|| format!("tree {at}: {tree:?}")))
        .collect()
}

fn seed() -> u64 {
    number("CSG2BREP_SEED", 0)
}

/// 200 trees in general position in four positions of the domain each.
///
/// `CSG2BREP_TREES=2000 CSG2BREP_SEED=1 cargo test --release --test topology` runs others.
#[test]
fn random_trees_agree_in_every_position() {
    let (count, seed) = (number("CSG2BREP_TREES", 200), seed());
    let verdicts = compare_trees(count, seed, Setting::General, 1e-5);
    println!("trees, seed {seed}: {}", Verdict::summary(&verdicts));
    assert!(verdicts.iter().all(|v| v.certified));
    let compared = verdicts.iter().filter(|v| v.metric.is_some()).count();
    assert!(compared as u64 * 10 > count * 8, "{compared}");
}

/// On the grid surfaces touch and planes meet in one point, which is never proved; where nothing
/// of that is on the boundary, all must agree, too.
#[test]
fn random_trees_on_the_grid_agree_where_they_are_proved() {
    let (count, seed) = (number("CSG2BREP_TREES", 60), seed());
    let verdicts = compare_trees(count, seed, Setting::Grid, 1e-2);
    println!(
        "trees on the grid, seed {seed}: {}",
        Verdict::summary(&verdicts)
    );
    assert!(verdicts.iter().filter(|v| v.metric.is_some()).count() as u64 * 5 > count);
}
