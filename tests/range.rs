//! What lies at the ends of the range: tiny and huge coordinates, large offsets, deep nesting,
//! surfaces that are almost equal.

mod stages;

use csg::{Axis, Error, Model, ModelBuilder, Node, NodeId, Polynomial, Shape, Solid, Transform};
use glam::DVec3;
use stages::{Converted, convert, convert_model, read};
use std::f64::consts::PI;
use subdiv::Rule;

/// A cube of side 2 without a ball of radius 1.2 and with a cylinder through it.
const DEMO: &str = "union() {
    difference() { cube(2, center=true); sphere(r=1.2); }
    cylinder(r=0.25, h=3, center=true);
}";

fn moved(matrix: &str) -> String {
    format!("multmatrix({matrix}) {{ {DEMO} }}")
}

/// The same topology as the model of ordinary size, and its volume scaled.
fn is_demo(converted: &Converted, scale: f64, tolerance: f64) {
    let plain = convert(DEMO, 0.01);
    assert_eq!(converted.shells.genus(), plain.shells.genus());
    assert_eq!(converted.shells.shells.len(), plain.shells.shells.len());
    let volume = converted.properties.volume / scale.powi(3);
    let difference = (volume - plain.properties.volume).abs();
    // Both within the tolerance of the true boundary, most of which is flat.
    assert!(difference <= 2.0 * 20.0 * tolerance, "{difference}");
}

#[test]
fn coordinates_from_a_millionth_to_a_million() {
    for scale in [1e-6, 1e-3, 1e3, 1e6] {
        let source = moved(&format!(
            "[[{scale},0,0,0],[0,{scale},0,0],[0,0,{scale},0],[0,0,0,1]]"
        ));
        is_demo(&convert(&source, 0.01 * scale), scale, 0.01);
    }
}

/// A million sizes away, positions keep ten digits of sixteen.
#[test]
fn offsets_of_a_million_sizes() {
    for scale in [1e-3, 1.0, 1e3] {
        let [x, y, z] = [1e6, -2e6, 1.5e6].map(|at| at * scale);
        let source = moved(&format!(
            "[[{scale},0,0,{x}],[0,{scale},0,{y}],[0,0,{scale},{z}],[0,0,0,1]]"
        ));
        let found = convert(&source, 0.01 * scale);
        is_demo(&found, scale, 0.01);
        let off = found.properties.centroid - DVec3::new(x, y, z);
        assert!(off.length() < 0.02 * scale, "{off}");
    }
}

fn instance(model: &mut ModelBuilder, node: NodeId, x: f64) -> NodeId {
    let at = Transform::translation(DVec3::new(x, 0.0, 0.0)).expect("finite");
    model.add(Node::Instance(at, node))
}

/// B₁ − (B₂ − (B₃ − …)) of 2,500 slabs: slab n spans [n, 5000 − n], so that every second gap is
/// filled and the rest is air.
fn nested_slabs(levels: u32) -> Model {
    let mut model = ModelBuilder::new();
    let slab = |model: &mut ModelBuilder, n: u32| {
        let (low, high) = (f64::from(n), f64::from(2 * levels - n));
        let block = Shape::block(DVec3::new(low, 0.0, 0.0), DVec3::new(high, 50.0, 50.0));
        model.add(Node::Shape(block.expect("a block")))
    };
    let mut inner = slab(&mut model, levels - 1);
    for n in (0..levels - 1).rev() {
        let outer = slab(&mut model, n);
        inner = model.add(Node::Difference(vec![outer, inner]));
    }
    model.finish(inner)
}

#[test]
fn nesting_of_2500_levels() {
    let levels = 2500;
    let found = convert_model(&nested_slabs(levels), Rule::Tolerance(10.0));
    // Slabs [n, n + 1] for even n on both sides; the innermost is 2 thick or air.
    assert_eq!(found.shells.solids.len(), 2500);
    assert_eq!(found.shells.genus(), 0);
    let exact = 2500.0 * 2500.0;
    assert!(
        (found.properties.volume - exact).abs() < 1e-6 * exact,
        "{}",
        found.properties.volume
    );
}

/// Two thousand nested placements, each by a step.
#[test]
fn two_thousand_placements_in_each_other() {
    let mut model = ModelBuilder::new();
    let mut node = model.add(Node::Shape(Shape::sphere(1.0).expect("a ball")));
    for _ in 0..2000 {
        node = instance(&mut model, node, 0.5);
    }
    let found = convert_model(&model.finish(node), Rule::Tolerance(0.01));
    assert!((found.properties.centroid - DVec3::new(1000.0, 0.0, 0.0)).length() < 1e-3);
    assert!((found.properties.volume - 4.0 / 3.0 * PI).abs() < 1.05 * 4.0 * PI * 0.01);
}

