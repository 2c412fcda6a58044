//! The counts of the thesis' chapter 6 against today's, and its projective instances.
//!
//! The three solids are reconstructions (`fixtures/thesis/README.md`): their own counts cannot be
//! compared, but ratios and trends can. All tables: `cargo bench --bench thesis`.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use csg::{Model, ModelBuilder, Node, Shape, Solid, Transform};
use glam::DVec3;
use std::f64::consts::PI;
use subdiv::methods::{Adaptive, Halt, adaptive};
use subdiv::{Criterion, Rule};

fn solid(name: &str) -> Solid {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/thesis");
    let source = std::fs::read_to_string(format!("{folder}/{name}.csg")).unwrap();
    Solid::build(&stages::read(&source), None).unwrap()
}

/// Polynomial values a primitive that bounds the solid in a minimal simplex.
fn per_optimum(run: &Adaptive) -> f64 {
    run.evaluations as f64 / run.found.optimal_evaluations as f64
}

/// Table 6.4: no row takes more values for each one needed than the thesis' SSA; for disjoint
/// spheres that holds for classifications as well.
#[test]
fn spheres_take_no_more_than_in_table_6_4() {
    let rows = [
        (1, 4.70),
        (2, 4.44),
        (4, 4.25),
        (8, 4.14),
        (16, 4.07),
        (32, 4.02),
        (64, 3.98),
        (128, 4.96),
    ];
    for (count, then) in rows {
        let solid = solid(&format!("spheres_{count:03}"));
        let run = adaptive(&solid, Criterion::Rivlin, 18, Halt::Never);
        assert!(per_optimum(&run) <= then, "{count} spheres: {run:?}");
        if count <= 64 {
            let best = run.found.optimal_evaluations as f64;
            let classified = run.classifications as f64 / best;
            assert!(classified <= then, "{count} spheres: {classified}");
        }
    }
}

/// Table 6.3: the ratio falls with the level, below 2 at the deepest one, and is below the thesis'
/// at each.
#[test]
fn ratio_falls_towards_two_as_in_table_6_3() {
    let solid = solid("chupeta");
    let mut before = f64::INFINITY;
    for (level, then) in [(9, 4.82), (12, 4.61), (15, 4.13), (18, 3.92), (21, 3.67)] {
        let run = adaptive(&solid, Criterion::Rivlin, level, Halt::AtPlanes);
        let now = per_optimum(&run);
        assert!(now < before && now < then, "level {level}: {now}");
        before = now;
    }
    assert!(before < 2.0, "{before}");
}

/// Tables 6.7 and 6.8.
#[test]
fn rivlin_bisects_less_in_vain_than_bezier() {
    for name in ["manchete", "atomo", "chupeta"] {
        let solid = solid(name);
        let [bezier, rivlin] = [Criterion::Bezier, Criterion::Rivlin]
            .map(|criterion| adaptive(&solid, criterion, 15, Halt::AtPlanes));
        assert!(rivlin.wrongly_bisected < bezier.wrongly_bisected, "{name}");
        assert!(rivlin.classifications < bezier.classifications, "{name}");
        assert!(rivlin.simplices < bezier.simplices, "{name}");
    }
}

/// A shape moved by a matrix for column vectors.
fn instance(shape: Shape, matrix: &[[f64; 4]; 4]) -> Model {
    let mut builder = ModelBuilder::new();
    let shape = builder.add(Node::Shape(shape));
    let transform = Transform::from_columns(matrix).unwrap();
    let root = builder.add(Node::Instance(transform, shape));
    builder.finish(root)
}

/// Notes 10.2.5: p/(1 + x/2) takes the unit sphere to an ellipsoid with semi-axes 1/(1−¼) and
/// twice 1/√(1−¼).
#[test]
fn projective_image_of_a_ball_is_an_ellipsoid() {
    let matrix = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.5, 0.0, 0.0, 1.0],
    ];
    let model = instance(Shape::sphere(1.0).unwrap(), &matrix);
    let converted = stages::convert_model(&model, Rule::Tolerance(1e-3));
    let axis = 1.0 / 0.75;
    let exact = 4.0 / 3.0 * PI * axis * axis;
    let area_at_most = 4.0 * PI * axis * axis;
    let off = (converted.properties.volume - exact).abs();
    assert!(off < 1e-3 * area_at_most, "{off}");
}

/// p/(1 + z/2) takes a cube to the frustum of a pyramid: squares of sides 4 and 4/3, 8/3 apart.
#[test]
fn projective_image_of_a_cube_is_a_frustum() {
    let matrix = [
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.5, 1.0],
    ];
    let cube = Shape::block(DVec3::NEG_ONE, DVec3::ONE).unwrap();
    let converted = stages::convert_model(&instance(cube, &matrix), Rule::Tolerance(1e-2));
    let exact = 8.0 / 9.0 * (16.0 + 16.0 / 9.0 + 16.0 / 3.0);
    let volume = converted.properties.volume;
    assert!((volume - exact).abs() < 1e-9 * exact, "{volume} {exact}");
}
