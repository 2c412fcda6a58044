//! One polynomial in one simplex, as far as the metric acceptance rule needs it
//! (`crate::deviation`; the whole argument is in `docs/accuracy.md`).
//!
//! In a simplex, with ℓ the affine interpolant of p at the vertices and ξ_α the domain points:
//!
//! * r = p − ℓ lies between (1 − 4^(1−n)) · min and max of c_α − ℓ(ξ_α) and zero: the four corner
//!   coefficients agree, and the other Bernstein polynomials sum up to at most that factor. The
//!   range of a quadric's r is found exactly (`crate::remainder`);
//! * ω = max r − min r bounds |p| in the mesh: its corners lie on p = 0, where ℓ = −r, or on
//!   ℓ = 0, and between them ℓ is interpolated. Where |p| > ω the mesh has p's sign. Both hold
//!   for all finer simplices inside as well;
//! * m = min of the Bernstein coefficients of ∂p/∂u, u the direction of ∇ℓ, is a lower bound of |∇p|;
//! * H bounds the second derivatives within a radius of the simplex;
//! * s = largest distance of a control gradient from ∇ℓ, so that within the radius
//!   ∇p is at most φ = arcsin((s + radius·H)/|∇ℓ|) away from ∇ℓ.
//!
//! All of them include the error e of the coefficients.

use crate::bernstein::{count, for_each_index, index};
use crate::hessian::{Hessian, norm};
use crate::margin::growth;
use crate::remainder::quadric_remainder;
use crate::rounding::UNIT_ROUNDOFF;
use crate::simplex::Simplex;
use crate::snap::RESIDUAL;
use crate::walk::Active;
use csg::Ternary;
use glam::{DMat3, DVec3};

/// Index tables for one degree.
#[derive(Clone, Debug)]
pub(crate) struct DegreeTable {
    degree: usize,
    /// Barycentric coordinates of the domain points.
    points: Vec<[f64; 4]>,
    /// For each coefficient α of degree n−1, the positions of α+e_0 … α+e_3.
    raised: Vec<[u32; 4]>,
}

impl DegreeTable {
    /// Tables for this degree, at least 1.
    #[must_use]
    pub(crate) fn new(degree: usize) -> Self {
        let mut points = Vec::with_capacity(count(degree));
        for_each_index(degree, |_, e| {
            points.push(e.map(|x| x as f64 / degree as f64));
        });
        let mut raised = Vec::with_capacity(count(degree - 1));
        for_each_index(degree - 1, |_, [_, j, k, l]| {
            raised.push(
                [
                    index(j, k, l),
                    index(j + 1, k, l),
                    index(j, k + 1, l),
                    index(j, k, l + 1),
                ]
                .map(|x| x as u32),
            );
        });
        Self {
            degree,
            points,
            raised,
        }
    }

    /// Range, with zero, of c_α − ℓ(ξ_α), given ℓ by its values at the vertices.
    fn remainder_range(&self, coefficients: &[f64], v: &[f64; 4]) -> (f64, f64) {
        let (mut low, mut high) = (0.0f64, 0.0f64);
        for (c, b) in coefficients.iter().zip(&self.points) {
            let affine = b[0] * v[0] + b[1] * v[1] + b[2] * v[2] + b[3] * v[3];
            low = low.min(c - affine);
            high = high.max(c - affine);
        }
        (low, high)
    }

    /// Largest |c_α − ℓ(ξ_α)|.
    #[must_use]
    pub(crate) fn remainder(&self, coefficients: &[f64], values: &[f64; 4]) -> f64 {
        if self.degree == 1 {
            return 0.0;
        }
        let (low, high) = self.remainder_range(coefficients, values);
        high.max(-low)
    }

    /// The control gradients n·Σ ∇b_v c_{α+e_v}, in storage order.
    fn control_gradients<'a>(
        &'a self,
        coefficients: &'a [f64],
        gradients: &BarycentricGradients,
    ) -> impl Iterator<Item = DVec3> + 'a {
        let scaled = gradients.map(|g| g * self.degree as f64);
        self.raised.iter().map(move |raised| {
            (0..4)
                .map(|v| scaled[v] * coefficients[raised[v] as usize])
                .sum()
        })
    }
}

