//! The stage as a whole: prove, balance, extract.

use crate::balance::close;
use crate::blossom::RootCoefficients;
use crate::certify::DegreeTable;
use crate::error::Error;
use crate::fragments::Fragments;
use crate::harvest::extract;
use crate::lattice::MAX_LEVEL;
use crate::limits::Budget;
use crate::prove::{Prover, prove};
use crate::settings::{Observer, Report, Rule, Settings};
use crate::walk::{Sector, Visitor, Walker};
use csg::Solid;
use rustc_hash::FxHashSet;
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

/// A run with everything resolved.
pub(crate) struct Plan<'a> {
    pub(crate) solid: &'a Solid,
    settings: &'a Settings,
    roots: Vec<RootCoefficients>,
    pub(crate) tables: Vec<DegreeTable>,
    /// Tolerance in the domain's own units; `None` for a fixed level.
    pub(crate) tolerance: Option<f64>,
    pub(crate) max_level: u8,
}

impl<'a> Plan<'a> {
    fn new(solid: &'a Solid, settings: &'a Settings) -> Result<Self, Error> {
        let (tolerance, max_level) = match settings.rule {
            Rule::Tolerance(t) if t > 0.0 && t.is_finite() => {
                let tolerance = t / solid.domain.size();
                let level = settings.max_level.unwrap_or_else(|| level_for(tolerance));
                (Some(tolerance), level)
            }
            Rule::Tolerance(t) => return Err(Error::Tolerance(t)),
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
        Ok(Self {
            solid,
            settings,
            roots,
            tables: (1..=degrees.max(1)).map(DegreeTable::new).collect(),
            tolerance,
            max_level,
        })
    }

    pub(crate) fn walker(&self) -> Walker {
        Walker::new(self.solid, self.settings.criterion)
    }
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
    let splits = plan
        .tolerance
        .map(|_| prove(plan, &budget, &sectors, head, &mut report, observer));
    lap(&mut report.seconds[0]);
    budget.check()?;
    let splits = splits.map(|asked| {
        let count = asked.len();
        let mut all = FxHashSet::with_capacity_and_hasher(count * 2, rustc_hash::FxBuildHasher);
        close(&mut all, asked);
        report.balance_points = (all.len() - count) as u64;
        all
    });
    lap(&mut report.seconds[1]);
    let fragments = extract(
        plan,
        &budget,
        &sectors,
        splits.as_ref(),
        &mut report,
        observer,
    )?;
    lap(&mut report.seconds[2]);
    Ok(Outcome { fragments, report })
}

/// Bisects the roots breadth first until there is enough to share out.
fn cut_into_sectors(plan: &Plan<'_>, prover: &mut Prover<'_>) -> Vec<Sector> {
    let mut walker = plan.walker();
    let mut open: std::collections::VecDeque<_> = walker.roots(plan.solid, &plan.roots).into();
    let mut ended = Vec::new();
    while open.len() + ended.len() < SECTORS {
        let Some(sector) = open.pop_front() else {
            break;
        };
        if prover.visit(&sector.simplex, &sector.frame) {
            open.extend(walker.bisect(&sector));
        } else {
            ended.push(sector);
        }
    }
    // Leaves so far come first; what they contributed to the prover is not visited again.
    ended.extend(open);
    ended
}

#[cfg(test)]
mod tests;
