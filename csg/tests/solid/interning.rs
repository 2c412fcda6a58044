//! Which half-spaces become one primitive, and how formulas simplify.

use crate::oracle::{self, Tree, affine, bounded_shape, tree};
use csg::{
    Aabb, Formula, FormulaNode, Material, MaterialId, Model, ModelBuilder, Node, NodeId, Sense,
    Shape, Solid, Transform,
};
use glam::DVec3;
use proptest::prelude::*;

fn built(add: impl FnOnce(&mut ModelBuilder) -> NodeId) -> Solid {
    Solid::build(&model(add), None).unwrap()
}

fn model(add: impl FnOnce(&mut ModelBuilder) -> NodeId) -> Model {
    let mut builder = ModelBuilder::new();
    let root = add(&mut builder);
    builder.finish(root)
}

fn cube(builder: &mut ModelBuilder, min: DVec3, max: DVec3) -> NodeId {
    builder.add(Node::Shape(Shape::block(min, max).unwrap()))
}

fn moved(builder: &mut ModelBuilder, transform: Transform, child: NodeId) -> NodeId {
    builder.add(Node::Instance(transform, child))
}

fn assert_empty(solid: &Solid) {
    assert_eq!(solid.formula.nodes(), [FormulaNode::Union { len: 0 }]);
    assert!(solid.primitives.is_empty());
    assert_eq!(solid.extent, Aabb::EMPTY);
}

/// Kinds of nodes with their number of nodes below, literals as −1.
fn outline(formula: &Formula) -> Vec<(char, i64)> {
    let kind = |node: &FormulaNode| match node {
        FormulaNode::Union { len } => ('u', i64::from(*len)),
        FormulaNode::Intersection { len } => ('n', i64::from(*len)),
        FormulaNode::Literal(_) => ('l', -1),
    };
    formula.nodes().iter().map(kind).collect()
}

#[test]
fn neighbouring_cubes_share_planes() {
    let solid = built(|b| {
        let left = cube(b, DVec3::ZERO, DVec3::ONE);
        let right = cube(b, DVec3::X, DVec3::new(2.0, 1.0, 1.0));
        b.add(Node::Union(vec![left, right]))
    });
    // x = 0, 1, 2 and y, z = 0, 1.
    assert_eq!(solid.primitives.len(), 7);
    assert!(solid.nearly_equal.is_empty());
    // x ≤ 1 of the left cube and x ≥ 1 of the right one are opposite senses of one primitive.
    let sides: Vec<_> = solid
        .formula
        .nodes()
        .iter()
        .filter_map(|node| match node {
            FormulaNode::Literal(l) if l.primitive.0 == 1 => Some(l.sense),
            _ => None,
        })
        .collect();
    assert_eq!(sides, [Sense::Inside, Sense::Outside]);
}

#[test]
fn planes_written_differently_are_one() {
    let third = 1.0 / 3.0;
    let solid = built(|b| {
        let written = cube(b, DVec3::splat(0.1), DVec3::splat(2.1));
        let unit = cube(b, DVec3::ZERO, DVec3::ONE);
        let scaled = moved(b, Transform::scale(DVec3::splat(2.0)).unwrap(), unit);
        let shifted = moved(
            b,
            Transform::translation(DVec3::splat(0.1)).unwrap(),
            scaled,
        );
        let small = cube(b, DVec3::ZERO, DVec3::splat(third));
        let large = moved(b, Transform::scale(DVec3::splat(6.0)).unwrap(), small);
        let thirds = (0..3).fold(large, |node, _| {
            moved(
                b,
                Transform::translation(DVec3::splat(0.1 * third)).unwrap(),
                node,
            )
        });
        let quarter = Transform::rotation(DVec3::Z, std::f64::consts::FRAC_PI_2).unwrap();
        let turned = (0..4).fold(thirds, |node, _| moved(b, quarter.clone(), node));
        b.add(Node::Union(vec![written, shifted, turned]))
    });
    assert_eq!(solid.primitives.len(), 6);
    assert!(solid.primitives.iter().all(|p| p.coefficient_error < 1e-13));
}

