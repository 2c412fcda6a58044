//! What the rule needs of one primitive in one leaf: its coefficients, how far they may be off,
//! and the cone of its gradients.
//!
//! Rounding. Let u = 2⁻⁵³, ε the bound on the error of the coefficients c, and M = max |c|. Every
//! test here holds for *all* coefficients within ε of the stored ones, so both for the true
//! polynomial and for the stored one. `noise` is ε + 16uM and bounds linear combinations
//! (`crate::topology::combination`).
//!
//! The gradients of the barycentric coordinates of a Kuhn simplex are small integers times powers of
//! two, hence exact; a component of a control gradient (without the degree as factor) is a sum of
//! four products with them. Let Γ be the largest sum of magnitudes in a component, which grows as
//! the simplex shrinks. Only what halving rounded, ε_h, is multiplied by it. What the root's
//! coefficients were off by, ε_r, is the restriction of one polynomial on the root, where Γ is 2;
//! and the model's error ε_m bounds the coefficients of the error's derivatives, divided by the
//! degree, as it bounds those of the error. So a component is off by at most
//! Γ·(ε_h + 8uM) + 2ε_r + ε_m: four roundings relative to ΓM, and as many to spare.

use crate::certify::{BarycentricGradients, DegreeTable, barycentric_gradients};
use crate::rounding::UNIT_ROUNDOFF;
use crate::simplex::Simplex;
use crate::topology::kindred::Kin;
use crate::walk::Active;
use glam::DVec3;

/// One primitive in one leaf, or the difference of two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surface<'a> {
    /// Index tables for its degree.
    pub(crate) table: &'a DegreeTable,
    /// Its Bernstein coefficients.
    pub(crate) coefficients: &'a [f64],
    /// Its values at the vertices.
    pub(crate) values: [f64; 4],
    /// ε + 16uM.
    pub(crate) noise: f64,
    /// Bound on the rounding of a component of ∇ℓ: 8ΓuM.
    slope_noise: f64,
    /// Bound on the error of a component of a control gradient.
    gradient_noise: f64,
    /// ∇ℓ of its affine interpolant.
    pub(crate) slope: DVec3,
    /// |∇ℓ|, or 1 where that vanishes.
    pub(crate) steepness: f64,
    /// Its family among the quadrics.
    pub(crate) kin: Option<Kin>,
    /// Its cone, once it is known.
    pub(crate) cone: Option<Cone>,
}

/// A circular cone that holds all gradients of a primitive in a leaf and that of its interpolant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    /// Unit vector along ∇ℓ.
    pub(crate) axis: DVec3,
    /// Tangent of its half-angle, which is below 90°.
    pub(crate) tangent: f64,
    /// Bound on the angle between the axis and the true ∇ℓ, in radians.
    pub(crate) wobble: f64,
}

/// The gradients of the barycentric coordinates in a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafFrame {
    gradients: BarycentricGradients,
    /// Γ: the sum of their magnitudes in each component, the largest of the three.
    magnification: f64,
}

impl LeafFrame {
    /// That of a simplex.
    #[must_use]
    pub(crate) fn new(simplex: &Simplex) -> Self {
        let gradients = barycentric_gradients(simplex);
        let sum: DVec3 = gradients.iter().map(|g| g.abs()).sum();
        Self {
            gradients,
            magnification: sum.max_element(),
        }
    }
}

impl<'a> Surface<'a> {
    /// An active primitive with its coefficients.
    #[must_use]
    pub(crate) fn new(
        table: &'a DegreeTable,
        coefficients: &'a [f64],
        active: &Active,
        frame: &LeafFrame,
        kin: Option<Kin>,
    ) -> Self {
        let halving = active.rounding - active.root_rounding;
        let slope_noise = frame.magnification * (8.0 * UNIT_ROUNDOFF * active.largest);
        let inherited = 2.0 * (active.root_rounding + active.model_error);
        Self {
            noise: active.error() + 16.0 * UNIT_ROUNDOFF * active.largest,
            slope_noise,
            gradient_noise: frame.magnification * halving + slope_noise + inherited,
            kin,
            ..Self::without_noise(table, coefficients, frame)
        }
    }

