//! Random CSG trees with deliberately coincident, tangent and XOR-like parts: every one must
//! come out as a closed, oriented 2-manifold, in our own validation and in manifold3d's.
//!
//! `CSG2BREP_TREES=10000 CSG2BREP_SEED=1 cargo test --release --test random_trees` runs others
//! than the 500 of a normal test run; `docs/reliability.md` lists what has been run.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;
mod support;

use csg::{Model, ModelBuilder, Node, NodeId, Shape, Transform};
use glam::DVec3;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use rayon::prelude::*;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;
use subdiv::{Rule, Settings};

/// A solid whose parts sit on a coarse grid, so that faces coincide and surfaces touch.
#[derive(Clone, Debug)]
enum Tree {
    Leaf(Part, Placement),
    Union(Vec<Tree>),
    Intersection(Vec<Tree>),
    Difference(Vec<Tree>),
    Xor(Box<Tree>, Box<Tree>),
}

#[derive(Clone, Copy, Debug)]
enum Part {
    Block,
    Ball(f64),
    Cylinder(f64),
    Cone(f64, f64),
    Torus,
    Prism(u32),
    HalfSpaceInBox,
}

#[derive(Clone, Copy, Debug)]
struct Placement {
    quarter_turns: [u8; 3],
    mirrored: bool,
    offset: [i8; 3],
    jitter: [f64; 3],
}

fn part() -> impl Strategy<Value = Part> {
    let radius = prop_oneof![Just(0.5), Just(1.0), 0.3..1.2f64];
    prop_oneof![
        4 => Just(Part::Block),
        3 => radius.prop_map(Part::Ball),
        3 => prop_oneof![Just(0.5), Just(1.0)].prop_map(Part::Cylinder),
        1 => (prop_oneof![Just(0.0), Just(0.5)], Just(1.0)).prop_map(|(a, b)| Part::Cone(a, b)),
        1 => Just(Part::Torus),
        1 => (3u32..9).prop_map(Part::Prism),
        1 => Just(Part::HalfSpaceInBox),
    ]
}

fn placement() -> impl Strategy<Value = Placement> {
    let jitter = prop_oneof![
        5 => Just([0.0; 3]),
        1 => proptest::array::uniform3(-0.3..0.3f64),
        1 => proptest::array::uniform3(-1e-9..1e-9f64),
    ];
    (
        proptest::array::uniform3(0u8..4),
        any::<bool>(),
        proptest::array::uniform3(-2i8..=2),
        jitter,
    )
        .prop_map(|(quarter_turns, mirrored, offset, jitter)| Placement {
            quarter_turns,
            mirrored,
            offset,
            jitter,
        })
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = (part(), placement()).prop_map(|(part, placement)| Tree::Leaf(part, placement));
    leaf.prop_recursive(4, 12, 3, |inner| {
        let several = || proptest::collection::vec(inner.clone(), 2..4);
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            3 => several().prop_map(Tree::Union),
            2 => several().prop_map(Tree::Intersection),
            3 => several().prop_map(Tree::Difference),
            2 => pair.prop_map(|(a, b)| Tree::Xor(Box::new(a), Box::new(b))),
        ]
    })
}

fn add_part(model: &mut ModelBuilder, part: Part) -> NodeId {
    let two = DVec3::splat(1.0);
    let shape = match part {
        Part::Block => Shape::block(-two, two),
        Part::Ball(radius) => Shape::sphere(radius),
        Part::Cylinder(radius) => Shape::cylinder(radius, -1.0, 1.0),
        Part::Cone(r0, r1) => Shape::frustum(r0, r1, -1.0, 1.0),
        Part::Torus => Shape::torus(1.0, 0.5),
        Part::Prism(sides) => Shape::prism(sides, 1.0, 1.0, -1.0, 1.0),
        Part::HalfSpaceInBox => {
            let half = Shape::half_space(DVec3::new(1.0, 1.0, 0.0), 0.0).unwrap();
            let half = model.add(Node::Shape(half));
            let block = model.add(Node::Shape(Shape::block(-two, two).unwrap()));
            return model.add(Node::Intersection(vec![half, block]));
        }
    };
    model.add(Node::Shape(shape.unwrap()))
}

fn place(model: &mut ModelBuilder, node: NodeId, placement: Placement) -> NodeId {
    // Quarter turns and a mirror as exact signed permutations.
    let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
    for (axis, turns) in placement.quarter_turns.into_iter().enumerate() {
        for _ in 0..turns {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            (columns[b], columns[c]) = (columns[c], -columns[b]);
        }
    }
    if placement.mirrored {
        columns[0] = -columns[0];
    }
    let [x, y, z] = columns;
    let at = [0, 1, 2].map(|a| f64::from(placement.offset[a]) * 0.5 + placement.jitter[a]);
    let matrix = [
        [x.x, y.x, z.x, at[0]],
        [x.y, y.y, z.y, at[1]],
        [x.z, y.z, z.z, at[2]],
        [0.0, 0.0, 0.0, 1.0],
    ];
    model.add(Node::Instance(
        Transform::from_columns(&matrix).unwrap(),
        node,
    ))
}

/// Depth is at most four by construction of the strategy.
fn add(model: &mut ModelBuilder, tree: &Tree) -> NodeId {
    let all = |model: &mut ModelBuilder, children: &[Tree]| {
        children.iter().map(|c| add(model, c)).collect::<Vec<_>>()
    };
    match tree {
        Tree::Leaf(part, placement) => {
            let node = add_part(model, *part);
            place(model, node, *placement)
        }
        Tree::Union(children) => {
            let children = all(model, children);
            model.add(Node::Union(children))
        }
        Tree::Intersection(children) => {
            let children = all(model, children);
            model.add(Node::Intersection(children))
        }
        Tree::Difference(children) => {
            let children = all(model, children);
            model.add(Node::Difference(children))
        }
        Tree::Xor(a, b) => {
            let (a, b) = (add(model, a), add(model, b));
            let left = model.add(Node::Difference(vec![a, b]));
            let right = model.add(Node::Difference(vec![b, a]));
            model.add(Node::Union(vec![left, right]))
        }
    }
}

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
}

#[test]
fn random_trees_are_manifold() {
    let (count, seed) = (number("CSG2BREP_TREES", 500), number("CSG2BREP_SEED", 0));
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let models: Vec<(Tree, Model)> = (0..count)
        .map(|_| {
            let tree = tree().new_tree(&mut runner).unwrap().current();
            let mut model = ModelBuilder::new();
            let root = add(&mut model, &tree);
            (tree, model.finish(root))
        })
        .collect();

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
            fs::remove_file(path).unwrap();
        }
    }
}
