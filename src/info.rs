//! `csg2brep info IN`: what a model consists of, before any conversion.

mod surface;
mod tree;

use crate::args::InfoArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::output;
use crate::run::Target;
use crate::summary::{counted, triple};
use crate::talk::Talk;
use csg::{FormulaNode, Model, Solid};
use serde_json::{Value, json};
use surface::Description;

/// Reads, and prints what was found on standard output.
pub(crate) fn run(args: InfoArgs, talk: Talk) -> Result<(), Failure> {
    let input = Input::new(args.input);
    let (solid, loaded) = input.solid(&args.clip, args.dialect, talk)?;
    let model = &loaded.model;
    let text = if args.json {
        let json = serde_json::to_string_pretty(&to_json(&solid, &input.name(), model));
        json.map_err(|error| Failure::Bug(error.to_string()))? + "\n"
    } else {
        to_text(&solid, &input.name(), model)
    };
    output::write_bytes(&Target::Stdout, text.as_bytes())
}

fn literal_count(solid: &Solid) -> usize {
    let nodes = solid.formula.nodes().iter();
    let literals = nodes.filter(|node| matches!(node, FormulaNode::Literal(_)));
    literals.count()
}

fn to_text(solid: &Solid, name: &str, model: &Model) -> String {
    let mut lines = vec![format!(
        "{name}: {}, {}, {}",
        counted(model.nodes().len() as u64, "node"),
        counted(literal_count(solid) as u64, "half-space"),
        counted(solid.primitives.len() as u64, "surface")
    )];
    if solid.primitives.is_empty() {
        lines.push("the solid is empty".to_owned());
        return lines.join("\n") + "\n";
    }
    let size = solid.extent.diagonal();
    let [min, max] = [solid.extent.min, solid.extent.max].map(|corner| triple(corner, size));
    let clipped = if solid.clipped { ", clipped" } else { "" };
    lines.push(format!("box: {min} to {max}{clipped}"));
    lines.extend(tree::to_text(model));
    lines.push("surfaces:".to_owned());
    for (at, primitive) in solid.primitives.iter().enumerate() {
        let surface = Description::of(primitive.surface(&solid.domain));
        lines.push(format!("  {at}: {}", surface.to_text(size)));
    }
    lines.join("\n") + "\n"
}

fn to_json(solid: &Solid, name: &str, model: &Model) -> Value {
    let surfaces = solid.primitives.iter().map(|primitive| {
        let mut value = Description::of(primitive.surface(&solid.domain)).to_json();
        value["degree"] = json!(primitive.polynomial.degree());
        value
    });
    let surfaces: Vec<Value> = surfaces.collect();
    let extent = (!solid.primitives.is_empty())
        .then(|| [solid.extent.min.to_array(), solid.extent.max.to_array()]);
    json!({
        "schema_version": 1,
        "name": name,
        "nodes": model.nodes().len(),
        "tree": tree::to_json(model),
        "half_spaces": literal_count(solid),
        "box": extent,
        "clipped": solid.clipped,
        "materials": solid.materials.len(),
        "surfaces": surfaces,
    })
}
