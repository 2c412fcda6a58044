//! Points on several surfaces at once, by Newton's method.

use csg::{Polynomial, PrimitiveId, Solid};
use glam::{DMat3, DVec3};

/// Convergence to rounding, relative to the domain.
const STILL: f64 = 4.0 * f64::EPSILON;
/// Newton's method halves the error a step where surfaces touch: this many steps reach 10⁻¹⁶.
const STEPS: usize = 60;
/// Sine below which two surfaces count as touching, if they prove to be.
pub(super) const TOUCHING: f64 = 1e-3;
/// What may be left of a sine where surfaces touch.
const TOUCHED: f64 = 1e-9;
/// Weight that keeps undetermined directions still.
const DAMPING: f64 = 1e-12;
/// Largest distance, relative to the domain, of a solution from the surfaces.
const SOLVED: f64 = 1e-11;

/// Surfaces that a point is to lie on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meet<'a> {
    solid: &'a Solid,
    primitives: &'a [PrimitiveId],
}

impl<'a> Meet<'a> {
    pub(super) fn new(solid: &'a Solid, primitives: &'a [PrimitiveId]) -> Self {
        Self { solid, primitives }
    }

    fn polynomials(self) -> impl Iterator<Item = &'a Polynomial> {
        let all = &self.solid.primitives;
        self.primitives
            .iter()
            .filter_map(|id| Some(&all.get(id.0 as usize)?.polynomial))
    }

    /// The solution nearest to a point, at most `reach` away from it, in model units.
    pub(super) fn solve(self, near: DVec3, reach: f64) -> Option<DVec3> {
        let domain = &self.solid.domain;
        let start = domain.to_centered(near);
        let reach = reach / domain.half_size();
        let plain = self.iterate(start, start, reach, &[]);
        let from = plain.unwrap_or(start);
        let pairs = self.pairs(from, TOUCHING);
        let touched = if pairs.is_empty() {
            None
        } else {
            self.iterate(from, start, reach, &pairs)
                .filter(|&at| self.residual(at) <= SOLVED && slant(&pairs, at) <= TOUCHED)
        };
        let plain = plain.filter(|&at| self.residual(at) <= SOLVED);
        Some(domain.from_centered(touched.or(plain)?))
    }

    /// Largest distance from the surfaces, to first order, in model units.
    pub(super) fn distance(self, at: DVec3) -> f64 {
        let domain = &self.solid.domain;
        self.residual(domain.to_centered(at)) * domain.half_size()
    }

    /// Largest distance from the surfaces, to first order, relative to the domain.
    fn residual(self, at: DVec3) -> f64 {
        self.polynomials()
            .map(|p| {
                let slope = p.gradient(at).length();
                let value = p.evaluate(at).abs();
                // At a singular point the value itself has to do.
                if slope > 1e-6 { value / slope } else { value }
            })
            .fold(0.0, f64::max)
    }

    /// The nearest point where all surfaces touch each other.
    pub(super) fn touching_point(self, near: DVec3, reach: f64) -> Option<DVec3> {
        let domain = &self.solid.domain;
        let start = domain.to_centered(near);
        let pairs = self.pairs(start, f64::INFINITY);
        let at = self.iterate(start, start, reach / domain.half_size(), &pairs)?;
        let holds =
            !pairs.is_empty() && self.residual(at) <= SOLVED && slant(&pairs, at) <= TOUCHED;
        holds.then(|| domain.from_centered(at))
    }

    /// Largest sine between normals; 1 where there is nothing to compare.
    pub(super) fn slant_at(self, at: DVec3) -> f64 {
        let at = self.solid.domain.to_centered(at);
        let pairs = self.pairs(at, f64::INFINITY);
        if pairs.is_empty() {
            1.0
        } else {
            slant(&pairs, at)
        }
    }

    /// Pairs of surfaces, not both planes, whose normals differ by less than a sine.
    fn pairs(self, at: DVec3, below: f64) -> Vec<[&'a Polynomial; 2]> {
        let all: Vec<&Polynomial> = self.polynomials().collect();
        let mut pairs = Vec::new();
        for (i, &p) in all.iter().enumerate() {
            for &q in &all[i + 1..] {
                let pair = [p, q];
                if (p.degree() > 1 || q.degree() > 1) && slant(&[pair], at) < below {
                    pairs.push(pair);
                }
            }
        }
        pairs
    }

    /// Damped Gauss–Newton steps of least length; normals of these pairs are to
    /// become parallel as well, which makes a double solution a simple one.
    fn iterate(
        self,
        from: DVec3,
        start: DVec3,
        reach: f64,
        pairs: &[[&Polynomial; 2]],
    ) -> Option<DVec3> {
        let bends: Vec<[Bend; 2]> = pairs.iter().map(|pair| pair.map(Bend::of)).collect();
        let mut at = from;
        for _ in 0..STEPS {
            let mut square = DMat3::from_diagonal(DVec3::splat(DAMPING));
            let mut right = DVec3::ZERO;
            let mut add = |row: DVec3, value: f64| {
                square += DMat3::from_cols(row * row.x, row * row.y, row * row.z);
                right -= row * value;
            };
            for p in self.polynomials() {
                let gradient = p.gradient(at);
                let slope = gradient.length();
                if slope > 0.0 {
                    add(gradient / slope, p.evaluate(at) / slope);
                }
            }
            for (pair, bends) in pairs.iter().zip(&bends) {
                let [m, n] = pair.map(|p| p.gradient(at).normalize_or_zero());
                let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|direction| {
                    let [dm, dn] = [0, 1].map(|k| bends[k].turn(pair[k], at, direction));
                    dm.cross(n) + m.cross(dn)
                });
                let rows = DMat3::from_cols_array_2d(&columns.map(|c| c.to_array())).transpose();
                let value = m.cross(n);
                for k in 0..3 {
                    add(rows.col(k), value[k]);
                }
            }
            let step = square.inverse() * right;
            if !step.is_finite() {
                return None;
            }
            at += step;
            if at.distance(start) > reach {
                return None;
            }
            if step.length() <= STILL {
                break;
            }
        }
        Some(at)
    }

    /// Direction of the curve in which the first two surfaces cross; none where they touch.
    pub(super) fn direction(self, at: DVec3) -> Option<DVec3> {
        let at = self.solid.domain.to_centered(at);
        let mut normals = self
            .polynomials()
            .map(|p| p.gradient(at).normalize_or_zero());
        let cross = normals.next()?.cross(normals.next()?);
        (cross.length() > TOUCHING).then(|| cross.normalize())
    }
}

/// Largest sine between the normals of pairs.
fn slant(pairs: &[[&Polynomial; 2]], at: DVec3) -> f64 {
    pairs
        .iter()
        .map(|pair| {
            let [m, n] = pair.map(|p| p.gradient(at).normalize_or_zero());
            m.cross(n).length()
        })
        .fold(0.0, f64::max)
}

/// Second derivatives of a polynomial.
struct Bend([Polynomial; 3]);

impl Bend {
    fn of(p: &Polynomial) -> Self {
        Self([0, 1, 2].map(|k| p.derivative(k)))
    }

    /// How the unit normal turns on the way in a direction.
    fn turn(&self, p: &Polynomial, at: DVec3, direction: DVec3) -> DVec3 {
        let gradient = p.gradient(at);
        let Some(normal) = gradient.try_normalize() else {
            return DVec3::ZERO;
        };
        let change = DVec3::from(self.0.each_ref().map(|d| d.gradient(at).dot(direction)));
        (change - normal * normal.dot(change)) / gradient.length()
    }
}
