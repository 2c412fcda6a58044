//! Depth-first descent of the bintree (thesis 4.3, Algorithms 4.1–4.3): every bisection halves
//! the undecided primitives, classifies them in both children and prunes the formula.

use crate::bernstein::{count, vertex_values};
use crate::blossom::RootCoefficients;
use crate::certify::{BarycentricGradients, barycentric_gradients};
use crate::classify::{Criterion, classify};
use crate::halving::halve;
use crate::margin::Margin;
use crate::predicates::{Sign, vertex_sign};
use crate::rounding::of_halving;
use crate::simplex::Simplex;
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Solid, Ternary, localize};
use std::sync::Arc;

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
    /// Its sign, where that is known in the simplex but not everywhere near it.
    pub value: Ternary,
    /// How far around the simplex that is proved at least, where there is a margin.
    pub clearance: f64,
}

impl Active {
    /// A primitive of which nothing is bounded, since nothing is to be proved.
    #[must_use]
    pub(crate) fn unbounded(primitive: u32, degree: u32, offset: u32) -> Self {
        Self {
            primitive,
            degree,
            offset,
            rounding: 0.0,
            root_rounding: 0.0,
            model_error: 0.0,
            largest: 0.0,
            value: Ternary::Unknown,
            clearance: 0.0,
        }
    }

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
    /// The primitives that the formula needs, ascending; with a margin also those that it needs
    /// near the simplex.
    pub active: Vec<Active>,
    /// The formula pruned to them.
    pub formula: Vec<FormulaNode>,
    /// The formula pruned to what crosses the simplex itself; empty where that is `formula`.
    within: Vec<FormulaNode>,
}

impl Frame {
    fn clear(&mut self) {
        self.coefficients.clear();
        self.active.clear();
        self.formula.clear();
        self.within.clear();
    }

    /// On which side of a primitive all four vertices are.
    #[must_use]
    pub(crate) fn side(&self, primitive: u32) -> Ternary {
        let Some(active) = self.active.iter().find(|a| a.primitive == primitive) else {
            return Ternary::Unknown;
        };
        let signs = self.values_of(active).map(vertex_sign);
        if signs != [signs[0]; 4] {
            Ternary::Unknown
        } else if signs[0] == Sign::Negative {
            Ternary::In
        } else {
            Ternary::Out
        }
    }

    /// The formula that holds in the simplex, whatever is around it.
    #[must_use]
    pub(crate) fn formula_within(&self) -> &[FormulaNode] {
        if self.within.is_empty() {
            &self.formula
        } else {
            &self.within
        }
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
        self.within.clear();
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
    /// How far around a simplex a sign must hold to be forgotten.
    margin: Option<Arc<Margin>>,
    /// Two children per level below the sector.
    frames: Vec<[Frame; 2]>,
    /// Value of each primitive in and around the children at hand.
    values: [Vec<Ternary>; 2],
    /// Value of each active primitive in them.
    inner_values: [Vec<Ternary>; 2],
    /// Marks the primitives that a pruned formula uses.
    used: Vec<u32>,
    stamp: u32,
    scratch: LocalizeScratch,
}

impl Walker {
    /// A walker for this solid. With a margin, frames also hold what the formula needs near
    /// their simplex; the simplices visited are the same.
    #[must_use]
    pub(crate) fn new(solid: &Solid, criterion: Criterion, margin: Option<Arc<Margin>>) -> Self {
        let n = solid.primitives.len();
        let unknown = || vec![Ternary::Unknown; n];
        Self {
            criterion,
            margin,
            frames: Vec::new(),
            values: [unknown(), unknown()],
            inner_values: [unknown(), unknown()],
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
            let (mut frame, mut gradients) = (Frame::default(), None);
            for (primitive, root) in roots.iter().enumerate() {
                let coefficients = &root.roots[at];
                let active = Active {
                    primitive: primitive as u32,
                    degree: root.degree as u32,
                    offset: frame.coefficients.len() as u32,
                    rounding: root.rounding,
                    root_rounding: root.rounding,
                    model_error: root.model_error,
                    largest: 0.0,
                    value: Ternary::Unknown,
                    clearance: 0.0,
                };
                frame.coefficients.extend_from_slice(coefficients);
                self.classify(0, (&simplex, &mut gradients), &mut frame, active);
            }
            let values = &self.values[0];
            let value = |p: PrimitiveId| values[p.0 as usize];
            let nodes = solid.formula.nodes();
            if localize(nodes, value, &mut frame.formula, &mut self.scratch) == Ternary::Unknown {
                self.drop_unused(&mut frame);
                if self.is_undecided(&mut frame, 0) {
                    sectors.push(Sector { simplex, frame });
                }
            }
        }
        sectors
    }

