//! The metric acceptance rule: when the affine interpolants are close enough to the truth.
//!
//! In a simplex, with ℓ the affine interpolant of p at the vertices and ξ_α the domain points:
//!
//! * r = p − ℓ lies between (1 − 4^(1−n)) · min and max of c_α − ℓ(ξ_α) and zero: the four corner
//!   coefficients agree, and the other Bernstein polynomials sum up to at most that factor. δ is
//!   the larger bound's magnitude, |r| ≤ δ;
//! * ω = max r − min r bounds |p| in the mesh: its corners lie on p = 0, where ℓ = −r, or on
//!   ℓ = 0, and between them ℓ is interpolated;
//! * g = min of the Bernstein coefficients of ∂p/∂u, u the direction of ∇ℓ: where g > 0 the zero
//!   set is a graph over the plane across u, and p = 0 is reached from the mesh within ω/g;
//! * φ = largest angle between u and a control gradient.
//!
//! Where all outward normals have a common direction, several surfaces are as good as one: the
//! solid is then `height ≤ F(h₁, …)` with the heights hᵢ of its surfaces along that direction and
//! a formula F of minima and maxima, which changes by no more than its arguments do. Tangent
//! surfaces, a dome on a cylinder, need nothing else.
//!
//! Otherwise a crease of two surfaces moves by at most √(d₁² + d₂² + 2·d₁·d₂·cos θ)/sin θ when they move by
//! d₁ and d₂ and meet at an angle of at least θ = θ_ℓ − φ₁ − φ₂; a corner by at most
//! √3·√(d₁² + d₂² + d₃²)/|det u| with the determinant of the three unit normals.

use crate::bernstein::{count, for_each_index, index};
use crate::simplex::Simplex;
use glam::DVec3;

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

/// What is known of one primitive in one simplex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sheet {
    /// Values at the vertices.
    pub values: [f64; 4],
    /// δ: bound on |p − ℓ|.
    pub delta: f64,
    /// ω: bound on |p| in the mesh.
    pub swing: f64,
    /// ∇ℓ normalized.
    pub normal: DVec3,
    /// |∇ℓ|.
    pub slope: f64,
    /// ω/g: bound on the distance between the mesh and p = 0.
    pub deviation: f64,
    /// φ, in radians; computed only where sheets meet.
    pub spread_rad: f64,
}

/// Bounds one primitive; `None` when its deviation is not proved to be at most `tolerance`.
#[must_use]
pub(crate) fn sheet(
    table: &DegreeTable,
    coefficients: &[f64],
    gradients: &BarycentricGradients,
    tolerance: f64,
) -> Option<Sheet> {
    let n = table.degree;
    let values = crate::bernstein::vertex_values(n, coefficients);
    let gradient: DVec3 = (0..4).map(|v| gradients[v] * values[v]).sum();
    let slope = gradient.length();
    if slope == 0.0 {
        return None;
    }
    let normal = gradient / slope;
    if n == 1 {
        return Some(Sheet {
            values,
            delta: 0.0,
            swing: 0.0,
            normal,
            slope,
            deviation: 0.0,
            spread_rad: 0.0,
        });
    }
    let (low, high) = if n == 2 {
        quadric_remainder(coefficients)
    } else {
        let (mut low, mut high) = (0.0f64, 0.0f64);
        for (c, b) in coefficients.iter().zip(&table.points) {
            let affine = b[0] * values[0] + b[1] * values[1] + b[2] * values[2] + b[3] * values[3];
            low = low.min(c - affine);
            high = high.max(c - affine);
        }
        (low, high)
    };
    let share = 1.0 - 0.25f64.powf(n as f64 - 1.0);
    let (delta, swing) = (share * high.max(-low), share * (high - low));
    // Every coefficient of the derivative must exceed this; most fail at the first.
    let needed = swing / tolerance;
    let along = gradients.map(|g| g.dot(normal) * n as f64);
    let mut steepness = f64::INFINITY;
    for raised in &table.raised {
        let derivative: f64 = (0..4)
            .map(|v| along[v] * coefficients[raised[v] as usize])
            .sum();
        if derivative < needed || derivative <= 0.0 {
            return None;
        }
        steepness = steepness.min(derivative);
    }
    Some(Sheet {
        values,
        delta,
        swing,
        normal,
        slope,
        deviation: swing / steepness,
        spread_rad: 0.0,
    })
}

/// Range, with zero, of a quadric's six edge coefficients less the means of the vertex values.
fn quadric_remainder(c: &[f64]) -> (f64, f64) {
    let Some(c) = c.first_chunk::<10>() else {
        return (f64::NEG_INFINITY, f64::INFINITY);
    };
    let (mut low, mut high) = (0.0f64, 0.0f64);
    for (edge, a, b) in [
        (1, 0, 4),
        (2, 0, 7),
        (3, 0, 9),
        (5, 4, 7),
        (6, 4, 9),
        (8, 7, 9),
    ] {
        let off = c[edge] - 0.5 * (c[a] + c[b]);
        low = low.min(off);
        high = high.max(off);
    }
    (low, high)
}

