//! Depth-first descent of the bintree (thesis 4.3, Algorithms 4.1–4.3): every bisection halves
//! the undecided primitives, classifies them in both children and prunes the formula.

use crate::bernstein::{count, vertex_values};
use crate::blossom::RootCoefficients;
use crate::classify::{Criterion, classify};
use crate::halving::halve;
use crate::rounding::of_halving;
use crate::simplex::Simplex;
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Solid, Ternary, localize};

/// A primitive whose sign is not known in a simplex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Active {
    /// Its global index.
    pub primitive: u32,
    /// Its degree.
    pub degree: u32,
    /// Where its coefficients begin in [`Frame::coefficients`].
    pub offset: u32,
    /// Bound on their rounding, against the polynomial that the subdivision was given.
    pub rounding: f64,
    /// The part of it that the root's coefficients had; it is that of one polynomial throughout
    /// the root, so that its gradient does not grow in smaller simplices.
    pub root_rounding: f64,
    /// Bound on that polynomial's error against the user's model; the same everywhere.
    pub model_error: f64,
    /// Its largest absolute coefficient.
    pub largest: f64,
}

impl Active {
    /// Bound on the error of its coefficients against the user's model.
    #[must_use]
    pub(crate) fn error(&self) -> f64 {
        self.rounding + self.model_error
    }
}

/// What is known of the solid in one simplex.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frame {
    /// Bernstein coefficients of the active primitives, one after the other.
    pub coefficients: Vec<f64>,
    /// The primitives that the formula needs, ascending.
    pub active: Vec<Active>,
    /// The formula pruned to them.
    pub formula: Vec<FormulaNode>,
}

impl Frame {
    fn clear(&mut self) {
        self.coefficients.clear();
        self.active.clear();
        self.formula.clear();
    }

    /// Drops primitives that do not matter; without any left the formula is decided.
    ///
    /// `pruned`: work space.
    pub(crate) fn prune(
        &mut self,
        pruning: Pruning,
        pruned: &mut Vec<FormulaNode>,
        scratch: &mut LocalizeScratch,
    ) {
        if pruning.is_empty() {
            return;
        }
        let bit = |set: u8, at: usize| at < 8 && set >> at & 1 == 1;
        let active = &self.active;
        let value = |p: PrimitiveId| match active.iter().position(|a| a.primitive == p.0) {
            Some(at) if bit(pruning.inside, at) => Ternary::In,
            Some(at) if bit(pruning.outside, at) => Ternary::Out,
            _ => Ternary::Unknown,
        };
        pruned.clear();
        let result = localize(&self.formula, value, pruned, scratch);
        std::mem::swap(&mut self.formula, pruned);
        if result != Ternary::Unknown {
            self.formula.clear();
        }
        let formula = &self.formula;
        self.active.retain(|a| {
            formula.iter().any(|node| {
                matches!(node, FormulaNode::Literal(literal) if literal.primitive.0 == a.primitive)
            })
        });
    }

    /// The Bernstein coefficients of an active primitive.
    #[must_use]
    pub(crate) fn coefficients_of(&self, active: &Active) -> &[f64] {
        let start = active.offset as usize;
        &self.coefficients[start..start + count(active.degree as usize)]
    }

    /// Its values at the simplex' vertices.
    #[must_use]
    pub(crate) fn values_of(&self, active: &Active) -> [f64; 4] {
        vertex_values(active.degree as usize, self.coefficients_of(active))
    }
}

/// Primitives whose sign in a simplex no longer matters, by their places among the active ones.
///
/// The formula has the same value at all points of the simplex when each of them is taken to be
/// inside everywhere, or outside everywhere.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) struct Pruning {
    /// One bit for each that is taken to be inside.
    pub inside: u8,
    /// One bit for each that is taken to be outside.
    pub outside: u8,
}

impl Pruning {
    /// Whether there is none.
    #[must_use]
    pub(crate) fn is_empty(self) -> bool {
        self == Self::default()
    }
}

/// A simplex of the bintree with its frame.
#[derive(Clone, Debug)]
pub(crate) struct Sector {
    /// The simplex.
    pub simplex: Simplex,
    /// What is known there.
    pub frame: Frame,
}

/// Visits the simplices that meet the boundary.
pub(crate) trait Visitor {
    /// Looks at a simplex whose formula is undecided; whether to bisect it.
    ///
    /// It may prune the frame, down to nothing where no boundary is left.
    fn visit(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool;

    /// Whether to stop the traversal.
    fn stopped(&self) -> bool {
        false
    }
}

/// Work space of a descent.
#[derive(Debug)]
pub(crate) struct Walker {
    criterion: Criterion,
    /// Two children per level below the sector.
    frames: Vec<[Frame; 2]>,
    /// Value of each primitive in the child at hand.
    values: [Vec<Ternary>; 2],
    /// Marks the primitives that a pruned formula uses.
    used: Vec<u32>,
    stamp: u32,
    scratch: LocalizeScratch,
}

impl Walker {
    /// A walker for this solid.
    #[must_use]
    pub(crate) fn new(solid: &Solid, criterion: Criterion) -> Self {
        let n = solid.primitives.len();
        Self {
            criterion,
            frames: Vec::new(),
            values: [vec![Ternary::Unknown; n], vec![Ternary::Unknown; n]],
            used: vec![0; n],
            stamp: 0,
            scratch: LocalizeScratch::default(),
        }
    }

