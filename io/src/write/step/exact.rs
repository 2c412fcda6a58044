//! Faces on true surfaces.

use super::describe::{Described, point};
use super::{Error, File, ShellFaces, refused, surface};
use brep::ExactFace;
use std::collections::BTreeMap;
use step_io::Orientation;
use step_io::build::{CurveInput, FaceBoundInput, Vertex};
use step_io::model::{AdvancedFaceId, EdgeCurveId};

impl File<'_> {
    /// Adds the edges and faces of a solid.
    pub(super) fn exact_faces(&mut self, described: &Described) -> Result<ShellFaces, Error> {
        let mut vertices: BTreeMap<usize, Vertex> = BTreeMap::new();
        let mut edges: BTreeMap<usize, EdgeCurveId> = BTreeMap::new();
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
            let id = self
                .builder
                .edge(ends[0], ends[1], curve.clone())
                .map_err(refused)?;
            edges.insert(at, id);
        }
        let mut shells = Vec::new();
        for faces in &described.shells {
            let mut shell = Vec::new();
            for (surface, face) in faces {
                shell.push((self.exact_face(surface, face, &edges)?, face.material));
            }
            self.outcome.faces += shell.len();
            shells.push(shell);
        }
        Ok(shells)
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
        edges: &BTreeMap<usize, EdgeCurveId>,
    ) -> Result<AdvancedFaceId, Error> {
        let scale = self.scale;
        let orientation = surface.orientation;
        if face.loops.is_empty() {
            return surface.whole(&mut self.builder, scale).map_err(refused);
        }
        let bounds = face.loops.iter().enumerate().map(|(at, ring)| {
            let edges = ring
                .iter()
                .map(|half_edge| {
                    let orientation = if half_edge % 2 == 0 {
                        Orientation::Forward
                    } else {
                        Orientation::Reversed
                    };
                    (edges[&(half_edge / 2)], orientation)
                })
                .collect();
            if at == 0 && surface.is_plane() {
                FaceBoundInput::outer(edges)
            } else {
                FaceBoundInput::inner(edges)
            }
        });
        let bounds = bounds.collect();
        self.builder
            .face(surface.input(scale), orientation, bounds)
            .map_err(refused)
    }
}
