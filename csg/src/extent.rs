//! Bounding box of a model.
//!
//! A box is known for every shape and for its complement (all of space, but for half-spaces and
//! the like); unions unite the boxes, intersections intersect them. Only where this leaves the
//! whole model infinite, intersections with infinite boxes are examined by [`bounded`].

use crate::bounded::{self, BoundedSet, Framed, Problem};
use crate::bounds::{self, Support};
use crate::lower::{Lowered, Region, Token};
use crate::matrix::{self, Bounded, IDENTITY, Rows};
use crate::simplify::{Simplified, simplify};
use crate::survey::Survey;
use crate::walk::{Leaf, Visitor, walk};
use crate::{
    Aabb, Error, FormulaNode, MaterialId, Model, NodeId, Polynomial, PrimitiveId, Sense, Shape,
    Transform,
};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// Half-spaces that all proofs for one model may look at together.
const PROVABLE: usize = 20_000;

/// The bounding box of a model whose root is not constant; infinite if nothing was proved.
pub(crate) fn extent(model: &Model, survey: &Survey) -> Result<Aabb, Error> {
    let mut extents = Extents {
        operators: Vec::new(),
        result: Aabb::EVERYWHERE,
        sets: FxHashMap::default(),
        proofs: None,
    };
    let at = Placement {
        to_model: IDENTITY,
        to_shape: Bounded::exact(IDENTITY),
    };
    walk(model, survey, at.clone(), &mut extents)?;
    if !extents.result.is_empty() && !extents.result.is_finite() {
        extents.proofs = Some(Proofs {
            items: Vec::new(),
            left: PROVABLE,
        });
        walk(model, survey, at, &mut extents)?;
    }
    Ok(extents.result)
}

/// Where a shape stands.
#[derive(Clone)]
struct Placement {
    /// From the shape's coordinates to the model's.
    to_model: Rows,
    /// The inverse, with its error.
    to_shape: Bounded,
}

struct Extents<'a> {
    operators: Vec<Operator>,
    result: Aabb,
    /// Proofs for polynomials of higher degree, by node and complementation.
    sets: FxHashMap<(NodeId, bool), Option<Rc<BoundedSet>>>,
    /// Present on the second walk.
    proofs: Option<Proofs<'a>>,
}

/// An operator some of whose children have been read.
struct Operator {
    union: bool,
    bounds: Aabb,
    /// Planes that are children of an intersection: normals and offsets.
    planes: Vec<(DVec3, f64)>,
    /// Where it begins in the items.
    start: usize,
}

/// What the second walk remembers to describe intersections.
struct Proofs<'a> {
    items: Vec<Item<'a>>,
    /// Half-spaces that may still be looked at.
    left: usize,
}

/// A part of a formula in prefix order.
enum Item<'a> {
    Open { union: bool },
    Close,
    Shape(&'a Shape, bool, Box<Bounded>),
}

impl Extents<'_> {
    fn add(&mut self, child: Aabb) {
        match self.operators.last_mut() {
            None => self.result = child,
            Some(top) if top.union => top.bounds = top.bounds.union(&child),
            Some(top) => top.bounds = top.bounds.intersection(&child),
        }
    }

    /// The box of a polynomial of degree above 2, or of its complement.
    fn polynomial(
        &mut self,
        node: NodeId,
        polynomial: &Polynomial,
        complemented: bool,
        to_model: &Rows,
    ) -> Result<Aabb, Error> {
        let known = self.sets.get(&(node, complemented)).cloned();
        let set = if let Some(set) = known {
            set
        } else {
            let side = Side {
                polynomial,
                complemented,
            };
            let set = bounded::prove(&side)?.map(Rc::new);
            self.sets.insert((node, complemented), set.clone());
            set
        };
        Ok(match set {
            None => Aabb::EVERYWHERE,
            Some(set) => bounds::of_image(&Support::finite(|d| set.support(d)), to_model),
        })
    }
}

