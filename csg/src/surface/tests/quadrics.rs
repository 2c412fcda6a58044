//! Quadrics built exactly, in rational numbers: turned by integer quaternions, moved, scaled, and
//! rounded once, at the end.

use super::*;
use num_rational::BigRational;
use num_traits::ToPrimitive;

type Rows = [[BigRational; 4]; 4];

fn rational(number: i64) -> BigRational {
    BigRational::from_integer(number.into())
}

/// A quadric in its own axes: kind, sizes, and the equation's diagonal, coefficient of z, constant.
struct Case {
    kind: QuadricKind,
    sizes: [f64; 3],
    diagonal: [BigRational; 3],
    linear: BigRational,
    constant: BigRational,
}

/// Signs of x², y² and z², coefficient of z, constant.
const EQUATIONS: [(QuadricKind, [i64; 3], i64, i64); 17] = [
    (QuadricKind::Ellipsoid, [1, 1, 1], 0, -1),
    (QuadricKind::ImaginaryEllipsoid, [1, 1, 1], 0, 1),
    (QuadricKind::HyperboloidOfOneSheet, [1, 1, -1], 0, -1),
    (QuadricKind::HyperboloidOfTwoSheets, [1, 1, -1], 0, 1),
    (QuadricKind::EllipticCone, [1, 1, -1], 0, 0),
    (QuadricKind::Point, [1, 1, 1], 0, 0),
    (QuadricKind::EllipticParaboloid, [1, 1, 0], -2, 0),
    (QuadricKind::HyperbolicParaboloid, [1, -1, 0], -2, 0),
    (QuadricKind::EllipticCylinder, [1, 1, 0], 0, -1),
    (QuadricKind::ImaginaryCylinder, [1, 1, 0], 0, 1),
    (QuadricKind::HyperbolicCylinder, [1, -1, 0], 0, -1),
    (QuadricKind::ParabolicCylinder, [1, 0, 0], -2, 0),
    (QuadricKind::CrossingPlanes, [1, -1, 0], 0, 0),
    (QuadricKind::Line, [1, 1, 0], 0, 0),
    (QuadricKind::ParallelPlanes, [1, 0, 0], 0, -1),
    (QuadricKind::ImaginaryPlanes, [1, 0, 0], 0, 1),
    (QuadricKind::DoublePlane, [1, 0, 0], 0, 0),
];

/// The equation of index `at` for lengths a > b > c.
fn case(at: usize, lengths: [i64; 3]) -> Case {
    let (kind, signs, linear, constant) = EQUATIONS[at];
    let [a, b, c] = lengths.map(|n| rational(n).to_f64().expect("small"));
    let sizes = match kind {
        QuadricKind::EllipticCone | QuadricKind::Point => [a / c, b / c, 1.0],
        QuadricKind::CrossingPlanes => [(b / a).atan(), 0.0, 0.0],
        QuadricKind::Line => [a / b, 0.0, 0.0],
        QuadricKind::DoublePlane => [0.0; 3],
        _ => [0, 1, 2].map(|k| if signs[k] == 0 { 0.0 } else { [a, b, c][k] }),
    };
    // Lengths are radii where there is a vertex, semi-axes elsewhere.
    let power = if linear == 0 { 2 } else { 1 };
    Case {
        kind,
        sizes,
        diagonal: [0, 1, 2].map(|k| rational(signs[k]) / rational(lengths[k].pow(power))),
        linear: rational(linear),
        constant: rational(constant),
    }
}

/// The rotation of an integer quaternion that is not zero: columns are the turned axes.
fn rotation([w, x, y, z]: [i64; 4]) -> [[BigRational; 3]; 3] {
    let norm = rational(w * w + x * x + y * y + z * z);
    let rows = [
        [
            w * w + x * x - y * y - z * z,
            2 * (x * y - w * z),
            2 * (x * z + w * y),
        ],
        [
            2 * (x * y + w * z),
            w * w - x * x + y * y - z * z,
            2 * (y * z - w * x),
        ],
        [
            2 * (x * z - w * y),
            2 * (y * z + w * x),
            w * w - x * x - y * y + z * z,
        ],
    ];
    rows.map(|row| row.map(|entry| rational(entry) / &norm))
}

