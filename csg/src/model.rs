//! The solid as a user describes it: a tree of shapes, set operations, instances and materials.
//!
//! Readers build a [`Model`]; [`Solid::build`](crate::Solid::build) turns it into a formula over
//! interned primitives. Nodes live in one arena and refer to nodes that stand before them, so a
//! model of any depth is built, walked and dropped without recursion.

use crate::{Facets, Material, MaterialId, Shape, Transform};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Index of a node in a [`Model`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct NodeId(u32);

impl NodeId {
    /// Position in the arena.
    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// One node of a [`Model`].
#[derive(Clone, PartialEq, Debug)]
pub enum Node {
    /// A shape in its own coordinates.
    Shape(Shape),
    /// Regularized union of the children; of none: the empty set.
    Union(Vec<NodeId>),
    /// Regularized intersection of the children; of none: the empty set, as in OpenSCAD.
    Intersection(Vec<NodeId>),
    /// The first child without the others; of none: the empty set.
    Difference(Vec<NodeId>),
    /// Everything outside the child.
    Complement(NodeId),
    /// The child, moved by the transform.
    Instance(Transform, NodeId),
    /// The child in this material; of nested ones the outermost wins, as in OpenSCAD.
    Painted(MaterialId, NodeId),
}

/// A constructive model: an arena of nodes with a root.
#[derive(Clone, PartialEq, Debug)]
pub struct Model {
    nodes: Vec<Node>,
    materials: Vec<Material>,
    facets: BTreeMap<NodeId, Arc<Facets>>,
    root: NodeId,
}

/// Builds a [`Model`] bottom-up.
#[derive(Clone, Debug)]
pub struct ModelBuilder {
    nodes: Vec<Node>,
    materials: Vec<Material>,
    facets: BTreeMap<NodeId, Arc<Facets>>,
}

impl Default for ModelBuilder {
    fn default() -> Self {
        Self::new()
    }
}

impl ModelBuilder {
    /// Starts an empty model, whose material 0 is "no colour given".
    #[must_use]
    pub fn new() -> Self {
        Self {
            nodes: Vec::new(),
            materials: vec![Material { color: None }],
            facets: BTreeMap::new(),
        }
    }

    /// Appends a node; its children must come from earlier calls on this builder.
    pub fn add(&mut self, node: Node) -> NodeId {
        self.nodes.push(node);
        NodeId(u32::try_from(self.nodes.len() - 1).unwrap_or(u32::MAX))
    }

    /// Says of a node added before which mesh bounds it.
    pub fn bound(&mut self, node: NodeId, by: Facets) {
        self.facets.insert(node, Arc::new(by));
    }

    /// A node added before.
    #[must_use]
    pub fn get(&self, id: NodeId) -> Option<&Node> {
        self.nodes.get(id.index())
    }

    /// The id of this material, equal ones being one.
    pub fn material(&mut self, material: Material) -> MaterialId {
        let at = self.materials.iter().position(|m| *m == material);
        let at = at.unwrap_or_else(|| {
            self.materials.push(material);
            self.materials.len() - 1
        });
        MaterialId(u32::try_from(at).unwrap_or(u32::MAX))
    }

    /// A node with all that it is made of, as a model of its own.
    #[must_use]
    pub fn subtree(&self, root: NodeId) -> Model {
        let mut needed = BTreeSet::new();
        let mut waiting = vec![root];
        while let Some(id) = waiting.pop() {
            if !needed.insert(id) {
                continue;
            }
            match self.nodes.get(id.index()) {
                Some(Node::Union(all) | Node::Intersection(all) | Node::Difference(all)) => {
                    waiting.extend(all);
                }
                Some(
                    Node::Complement(child) | Node::Instance(_, child) | Node::Painted(_, child),
                ) => waiting.push(*child),
                Some(Node::Shape(_)) | None => {}
            }
        }
        // Children come before parents here as there.
        let mut renumbered = BTreeMap::new();
        let mut nodes = Vec::with_capacity(needed.len());
        let mut facets = BTreeMap::new();
        for id in needed {
            let Some(mut node) = self.nodes.get(id.index()).cloned() else {
                continue;
            };
            let rename = |child: &mut NodeId| {
                *child = renumbered.get(child).copied().unwrap_or(*child);
            };
            match &mut node {
                Node::Union(all) | Node::Intersection(all) | Node::Difference(all) => {
                    all.iter_mut().for_each(rename);
                }
                Node::Complement(child) | Node::Instance(_, child) | Node::Painted(_, child) => {
                    rename(child);
                }
                Node::Shape(_) => {}
            }
            let renamed = NodeId(u32::try_from(nodes.len()).unwrap_or(u32::MAX));
            if let Some(known) = self.facets.get(&id) {
                facets.insert(renamed, known.clone());
            }
            renumbered.insert(id, renamed);
            nodes.push(node);
        }
        Model {
            root: renumbered.get(&root).copied().unwrap_or(root),
            nodes,
            materials: self.materials.clone(),
            facets,
        }
    }

    /// Ends the model with this root.
    #[must_use]
    pub fn finish(self, root: NodeId) -> Model {
        Model {
            nodes: self.nodes,
            materials: self.materials,
            facets: self.facets,
            root,
        }
    }
}

impl Model {
    /// The root node.
    #[must_use]
    pub fn root(&self) -> NodeId {
        self.root
    }

    /// A node by its id.
    #[must_use]
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The mesh that bounds a node, if one was given.
    pub(crate) fn facets(&self, id: NodeId) -> Option<&Facets> {
        self.facets.get(&id).map(Arc::as_ref)
    }

    /// All nodes, children before parents.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The materials, indexed by [`MaterialId`].
    #[must_use]
    pub fn materials(&self) -> &[Material] {
        &self.materials
    }
}