    fn without_noise(table: &'a DegreeTable, coefficients: &'a [f64], frame: &LeafFrame) -> Self {
        let values = crate::bernstein::vertex_values(table.degree(), coefficients);
        let slope: DVec3 = (0..4).map(|v| frame.gradients[v] * values[v]).sum();
        let length = slope.length();
        Self {
            table,
            coefficients,
            values,
            noise: 0.0,
            slope_noise: 0.0,
            gradient_noise: 0.0,
            slope,
            steepness: if length > 0.0 { length } else { 1.0 },
            kin: None,
            cone: None,
        }
    }

    /// The cone of the difference of two kin, scaled to one quadratic part.
    #[must_use]
    pub(crate) fn cone_of_difference(&self, other: &Self, frame: &LeafFrame) -> Option<Cone> {
        let (a, b) = (self.kin?.factor, other.kin?.factor);
        let mut difference = [0.0; 10];
        for (at, slot) in difference.iter_mut().enumerate() {
            *slot = a * self.coefficients[at] - b * other.coefficients[at];
        }
        // Three roundings relative to the terms, for which twice the slopes' noise has room with
        // those that follow.
        let sum = |of: fn(&Self) -> f64| a.abs() * of(self) + b.abs() * of(other);
        let slope_noise = 2.0 * sum(|surface| surface.slope_noise);
        let surface = Surface {
            slope_noise,
            gradient_noise: sum(|surface| surface.gradient_noise) + slope_noise,
            ..Surface::without_noise(self.table, &difference, frame)
        };
        surface.find_cone(frame)
    }

    /// The cone of its gradients around ∇ℓ, if no gradient is 90° or more away.
    #[must_use]
    pub(crate) fn find_cone(&self, frame: &LeafFrame) -> Option<Cone> {
        // A vector is off by √3 times its components' bound. Products with the unit axis and the
        // norms add at most 10u|G| ≤ 10u·√3·ΓM, less than 2.2 times the bound on a component.
        let slack = 4.0 * self.gradient_noise;
        let slope_slack = 4.0 * self.slope_noise;
        let wobble = slope_slack / (self.steepness - slope_slack);
        // Up to this angle tan 3x < 4x.
        if !(self.slope != DVec3::ZERO && (0.0..0.05).contains(&wobble)) {
            return None;
        }
        let axis = self.slope / self.steepness;
        let mut tangent = 0.0f64;
        for raised in self.table.raised() {
            let gradient: DVec3 = (0..4)
                .map(|v| frame.gradients[v] * self.coefficients[raised[v] as usize])
                .sum();
            let along = gradient.dot(axis) - slack;
            if along <= 0.0 || along.is_nan() {
                return None;
            }
            let across = (gradient - axis * gradient.dot(axis)).length() + slack;
            tangent = tangent.max(across / along);
        }
        // Conditions compare angles between true interpolants and true gradients with angles
        // between axes: three times the axis' own error covers every use.
        let turn = 4.0 * wobble;
        let tangent = (tangent + turn) / (1.0 - tangent * turn) * (1.0 + 1e-14);
        (0.0..1e12).contains(&tangent).then_some(Cone {
            axis,
            tangent,
            wobble,
        })
    }
}

impl Cone {
    /// Bound on the distance between the axis and the unit vectors in the cone: 2·sin(ψ/2).
    #[must_use]
    pub(crate) fn chord(&self) -> f64 {
        let secant = (1.0 + self.tangent * self.tangent).sqrt();
        self.tangent * (2.0 / (secant * (secant + 1.0))).sqrt() * (1.0 + 1e-14)
    }
}
