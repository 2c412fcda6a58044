//! What a solid's faces and edges are in STEP's terms.

use super::{Plan, surface};
use brep::{Brep, Curve, ExactFace, Valid};
use glam::DVec3;
use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use step_io::build::{CurveInput, Frame};
use step_io::scene::NurbsCurve;

/// A solid before it is written.
#[derive(Default)]
pub(super) struct Described {
    pub(super) shells: Vec<Vec<(surface::Described, ExactFace)>>,
    pub(super) curves: BTreeMap<usize, CurveInput>,
    /// Edges that are written as arcs.
    pub(super) split: BTreeSet<usize>,
    /// Parameters at which edges are cut in two, since a closed surface is cut open there.
    pub(super) stops: BTreeMap<usize, Vec<f64>>,
}

/// Why a solid has no true form.
pub(super) struct NoForm {
    pub(super) reason: String,
    /// Whether a finer subdivision may have one: not for want of an entity in STEP, but since
    /// faces or edges were not told apart.
    pub(super) is_unresolved: bool,
}

impl NoForm {
    /// STEP has no entity for a surface.
    pub(super) fn of_surface(reason: String) -> Self {
        Self {
            reason,
            is_unresolved: false,
        }
    }

    fn unresolved(reason: String) -> Self {
        Self {
            reason,
            is_unresolved: true,
        }
    }
}

/// Distance between curves, relative to the solid, that other programs take for none.
const TOUCHING: f64 = 1e-6;

impl Plan<'_> {
    /// Geometry of all faces and edges of a solid, or why it has no true form.
    pub(super) fn describe(
        &self,
        topology: &Valid<Brep>,
        shells: &[usize],
    ) -> Result<Described, NoForm> {
        let broken = self.exact.broken_shells();
        if shells.iter().any(|shell| broken.contains(shell)) {
            let reason = "its faces touch themselves".to_owned();
            return Err(NoForm::unresolved(reason));
        }
        let mut described = Described::default();
        for &shell in shells {
            let mut faces = Vec::new();
            for &face in &self.exact.shells[shell].faces {
                let face = &self.exact.faces[face];
                let surface = surface::describe(topology, self.solid, &self.exact, face)
                    .map_err(NoForm::of_surface)?;
                if face.loops.is_empty() && !surface.is_closed() {
                    let id = face.primitive.0;
                    return Err(NoForm::unresolved(format!(
                        "a face of surface {id} has lost its edges"
                    )));
                }
                if face.is_pinched {
                    let id = face.primitive.0;
                    return Err(NoForm::unresolved(format!(
                        "a face of surface {id} touches itself in a point"
                    )));
                }
                if self
                    .exact
                    .is_folded(face, TOUCHING * self.solid.extent.diagonal())
                {
                    let id = face.primitive.0;
                    return Err(NoForm::unresolved(format!(
                        "a face of surface {id} touches itself along an edge"
                    )));
                }
                for &half_edge in face.loops.iter().flatten() {
                    let edge = half_edge / 2;
                    if surface.bends(&self.exact.edges[edge].piece.curve) {
                        described.split.insert(edge);
                    }
                    if let Entry::Vacant(entry) = described.curves.entry(edge) {
                        entry.insert(self.curve(edge)?);
                    }
                }
                for start in surface.cut.iter().flat_map(|cut| &cut.starts) {
                    let half_edge = face.loops[start.ring][start.place];
                    let stops = described.stops.entry(half_edge / 2).or_default();
                    stops.extend(start.parameter);
                }
                faces.push((surface, face.clone()));
            }
            described.shells.push(faces);
        }
        Ok(described)
    }

    fn curve(&self, edge: usize) -> Result<CurveInput, NoForm> {
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
                    NoForm::unresolved(format!(
                        "an edge of surfaces {ids} was not traced to the tolerance"
                    ))
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
