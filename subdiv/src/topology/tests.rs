//! The oracle computes the same in exact rational numbers, for coefficients that are off by as
//! much as the bound allows.

use super::*;
use crate::bernstein::count;
use crate::blossom::RootCoefficients;
use crate::certify::{DegreeTable, barycentric_gradients};
use crate::walk::Active;
use combination::{Combination, excluded};
use csg::{Polynomial, Primitive};
use num_rational::BigRational;
use proptest::prelude::*;

type Vector = [BigRational; 3];

fn exact(value: f64) -> BigRational {
    BigRational::from_float(value).unwrap()
}

fn zero() -> BigRational {
    exact(0.0)
}

fn dot(a: &Vector, b: &Vector) -> BigRational {
    (0..3).fold(zero(), |sum, x| sum + &a[x] * &b[x])
}

fn vector(v: glam::DVec3) -> Vector {
    v.to_array().map(exact)
}

/// A leaf `turns.len()` levels below a root.
fn leaf(root: usize, turns: &[bool]) -> Simplex {
    turns.iter().fold(Simplex::roots()[root], |simplex, &far| {
        simplex.children()[usize::from(far)]
    })
}

/// A polynomial of some degree that is nearly affine, in a leaf.
#[derive(Clone, Debug)]
struct Sample {
    degree: usize,
    coefficients: Vec<f64>,
    error: f64,
    /// Which way each coefficient is off.
    signs: Vec<bool>,
}

impl Sample {
    fn active(&self) -> Active {
        Active {
            primitive: 0,
            degree: self.degree as u32,
            offset: 0,
            rounding: self.error,
            root_rounding: 0.0,
            model_error: 0.0,
            largest: self.coefficients.iter().fold(0.0, |m, c| c.abs().max(m)),
            value: csg::Ternary::Unknown,
            clearance: 0.0,
        }
    }

    /// The coefficients, off as far as allowed.
    fn shifted(&self) -> Vec<BigRational> {
        let pairs = self.coefficients.iter().zip(&self.signs);
        pairs
            .map(|(c, up)| exact(*c) + exact(if *up { self.error } else { -self.error }))
            .collect()
    }
}

/// `level`: how far the values at the vertices are from zero.
fn sample(level: f64) -> impl Strategy<Value = Sample> {
    let bend = prop_oneof![Just(0.0), Just(1e-9), 0.0..1.0f64];
    let error = prop_oneof![Just(0.0), Just(1e-13), 0.0..0.02f64];
    (
        1usize..5,
        proptest::array::uniform4(-1.0..1.0f64),
        bend,
        error,
        proptest::collection::vec((-1.0..1.0f64, any::<bool>()), 35),
    )
        .prop_map(move |(degree, values, bend, error, rest)| {
            let table = DegreeTable::new(degree);
            let coefficient = |(b, (off, _)): (&[f64; 4], &(f64, bool))| {
                let affine: f64 = (0..4).map(|v| b[v] * values[v]).sum();
                level + affine + bend * off
            };
            let n = count(degree);
            let pairs = table.points().iter().zip(&rest[..n]);
            Sample {
                degree,
                coefficients: pairs.map(coefficient).collect(),
                error,
                signs: rest[..n].iter().map(|(_, up)| *up).collect(),
            }
        })
}

fn surface<'a>(sample: &'a Sample, table: &'a DegreeTable, frame: &LeafFrame) -> Surface<'a> {
    let active = sample.active();
    let mut surface = Surface::new(table, &sample.coefficients, &active, frame, None);
    surface.cone = surface.find_cone(frame);
    surface
}

/// The control gradients of the shifted polynomial, without the degree as factor.
fn gradients(sample: &Sample, simplex: &Simplex) -> Vec<Vector> {
    let table = DegreeTable::new(sample.degree);
    let barycentric = barycentric_gradients(simplex).map(vector);
    let c = sample.shifted();
    let of = |raised: &[u32; 4]| {
        let mut sum = [zero(), zero(), zero()];
        for (g, at) in barycentric.iter().zip(raised) {
            for x in 0..3 {
                sum[x] += &g[x] * &c[*at as usize];
            }
        }
        sum
    };
    table.raised().iter().map(of).collect()
}

/// ∇ℓ of the stored vertex values.
fn interpolant(surface: &Surface<'_>, simplex: &Simplex) -> Vector {
    let mut sum = [zero(), zero(), zero()];
    for (g, value) in barycentric_gradients(simplex)
        .map(vector)
        .iter()
        .zip(surface.values)
    {
        for x in 0..3 {
            sum[x] += &g[x] * exact(value);
        }
    }
    sum
}

