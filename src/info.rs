//! `csg2brep info IN`: what a model consists of, before any conversion.

use crate::args::InfoArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::output;
use crate::run::{Target, clip_box};
use crate::summary::{counted, number, triple};
use crate::talk::Talk;
use csg::{FormulaNode, QuadricKind, Solid, Surface};
use glam::DVec3;
use io::read::ReadOptions;
use serde_json::{Value, json};

/// Reads, and prints what was found on standard output.
pub(crate) fn run(args: InfoArgs, talk: Talk) -> Result<(), Failure> {
    let input = Input::new(args.input);
    let clip = args.clip.as_deref().map(clip_box).transpose()?;
    let loaded = input.load(None, ReadOptions::default())?;
    for warning in &loaded.warnings {
        talk.warn_about(warning, &loaded.source);
    }
    let solid = Solid::build(&loaded.model, clip);
    let solid = solid.map_err(|error| Failure::from(error).of_input(&input.name()))?;
    let text = if args.json {
        let value = to_json(&solid, &input.name(), loaded.model.nodes().len());
        let json = serde_json::to_string_pretty(&value);
        json.map_err(|error| Failure::Bug(error.to_string()))? + "\n"
    } else {
        to_text(&solid, &input.name(), loaded.model.nodes().len())
    };
    output::write_bytes(&Target::Stdout, text.as_bytes())
}

fn literal_count(solid: &Solid) -> usize {
    let nodes = solid.formula.nodes().iter();
    let literals = nodes.filter(|node| matches!(node, FormulaNode::Literal(_)));
    literals.count()
}

fn to_text(solid: &Solid, name: &str, nodes: usize) -> String {
    let mut lines = vec![format!(
        "{name}: {}, {}, {}",
        counted(nodes as u64, "node"),
        counted(literal_count(solid) as u64, "half-space"),
        counted(solid.primitives.len() as u64, "surface")
    )];
    if solid.primitives.is_empty() {
        lines.push("the solid is empty".to_owned());
        return lines.join("\n") + "\n";
    }
    let write = Numbers {
        size: solid.extent.diagonal(),
    };
    let [min, max] = [solid.extent.min, solid.extent.max].map(|corner| write.point(corner));
    let clipped = if solid.clipped { ", clipped" } else { "" };
    lines.push(format!("box: {min} to {max}{clipped}"));
    for (at, primitive) in solid.primitives.iter().enumerate() {
        lines.push(format!(
            "{at}: {}",
            write.surface(primitive.surface(&solid.domain))
        ));
    }
    lines.join("\n") + "\n"
}

/// Numbers for reading, of a model of this size.
struct Numbers {
    size: f64,
}

impl Numbers {
    fn length(&self, value: f64) -> String {
        number(value, self.size)
    }

    fn point(&self, point: DVec3) -> String {
        triple(point, self.size)
    }

    fn surface(&self, surface: Surface) -> String {
        let kind = kind(surface);
        let direction = |vector| triple(vector, 1.0);
        match surface {
            Surface::Plane { normal, offset } => {
                let offset = self.length(offset);
                format!("{kind}, normal {}, offset {offset}", direction(normal))
            }
            Surface::Sphere { center, radius } => {
                let (center, radius) = (self.point(center), self.length(radius));
                format!("{kind}, centre {center}, radius {radius}")
            }
            Surface::Cylinder {
                point,
                axis,
                radius,
            } => {
                let (point, radius) = (self.point(point), self.length(radius));
                format!(
                    "{kind}, axis {} through {point}, radius {radius}",
                    direction(axis)
                )
            }
            Surface::Cone {
                apex,
                axis,
                half_angle_rad,
            } => {
                let (apex, angle) = (self.point(apex), half_angle_rad.to_degrees());
                let angle = number(angle, 1.0);
                format!(
                    "{kind}, axis {} from apex {apex}, half-angle {angle}°",
                    direction(axis)
                )
            }
            Surface::Torus {
                center,
                axis,
                ring,
                tube,
            } => {
                let (center, axis) = (self.point(center), direction(axis));
                let (ring, tube) = (self.length(ring), self.length(tube));
                format!("{kind}, axis {axis}, centre {center}, radii {ring} and {tube}")
            }
            Surface::Algebraic { degree } => format!("{kind}, degree {degree}"),
            _ => kind.to_owned(),
        }
    }
}

fn to_json(solid: &Solid, name: &str, nodes: usize) -> Value {
    let surfaces = solid.primitives.iter().map(|primitive| {
        let mut value = parameters(primitive.surface(&solid.domain));
        value["degree"] = json!(primitive.polynomial.degree());
        value
    });
    let surfaces: Vec<Value> = surfaces.collect();
    let extent = (!solid.primitives.is_empty())
        .then(|| [solid.extent.min.to_array(), solid.extent.max.to_array()]);
    json!({
        "schema_version": 1,
        "name": name,
        "nodes": nodes,
        "half_spaces": literal_count(solid),
        "box": extent,
        "clipped": solid.clipped,
        "materials": solid.materials.len(),
        "surfaces": surfaces,
    })
}

fn parameters(surface: Surface) -> Value {
    let kind = kind(surface);
    match surface {
        Surface::Plane { normal, offset } => {
            json!({ "kind": kind, "normal": normal.to_array(), "offset": offset })
        }
        Surface::Sphere { center, radius } => {
            json!({ "kind": kind, "center": center.to_array(), "radius": radius })
        }
        Surface::Cylinder {
            point,
            axis,
            radius,
        } => json!({
            "kind": kind, "point": point.to_array(), "axis": axis.to_array(), "radius": radius,
        }),
        Surface::Cone {
            apex,
            axis,
            half_angle_rad,
        } => json!({
            "kind": kind, "apex": apex.to_array(), "axis": axis.to_array(),
            "half_angle_rad": half_angle_rad,
        }),
        Surface::Torus {
            center,
            axis,
            ring,
            tube,
        } => json!({
            "kind": kind, "center": center.to_array(), "axis": axis.to_array(),
            "ring": ring, "tube": tube,
        }),
        _ => json!({ "kind": kind }),
    }
}

fn kind(surface: Surface) -> &'static str {
    match surface {
        Surface::Plane { .. } => "plane",
        Surface::Sphere { .. } => "sphere",
        Surface::Cylinder { .. } => "cylinder",
        Surface::Cone { .. } => "cone",
        Surface::Torus { .. } => "torus",
        Surface::Quadric(kind) => match kind {
            QuadricKind::Ellipsoid => "ellipsoid",
            QuadricKind::EllipticCylinder => "elliptic cylinder",
            QuadricKind::EllipticCone => "elliptic cone",
            QuadricKind::HyperbolicCylinder => "hyperbolic cylinder",
            QuadricKind::ParabolicCylinder => "parabolic cylinder",
            QuadricKind::EllipticParaboloid => "elliptic paraboloid",
            QuadricKind::HyperbolicParaboloid => "hyperbolic paraboloid",
            QuadricKind::HyperboloidOfOneSheet => "hyperboloid of one sheet",
            QuadricKind::HyperboloidOfTwoSheets => "hyperboloid of two sheets",
            QuadricKind::CrossingPlanes => "crossing planes",
            QuadricKind::ParallelPlanes => "parallel planes",
            QuadricKind::DoublePlane => "double plane",
            QuadricKind::Line => "line",
            QuadricKind::Point => "point",
            QuadricKind::Imaginary => "imaginary quadric",
        },
        Surface::Algebraic { .. } => "algebraic surface",
        _ => "constant",
    }
}
