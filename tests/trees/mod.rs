//! Random CSG trees with deliberately coincident, tangent and XOR-like parts.

#![allow(dead_code, reason = "each test uses its own part")]

pub(crate) mod membership;

use csg::{Model, ModelBuilder, Node, NodeId, Shape, Transform};
use glam::DVec3;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};

/// Where the parts sit.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Setting {
    /// On a coarse grid, so that faces coincide and surfaces touch; a third is displaced.
    Grid,
    /// Anywhere: nothing coincides or touches but by chance.
    General,
}

/// This many trees with their models, the same for the same seed.
pub(crate) fn trees(count: u64, seed: u64, setting: Setting) -> Vec<(Tree, Model)> {
    let mut runner = runner(seed);
    (0..count)
        .map(|_| {
            let tree = tree(setting).new_tree(&mut runner).unwrap().current();
            let mut model = ModelBuilder::new();
            let root = add(&mut model, &tree);
            (tree, model.finish(root))
        })
        .collect()
}

/// Makes the same choices for the same seed.
pub(crate) fn runner(seed: u64) -> TestRunner {
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &bytes);
    TestRunner::new_with_rng(ProptestConfig::default(), rng)
}

/// The number in an environment variable.
pub(crate) fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().expect("a number"))
}

/// A solid whose parts sit on a coarse grid, so that faces coincide and surfaces touch.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Leaf(Part, Placement),
    Union(Vec<Tree>),
    Intersection(Vec<Tree>),
    Difference(Vec<Tree>),
    Xor(Box<Tree>, Box<Tree>),
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Part {
    Block,
    Ball(f64),
    Cylinder(f64),
    Cone(f64, f64),
    Torus,
    Prism(u32),
    /// Cut by x + y = offset·√2.
    HalfSpaceInBox(f64),
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    quarter_turns: [u8; 3],
    mirrored: bool,
    offset: [i8; 3],
    jitter: [f64; 3],
    /// Angle by which it is turned around an oblique axis.
    turn_rad: f64,
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
        1 => Just(Part::HalfSpaceInBox(0.0)),
    ]
}

fn grid_placement() -> impl Strategy<Value = Placement> {
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
            turn_rad: 0.0,
        })
}

fn general_placement() -> impl Strategy<Value = Placement> {
    let jitter = proptest::array::uniform3(-0.25..0.25f64);
    (grid_placement(), jitter, 0.05..1.5f64).prop_map(|(grid, jitter, turn_rad)| Placement {
        jitter,
        turn_rad,
        ..grid
    })
}

fn placement(setting: Setting) -> BoxedStrategy<Placement> {
    match setting {
        Setting::Grid => grid_placement().boxed(),
        Setting::General => general_placement().boxed(),
    }
}

fn tree(setting: Setting) -> impl Strategy<Value = Tree> {
    // An apex, or a plane through two edges of a block, is degenerate by itself.
    let suited = move |part| match part {
        Part::Cone(a, b) if setting == Setting::General => Part::Cone(a.max(0.3), b),
        Part::HalfSpaceInBox(_) if setting == Setting::General => Part::HalfSpaceInBox(0.3),
        part => part,
    };
    let leaf = (part().prop_map(suited), placement(setting))
        .prop_map(|(part, placement)| Tree::Leaf(part, placement));
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
        Part::HalfSpaceInBox(offset) => {
            let half = Shape::half_space(DVec3::new(1.0, 1.0, 0.0), offset).unwrap();
            let half = model.add(Node::Shape(half));
            let block = model.add(Node::Shape(Shape::block(-two, two).unwrap()));
            return model.add(Node::Intersection(vec![half, block]));
        }
    };
    model.add(Node::Shape(shape.unwrap()))
}

impl Placement {
    /// Where the axes and the origin go; the axes stay orthonormal.
    fn frame(&self) -> ([DVec3; 3], DVec3) {
        // Quarter turns and a mirror as exact signed permutations.
        let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
        for (axis, turns) in self.quarter_turns.into_iter().enumerate() {
            for _ in 0..turns {
                let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
                (columns[b], columns[c]) = (columns[c], -columns[b]);
            }
        }
        if self.mirrored {
            columns[0] = -columns[0];
        }
        if self.turn_rad != 0.0 {
            let axis = DVec3::new(1.0, 2.0, 3.0).normalize();
            let turn = glam::DQuat::from_axis_angle(axis, self.turn_rad);
            columns = columns.map(|column| turn * column);
        }
        let at = [0, 1, 2].map(|a| f64::from(self.offset[a]) * 0.5 + self.jitter[a]);
        (columns, DVec3::from(at))
    }
}

fn place(model: &mut ModelBuilder, node: NodeId, placement: Placement) -> NodeId {
    let ([x, y, z], at) = placement.frame();
    let matrix = [
        [x.x, y.x, z.x, at.x],
        [x.y, y.y, z.y, at.y],
        [x.z, y.z, z.z, at.z],
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
