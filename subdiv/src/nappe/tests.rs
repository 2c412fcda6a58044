use super::*;
use crate::blossom::RootCoefficients;
use crate::halving::halve;
use csg::{MaterialId, Polynomial};
use proptest::prelude::*;

const DOMAIN: (DVec3, f64) = (DVec3::ZERO, 2.0);

/// ±(a·x² + b·y² − c·z²) about an apex and an axis, in centred coordinates, and the plane z = 0.
fn cone(apex: DVec3, axis: DVec3, [a, b, c]: [f64; 3], flip: f64) -> [Primitive; 2] {
    let z = axis.normalize();
    let x = z.any_orthonormal_vector();
    let y = z.cross(x);
    let mut quadric = vec![0.0; 10];
    for (axis, value) in [(x, a), (y, b), (z, -c)] {
        let form = [axis.x, axis.y, axis.z, -axis.dot(apex)];
        let mut at = 0;
        for i in 0..4 {
            for j in i..4 {
                let twice = if i == j { 1.0 } else { 2.0 };
                quadric[at] += flip * twice * value * form[i] * form[j];
                at += 1;
            }
        }
    }
    let plane = vec![z.x, z.y, z.z, -z.dot(apex)];
    [(2, quadric), (1, plane)].map(|(degree, coefficients)| Primitive {
        polynomial: Polynomial::new(degree, coefficients).unwrap(),
        coefficient_error: 0.0,
    })
}

fn domain() -> Domain {
    Domain::around(&csg::Aabb {
        min: DOMAIN.0 - DOMAIN.1 * 0.5,
        max: DOMAIN.0 + DOMAIN.1 * 0.5,
    })
}

fn literal(primitive: u32, sense: Sense) -> FormulaNode {
    FormulaNode::Literal(Literal {
        primitive: PrimitiveId(primitive),
        sense,
        material: MaterialId(0),
    })
}

/// A simplex of the bintree, with p's coefficients there.
fn descend(primitive: &Primitive, root: usize, turns: &[bool]) -> (Simplex, Vec<f64>) {
    let mut c = RootCoefficients::new(primitive).roots[root].clone();
    let mut simplex = Simplex::roots()[root];
    for &turn in turns {
        let mut halves = [vec![0.0; c.len()], vec![0.0; c.len()]];
        let [near, far] = &mut halves;
        halve(2, simplex.kind(), &c, near, far);
        simplex = simplex.children()[usize::from(turn)];
        c = std::mem::take(&mut halves[usize::from(turn)]);
    }
    (simplex, c)
}

