//! The topological acceptance rule: when the interpolants have the solid's topology for certain.
//!
//! `docs/topology.md` has the argument with its proof. In short: every leaf is tested on its own,
//! and if all leaves pass, moving each polynomial p straight to its piecewise affine interpolant
//! ℓ changes no component, hole, face, crease or corner on the way.
//!
//! * One surface: every gradient is less than 90° from ∇ℓ (`surface`).
//! * Two: their cones of gradients share no line, or they are apart (`pairs`).
//! * Three: their normals stay independent, or they have no common point (`triples`).
//! * Four: they have no common point (`quadruples`).
//! * The domain's walls: the formula is decided there (`walls`).
//!
//! Only surfaces on which the formula really depends together are tested, given the sign
//! patterns that were proved not to occur (`crate::patterns`).

mod combination;
pub(crate) mod kindred;
mod pairs;
mod quadruples;
mod surface;
mod triples;
mod walls;

use crate::convert::Plan;
use crate::patterns::{CROWD, Patterns};
use crate::settings::Reason;
use crate::simplex::Simplex;
use crate::walk::{Frame, Pruning};
use arrayvec::ArrayVec;
use csg::{FormulaNode, LocalizeScratch};
use kindred::Kin;
use surface::{Cone, LeafFrame, Surface};

/// Tests leaves; holds only work space between them.
#[derive(Debug, Default)]
pub(crate) struct TopologyRule {
    pruning: Pruning,
    open: Vec<(usize, Patterns)>,
    pruned: Vec<FormulaNode>,
    scratch: LocalizeScratch,
}

impl TopologyRule {
    /// Whether the interpolants have the solid's topology in a leaf, as far as the leaf goes.
    ///
    /// # Errors
    /// Why it cannot be told.
    pub(crate) fn test(
        &mut self,
        plan: &Plan<'_>,
        simplex: &Simplex,
        frame: &Frame,
    ) -> Result<(), Reason> {
        self.pruning = Pruning::default();
        let count = frame.active.len();
        if count > CROWD {
            return Err(Reason::Crowded);
        }
        let leaf_frame = LeafFrame::new(simplex);
        let mut surfaces = ArrayVec::<Surface<'_>, CROWD>::new();
        for active in &frame.active {
            let table = &plan.tables[active.degree as usize - 1];
            let coefficients = frame.coefficients_of(active);
            let kin = plan.families[active.primitive as usize];
            surfaces.push(Surface::new(table, coefficients, active, &leaf_frame, kin));
        }
        let local = |primitive: u32| {
            let found = frame.active.iter().position(|a| a.primitive == primitive);
            found.unwrap_or(0)
        };
        let mut leaf = Leaf {
            frame: &leaf_frame,
            differences: [[Difference::Unknown; CROWD]; CROWD],
            formula: Patterns::of_formula(&frame.formula, local, &mut self.open),
            feasible: Patterns::ALL,
            labelled: plan.labelled,
        };
        let verdict = leaf.test_surfaces(&mut surfaces);
        self.pruning = leaf.pruning(count);
        verdict?;
        for apex in walls::wall_facets(simplex) {
            let (pruned, scratch) = (&mut self.pruned, &mut self.scratch);
            if !walls::is_decided(frame, apex, pruned, scratch) {
                return Err(Reason::Wall);
            }
        }
        Ok(())
    }
}

impl TopologyRule {
    /// What the last leaf tested can do without.
    pub(crate) fn pruning(&self) -> Pruning {
        self.pruning
    }
}

/// The cone of a difference of kin.
#[derive(Clone, Copy, Debug)]
enum Difference {
    Unknown,
    None,
    Cone(Cone),
}

/// What is known of a leaf.
#[derive(Debug)]
struct Leaf<'a> {
    frame: &'a LeafFrame,
    /// Cones of differences of kin, the larger index first.
    differences: [[Difference; CROWD]; CROWD],
    /// The patterns inside the solid.
    formula: Patterns,
    /// The patterns that are not proved to be absent.
    feasible: Patterns,
    /// Whether other patterns than those of the set matter.
    labelled: bool,
}

