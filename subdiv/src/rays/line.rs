//! One ray in one simplex: each polynomial becomes univariate, and the formula is followed along.

use super::roots::{Roots, is_negative};
use crate::leaf_formula::{Label, LeafFormula, Pattern};
use crate::walk::Frame;
use csg::{FormulaNode, MaterialId, PrimitiveId, Sense};

/// Where a ray enters the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// At which part of its way through the simplex, 0 to 1.
    pub part: f64,
    /// The surface that it crosses.
    pub primitive: PrimitiveId,
    /// What is behind it.
    pub label: Label,
}

/// Walls that take less of a ray's way through a simplex are rounding.
const THINNEST: f64 = 1e-11;

/// Work space.
#[derive(Debug, Default)]
pub(super) struct Line {
    formula: LeafFormula,
    /// Place of each of the formula's primitives among the frame's active ones.
    places: Vec<usize>,
    layers: [Vec<f64>; 2],
    univariate: Vec<f64>,
    roots: Roots,
    /// Where which of the formula's primitives changes its sign.
    events: Vec<(f64, usize)>,
    /// How near the ray's beginning is to each of the formula's primitives, by value.
    nearness: Vec<f64>,
}

impl Line {
    /// Prepares for rays in a simplex.
    pub(super) fn load(&mut self, frame: &Frame) {
        self.formula.load(&frame.formula);
        self.places.clear();
        let active = &frame.active;
        for primitive in &self.formula.primitives {
            let found = active.binary_search_by_key(primitive, |a| a.primitive);
            self.places.extend(found.ok());
        }
    }

    /// The first place between two points, given by barycentric coordinates, behind which the
    /// formula holds.
    pub(super) fn entry(&mut self, frame: &Frame, ends: [[f64; 4]; 2]) -> Option<Entry> {
        self.events.clear();
        self.nearness.clear();
        let mut pattern: Pattern = 0;
        for (local, &place) in self.places.iter().enumerate() {
            let active = &frame.active[place];
            let degree = active.degree as usize;
            let coefficients = frame.coefficients_of(active);
            restrict(
                degree,
                coefficients,
                ends,
                &mut self.layers,
                &mut self.univariate,
            );
            let first = self.univariate[0];
            pattern |= Pattern::from(is_negative(first)) << local;
            self.nearness
                .push(first.abs() / active.largest.max(f64::MIN_POSITIVE));
            let roots = self.roots.of(&self.univariate);
            self.events.extend(roots.iter().map(|root| (*root, local)));
        }
        if self.formula.value(pattern) {
            // The simplex before ought to have found it, a rounding error earlier.
            let near = |a: &usize, b: &usize| self.nearness[*a].total_cmp(&self.nearness[*b]);
            let mut order: Vec<usize> = (0..self.places.len()).collect();
            order.sort_by(near);
            return Some(self.enter(frame, 0.0, &order, pattern));
        }
        self.events
            .sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut at = 0;
        while let Some(&(part, _)) = self.events.get(at) {
            let first = at;
            while let Some((_, local)) = self.events.get(at).filter(|e| e.0 - part <= THINNEST) {
                pattern ^= 1 << local;
                at += 1;
            }
            if self.formula.value(pattern) {
                let crossed: Vec<usize> = self.events[first..at].iter().map(|e| e.1).collect();
                return Some(self.enter(frame, part, &crossed, pattern));
            }
        }
        None
    }

    /// An entry through the first of these surfaces at which the formula turns, given what is
    /// behind it; through the first one if it takes several.
    fn enter(&mut self, frame: &Frame, part: f64, surfaces: &[usize], behind: Pattern) -> Entry {
        let mut labels = surfaces
            .iter()
            .filter_map(|&local| Some((local, self.formula.label(local, behind)?)));
        let (local, label) = labels.next().unwrap_or_else(|| {
            let local = surfaces[0];
            let inside = behind >> local & 1 == 1;
            let of_surface = |node: &FormulaNode| match node {
                FormulaNode::Literal(literal) => (literal.primitive.0
                    == self.formula.primitives[local])
                    .then_some(literal.material),
                _ => None,
            };
            let material = frame.formula.iter().find_map(of_surface);
            let label = Label {
                sense: if inside {
                    Sense::Inside
                } else {
                    Sense::Outside
                },
                material: material.unwrap_or(MaterialId(0)),
            };
            (local, label)
        });
        let primitive = PrimitiveId(self.formula.primitives[local]);
        Entry {
            part,
            primitive,
            label,
        }
    }
}

/// Steps of de Casteljau's algorithm that [`restrict`] takes, one for each coefficient.
pub(super) fn steps(degree: usize) -> usize {
    // The sum over all m < n of count(m), once along the first end and once for each start.
    let n = degree;
    n * (n + 1) * (n + 2) * (n + 3) * (n + 9) / 120
}

/// Bernstein coefficients of a polynomial along the segment between two points: number j is its
/// blossom at the first point n−j times and at the second one j times.
fn restrict(
    degree: usize,
    coefficients: &[f64],
    [first, second]: [[f64; 4]; 2],
    [outer, inner]: &mut [Vec<f64>; 2],
    univariate: &mut Vec<f64>,
) {
    univariate.clear();
    outer.clear();
    outer.extend_from_slice(coefficients);
    for left in (0..=degree).rev() {
        inner.clear();
        inner.extend_from_slice(outer);
        for below in (0..left).rev() {
            lower(below, inner, first);
        }
        univariate.push(inner[0]);
        if let Some(below) = left.checked_sub(1) {
            lower(below, outer, second);
        }
    }
}

/// One step of de Casteljau's algorithm, in place, to the form of this degree.
fn lower(degree: usize, c: &mut Vec<f64>, [w0, w1, w2, w3]: [f64; 4]) {
    let mut at = 0;
    for m in 0..=degree {
        // How far the coefficient with one more of v1 stands from the one with one more of v0.
        let one = (m + 1) * (m + 2) / 2;
        for q in 0..=m {
            let two = one + q + 1;
            for _ in 0..=q {
                c[at] = w0 * c[at] + w1 * c[at + one] + w2 * c[at + two] + w3 * c[at + two + 1];
                at += 1;
            }
        }
    }
    c.truncate(at);
}
