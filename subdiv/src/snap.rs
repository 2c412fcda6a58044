//! True positions: from the affine answer onto the polynomials themselves, without leaving the
//! edge, facet or simplex that names the vertex.
//!
//! A vertex on an edge is a root of a univariate Bernstein form whose ends have different signs:
//! bracketing cannot fail. Vertices in facets and simplices are found by Newton's method from
//! the affine answer; where it does not converge inside, the affine answer stays.

use crate::bernstein::{for_each_index, index, vertex_values};

/// A polynomial's coefficients in the leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeafPolynomial<'a> {
    /// Its degree.
    pub(crate) degree: usize,
    /// Bernstein coefficients in storage order.
    pub(crate) coefficients: &'a [f64],
}

impl LeafPolynomial<'_> {
    /// Its values at the four vertices.
    pub(crate) fn vertex_values(&self) -> [f64; 4] {
        vertex_values(self.degree, self.coefficients)
    }
}

/// Work space for de Casteljau's algorithm.
#[derive(Debug, Default)]
pub(crate) struct Snapper {
    triangle: Vec<f64>,
    edge: Vec<f64>,
}

/// Values at snapped vertices are at most this part of the polynomial's largest coefficient:
/// roots on edges are found to rounding, others are checked.
pub(crate) const RESIDUAL: f64 = 1e-11;

/// Most Newton steps; convergence is quadratic from an answer that is already close.
const NEWTON_STEPS: usize = 12;

impl Snapper {
    /// Parameter in [0, 1] of a root on the edge from vertex `from` to vertex `to`, whose values
    /// there must not have the same sign.
    pub(crate) fn edge_root(&mut self, p: LeafPolynomial<'_>, from: usize, to: usize) -> f64 {
        let n = p.degree;
        self.edge.clear();
        self.edge.extend((0..=n).map(|t| {
            let mut exponents = [0; 4];
            exponents[from] = n - t;
            exponents[to] = t;
            p.coefficients[index(exponents[1], exponents[2], exponents[3])]
        }));
        let (first, last) = (self.edge[0], self.edge[n]);
        if first == 0.0 {
            return 0.0;
        }
        if last == 0.0 {
            return 1.0;
        }
        match self.edge[..] {
            [a, b] => a / (a - b),
            [a, b, c] => quadratic_root(a, b, c),
            _ => self.bracketed_root(),
        }
    }

    /// Newton's method safeguarded by bisection on the univariate form in `self.edge`.
    fn bracketed_root(&mut self) -> f64 {
        let n = self.edge.len() - 1;
        let (mut low, mut high) = (0.0, 1.0);
        let low_is_negative = self.edge[0] < 0.0;
        let mut t = self.edge[0] / (self.edge[0] - self.edge[n]);
        let mut width_before_last = 2.0;
        for _ in 0..200 {
            let (value, slope) = self.univariate(t);
            if value == 0.0 {
                return t;
            }
            if (value < 0.0) == low_is_negative {
                low = t;
            } else {
                high = t;
            }
            let newton = t - value / slope;
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high || newton - t == 0.0 {
                return t;
            }
            // Newton may creep along one side of the root: bisect unless the bracket shrinks.
            let width = high - low;
            let shrinks = width <= 0.5 * width_before_last || (newton - t).abs() < 1e-9;
            t = if newton > low && newton < high && shrinks {
                newton
            } else {
                middle
            };
            width_before_last = width;
        }
        0.5 * (low + high)
    }

    /// Value and derivative of the univariate form in `self.edge`.
    fn univariate(&mut self, t: f64) -> (f64, f64) {
        let n = self.edge.len() - 1;
        self.triangle.clear();
        self.triangle.extend_from_slice(&self.edge);
        for d in (1..n).rev() {
            for i in 0..=d {
                self.triangle[i] = (1.0 - t) * self.triangle[i] + t * self.triangle[i + 1];
            }
        }
        let (a, b) = (self.triangle[0], self.triangle[1]);
        ((1.0 - t) * a + t * b, n as f64 * (b - a))
    }

    /// Value at barycentric coordinates `b`.
    pub(crate) fn value(&mut self, p: LeafPolynomial<'_>, b: [f64; 4]) -> f64 {
        self.evaluate(p, b).0
    }