/// Whether a vector is within the angle with this tangent of an axis.
fn within(v: &Vector, axis: glam::DVec3, tangent: f64) -> bool {
    let axis = vector(axis);
    let along = dot(v, &axis);
    // cos² ≥ 1/(1 + t²)
    let squared = &along * &along * (exact(1.0) + exact(tangent) * exact(tangent));
    along > zero() && squared >= dot(v, v) * dot(&axis, &axis)
}

/// det(a, b, c) in floating point, for directions.
fn determinant(a: glam::DVec3, b: glam::DVec3, c: glam::DVec3) -> f64 {
    a.dot(b.cross(c))
}

fn direction(v: &Vector) -> glam::DVec3 {
    use num_traits::ToPrimitive;
    glam::DVec3::from_array([0, 1, 2].map(|x| v[x].to_f64().unwrap())).normalize()
}

/// The coordinates of each r in the dual basis of the u are dominated by its own.
fn assert_dominated(u: [glam::DVec3; 3], r: [glam::DVec3; 3]) -> Result<(), TestCaseError> {
    let whole = determinant(u[0], u[1], u[2]);
    for i in 0..3 {
        let replaced = [0, 1, 2].map(|m| {
            let mut columns = u;
            columns[m] = r[i];
            determinant(columns[0], columns[1], columns[2]) / whole
        });
        let others: f64 = (0..3).filter(|m| *m != i).map(|m| replaced[m].abs()).sum();
        prop_assert!(
            replaced[i] > others - 1e-9 * replaced[i].abs(),
            "{replaced:?}"
        );
    }
    Ok(())
}

fn unit() -> impl Strategy<Value = glam::DVec3> {
    proptest::array::uniform3(-1.0..1.0f64).prop_filter_map("no direction", |v| {
        glam::DVec3::from_array(v).try_normalize()
    })
}

fn cone(axis: glam::DVec3, half_rad: f64) -> Cone {
    Cone {
        axis,
        tangent: half_rad.tan(),
        wobble: 0.0,
    }
}

