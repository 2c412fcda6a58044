//! What values a primitive's polynomial takes over a ball or a triangle.

use super::lattice::{self, Lattice};
use csg::{Polynomial, Primitive, Ternary};
use glam::{DMat3, DVec3};

/// A polynomial in centred coordinates, with what is the same everywhere.
#[derive(Clone, Debug)]
pub(super) struct Field<'a> {
    form: Form<'a>,
    degree: usize,
    /// Largest error of a value in the domain: of the coefficients, and of the arithmetic here.
    error: f64,
}

#[derive(Clone, Debug)]
enum Form<'a> {
    /// n·x + c.
    Affine { normal: DVec3, constant: f64 },
    /// x·Qx + 2h·x + c, with a bound on |Qu| over unit vectors u.
    Quadric {
        matrix: DMat3,
        half: DVec3,
        constant: f64,
        norm: f64,
    },
    /// Any polynomial: second derivatives by xx, xy, xz, yy, yz, zz, and a bound on the third one
    /// in any direction, in the domain.
    Higher {
        polynomial: &'a Polynomial,
        second: Box<[Polynomial; 6]>,
        third: f64,
        lattice: Option<Lattice>,
    },
}

/// Bounds of values.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Range {
    /// Where all points with such values lie.
    pub(super) fn side(self) -> Ternary {
        if self.high < 0.0 {
            Ternary::In
        } else if self.low > 0.0 {
            Ternary::Out
        } else {
            Ternary::Unknown
        }
    }
}

/// Value, gradient and half the second derivatives at a point: p(x + d) is
/// v + g·d + d·Hd, up to a third of the third derivative's bound.
struct Expansion {
    value: f64,
    gradient: DVec3,
    half_hessian: DMat3,
}

impl<'a> Field<'a> {
    pub(super) fn of(primitive: &'a Primitive) -> Self {
        let polynomial = &primitive.polynomial;
        let c = polynomial.coefficients();
        let form = match polynomial.degree() {
            0 => Form::Affine {
                normal: DVec3::ZERO,
                constant: c[0],
            },
            1 => Form::Affine {
                normal: DVec3::new(c[0], c[1], c[2]),
                constant: c[3],
            },
            2 => {
                let matrix = DMat3::from_cols(
                    DVec3::new(c[0], 0.5 * c[1], 0.5 * c[2]),
                    DVec3::new(0.5 * c[1], c[4], 0.5 * c[5]),
                    DVec3::new(0.5 * c[2], 0.5 * c[5], c[7]),
                );
                Form::Quadric {
                    matrix,
                    half: 0.5 * DVec3::new(c[3], c[6], c[8]),
                    constant: c[9],
                    norm: frobenius(&matrix),
                }
            }
            _ => {
                let by = |axes: [usize; 2]| polynomial.derivative(axes[0]).derivative(axes[1]);
                Form::Higher {
                    polynomial,
                    second: Box::new([[0, 0], [0, 1], [0, 2], [1, 1], [1, 2], [2, 2]].map(by)),
                    third: third_derivative(polynomial),
                    lattice: (polynomial.degree() <= lattice::MOST)
                        .then(|| Lattice::new(polynomial.degree())),
                }
            }
        };
        let sum: f64 = c.iter().map(|c| c.abs()).sum();
        // Each of some n³ sums of products has 3n roundings of numbers that add up to this.
        let n = polynomial.degree() as f64;
        let roundings = 16.0 * (n + 1.0) * (n + 1.0) * if n > 2.0 { n } else { 1.0 };
        let amplification = match &form {
            Form::Higher {
                lattice: Some(lattice),
                ..
            } => lattice.amplification(),
            _ => 1.0,
        };
        let rounding = amplification * roundings * f64::EPSILON * sum;
        Self {
            form,
            degree: polynomial.degree(),
            error: primitive.coefficient_error + rounding,
        }
    }

    pub(super) fn error(&self) -> f64 {
        self.error
    }

    pub(super) fn value(&self, at: DVec3) -> f64 {
        self.expansion(at).value
    }

    pub(super) fn gradient(&self, at: DVec3) -> DVec3 {
        match &self.form {
            Form::Affine { normal, .. } => *normal,
            Form::Quadric { matrix, half, .. } => 2.0 * (*matrix * at + *half),
            Form::Higher { polynomial, .. } => polynomial.gradient(at),
        }
    }