impl DegreeTable {
    /// The degree.
    #[must_use]
    pub(crate) fn degree(&self) -> usize {
        self.degree
    }

    /// Barycentric coordinates of the domain points, in storage order.
    #[must_use]
    pub(crate) fn points(&self) -> &[[f64; 4]] {
        &self.points
    }

    /// For each coefficient α of a derivative, the positions of α+e_0 … α+e_3.
    #[must_use]
    pub(crate) fn raised(&self) -> &[[u32; 4]] {
        &self.raised
    }
}

/// Gradients of the barycentric coordinates, in the domain's own units.
pub(crate) type BarycentricGradients = [DVec3; 4];

/// The four gradients for a simplex.
#[must_use]
pub(crate) fn barycentric_gradients(simplex: &Simplex) -> BarycentricGradients {
    let [o, a, b, c] = simplex.vertices.map(crate::lattice::Point::position);
    let (a, b, c) = (a - o, b - o, c - o);
    let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
    let inverse = 1.0 / a.dot(bc);
    let (ga, gb, gc) = (bc * inverse, ca * inverse, ab * inverse);
    [-(ga + gb + gc), ga, gb, gc]
}

/// Values at the vertices, and ∇ℓ.
#[must_use]
pub(crate) fn gradient(
    table: &DegreeTable,
    coefficients: &[f64],
    gradients: &BarycentricGradients,
) -> ([f64; 4], DVec3) {
    let values = crate::bernstein::vertex_values(table.degree, coefficients);
    (values, (0..4).map(|v| gradients[v] * values[v]).sum())
}

/// Range, with zero, of p − ℓ.
#[must_use]
pub(crate) fn remainder_bounds(table: &DegreeTable, coefficients: &[f64]) -> (f64, f64) {
    match table.degree {
        1 => (0.0, 0.0),
        2 => quadric_remainder(coefficients),
        n => {
            let values = crate::bernstein::vertex_values(n, coefficients);
            let (low, high) = table.remainder_range(coefficients, &values);
            let share = 1.0 - 0.25f64.powf(n as f64 - 1.0);
            (share * low, share * high)
        }
    }
}

/// The neighbourhood for which a leaf is tested.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    /// How far it reaches; at most the tolerance, in the domain's own units.
    pub radius: f64,
    /// Whether true boundary and mesh are to be reached from each other, or only the true
    /// boundary from the mesh.
    pub both_ways: bool,
    /// N (`crate::margin`).
    pub rate: f64,
}

/// A simplex with what all its sheets need.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    /// Gradients of its barycentric coordinates.
    pub gradients: BarycentricGradients,
    /// N (`crate::margin`).
    pub rate: f64,
    /// The tolerance, in the domain's own units.
    pub tolerance: f64,
}

/// What is known of one primitive in one simplex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    /// Its degree.
    pub degree: usize,
    /// Values at the vertices.
    pub values: [f64; 4],
    /// ∇ℓ normalized.
    pub normal: DVec3,
    /// |∇ℓ|.
    pub slope: f64,
    /// ω; zero where the primitive has one sign in the simplex.
    pub swing: f64,
    /// m.
    pub steepness: f64,
    /// The parts of H: that of the mean second derivatives, and that which grows outside.
    bend: [f64; 2],
    /// s; computed only where sheets meet.
    spread: f64,
    /// Bound on the error of the coefficients.
    pub error: f64,
}

