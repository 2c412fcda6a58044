//! The stage as a whole: prove, balance, extract.

use crate::balance::close;
use crate::blossom::RootCoefficients;
use crate::certify::DegreeTable;
use crate::error::Error;
use crate::fragments::{Fragments, Triangle, VertexKind};
use crate::harvest::{Cut, extract, gather};
use crate::hessian::Hessian;
use crate::lattice::MAX_LEVEL;
use crate::limits::Budget;
use crate::margin::Margin;
use crate::prove::{Proof, Prover, prove};
use crate::settings::{Observer, Report, Rule, Settings};
use crate::specks::Doubtful;
use crate::topology::kindred::{Kin, families};
use crate::walk::{Sector, Visitor, Walker};
use csg::{KnownBoundary, Solid};
use rustc_hash::FxHashSet;
use std::sync::Arc;
use std::time::Instant;

/// What the subdivision yields.
#[derive(Clone, PartialEq, Debug)]
pub struct Outcome {
    /// The boundary.
    pub fragments: Fragments,
    /// How it came about.
    pub report: Report,
}

/// Number of subtrees into which the work is cut, whatever the number of threads.
const SECTORS: usize = 384;

/// Extractions that may be repeated for the sake of a proof that is incomplete anyway.
const ROUNDS: u64 = 3;

/// Converts a solid to its piecewise linear boundary.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// Settings out of range, a limit reached, or the observer cancelled.
pub fn convert(
    solid: &Solid,
    settings: &Settings,
    observer: &dyn Observer,
) -> Result<Outcome, Error> {
    let plan = Plan::new(solid, settings)?;
    if let Some(known) = &solid.known_boundary
        && plan.is_adaptive()
    {
        return Ok(known_outcome(known, settings));
    }
    let threads = settings.threads.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|_| Error::Threads(threads))?;
    // From a thread of its own: a caller that is itself a rayon worker would otherwise take up
    // other jobs while it waits, conversions inside conversions, until its stack is full.
    std::thread::scope(|scope| {
        let worker = scope.spawn(|| pool.install(|| run(&plan, observer)));
        worker
            .join()
            .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
    })
}

/// A boundary that was given needs no subdivision: nothing is nearer to what was meant.
fn known_outcome(known: &KnownBoundary, settings: &Settings) -> Outcome {
    let triangles = known.facets.iter().map(|facet| Triangle {
        vertices: facet.vertices,
        primitive: facet.primitive,
        sense: facet.sense,
        material: facet.material,
    });
    let fragments = Fragments {
        kinds: vec![VertexKind::Interior; known.positions.len()],
        positions: known.positions.clone(),
        triangles: triangles.collect(),
    };
    let farthest = fragments.positions.iter();
    let farthest = farthest.fold(0.0_f64, |far, p| far.max(p.abs().max_element()));
    // A placement takes each coordinate four products and three sums.
    let rounding = 8.0 * f64::EPSILON * farthest;
    let topology = matches!(settings.rule, Rule::Topology { .. });
    let report = Report {
        largest_deviation: Some(rounding),
        proved_topology: topology.then_some(true),
        volume_interval: (!topology).then(|| fragments.volume_interval(rounding)),
        ..Report::default()
    };
    Outcome { fragments, report }
}

/// A run with everything resolved.
pub(crate) struct Plan<'a> {
    pub(crate) solid: &'a Solid,
    settings: &'a Settings,
    roots: Vec<RootCoefficients>,
    pub(crate) tables: Vec<DegreeTable>,
    /// Tolerance of the metric rule in the domain's own units.
    pub(crate) tolerance: Option<f64>,
    /// Whether the topological rule decides.
    pub(crate) topology: bool,
    /// Whether literals of one primitive differ in material, so that a face may show another one
    /// where the set itself has no crease.
    pub(crate) labelled: bool,
    /// Of each primitive, for the topological rule.
    pub(crate) families: Vec<Option<Kin>>,
    /// Second derivatives of each quadric.
    pub(crate) hessians: Vec<Option<Hessian>>,
    /// Three tolerances, with the metric rule.
    pub(crate) margin: Option<Arc<Margin>>,
    pub(crate) max_level: u8,
}

impl<'a> Plan<'a> {
    fn new(solid: &'a Solid, settings: &'a Settings) -> Result<Self, Error> {
        let (tolerance, max_level) = match settings.rule {
            Rule::Tolerance(length) | Rule::Topology { finest: length } => {
                if !(length > 0.0 && length.is_finite()) {
                    return Err(Error::Tolerance(length));
                }
                let length = length / solid.domain.size();
                let level = settings.max_level.unwrap_or_else(|| level_for(length));
                let metric = matches!(settings.rule, Rule::Tolerance(_));
                (metric.then_some(length), level)
            }
            Rule::Level(level) => (None, level),
        };
        if max_level > MAX_LEVEL {
            return Err(Error::Level {
                asked: max_level,
                deepest: MAX_LEVEL,
            });
        }
        let roots: Vec<_> = solid.primitives.iter().map(RootCoefficients::new).collect();
        let degrees = roots.iter().map(|r| r.degree).max().unwrap_or(1);
        let tables: Vec<_> = (1..=degrees.max(1)).map(DegreeTable::new).collect();
        let hessians: Vec<_> = solid.primitives.iter().map(Hessian::of).collect();
        Ok(Self {
            solid,
            settings,
            roots,
            margin: tolerance.map(|t| Arc::new(Margin::new(3.0 * t, &tables, &hessians))),
            hessians,
            tables,
            tolerance,
            topology: matches!(settings.rule, Rule::Topology { .. }),
            families: families(&solid.primitives),
            labelled: has_several_materials(solid),
            max_level,
        })
    }

