//! Second traversal: bisects where the closed set of midpoints says so and extracts the leaves.

use crate::convert::Plan;
use crate::error::Error;
use crate::extract::{Extractor, LeafError};
use crate::fragments::Fragments;
use crate::lattice::Point;
use crate::limits::Budget;
use crate::mesh::{MeshBuilder, join};
use crate::predicates::{Sign, vertex_sign};
use crate::settings::{Observer, Report};
use crate::simplex::Simplex;
use crate::walk::{Frame, Sector, Visitor};
use csg::{Domain, FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// The boundary in all sectors; `splits`: the midpoints to bisect at, `None` for a fixed level.
pub(crate) fn extract(
    plan: &Plan<'_>,
    budget: &Budget<'_>,
    sectors: &[Sector],
    splits: Option<&FxHashSet<Point>>,
    report: &mut Report,
    observer: &dyn Observer,
) -> Result<Fragments, Error> {
    observer.stage("extraction", Some(sectors.len() as u64));
    budget.restart();
    let parts: Vec<Result<Harvest, Error>> = sectors
        .par_iter()
        .map_init(
            || {
                (
                    plan.walker(),
                    Extractor::default(),
                    LocalizeScratch::default(),
                )
            },
            |(walker, extractor, scratch), sector| {
                let mut harvester = Harvester {
                    plan,
                    budget,
                    splits,
                    harvest: Harvest::new(&sector.simplex),
                    extractor,
                    scratch,
                    pruned: Vec::new(),
                    unflushed: 0,
                    error: None,
                };
                walker.walk(sector, &mut harvester);
                harvester.flush();
                observer.advance(1);
                harvester.harvest.mesh.finish();
                harvester.error.map_or(Ok(harvester.harvest), Err)
            },
        )
        .collect();
    budget.check()?;
    let mut meshes = Vec::with_capacity(parts.len());
    for part in parts {
        let harvest = part?;
        report.leaves += harvest.leaves;
        report.bisections += harvest.bisections;
        report.visited += harvest.leaves + harvest.bisections;
        report.deepest_level = report.deepest_level.max(harvest.deepest_level);
        report.split_vertices += harvest.mesh.split_vertices;
        meshes.push(harvest.mesh);
    }
    let domain: Domain = plan.solid.domain;
    Ok(join(meshes, |unit| domain.to_model(unit)))
}

/// What one subtree's second traversal yields.
#[derive(Debug)]
struct Harvest {
    mesh: MeshBuilder,
    leaves: u64,
    bisections: u64,
    deepest_level: u8,
}

impl Harvest {
    fn new(root: &Simplex) -> Self {
        Self {
            mesh: MeshBuilder::new(root),
            leaves: 0,
            bisections: 0,
            deepest_level: 0,
        }
    }
}

struct Harvester<'a> {
    plan: &'a Plan<'a>,
    budget: &'a Budget<'a>,
    splits: Option<&'a FxHashSet<Point>>,
    harvest: Harvest,
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
        let side = |primitive: u32| {
            let found = frame.active.iter().find(|a| a.primitive == primitive);
            let Some(active) = found else {
                return Ternary::Unknown;
            };
            let signs = frame.values_of(active).map(vertex_sign);
            if signs != [signs[0]; 4] {
                Ternary::Unknown
            } else if signs[0] == Sign::Negative {
                Ternary::In
            } else {
                Ternary::Out
            }
        };
        let formula = if frame
            .active
            .iter()
            .all(|a| side(a.primitive) == Ternary::Unknown)
        {
            &frame.formula
        } else {
            self.pruned.clear();
            let value = |p: PrimitiveId| side(p.0);
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

impl Visitor for Harvester<'_> {
    fn visit(&mut self, simplex: &Simplex, frame: &Frame) -> bool {
        let split = match self.splits {
            Some(set) => set.contains(&simplex.midpoint()),
            None => simplex.level < self.plan.max_level,
        };
        if split {
            self.harvest.bisections += 1;
            return true;
        }
        self.harvest.leaves += 1;
        self.harvest.deepest_level = self.harvest.deepest_level.max(simplex.level);
        if let Err(LeafError::TooManyPrimitives(count)) = self.extract(simplex, frame) {
            let p = self
                .plan
                .solid
                .domain
                .to_model(simplex.midpoint().position());
            self.error.get_or_insert(Error::TooManySurfaces {
                count,
                x: p.x,
                y: p.y,
                z: p.z,
            });
        }
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
