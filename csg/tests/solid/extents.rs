//! Extents: never too small, and tight.

use crate::oracle::{Tree, affine, bounded_shape, heart, model, shape_contains, vector};
use csg::{Aabb, Error, Model, ModelBuilder, Node, Polynomial, Shape, Solid, Transform};
use glam::DVec3;
use proptest::prelude::*;

fn of_shape(shape: Shape) -> Result<Aabb, Error> {
    Solid::build(&model(&Tree::Shape(shape)), None).map(|solid| solid.extent)
}

fn moved(shape: Shape, transform: &Transform) -> Model {
    model(&Tree::Moved(
        transform.clone(),
        Box::new(Tree::Shape(shape)),
    ))
}

fn intersection(shapes: Vec<Shape>) -> Model {
    let mut builder = ModelBuilder::new();
    let nodes = shapes.into_iter().map(|s| builder.add(Node::Shape(s)));
    let nodes: Vec<_> = nodes.collect();
    let root = builder.add(Node::Intersection(nodes));
    builder.finish(root)
}

/// How much of each side of `found` the box `truth` misses, at most; negative if too small.
fn excess(found: &Aabb, truth: &Aabb) -> f64 {
    let sides = truth.max - truth.min;
    let over = ((found.max - truth.max) / sides).max((truth.min - found.min) / sides);
    let under = ((found.max - truth.max) / sides).min((truth.min - found.min) / sides);
    if under.min_element() < 0.0 {
        under.min_element()
    } else {
        over.max_element()
    }
}

/// Farthest point of the heart in a direction, by brute force over a grid of directions from
/// the origin (it is star-shaped about it) and bisection along each.
fn heart_box() -> Aabb {
    let p = heart();
    let mut found = Aabb::EMPTY;
    let steps = 400;
    for i in 0..=steps {
        for j in 0..2 * steps {
            let theta = std::f64::consts::PI * f64::from(i) / f64::from(steps);
            let phi = std::f64::consts::PI * f64::from(j) / f64::from(steps);
            let d = DVec3::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            );
            let (mut near, mut far) = (0.0, 3.0);
            for _ in 0..40 {
                let middle = 0.5 * (near + far);
                if p.evaluate(d * middle) <= 0.0 {
                    near = middle;
                } else {
                    far = middle;
                }
            }
            found.min = found.min.min(d * near);
            found.max = found.max.max(d * near);
        }
    }
    found
}

#[test]
fn the_heart_gets_a_tight_box() {
    let truth = heart_box();
    let found = of_shape(Shape::Polynomial(heart())).unwrap();
    // The grid misses the extreme points by the square of its step, 6e-5.
    let excess = excess(&found, &truth);
    assert!(
        (-1e-4..0.01).contains(&excess),
        "{excess}: {found:?} {truth:?}"
    );
}

#[test]
fn far_and_near_hearts_get_tight_boxes() {
    let truth = heart_box();
    let p = heart();
    for (scale, offset) in [(1e-3, 0.0), (1e3, 0.0), (1.0, 5.0)] {
        let by = DVec3::new(1.0, -2.0, 0.5) * offset;
        let back = [
            [1.0 / scale, 0.0, 0.0, 0.0],
            [0.0, 1.0 / scale, 0.0, 0.0],
            [0.0, 0.0, 1.0 / scale, 0.0],
            [-by.x / scale, -by.y / scale, -by.z / scale, 1.0],
        ];
        let found = of_shape(Shape::Polynomial(p.substituted(&back).unwrap())).unwrap();
        let truth = Aabb {
            min: truth.min * scale + by,
            max: truth.max * scale + by,
        };
        let excess = excess(&found, &truth);
        assert!(
            (-1e-4..0.03).contains(&excess),
            "{scale} {offset}: {excess}"
        );
    }
}

#[test]
fn a_complement_with_a_bounded_inside_is_bounded() {
    let outside = Shape::Polynomial(heart().negated());
    let inside = model(&Tree::Complement(Box::new(Tree::Shape(outside))));
    let found = Solid::build(&inside, None).unwrap().extent;
    assert!(excess(&found, &heart_box()) < 0.01);
}

