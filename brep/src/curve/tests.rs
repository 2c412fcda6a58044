use super::*;
use csg::{ModelBuilder, Node, NodeId, Shape, Transform};
use subdiv::{Rule, Settings};

fn moved(builder: &mut ModelBuilder, node: NodeId, offset: DVec3) -> NodeId {
    let transform = Transform::translation(offset).expect("a translation");
    builder.add(Node::Instance(transform, node))
}

fn turned(builder: &mut ModelBuilder, node: NodeId, axis: DVec3, angle_rad: f64) -> NodeId {
    let transform = Transform::rotation(axis, angle_rad).expect("a rotation");
    builder.add(Node::Instance(transform, node))
}

struct Found {
    solid: Solid,
    groups: Groups,
    curves: Curves,
}

/// Curves and positions do not depend on the mesh from which they are found.
const RULES: [Rule; 4] = [
    Rule::Tolerance(0.02),
    Rule::Tolerance(0.005),
    Rule::Topology { finest: 0.01 },
    Rule::Tolerance(0.3),
];

fn curves(make: impl FnOnce(&mut ModelBuilder) -> NodeId) -> Found {
    let found = from_all_meshes(make);
    for (other, rule) in found.iter().zip(RULES) {
        assert_eq!(kinds(other), kinds(&found[0]), "{rule:?}");
    }
    let [first, ..] = found;
    first
}

fn from_all_meshes(make: impl FnOnce(&mut ModelBuilder) -> NodeId) -> [Found; 4] {
    let mut builder = ModelBuilder::new();
    let root = make(&mut builder);
    let model = builder.finish(root);
    RULES.map(|rule| {
        let solid = Solid::build(&model, None).expect("bounded");
        let outcome = subdiv::convert(&solid, &Settings::new(rule), &());
        let fragments = outcome.expect("a subdivision").fragments;
        let stitched = crate::stitch(&fragments).expect("closed");
        let brep = stitched.validate().expect("valid");
        let groups = Groups::of(&brep);
        let curves = Curves::of(&brep, &groups, &solid, 1e-4);
        Found {
            solid,
            groups,
            curves,
        }
    })
}

fn pieces(found: &Found) -> impl Iterator<Item = &Piece> {
    found.curves.edges.iter().flat_map(|edge| &edge.pieces)
}

/// Letters of all curves, sorted.
fn kinds(found: &Found) -> String {
    let kind = |piece: &Piece| match piece.curve {
        Curve::Line { .. } => 'L',
        Curve::Circle { .. } => 'C',
        Curve::Ellipse { .. } => 'E',
        Curve::Traced { .. } => 'T',
    };
    let mut kinds: Vec<char> = pieces(found).map(kind).collect();
    kinds.sort_unstable();
    kinds.into_iter().collect()
}

/// All curves lie on their primitives, between the positions of their ends.
fn check(found: &Found) {
    let Found {
        solid,
        groups,
        curves,
    } = found;
    assert_eq!(curves.unsolved_vertices, []);
    for (edge, curve) in groups.edges.iter().zip(&curves.edges) {
        assert_eq!(curve.unsolved, 0);
        if let Some(ends) = edge.ends {
            assert_eq!(curve.ends(), ends.map(|end| curves.vertices[end]));
        }
        for piece in &curve.pieces {
            for (t, end) in piece.range.into_iter().zip(piece.ends) {
                assert!(piece.curve.point(t).distance(end) < 1e-9, "{piece:?}");
            }
        }
        for chord_error in [1e-1, 1e-3, 1e-5] {
            let line = curve.polyline(solid, chord_error);
            assert_eq!([line[0], line[line.len() - 1]], curve.ends());
            for &point in &line {
                for id in &curve.primitives {
                    let p = &solid.primitives[id.0 as usize].polynomial;
                    let at = solid.domain.to_centered(point);
                    let distance = p.evaluate(at) / p.gradient(at).length();
                    assert!(distance.abs() < 1e-10, "{distance} {curve:?}");
                }
            }
            for pair in line.windows(2) {
                let middle = pair[0].midpoint(pair[1]);
                let meet = Meet::new(solid, &curve.primitives);
                let on = meet.solve(middle, 1.0).expect("near the curve");
                assert!(on.distance(middle) <= 1.01 * chord_error, "{curve:?}");
            }
        }
    }
}

fn cylinder(builder: &mut ModelBuilder, radius: f64, half: f64) -> NodeId {
    builder.add(Node::Shape(
        Shape::cylinder(radius, -half, half).expect("a cylinder"),
    ))
}

fn sphere(builder: &mut ModelBuilder, radius: f64) -> NodeId {
    builder.add(Node::Shape(Shape::sphere(radius).expect("a ball")))
}

const TILT: DVec3 = DVec3::new(0.3, -0.5, 0.8);

#[test]
fn a_tilted_cylinder_has_two_circles() {
    let found = curves(|b| {
        let part = cylinder(b, 0.7, 1.0);
        turned(b, part, TILT, 0.7)
    });
    check(&found);
    assert_eq!(kinds(&found), "CC");
    assert!(found.curves.edges.iter().all(EdgeCurve::is_closed));
    for piece in pieces(&found) {
        let Curve::Circle { across, .. } = &piece.curve else {
            panic!("{piece:?}");
        };
        assert!((across[0].length() - 0.7).abs() < 1e-12);
        assert!((piece.range[1] - TAU).abs() < 1e-15);
    }
}

