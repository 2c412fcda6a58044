//! Second traversal: bisects where the closed set of midpoints says so and extracts the leaves.

use crate::convert::Plan;
use crate::error::Error;
use crate::extract::{Extractor, LeafError};
use crate::fragments::Fragments;
use crate::lattice::Point;
use crate::limits::Budget;
use crate::mesh::{MeshBuilder, join};
use crate::settings::{MAX_SPOTS, Observer, Report, Spot};
use crate::simplex::Simplex;
use crate::specks::{Doubtful, clear_specks};
use crate::topology::TopologyRule;
use crate::trail::{Step, Trail};
use crate::untangle::untangle;
use crate::volume::VolumeGap;
use crate::walk::{Frame, Sector, Visitor};
use csg::{Domain, FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// Where to bisect.
#[derive(Clone, Copy)]
pub(crate) struct Cut<'a> {
    /// The subtrees.
    pub(crate) sectors: &'a [Sector],
    /// The midpoints to bisect at, `None` for a fixed level.
    pub(crate) splits: Option<&'a FxHashSet<Point>>,
    /// What the first traversal decided in each sector.
    pub(crate) trails: &'a [Trail],
    /// Whether leaves that fail the topological rule are listed instead of bisected.
    pub(crate) is_last: bool,
}

/// Extracts the boundary in those sectors whose harvest is missing.
///
/// Returns the midpoints at which leaves that only the closure made must be bisected, since they
/// fail the topological rule; unless there are none, the harvests of their sectors are incomplete.
pub(crate) fn extract(
    plan: &Plan<'_>,
    budget: &Budget<'_>,
    cut: Cut<'_>,
    harvests: &mut [Option<Harvest>],
    observer: &dyn Observer,
) -> Result<Vec<Point>, Error> {
    observer.stage("extraction", Some(cut.sectors.len() as u64));
    budget.restart();
    let parts: Vec<Result<Vec<Point>, Error>> = harvests
        .par_iter_mut()
        .enumerate()
        .map_init(
            || {
                (
                    plan.walker(),
                    Extractor::default(),
                    LocalizeScratch::default(),
                    TopologyRule::default(),
                )
            },
            |(walker, extractor, scratch, topology), (at, slot)| {
                observer.advance(1);
                if let Some(done) = slot {
                    budget.add_cells(done.leaves);
                    return Ok(Vec::new());
                }
                let sector = &cut.sectors[at];
                let mut harvester = Harvester {
                    plan,
                    budget,
                    splits: cut.splits,
                    trail: cut.trails.get(at).filter(|_| plan.topology),
                    step: Step::default(),
                    untested_below: None,
                    is_last: cut.is_last,
                    topology,
                    harvest: Harvest::new(&sector.simplex),
                    doubts: Vec::new(),
                    extractor,
                    scratch,
                    pruned: Vec::new(),
                    unflushed: 0,
                    error: None,
                };
                walker.walk(sector, &mut harvester);
                harvester.flush();
                harvester.harvest.mesh.finish();
                *slot = Some(harvester.harvest);
                harvester.error.map_or(Ok(harvester.doubts), Err)
            },
        )
        .collect();
    budget.check()?;
    let mut doubts = Vec::new();
    for part in parts {
        doubts.extend(part?);
    }
    Ok(doubts)
}

/// Joins the harvests of all sectors.
pub(crate) fn gather(
    plan: &Plan<'_>,
    harvests: Vec<Option<Harvest>>,
    mut doubtful: Doubtful,
    report: &mut Report,
) -> Fragments {
    let mut meshes = Vec::with_capacity(harvests.len());
    let mut volume = VolumeGap::default();
    for harvest in harvests.into_iter().flatten() {
        report.leaves += harvest.leaves;
        report.bisections += harvest.bisections;
        report.visited += harvest.leaves + harvest.bisections;
        report.deepest_level = report.deepest_level.max(harvest.deepest_level);
        report.split_vertices += harvest.mesh.split_vertices;
        report.uncertified_leaves += harvest.uncertified_leaves;
        let room = MAX_SPOTS - report.uncertified.len();
        let listed = harvest.uncertified.into_iter().take(room);
        report.uncertified.extend(listed);
        doubtful.append(harvest.doubtful);
        volume.add(harvest.mesh.volume());
        volume.add(harvest.gap);
        meshes.push(harvest.mesh);
    }
    // The topological rule drops surfaces that do not matter to it.
    report.volume_interval = (!plan.topology).then(|| volume.of_domain(&plan.solid.domain));
    let domain: Domain = plan.solid.domain;
    let (mut fragments, tangles) = join(meshes, |unit| domain.from_unit(unit));
    let primitives = plan.solid.primitives.iter();
    let is_plane: Vec<bool> = primitives.map(|p| p.polynomial.degree() == 1).collect();
    report.crossing_leaves = untangle(&mut fragments, &tangles, &is_plane);
    let cleared = clear_specks(&mut fragments, &doubtful, &domain);
    report.specks = cleared.pieces;
    report.crumbs = cleared.faces;
    fragments
}

/// What one subtree's second traversal yields.
#[derive(Debug)]
pub(crate) struct Harvest {
    mesh: MeshBuilder,
    leaves: u64,
    bisections: u64,
    deepest_level: u8,
    /// True volume less the mesh's in the leaves.
    gap: VolumeGap,
    uncertified_leaves: u64,
    uncertified: Vec<Spot>,
    doubtful: Doubtful,
}