    /// Value at barycentric coordinates `b` and the four partial derivatives by them.
    fn evaluate(&mut self, p: LeafPolynomial<'_>, b: [f64; 4]) -> (f64, [f64; 4]) {
        if let Some(c) = p.coefficients.first_chunk::<10>()
            && p.degree == 2
        {
            return quadric(c, b);
        }
        let c = &mut self.triangle;
        c.clear();
        c.extend_from_slice(p.coefficients);
        for d in (1..p.degree).rev() {
            for_each_index(d, |at, [_, j, k, l]| {
                c[at] = b[0] * c[index(j, k, l)]
                    + b[1] * c[index(j + 1, k, l)]
                    + b[2] * c[index(j, k + 1, l)]
                    + b[3] * c[index(j, k, l + 1)];
            });
        }
        let value = (0..4).map(|v| b[v] * c[v]).sum();
        let n = p.degree as f64;
        (value, [n * c[0], n * c[1], n * c[2], n * c[3]])
    }

    /// Solves p = 0 for all of `polynomials`, one fewer than there are `columns` (the vertices of
    /// the face), from the start `b`; `None` when Newton's method does not converge to a point of
    /// the closed face.
    pub(crate) fn crossing(
        &mut self,
        polynomials: &[LeafPolynomial<'_>],
        columns: &[usize],
        mut b: [f64; 4],
    ) -> Option<[f64; 4]> {
        let unknowns = polynomials.len();
        if unknowns + 1 != columns.len() || !(2..=3).contains(&unknowns) {
            return None;
        }
        let mut last_step = f64::INFINITY;
        for _ in 0..NEWTON_STEPS {
            let mut matrix = [[0.0; 3]; 3];
            let mut right = [0.0; 3];
            for (row, p) in polynomials.iter().enumerate() {
                let (value, partial) = self.evaluate(*p, b);
                right[row] = -value;
                for (at, column) in columns[1..].iter().enumerate() {
                    matrix[row][at] = partial[*column] - partial[columns[0]];
                }
            }
            let step = solve(unknowns, &matrix, &right)?;
            let mut size = 0.0f64;
            for (at, column) in columns[1..].iter().enumerate() {
                b[*column] += step[at];
                b[columns[0]] -= step[at];
                size = size.max(step[at].abs());
            }
            if size <= 1e-15 || (size <= 1e-12 && size >= last_step) {
                return self.accepted(polynomials, b);
            }
            // Far outside or slow: not the root that the arrangement means.
            if b.iter().any(|x| x.abs() > 4.0) {
                return None;
            }
            last_step = size;
        }
        if last_step <= 1e-12 {
            self.accepted(polynomials, b)
        } else {
            None
        }
    }

    /// The point itself if it lies in the closed face and on all the polynomials.
    fn accepted(&mut self, polynomials: &[LeafPolynomial<'_>], b: [f64; 4]) -> Option<[f64; 4]> {
        let on = |p: &LeafPolynomial<'_>| {
            let largest = p.coefficients.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            self.value(*p, b).abs() <= RESIDUAL * largest
        };
        (b.iter().all(|x| *x >= 0.0) && polynomials.iter().all(on)).then_some(b)
    }
}

/// The same for degree 2, written out: in most leaves most surfaces are quadrics or planes.
fn quadric(c: &[f64; 10], b: [f64; 4]) -> (f64, [f64; 4]) {
    let rows = [[0, 1, 2, 3], [1, 4, 5, 6], [2, 5, 7, 8], [3, 6, 8, 9]];
    let half = rows.map(|[i, j, k, l]| b[0] * c[i] + b[1] * c[j] + b[2] * c[k] + b[3] * c[l]);
    let value = (0..4).map(|v| b[v] * half[v]).sum();
    (value, half.map(|h| 2.0 * h))
}

/// The root in (0, 1) of a quadratic Bernstein form whose ends have strictly opposite signs.
///
/// With s = t/(1−t) it is a + 2bs + cs² = 0, which has exactly one positive root.
fn quadratic_root(a: f64, b: f64, c: f64) -> f64 {
    let q = -(b + (b * b - a * c).max(0.0).sqrt().copysign(b));
    let (s1, s2) = (q / c, a / q);
    let s = if s1 > 0.0 { s1 } else { s2 };
    let t = s / (1.0 + s);
    if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        a / (a - c)
    }
}