    fn expansion(&self, at: DVec3) -> Expansion {
        match &self.form {
            Form::Affine { normal, constant } => Expansion {
                value: normal.dot(at) + constant,
                gradient: *normal,
                half_hessian: DMat3::ZERO,
            },
            Form::Quadric {
                matrix,
                half,
                constant,
                ..
            } => {
                let moved = *matrix * at + *half;
                Expansion {
                    value: moved.dot(at) + half.dot(at) + constant,
                    gradient: 2.0 * moved,
                    half_hessian: *matrix,
                }
            }
            Form::Higher {
                polynomial, second, ..
            } => {
                let [xx, xy, xz, yy, yz, zz] = second.each_ref().map(|p| 0.5 * p.evaluate(at));
                Expansion {
                    value: polynomial.evaluate(at),
                    gradient: polynomial.gradient(at),
                    half_hessian: DMat3::from_cols(
                        DVec3::new(xx, xy, xz),
                        DVec3::new(xy, yy, yz),
                        DVec3::new(xz, yz, zz),
                    ),
                }
            }
        }
    }

    fn third(&self) -> f64 {
        match self.form {
            Form::Higher { third, .. } => third,
            _ => 0.0,
        }
    }

    /// Values in a ball.
    pub(super) fn over_ball(&self, center: DVec3, radius: f64) -> Range {
        let at = self.expansion(center);
        let norm = match self.form {
            Form::Quadric { norm, .. } => norm,
            _ => frobenius(&at.half_hessian),
        };
        // Beyond the domain powers grow.
        let reach = (center.abs().max_element() + radius).max(1.0);
        let growth = reach.powi(i32::try_from(self.degree).unwrap_or(i32::MAX));
        let third = self.third() * growth;
        let change = radius
            * (at.gradient.length() + radius * (norm + radius * third / 6.0))
            * (1.0 + 1e-12)
            + self.error * growth;
        Range {
            low: at.value - change,
            high: at.value + change,
        }
    }

    /// About the range of values over a triangle, not proved.
    pub(super) fn roughly_over_triangle(&self, corners: [DVec3; 3]) -> Range {
        let Form::Higher {
            polynomial,
            lattice: Some(lattice),
            ..
        } = &self.form
        else {
            return self.over_triangle(corners);
        };
        let [a, b, c] = corners;
        let [low, high] = lattice.sampled(|[x, y, z]| polynomial.evaluate(x * a + y * b + z * c));
        Range { low, high }
    }

    /// Values over a triangle.
    pub(super) fn over_triangle(&self, corners: [DVec3; 3]) -> Range {
        let [a, b, c] = corners;
        match &self.form {
            Form::Affine { normal, constant } => {
                let [x, y, z] = corners.map(|corner| normal.dot(corner) + constant);
                let rest = [-self.error, self.error];
                of_quadratic([x, y, z, 0.5 * (x + y), 0.5 * (y + z), 0.5 * (z + x)], rest)
            }
            Form::Quadric {
                matrix,
                half,
                constant,
                ..
            } => {
                let moved = corners.map(|corner| *matrix * corner + *half);
                let polar =
                    |i: usize, j: usize| moved[i].dot(corners[j]) + half.dot(corners[i]) + constant;
                of_quadratic(six(polar), [-self.error, self.error])
            }
            Form::Higher {
                polynomial,
                lattice: Some(lattice),
                ..
            } => {
                let split = lattice.split(|[x, y, z]| polynomial.evaluate(x * a + y * b + z * c));
                let [low, high] = split.rest;
                of_quadratic(split.quadratic, [low - self.error, high + self.error])
            }
            Form::Higher { third, .. } => {
                let center = (a + b + c) / 3.0;
                let at = self.expansion(center);
                let from = corners.map(|corner| corner - center);
                let moved = from.map(|d| at.half_hessian * d + 0.5 * at.gradient);
                let polar = |i: usize, j: usize| {
                    moved[i].dot(from[j]) + 0.5 * at.gradient.dot(from[i]) + at.value
                };
                let radius = from.map(DVec3::length).into_iter().fold(0.0, f64::max);
                let rest = third / 6.0 * radius.powi(3) * (1.0 + 1e-12) + self.error;
                of_quadratic(six(polar), [-rest, rest])
            }
        }
    }
}

/// A quadratic's coefficients: three at the corners and three on the sides 01, 12, 20.
fn six(polar: impl Fn(usize, usize) -> f64) -> [f64; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)].map(|(i, j)| polar(i, j))
}

