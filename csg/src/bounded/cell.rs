//! Boxes in a chart, with what is undecided in them.

use super::tensor::{Role, Tensor};
use crate::{FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};
use glam::DVec3;
use std::rc::Rc;

/// A formula whose polynomials are in the coordinates of a frame.
pub(crate) struct Problem {
    pub(crate) nodes: Vec<FormulaNode>,
    pub(crate) polynomials: Vec<crate::Polynomial>,
    /// Bounds on the error of the values over [−1, 1]³, for each polynomial.
    pub(crate) errors: Vec<f64>,
}

/// A box and the formula's undecided part in it.
#[derive(Clone)]
pub(super) struct Cell {
    pub(super) low: DVec3,
    pub(super) high: DVec3,
    nodes: Rc<Vec<FormulaNode>>,
    /// By rising primitive.
    active: Vec<(PrimitiveId, Rc<Tensor>)>,
}

impl Cell {
    /// The whole box of a chart.
    pub(super) fn root(problem: &Problem, chart: [Role; 4], work: &mut u64) -> Self {
        let mut low = DVec3::ZERO;
        for role in chart {
            if let Role::Symmetric(variable) = role {
                low[variable] = -1.0;
            }
        }
        let tensors = problem.polynomials.iter().zip(0..).map(|(p, id)| {
            let tensor = Tensor::new(p, chart);
            *work += tensor.work();
            (PrimitiveId(id), Rc::new(tensor))
        });
        Self {
            low,
            high: DVec3::ONE,
            nodes: Rc::new(problem.nodes.clone()),
            active: tensors.collect(),
        }
    }

    /// Whether the box lies outside or inside the set; what is decided in it is forgotten.
    pub(super) fn classify(&mut self, errors: &[f64], scratch: &mut LocalizeScratch) -> Ternary {
        let mut values = Vec::with_capacity(self.active.len());
        for (id, tensor) in &self.active {
            let error = errors[id.0 as usize];
            let (low, high) = tensor.range();
            values.push(if low > error {
                Ternary::Out
            } else if high < -error {
                Ternary::In
            } else {
                Ternary::Unknown
            });
        }
        if !values.is_empty() && values.iter().all(|v| *v == Ternary::Unknown) {
            return Ternary::Unknown;
        }
        let place = |id: PrimitiveId| self.active.binary_search_by_key(&id, |entry| entry.0);
        let value = |id: PrimitiveId| place(id).map_or(Ternary::Unknown, |at| values[at]);
        let mut pruned = Vec::new();
        let result = localize(&self.nodes, value, &mut pruned, scratch);
        if result == Ternary::Unknown {
            let mut needed: Vec<PrimitiveId> = pruned
                .iter()
                .filter_map(|node| match node {
                    FormulaNode::Literal(literal) => Some(literal.primitive),
                    _ => None,
                })
                .collect();
            needed.sort_unstable();
            self.active
                .retain(|entry| needed.binary_search(&entry.0).is_ok());
            self.nodes = Rc::new(pruned);
        }
        result
    }

    /// The axis along which the undecided polynomials change most, relative to their own values,
    /// weighted with the box's side: without that a polynomial that touches 0 would have the
    /// box halved across it for ever.
    pub(super) fn liveliest_axis(&self) -> usize {
        let mut sums = DVec3::ZERO;
        for (_, tensor) in &self.active {
            sums += DVec3::from(tensor.variation());
        }
        let sums = sums * (self.high - self.low);
        let steeper = |best: usize, axis: usize| if sums[axis] > sums[best] { axis } else { best };
        [0, 1].into_iter().fold(2, steeper)
    }

    /// What one bisection costs.
    pub(super) fn halving_work(&self) -> u64 {
        let tensors = self.active.iter().map(|(_, tensor)| tensor);
        tensors.map(|tensor| 8 + tensor.halving_work(0)).sum()
    }

    /// The two halves along an axis, lower one first.
    pub(super) fn halves(&self, axis: usize, work: &mut u64) -> [Self; 2] {
        let (mut low, mut high) = (self.clone(), self.clone());
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        low.high[axis] = middle;
        high.low[axis] = middle;
        for (at, (_, tensor)) in self.active.iter().enumerate() {
            *work += 8 + tensor.halving_work(axis);
            let [lower, upper] = tensor.halves(axis);
            low.active[at].1 = Rc::new(lower);
            high.active[at].1 = Rc::new(upper);
        }
        [low, high]
    }
}