    /// Whether a rule decides where to bisect.
    pub(crate) fn is_adaptive(&self) -> bool {
        self.tolerance.is_some() || self.topology
    }

    /// A walker whose frames hold what the formula needs in each simplex.
    pub(crate) fn walker(&self) -> Walker {
        Walker::new(self.solid, self.settings.criterion, None)
    }

    /// A walker whose frames also hold what it needs within three tolerances.
    pub(crate) fn prover_walker(&self) -> Walker {
        let margin = self.margin.clone();
        Walker::new(self.solid, self.settings.criterion, margin)
    }
}

fn has_several_materials(solid: &Solid) -> bool {
    let mut material = vec![None; solid.primitives.len()];
    solid.formula.nodes().iter().any(|node| {
        let csg::FormulaNode::Literal(literal) = node else {
            return false;
        };
        let known = &mut material[literal.primitive.0 as usize];
        known
            .replace(literal.material)
            .is_some_and(|before| before != literal.material)
    })
}

/// The level at which the longest edge of a simplex is no longer than the tolerance.
///
/// In cubes of side h it is √3·h for type 0, √2·h for type 1 and h for type 2 (Table 4.2).
fn level_for(tolerance: f64) -> u8 {
    let mut level = 0;
    let mut side = 1.0;
    loop {
        for longest in [3f64.sqrt(), 2f64.sqrt(), 1.0] {
            if side * longest <= tolerance || level == MAX_LEVEL {
                return level;
            }
            level += 1;
        }
        side *= 0.5;
    }
}

fn run(plan: &Plan<'_>, observer: &dyn Observer) -> Result<Outcome, Error> {
    let budget = Budget::new(plan.settings, observer);
    let mut report = Report::default();
    let mut clock = Instant::now();
    let mut lap = |slot: &mut f64| {
        *slot = clock.elapsed().as_secs_f64();
        clock = Instant::now();
    };

    let mut head = Prover::new(plan, &budget);
    let sectors = cut_into_sectors(plan, &mut head);
    let proof = plan
        .is_adaptive()
        .then(|| prove(plan, &budget, &sectors, head, &mut report, observer));
    lap(&mut report.seconds[0]);
    budget.check()?;
    let (mut splits, trails, doubtful) = match proof {
        Some(Proof {
            splits,
            trails,
            doubtful,
        }) => {
            let count = splits.len();
            let mut all = FxHashSet::with_capacity_and_hasher(count * 2, rustc_hash::FxBuildHasher);
            close(&mut all, splits, |_| {});
            report.balance_points = (all.len() - count) as u64;
            (Some(all), trails, doubtful)
        }
        None => (None, Vec::new(), Doubtful::default()),
    };
    lap(&mut report.seconds[1]);
    // Leaves that only the closure made are tested on the way, and the rare ones that fail ask
    // for more bisections; then the subtrees that these reach are traversed again. Beside cells
    // that prove nothing at any level this may go on for dozens of rounds without a gain.
    let mut harvests: Vec<_> = sectors.iter().map(|_| None).collect();
    loop {
        let cut = Cut {
            sectors: &sectors,
            splits: splits.as_ref(),
            trails: &trails,
            is_last: report.uncertified_leaves > 0 && report.rounds >= ROUNDS,
        };
        let doubts = extract(plan, &budget, cut, &mut harvests, observer)?;
        if doubts.is_empty() {
            break;
        }
        report.rounds += 1;
        let all = splits.get_or_insert_default();
        close(all, doubts, |point| {
            report.balance_points += 1;
            for (sector, harvest) in sectors.iter().zip(&mut harvests) {
                if sector.simplex.contains(point) {
                    *harvest = None;
                }
            }
        });
    }
    let fragments = gather(plan, harvests, doubtful, &mut report);
    lap(&mut report.seconds[2]);
    if plan.topology {
        report.proved_topology = Some(report.uncertified_leaves == 0);
    }
    Ok(Outcome { fragments, report })
}

/// Bisects the roots breadth first until there is enough to share out.
fn cut_into_sectors(plan: &Plan<'_>, prover: &mut Prover<'_>) -> Vec<Sector> {
    let mut walker = plan.prover_walker();
    let mut open: std::collections::VecDeque<_> = walker.roots(plan.solid, &plan.roots).into();
    let mut ended = Vec::new();
    while open.len() + ended.len() < SECTORS {
        let Some(mut sector) = open.pop_front() else {
            break;
        };
        if prover.visit(&sector.simplex, &mut sector.frame) {
            open.extend(walker.bisect(&sector));
        } else if !sector.frame.active.is_empty() {
            ended.push(sector);
        }
    }
    // Leaves so far come first; what they contributed to the prover is not visited again.
    ended.extend(open);
    ended
}

#[cfg(test)]
mod tests;
