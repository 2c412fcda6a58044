use super::*;
use csg::{Ellipsoid, ModelBuilder, Node, NodeId, Shape};

fn ball() -> Solid {
    let mut model = ModelBuilder::new();
    let shape = Shape::Ellipsoid(Ellipsoid::new(DVec3::ONE).unwrap());
    let ball = model.add(Node::Shape(shape));
    Solid::build(&model.finish(ball), None).unwrap()
}

/// A grid of origins in a plane across the direction, and far away.
fn grid(direction: DVec3, half: f64, side: u32) -> Vec<DVec3> {
    let (u, v) = direction.normalize().any_orthonormal_pair();
    let place = |i: u32| (f64::from(i) + 0.37) / f64::from(side) * 2.0 * half - half;
    (0..side * side)
        .map(|at| u * place(at % side) + v * place(at / side) - direction * 9.0)
        .collect()
}

/// Source: the quadratic equation.
#[test]
fn rays_meet_a_ball_where_they_should() {
    let solid = ball();
    let tracer = Tracer::new(&solid);
    for direction in [DVec3::Y, DVec3::NEG_Z, DVec3::new(-1.0, 2.0, -0.5)] {
        let origins = grid(direction, 1.1, 64);
        let hits = tracer.first_hits(direction, &origins).unwrap();
        let unit = direction.normalize();
        for (origin, hit) in origins.iter().zip(hits) {
            let foot = *origin - unit * unit.dot(*origin);
            let squared = 1.0 - foot.length_squared();
            let Some(hit) = hit else {
                assert!(squared < 1e-9, "{origin} misses the ball");
                continue;
            };
            let expected = foot - unit * squared.max(0.0).sqrt();
            let error = hit.position.distance(expected);
            assert!(
                error < 1e-12 / squared.max(1e-6).sqrt(),
                "{error} {squared}"
            );
            assert!(hit.normal.distance(expected) < 10.0 * error + 1e-12);
        }
    }
}

/// Solids with thin walls, coincident faces, creases, several colours and a quartic.
fn samples() -> Vec<Solid> {
    let mut solids = Vec::new();
    let mut build = |make: &dyn Fn(&mut ModelBuilder) -> NodeId| {
        let mut model = ModelBuilder::new();
        let root = make(&mut model);
        solids.push(Solid::build(&model.finish(root), None).unwrap());
    };
    let shape = |model: &mut ModelBuilder, shape: Shape| model.add(Node::Shape(shape));
    build(&|model| {
        let block = shape(model, Shape::block(DVec3::splat(-1.0), DVec3::ONE).unwrap());
        let ball = shape(model, Shape::sphere(1.25).unwrap());
        let color = model.material(csg::Material {
            color: Some([1.0, 0.0, 0.0, 1.0]),
        });
        let ball = model.add(Node::Painted(color, ball));
        model.add(Node::Difference(vec![block, ball]))
    });
    build(&|model| {
        let torus = shape(model, Shape::torus(1.0, 0.3).unwrap());
        let ball = shape(model, Shape::sphere(0.8).unwrap());
        model.add(Node::Union(vec![torus, ball]))
    });
    build(&|model| {
        let outer = shape(model, Shape::sphere(1.0).unwrap());
        let inner = shape(model, Shape::sphere(0.999).unwrap());
        let half = DVec3::new(2.0, 2.0, 0.3);
        let cut = shape(
            model,
            Shape::block(DVec3::new(-2.0, -2.0, -2.0), half).unwrap(),
        );
        let cup = model.add(Node::Difference(vec![outer, inner]));
        model.add(Node::Intersection(vec![cup, cut]))
    });
    build(&|model| {
        let below = shape(
            model,
            Shape::block(DVec3::NEG_ONE, DVec3::new(1.0, 1.0, 0.0)).unwrap(),
        );
        let above = shape(
            model,
            Shape::block(DVec3::new(-0.5, -0.5, 0.0), DVec3::ONE).unwrap(),
        );
        model.add(Node::Union(vec![below, above]))
    });
    solids
}

/// The oracle is membership of points along the rays, which knows nothing of the bintree.
#[test]
fn nothing_is_in_front_of_a_hit_and_the_solid_behind_it() {
    const STEPS: u32 = 700;
    for solid in samples() {
        let tracer = Tracer::new(&solid);
        let middle = (solid.extent.min + solid.extent.max) * 0.5;
        for direction in [DVec3::new(0.3, 0.2, -1.0), DVec3::NEG_X, DVec3::ONE] {
            let direction = direction.normalize();
            let mut origins = grid(direction, 1.6, 24);
            for origin in &mut origins {
                *origin += middle;
            }
            let hits = tracer.first_hits(direction, &origins).unwrap();
            assert!(hits.iter().any(Option::is_some) && hits.iter().any(Option::is_none));
            for (origin, hit) in origins.iter().zip(hits) {
                let at = |step: u32| 6.5 + 5.0 * f64::from(step) / f64::from(STEPS);
                let distance =
                    hit.map_or(f64::INFINITY, |hit| (hit.position - *origin).dot(direction));
                let before = (0..STEPS).map(at).filter(|t| *t < distance - 1e-9);
                for t in before {
                    assert!(
                        !solid.contains(*origin + direction * t),
                        "{origin} {direction} {t}"
                    );
                }
                if let Some(hit) = hit {
                    // Through an edge a ray may pass for less than this.
                    let behind = [1e-9, 1e-6].map(|t| solid.contains(hit.position + direction * t));
                    assert!(behind[0] || behind[1], "{origin} {direction}");
                    assert!(hit.normal.dot(direction) < 1e-6);
                    assert!(hit.position.distance(*origin + direction * distance) < 1e-9);
                }
            }
        }
    }
}

/// A cube with a ball cut out of it, which opens all six faces: red inside.
#[test]
fn a_hit_tells_surface_and_material() {
    let solid = &samples()[0];
    let tracer = Tracer::new(solid);
    let first = |direction: DVec3, through: DVec3| {
        let origin = through - direction * 9.0;
        let hit = tracer.first_hits(direction, &[origin]).unwrap()[0];
        hit.map(|hit| (hit.sense, solid.materials[hit.material.0 as usize].color))
    };
    let red = Some([1.0, 0.0, 0.0, 1.0]);
    assert_eq!(first(DVec3::NEG_Z, DVec3::new(0.1, 0.2, 0.0)), None);
    let corner = DVec3::new(0.95, 0.95, 0.0);
    assert_eq!(first(DVec3::NEG_Z, corner), Some((Sense::Inside, None)));
    let through_the_hole = first(DVec3::new(1.0, 1.0, -0.5), DVec3::Z);
    assert_eq!(through_the_hole, Some((Sense::Outside, red)));
}