impl Sheet {
    /// Bounds a primitive.
    ///
    /// `control`: work space. `None` when even without other primitives p = 0 is not within the
    /// tolerance of the mesh for certain.
    ///
    /// `tables`: those of degrees 1, 2, …; `hessian`: that of a quadric.
    #[must_use]
    pub(crate) fn new(
        tables: &[DegreeTable],
        active: &Active,
        coefficients: &[f64],
        place: &Place,
        hessian: Option<&Hessian>,
        control: &mut Vec<DVec3>,
    ) -> Option<Self> {
        let n = active.degree as usize;
        let table = &tables[n - 1];
        let (values, gradient) = gradient(table, coefficients, &place.gradients);
        let slope = gradient.length();
        let error = active.error();
        // Only what halving rounded, and sums here, grows with Σ |∂b_v/∂u| ≤ 2N. What the root's
        // coefficients were off by is the restriction of one polynomial, with N = √3 there, and
        // the model's error is twice that of the derivatives, divided by the degree.
        let halving =
            active.rounding - active.root_rounding + 16.0 * UNIT_ROUNDOFF * active.largest;
        let inherited = 4.0 * active.root_rounding + 4.0 * active.model_error;
        let slope_error = n as f64 * (2.0 * place.rate * halving + inherited);
        if slope <= slope_error {
            return None;
        }
        let normal = gradient / slope;
        let mut sheet = Self {
            degree: n,
            values,
            normal,
            slope,
            swing: 8.0 * error,
            steepness: slope - slope_error,
            bend: [0.0; 2],
            spread: slope_error,
            error,
        };
        if n == 1 {
            // Planes are their own interpolants.
            sheet.swing = if active.value == Ternary::Unknown {
                2.0 * error
            } else {
                0.0
            };
            return Some(sheet);
        }
        let (low, high) = remainder_bounds(table, coefficients);
        // Vertices lie on the polynomials but for the residual that snapping leaves.
        sheet.swing += high - low + 2.0 * RESIDUAL * active.largest;
        if active.value != Ternary::Unknown {
            sheet.swing = 0.0;
        }
        // Every coefficient of the derivative must exceed this; most fail at the first.
        let needed = sheet.swing / place.tolerance + slope_error;
        let along = place.gradients.map(|g| g.dot(normal) * n as f64);
        let (mut steepness, mut steepest) = (f64::INFINITY, 0.0f64);
        for raised in &table.raised {
            let derivative: f64 = (0..4)
                .map(|v| along[v] * coefficients[raised[v] as usize])
                .sum();
            if derivative <= needed {
                return None;
            }
            steepness = steepness.min(derivative);
            steepest = steepest.max(derivative);
        }
        // The diameter is at most 3/N, so H is probably larger than this; where it is, `reach`
        // has no root. Refusing early costs a bisection at worst.
        let bend_guess = (steepest - steepness) * place.rate / 3.0;
        if sheet.swing * bend_guess > 0.5 * steepness * steepness {
            return None;
        }
        sheet.steepness = steepness - slope_error;
        sheet.bend = hessian.map_or_else(
            || {
                control.clear();
                control.extend(table.control_gradients(coefficients, &place.gradients));
                let [mean, spread] = bend_of(&tables[n - 2], control, &place.gradients);
                // Second differences of coefficients that are off by e.
                let error = 2.0 * place.rate * (n - 1) as f64 * slope_error;
                [mean + error, spread + error]
            },
            |hessian| [hessian.norm, 0.0],
        );
        Some(sheet)
    }

    /// H for a neighbourhood.
    fn bend(&self, around: &Around) -> f64 {
        let [mean, spread] = self.bend;
        if spread == 0.0 {
            return mean;
        }
        mean + spread * growth(self.degree - 2, around.radius * around.rate)
    }

    /// Finds s.
    pub(crate) fn find_spread(&mut self, table: &DegreeTable, coefficients: &[f64], place: &Place) {
        if self.degree > 1 {
            let mean = self.normal * self.slope;
            let far = |control: DVec3| (control - mean).length_squared();
            let control = table.control_gradients(coefficients, &place.gradients);
            self.spread += control.map(far).fold(0.0, f64::max).sqrt();
        }
    }

    /// sin φ; 1 where φ is a right angle or more.
    pub(crate) fn spread_sine(&self, around: &Around) -> f64 {
        ((self.spread + around.radius * self.bend(around)) / self.slope).min(1.0)
    }

    /// The least distance in which the boundary may be reached, whatever is around.
    pub(crate) fn least_reach(&self) -> f64 {
        self.swing / self.steepness
    }