#[test]
fn balls_meet_in_a_circle_of_known_radius() {
    let found = curves(|b| {
        let [big, small] = [1.0, 0.8].map(|radius| sphere(b, radius));
        let small = moved(b, small, TILT.normalize());
        b.add(Node::Union(vec![big, small]))
    });
    check(&found);
    assert_eq!(kinds(&found), "C");
    let Curve::Circle { center, across } = &found.curves.edges[0].pieces[0].curve else {
        panic!("no circle");
    };
    // d = (1 + R² − r²)/2 along the axis.
    let d = 0.5 * (1.0 + 1.0 - 0.64);
    assert!((*center - TILT.normalize() * d).length() < 1e-12);
    assert!((across[0].length() - (1.0 - d * d).sqrt()).abs() < 1e-12);
}

#[test]
fn equal_cylinders_cross_in_ellipses_that_meet_in_two_points() {
    let found = curves(|b| {
        let first = cylinder(b, 0.5, 1.0);
        let second = turned(b, first, DVec3::X, 1.1);
        b.add(Node::Union(vec![first, second]))
    });
    check(&found);
    assert_eq!(kinds(&found), "CCCCEEEE");
    // Where the ellipses cross, both cylinders' normals are along x.
    let corners = pieces(&found).filter(|piece| matches!(piece.curve, Curve::Ellipse { .. }));
    for at in corners.flat_map(|piece| piece.ends) {
        assert!((at.abs() - DVec3::X * 0.5).length() < 1e-9, "{at}");
    }
}

#[test]
fn unequal_cylinders_cross_in_traced_curves() {
    let found = curves(|b| {
        let first = cylinder(b, 0.5, 1.0);
        let second = cylinder(b, 0.4, 1.0);
        let second = turned(b, second, DVec3::X, 1.1);
        b.add(Node::Union(vec![first, second]))
    });
    check(&found);
    assert_eq!(kinds(&found), "CCCCTT");
}

#[test]
fn a_plane_cuts_a_cone_in_an_ellipse_and_a_torus_in_circles() {
    let found = curves(|b| {
        let cone = b.add(Node::Shape(
            Shape::frustum(1.0, 0.5, -1.0, 1.0).expect("a frustum"),
        ));
        let plane = Shape::half_space(DVec3::new(0.3, 0.1, 1.0), 0.1).expect("a half-space");
        let plane = b.add(Node::Shape(plane));
        b.add(Node::Intersection(vec![cone, plane]))
    });
    check(&found);
    assert_eq!(kinds(&found), "CE");
    let found = curves(|b| {
        let torus = b.add(Node::Shape(Shape::torus(1.0, 0.3).expect("a torus")));
        let torus = turned(b, torus, TILT, 1.0);
        let along = TILT.normalize().any_orthonormal_vector();
        let plane = b.add(Node::Shape(
            Shape::half_space(along, 0.0).expect("a half-space"),
        ));
        b.add(Node::Intersection(vec![torus, plane]))
    });
    check(&found);
    assert!(kinds(&found).chars().all(|kind| kind == 'T' || kind == 'C'));
}

#[test]
fn corners_of_a_tilted_box_lie_where_three_planes_meet() {
    let turn = Transform::rotation(TILT, 0.7).expect("a rotation");
    let found = curves(|b| {
        let part = Shape::block(DVec3::splat(-0.5), DVec3::splat(0.5)).expect("a box");
        let part = b.add(Node::Shape(part));
        turned(b, part, TILT, 0.7)
    });
    check(&found);
    assert_eq!(kinds(&found), "L".repeat(12));
    let inverse = turn.inverse();
    for &key in &found.groups.vertices {
        let at = inverse.apply(found.curves.vertices[key]).expect("affine");
        assert!((at.abs() - DVec3::splat(0.5)).length() < 1e-14, "{at}");
    }
}

#[test]
fn a_cylinder_that_touches_a_box_has_tangent_lines() {
    // A slot: the box's sides continue in the cylinder.
    let all = from_all_meshes(|b| {
        let part = Shape::block(DVec3::new(-1.0, -0.5, -0.3), DVec3::new(0.0, 0.5, 0.3));
        let part = b.add(Node::Shape(part.expect("a box")));
        let round = cylinder(b, 0.5, 0.3);
        b.add(Node::Union(vec![part, round]))
    });
    let is_upright = |edge: &&Piece| {
        let [a, b] = edge.ends;
        a.distance(b) > 0.1 && (a - b).cross(DVec3::Z).length() < 1e-9 && a.x.abs() < 1e-9
    };
    for found in &all {
        let mut sides = [0, 0];
        for edge in pieces(found).filter(is_upright) {
            assert!(matches!(edge.curve, Curve::Line { .. }), "{edge:?}");
            sides[usize::from(edge.ends[0].y > 0.0)] += 1;
        }
        assert!(sides.iter().all(|&count| count > 0), "{sides:?}");
    }
}

#[test]
fn a_rounded_cube_has_six_circles() {
    let found = curves(|b| {
        let cube = Shape::block(DVec3::splat(-1.0), DVec3::splat(1.0)).expect("a cube");
        let cube = b.add(Node::Shape(cube));
        let ball = sphere(b, 1.35);
        b.add(Node::Intersection(vec![cube, ball]))
    });
    check(&found);
    assert_eq!(kinds(&found), "CCCCCC");
}
