//! A first look at a model: are its references sound, how large does it get when shared nodes
//! are expanded, and which nodes are constant because no shape stands below them?

use crate::{Error, Model, Node, NodeId};

/// The most half-spaces that a model may expand to.
pub(crate) const MAX_LITERALS: u64 = 2_000_000;

/// The most nodes that may be visited on the way to them.
const MAX_VISITS: u64 = 32 * MAX_LITERALS;

/// What is known about each node of a model.
pub(crate) struct Survey {
    /// `Some(true)`: all of space, `Some(false)`: empty, for nodes without shapes.
    constants: Vec<Option<bool>>,
}

/// Size of the tree below a node, shared nodes counted as often as they are used.
#[derive(Clone, Copy, Default)]
struct Size {
    literals: u64,
    visits: u64,
}

impl Survey {
    /// Checks a model. Cost: linear in its arena, however large it expands.
    ///
    /// # Errors
    /// [`Error::MisplacedNode`], [`Error::UnknownMaterial`], [`Error::TooManyLiterals`].
    pub(crate) fn of(model: &Model) -> Result<Self, Error> {
        let count = model.nodes().len();
        let mut constants = Vec::with_capacity(count);
        let mut sizes: Vec<Size> = Vec::with_capacity(count);
        for (node, content) in model.nodes().iter().enumerate() {
            let children = children(content);
            if let Some(child) = children.iter().map(|c| c.index()).find(|&c| c >= node) {
                return Err(Error::MisplacedNode { node, child });
            }
            if let Node::Painted(material, _) = content
                && material.0 as usize >= model.materials().len()
            {
                let material = material.0;
                return Err(Error::UnknownMaterial { node, material });
            }
            constants.push(constant(content, &constants));
            sizes.push(size(content, children, &sizes));
        }
        let child = model.root().index();
        let Some(size) = sizes.get(child) else {
            return Err(Error::MisplacedNode { node: count, child });
        };
        for (what, found, limit) in [
            ("half-spaces", size.literals, MAX_LITERALS),
            ("nodes", size.visits, MAX_VISITS),
        ] {
            if found > limit {
                return Err(Error::TooManyLiterals { what, found, limit });
            }
        }
        Ok(Self { constants })
    }

    /// Whether a node is all of space or empty for want of shapes.
    pub(crate) fn constant(&self, node: NodeId) -> Option<bool> {
        self.constants[node.index()]
    }
}

/// The nodes that a node refers to.
pub(crate) fn children(node: &Node) -> &[NodeId] {
    match node {
        Node::Shape(_) => &[],
        Node::Union(children) | Node::Intersection(children) | Node::Difference(children) => {
            children
        }
        Node::Complement(child) | Node::Instance(_, child) | Node::Painted(_, child) => {
            std::slice::from_ref(child)
        }
    }
}

/// The value of a node, from those of its children, if they alone decide it.
fn constant(node: &Node, known: &[Option<bool>]) -> Option<bool> {
    let of = |child: &NodeId| known[child.index()];
    let fold = |children: &[NodeId], absorbing: bool| {
        if children.iter().any(|c| of(c) == Some(absorbing)) {
            Some(absorbing)
        } else if children.iter().all(|c| of(c).is_some()) {
            Some(!absorbing)
        } else {
            None
        }
    };
    match node {
        Node::Shape(_) => None,
        Node::Union(children) => fold(children, true),
        Node::Intersection(children) if children.is_empty() => Some(false),
        Node::Intersection(children) => fold(children, false),
        Node::Difference(children) => match children.split_first() {
            None => Some(false),
            Some((first, rest)) => match (of(first), fold(rest, true)) {
                (Some(false), _) | (_, Some(true)) => Some(false),
                (Some(true), Some(false)) => Some(true),
                _ => None,
            },
        },
        Node::Complement(child) => of(child).map(|all| !all),
        Node::Instance(_, child) | Node::Painted(_, child) => of(child),
    }
}

fn size(node: &Node, children: &[NodeId], known: &[Size]) -> Size {
    let own = match node {
        // An odd polynomial under a projective map takes four literals.
        Node::Shape(shape) => shape.half_space_count() as u64,
        _ => 0,
    };
    let start = Size {
        literals: own,
        visits: 1,
    };
    children.iter().fold(start, |sum, child| {
        let child = known[child.index()];
        Size {
            literals: sum.literals.saturating_add(child.literals),
            visits: sum.visits.saturating_add(child.visits),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Material, MaterialId, ModelBuilder, Shape};

    fn ball(builder: &mut ModelBuilder) -> NodeId {
        builder.add(Node::Shape(Shape::sphere(1.0).unwrap()))
    }

    #[test]
    fn sharing_that_expands_without_end_is_refused_at_once() {
        let mut builder = ModelBuilder::new();
        let mut node = ball(&mut builder);
        for _ in 0..100 {
            node = builder.add(Node::Union(vec![node, node]));
        }
        let refused = Survey::of(&builder.finish(node)).err();
        assert!(matches!(
            refused,
            Some(Error::TooManyLiterals {
                found: u64::MAX,
                ..
            })
        ));
    }

    #[test]
    fn foreign_nodes_and_materials_are_refused() {
        let mut builder = ModelBuilder::new();
        let first = ball(&mut builder);
        let later = ball(&mut builder);
        let mut other = ModelBuilder::new();
        let root = other.add(Node::Union(vec![first, later]));
        assert_eq!(
            Survey::of(&other.clone().finish(root)).err(),
            Some(Error::MisplacedNode { node: 0, child: 0 })
        );
        let empty = ModelBuilder::new().finish(later);
        assert_eq!(
            Survey::of(&empty).err(),
            Some(Error::MisplacedNode { node: 0, child: 1 })
        );
        let red = other.material(Material {
            color: Some([1.0, 0.0, 0.0, 1.0]),
        });
        assert_eq!(red, MaterialId(1));
        let painted = builder.add(Node::Painted(red, first));
        assert_eq!(
            Survey::of(&builder.finish(painted)).err(),
            Some(Error::UnknownMaterial {
                node: 2,
                material: 1
            })
        );
    }

    #[test]
    fn nodes_without_shapes_are_constant() {
        let mut builder = ModelBuilder::new();
        let shape = ball(&mut builder);
        let empty = builder.add(Node::Union(vec![]));
        let also_empty = builder.add(Node::Intersection(vec![]));
        let all = builder.add(Node::Complement(empty));
        let difference = builder.add(Node::Difference(vec![all, also_empty]));
        let nothing = builder.add(Node::Difference(vec![shape, all]));
        let something = builder.add(Node::Difference(vec![shape, empty]));
        let survey = Survey::of(&builder.finish(something)).unwrap();
        assert_eq!(survey.constant(also_empty), Some(false));
        assert_eq!(survey.constant(difference), Some(true));
        assert_eq!(survey.constant(nothing), Some(false));
        assert_eq!(survey.constant(something), None);
    }
}
