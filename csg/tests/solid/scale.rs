//! Very deep and very wide models.

use csg::{Error, ModelBuilder, Node, Shape, Solid, Transform};
use glam::DVec3;
use std::time::{Duration, Instant};

#[test]
fn nesting_100_000_deep_is_built_and_dropped() {
    let mut builder = ModelBuilder::new();
    let mut node = builder.add(Node::Shape(Shape::sphere(1.0).unwrap()));
    let there = Transform::translation(DVec3::X).unwrap();
    for level in 0..100_000_u32 {
        let other = builder.add(Node::Shape(
            Shape::sphere(1.0 + f64::from(level % 100)).unwrap(),
        ));
        node = match level % 4 {
            0 => builder.add(Node::Union(vec![node, other])),
            1 => builder.add(Node::Intersection(vec![other, node])),
            2 => builder.add(Node::Complement(node)),
            _ => builder.add(Node::Difference(vec![other, node])),
        };
        if level % 1000 == 0 {
            let back = there.inverse();
            node = builder.add(Node::Instance(there.clone(), node));
            node = builder.add(Node::Instance(back, node));
        }
    }
    let solid = Solid::build(&builder.finish(node), None).unwrap();
    assert!(solid.extent.is_finite());
    assert!(solid.primitives.len() <= 100);
    // The outermost operator takes something from the ball of radius 100.
    assert!(!solid.contains(DVec3::splat(100.0)));
}

#[test]
fn unary_nesting_100_000_deep_vanishes() {
    let mut builder = ModelBuilder::new();
    let mut node = builder.add(Node::Shape(Shape::sphere(1.0).unwrap()));
    let grey = builder.material(csg::Material {
        color: Some([0.5; 4]),
    });
    for level in 0..100_000 {
        node = builder.add(match level % 5 {
            0 => Node::Union(vec![node]),
            1 => Node::Instance(Transform::identity(), node),
            2 | 3 => Node::Complement(node),
            _ => Node::Painted(grey, node),
        });
    }
    let solid = Solid::build(&builder.finish(node), None).unwrap();
    assert_eq!(solid.formula.nodes().len(), 1);
}

#[test]
fn wide_unions_are_quick() {
    let mut builder = ModelBuilder::new();
    let ball = builder.add(Node::Shape(Shape::sphere(0.6).unwrap()));
    let children = (0..100_000_u32).map(|k| {
        let at = DVec3::new(
            f64::from(k % 100),
            f64::from(k / 100 % 100),
            f64::from(k / 10_000),
        );
        builder.add(Node::Instance(Transform::translation(at).unwrap(), ball))
    });
    let children = children.collect();
    let root = builder.add(Node::Union(children));
    let model = builder.finish(root);
    let start = Instant::now();
    let solid = Solid::build(&model, None).unwrap();
    // Half a second alone on a machine; the allowance is for a crowded one.
    assert!(
        start.elapsed() < Duration::from_secs(5),
        "{:?}",
        start.elapsed()
    );
    assert_eq!(solid.primitives.len(), 100_000);
    assert_eq!(solid.formula.nodes().len(), 100_001);
}

#[test]
fn a_grid_of_cubes_shares_its_planes() {
    let mut builder = ModelBuilder::new();
    let cube = builder.add(Node::Shape(Shape::block(DVec3::ZERO, DVec3::ONE).unwrap()));
    let children = (0..8000_u32).map(|k| {
        let at = DVec3::new(
            f64::from(k % 20),
            f64::from(k / 20 % 20),
            f64::from(k / 400),
        );
        builder.add(Node::Instance(
            Transform::translation(at * 0.7).unwrap(),
            cube,
        ))
    });
    let children = children.collect();
    let root = builder.add(Node::Union(children));
    let solid = Solid::build(&builder.finish(root), None).unwrap();
    // Each axis has planes at 0.7 k and at 0.7 k + 1, 0 ≤ k < 20, of which 10 coincide:
    // 0.7 j = 0.7 k + 1 has j − k = 10/7, never.
    assert_eq!(solid.primitives.len(), 120);
    assert!(solid.nearly_equal.is_empty());
}

#[test]
fn too_large_models_are_refused() {
    let mut builder = ModelBuilder::new();
    let mut node = builder.add(Node::Shape(Shape::sphere(1.0).unwrap()));
    for _ in 0..40 {
        node = builder.add(Node::Union(vec![node, node]));
    }
    let refused = Solid::build(&builder.finish(node), None).unwrap_err();
    assert!(matches!(refused, Error::TooManyLiterals { .. }));
}