/// Planes and balls that differ by 1e-8 of the size are two, are listed, and stay manifold.
#[test]
fn almost_equal_surfaces_are_listed_and_manifold() {
    let shift = |by: f64, what: &str| {
        format!("multmatrix([[1,0,0,{by}],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {what}")
    };
    for what in [
        "cube(1);",
        "sphere(r=1);",
        "cylinder(r=1, h=2);",
        "torus(r1=2, r2=0.5);",
    ] {
        for operation in ["union", "difference", "intersection"] {
            let source = format!("{operation}() {{ {what} {} }}", shift(1e-8, what));
            let found = convert(&source, 0.05);
            assert!(!found.solid.nearly_equal.is_empty(), "{source}");
        }
        // A thousand times less is one surface to this program.
        let source = format!("difference() {{ {what} {} }}", shift(1e-13, what));
        let found = convert(&source, 0.05);
        assert!(found.solid.nearly_equal.is_empty(), "{source}");
        assert!(found.brep.is_empty(), "{source}");
    }
}

/// xⁿ + yⁿ + zⁿ ≤ 1 has volume 8 Γ(1 + 1/n)³/Γ(1 + 3/n). At a fixed level no tolerance bounds the
/// difference, but the volume's interval holds.
#[test]
fn superballs_up_to_degree_32() {
    for (n, exact) in [(16, 7.863_500_266_128), (32, 7.963_727_103_878)] {
        let model = read(&format!("polynomial(\"x^{n}+y^{n}+z^{n}-1\");"));
        let solid = Solid::build(&model, None).expect("a bounded solid");
        // Whatever the degree, the box is found to a half of its size.
        assert!(
            solid.extent.max.max_element() < 1.55,
            "{n}: {:?}",
            solid.extent
        );
        let found = convert_model(&model, Rule::Level(9));
        assert_eq!(found.shells.shells.len(), 1, "{n}");
        assert_eq!(found.shells.genus(), 0, "{n}");
        let [low, high] = found.report.volume_interval.expect("an interval");
        assert!(low <= exact && exact <= high, "{n}: {low} {high}");
        let volume = found.properties.volume;
        assert!((volume - exact).abs() < 0.03 * exact, "{n}: {volume}");
    }
}

/// The Chebyshev polynomial of the first kind.
fn chebyshev(degree: usize, axis: Axis) -> Polynomial {
    let t = Polynomial::variable(axis);
    let mut last = Polynomial::constant(1.0).expect("finite");
    let mut this = t.clone();
    for _ in 1..degree {
        let twice = t
            .product(&this)
            .and_then(|p| p.scaled(2.0))
            .expect("finite");
        (last, this) = (this.clone(), twice.difference(&last).expect("finite"));
    }
    this
}

/// Chmutov's surfaces Tₙ(x) + Tₙ(y) + Tₙ(z) = 0 in a cube: Tₙ is at most 1 there, its coefficients
/// sum up to (1 + √2)ⁿ/2, so n·0.38 digits are lost. That is said, and no surface is made up.
#[test]
fn lost_digits_are_announced() {
    let build = |n: usize| {
        let [x, y, z] = [Axis::X, Axis::Y, Axis::Z].map(|axis| chebyshev(n, axis));
        let sum = x.sum(&y).and_then(|p| p.sum(&z)).expect("finite");
        let mut model = ModelBuilder::new();
        let chmutov = model.add(Node::Shape(Shape::Polynomial(sum)));
        let cube = Shape::block(DVec3::NEG_ONE, DVec3::ONE).expect("a block");
        let cube = model.add(Node::Shape(cube));
        let both = model.add(Node::Intersection(vec![chmutov, cube]));
        Solid::build(&model.finish(both), None)
    };
    assert!(build(8).expect("a solid").imprecise.is_empty());
    let few = build(24).expect("a solid").imprecise;
    assert_eq!(few.len(), 1);
    // 2.414²⁴/2 = 8e8 times some hundred roundings; less a few digits of the sums' slack.
    assert!((1e-7..1e-2).contains(&few[0].uncertainty), "{few:?}");
    assert!(matches!(
        build(64),
        Err(Error::NoDigitsLeft { degree: 64, .. })
    ));
}
