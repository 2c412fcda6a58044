//! First traversal: where the metric rule (`crate::certify`) or the topological one
//! (`crate::topology`) wants to bisect.

use crate::certify::{
    BarycentricGradients, Sheet, barycentric_gradients, creases_within, sheet, slope_along,
    spread_rad,
};
use crate::convert::Plan;
use crate::lattice::Point;
use crate::limits::Budget;
use crate::settings::{MAX_SPOTS, Observer, Reason, Report, Spot};
use crate::simplex::Simplex;
use crate::topology::TopologyRule;
use crate::trail::Trail;
use crate::walk::{Frame, Pruning, Sector, Visitor};
use csg::{Domain, FormulaNode, LocalizeScratch, PrimitiveId, Sense};
use glam::DVec3;
use rayon::prelude::*;

/// Most primitives in a leaf that the metric rule accepts.
const CROWD: usize = 8;

/// What the first traversal found.
#[derive(Debug)]
pub(crate) struct Proof {
    /// The midpoints at which the rule wants to bisect, each once.
    pub(crate) splits: Vec<Point>,
    /// The decisions in each sector.
    pub(crate) trails: Vec<Trail>,
}

/// First traversal: where the rule wants to bisect.
pub(crate) fn prove(
    plan: &Plan<'_>,
    budget: &Budget<'_>,
    sectors: &[Sector],
    head: Prover<'_>,
    report: &mut Report,
    observer: &dyn Observer,
) -> Proof {
    observer.stage("proving", Some(sectors.len() as u64));
    let parts: Vec<Findings> = sectors
        .par_iter()
        .map_init(
            || plan.walker(),
            |walker, sector| {
                let mut prover = Prover::new(plan, budget);
                walker.walk(sector, &mut prover);
                prover.flush();
                observer.advance(1);
                prover.findings.splits.sort_unstable();
                prover.findings.splits.dedup();
                prover.findings
            },
        )
        .collect();
    let mut splits = head.findings.splits;
    let mut trails = Vec::with_capacity(parts.len());
    let mut largest = 0.0f64;
    report.visited += head.findings.visited;
    for part in parts {
        splits.extend(part.splits);
        trails.push(part.trail);
        largest = largest.max(part.largest_deviation);
        report.visited += part.visited;
        report.uncertified_leaves += part.uncertified_leaves;
        let room = MAX_SPOTS - report.uncertified.len();
        report
            .uncertified
            .extend(part.uncertified.into_iter().take(room));
    }
    splits.par_sort_unstable();
    splits.dedup();
    report.largest_deviation = plan.tolerance.map(|_| largest * plan.solid.domain.size());
    Proof { splits, trails }
}

/// What one subtree's first traversal found.
#[derive(Debug, Default)]
struct Findings {
    splits: Vec<Point>,
    trail: Trail,
    visited: u64,
    largest_deviation: f64,
    uncertified_leaves: u64,
    uncertified: Vec<Spot>,
}

/// Applies the rule to every simplex on the way down.
pub(crate) struct Prover<'a> {
    plan: &'a Plan<'a>,
    budget: &'a Budget<'a>,
    findings: Findings,
    leaves: u64,
    sheets: Vec<Sheet>,
    topology: TopologyRule,
    /// What the last test found to be of no account.
    pruning: Pruning,
    pruned: Vec<FormulaNode>,
    scratch: LocalizeScratch,
}

impl<'a> Prover<'a> {
    pub(crate) fn new(plan: &'a Plan<'a>, budget: &'a Budget<'a>) -> Self {
        Self {
            plan,
            budget,
            findings: Findings::default(),
            leaves: 0,
            sheets: Vec::new(),
            topology: TopologyRule::default(),
            pruning: Pruning::default(),
            pruned: Vec::new(),
            scratch: LocalizeScratch::default(),
        }
    }

    fn flush(&mut self) {
        self.budget.add_cells(std::mem::take(&mut self.leaves));
    }

    /// The rule that was asked for; the largest deviation where the metric one accepts.
    fn test(&mut self, simplex: &Simplex, frame: &Frame) -> Result<f64, Reason> {
        if let Some(tolerance) = self.plan.tolerance {
            return self.test_deviation(simplex, frame, tolerance);
        }
        let verdict = self.topology.test(self.plan, simplex, frame);
        self.pruning = self.topology.pruning();
        verdict.map(|()| 0.0)
    }

