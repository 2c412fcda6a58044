mod quadrics;

use super::*;
use crate::{ModelBuilder, Node, Shape, Solid, Transform};
use proptest::prelude::*;

/// The surfaces of a moved shape, and the motion.
fn surfaces(shape: Shape, motion: &Transform) -> Vec<Surface> {
    let mut builder = ModelBuilder::new();
    let node = builder.add(Node::Shape(shape));
    let root = builder.add(Node::Instance(motion.clone(), node));
    let solid = Solid::build(&builder.finish(root), None).expect("bounded");
    let primitives = solid.primitives.iter();
    primitives.map(|p| p.surface(&solid.domain)).collect()
}

fn motion() -> impl Strategy<Value = Transform> {
    let vector = || proptest::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from);
    let axis = vector().prop_filter("a direction", |v| v.length() > 0.1);
    (axis, 0.0..6.3_f64, vector()).prop_map(|(axis, angle_rad, offset)| {
        let turn = Transform::rotation(axis, angle_rad).expect("a rotation");
        let shift = Transform::translation(offset * 3.0).expect("a translation");
        turn.compose(&shift).expect("a motion")
    })
}

/// Images of the origin and of the z axis.
fn image(motion: &Transform) -> (DVec3, DVec3) {
    let at = |p| motion.apply(p).expect("affine");
    (at(DVec3::ZERO), at(DVec3::Z) - at(DVec3::ZERO))
}

/// Coefficients carry 1e-16, in units where the solid has size 1; radicands of small radii lose
/// three digits of them.
const NEAR: f64 = 1e-11;

fn parallel(a: DVec3, b: DVec3) -> bool {
    a.cross(b).length() < NEAR && (a.length() - 1.0).abs() < NEAR
}

fn is_on_axis(point: DVec3, through: DVec3, axis: DVec3) -> bool {
    (point - through).reject_from(axis).length() < NEAR
}

proptest! {
    #[test]
    fn balls_have_spheres(motion in motion(), r in 0.2..3.0_f64) {
        let found = surfaces(Shape::sphere(r).expect("a ball"), &motion);
        let (at, _) = image(&motion);
        let [Surface::Sphere { center, radius }] = found[..] else {
            panic!("{found:?}");
        };
        prop_assert!((center - at).length() < NEAR && (radius - r).abs() < NEAR);
    }

    #[test]
    fn cylinders_have_cylinders_and_planes(motion in motion(), r in 0.2..3.0_f64) {
        let found = surfaces(Shape::cylinder(r, -1.0, 2.0).expect("a cylinder"), &motion);
        let (at, along) = image(&motion);
        let mut offsets = Vec::new();
        for surface in &found {
            match *surface {
                Surface::Plane { normal, offset } => {
                    prop_assert!(parallel(normal, along));
                    offsets.push(offset * normal.dot(along).signum() - at.dot(along));
                }
                Surface::Cylinder { point, axis, radius } => {
                    prop_assert!(parallel(axis, along) && is_on_axis(point, at, along));
                    prop_assert!((radius - r).abs() < NEAR);
                }
                _ => prop_assert!(false, "{surface:?}"),
            }
        }
        offsets.sort_by(f64::total_cmp);
        prop_assert_eq!(found.len(), 3);
        prop_assert!((offsets[0] + 1.0).abs() < NEAR && (offsets[1] - 2.0).abs() < NEAR);
    }

    #[test]
    fn frusta_have_cones(motion in motion(), r in 0.5..2.0_f64) {
        let found = surfaces(Shape::frustum(r, 0.0, -1.0, 1.0).expect("a cone"), &motion);
        let (at, along) = image(&motion);
        let cones = found.iter().filter_map(|surface| match *surface {
            Surface::Cone { apex, axis, half_angle_rad } => Some((apex, axis, half_angle_rad)),
            _ => None,
        });
        let cones: Vec<_> = cones.collect();
        prop_assert_eq!(cones.len(), 1, "{:?}", found);
        let (apex, axis, half_angle_rad) = cones[0];
        prop_assert!((apex - (at + along)).length() < NEAR && parallel(axis, along));
        prop_assert!((half_angle_rad - (0.5 * r).atan()).abs() < NEAR);
    }

    #[test]
    fn tori_are_recognised_from_expanded_quartics(motion in motion(), r in 0.2..0.9_f64) {
        let found = surfaces(Shape::torus(1.0, r).expect("a torus"), &motion);
        let (at, along) = image(&motion);
        let [Surface::Torus { center, axis, ring, tube }] = found[..] else {
            panic!("{found:?}");
        };
        prop_assert!((center - at).length() < NEAR && parallel(axis, along));
        prop_assert!((ring - 1.0).abs() < NEAR && (tube - r).abs() < NEAR);
    }
}