#[test]
fn cylinders_and_spheres_written_differently_are_one() {
    let solid = built(|b| {
        let ball = b.add(Node::Shape(Shape::sphere(2.0).unwrap()));
        let unit = b.add(Node::Shape(Shape::sphere(1.0).unwrap()));
        let mirrored = moved(
            b,
            Transform::scale(DVec3::new(-2.0, 2.0, 2.0)).unwrap(),
            unit,
        );
        let turn = Transform::rotation(DVec3::new(1.0, 2.0, 3.0), 0.7).unwrap();
        let turned = moved(b, turn, ball);
        let m = [
            [-1.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 0.0],
            [0.0, 0.0, -1.0, 0.0],
            [0.0, 0.0, 0.0, 4.0],
        ];
        let outside = b.add(Node::Shape(Shape::quadric(&m).unwrap()));
        let inside = b.add(Node::Complement(outside));
        b.add(Node::Union(vec![ball, mirrored, turned, inside]))
    });
    assert_eq!(solid.primitives.len(), 1);
    assert_eq!(solid.formula.nodes().len(), 1);
}

#[test]
fn planes_within_the_tolerance_are_one() {
    let solid = built(|b| {
        let one = cube(b, DVec3::ZERO, DVec3::ONE);
        let other = cube(b, DVec3::ZERO, DVec3::splat(1.0 + 5e-13));
        b.add(Node::Union(vec![one, other]))
    });
    assert_eq!(solid.primitives.len(), 6);
    // What was merged counts as an error of the coefficients.
    let errors = solid.primitives.iter().map(|p| p.coefficient_error);
    assert!(errors.fold(0.0, f64::max) > 1e-13);
}

#[test]
fn a_matrix_and_its_negative_are_the_same_map() {
    let there = Transform::translation(DVec3::new(3.0, -2.0, 5.0)).unwrap();
    let negative = there.to_rows().map(|row| row.map(|entry| -entry));
    let negative = Transform::from_rows(&negative).unwrap();
    let solid = built(|b| {
        let shape = cube(b, -DVec3::ONE, DVec3::ONE);
        let one = moved(b, there, shape);
        let other = moved(b, negative, shape);
        b.add(Node::Intersection(vec![one, other]))
    });
    assert_eq!(solid.primitives.len(), 6);
    assert_eq!(solid.formula.nodes().len(), 7);
    assert!(solid.contains(DVec3::new(3.5, -1.5, 4.5)));
    assert!(!solid.contains(DVec3::new(3.5, -1.5, 6.01)));
}

#[test]
fn nearly_equal_planes_are_reported_and_kept_apart() {
    let solid = built(|b| {
        let one = cube(b, DVec3::ZERO, DVec3::ONE);
        let other = cube(b, DVec3::ZERO, DVec3::new(1.0, 1.0, 1.0 + 3e-9));
        b.add(Node::Union(vec![one, other]))
    });
    assert_eq!(solid.primitives.len(), 7);
    assert_eq!(solid.nearly_equal.len(), 1);
    let pair = solid.nearly_equal[0];
    assert!(pair.first < pair.second);
    assert!(pair.difference > 1e-9 && pair.difference < 1e-8);
}

#[test]
fn far_from_the_origin_digits_are_kept() {
    let far = DVec3::new(1e6, -2e6, 3e6);
    let solid = built(|b| {
        let ball = b.add(Node::Shape(Shape::sphere(1.0).unwrap()));
        moved(b, Transform::translation(far).unwrap(), ball)
    });
    assert!(solid.primitives[0].coefficient_error < 1e-8);
    let direction = DVec3::new(0.6, 0.0, 0.8);
    assert!(solid.contains(far + direction * (1.0 - 1e-8)));
    assert!(!solid.contains(far + direction * (1.0 + 1e-8)));
}