/// Largest angle between the control gradients and `normal`, in radians.
#[must_use]
pub(crate) fn spread_rad(
    table: &DegreeTable,
    coefficients: &[f64],
    gradients: &BarycentricGradients,
    normal: DVec3,
) -> f64 {
    if table.degree == 1 {
        return 0.0;
    }
    let mut smallest_cosine = 1.0f64;
    for raised in &table.raised {
        let g: DVec3 = (0..4)
            .map(|v| gradients[v] * coefficients[raised[v] as usize])
            .sum();
        smallest_cosine = smallest_cosine.min(g.dot(normal) / g.length());
    }
    smallest_cosine.clamp(-1.0, 1.0).acos()
}

/// Smallest directional derivative of a polynomial along the unit vector `direction`.
#[must_use]
pub(crate) fn slope_along(
    table: &DegreeTable,
    coefficients: &[f64],
    gradients: &BarycentricGradients,
    direction: DVec3,
) -> f64 {
    let along = gradients.map(|g| g.dot(direction) * table.degree as f64);
    let derivative = |raised: &[u32; 4]| {
        (0..4)
            .map(|v| along[v] * coefficients[raised[v] as usize])
            .sum::<f64>()
    };
    table
        .raised
        .iter()
        .map(derivative)
        .fold(f64::INFINITY, f64::min)
}

/// Whether creases and corners of these sheets stay within the tolerance, too.
///
/// `coefficients(i)`: those of sheet i.
#[must_use]
pub(crate) fn creases_within<'a>(
    sheets: &[Sheet],
    coefficients: impl Fn(usize) -> &'a [f64],
    tolerance: f64,
) -> bool {
    let mut apart = [0u64; 64];
    for i in 0..sheets.len().min(64) {
        for j in 0..i {
            let (a, b) = (&sheets[i], &sheets[j]);
            if disjoint(a, coefficients(i), b, coefficients(j)) {
                apart[i] |= 1 << j;
                continue;
            }
            if a.delta == 0.0 && b.delta == 0.0 {
                continue;
            }
            let cosine = a.normal.dot(b.normal).abs().min(1.0);
            let angle = cosine.acos() - a.spread_rad - b.spread_rad;
            if angle <= 0.0 {
                return false;
            }
            let (d, e) = (a.deviation, b.deviation);
            let reach = (d * d + e * e + 2.0 * d * e * angle.cos()).sqrt();
            if reach > tolerance * angle.sin() {
                return false;
            }
        }
    }
    for i in 0..sheets.len().min(64) {
        for j in 0..i {
            for k in 0..j {
                if apart[i] >> j & 1 == 1 || apart[i] >> k & 1 == 1 || apart[j] >> k & 1 == 1 {
                    continue;
                }
                let three = [&sheets[i], &sheets[j], &sheets[k]];
                if three.iter().all(|s| s.delta == 0.0) {
                    continue;
                }
                let spread: f64 = three.iter().map(|s| s.spread_rad).sum();
                let det = three[0]
                    .normal
                    .dot(three[1].normal.cross(three[2].normal))
                    .abs()
                    - spread;
                let squares: f64 = three.iter().map(|s| s.deviation * s.deviation).sum();
                if det <= 0.0 || (3.0 * squares).sqrt() > tolerance * det {
                    return false;
                }
            }
        }
    }
    true
}

/// Whether p − λq has one sign in the simplex for a suitable λ, so that the zero sets of p and q
/// cannot meet there.
///
/// Polynomials of one degree are compared coefficient by coefficient, which proves even the
/// sheets of a very thin shell apart; others by their affine interpolants.
fn disjoint(a: &Sheet, p: &[f64], b: &Sheet, q: &[f64]) -> bool {
    let ratio = a.slope / b.slope;
    [ratio, -ratio].into_iter().any(|lambda| {
        if p.len() == q.len() {
            let (mut low, mut high, mut size) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
            for (p, q) in p.iter().zip(q) {
                let d = p - lambda * q;
                low = low.min(d);
                high = high.max(d);
                size = size.max(p.abs());
            }
            // The product and the difference round once each; |λq| is about |p| where d is small.
            let slack = 4.0 * f64::EPSILON * (size + high.max(-low));
            return low > slack || high < -slack;
        }
        let slack = a.delta + lambda.abs() * b.delta;
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (p, q) in a.values.iter().zip(&b.values) {
            let d = p - lambda * q;
            low = low.min(d);
            high = high.max(d);
        }
        low > slack || high < -slack
    })
}
