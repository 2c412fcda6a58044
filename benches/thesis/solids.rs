//! The solids of the thesis, each in a box of a chosen size.

use csg::{DomainFit, Formula, FormulaNode, Model, Solid};
use glam::DVec3;
use std::path::Path;

/// The three of Figure 6.1.
pub(crate) const THREE: [&str; 3] = ["manchete", "atomo", "chupeta"];

fn model(name: &str) -> Model {
    read_fixture(&format!("thesis/{name}"))
}

/// A model in `fixtures/`, named without its extension.
pub(crate) fn read_fixture(name: &str) -> Model {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let source = std::fs::read_to_string(folder.join(format!("{name}.csg")));
    let source = source.expect("a fixture");
    let options = io::read::ReadOptions::default();
    let reading = io::read::scad_csg::read(&source, name, &options);
    reading.expect("a readable fixture").model
}

/// In the usual box.
pub(crate) fn load(name: &str) -> Solid {
    load_in(name, 1.0)
}

/// In a box so many times as wide as the usual one.
pub(crate) fn load_in(name: &str, times: f64) -> Solid {
    let shift = DVec3::new(0.009_173_1, -0.012_951_7, 0.006_837_9);
    let fit = DomainFit::new(1.073_618_3 * times, shift).expect("room");
    Solid::build_fitted(&model(name), None, fit).expect("a bounded fixture")
}

/// The first spheres of the 64, in the box of all of them; 128 have their own, since they are a
/// ring.
pub(crate) fn spheres(count: usize) -> Solid {
    if count > 64 {
        return load(&format!("spheres_{count:03}"));
    }
    let mut solid = load("spheres_064");
    let literals = solid.formula.nodes().iter().copied();
    let literals = literals.filter(|node| matches!(node, FormulaNode::Literal(_)));
    let mut nodes: Vec<FormulaNode> = literals.take(count).collect();
    solid.primitives.truncate(count);
    if count > 1 {
        let len = u32::try_from(count).expect("at most 64");
        nodes.insert(0, FormulaNode::Union { len });
    }
    solid.formula = Formula::new(nodes).expect("a union of literals");
    solid
}