impl<'a> Visitor<'a> for Extents<'a> {
    type Placement = Placement;

    fn place(&mut self, at: &Placement, transform: &Transform) -> Result<Placement, Error> {
        let to_model = matrix::multiply(&transform.to_rows(), &at.to_model);
        Ok(Placement {
            to_model: Bounded::exact(to_model).finite()?.rows,
            to_shape: at.to_shape.then(transform.bounded_inverse()).finite()?,
        })
    }

    fn open(&mut self, union: bool) {
        let mut start = 0;
        if let Some(proofs) = &mut self.proofs {
            start = proofs.items.len();
            proofs.items.push(Item::Open { union });
        }
        self.operators.push(Operator {
            union,
            bounds: if union { Aabb::EMPTY } else { Aabb::EVERYWHERE },
            planes: Vec::new(),
            start,
        });
    }

    fn close(&mut self) -> Result<(), Error> {
        let Some(mut top) = self.operators.pop() else {
            return Ok(());
        };
        if !top.union && !top.bounds.is_empty() && !top.bounds.is_finite() {
            let polyhedron = bounds::of_half_spaces(&top.planes);
            top.bounds = top.bounds.intersection(&polyhedron);
        }
        if let Some(proofs) = &mut self.proofs {
            proofs.items.push(Item::Close);
            if !top.union && !top.bounds.is_empty() && !top.bounds.is_finite() {
                let part = proofs.part(top.start);
                if let Some(set) = part.map(|p| bounded::prove(&p)).transpose()?.flatten() {
                    let support = Support::finite(|d| set.support(d));
                    let found = bounds::of_image(&support, &IDENTITY);
                    top.bounds = top.bounds.intersection(&found);
                }
            }
        }
        self.add(top.bounds);
        Ok(())
    }

    fn shape(&mut self, leaf: &Leaf<'a, '_, Placement>) -> Result<(), Error> {
        let Placement { to_model, to_shape } = leaf.at;
        let bounds = match leaf.shape {
            Shape::Polynomial(p) if p.degree() > 2 => {
                self.polynomial(leaf.node, p, leaf.complemented, to_model)?
            }
            shape if leaf.complemented => bounds::of_image(&shape.complement_support(), to_model),
            shape => bounds::of_image(&shape.support(), to_model),
        };
        // Shapes have a volume; here it was lost to rounding.
        if bounds.min.cmpeq(bounds.max).any() {
            return Err(Error::ExtentOutOfRange);
        }
        if let Some(proofs) = &mut self.proofs {
            let item = Item::Shape(leaf.shape, leaf.complemented, Box::new(*to_shape));
            proofs.items.push(item);
        }
        if let (Shape::HalfSpace(plane), Some(top)) = (leaf.shape, self.operators.last_mut())
            && !top.union
            && crate::transform::is_affine(to_model)
        {
            let sign = if leaf.complemented { -1.0 } else { 1.0 };
            let n = plane.normal() * sign;
            let form = [n.x, n.y, n.z, -plane.offset() * sign];
            let [x, y, z, one] = to_shape
                .rows
                .map(|row| row.iter().zip(form).map(|(m, c)| m * c).sum::<f64>());
            top.planes.push((DVec3::new(x, y, z), -one));
        }
        self.add(bounds);
        Ok(())
    }
}

impl<'a> Proofs<'a> {
    /// The formula from an item on, if it may still be looked at.
    fn part(&mut self, start: usize) -> Option<Part<'a, '_>> {
        let items = &self.items[start..];
        let sizes = items.iter().map(|item| match item {
            Item::Shape(shape, ..) => shape.half_space_count(),
            _ => 0,
        });
        let size: usize = sizes.sum();
        self.left = self.left.checked_sub(size)?;
        Some(Part { items })
    }
}

/// One side of a polynomial.
struct Side<'a> {
    polynomial: &'a Polynomial,
    complemented: bool,
}

impl Framed for Side<'_> {
    fn in_frame(&self, frame: &Bounded) -> Result<Problem, Error> {
        let shape = Shape::Polynomial(self.polynomial.clone());
        let item = Item::Shape(
            &shape,
            self.complemented,
            Box::new(Bounded::exact(IDENTITY)),
        );
        Part { items: &[item] }.in_frame(frame)
    }
}

/// A part of a formula.
struct Part<'a, 'i> {
    items: &'i [Item<'a>],
}

impl Framed for Part<'_, '_> {
    fn in_frame(&self, frame: &Bounded) -> Result<Problem, Error> {
        let mut lowered = Lowered::new(Region::Everywhere);
        for item in self.items {
            match item {
                Item::Open { union } => lowered.tokens.push(Token::Open { union: *union }),
                Item::Close => lowered.tokens.push(Token::Close),
                Item::Shape(shape, complemented, to_shape) => {
                    let to_shape = frame.then(to_shape).finite()?;
                    lowered.add_shape(shape, *complemented, &to_shape, MaterialId(0))?;
                }
            }
        }
        let count = u32::try_from(lowered.halves.len()).unwrap_or(u32::MAX);
        let ids: Vec<_> = (0..count)
            .map(|id| (PrimitiveId(id), Sense::Inside))
            .collect();
        Ok(Problem {
            nodes: match simplify(&lowered.tokens, &ids) {
                Simplified::Constant { all: true } => vec![FormulaNode::Intersection { len: 0 }],
                Simplified::Constant { all: false } => vec![FormulaNode::Union { len: 0 }],
                Simplified::Nodes(nodes) => nodes,
            },
            // The bound on a coefficient's error counts all of them, so it also bounds the
            // values over [−1, 1]³; twice, for the change of basis.
            errors: lowered.halves.iter().map(|h| 2.0 * h.error).collect(),
            polynomials: lowered.halves.into_iter().map(|h| h.polynomial).collect(),
        })
    }
}