#[test]
fn ellipsoids_written_as_quadrics_get_exact_boxes() {
    // (x−1)²/4 + (y+2)² + z²/9 ≤ 1, times −1, as a complement too.
    let m = [
        [0.25, 0.0, 0.0, -0.25],
        [0.0, 1.0, 0.0, 2.0],
        [0.0, 0.0, 1.0 / 9.0, 0.0],
        [-0.25, 2.0, 0.0, 3.25],
    ];
    let truth = Aabb {
        min: DVec3::new(-1.0, -3.0, -3.0),
        max: DVec3::new(3.0, -1.0, 3.0),
    };
    let found = of_shape(Shape::quadric(&m).unwrap()).unwrap();
    assert!((0.0..1e-12).contains(&excess(&found, &truth)), "{found:?}");
    let negative = Shape::quadric(&m.map(|row| row.map(|c| -c))).unwrap();
    let complement = model(&Tree::Complement(Box::new(Tree::Shape(negative))));
    let found = Solid::build(&complement, None).unwrap().extent;
    assert!((0.0..1e-12).contains(&excess(&found, &truth)));
}

#[test]
fn quadrics_are_bounded_by_planes() {
    let up = |z| Shape::half_space(DVec3::Z, z).unwrap();
    let down = |z: f64| Shape::half_space(-DVec3::Z, -z).unwrap();
    // z ≥ x² + y² below z = 4; the cone x² + y² ≤ z² for 1 ≤ z ≤ 3.
    let mut paraboloid = [[0.0; 4]; 4];
    paraboloid[0][0] = 1.0;
    paraboloid[1][1] = 1.0;
    paraboloid[2][3] = -1.0;
    let found = intersection(vec![Shape::quadric(&paraboloid).unwrap(), up(4.0)]);
    let found = Solid::build(&found, None).unwrap().extent;
    let truth = Aabb {
        min: DVec3::new(-2.0, -2.0, 0.0),
        max: DVec3::new(2.0, 2.0, 4.0),
    };
    assert!((0.0..0.01).contains(&excess(&found, &truth)), "{found:?}");

    let mut cone = [[0.0; 4]; 4];
    cone[0][0] = 1.0;
    cone[1][1] = 1.0;
    cone[2][2] = -1.0;
    let found = intersection(vec![Shape::quadric(&cone).unwrap(), up(3.0), down(1.0)]);
    let found = Solid::build(&found, None).unwrap().extent;
    let truth = Aabb {
        min: DVec3::new(-3.0, -3.0, 1.0),
        max: DVec3::splat(3.0),
    };
    assert!((0.0..0.01).contains(&excess(&found, &truth)), "{found:?}");
}

#[test]
fn oblique_planes_bound_a_needle() {
    // Three planes through (0, 0, 1000), hardly inclined to the axis, and z ≥ 0.
    let mut shapes = vec![Shape::half_space(-DVec3::Z, 0.0).unwrap()];
    for k in 0..3 {
        let angle = f64::from(k) * std::f64::consts::TAU / 3.0;
        let normal = DVec3::new(angle.cos(), angle.sin(), 1e-4);
        shapes.push(Shape::half_space(normal, 0.1).unwrap());
    }
    let found = Solid::build(&intersection(shapes), None).unwrap().extent;
    assert!(found.max.z >= 1000.0 && found.max.z < 1020.0, "{found:?}");
    assert!(found.min.x <= -0.2 && found.min.x > -0.21, "{found:?}");
}

#[test]
fn unbounded_solids_need_a_clip_box() {
    let clip = Aabb {
        min: DVec3::splat(-1.0),
        max: DVec3::splat(2.0),
    };
    let mut cylinder = [[0.0; 4]; 4];
    cylinder[0][0] = 1.0;
    cylinder[1][1] = 1.0;
    cylinder[3][3] = -0.25;
    for shape in [
        Shape::half_space(DVec3::ONE, 0.5).unwrap(),
        Shape::quadric(&cylinder).unwrap(),
        Shape::Polynomial(
            Polynomial::from_terms(3, &[([3, 0, 0], 1.0), ([0, 1, 0], 1.0)]).unwrap(),
        ),
    ] {
        let model = model(&Tree::Shape(shape));
        assert_eq!(Solid::build(&model, None).unwrap_err(), Error::Unbounded);
        let solid = Solid::build(&model, Some(clip)).unwrap();
        assert!(solid.clipped);
        assert_eq!(solid.extent.intersection(&clip), solid.extent);
        assert!(!solid.contains(DVec3::splat(2.01)));
    }
    let ball = model(&Tree::Shape(Shape::sphere(0.5).unwrap()));
    let solid = Solid::build(&ball, Some(clip)).unwrap();
    assert!(!solid.clipped);
    assert_eq!(solid.primitives.len(), 1);
}

