//! Faces on true surfaces.

use super::describe::{Described, point};
use super::{Error, File, ShellFaces, Substitute, refused, surface};
use brep::ExactFace;
use csg::PrimitiveId;
use std::collections::BTreeMap;
use step_io::Orientation;
use step_io::build::{CurveInput, FaceBoundInput, Vertex};
use step_io::model::{AdvancedFaceId, EdgeCurveId};

/// Longest arc of a circle or an ellipse, in radians, where its image is no line on a surface's
/// parameters: readers interpolate two dozen points of each edge.
const ARC: f64 = std::f64::consts::FRAC_PI_4 + 1e-9;

/// What became of each edge.
pub(super) type EdgeChains = BTreeMap<usize, EdgeChain>;

/// An edge that is written in one or more parts.
pub(super) struct EdgeChain {
    parts: Vec<EdgeCurveId>,
    /// Ends of the parts: one more than there are.
    stops: Vec<Vertex>,
    /// Parameters between the parts: one less than there are.
    parameters: Vec<f64>,
}

/// A part of an edge on the way around a face.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) id: EdgeCurveId,
    pub(super) orientation: Orientation,
    pub(super) start: Vertex,
}

impl EdgeChain {
    /// The parts in the order of one of its half-edges.
    pub(super) fn along(&self, half_edge: usize) -> Vec<Part> {
        let is_forward = half_edge.is_multiple_of(2);
        let part = |(at, &id): (usize, &EdgeCurveId)| Part {
            id,
            orientation: if is_forward {
                Orientation::Forward
            } else {
                Orientation::Reversed
            },
            start: self.stops[at + usize::from(!is_forward)],
        };
        let all = self.parts.iter().enumerate().map(part);
        if is_forward {
            all.collect()
        } else {
            all.rev().collect()
        }
    }

    /// How many parts of a half-edge there are before a parameter.
    pub(super) fn before(&self, half_edge: usize, parameter: f64) -> usize {
        let before = self.parameters.iter().filter(|&&at| at <= parameter);
        let before = before.count();
        if half_edge.is_multiple_of(2) {
            before
        } else {
            self.parts.len() - before
        }
    }
}

impl File<'_> {
    /// Adds the edges and faces of a solid.
    pub(super) fn exact_faces(&mut self, described: &Described) -> Result<ShellFaces, Error> {
        let mut vertices: BTreeMap<usize, Vertex> = BTreeMap::new();
        let mut edges = EdgeChains::new();
        for (&at, curve) in &described.curves {
            let edge = &self.exact.edges[at];
            let ends = if let Some([from, to]) = edge.ends {
                [
                    self.vertex(from, &mut vertices)?,
                    self.vertex(to, &mut vertices)?,
                ]
            } else {
                let point = point(edge.piece.ends[0], self.scale);
                let vertex = self.builder.vertex(point).map_err(refused)?;
                [vertex, vertex]
            };
            self.outcome.spline_edges += usize::from(matches!(curve, CurveInput::Nurbs(_)));
            let [from, to] = edge.piece.range;
            let mut parameters = described.stops.get(&at).cloned().unwrap_or_default();
            if described.split.contains(&at) {
                let count = ((to - from) / ARC).ceil();
                let mut k = 1.0;
                while k < count {
                    parameters.push(from + (to - from) * (k / count));
                    k += 1.0;
                }
            }
            parameters.sort_unstable_by(f64::total_cmp);
            parameters.dedup();
            let mut stops = vec![ends[0]];
            for &t in &parameters {
                let vertex = self
                    .builder
                    .vertex(point(edge.piece.curve.point(t), self.scale));
                stops.push(vertex.map_err(refused)?);
            }
            stops.push(ends[1]);
            let parts = stops.windows(2).map(|pair| {
                let edge = self.builder.edge(pair[0], pair[1], curve.clone());
                edge.map_err(refused)
            });
            let parts = parts.collect::<Result<_, _>>()?;
            let chain = EdgeChain {
                parts,
                stops,
                parameters,
            };
            edges.insert(at, chain);
        }
        let mut shells = Vec::new();
        for faces in &described.shells {
            let mut shell = Vec::new();
            for (surface, face) in faces {
                shell.push((self.exact_face(surface, face, &edges)?, face.material));
                if let Some(entity) = surface.entity() {
                    self.count(face.primitive, entity);
                }
            }
            self.outcome.faces += shell.len();
            shells.push(shell);
        }
        Ok(shells)
    }

    fn count(&mut self, surface: PrimitiveId, entity: &'static str) {
        let known = &mut self.outcome.substitutes;
        let is_same = |of: &&mut Substitute| of.surface == surface && of.entity == entity;
        if let Some(of) = known.iter_mut().find(is_same) {
            of.faces += 1;
        } else {
            known.push(Substitute {
                surface,
                entity,
                faces: 1,
            });
        }
    }

    fn vertex(&mut self, at: usize, known: &mut BTreeMap<usize, Vertex>) -> Result<Vertex, Error> {
        if let Some(&vertex) = known.get(&at) {
            return Ok(vertex);
        }
        let point = point(self.exact.vertices[at], self.scale);
        let vertex = self.builder.vertex(point).map_err(refused)?;
        known.insert(at, vertex);
        Ok(vertex)
    }

    fn exact_face(
        &mut self,
        surface: &surface::Described,
        face: &ExactFace,
        edges: &EdgeChains,
    ) -> Result<AdvancedFaceId, Error> {
        let scale = self.scale;
        let orientation = surface.orientation;
        if face.loops.is_empty() {
            return surface.whole(&mut self.builder, scale).map_err(refused);
        }
        let input = surface.input(scale).map_err(refused)?;
        if let Some(cut) = &surface.cut {
            let bound = self.cut_bound(cut, &face.loops, edges)?;
            let bounds = vec![FaceBoundInput::outer(bound)];
            let face = self.builder.face(input, orientation, bounds);
            return face.map_err(refused);
        }
        let bounds = face.loops.iter().enumerate().map(|(at, ring)| {
            let parts = ring
                .iter()
                .flat_map(|&half_edge| edges[&(half_edge / 2)].along(half_edge));
            let parts = parts.map(|part| (part.id, part.orientation)).collect();
            if at == 0 && surface.is_plane() {
                FaceBoundInput::outer(parts)
            } else {
                FaceBoundInput::inner(parts)
            }
        });
        let bounds = bounds.collect();
        self.builder
            .face(input, orientation, bounds)
            .map_err(refused)
    }
}
