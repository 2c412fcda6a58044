//! One solid in four positions of the domain, and by the metric rule.

use crate::{Structure, metric, topology};
use csg::{DomainFit, Model, Solid};
use glam::DVec3;

/// The domain's size and position must not matter: four of them.
fn fits() -> [DomainFit; 4] {
    let fit = |margin, x, y, z| DomainFit::new(margin, DVec3::new(x, y, z)).unwrap();
    [
        DomainFit::default(),
        fit(1.193_17, -0.041_73, 0.031_97, 0.050_31),
        fit(1.414_91, 0.073_97, 0.101_33, -0.057_19),
        fit(1.733_77, -0.130_71, -0.089_33, 0.171_39),
    ]
}

/// What was found in several conversions of one solid.
#[derive(Default)]
pub(crate) struct Verdict {
    /// The topology is proved in all positions.
    pub(crate) certified: bool,
    /// In all positions together.
    pub(crate) leaves: u64,
    /// The tolerance at which the metric rule has the same structure, if it certifies all leaves.
    pub(crate) metric: Option<f64>,
}

impl Verdict {
    pub(crate) fn summary(all: &[Self]) -> String {
        let proved = all.iter().filter(|v| v.certified).count();
        let leaves: u64 = all.iter().map(|v| v.leaves).sum();
        let at = TOLERANCES.map(|t| all.iter().filter(|v| v.metric == Some(t)).count());
        format!(
            "{} solids: {proved} proved in all positions, {leaves} leaves; the metric rule agrees \
             at {TOLERANCES:?} of the diagonal for {at:?} solids",
            all.len()
        )
    }
}

/// Fractions of the diagonal for the metric rule. It proves distances only: faces and parts smaller
/// than the tolerance may come out wrong, so where it differs, a finer one must agree.
const TOLERANCES: [f64; 5] = [1e-2, 2e-3, 4e-4, 8e-5, 1.6e-5];

/// Converts a model in all positions of the domain, and by the metric rule.
///
/// `finest`: cells at which the proof gives up, as a fraction of the diagonal.
pub(crate) fn compare(model: &Model, finest: f64, name: &dyn Fn() -> String) -> Verdict {
    let solids = fits().map(|fit| {
        Solid::build_fitted(model, None, fit).unwrap_or_else(|error| panic!("{}: {error}", name()))
    });
    let mut verdict = Verdict {
        certified: true,
        ..Verdict::default()
    };
    if solids[0].primitives.is_empty() {
        return verdict;
    }
    let mut known: Option<Structure> = None;
    for (at, solid) in solids.iter().enumerate() {
        let coarse = topology(solid.clone(), finest);
        verdict.leaves += coarse.report.leaves;
        if coarse.report.proved_topology != Some(true) {
            verdict.certified = false;
            continue;
        }
        let structure = Structure::of(&coarse);
        if let Some(known) = &known {
            assert_eq!(&structure, known, "position {at} of {}", name());
        }
        known = Some(structure);
    }
    let Some(known) = known else {
        return verdict;
    };
    let mut seen = Vec::new();
    for tolerance in TOLERANCES {
        let fine = metric(solids[0].clone(), tolerance);
        if fine.report.uncertified_leaves > 0 {
            continue;
        }
        let structure = Structure::of(&fine);
        if structure == known {
            verdict.metric = Some(tolerance);
            return verdict;
        }
        seen.push(structure);
    }
    if seen.is_empty() {
        return verdict;
    }
    panic!("proved: {known:?}\nmetric: {seen:?}\n{}", name());
}
