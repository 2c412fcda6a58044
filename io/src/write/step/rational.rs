//! Rational quadratic curves and surfaces, exactly as splines.
//!
//! A conic is (x, y, z, w)(s) with quadratic polynomials, and a quadric (x, y, z, w)(u, v)
//! with polynomials quadratic in each parameter. Their control points are values of the polar form at
//! neighbouring knots, so that any number of knots says the same surface.
//! Source: Piegl and Tiller, *The NURBS Book*, chapters 4 and 6; Ramshaw, *Blossoming*.

use glam::{DVec3, DVec4};
use step_io::scene::{NurbsCurve, NurbsSurface};

/// Homogeneous coordinates as quadratic polynomials of u and v: `[i][j]` goes with uⁱvʲ.
pub(super) type Coefficients = [[DVec4; 3]; 3];

/// A rectangle of a surface (x, y, z, w)(u, v).
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Rational {
    pub(super) coefficients: Coefficients,
    /// Where the parameters begin, end, and have knots.
    pub(super) breaks: [Vec<f64>; 2],
}

/// Places from one to another, in equal steps.
pub(super) fn steps([from, to]: [f64; 2], count: u32) -> Vec<f64> {
    (0..=count)
        .map(|k| from + (to - from) * (f64::from(k) / f64::from(count)))
        .collect()
}

/// Places from one to another, both positive, in equal ratios.
pub(super) fn ratios([from, to]: [f64; 2], count: u32) -> Vec<f64> {
    let logarithms = steps([from.ln(), to.ln()], count);
    logarithms.into_iter().map(f64::exp).collect()
}

/// Polar forms of 1, s and s².
fn polar(a: f64, b: f64) -> [f64; 3] {
    [1.0, 0.5 * (a + b), a * b]
}

fn knots(breaks: &[f64]) -> Vec<f64> {
    let ends = [breaks[0], breaks[breaks.len() - 1]];
    let mut knots = vec![ends[0]; 2];
    knots.extend_from_slice(breaks);
    knots.extend([ends[1]; 2]);
    knots
}

impl Rational {
    /// Homogeneous coordinates from the polar forms' arguments.
    fn blossom(&self, u: [f64; 2], v: [f64; 2]) -> DVec4 {
        let (u, v) = (polar(u[0], u[1]), polar(v[0], v[1]));
        let mut sum = DVec4::ZERO;
        for (row, u) in self.coefficients.iter().zip(u) {
            for (&coefficient, v) in row.iter().zip(v) {
                sum += coefficient * (u * v);
            }
        }
        sum
    }

    pub(super) fn homogeneous(&self, u: f64, v: f64) -> DVec4 {
        self.blossom([u; 2], [v; 2])
    }

    /// A point in the middle, and the surface's derivatives there.
    pub(super) fn tangents(&self) -> (DVec3, DVec3, DVec3) {
        let middle = |breaks: &[f64]| {
            let at = breaks.len() / 2;
            0.5 * (breaks[at.saturating_sub(1)] + breaks[at])
        };
        let [u, v] = self.breaks.each_ref().map(|breaks| middle(breaks));
        let h = self.homogeneous(u, v);
        let at = h.truncate() / h.w;
        // Derivatives of polynomials from their polar form.
        let along_u = 2.0 * (self.blossom([u, u + 1.0], [v; 2]) - h);
        let along_v = 2.0 * (self.blossom([u; 2], [v, v + 1.0]) - h);
        let [along_u, along_v] =
            [along_u, along_v].map(|along| (along.truncate() - at * along.w) / h.w);
        (at, along_u, along_v)
    }

    /// The spline; `None` if a control point is at infinity, or beyond.
    pub(super) fn spline(&self, scale: f64) -> Option<NurbsSurface> {
        let [knots_u, knots_v] = self.breaks.each_ref().map(|breaks| knots(breaks));
        let pairs = |knots: &[f64]| -> Vec<[f64; 2]> {
            (0..knots.len() - 3)
                .map(|i| [knots[i + 1], knots[i + 2]])
                .collect()
        };
        let (mut control_points, mut weights) = (Vec::new(), Vec::new());
        for &u in &pairs(&knots_u) {
            let row: Vec<DVec4> = pairs(&knots_v)
                .iter()
                .map(|&v| self.blossom(u, v))
                .collect();
            if row.iter().any(|point| point.w.is_nan() || point.w <= 0.0) {
                return None;
            }
            let place = |p: &DVec4| (p.truncate() * (scale / p.w) + DVec3::ZERO).to_array();
            control_points.push(row.iter().map(place).collect());
            weights.push(row.iter().map(|point| point.w).collect());
        }
        Some(NurbsSurface {
            degree_u: 2,
            degree_v: 2,
            control_points,
            weights,
            knots_u,
            knots_v,
        })
    }

