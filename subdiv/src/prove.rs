//! First traversal: where the metric rule (`crate::deviation`) or the topological one
//! (`crate::topology`) wants to bisect.

use crate::convert::Plan;
use crate::deviation::{DeviationRule, Proved};
use crate::lattice::Point;
use crate::limits::Budget;
use crate::settings::{MAX_SPOTS, Observer, Reason, Report, Spot};
use crate::simplex::Simplex;
use crate::specks::Doubtful;
use crate::topology::TopologyRule;
use crate::trail::Trail;
use crate::walk::{Frame, Pruning, Sector, Visitor};
use csg::{Domain, FormulaNode, LocalizeScratch, PrimitiveId, Ternary};
use glam::DVec3;
use rayon::prelude::*;

/// A vertex is a sum of four corners, then scaled and shifted: some eight roundings on each axis,
/// relative to the largest coordinate.
const POSITION_ROUNDING: f64 = 16.0 * f64::EPSILON;

/// What the first traversal found.
#[derive(Debug)]
pub(crate) struct Proof {
    /// The midpoints at which the rule wants to bisect, each once.
    pub(crate) splits: Vec<Point>,
    /// The decisions in each sector.
    pub(crate) trails: Vec<Trail>,
    /// Where nothing could be proved.
    pub(crate) doubtful: Doubtful,
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
            || plan.prover_walker(),
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
    let mut doubtful = head.findings.doubtful;
    report.visited += head.findings.visited;
    for part in parts {
        splits.extend(part.splits);
        trails.push(part.trail);
        largest = largest.max(part.largest_deviation);
        report.visited += part.visited;
        report.uncertified_leaves += part.uncertified_leaves;
        report.one_way_leaves += part.one_way_leaves;
        doubtful.append(part.doubtful);
        let room = MAX_SPOTS - report.uncertified.len();
        report
            .uncertified
            .extend(part.uncertified.into_iter().take(room));
    }
    splits.par_sort_unstable();
    splits.dedup();
    let domain = &plan.solid.domain;
    let rounding = POSITION_ROUNDING * (domain.size() + domain.origin().abs().max_element());
    report.largest_deviation = plan
        .tolerance
        .map(|_| largest * domain.size() * (1.0 + f64::EPSILON) + rounding);
    Proof {
        splits,
        trails,
        doubtful,
    }
}

/// What one subtree's first traversal found.
#[derive(Debug, Default)]
struct Findings {
    splits: Vec<Point>,
    trail: Trail,
    visited: u64,
    largest_deviation: f64,
    one_way_leaves: u64,
    uncertified_leaves: u64,
    uncertified: Vec<Spot>,
    doubtful: Doubtful,
}

/// Applies the rule to every simplex on the way down.
pub(crate) struct Prover<'a> {
    plan: &'a Plan<'a>,
    budget: &'a Budget<'a>,
    findings: Findings,
    leaves: u64,
    rule: DeviationRule,
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
            rule: DeviationRule::default(),
            topology: TopologyRule::default(),
            pruning: Pruning::default(),
            pruned: Vec::new(),
            scratch: LocalizeScratch::default(),
        }
    }

    fn flush(&mut self) {
        self.budget.add_cells(std::mem::take(&mut self.leaves));
    }

    /// The rule that was asked for.
    fn test(&mut self, simplex: &Simplex, frame: &Frame) -> Result<Proved, Reason> {
        if let Some(margin) = &self.plan.margin {
            return self.rule.test(self.plan, margin, simplex, frame);
        }
        let verdict = self.topology.test(self.plan, simplex, frame);
        self.pruning = self.topology.pruning();
        verdict.map(|()| Proved {
            distance: 0.0,
            both_ways: true,
        })
    }

    /// Whether to bisect.
    fn decide(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        let verdict = self.test(simplex, frame);
        frame.prune(self.pruning, &mut self.pruned, &mut self.scratch);
        match verdict {
            // The surfaces that failed do not matter.
            _ if frame.active.is_empty() => {}
            Ok(proved) => {
                let largest = &mut self.findings.largest_deviation;
                *largest = largest.max(proved.distance);
                self.findings.one_way_leaves += u64::from(!proved.both_ways);
            }
            Err(_) if simplex.level < self.plan.max_level => {
                self.findings.splits.push(simplex.midpoint());
                return true;
            }
            Err(reason) => {
                self.findings.uncertified_leaves += 1;
                self.findings.doubtful.push(simplex);
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
        let corners = simplex.vertices.map(|v| domain.from_unit(v.position()));
        let crossing = frame.active.iter().filter(|a| a.value == Ternary::Unknown);
        let primitives = crossing.map(|a| PrimitiveId(a.primitive));
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
