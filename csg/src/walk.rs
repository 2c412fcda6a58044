//! One walk over a model as a formula without difference and complement: these are pushed down
//! to the shapes, operators in operators of the same kind are merged, and operators left with
//! one child vanish. The stack is explicit, so depth is no limit.

use crate::survey::Survey;
use crate::{Error, MaterialId, Model, Node, NodeId, Shape, Transform};

/// What happens on the way.
pub(crate) trait Visitor<'a> {
    /// Where a node stands; inherited from its ancestors.
    type Placement: Clone;

    /// The placement of the child of an instance that stands at `at`.
    fn place(
        &mut self,
        at: &Self::Placement,
        transform: &Transform,
    ) -> Result<Self::Placement, Error>;

    /// An operator begins, inside one of the other kind or at the root.
    fn open(&mut self, union: bool);

    /// The innermost operator ends.
    fn close(&mut self) -> Result<(), Error>;

    /// A shape, or its complement.
    fn shape(&mut self, leaf: &Leaf<'a, '_, Self::Placement>) -> Result<(), Error>;
}

/// A shape met on the walk.
pub(crate) struct Leaf<'a, 'p, P> {
    /// The node that holds it.
    pub(crate) node: NodeId,
    pub(crate) shape: &'a Shape,
    pub(crate) complemented: bool,
    pub(crate) at: &'p P,
    /// The outermost one given.
    pub(crate) material: MaterialId,
}

/// A node to visit, and what it inherits.
#[derive(Clone)]
struct Visit<P> {
    node: NodeId,
    complemented: bool,
    at: P,
    material: Option<MaterialId>,
}

/// An operator some of whose children are still to be visited.
struct Open<'a, P> {
    children: &'a [NodeId],
    next: usize,
    /// Whether the children after the first are complemented in addition.
    difference: bool,
    inherited: Visit<P>,
    union: bool,
    /// Whether the visitor was told, or it is part of the operator around it.
    announced: bool,
}

/// Walks over a model whose root is not constant.
pub(crate) fn walk<'a, V: Visitor<'a>>(
    model: &'a Model,
    survey: &Survey,
    at: V::Placement,
    visitor: &mut V,
) -> Result<(), Error> {
    let mut open: Vec<Open<'a, V::Placement>> = Vec::new();
    let mut pending = Some(Visit {
        node: model.root(),
        complemented: false,
        at,
        material: None,
    });
    loop {
        let Some(mut visit) = pending.take() else {
            let Some(top) = open.last_mut() else {
                return Ok(());
            };
            pending = next_child(top, survey);
            if pending.is_none() && open.pop().is_some_and(|top| top.announced) {
                visitor.close()?;
            }
            continue;
        };
        let (children, is_union, difference) = match model.node(visit.node) {
            Node::Shape(shape) => {
                visitor.shape(&Leaf {
                    node: visit.node,
                    shape,
                    complemented: visit.complemented,
                    at: &visit.at,
                    material: visit.material.unwrap_or(MaterialId(0)),
                })?;
                continue;
            }
            Node::Complement(child) => {
                visit.complemented = !visit.complemented;
                visit.node = *child;
                pending = Some(visit);
                continue;
            }
            Node::Instance(transform, child) => {
                visit.at = visitor.place(&visit.at, transform)?;
                visit.node = *child;
                pending = Some(visit);
                continue;
            }
            Node::Painted(material, child) => {
                visit.material = visit.material.or(Some(*material));
                visit.node = *child;
                pending = Some(visit);
                continue;
            }
            Node::Union(children) => (children, true, false),
            Node::Intersection(children) => (children, false, false),
            Node::Difference(children) => (children, false, true),
        };
        let union = is_union != visit.complemented;
        let mut top = Open {
            children,
            next: 0,
            difference,
            inherited: visit,
            union,
            announced: false,
        };
        let varying = children.iter().filter(|c| survey.constant(**c).is_none());
        if varying.take(2).count() == 1 {
            pending = next_child(&mut top, survey);
            continue;
        }
        top.announced = open.last().is_none_or(|around| around.union != union);
        if top.announced {
            visitor.open(union);
        }
        open.push(top);
    }
}

/// The next child that matters: constant ones that would decide the operator have made it
/// constant itself, so those met here are neutral.
fn next_child<P: Clone>(top: &mut Open<'_, P>, survey: &Survey) -> Option<Visit<P>> {
    while let Some(&node) = top.children.get(top.next) {
        top.next += 1;
        if survey.constant(node).is_none() {
            let mut visit = top.inherited.clone();
            visit.node = node;
            visit.complemented ^= top.difference && top.next > 1;
            return Some(visit);
        }
    }
    None
}