    /// The curve u ↦ (x, y, z, w)(u, 0) as a spline.
    pub(super) fn curve(&self, scale: f64) -> Option<NurbsCurve> {
        let knots = knots(&self.breaks[0]);
        let points: Vec<DVec4> = (0..knots.len() - 3)
            .map(|i| self.blossom([knots[i + 1], knots[i + 2]], [0.0; 2]))
            .collect();
        let is_finite = points.iter().all(|point| point.w > 0.0);
        is_finite.then(|| NurbsCurve {
            degree: 2,
            control_points: points
                .iter()
                .map(|p| (p.truncate() * (scale / p.w) + DVec3::ZERO).to_array())
                .collect(),
            weights: points.iter().map(|point| point.w).collect(),
            knots,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// De Boor's algorithm, as written in *The NURBS Book*, A3.1 and A4.1, for degree 2.
    fn evaluate(points: &[DVec4], knots: &[f64], t: f64) -> DVec4 {
        let span = (2..points.len())
            .rfind(|&i| knots[i] <= t)
            .expect("within the knots");
        let mut d: Vec<DVec4> = (0..3).map(|j| points[span - 2 + j]).collect();
        for r in 1..3 {
            for j in (r..3).rev() {
                let (low, high) = (knots[span - 2 + j], knots[span + 1 + j - r]);
                let part = (t - low) / (high - low);
                d[j] = d[j - 1] * (1.0 - part) + d[j] * part;
            }
        }
        d[2]
    }

    #[test]
    fn a_half_circle_is_a_spline() {
        let mut coefficients = [[DVec4::ZERO; 3]; 3];
        // (1 − t², 2t) / (1 + t²)
        coefficients[0][0] = DVec4::new(1.0, 0.0, 0.0, 1.0);
        coefficients[1][0] = DVec4::new(0.0, 2.0, 0.0, 0.0);
        coefficients[2][0] = DVec4::new(-1.0, 0.0, 0.0, 1.0);
        let circle = Rational {
            coefficients,
            breaks: [steps([-1.0, 1.0], 3), vec![0.0]],
        };
        let curve = circle.curve(2.0).expect("finite");
        let points: Vec<DVec4> = curve
            .control_points
            .iter()
            .zip(&curve.weights)
            .map(|(&[x, y, z], &w)| DVec4::new(x * w, y * w, z * w, w))
            .collect();
        for k in 0..=20 {
            let t = -1.0 + 0.1 * f64::from(k);
            let point = evaluate(&points, &curve.knots, t);
            let point = point.truncate() / point.w;
            assert!((point.length() - 2.0).abs() < 1e-14, "{t}: {point}");
        }
        // A single span reaches a point at infinity.
        let single = Rational {
            breaks: [vec![-1.0, 1.0], vec![0.0]],
            ..circle
        };
        assert_eq!(single.curve(1.0), None);
    }

    #[test]
    fn a_saddle_is_a_polynomial_surface() {
        let mut coefficients = [[DVec4::ZERO; 3]; 3];
        coefficients[0][0] = DVec4::W;
        coefficients[1][0] = DVec4::X;
        coefficients[0][1] = DVec4::Y;
        coefficients[2][0] = DVec4::Z;
        coefficients[0][2] = -DVec4::Z;
        let saddle = Rational {
            coefficients,
            breaks: [steps([-1.0, 2.0], 2), steps([-3.0, 1.0], 4)],
        };
        let spline = saddle.spline(1.0).expect("finite");
        assert!(
            spline
                .weights
                .iter()
                .flatten()
                .all(|&w| (w - 1.0).abs() < 1e-15)
        );
        for u in [-1.0, -0.2, 0.5, 1.3] {
            for v in [-3.0, -1.1, 0.0, 0.9] {
                let columns: Vec<DVec4> = spline
                    .control_points
                    .iter()
                    .map(|row| {
                        let row: Vec<DVec4> = row
                            .iter()
                            .map(|&[x, y, z]| DVec4::new(x, y, z, 1.0))
                            .collect();
                        evaluate(&row, &spline.knots_v, v)
                    })
                    .collect();
                let point = evaluate(&columns, &spline.knots_u, u);
                let expected = DVec4::new(u, v, u * u - v * v, 1.0);
                assert!((point - expected).length() < 1e-13, "{point} {expected}");
            }
        }
    }
}