/// Cramer's rule for two or three unknowns.
fn solve(unknowns: usize, m: &[[f64; 3]; 3], right: &[f64; 3]) -> Option<[f64; 3]> {
    let det = |m: &[[f64; 3]; 3]| {
        if unknowns == 2 {
            m[0][0] * m[1][1] - m[0][1] * m[1][0]
        } else {
            m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
                - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
                + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
        }
    };
    let whole = det(m);
    let mut solution = [0.0; 3];
    for (unknown, value) in solution.iter_mut().enumerate().take(unknowns) {
        let mut replaced = *m;
        for row in 0..unknowns {
            replaced[row][unknown] = right[row];
        }
        *value = det(&replaced) / whole;
        if !value.is_finite() {
            return None;
        }
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bernstein::count;
    use proptest::prelude::*;

    proptest! {
        /// The value at the root is as small as rounding allows, for all degrees.
        #[test]
        fn edge_roots_are_roots(
            degree in 1usize..9, seed in proptest::collection::vec(-1.0..1.0f64, 165),
            from in 0usize..4, turn in 1usize..4,
        ) {
            let to = (from + turn) % 4;
            let mut c = seed[..count(degree)].to_vec();
            let vertex = |v: usize| {
                let mut e = [0; 4];
                e[v] = degree;
                index(e[1], e[2], e[3])
            };
            c[vertex(from)] = c[vertex(from)].abs() + 1e-3;
            c[vertex(to)] = -c[vertex(to)].abs() - 1e-3;
            let mut snapper = Snapper::default();
            let p = LeafPolynomial { degree, coefficients: &c };
            let t = snapper.edge_root(p, from, to);
            prop_assert!((0.0..=1.0).contains(&t));
            let mut b = [0.0; 4];
            b[from] = 1.0 - t;
            b[to] = t;
            let (value, partial) = snapper.evaluate(p, b);
            let slope = (partial[to] - partial[from]).abs();
            prop_assert!(value.abs() <= 1e-14 + 1e-15 * slope, "{value} at {t}");
        }
    }

    /// Sphere |b|² = ½ around v0 in the barycentric frame and two planes, solved by hand.
    #[test]
    fn corner_of_a_sphere_and_two_planes() {
        // p = b1² + b2² + b3² − ½·(Σb)²; planes b1 = b2 and b3 = ½.
        let mut ball = vec![0.0; 10];
        for_each_index(2, |at, e| {
            let square = (1..4).any(|v| e[v] == 2);
            ball[at] = f64::from(u8::from(square)) - 0.5;
        });
        let first = [0.0, 1.0, -1.0, 0.0];
        let second = [-0.5, -0.5, -0.5, 0.5];
        let polynomials = [
            LeafPolynomial {
                degree: 2,
                coefficients: &ball,
            },
            LeafPolynomial {
                degree: 1,
                coefficients: &first,
            },
            LeafPolynomial {
                degree: 1,
                coefficients: &second,
            },
        ];
        let start = [0.05, 0.25, 0.2, 0.5];
        let b = Snapper::default().crossing(&polynomials, &[0, 1, 2, 3], start);
        // 2·b1² = ¼ gives b1 = 1/√8; then b0 = ½ − 2/√8 < 0: outside the simplex.
        assert_eq!(b, None);
        let wider = [
            polynomials[0],
            polynomials[1],
            LeafPolynomial {
                degree: 1,
                coefficients: &[-0.7, -0.7, -0.7, 0.3],
            },
        ];
        let b = Snapper::default()
            .crossing(&wider, &[0, 1, 2, 3], [0.2, 0.05, 0.05, 0.7])
            .unwrap();
        let side = ((0.5f64 - 0.49) / 2.0).sqrt();
        assert!((b[1] - side).abs() < 1e-14 && (b[2] - side).abs() < 1e-14);
    }
}