proptest! {
    /// What the sheet says holds at random points around the simplex: the gradient of |u| − v, by
    /// hand, is within the angle, and no shorter than told; and where |f| exceeds the swing, p has
    /// the nappe's sign by more than the mesh may be off.
    #[test]
    fn bounds_hold_around_a_simplex(
        apex in proptest::array::uniform3(-0.9..0.9f64), axis in proptest::array::uniform3(-1.0..1.0f64),
        values in proptest::array::uniform3(0.05..1.0f64), flip in any::<bool>(), below in any::<bool>(),
        root in 0usize..6, turns in proptest::collection::vec(any::<bool>(), 0..15),
        tolerance in 0.001..0.05f64,
        samples in proptest::collection::vec((proptest::array::uniform4(0.0..1.0f64), proptest::array::uniform3(-1.0..1.0f64)), 20),
    ) {
        let (apex, axis) = (DVec3::from(apex), DVec3::from(axis));
        prop_assume!(axis.length() > 0.1);
        let flip = if flip { -1.0 } else { 1.0 };
        let primitives = cone(apex, axis, values, flip);
        let cones = DoubleCone::all(&primitives, &domain());
        let found = cones[0].as_ref().unwrap();
        prop_assert!(cones[1].is_none() && found.plane.is_some() && found.error < 1e-12);
        let (simplex, c) = descend(&primitives[0], root, &turns);
        let active = Active::unbounded(0, 2, 0);
        let sign = if below { -1.0 } else { 1.0 };
        let facing = Facing { sign, by_plane: true, absorbed: None };
        let table = DegreeTable::new(2);
        let sheet = found.sheet(facing, (&active, &c), &table, &simplex, tolerance);
        let (low, high) = remainder_bounds(&table, &c);

        let z = axis.normalize();
        let x = z.any_orthonormal_vector();
        let axes = [x, z.cross(x), z];
        let up = sign * if found.along.dot(z) > 0.0 { 1.0 } else { -1.0 };
        for (b, step) in samples {
            let sum = b.iter().sum::<f64>().max(1e-9);
            let inside: DVec3 = (0..4).map(|v| simplex.vertices[v].position() * (b[v] / sum)).sum();
            let step = DVec3::from(step).normalize_or_zero() * 2.0 * tolerance;
            for (at, is_inside) in [(inside, true), (inside + step, false)] {
                let from_apex = 2.0 * at - 1.0 - apex;
                let along = axes.map(|axis| axis.dot(from_apex));
                let [a, b, c] = values;
                let u = (a * along[0] * along[0] + b * along[1] * along[1]).sqrt();
                let v = up * c.sqrt() * along[2];
                // By unit coordinates, of which one is two centred ones.
                let gradient = flip * 2.0 * ((axes[0] * (a * along[0]) + axes[1] * (b * along[1])) / u - z * (up * c.sqrt()));
                prop_assert!(gradient.length() >= sheet.steepness * (1.0 - 1e-9));
                let cosine = gradient.normalize().dot(sheet.normal);
                prop_assert!(cosine >= sheet.own_cosine() - 1e-9, "{cosine} {}", sheet.own_cosine());
                if is_inside && (u - v).abs() >= sheet.swing {
                    let outside = u > v;
                    let p = u * u - v * v;
                    let by_plane = outside && v < 0.0;
                    prop_assert!(by_plane || (p > 0.0) == outside && p.abs() >= high - low);
                }
            }
        }
    }
}

/// Cone and plane are one nappe where each of the cone's literals stands beside the plane's, as
/// the solid or as its complement.
#[test]
fn nappes_are_read_off_the_formula() {
    use FormulaNode::{Intersection, Union};
    use Sense::{Inside, Outside};
    let primitives = cone(DVec3::ZERO, DVec3::Z, [1.0; 3], 1.0);
    let cones = DoubleCone::all(&primitives, &domain());
    let found = cones[0].as_ref().unwrap();
    let up = found.along.z.signum();
    let root = Simplex::roots()[0];
    let facing = |formula: &[FormulaNode]| found.facing(0, formula, &root, 0.01);
    // z ≤ 0 inside of both.
    let below = [
        Intersection { len: 2 },
        literal(0, Inside),
        literal(1, Inside),
    ];
    let is = |sign, absorbed| {
        let by_plane = true;
        Some(Facing {
            sign,
            by_plane,
            absorbed,
        })
    };
    assert_eq!(facing(&below), is(-up, Some(1)));
    let above = [
        Intersection { len: 2 },
        literal(0, Inside),
        literal(1, Outside),
    ];
    assert_eq!(facing(&above), is(up, Some(1)));
    let complement = [Union { len: 2 }, literal(0, Outside), literal(1, Outside)];
    assert_eq!(facing(&complement), is(-up, Some(1)));
    let flush = [
        Union { len: 6 },
        Intersection { len: 2 },
        literal(0, Inside),
        literal(1, Inside),
        Intersection { len: 2 },
        literal(2, Inside),
        literal(1, Outside),
    ];
    assert_eq!(facing(&flush), is(-up, None));
    let both = [Union { len: 2 }, literal(0, Inside), literal(1, Inside)];
    assert_eq!(facing(&both), None);
    let outer = [
        Intersection { len: 2 },
        literal(0, Outside),
        literal(1, Inside),
    ];
    assert_eq!(facing(&outer), None);
    assert_eq!(facing(&[literal(0, Inside)]), None);
    let double = [
        Union { len: 4 },
        Intersection { len: 2 },
        literal(0, Inside),
        literal(1, Inside),
        literal(0, Inside),
    ];
    assert_eq!(facing(&double), None);
}