    /// The metric rule; the largest deviation where it accepts.
    fn test_deviation(
        &mut self,
        simplex: &Simplex,
        frame: &Frame,
        tolerance: f64,
    ) -> Result<f64, Reason> {
        if frame.active.len() > CROWD {
            return Err(Reason::Crowded);
        }
        self.sheets.clear();
        let gradients = barycentric_gradients(simplex);
        let mut largest = 0.0f64;
        for active in &frame.active {
            let table = &self.plan.tables[active.degree as usize - 1];
            let coefficients = frame.coefficients_of(active);
            let found =
                sheet(table, coefficients, &gradients, tolerance).ok_or(Reason::Singular)?;
            largest = largest.max(found.deviation);
            self.sheets.push(found);
        }
        if self.sheets.len() > 1 && largest > 0.0 {
            if let Some(deviation) = self.common_graph(frame, &gradients)
                && deviation <= tolerance
            {
                return Ok(deviation);
            }
            for (active, found) in frame.active.iter().zip(&mut self.sheets) {
                let table = &self.plan.tables[active.degree as usize - 1];
                let coefficients = frame.coefficients_of(active);
                found.spread_rad = spread_rad(table, coefficients, &gradients, found.normal);
            }
            let coefficients = |at: usize| frame.coefficients_of(&frame.active[at]);
            if !creases_within(&self.sheets, coefficients, tolerance) {
                return Err(Reason::Tangent);
            }
        }
        Ok(largest)
    }

    /// The deviation of a leaf whose boundary is one graph over the plane across some direction.
    fn common_graph(&self, frame: &Frame, gradients: &BarycentricGradients) -> Option<f64> {
        let mut outward = arrayvec::ArrayVec::<f64, CROWD>::new();
        for active in &frame.active {
            outward.push(single_sense(&frame.formula, active.primitive)?);
        }
        let sum: DVec3 = (self.sheets.iter().zip(&outward))
            .map(|(sheet, sign)| sheet.normal * *sign)
            .sum();
        let direction = sum.try_normalize()?;
        let mut largest = 0.0f64;
        for ((active, sheet), sign) in frame.active.iter().zip(&self.sheets).zip(&outward) {
            let table = &self.plan.tables[active.degree as usize - 1];
            let coefficients = frame.coefficients_of(active);
            let slope = slope_along(table, coefficients, gradients, direction * *sign);
            // Steeper than 75° against the direction is no graph to rely on.
            if slope < 0.25 * sheet.slope {
                return None;
            }
            largest = largest.max(sheet.swing / slope);
        }
        Some(largest)
    }

    /// Whether to bisect.
    fn decide(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        let verdict = self.test(simplex, frame);
        frame.prune(self.pruning, &mut self.pruned, &mut self.scratch);
        match verdict {
            // The surfaces that failed do not matter.
            _ if frame.active.is_empty() => {}
            Ok(deviation) => {
                self.findings.largest_deviation = self.findings.largest_deviation.max(deviation);
            }
            Err(_) if simplex.level < self.plan.max_level => {
                self.findings.splits.push(simplex.midpoint());
                return true;
            }
            Err(reason) => {
                self.findings.uncertified_leaves += 1;
                if self.findings.uncertified.len() < MAX_SPOTS {
                    let spot = Spot::new(&self.plan.solid.domain, simplex, frame, reason);
                    self.findings.uncertified.push(spot);
                }
            }
        }
        self.leaves += 1;
        if self.leaves == 1024 {
            self.flush();
        }
        false
    }
}

impl Spot {
    /// A leaf, with why nothing is proved there.
    pub(crate) fn new(domain: &Domain, simplex: &Simplex, frame: &Frame, reason: Reason) -> Self {
        let corners = simplex.vertices.map(|v| domain.to_model(v.position()));
        let primitives = frame.active.iter().map(|a| PrimitiveId(a.primitive));
        Self {
            position: corners.iter().copied().sum::<DVec3>() * 0.25,
            size: corners[0].distance(corners[3]),
            primitives: primitives.collect(),
            reason,
        }
    }
}

impl Visitor for Prover<'_> {
    fn visit(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        self.findings.visited += 1;
        if !self.plan.is_adaptive() {
            return simplex.level < self.plan.max_level;
        }
        let bisect = self.decide(simplex, frame);
        self.findings.trail.push(bisect, self.pruning);
        bisect
    }

    fn stopped(&self) -> bool {
        self.budget.stopped()
    }
}

/// 1 when all literals of a primitive mean its inside, so that its gradient points outward, −1
/// when all mean its outside, `None` when both occur.
fn single_sense(formula: &[FormulaNode], primitive: u32) -> Option<f64> {
    let mut found = None;
    for node in formula {
        if let FormulaNode::Literal(literal) = node
            && literal.primitive.0 == primitive
        {
            if found.is_some_and(|sense| sense != literal.sense) {
                return None;
            }
            found = Some(literal.sense);
        }
    }
    Some(match found? {
        Sense::Inside => 1.0,
        Sense::Outside => -1.0,
    })
}
