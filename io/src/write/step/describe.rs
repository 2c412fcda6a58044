//! What a solid's faces and edges are in STEP's terms.

use super::{Plan, surface};
use brep::{Curve, ExactFace};
use glam::DVec3;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use step_io::build::{CurveInput, Frame};
use step_io::scene::NurbsCurve;

/// A solid before it is written.
#[derive(Default)]
pub(super) struct Described {
    pub(super) shells: Vec<Vec<(surface::Described, ExactFace)>>,
    pub(super) curves: BTreeMap<usize, CurveInput>,
}

/// Distance between curves, relative to the solid, that other programs take for none.
const TOUCHING: f64 = 1e-6;

impl Plan<'_> {
    /// Geometry of all faces and edges of a solid, or why it has no true form.
    pub(super) fn describe(&self, shells: &[usize]) -> Result<Described, String> {
        let broken = self.exact.broken_shells();
        if shells.iter().any(|shell| broken.contains(shell)) {
            return Err("its faces touch themselves".to_owned());
        }
        let mut described = Described::default();
        for &shell in shells {
            let mut faces = Vec::new();
            for &face in &self.exact.shells[shell].faces {
                let face = &self.exact.faces[face];
                let surface = surface::describe(self.topology, self.solid, &self.exact, face)?;
                if face.loops.is_empty() && !surface.is_closed() {
                    let id = face.primitive.0;
                    return Err(format!("a face of surface {id} has lost its edges"));
                }
                if face.is_pinched {
                    let id = face.primitive.0;
                    return Err(format!("a face of surface {id} touches itself in a point"));
                }
                if self
                    .exact
                    .is_folded(face, TOUCHING * self.solid.extent.diagonal())
                {
                    let id = face.primitive.0;
                    return Err(format!(
                        "a face of surface {id} touches itself along an edge"
                    ));
                }
                faces.push((surface, face.clone()));
                for &half_edge in face.loops.iter().flatten() {
                    let edge = half_edge / 2;
                    if let Entry::Vacant(entry) = described.curves.entry(edge) {
                        entry.insert(self.curve(edge)?);
                    }
                }
            }
            described.shells.push(faces);
        }
        Ok(described)
    }

    fn curve(&self, edge: usize) -> Result<CurveInput, String> {
        let edge = &self.exact.edges[edge];
        let scale = self.options.millimetres_per_unit;
        let frame = |center: DVec3, across: [DVec3; 2]| Frame {
            origin: point(center, scale),
            axis: across[0].cross(across[1]).normalize_or_zero().to_array(),
            ref_dir: across[0].normalize_or_zero().to_array(),
        };
        Ok(match edge.piece.curve {
            Curve::Line { direction, .. } => CurveInput::LineAlong(direction.to_array()),
            Curve::Circle { center, across } => {
                CurveInput::Circle(frame(center, across), across[0].length() * scale)
            }
            Curve::Ellipse { center, across } => {
                let [a, b] = across.map(|axis| axis.length() * scale);
                CurveInput::Ellipse(frame(center, across), a, b)
            }
            Curve::Traced { .. } => {
                let spline =
                    edge.piece
                        .spline(self.solid, &edge.primitives, self.options.tolerance);
                let spline = spline.ok_or_else(|| {
                    let ids: Vec<String> =
                        edge.primitives.iter().map(|id| id.0.to_string()).collect();
                    let ids = ids.join(" and ");
                    format!("an edge of surfaces {ids} was not traced to the tolerance")
                })?;
                CurveInput::Nurbs(NurbsCurve {
                    degree: 3,
                    weights: vec![1.0; spline.points.len()],
                    control_points: spline.points.iter().map(|&p| point(p, scale)).collect(),
                    knots: spline.knots,
                })
            }
        })
    }
}

/// A point in millimetres. Adding zero turns −0 into 0.
pub(super) fn point(point: DVec3, scale: f64) -> [f64; 3] {
    (point * scale + DVec3::ZERO).to_array()
}