proptest! {
    /// Barycentric gradients of lattice simplices carry no rounding at all.
    #[test]
    fn barycentric_gradients_are_exact(root in 0usize..6, turns in proptest::collection::vec(any::<bool>(), 0..50)) {
        let simplex = leaf(root, &turns);
        let corners = simplex.vertices.map(|v| vector(v.position()));
        for (v, g) in barycentric_gradients(&simplex).map(vector).iter().enumerate() {
            for w in 1..4 {
                let edge: Vector = std::array::from_fn(|x| &corners[w][x] - &corners[0][x]);
                let expected = f64::from(u8::from(v == w)) - f64::from(u8::from(v == 0));
                prop_assert_eq!(dot(g, &edge), exact(expected));
            }
        }
    }

    /// Every true gradient and the interpolant's lie in the cone.
    #[test]
    fn cones_hold_all_gradients(
        p in sample(0.0), root in 0usize..6, turns in proptest::collection::vec(any::<bool>(), 0..20),
    ) {
        let simplex = leaf(root, &turns);
        let table = DegreeTable::new(p.degree);
        let surface = surface(&p, &table, &LeafFrame::new(&simplex));
        if let Some(cone) = surface.cone {
            let flat = interpolant(&surface, &simplex);
            prop_assert!(within(&flat, cone.axis, cone.wobble));
            for gradient in gradients(&p, &simplex) {
                prop_assert!(within(&gradient, cone.axis, cone.tangent));
                // The condition itself: the polynomial increases along ∇ℓ.
                prop_assert!(dot(&gradient, &flat) > zero());
            }
        }
    }

    /// ∇ℓ of each is closer to its own true gradients than to the other's lines.
    #[test]
    fn transversal_pairs_keep_apart(
        p in sample(0.0), q in sample(0.0), turns in proptest::collection::vec(any::<bool>(), 0..20),
    ) {
        let simplex = leaf(0, &turns);
        let frame = LeafFrame::new(&simplex);
        let tables = [&p, &q].map(|s| DegreeTable::new(s.degree));
        let surfaces = [surface(&p, &tables[0], &frame), surface(&q, &tables[1], &frame)];
        if let [Some(a), Some(b)] = [surfaces[0].cone, surfaces[1].cone]
            && pairs::transversal(&a, &b)
        {
            let own = [&p, &q].map(|s| gradients(s, &simplex));
            for (i, j) in [(0, 1), (1, 0)] {
                let flat = interpolant(&surfaces[i], &simplex);
                for g in &own[i] {
                    for h in &own[j] {
                        let (mine, other) = (dot(&flat, g), dot(&flat, h));
                        prop_assert!(mine > zero());
                        prop_assert!(&mine * &mine * dot(h, h) > &other * &other * dot(g, g));
                    }
                }
            }
        }
    }

    /// The coordinates of each ∇ℓ in the dual basis of the true gradients are dominated by its own.
    #[test]
    fn independent_triples_are_dominated(
        three in proptest::array::uniform3(sample(0.0)), turns in proptest::collection::vec(any::<bool>(), 0..20),
        pick in proptest::array::uniform3(0usize..20),
    ) {
        let simplex = leaf(0, &turns);
        let frame = LeafFrame::new(&simplex);
        let tables = [0, 1, 2].map(|m| DegreeTable::new(three[m].degree));
        let surfaces = [0, 1, 2].map(|m| surface(&three[m], &tables[m], &frame));
        if let [Some(a), Some(b), Some(c)] = [0, 1, 2].map(|m| surfaces[m].cone)
            && triples::independent(&[a, b, c])
        {
            let u = [0, 1, 2].map(|m| {
                let all = gradients(&three[m], &simplex);
                direction(&all[pick[m] % all.len()])
            });
            let r = [0, 1, 2].map(|m| direction(&interpolant(&surfaces[m], &simplex)));
            assert_dominated(u, r)?;
        }
    }

    /// Cones share a line exactly where their half-angles add up to the angle of their axes.
    #[test]
    fn transversality_is_that_of_angles(
        axes in proptest::array::uniform2(unit()), halves_rad in proptest::array::uniform2(0.0..0.8f64),
    ) {
        let cones = [0, 1].map(|m| cone(axes[m], halves_rad[m]));
        let angle = axes[0].dot(axes[1]).abs().min(1.0).acos();
        let excess = halves_rad[0] + halves_rad[1] - angle;
        prop_assume!(excess.abs() > 1e-7);
        prop_assert_eq!(pairs::transversal(&cones[0], &cones[1]), excess < 0.0);
    }

    /// Vectors on the cones' rims, in the directions that hurt most among several.
    #[test]
    fn dominance_holds_on_the_rims(
        axes in proptest::array::uniform3(unit()), sizes in proptest::array::uniform3(prop_oneof![Just(0.0), 0.0..0.6f64]),
        turns in proptest::collection::vec(0.0..std::f64::consts::TAU, 60),
    ) {
        // Scaled so that about half of the triples pass.
        let whole = determinant(axes[0], axes[1], axes[2]).abs();
        let halves = sizes.map(|size| size * whole);
        let cones = [0, 1, 2].map(|m| cone(axes[m], halves[m]));
        if !triples::independent(&cones) {
            return Ok(());
        }
        for turn in turns.chunks_exact(3) {
            let u = [0, 1, 2].map(|m| {
                let across = axes[m].any_orthonormal_vector();
                let around = axes[m].cross(across) * turn[m].sin() + across * turn[m].cos();
                axes[m] * halves[m].cos() + around * halves[m].sin()
            });
            assert_dominated(u, axes)?;
        }
    }

    /// Where a pattern is excluded, the combination has its sign whatever the errors, at all
    /// coefficients.
    #[test]
    fn excluded_patterns_do_not_occur(
        all in proptest::collection::vec(sample(0.6), 2..5), factors in proptest::array::uniform4(-1.0..1.0f64),
    ) {
        let simplex = leaf(0, &[]);
        let frame = LeafFrame::new(&simplex);
        let tables: Vec<_> = all.iter().map(|s| DegreeTable::new(s.degree)).collect();
        let surfaces: Vec<_> = all.iter().zip(&tables).map(|(s, t)| surface(s, t, &frame)).collect();
        let combination: Combination = (0..all.len()).map(|m| (m, factors[m])).collect();
        if let Some(pattern) = excluded(&surfaces, &combination) {
            // Degree elevation in exact numbers, up to the highest degree.
            let degree = all.iter().map(|s| s.degree).max().unwrap();
            let mut sums = vec![zero(); count(degree)];
            for (m, s) in all.iter().enumerate() {
                for (sum, c) in sums.iter_mut().zip(elevated(s.degree, s.shifted(), degree)) {
                    *sum += exact(factors[m]) * c;
                }
            }
            let positive = sums[0] > zero();
            for sum in &sums {
                prop_assert!(*sum != zero() && (*sum > zero()) == positive);
            }
            for (m, factor) in factors[..all.len()].iter().enumerate().filter(|(_, f)| **f != 0.0) {
                let expected = Patterns::with(m, (*factor > 0.0) == positive);
                prop_assert_eq!(pattern.intersection(expected), pattern);
            }
        }
    }

    /// Four planes that miss each other are found to do so, however close they come.
    #[test]
    fn quadruples_of_planes_are_told_apart(
        at in proptest::array::uniform3(0.1..0.25f64), gap in prop_oneof![Just(1e-9), Just(-1e-9), -0.1..0.1f64],
    ) {
        prop_assume!(gap != 0.0);
        // Barycentric coordinates b1, b2, b3 at three given values, and their sum.
        let plane = |c: [f64; 4]| Sample {
            degree: 1, coefficients: c.to_vec(), error: 1e-15, signs: vec![true; 4],
        };
        let sum = at[0] + at[1] + at[2] + gap;
        let all = [
            plane([-at[0], 1.0 - at[0], -at[0], -at[0]]),
            plane([-at[1], -at[1], 1.0 - at[1], -at[1]]),
            plane([-at[2], -at[2], -at[2], 1.0 - at[2]]),
            plane([-sum, 1.0 - sum, 1.0 - sum, 1.0 - sum]),
        ];
        let table = DegreeTable::new(1);
        let frame = LeafFrame::new(&leaf(0, &[]));
        let surfaces = [0, 1, 2, 3].map(|m| surface(&all[m], &table, &frame));
        prop_assert!(quadruples::apart(&surfaces, [0, 1, 2, 3]).is_some());
    }
}