#[test]
fn bad_clip_boxes_are_refused() {
    let ball = model(&Tree::Shape(Shape::sphere(0.5).unwrap()));
    let flat = Aabb {
        min: DVec3::ZERO,
        max: DVec3::new(1.0, 1.0, 0.0),
    };
    for clip in [Aabb::EMPTY, Aabb::EVERYWHERE, flat] {
        assert_eq!(
            Solid::build(&ball, Some(clip)).unwrap_err(),
            Error::BadClipBox
        );
    }
}

#[test]
fn extents_beyond_floating_point_are_refused() {
    let by = Transform::translation(DVec3::splat(1e15)).unwrap();
    let far = moved(Shape::sphere(1e-3).unwrap(), &by);
    assert_eq!(
        Solid::build(&far, None).unwrap_err(),
        Error::ExtentOutOfRange
    );
    let tiny = model(&Tree::Shape(Shape::sphere(1e-120).unwrap()));
    assert_eq!(
        Solid::build(&tiny, None).unwrap_err(),
        Error::ExtentOutOfRange
    );
}

/// Points of a shape's surface as seen along a direction come as close to the box as sampling
/// allows: maximise each coordinate by random search with shrinking steps.
fn reaches(shape: &Shape, transform: &Transform, found: &Aabb) -> bool {
    let back = transform.inverse();
    let holds = |p: DVec3| back.apply(p).is_some_and(|q| shape_contains(shape, q));
    let sides = found.max - found.min;
    let grid = 24;
    let mut reached = Aabb::EMPTY;
    for at in 0..grid * grid * grid {
        let cell = DVec3::new(
            f64::from(at % grid),
            f64::from(at / grid % grid),
            f64::from(at / grid / grid),
        );
        let p = found.min + sides * (cell + 0.5) / f64::from(grid);
        if holds(p) {
            reached.min = reached.min.min(p);
            reached.max = reached.max.max(p);
        }
    }
    // A cone's apex or a block's corner may be missed by several cells.
    let slack = sides * 8.0 / f64::from(grid);
    (found.max - reached.max).cmple(slack).all() && (reached.min - found.min).cmple(slack).all()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn boxes_of_moved_shapes_are_tight(shape in bounded_shape(), t in affine()) {
        let found = Solid::build(&moved(shape.clone(), &t), None).unwrap().extent;
        prop_assert!(reaches(&shape, &t, &found), "{:?}", found);
    }

    /// The box of a rotated ellipsoid from the lengths of the matrix' rows.
    #[test]
    fn boxes_of_ellipsoids_are_exact(radii in vector(0.2, 2.0), t in affine()) {
        let found = Solid::build(&moved(Shape::ellipsoid(radii).unwrap(), &t), None).unwrap();
        for (axis, [x, y, z, center]) in t.to_columns().into_iter().take(3).enumerate() {
            let reach = (DVec3::new(x, y, z) * radii).length();
            prop_assert!((found.extent.max[axis] - center - reach).abs() < 1e-14 * 10.0);
            prop_assert!((center - reach - found.extent.min[axis]).abs() < 1e-14 * 10.0);
        }
    }

    /// An ellipsoid written as a polynomial of degree 4 (its quadric times a positive one), so
    /// that it takes the general proof.
    #[test]
    fn boxes_of_moved_polynomials_are_tight(radii in vector(0.5, 2.0), t in affine()) {
        let squares = |r: DVec3, c: f64| Polynomial::from_terms(2, &[
            ([2, 0, 0], 1.0 / (r.x * r.x)), ([0, 2, 0], 1.0 / (r.y * r.y)),
            ([0, 0, 2], 1.0 / (r.z * r.z)), ([0, 0, 0], c),
        ]).unwrap();
        let p = squares(radii, -1.0).product(&squares(DVec3::ONE, 1.0)).unwrap();
        let exact = Shape::ellipsoid(radii).unwrap().bounds(&t);
        let found = Solid::build(&moved(Shape::Polynomial(p), &t), None).unwrap().extent;
        let excess = excess(&found, &exact);
        prop_assert!((-1e-12..0.02).contains(&excess), "{}", excess);
    }
}
