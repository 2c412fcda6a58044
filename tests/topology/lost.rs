//! Nothing is lost: parts, holes and walls that are tiny against the whole are found by proof.

use crate::stages::convert_solid;
use crate::{Structure, settings};
use csg::{ModelBuilder, Node, NodeId, Polynomial, Shape, Solid, Transform};
use glam::DVec3;
use subdiv::Rule;

fn ball(model: &mut ModelBuilder, center: DVec3, radius: f64) -> NodeId {
    let ball = model.add(Node::Shape(Shape::sphere(radius).unwrap()));
    model.add(Node::Instance(
        Transform::translation(center).unwrap(),
        ball,
    ))
}

fn block(model: &mut ModelBuilder, min: DVec3, max: DVec3) -> NodeId {
    model.add(Node::Shape(Shape::block(min, max).unwrap()))
}

/// The genera of the shells of what is made, which must be proved with cells above `finest`.
fn proved(finest: f64, make: impl FnOnce(&mut ModelBuilder) -> Node) -> Vec<u64> {
    let mut model = ModelBuilder::new();
    let node = make(&mut model);
    let root = model.add(node);
    let solid = Solid::build(&model.finish(root), None).unwrap();
    let converted = convert_solid(solid, &settings(Rule::Topology { finest }));
    let uncertified = &converted.report.uncertified;
    assert_eq!(uncertified.first(), None);
    Structure::of(&converted).genera
}

/// 1e-5 of the size; near the big one, farther away, far away.
#[test]
fn a_tiny_ball_beside_a_big_one() {
    for gap in [1e-5, 1e-3, 0.7] {
        let genera = proved(1e-12, |model| {
            let big = ball(model, DVec3::ZERO, 1.0);
            let direction = DVec3::new(0.6, -0.37, 0.71).normalize();
            let tiny = ball(model, direction * (1.0 + 1e-5 + gap), 1e-5);
            Node::Union(vec![big, tiny])
        });
        assert_eq!(genera, [0, 0], "gap {gap}");
    }
}

#[test]
fn a_tiny_bubble_in_a_block() {
    let genera = proved(1e-9, |model| {
        let whole = block(model, -DVec3::ONE, DVec3::ONE);
        let bubble = ball(model, DVec3::new(0.31, -0.47, 0.117), 1e-5);
        Node::Difference(vec![whole, bubble])
    });
    assert_eq!(genera, [0, 0]);
}

#[test]
fn a_tiny_bore_through_a_plate() {
    let genera = proved(1e-8, |model| {
        let plate = block(
            model,
            DVec3::new(-1.0, -1.0, 0.0),
            DVec3::new(1.0, 1.0, 1e-3),
        );
        let bore = model.add(Node::Shape(Shape::cylinder(1e-5, -1.0, 1.0).unwrap()));
        let at = Transform::translation(DVec3::new(0.3, 0.2, 0.0)).unwrap();
        let bore = model.add(Node::Instance(at, bore));
        Node::Difference(vec![plate, bore])
    });
    assert_eq!(genera, [1]);
}

/// A tiny oval of one polynomial: (|x|² − 1)·(|x − c|² − r²) < 0 outside of the big ball is inside
/// of the tiny one.
#[test]
fn a_tiny_oval_of_a_quartic() {
    let (c, r) = (DVec3::new(1.3, 0.4, 0.2), 1e-4);
    let square = [([2, 0, 0], 1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0)];
    let mut big = square.to_vec();
    big.push(([0, 0, 0], -1.0));
    let mut tiny = square.to_vec();
    tiny.push(([1, 0, 0], -2.0 * c.x));
    tiny.push(([0, 1, 0], -2.0 * c.y));
    tiny.push(([0, 0, 1], -2.0 * c.z));
    tiny.push(([0, 0, 0], c.length_squared() - r * r));
    let product: Vec<_> = big
        .iter()
        .flat_map(|(a, x)| {
            tiny.iter()
                .map(move |(b, y)| ([a[0] + b[0], a[1] + b[1], a[2] + b[2]], x * y))
        })
        .collect();
    let genera = proved(1e-7, |_| {
        Node::Shape(Shape::Polynomial(
            Polynomial::from_terms(4, &product).unwrap(),
        ))
    });
    assert_eq!(genera, [0, 0]);
}

/// Walls between different primitives, 1e-9 of the size: a hollow ball, a slab, a wedge's edge.
#[test]
fn thin_walls() {
    let hollow = proved(1e-4, |model| {
        let outer = ball(model, DVec3::ZERO, 1.0);
        let inner = ball(model, DVec3::ZERO, 1.0 - 1e-9);
        Node::Difference(vec![outer, inner])
    });
    assert_eq!(hollow, [0, 0]);
    let slab = proved(1e-4, |model| {
        let (low, high) = (
            DVec3::new(-1.0, -0.7, 0.1),
            DVec3::new(0.8, 1.0, 0.1 + 1e-9),
        );
        let whole = block(model, low, high);
        let turn = Transform::rotation(DVec3::new(1.0, 2.0, 3.0), 0.7).unwrap();
        Node::Instance(turn, whole)
    });
    assert_eq!(slab, [0]);
    // Two bores along one axis leave a pipe's wall.
    let pipe = proved(1e-4, |model| {
        let outer = model.add(Node::Shape(Shape::cylinder(0.5, -1.0, 1.0).unwrap()));
        let inner = model.add(Node::Shape(Shape::cylinder(0.5 - 1e-9, -2.0, 2.0).unwrap()));
        Node::Difference(vec![outer, inner])
    });
    assert_eq!(pipe, [1]);
}

/// Balls apart by 1e-9 of their size are two, balls that overlap by as much are one.
#[test]
fn balls_that_nearly_touch() {
    for (gap, genera) in [(1e-9, vec![0, 0]), (-1e-9, vec![0])] {
        let found = proved(1e-9, |model| {
            let direction = DVec3::new(0.6, -0.37, 0.71).normalize();
            let left = ball(model, DVec3::ZERO, 0.5);
            let right = ball(model, direction * (1.0 + gap), 0.5);
            Node::Union(vec![left, right])
        });
        assert_eq!(found, genera, "gap {gap}");
    }
}

/// What cannot be proved is listed: a double cone through its apex.
#[test]
fn an_apex_is_listed() {
    let mut model = ModelBuilder::new();
    let cone = model.add(Node::Shape(Shape::frustum(0.0, 1.0, 0.0, 1.0).unwrap()));
    let solid = Solid::build(&model.finish(cone), None).unwrap();
    let finest = 1e-4;
    let report = convert_solid(solid, &settings(Rule::Topology { finest })).report;
    assert_eq!(report.proved_topology, Some(false));
    assert!(report.uncertified_leaves > 0 && report.uncertified_leaves < 100);
    for spot in &report.uncertified {
        assert!(spot.position.length() < 4.0 * finest && spot.size <= finest);
    }
}