/// Coefficient matrix of the case turned and moved to `center`.
fn placed(case: &Case, turn: &[[BigRational; 3]; 3], center: [i64; 3]) -> Rows {
    // Own coordinates as forms in (x, y, z, 1): axis · (p − center).
    let own: Vec<[BigRational; 4]> = (0..3)
        .map(|k| {
            let axis = [0, 1, 2].map(|row| turn[row][k].clone());
            let offset: BigRational = (0..3).map(|i| &axis[i] * rational(center[i])).sum();
            let [x, y, z] = axis;
            [x, y, z, -offset]
        })
        .collect();
    let mut rows = Rows::default();
    for i in 0..4 {
        for j in 0..4 {
            rows[i][j] = (0..3)
                .map(|k| &case.diagonal[k] * &own[k][i] * &own[k][j])
                .sum();
        }
        rows[i][3] += &case.linear * &own[2][i];
    }
    rows[3][3] += &case.constant;
    rows
}

/// The same equation in the frame that was found, in floating point.
fn expanded(case: &Case, form: &QuadricForm) -> Polynomial {
    let number = |r: &BigRational| r.to_f64().expect("small");
    let own = form
        .axes
        .map(|axis| [axis.x, axis.y, axis.z, -axis.dot(form.center)]);
    let mut rows = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            rows[i][j] = (0..3)
                .map(|k| number(&case.diagonal[k]) * own[k][i] * own[k][j])
                .sum();
        }
        rows[i][3] += number(&case.linear) * own[2][i];
    }
    rows[3][3] += number(&case.constant);
    Polynomial::quadric(&rows).expect("finite")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn quadrics_have_their_kinds_sizes_and_places(
        kind in 0..EQUATIONS.len(),
        sizes in proptest::sample::subsequence((1..=9_i64).collect::<Vec<i64>>(), 3),
        quaternion in proptest::array::uniform4(-5..=5_i64)
            .prop_filter("a rotation", |q| *q != [0; 4]),
        center in proptest::array::uniform3(-4..=4_i64),
        factor in prop_oneof![-1000_i64..=-1, 1..=1000_i64],
    ) {
        let case = case(kind, [sizes[2], sizes[1], sizes[0]]);
        let turn = rotation(quaternion);
        let rows = placed(&case, &turn, center);
        let rows = rows.map(|row| row.map(|entry| (entry * rational(factor)).to_f64().expect("small")));
        let p = Polynomial::quadric(&rows).expect("finite");
        let scale = p.max_abs();
        let primitive = Primitive {
            polynomial: p.scaled(1.0 / scale).expect("finite"),
            coefficient_error: f64::EPSILON,
        };
        let domain = Domain::around(&crate::Aabb { min: DVec3::ZERO, max: DVec3::ONE });
        // The same quadric in the coordinates of a cube that is not the unit cube.
        let (o, s) = (domain.center(), domain.half_size());
        let inner = primitive.polynomial.substituted(&[
            [s, 0.0, 0.0, 0.0],
            [0.0, s, 0.0, 0.0],
            [0.0, 0.0, s, 0.0],
            [o.x, o.y, o.z, 1.0],
        ]).expect("finite");
        let inner = Primitive { polynomial: inner, coefficient_error: 64.0 * f64::EPSILON };
        let Surface::Quadric(form) = inner.surface(&domain) else {
            panic!("{:?}", inner.surface(&domain));
        };
        prop_assert_eq!(form.kind, case.kind);
        // Coefficients carry 1e-16 of the largest one; sizes 1 to 9 make eigenvalues that differ by
        // factors of up to 81 and gaps of 1/300.
        let near = 1e-9;
        for (found, expected) in form.sizes.iter().zip(case.sizes) {
            prop_assert!((found - expected).abs() < near * expected.max(1.0), "{form:?} {:?}", case.sizes);
        }
        let [x, y, z] = form.axes;
        prop_assert!((x.cross(y) - z).length() < 1e-12);
        let ours = expanded(&case, &form);
        let largest = ours.max_abs();
        let relative = ours.scaled(primitive.polynomial.max_abs() / largest).expect("finite");
        // Up to the sign that the factor has.
        let difference = [1.0, -1.0].map(|sign| {
            let turned = relative.clone().scaled(sign).expect("finite");
            turned.difference(&primitive.polynomial).expect("finite").max_abs()
        });
        prop_assert!(difference[0].min(difference[1]) < near, "{form:?}");
        if let Some(planes) = form.planes() {
            for (normal, offset) in planes {
                let on_plane = normal * offset;
                let value = primitive.polynomial.evaluate(on_plane);
                let gradient = primitive.polynomial.gradient(on_plane);
                prop_assert!(value.abs() < near, "{form:?}");
                // All of the plane, as far as first order tells.
                prop_assert!(gradient.reject_from(normal).length() < 1e-7, "{form:?}");
            }
        }
    }
}