#[test]
fn outermost_materials_win() {
    let red = Material {
        color: Some([1.0, 0.0, 0.0, 1.0]),
    };
    let blue = Material {
        color: Some([0.0, 0.0, 1.0, 1.0]),
    };
    let solid = built(|b| {
        let (red, blue) = (b.material(red), b.material(blue));
        let ball = b.add(Node::Shape(Shape::sphere(1.0).unwrap()));
        let inner = b.add(Node::Painted(red, ball));
        let outer = b.add(Node::Painted(blue, inner));
        let plain = cube(b, DVec3::ZERO, DVec3::splat(2.0));
        b.add(Node::Union(vec![outer, plain]))
    });
    let materials: Vec<_> = solid
        .formula
        .nodes()
        .iter()
        .filter_map(|node| match node {
            FormulaNode::Literal(l) => Some(l.material),
            _ => None,
        })
        .collect();
    assert_eq!(materials[0], MaterialId(2));
    assert!(materials[1..].iter().all(|m| *m == MaterialId(0)));
    assert_eq!(solid.materials.len(), 3);
}

#[test]
fn operators_are_flattened_and_constants_folded() {
    let solid = built(|b| {
        let balls: Vec<_> = (1..6)
            .map(|r| b.add(Node::Shape(Shape::sphere(f64::from(r)).unwrap())))
            .collect();
        let empty = b.add(Node::Intersection(vec![]));
        let all = b.add(Node::Complement(empty));
        let inner = b.add(Node::Union(vec![balls[0], empty, balls[1]]));
        let same = b.add(Node::Union(vec![balls[1], inner, balls[0]]));
        let lone = b.add(Node::Intersection(vec![all, same]));
        let difference = b.add(Node::Difference(vec![balls[3], balls[2], empty]));
        b.add(Node::Union(vec![lone, difference, balls[0]]))
    });
    let expected = [
        ('u', 5),
        ('l', -1),
        ('l', -1),
        ('n', 2),
        ('l', -1),
        ('l', -1),
    ];
    assert_eq!(outline(&solid.formula), expected);
}

#[test]
fn lone_children_that_folding_leaves_are_merged() {
    // A ∪ ((B ∪ C) ∩ (D ∪ ¬D)) = A ∪ B ∪ C, where D ∪ ¬D is only seen to be all by interning.
    let solid = built(|b| {
        let mut ball = |r: f64| b.add(Node::Shape(Shape::sphere(r).unwrap()));
        let (a, c, d, e) = (ball(1.0), ball(2.0), ball(3.0), ball(4.0));
        let not_d = b.add(Node::Complement(d));
        let all = b.add(Node::Union(vec![d, not_d]));
        let both = b.add(Node::Union(vec![c, e]));
        let same = b.add(Node::Intersection(vec![both, all]));
        b.add(Node::Union(vec![a, same]))
    });
    let expected = [('u', 3), ('l', -1), ('l', -1), ('l', -1)];
    assert_eq!(outline(&solid.formula), expected);
    assert_eq!(solid.primitives.len(), 3);
}

#[test]
fn touching_cubes_intersect_in_nothing() {
    assert_empty(&built(|b| {
        let left = cube(b, DVec3::ZERO, DVec3::ONE);
        let right = cube(b, DVec3::X, DVec3::new(2.0, 1.0, 1.0));
        b.add(Node::Intersection(vec![left, right]))
    }));
    assert_empty(&built(|b| b.add(Node::Union(vec![]))));
    assert_empty(&built(|b| b.add(Node::Intersection(vec![]))));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_shape_without_itself_is_empty(shape in bounded_shape(), t in affine()) {
        let solid = built(|b| {
            let shape = b.add(Node::Shape(shape));
            let one = moved(b, t.clone(), shape);
            let other = moved(b, t, shape);
            b.add(Node::Difference(vec![one, other]))
        });
        assert_empty(&solid);
    }

    #[test]
    fn a_tree_without_itself_is_empty(t in tree(bounded_shape(), affine())) {
        let tree = Tree::Difference(vec![t.clone(), t]);
        let clip = Aabb { min: DVec3::splat(-1.0), max: DVec3::ONE };
        assert_empty(&Solid::build(&oracle::model(&tree), Some(clip)).unwrap());
    }
}
