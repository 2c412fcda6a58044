//! The adaptive simplicial subdivision (SSA) as [`convert`](crate::convert()) walks it, counted
//! the way the thesis counts.

use super::reduction::Reducer;
use super::signs::{Judge, value};
use super::{Cell, Found};
use crate::bernstein::count;
use crate::blossom::RootCoefficients;
use crate::classify::Criterion;
use crate::simplex::Simplex;
use crate::walk::{Frame, Visitor, Walker};
use csg::{FormulaNode, Solid};

/// Where bisection ends above the level asked for.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Halt {
    /// Nowhere: all leaves have the same level.
    #[default]
    Never,
    /// Where a single plane bounds the solid (PrimitivaLinear, Algorithm 4.3).
    AtPlanes,
}

/// What the subdivision did.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Adaptive {
    /// What it found in its leaves.
    pub found: Found,
    /// Leaves that the criterion leaves open, whether the boundary passes there or not ("Simp.
    /// Inter.": the thesis' tables obey simplices(n + 1) = simplices(n) + 2·front(n)).
    pub front: u64,
    /// Primitives in the pruned formulas of those leaves ("Prim. Inter.", what the thesis calls
    /// MAO; in the same way classifications(n + 1) = classifications(n) + 2·front_primitives(n)).
    pub front_primitives: u64,
    /// Simplices made, the six roots included ("Tot. Simp.").
    pub simplices: u64,
    /// Primitives classified in simplices ("Class. Prim.", the evaluations of Tables 6.2–6.4).
    pub classifications: u64,
    /// Those among them whose result the parent's vertices do not show: the primitive has one sign
    /// at the three vertices that a child keeps.
    pub doubtful: u64,
    /// Evaluations by de Casteljau: at the roots one for each primitive, and one at the middle of
    /// the refinement edge, which serves both children.
    pub evaluations: u64,
    /// Bernstein coefficients halved.
    pub coefficients: u64,
    /// Simplices bisected although none of their descendants is F-intersecting ("Sub. Indev.").
    pub wrongly_bisected: u64,
}

/// Subdivides down to `level` (at most [`MAX_LEVEL`](crate::MAX_LEVEL)).
#[must_use]
pub fn adaptive(solid: &Solid, criterion: Criterion, level: u8, halt: Halt) -> Adaptive {
    run(solid, criterion, level, halt, None)
}

/// As [`adaptive()`], with degrees lowered on the way (thesis 6.3.2): in a simplex whose edges are
/// k times those of the smallest ones, a polynomial may be off by `allowed`/k times the width of
/// its range there, so that its zero set stays within about `allowed` of a smallest simplex.
#[must_use]
pub fn adaptive_reduced(
    solid: &Solid,
    criterion: Criterion,
    level: u8,
    halt: Halt,
    allowed: f64,
) -> Adaptive {
    let degrees = solid.primitives.iter().map(|p| p.polynomial.degree());
    let reducer = Reducer::new(degrees.max().unwrap_or(0), level, allowed);
    run(solid, criterion, level, halt, Some(reducer))
}

fn run(
    solid: &Solid,
    criterion: Criterion,
    level: u8,
    halt: Halt,
    reducer: Option<Reducer>,
) -> Adaptive {
    let level = level.min(crate::MAX_LEVEL);
    let primitives = solid.primitives.len();
    let roots: Vec<_> = solid.primitives.iter().map(RootCoefficients::new).collect();
    let mut walker = Walker::new(solid, criterion, None);
    let at_roots = 6 * primitives as u64;
    let mut count = Count {
        done: Adaptive {
            simplices: 6,
            classifications: at_roots,
            doubtful: at_roots,
            evaluations: at_roots,
            ..Adaptive::default()
        },
        level,
        halt,
        judge: Judge::new(primitives),
        open: Vec::new(),
        reducer,
    };
    for sector in walker.roots(solid, &roots) {
        walker.walk(&sector, &mut count);
        count.close(0);
    }
    count.done.found = count.done.found.sorted();
    count.done
}

/// A bisected simplex whose descendants are being visited.
struct Open {
    level: u8,
    found: bool,
}

struct Count {
    done: Adaptive,
    level: u8,
    halt: Halt,
    judge: Judge,
    open: Vec<Open>,
    reducer: Option<Reducer>,
}

impl Visitor for Count {
    fn visit(&mut self, simplex: &Simplex, frame: &mut Frame) -> bool {
        self.close(simplex.level);
        let is_leaf = simplex.level == self.level || self.halt == Halt::AtPlanes && is_plane(frame);
        if is_leaf {
            self.leaf(simplex, frame);
        } else {
            // A term of highest degree shrinks in three levels, when simplices are halved.
            if let Some(reducer) = self.reducer.as_mut().filter(|_| simplex.kind() == 0) {
                reducer.reduce(simplex.level, frame);
            }
            self.bisection(frame);
            let level = simplex.level;
            self.open.push(Open {
                level,
                found: false,
            });
        }
        !is_leaf
    }
}

fn is_plane(frame: &Frame) -> bool {
    matches!(frame.formula[..], [FormulaNode::Literal(_)])
        && frame.active.iter().all(|active| active.degree == 1)
}

impl Count {
    fn leaf(&mut self, simplex: &Simplex, frame: &Frame) {
        for active in &frame.active {
            let values = frame.values_of(active);
            let inside = values.iter().filter(|v| **v <= 0.0).count();
            let value = value(inside, 4);
            self.judge.note(active.primitive as usize, value);
        }
        self.done.front += 1;
        self.done.front_primitives += frame.active.len() as u64;
        let primitives = self.judge.undecided(&frame.formula);
        if primitives > 0 {
            self.done.found.cells.push(cell(simplex));
            self.done.found.optimal_evaluations += primitives;
            if let Some(parent) = self.open.last_mut() {
                parent.found = true;
            }
        }
    }

    fn bisection(&mut self, frame: &Frame) {
        self.done.simplices += 2;
        self.done.classifications += 2 * frame.active.len() as u64;
        self.done.evaluations += frame.active.len() as u64;
        for active in &frame.active {
            self.done.coefficients += count(active.degree as usize) as u64;
            let [v0, v1, v2, v3] = frame.values_of(active).map(|v| v <= 0.0);
            self.done.doubtful += u64::from(v1 == v2 && v0 == v1);
            self.done.doubtful += u64::from(v1 == v2 && v3 == v1);
        }
    }

    /// Ends the bisected simplices of this level and deeper: their descendants are done.
    fn close(&mut self, level: u8) {
        while self.open.last().is_some_and(|open| open.level >= level) {
            let found = self.open.pop().is_some_and(|open| open.found);
            self.done.wrongly_bisected += u64::from(!found);
            if let Some(parent) = self.open.last_mut() {
                parent.found |= found;
            }
        }
    }
}

pub(super) fn cell(simplex: &Simplex) -> Cell {
    let mut cell = simplex.vertices.map(crate::lattice::Point::coordinates);
    cell.sort_unstable();
    cell
}