    /// The children of a sector that the boundary may meet.
    #[must_use]
    pub(crate) fn bisect(&mut self, sector: &Sector) -> Vec<Sector> {
        let mut frames = [Frame::default(), Frame::default()];
        let children = sector.simplex.children();
        let undecided = self.descend(&sector.frame, sector.simplex.kind(), &children, &mut frames);
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
        let children = simplex.children();
        let undecided = self.descend(frame, simplex.kind(), &children, &mut frames);
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
    pub(crate) fn descend(
        &mut self,
        parent: &Frame,
        kind: u8,
        children: &[Simplex; 2],
        frames: &mut [Frame; 2],
    ) -> [bool; 2] {
        let [near, far] = frames;
        near.clear();
        far.clear();
        let mut forgotten = [false; 2];
        let mut gradients = [None; 2];
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
            let rounding = of_halving(degree, active.rounding, active.largest);
            for (side, frame) in [&mut *near, &mut *far].into_iter().enumerate() {
                let child = Active {
                    offset: starts[side] as u32,
                    rounding,
                    ..*active
                };
                let place = (&children[side], &mut gradients[side]);
                forgotten[side] |= !self.classify(side, place, frame, child);
            }
        }
        let near_open = self.prune(parent, near, 0, forgotten[0]);
        let far_open = self.prune(parent, far, 1, forgotten[1]);
        [near_open, far_open]
    }

    /// Classifies the primitive whose coefficients end the frame's list, and keeps it unless its
    /// sign is known in the simplex and around it; whether it was kept.
    ///
    /// `gradients`: those of the simplex, found when they are needed first.
    fn classify(
        &mut self,
        side: usize,
        (simplex, gradients): (&Simplex, &mut Option<BarycentricGradients>),
        frame: &mut Frame,
        mut active: Active,
    ) -> bool {
        let (degree, start) = (active.degree as usize, active.offset as usize);
        let coefficients = &frame.coefficients[start..];
        let class = classify(
            self.criterion,
            simplex.kind(),
            degree,
            coefficients,
            active.error(),
        );
        // What was known of the parent is known of its children.
        if active.value == Ternary::Unknown {
            active.value = class.value();
        }
        let decided = active.value != Ternary::Unknown;
        let forget = decided
            && self.margin.as_ref().is_none_or(|margin| {
                let gradients = gradients.get_or_insert_with(|| barycentric_gradients(simplex));
                let place = (margin.rate(simplex.level), &*gradients);
                active.clearance = margin.clearance(place, &active, coefficients, &class);
                active.clearance >= margin.radius
            });
        let primitive = active.primitive as usize;
        self.inner_values[side][primitive] = active.value;
        if forget {
            self.values[side][primitive] = active.value;
            frame.coefficients.truncate(start);
            return false;
        }
        self.values[side][primitive] = Ternary::Unknown;
        active.largest = class.largest();
        frame.active.push(active);
        true
    }

    /// Prunes the parent's formula for a child; whether it stays undecided.
    fn prune(&mut self, parent: &Frame, child: &mut Frame, side: usize, forgotten: bool) -> bool {
        if !child.active.iter().any(|a| a.value == Ternary::Unknown) {
            return false;
        }
        if forgotten {
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
        } else {
            child.formula.extend_from_slice(&parent.formula);
        }
        self.is_undecided(child, side)
    }

    /// Whether the formula is undecided in a simplex, given that it is so around it.
    fn is_undecided(&mut self, frame: &mut Frame, side: usize) -> bool {
        if frame.active.iter().all(|a| a.value == Ternary::Unknown) {
            return true;
        }
        let values = &self.inner_values[side];
        let value = |p: PrimitiveId| values[p.0 as usize];
        let within = &mut frame.within;
        localize(&frame.formula, value, within, &mut self.scratch) == Ternary::Unknown
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
