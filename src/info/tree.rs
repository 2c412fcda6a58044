//! A model's nodes, parents before children.

use csg::{MaterialId, Model, Node, NodeId, Shape};
use serde_json::{Value, json};

/// Nodes that are listed as text, at most.
const LINES: usize = 40;

/// Nodes that are listed as JSON, at most.
const ENTRIES: usize = 10_000;

/// A node below the moves and colours that lead to it.
struct Entry {
    depth: usize,
    kind: &'static str,
    is_moved: bool,
    material: Option<MaterialId>,
}

/// The first nodes in depth-first order, and whether that is all.
fn entries(model: &Model, most: usize) -> (Vec<Entry>, bool) {
    let mut found = Vec::new();
    let mut open: Vec<(NodeId, usize)> = vec![(model.root(), 0)];
    while let Some((mut id, depth)) = open.pop() {
        if found.len() == most {
            return (found, false);
        }
        let (mut is_moved, mut material) = (false, None);
        let node = loop {
            id = match model.node(id) {
                Node::Instance(_, child) => {
                    is_moved = true;
                    *child
                }
                // Of nested colours the outermost wins.
                Node::Painted(own, child) => {
                    material = material.or(Some(*own));
                    *child
                }
                node => break node,
            };
        };
        let children: &[NodeId] = match node {
            Node::Union(children) | Node::Intersection(children) | Node::Difference(children) => {
                children
            }
            Node::Complement(child) => std::slice::from_ref(child),
            Node::Shape(_) | Node::Instance(..) | Node::Painted(..) => &[],
        };
        open.extend(children.iter().rev().map(|&child| (child, depth + 1)));
        found.push(Entry {
            depth,
            kind: kind(node),
            is_moved,
            material,
        });
    }
    (found, true)
}

fn kind(node: &Node) -> &'static str {
    match node {
        Node::Union(_) => "union",
        Node::Intersection(_) => "intersection",
        Node::Difference(_) => "difference",
        Node::Complement(_) => "complement",
        Node::Instance(..) => "instance",
        Node::Painted(..) => "painted",
        Node::Shape(shape) => match shape {
            Shape::Block(_) => "block",
            Shape::Ellipsoid(_) => "ellipsoid",
            Shape::Cylinder(_) => "cylinder",
            Shape::Frustum(_) => "frustum",
            Shape::Torus(_) => "torus",
            Shape::HalfSpace(_) => "half-space",
            Shape::Quadric(_) => "quadric",
            Shape::Polynomial(_) => "polynomial",
            Shape::Helicoid(_) => "helicoid",
            Shape::Prism(_) => "prism",
            Shape::ConvexPolyhedron(_) => "convex polyhedron",
        },
    }
}

/// Lines of text, indented.
pub(super) fn to_text(model: &Model) -> Vec<String> {
    let (entries, is_all) = entries(model, LINES);
    let line = |entry: &Entry| {
        let indent = "  ".repeat(1 + entry.depth.min(20));
        let moved = if entry.is_moved { ", moved" } else { "" };
        let material = entry.material.map_or(String::new(), |MaterialId(number)| {
            format!(", material {number}")
        });
        format!("{indent}{}{moved}{material}", entry.kind)
    };
    let mut lines = vec!["tree:".to_owned()];
    lines.extend(entries.iter().map(line));
    if !is_all {
        lines.push("  … and more (--json lists up to 10,000 nodes)".to_owned());
    }
    lines
}

/// The nodes with their depths, as a list: nothing that reads it needs to recurse.
pub(super) fn to_json(model: &Model) -> Value {
    let (entries, is_all) = entries(model, ENTRIES);
    let nodes = entries.iter().map(|entry| {
        json!({
            "depth": entry.depth,
            "kind": entry.kind,
            "moved": entry.is_moved,
            "material": entry.material.map(|MaterialId(number)| number),
        })
    });
    json!({ "nodes": nodes.collect::<Vec<Value>>(), "complete": is_all })
}
