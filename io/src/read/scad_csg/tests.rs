use super::*;
use crate::read::Diagnostic;
use csg::{Material, Model, Node, NodeId, Shape};
use glam::DVec3;
use proptest::prelude::*;

mod figures;
mod files;
mod messages;
mod random;
mod semantics;
mod table;

fn try_read(text: &str) -> Result<Reading, Diagnostics> {
    read(text, "t.csg", &ReadOptions::default())
}

fn model(text: &str) -> Model {
    try_read(text).unwrap().model
}

fn lines(list: &[Diagnostic]) -> Vec<String> {
    list.iter().map(ToString::to_string).collect()
}

fn errors(text: &str) -> Vec<String> {
    lines(try_read(text).unwrap_err().as_slice())
}

fn warnings(text: &str) -> Vec<String> {
    lines(&try_read(text).unwrap().warnings)
}

/// Whether a point lies in a model, from its definition; recursion suits small test models.
fn contains(model: &Model, at: NodeId, point: DVec3) -> bool {
    let of = |child: &NodeId| contains(model, *child, point);
    match model.node(at) {
        Node::Shape(shape) => {
            let union = shape.half_spaces().unwrap();
            let inside = |all: &Vec<csg::Polynomial>| all.iter().all(|p| p.evaluate(point) <= 0.0);
            union.iter().any(inside)
        }
        Node::Union(children) => children.iter().any(of),
        Node::Intersection(children) => !children.is_empty() && children.iter().all(of),
        Node::Difference(children) => match children.split_first() {
            Some((first, rest)) => of(first) && !rest.iter().any(of),
            None => false,
        },
        Node::Complement(child) => !of(child),
        Node::Instance(transform, child) => {
            let back = transform.inverse().apply(point).unwrap();
            contains(model, *child, back)
        }
        Node::Painted(_, child) => of(child),
    }
}

fn inside(text: &str, points: &[[f64; 3]]) -> Vec<bool> {
    let model = model(text);
    let at = points
        .iter()
        .map(|p| contains(&model, model.root(), DVec3::from(*p)));
    at.collect()
}

fn is_empty(model: &Model) -> bool {
    *model.node(model.root()) == Node::Union(Vec::new())
}
