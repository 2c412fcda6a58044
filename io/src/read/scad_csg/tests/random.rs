//! Random models, printed and read again.

use super::*;
use csg::{ModelBuilder, Transform};
use std::fmt::Write as _;

/// A model as a tree, to be printed in one pass and built in another.
#[derive(Clone, Debug)]
enum Tree {
    Cube([f64; 3], bool),
    Sphere(f64),
    Cylinder(f64, f64, f64),
    Torus(f64, f64),
    Union(Vec<Tree>),
    Intersection(Vec<Tree>),
    Difference(Vec<Tree>),
    Moved([f64; 3], Box<Tree>),
}

impl Tree {
    fn print(&self, out: &mut String) {
        let mut list = |name: &str, children: &[Tree]| {
            write!(out, "{name}() {{\n\t").unwrap();
            for child in children {
                child.print(out);
            }
            out.push_str("}\r\n");
        };
        match self {
            Self::Union(children) => list("group", children),
            Self::Intersection(children) => list("intersection", children),
            Self::Difference(children) => list("difference", children),
            Self::Cube([x, y, z], center) => {
                write!(out, "cube(size = [{x}, {y}, {z}], center = {center});").unwrap();
            }
            Self::Sphere(r) => write!(out, "sphere($fn = 0, r = {r:e});").unwrap(),
            Self::Cylinder(h, r1, r2) => {
                write!(out, "/* ) */ cylinder(h = {h}, r1 = {r1}, r2 = {r2});").unwrap();
            }
            Self::Torus(r1, r2) => write!(out, "torus({r1}, {r2});").unwrap(),
            Self::Moved([x, y, z], child) => {
                write!(
                    out,
                    "multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,{z}],[0,0,0,1]]) "
                )
                .unwrap();
                child.print(out);
            }
        }
    }

    /// The root of the model that the reader should build.
    fn build(&self, builder: &mut ModelBuilder) -> NodeId {
        let mut list = |node: fn(Vec<NodeId>) -> Node, children: &[Tree]| {
            let children: Vec<_> = children.iter().map(|c| c.build(builder)).collect();
            match children[..] {
                [only] => only,
                _ => builder.add(node(children)),
            }
        };
        let node = match self {
            Self::Union(children) => return list(Node::Union, children),
            Self::Intersection(children) => return list(Node::Intersection, children),
            Self::Difference(children) => return list(Node::Difference, children),
            Self::Cube(size, center) => {
                let size = DVec3::from(*size);
                let min = if *center { -0.5 * size } else { DVec3::ZERO };
                Node::Shape(Shape::block(min, min + size).unwrap())
            }
            Self::Sphere(r) => Node::Shape(Shape::sphere(*r).unwrap()),
            Self::Cylinder(h, r1, r2) => Node::Shape(Shape::frustum(*r1, *r2, 0.0, *h).unwrap()),
            Self::Torus(r1, r2) => Node::Shape(Shape::torus(*r1, *r2).unwrap()),
            Self::Moved(offset, child) => {
                let child = child.build(builder);
                let offset = Transform::translation(DVec3::from(*offset)).unwrap();
                Node::Instance(offset, child)
            }
        };
        builder.add(node)
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let size = || 1e-3..1e3;
    let leaf = prop_oneof![
        (prop::array::uniform3(size()), any::<bool>()).prop_map(|(s, c)| Tree::Cube(s, c)),
        size().prop_map(Tree::Sphere),
        (size(), size(), 0.0..1e3).prop_map(|(h, r1, r2)| Tree::Cylinder(h, r1, r2)),
        (size(), size()).prop_map(|(r1, r2)| Tree::Torus(r1, r2)),
    ];
    leaf.prop_recursive(5, 40, 4, |inner| {
        let some = || prop::collection::vec(inner.clone(), 1..4);
        prop_oneof![
            some().prop_map(Tree::Union),
            some().prop_map(Tree::Intersection),
            some().prop_map(Tree::Difference),
            (prop::array::uniform3(1.0..9.0), inner.clone())
                .prop_map(|(offset, child)| Tree::Moved(offset, child.into())),
        ]
    })
}

proptest! {
    #[test]
    fn printed_models_are_read_as_they_were(tree in tree()) {
        let mut text = String::new();
        tree.print(&mut text);
        let mut builder = ModelBuilder::new();
        let root = tree.build(&mut builder);
        let expected = builder.finish(root);
        let reading = try_read(&text).unwrap();
        prop_assert!(reading.warnings.is_empty());
        prop_assert_eq!(reading.model.nodes().len(), expected.nodes().len());
        for (found, expected) in reading.model.nodes().iter().zip(expected.nodes()) {
            if let (Node::Instance(a, found), Node::Instance(b, expected)) = (found, expected) {
                // The inverse may be computed in another way.
                prop_assert_eq!(found, expected);
                prop_assert_eq!(a.apply(DVec3::ONE), b.apply(DVec3::ONE));
            } else {
                prop_assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn damage_never_panics(tree in tree(), cut in 0.0..1.0, insert in "[\\[\\](){};=,\"!%a-c0-9 .]{0,3}") {
        let mut text = String::new();
        tree.print(&mut text);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in range")]
        let at = (cut * text.len() as f64) as usize;
        let _ = try_read(&text[..at]);
        text.insert_str(at, &insert);
        let _ = try_read(&text);
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,60}") {
        let _ = try_read(&text);
    }
}