impl Harvest {
    fn new(root: &Simplex) -> Self {
        Self {
            mesh: MeshBuilder::new(root),
            leaves: 0,
            bisections: 0,
            deepest_level: 0,
            gap: VolumeGap::default(),
            uncertified_leaves: 0,
            uncertified: Vec::new(),
            doubtful: Doubtful::default(),
        }
    }
}

struct Harvester<'a> {
    plan: &'a Plan<'a>,
    budget: &'a Budget<'a>,
    splits: Option<&'a FxHashSet<Point>>,
    /// The first traversal's decisions, and how far they have been followed.
    trail: Option<&'a Trail>,
    step: Step,
    /// Level of the accepted simplex that is bisected all the same: what is below was never
    /// tested.
    untested_below: Option<u8>,
    is_last: bool,
    topology: &'a mut TopologyRule,
    harvest: Harvest,
    /// Where leaves that only the closure made must be bisected.
    doubts: Vec<Point>,
    extractor: &'a mut Extractor,
    scratch: &'a mut LocalizeScratch,
    pruned: Vec<FormulaNode>,
    unflushed: u64,
    error: Option<Error>,
}

impl Harvester<'_> {
    fn flush(&mut self) {
        self.budget.add_cells(std::mem::take(&mut self.unflushed));
    }

    fn extract(&mut self, simplex: &Simplex, frame: &Frame) -> Result<(), LeafError> {
        // Primitives with one sign at all four vertices do not cross the leaf's affine picture.
        let formula = if frame
            .active
            .iter()
            .all(|a| frame.side(a.primitive) == Ternary::Unknown)
        {
            &frame.formula
        } else {
            self.pruned.clear();
            let value = |p: PrimitiveId| frame.side(p.0);
            let result = localize(&frame.formula, value, &mut self.pruned, self.scratch);
            if result != Ternary::Unknown {
                return Ok(());
            }
            &self.pruned
        };
        self.extractor
            .extract(simplex, formula, frame, &mut self.harvest.mesh)
    }
}

impl Harvester<'_> {
    /// Whether to bisect, and whether the rule has seen the simplex; prunes the frame as it did.
    fn decide(&mut self, simplex: &Simplex, frame: &mut Frame) -> (bool, bool) {
        let Some(set) = self.splits else {
            return (simplex.level < self.plan.max_level, true);
        };
        let Some(trail) = self.trail else {
            return (set.contains(&simplex.midpoint()), true);
        };
        if self
            .untested_below
            .is_some_and(|level| simplex.level > level)
        {
            return (set.contains(&simplex.midpoint()), false);
        }
        self.untested_below = None;
        let (asked, pruning) = trail.follow(&mut self.step);
        frame.prune(pruning, &mut self.pruned, self.scratch);
        if frame.active.is_empty() {
            return (false, true);
        }
        let split = asked || set.contains(&simplex.midpoint());
        if split && !asked {
            self.untested_below = Some(simplex.level);
        }
        (split, true)
    }

    /// Applies the topological rule to a leaf that only the closure made; whether it must be
    /// bisected after all.
    fn fails(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        let verdict = self.topology.test(self.plan, simplex, frame);
        let pruning = self.topology.pruning();
        let Err(reason) = verdict else {
            frame.prune(pruning, &mut self.pruned, self.scratch);
            return false;
        };
        if simplex.level < self.plan.max_level && !self.is_last {
            self.doubts.push(simplex.midpoint());
            return true;
        }
        self.harvest.uncertified_leaves += 1;
        self.harvest.doubtful.push(simplex);
        if self.harvest.uncertified.len() < MAX_SPOTS {
            let spot = Spot::new(&self.plan.solid.domain, simplex, frame, reason);
            self.harvest.uncertified.push(spot);
        }
        false
    }
}

impl Visitor for Harvester<'_> {
    fn visit(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        let (split, tested) = self.decide(simplex, frame);
        if frame.active.is_empty() {
            return false;
        }
        if split {
            self.harvest.bisections += 1;
            return true;
        }
        if !tested && self.fails(simplex, frame) {
            // What is below is tested at once, so that one more round is enough for it.
            return true;
        }
        if frame.active.is_empty() {
            return false;
        }
        self.harvest.leaves += 1;
        self.harvest.deepest_level = self.harvest.deepest_level.max(simplex.level);
        if !self.doubts.is_empty() {
            // The subtree will be traversed again: only the rest of the tests matters.
            return false;
        }
        if let Err(LeafError::TooManyPrimitives(count)) = self.extract(simplex, frame) {
            let p = self
                .plan
                .solid
                .domain
                .from_unit(simplex.midpoint().position());
            self.error.get_or_insert(Error::TooManySurfaces {
                count,
                x: p.x,
                y: p.y,
                z: p.z,
            });
        }
        let tables = &self.plan.tables;
        let cut = self.extractor.cut.take();
        self.harvest.gap.add_leaf(simplex, frame, tables, cut);
        self.unflushed += 1;
        if self.unflushed == 1024 {
            self.flush();
        }
        false
    }

    fn stopped(&self) -> bool {
        self.error.is_some() || self.budget.stopped()
    }
}
