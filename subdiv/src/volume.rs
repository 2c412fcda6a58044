//! How much the mesh's volume may differ from the true solid's, leaf by leaf.
//!
//! Simplices proved empty or full are so in the mesh, too. In a leaf with one primitive
//! p = ℓ + r, r between r₀ ≤ 0 and r₁ ≥ 0, the true inside {p ≤ 0} holds {ℓ ≤ −r₁} and is held by
//! {ℓ ≤ −r₀}: volumes between a simplex' vertex values, against the part that the mesh cuts off.
//! In other leaves true solid and mesh agree wherever all |p| > ω (`crate::certify`), so they differ
//! at most where some ℓ lies in [−ω − r₁, ω − r₀]. Neither needs the leaf to be certified.

use crate::certify::{DegreeTable, remainder_bounds};
use crate::simplex::Simplex;
use crate::snap::RESIDUAL;
use crate::walk::{Active, Frame};
use csg::{Domain, Sense};

/// Roundings of a fraction, amply: positions have absolute errors, edges of level l are no shorter
/// than 2^(−l/3 − 1).
fn rounding(simplex: &Simplex) -> f64 {
    1e-13 * (f64::from(simplex.level) / 3.0).exp2()
}

/// Bounds of true volume less mesh volume, in the domain's own units.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub(crate) struct VolumeGap {
    /// The least.
    pub low: f64,
    /// The largest.
    pub high: f64,
}

impl VolumeGap {
    /// Adds the gap of another part.
    pub(crate) fn add(&mut self, other: Self) {
        self.low += other.low;
        self.high += other.high;
    }

    /// Bounds in model units, when the sum is of a whole solid.
    #[must_use]
    pub(crate) fn of_domain(self, domain: &Domain) -> [f64; 2] {
        // Sums of numbers of one magnitude: 2²⁰ roundings and more to spare.
        let slack = 1e-12 * (self.low.abs() + self.high.abs());
        let scale = domain.size().powi(3);
        [
            ((self.low - slack) * scale).max(0.0),
            (self.high + slack) * scale,
        ]
    }

    /// Adds a leaf; `cut`: the fraction that the mesh leaves on the negative side of the only
    /// primitive, and the sense in which the solid lies there.
    pub(crate) fn add_leaf(
        &mut self,
        simplex: &Simplex,
        frame: &Frame,
        tables: &[DegreeTable],
        cut: Option<(f64, Sense)>,
    ) {
        let rounding = rounding(simplex);
        let (low, high) = if let ([active], Some((fraction, sense))) = (&frame.active[..], cut) {
            let values = frame.values_of(active);
            let [least, most] = remainder(active, frame, tables);
            let low = below(values, -most) - fraction - rounding;
            let high = below(values, -least) - fraction + rounding;
            match sense {
                Sense::Inside => (low, high),
                Sense::Outside => (-high, -low),
            }
        } else {
            let slab = |active: &Active| {
                let values = frame.values_of(active);
                let [least, most] = remainder(active, frame, tables);
                let swing = most - least + 2.0 * RESIDUAL * active.largest;
                below(values, swing - least) - below(values, -swing - most) + rounding
            };
            let sum: f64 = frame.active.iter().map(slab).sum();
            let sum = sum.min(1.0);
            (-sum, sum)
        };
        // Half the volume at each level, from a sixth of the cube.
        let volume = (-f64::from(simplex.level)).exp2() / 6.0;
        self.low += volume * low;
        self.high += volume * high;
    }
}

/// r₀ and r₁, coefficients' errors included.
fn remainder(active: &Active, frame: &Frame, tables: &[DegreeTable]) -> [f64; 2] {
    let table = &tables[active.degree as usize - 1];
    let (low, high) = remainder_bounds(table, frame.coefficients_of(active));
    // The coefficient, its affine value and their difference.
    let error = 3.0 * active.error();
    [low - error, high + error]
}

/// Fraction of a simplex in which the affine function with these vertex values is below `level`.
#[must_use]
pub(crate) fn below(values: [f64; 4], level: f64) -> f64 {
    let mut v = values.map(|value| value - level);
    v.sort_by(f64::total_cmp);
    let negative = v.iter().filter(|x| **x < 0.0).count();
    let part = |from: usize, to: usize| v[from] / (v[from] - v[to]);
    match negative {
        0 => 0.0,
        1 => part(0, 1) * part(0, 2) * part(0, 3),
        2 => wedge([part(0, 2), part(0, 3), part(1, 2), part(1, 3)]),
        3 => 1.0 - part(3, 0) * part(3, 1) * part(3, 2),
        _ => 1.0,
    }
}

/// Fraction of a simplex a b c d on the side of a and b of the two triangles with the diagonal
/// ac–bd between the points ac, ad, bc, bd, each given by its place on the way from a or b.
#[must_use]
pub(crate) fn wedge([ac, ad, bc, bd]: [f64; 4]) -> f64 {
    ac * ad + ac * bd * (1.0 - ad) + bc * bd * (1.0 - ac)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// The cubic B-spline's integral: f = Σ over negative v_i of v_i³/Π (v_i − v_j).
        #[test]
        fn fractions_are_divided_differences(v in proptest::array::uniform4(-1.0..1.0f64)) {
            let gap = (0..4).flat_map(|i| (0..i).map(move |j| (i, j)));
            prop_assume!(gap.into_iter().all(|(i, j)| (v[i] - v[j]).abs() > 0.01));
            let term = |i: usize| {
                let others = (0..4).filter(|j| *j != i);
                v[i].powi(3) / others.map(|j| v[i] - v[j]).product::<f64>()
            };
            let expected: f64 = (0..4).filter(|i| v[*i] < 0.0).map(term).sum();
            prop_assert!((below(v, 0.0) - expected).abs() < 1e-9);
        }
    }
}
