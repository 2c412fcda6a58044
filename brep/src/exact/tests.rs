use super::*;
use crate::curve::Curve;
use csg::{ModelBuilder, Node, NodeId, Shape, Transform};
use subdiv::{Rule, Settings};

const TOLERANCE: f64 = 0.01;

/// The same from a fine mesh and from a coarse one.
fn exact(make: impl Fn(&mut ModelBuilder) -> NodeId) -> ExactBrep {
    let fine = exact_by(&make, Rule::Tolerance(TOLERANCE));
    let coarse = exact_by(&make, Rule::Topology { finest: TOLERANCE });
    assert_eq!(counts(&fine), counts(&coarse));
    coarse
}

fn exact_by(make: impl Fn(&mut ModelBuilder) -> NodeId, rule: Rule) -> ExactBrep {
    let mut builder = ModelBuilder::new();
    let root = make(&mut builder);
    let solid = Solid::build(&builder.finish(root), None).expect("bounded");
    let settings = Settings::new(rule);
    let outcome = subdiv::convert(&solid, &settings, &()).expect("a subdivision");
    let stitched = crate::stitch(&outcome.fragments).expect("closed");
    let brep = stitched.validate().expect("valid");
    let (groups, shells) = (Groups::of(&brep), Shells::of(&brep));
    let curves = Curves::of(&brep, &groups, &solid, 1e-3);
    let exact = ExactBrep::of(&brep, &groups, &shells, &curves, &solid, TOLERANCE);
    assert_eq!(exact.broken_shells(), [0_usize; 0]);
    walk(&exact);
    exact
}

/// Loops close, twins are in other loops, and half-edges follow each other in space.
fn walk(exact: &ExactBrep) {
    for (at, face) in exact.faces.iter().enumerate() {
        for ring in &face.loops {
            for (place, &half_edge) in ring.iter().enumerate() {
                let next = ring[(place + 1) % ring.len()];
                assert_eq!(exact.next(half_edge), Some(next));
                assert_eq!(exact.face_of(half_edge), Some(at));
                assert!(exact.face_of(ExactBrep::twin(half_edge)).is_some());
                let end = exact.origin(ExactBrep::twin(half_edge));
                assert_eq!(end, exact.origin(next));
            }
        }
    }
}

fn shape(builder: &mut ModelBuilder, shape: Result<Shape, csg::Error>, at: DVec3) -> NodeId {
    let node = builder.add(Node::Shape(shape.expect("a shape")));
    let transform = Transform::translation(at).expect("a translation");
    builder.add(Node::Instance(transform, node))
}

/// (faces, living edges, loops) of the whole.
fn counts(exact: &ExactBrep) -> (usize, usize, usize) {
    let loops = || exact.faces.iter().flat_map(|face| &face.loops);
    let half_edges: usize = loops().map(Vec::len).sum();
    (exact.faces.len(), half_edges / 2, loops().count())
}

#[test]
fn a_drilled_box_has_seven_faces_and_holes_in_two_of_them() {
    let exact = exact(|b| {
        let block = Shape::block(DVec3::splat(-1.0), DVec3::splat(1.0));
        let block = shape(b, block, DVec3::ZERO);
        let drill = shape(b, Shape::cylinder(0.4, -2.0, 2.0), DVec3::ZERO);
        b.add(Node::Difference(vec![block, drill]))
    });
    assert_eq!(counts(&exact), (7, 14, 10));
    assert_eq!(exact.shells[0].genus, 1);
    for face in exact.faces.iter().filter(|face| face.loops.len() == 2) {
        // Outer loops come first: four straight edges, then the circle.
        let is_plane = face.loops.iter().any(|ring| ring.len() == 4);
        assert!(!is_plane || face.loops[0].len() == 4);
    }
}

#[test]
fn closed_surfaces_have_faces_without_loops() {
    let torus = exact(|b| shape(b, Shape::torus(1.0, 0.4), DVec3::ZERO));
    assert_eq!((counts(&torus), torus.faces[0].genus), ((1, 0, 0), 1));
    let shell = exact(|b| {
        let outer = shape(b, Shape::sphere(1.0), DVec3::ZERO);
        let inner = shape(b, Shape::sphere(0.5), DVec3::X * 0.2);
        b.add(Node::Difference(vec![outer, inner]))
    });
    assert_eq!((shell.solids.len(), shell.solids[0].voids.len()), (1, 1));
    assert_eq!(shell.shells[1].role, ShellRole::Void);
}

#[test]
fn a_slot_has_no_slivers() {
    // A box whose sides continue in a cylinder at one end: five planes, half a cylinder.
    let exact = exact(|b| {
        let block = Shape::block(DVec3::new(-1.0, -0.5, -0.3), DVec3::new(0.0, 0.5, 0.3));
        let block = shape(b, block, DVec3::ZERO);
        let round = shape(b, Shape::cylinder(0.5, -0.3, 0.3), DVec3::ZERO);
        b.add(Node::Union(vec![block, round]))
    });
    assert_eq!(counts(&exact), (6, 12, 6), "{:?}", exact.crumbs);
    let arcs = exact
        .edges
        .iter()
        .filter(|edge| matches!(edge.piece.curve, Curve::Circle { .. }));
    assert_eq!(arcs.count(), 2);
}

#[test]
fn a_dome_on_a_cylinder_hides_the_plane_between_them() {
    // The cylinder's end and the sphere meet the side in one circle: the band of the end's plane between
    // two such circles has no width.
    let exact = exact(|b| {
        let side = shape(b, Shape::cylinder(0.5, -1.0, 0.0), DVec3::ZERO);
        let dome = shape(b, Shape::sphere(0.5), DVec3::ZERO);
        b.add(Node::Union(vec![side, dome]))
    });
    assert_eq!(counts(&exact), (3, 2, 4), "{:?}", exact.crumbs);
}

#[test]
fn an_edge_that_ends_in_a_tangency_is_zipped() {
    // A rounded edge between two sharp ends: where the cylinder touches the box's sides, their
    // planes end in lines.
    let exact = exact(|b| {
        let block = Shape::block(DVec3::new(-1.0, -1.0, -1.0), DVec3::ONE);
        let block = shape(b, block, DVec3::ZERO);
        let corner = Shape::block(DVec3::new(0.6, 0.6, -2.0), DVec3::new(2.0, 2.0, 2.0));
        let corner = shape(b, corner, DVec3::ZERO);
        let round = shape(
            b,
            Shape::cylinder(0.4, -2.0, 2.0),
            DVec3::new(0.6, 0.6, 0.0),
        );
        let rest = b.add(Node::Difference(vec![corner, round]));
        b.add(Node::Difference(vec![block, rest]))
    });
    assert_eq!(counts(&exact), (7, 15, 7), "{:?}", exact.crumbs);
}