impl Leaf<'_> {
    /// Whether the boundary depends on these primitives together somewhere in the leaf.
    fn needs(&self, members: &[usize]) -> bool {
        if self.labelled {
            // Which material a face shows may turn on any primitive.
            return !self.feasible.all_signs_of(members).is_empty();
        }
        self.formula.depends_jointly(self.feasible, members)
    }

    fn exclude(&mut self, pattern: Patterns) {
        self.feasible = self.feasible.intersection(pattern.complement());
    }

    fn test_surfaces(&mut self, surfaces: &mut [Surface<'_>]) -> Result<(), Reason> {
        let mut unruly = ArrayVec::<usize, CROWD>::new();
        for (at, surface) in surfaces.iter_mut().enumerate() {
            if self.needs(&[at]) {
                surface.cone = surface.find_cone(self.frame);
                if surface.cone.is_none() {
                    unruly.push(at);
                }
            }
        }
        for &at in &unruly {
            if !self.is_hidden(surfaces, at) {
                return Err(Reason::Singular);
            }
        }
        self.test_pairs(surfaces)?;
        self.test_triples(surfaces)?;
        self.test_quadruples(surfaces)
    }

    /// Whether others hide a surface wherever it passes, such as that of a ball inside another one.
    fn is_hidden(&mut self, surfaces: &[Surface<'_>], at: usize) -> bool {
        for other in 0..surfaces.len() {
            if other == at || !self.needs(&[at.min(other), at.max(other)]) {
                continue;
            }
            if let Some(pattern) = pairs::apart(surfaces, at.min(other), at.max(other)) {
                self.exclude(pattern);
                if !self.needs(&[at]) {
                    return true;
                }
            }
        }
        false
    }

    /// The primitives that the formula can do without, given the patterns that do not occur.
    fn pruning(&self, count: usize) -> Pruning {
        let mut pruning = Pruning::default();
        if self.labelled {
            return pruning;
        }
        let mut formula = self.formula;
        for at in 0..count {
            let turns = formula
                .difference(formula.flipped(at))
                .intersection(self.feasible);
            // Only where it is outside does it matter that it is not inside.
            for inside in [false, true] {
                if turns.intersection(Patterns::with(at, !inside)).is_empty() {
                    let kept = formula.intersection(Patterns::with(at, inside));
                    formula = kept.union(kept.flipped(at));
                    let set = if inside {
                        &mut pruning.inside
                    } else {
                        &mut pruning.outside
                    };
                    *set |= 1 << at;
                    break;
                }
            }
        }
        pruning
    }

    /// The cones with which some surfaces are tested together: of those that are kin, the first
    /// one's own and those of the others' differences from it.
    fn cones<const N: usize>(
        &mut self,
        surfaces: &[Surface<'_>],
        members: [usize; N],
    ) -> Option<[Cone; N]> {
        let mut cones = ArrayVec::<Cone, N>::new();
        for (m, &at) in members.iter().enumerate() {
            let kin = |other: &&usize| Kin::joins(surfaces[**other].kin, surfaces[at].kin);
            let cone = match members[..m].iter().find(kin) {
                Some(&first) => self.difference(surfaces, at, first),
                None => surfaces[at].cone,
            };
            cones.push(cone?);
        }
        cones.into_inner().ok()
    }

    fn difference(&mut self, surfaces: &[Surface<'_>], at: usize, first: usize) -> Option<Cone> {
        let known = &mut self.differences[at][first];
        if matches!(known, Difference::Unknown) {
            let cone = surfaces[first].cone_of_difference(&surfaces[at], self.frame);
            *known = cone.map_or(Difference::None, Difference::Cone);
        }
        match known {
            Difference::Cone(cone) => Some(*cone),
            _ => None,
        }
    }

    fn test_pairs(&mut self, surfaces: &[Surface<'_>]) -> Result<(), Reason> {
        for j in 0..surfaces.len() {
            for i in 0..j {
                if !self.needs(&[i, j]) {
                    continue;
                }
                let cones = self.cones(surfaces, [i, j]);
                if !cones.is_some_and(|[a, b]| pairs::transversal(&a, &b)) {
                    let pattern = pairs::apart(surfaces, i, j).ok_or(Reason::Tangent)?;
                    self.exclude(pattern);
                }
            }
        }
        Ok(())
    }

    fn test_triples(&mut self, surfaces: &[Surface<'_>]) -> Result<(), Reason> {
        for k in 0..surfaces.len() {
            for j in 0..k {
                for i in 0..j {
                    let members = [i, j, k];
                    if !self.needs(&members) {
                        continue;
                    }
                    let cones = self.cones(surfaces, members);
                    if !cones.is_some_and(|cones| triples::independent(&cones)) {
                        let pattern = triples::apart(surfaces, members).ok_or(Reason::Tangent)?;
                        self.exclude(pattern);
                    }
                }
            }
        }
        Ok(())
    }

    fn test_quadruples(&mut self, surfaces: &[Surface<'_>]) -> Result<(), Reason> {
        for i in 0..surfaces.len() {
            for j in 0..i {
                for k in 0..j {
                    for l in 0..k {
                        let members = [l, k, j, i];
                        if !self.needs(&members) {
                            continue;
                        }
                        let pattern = quadruples::apart(surfaces, members);
                        self.exclude(pattern.ok_or(Reason::Concurrent)?);
                    }
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