/// Values of a quadratic, three coefficients at the corners and three on the sides, and a rest.
fn of_quadratic([x, y, z, xy, yz, zx]: [f64; 6], rest: [f64; 2]) -> Range {
    let offsets = [xy - 0.5 * (x + y), yz - 0.5 * (y + z), zx - 0.5 * (z + x)];
    Range {
        low: x.min(y).min(z) - bulge(offsets.map(|o| -o)) + rest[0],
        high: x.max(y).max(z) + bulge(offsets) + rest[1],
    }
}

/// Largest value of the quadratic that vanishes at a triangle's corners and has these Bernstein
/// coefficients on its edges; where some are negative, a bound.
fn bulge(edges: [f64; 3]) -> f64 {
    let [a, b, c] = edges.map(|edge| edge.max(0.0));
    let largest = a.max(b).max(c);
    // λᵀMλ with M's entries a, b, c: stationary inside only under the triangle inequality.
    if a + b <= c || b + c <= a || c + a <= b {
        return 0.5 * largest;
    }
    let denominator = 2.0 * (a * b + b * c + c * a) - a * a - b * b - c * c;
    // Nowhere more than this, since the products of two weights add up to a third at most.
    let most = 2.0 / 3.0 * largest;
    if denominator <= 1e-5 * largest * largest {
        return most;
    }
    (2.0 * a * b * c / denominator * (1.0 + 1e-9)).min(most)
}

fn frobenius(matrix: &DMat3) -> f64 {
    let columns = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    columns
        .map(DVec3::length_squared)
        .iter()
        .sum::<f64>()
        .sqrt()
}

/// Bound on the third derivative in any direction, for coordinates between −1 and 1.
fn third_derivative(polynomial: &Polynomial) -> f64 {
    let mut sum = 0.0;
    for x in 0..3 {
        for y in 0..3 {
            for z in 0..3 {
                let derivative = polynomial.derivative(x).derivative(y).derivative(z);
                let largest: f64 = derivative.coefficients().iter().map(|c| c.abs()).sum();
                sum += largest * largest;
            }
        }
    }
    sum.sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = DVec3> {
        proptest::array::uniform3(-0.9..0.9f64).prop_map(DVec3::from)
    }

    fn primitive() -> impl Strategy<Value = Primitive> {
        (1usize..6).prop_flat_map(|degree| {
            let count = Polynomial::coefficient_count(degree);
            proptest::collection::vec(-1.0..1.0f64, count).prop_map(move |coefficients| Primitive {
                polynomial: Polynomial::new(degree, coefficients)
                    .unwrap_or_else(|_| unreachable!()),
                coefficient_error: 0.0,
            })
        })
    }

    proptest! {
        /// No value in a triangle or a ball is beyond the bounds; those of quadrics over a triangle
        /// whose corners have one value are attained.
        #[test]
        fn values_are_within_bounds(
            primitive in primitive(),
            corners in proptest::array::uniform3(point()),
            scale in 0.01..1.0f64,
        ) {
            let field = Field::of(&primitive);
            let corners = corners.map(|corner| corners[0].lerp(corner, scale));
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            let radius = corners.map(|p| p.distance(center)).into_iter().fold(0.0, f64::max);
            let (triangle, ball) = (field.over_triangle(corners), field.over_ball(center, radius));
            let n = 12;
            for i in 0..=n {
                for j in 0..=n - i {
                    let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(n));
                    let at = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
                    let value = primitive.polynomial.evaluate(at);
                    for range in [triangle, ball] {
                        prop_assert!(range.low <= value && value <= range.high, "{value} {range:?}");
                    }
                }
            }
        }

        /// The bulge is the maximum on a grid, but for what lies between its points.
        #[test]
        fn bulges_are_as_high_as_they_are(edges in proptest::array::uniform3(0.0..1.0f64)) {
            let [a, b, c] = edges;
            let n = 60;
            let mut highest = 0.0f64;
            for i in 0..=n {
                for j in 0..=n - i {
                    let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(n));
                    let w = 1.0 - u - v;
                    highest = highest.max(2.0 * (u * v * a + v * w * b + w * u * c));
                }
            }
            let bulge = bulge(edges);
            prop_assert!(highest <= bulge * (1.0 + 1e-9) && bulge <= highest + 2e-3, "{highest} {bulge}");
        }
    }
}