/// Value of a quadratic form's gradient at a point, in exact numbers, from its power coefficients.
fn true_gradient(power: &[BigRational], at: &Vector) -> Vector {
    let c = |i: usize, j: usize, k: usize| power[Polynomial::index(2, i, j, k)].clone();
    let two = exact(2.0);
    let [x, y, z] = at;
    [
        c(2, 0, 0) * &two * x + c(1, 1, 0) * y + c(1, 0, 1) * z + c(1, 0, 0),
        c(1, 1, 0) * x + c(0, 2, 0) * &two * y + c(0, 1, 1) * z + c(0, 1, 0),
        c(1, 0, 1) * x + c(0, 1, 1) * y + c(0, 0, 2) * &two * z + c(0, 0, 1),
    ]
}

proptest! {
    /// Far below the root, where errors of values are large against the cells: the gradients of the
    /// user's quadric, whose coefficients are off by as much as the model allows, are in the cone.
    #[test]
    fn deep_cones_hold_the_models_gradients(
        root in 0usize..6, turns in proptest::collection::vec(any::<bool>(), 57),
        power in proptest::collection::vec((-1.0..1.0f64, any::<bool>()), 10),
        error in prop_oneof![Just(0.0), Just(1e-16), Just(1e-12), Just(1e-7), Just(1e-3)],
        flatten in prop_oneof![Just(1.0), Just(1e-5), Just(1e-9), Just(1e-13)],
    ) {
        // A steep plane would hide all errors.
        let mut coefficients: Vec<f64> = power.iter().map(|(c, _)| c * flatten).collect();
        coefficients[9] = power[9].0;
        let polynomial = Polynomial::new(2, coefficients.clone()).unwrap();
        let shifted: Vec<BigRational> = coefficients.iter().zip(&power)
            .map(|(c, (_, up))| exact(*c) + exact(if *up { error } else { -error }))
            .collect();
        let roots = RootCoefficients::new(&Primitive { polynomial, coefficient_error: 10.0 * error });
        let table = DegreeTable::new(2);
        let mut simplex = Simplex::roots()[root];
        let mut coefficients = roots.roots[root].clone();
        let mut active = Active {
            primitive: 0,
            degree: 2,
            offset: 0,
            rounding: roots.rounding,
            root_rounding: roots.rounding,
            model_error: roots.model_error,
            largest: 0.0,
            value: csg::Ternary::Unknown,
            clearance: 0.0,
        };
        for far in turns {
            active.largest = coefficients.iter().fold(0.0, |m, c| c.abs().max(m));
            let frame = LeafFrame::new(&simplex);
            let surface = Surface::new(&table, &coefficients, &active, &frame, None);
            if let Some(cone) = surface.find_cone(&frame) {
                for corner in simplex.vertices {
                    let gradient = true_gradient(&shifted, &vector(2.0 * corner.position() - 1.0));
                    prop_assert!(within(&gradient, cone.axis, cone.tangent), "level {}", simplex.level);
                }
            }
            active.rounding = crate::rounding::of_halving(2, active.rounding, active.largest);
            let mut children = [coefficients.clone(), coefficients.clone()];
            let [near, other] = &mut children;
            crate::halving::halve(2, simplex.kind(), &coefficients, near, other);
            coefficients.clone_from(&children[usize::from(far)]);
            simplex = simplex.children()[usize::from(far)];
        }
    }
}

/// c_α of degree n as a polynomial of a higher degree, one degree at a time.
fn elevated(mut n: usize, mut c: Vec<BigRational>, degree: usize) -> Vec<BigRational> {
    while n < degree {
        let mut up = vec![zero(); count(n + 1)];
        crate::bernstein::for_each_index(n + 1, |at, e| {
            for v in 0..4 {
                if e[v] > 0 {
                    let mut lower = e;
                    lower[v] -= 1;
                    let from = crate::bernstein::index(lower[1], lower[2], lower[3]);
                    let weight = BigRational::new(e[v].into(), (n + 1).into());
                    up[at] += weight * &c[from];
                }
            }
        });
        n += 1;
        c = up;
    }
    c
}