    /// The root simplices that the boundary may meet.
    #[must_use]
    pub(crate) fn roots(&mut self, solid: &Solid, roots: &[RootCoefficients]) -> Vec<Sector> {
        let mut sectors = Vec::new();
        for (at, simplex) in Simplex::roots().into_iter().enumerate() {
            let mut frame = Frame::default();
            for (primitive, root) in roots.iter().enumerate() {
                let coefficients = &root.roots[at];
                let mut active = Active {
                    primitive: primitive as u32,
                    degree: root.degree as u32,
                    offset: frame.coefficients.len() as u32,
                    rounding: root.rounding,
                    root_rounding: root.rounding,
                    model_error: root.model_error,
                    largest: 0.0,
                };
                let class = classify(self.criterion, 0, root.degree, coefficients, active.error());
                self.values[0][primitive] = class.value;
                if class.value == Ternary::Unknown {
                    active.largest = class.largest;
                    frame.active.push(active);
                    frame.coefficients.extend_from_slice(coefficients);
                }
            }
            let values = &self.values[0];
            let value = |p: PrimitiveId| values[p.0 as usize];
            let nodes = solid.formula.nodes();
            if localize(nodes, value, &mut frame.formula, &mut self.scratch) == Ternary::Unknown {
                self.drop_unused(&mut frame);
                sectors.push(Sector { simplex, frame });
            }
        }
        sectors
    }

    /// The children of a sector that the boundary may meet.
    #[must_use]
    pub(crate) fn bisect(&mut self, sector: &Sector) -> Vec<Sector> {
        let mut frames = [Frame::default(), Frame::default()];
        let undecided = self.descend(&sector.frame, sector.simplex.kind(), &mut frames);
        let children = sector.simplex.children();
        let all = children.into_iter().zip(frames).zip(undecided);
        all.filter(|(_, undecided)| *undecided)
            .map(|((simplex, frame), _)| Sector { simplex, frame })
            .collect()
    }

    /// Visits a sector and its descendants in depth-first order.
    pub(crate) fn walk(&mut self, sector: &Sector, visitor: &mut impl Visitor) {
        let mut frame = sector.frame.clone();
        if visitor.visit(&sector.simplex, &mut frame) {
            self.walk_children(&sector.simplex, &frame, 0, visitor);
        }
    }

    /// Recursion depth is bounded by the lattice's levels, not by the input.
    fn walk_children(
        &mut self,
        simplex: &Simplex,
        frame: &Frame,
        depth: usize,
        visitor: &mut impl Visitor,
    ) {
        if self.frames.len() == depth {
            self.frames.push([Frame::default(), Frame::default()]);
        }
        // Taken out, and put back with its buffers when this level is done.
        let mut frames = std::mem::take(&mut self.frames[depth]);
        let undecided = self.descend(frame, simplex.kind(), &mut frames);
        let children = simplex.children();
        for side in 0..2 {
            if undecided[side]
                && !visitor.stopped()
                && visitor.visit(&children[side], &mut frames[side])
            {
                self.walk_children(&children[side], &frames[side], depth + 1, visitor);
            }
        }
        self.frames[depth] = frames;
    }

    /// Fills the frames of both children; tells in which the formula is undecided.
    fn descend(&mut self, parent: &Frame, kind: u8, frames: &mut [Frame; 2]) -> [bool; 2] {
        let [near, far] = frames;
        near.clear();
        far.clear();
        let mut decided = [false; 2];
        for active in &parent.active {
            let degree = active.degree as usize;
            let length = count(degree);
            let starts = [near.coefficients.len(), far.coefficients.len()];
            near.coefficients.resize(starts[0] + length, 0.0);
            far.coefficients.resize(starts[1] + length, 0.0);
            halve(
                degree,
                kind,
                parent.coefficients_of(active),
                &mut near.coefficients[starts[0]..],
                &mut far.coefficients[starts[1]..],
            );
            let mut child = Active {
                rounding: of_halving(degree, active.rounding, active.largest),
                ..*active
            };
            for (side, frame) in [&mut *near, &mut *far].into_iter().enumerate() {
                let start = starts[side];
                let coefficients = &frame.coefficients[start..];
                let kind = (kind + 1) % 3;
                let class = classify(self.criterion, kind, degree, coefficients, child.error());
                self.values[side][active.primitive as usize] = class.value;
                if class.value == Ternary::Unknown {
                    child.offset = start as u32;
                    child.largest = class.largest;
                    frame.active.push(child);
                } else {
                    frame.coefficients.truncate(start);
                    decided[side] = true;
                }
            }
        }
        let near_open = self.prune(parent, near, 0, decided[0]);
        let far_open = self.prune(parent, far, 1, decided[1]);
        [near_open, far_open]
    }

    /// Prunes the parent's formula for a child; whether it stays undecided.
    fn prune(&mut self, parent: &Frame, child: &mut Frame, side: usize, decided: bool) -> bool {
        if !decided {
            child.formula.extend_from_slice(&parent.formula);
            return true;
        }
        if child.active.is_empty() {
            return false;
        }
        let values = &self.values[side];
        let value = |p: PrimitiveId| values[p.0 as usize];
        let result = localize(
            &parent.formula,
            value,
            &mut child.formula,
            &mut self.scratch,
        );
        if result != Ternary::Unknown {
            return false;
        }
        self.drop_unused(child);
        true
    }

    /// Keeps only the active primitives that the formula still mentions.
    fn drop_unused(&mut self, frame: &mut Frame) {
        self.stamp += 1;
        for node in &frame.formula {
            if let FormulaNode::Literal(literal) = node {
                self.used[literal.primitive.0 as usize] = self.stamp;
            }
        }
        let (used, stamp) = (&self.used, self.stamp);
        frame.active.retain(|a| used[a.primitive as usize] == stamp);
    }
}
