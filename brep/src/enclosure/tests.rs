//! Meshes that are near a boundary, and such as are not: each part of the proof must fail when what
//! it is about is spoiled.

use super::*;
use crate::simplify::remove_degenerate;
use crate::stitch::stitch;
use csg::{ModelBuilder, Node, Shape, Transform};
use subdiv::{Fragments, Rule, Settings};

/// Balls, each with its middle's x and its radius; those after the first are added, or cut out.
fn balls(of: &[(f64, f64)], are_cut: bool) -> Solid {
    let mut model = ModelBuilder::new();
    let nodes: Vec<_> = of
        .iter()
        .map(|&(x, radius)| {
            let shape = Shape::sphere(radius).expect("a ball");
            let child = model.add(Node::Shape(shape));
            let to = Transform::translation(DVec3::new(x, 0.0, 0.0)).expect("finite");
            model.add(Node::Instance(to, child))
        })
        .collect();
    let root = model.add(if are_cut {
        Node::Difference(nodes)
    } else {
        Node::Union(nodes)
    });
    Solid::build(&model.finish(root), None).expect("bounded")
}

fn fragments(solid: &Solid, level: u8) -> Fragments {
    let settings = Settings {
        threads: Some(1),
        ..Settings::new(Rule::Level(level))
    };
    let outcome = subdiv::convert(solid, &settings, &());
    outcome.expect("small").fragments
}

fn valid(fragments: &Fragments) -> Valid<Brep> {
    let brep = stitch(fragments).expect("closed");
    remove_degenerate(brep.validate().expect("a manifold"))
        .expect("a manifold")
        .0
}

/// How far the facets' middles are from the nearest of these spheres.
fn measured(brep: &Brep, of: &[(f64, f64)]) -> f64 {
    let off = |at: DVec3| {
        let distances = of
            .iter()
            .map(|&(x, r)| (at.distance(DVec3::new(x, 0.0, 0.0)) - r).abs());
        distances.fold(f64::INFINITY, f64::min)
    };
    let middles = brep.facets().map(|facet| {
        let [a, b, c] = facet.vertices().map(VertexView::position);
        off((a + b + c) / 3.0)
    });
    middles.fold(0.0, f64::max)
}

#[test]
fn a_ball_is_enclosed_about_as_closely_as_it_is_measured() {
    let of = [(0.0, 1.0)];
    let solid = balls(&of, false);
    for level in [9, 12, 15] {
        let brep = valid(&fragments(&solid, level));
        let found = enclose(&brep, &solid, Some(1), 1.0).expect("a ball");
        let measured = measured(&brep, &of);
        assert!(found.is_both_ways);
        assert!(measured <= found.distance, "{measured} {}", found.distance);
        assert!(
            found.distance <= 1.5 * measured,
            "{measured} {}",
            found.distance
        );
        // It is no more than is allowed, or it is none.
        assert!(enclose(&brep, &solid, Some(1), 0.9 * measured).is_err());
    }
}

#[test]
fn cavities_and_other_components_are_enclosed_together() {
    for (of, are_cut) in [
        (vec![(0.0, 1.0), (0.1, 0.5)], true),
        (vec![(0.0, 1.0), (2.5, 1.0), (5.0, 0.7)], false),
    ] {
        let solid = balls(&of, are_cut);
        let brep = valid(&fragments(&solid, 15));
        let found = enclose(&brep, &solid, Some(of.len()), 0.5).expect("balls");
        assert!(found.is_both_ways);
        assert!(measured(&brep, &of) <= found.distance);
    }
}

#[test]
fn what_lacks_a_component_is_proved_one_way_only() {
    let solid = balls(&[(0.0, 1.0), (2.5, 1.0)], false);
    let mut all = fragments(&solid, 12);
    let positions = all.positions.clone();
    let is_first = |v: u32| positions[v as usize].x < 1.25;
    all.triangles
        .retain(|triangle| is_first(triangle.vertices[0]));
    let brep = valid(&all);
    let found = enclose(&brep, &solid, Some(2), 0.5).expect("a ball");
    assert!(!found.is_both_ways);
}

/// Two components, and as many are expected, but both are of one and the same ball.
#[test]
fn one_component_in_place_of_another_is_noticed() {
    let solid = balls(&[(0.0, 1.0), (2.5, 1.0)], false);
    let mut all = fragments(&solid, 12);
    let positions = all.positions.clone();
    let is_first = |v: u32| positions[v as usize].x < 1.25;
    all.triangles
        .retain(|triangle| is_first(triangle.vertices[0]));
    let count = u32::try_from(positions.len()).expect("few");
    let again: Vec<_> = (all.triangles.iter())
        .map(|triangle| subdiv::Triangle {
            vertices: triangle.vertices.map(|v| v + count),
            ..*triangle
        })
        .collect();
    all.triangles.extend(again);
    // A little larger, so that one is in the other.
    all.positions
        .extend(positions.iter().map(|&at| at * 1.0001));
    all.kinds.extend_from_within(..);
    let brep = valid(&all);
    let found = enclose(&brep, &solid, Some(2), 0.5).expect("a ball, twice");
    assert!(!found.is_both_ways);
}

#[test]
fn a_vertex_in_the_wrong_place_is_counted() {
    let solid = balls(&[(0.0, 1.0)], false);
    let mut spoiled = fragments(&solid, 15);
    let vertex = spoiled.triangles[7].vertices[0] as usize;
    spoiled.positions[vertex] *= 1.05;
    let brep = valid(&spoiled);
    let found = enclose(&brep, &solid, Some(1), 0.5).expect("near");
    assert!(found.distance >= 0.05, "{}", found.distance);
    match enclose(&brep, &solid, Some(1), 0.04) {
        Ok(found) => panic!("within {}", found.distance),
        Err(open) => assert!(!open.facets.is_empty()),
    }
}

#[test]
fn a_mesh_inside_out_is_not_enclosed() {
    let solid = balls(&[(0.0, 1.0)], false);
    let mut turned = fragments(&solid, 12);
    for triangle in &mut turned.triangles {
        triangle.vertices.swap(0, 1);
        triangle.sense = triangle.sense.complement();
    }
    assert!(enclose(&valid(&turned), &solid, Some(1), 0.5).is_err());
}