    /// The distance t after which p has surely passed from 0 to ±ω, or from ∓ω to 0, along
    /// a direction that meets ∇p at a cosine of at least c: the smaller root of
    ///
    /// ```text
    /// t·c·(m − t·H/2) = ω                    where c holds within the radius,
    /// t·(c·(m − t·H) − t·H/2) = ω            both ways: where c holds at the start,
    /// ```
    ///
    /// `None` when it exceeds the radius, or the left side does not grow up to there.
    #[must_use]
    pub(crate) fn reach(&self, cosine: f64, around: &Around) -> Option<f64> {
        let curved = if around.both_ways {
            cosine + 0.5
        } else {
            0.5 * cosine
        };
        let (linear, square) = (cosine * self.steepness, self.bend(around) * curved);
        let radius = around.radius;
        let grows = linear > 0.0 && 2.0 * radius * square <= linear;
        if !grows || radius * (linear - radius * square) < self.swing {
            return None;
        }
        let root = (linear * linear - 4.0 * self.swing * square)
            .max(0.0)
            .sqrt();
        let reach = 2.0 * self.swing / (linear + root) * (1.0 + 1e-12);
        (reach <= radius).then_some(reach)
    }
}

/// Norm of the mean of the Hessian's coefficients, which goes on outside, and their largest
/// distance from it, which may grow there.
///
/// `table`: that of the gradient's degree; `control`: its coefficients.
fn bend_of(table: &DegreeTable, control: &[DVec3], gradients: &BarycentricGradients) -> [f64; 2] {
    let scaled = gradients.map(|g| g * table.degree as f64);
    let hessian = |raised: &[u32; 4]| {
        (0..4).fold(DMat3::ZERO, |sum, v| {
            let g = control[raised[v] as usize];
            sum + DMat3::from_cols(scaled[v] * g.x, scaled[v] * g.y, scaled[v] * g.z)
        })
    };
    let sum = table
        .raised
        .iter()
        .fold(DMat3::ZERO, |sum, raised| sum + hessian(raised));
    let mean = sum * (1.0 / table.raised.len() as f64);
    let far = |raised: &[u32; 4]| norm(&(hessian(raised) - mean));
    let spread = table.raised.iter().map(far).fold(0.0, f64::max);
    [norm(&mean) * (1.0 + 1e-14), spread * (1.0 + 1e-14)]
}

/// Whether a + λb is proved to have one sign around the simplex for a suitable λ > 0, so that
/// there a and b are never both positive or never both negative: within one radius for the way
/// from the mesh, within two for both ways.
///
/// `senses`: 1, or −1 for the negative polynomial. Polynomials of one degree are compared
/// coefficient by coefficient, which proves even the sheets of a very thin shell apart.
#[must_use]
pub(crate) fn apart(
    [a, b]: [&Sheet; 2],
    [p, q]: [&[f64]; 2],
    senses: [f64; 2],
    (tables, hessians): (&[DegreeTable], [Option<&Hessian>; 2]),
    around: &Around,
    gradients: &BarycentricGradients,
) -> bool {
    let lambda = a.slope / b.slope * senses[1] * senses[0];
    let reach = if around.both_ways { 2.0 } else { 1.0 } * around.radius;
    let overshoot = reach * around.rate;
    let error = a.error + lambda.abs() * b.error;
    let range = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| {
            (low.min(d), high.max(d))
        })
    };
    let sum = |p: &[f64], q: &[f64]| range(&mut p.iter().zip(q).map(|(p, q)| p + lambda * q));
    if p.len() == q.len() {
        let (low, high) = sum(p, q);
        let growth = growth(a.degree, overshoot);
        let error = 2.0 * error * growth;
        let half = 0.5 * (high - low) * growth + error;
        if (0.5 * (high + low)).abs() > half {
            return true;
        }
        let ([Some(of_a), Some(of_b)], true) = (hessians, low > error || high < -error) else {
            return false;
        };
        let mut sum = [0.0; 10];
        for ((sum, p), q) in sum.iter_mut().zip(p).zip(q) {
            *sum = p + lambda * q;
        }
        let hessian = of_a.plus(lambda, of_b);
        let range = if low > 0.0 {
            (low - error, high)
        } else {
            (low, high + error)
        };
        return hessian.clearance(&sum, range, gradients) > reach;
    }
    let rest = |s: &Sheet, c: &[f64]| {
        let remainder = tables[s.degree - 1].remainder(c, &s.values);
        (remainder + 2.0 * s.error) * growth(s.degree, overshoot)
    };
    let slope = (a.normal * a.slope + b.normal * (b.slope * lambda)).length();
    let slack = rest(a, p) + lambda.abs() * rest(b, q) + reach * slope;
    let (low, high) = sum(&a.values, &b.values);
    low > slack || high < -slack
}
