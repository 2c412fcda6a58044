//! Solids as plane facets: the fallback.

use super::describe::point;
use super::{Error, File, ShellFaces, refused};
use brep::simplify::remove_small;
use brep::{Brep, FacetKey, HalfEdgeKey, HalfEdgeView, ShellId, Shells, Solid, Valid, VertexKey};
use csg::Aabb;
use glam::DVec3;
use std::collections::BTreeMap;
use step_io::Orientation;
use step_io::build::{CurveInput, FaceBoundInput, Frame, SurfaceInput, Vertex};
use step_io::model::EdgeCurveId;

/// Facets of a solid, shell by shell.
type FacetLists = Vec<Vec<FacetKey>>;

/// The mesh without edges and facets that readers would take for points and lines.
pub(super) fn without_slivers(brep: &Valid<Brep>, size: f64) -> Result<Valid<Brep>, Error> {
    let cleaned = remove_small(brep.clone(), size);
    let (brep, counts) = cleaned.map_err(|defects| Error::Step {
        reason: defects.to_string(),
    })?;
    match counts.remaining_edges + counts.remaining_facets {
        0 => Ok(brep),
        count => Err(Error::ThinFacets { count, size }),
    }
}

/// For each solid of one mesh, given by its box, the same solid in another mesh: that with the
/// nearest box. `None` if there are not enough of them.
pub(super) fn matching(boxes: &[Aabb], brep: &Valid<Brep>) -> Option<Vec<FacetLists>> {
    let shells = Shells::of(brep);
    let distance = |a: &Aabb, b: &Aabb| {
        (a.min - b.min)
            .abs()
            .max((a.max - b.max).abs())
            .max_element()
    };
    let mut pairs = Vec::with_capacity(boxes.len() * shells.solids.len());
    for (at, bounds) in boxes.iter().enumerate() {
        for (other, solid) in shells.solids.iter().enumerate() {
            let outer = &shells.shells[solid.outer.0 as usize];
            pairs.push((distance(bounds, &outer.bounds), at, other));
        }
    }
    pairs.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut found = vec![None; boxes.len()];
    let mut is_taken = vec![false; shells.solids.len()];
    for (_, at, other) in pairs {
        if found[at].is_none() && !is_taken[other] {
            found[at] = Some(other);
            is_taken[other] = true;
        }
    }
    let all = of_solids(brep, &shells);
    found
        .into_iter()
        .map(|other| Some(all[other?].clone()))
        .collect()
}

/// The facets of all solids.
pub(super) fn of_solids(brep: &Brep, shells: &Shells) -> Vec<FacetLists> {
    let mut of_shells = vec![Vec::new(); shells.shells.len()];
    for facet in brep.facets() {
        let ShellId(shell) = shells.shell_of[facet.key()];
        of_shells[shell as usize].push(facet.key());
    }
    let lists = |solid: &Solid| {
        let all = std::iter::once(&solid.outer).chain(&solid.voids);
        all.map(|&ShellId(shell)| of_shells[shell as usize].clone())
            .collect()
    };
    shells.solids.iter().map(lists).collect()
}

impl File<'_> {
    /// The mesh's facets, each as a plane face.
    pub(super) fn faceted(
        &mut self,
        brep: &Brep,
        facets: &[Vec<FacetKey>],
    ) -> Result<ShellFaces, Error> {
        let mut vertices = BTreeMap::new();
        let mut edges = BTreeMap::new();
        let mut all = Vec::new();
        for shell in facets {
            let mut faces = Vec::new();
            for &key in shell {
                let facet = brep.facet(key);
                let mut bound = Vec::with_capacity(3);
                for half_edge in facet.half_edges() {
                    let id = self.straight_edge(half_edge, &mut vertices, &mut edges)?;
                    let orientation = if half_edge.is_representative() {
                        Orientation::Forward
                    } else {
                        Orientation::Reversed
                    };
                    bound.push((id, orientation));
                }
                let [a, b, _] = facet.positions();
                let normal = facet.area_vector().normalize_or(DVec3::Z);
                let frame = Frame {
                    origin: point(a, self.scale),
                    axis: normal.to_array(),
                    ref_dir: (b - a).normalize_or(DVec3::X).to_array(),
                };
                let bounds = vec![FaceBoundInput::outer(bound)];
                let plane = SurfaceInput::Plane(frame);
                let face = self.builder.face(plane, Orientation::Forward, bounds);
                faces.push((face.map_err(refused)?, facet.material()));
            }
            all.push(faces);
        }
        Ok(all)
    }

    fn straight_edge(
        &mut self,
        half_edge: HalfEdgeView<'_>,
        vertices: &mut BTreeMap<VertexKey, Vertex>,
        edges: &mut BTreeMap<HalfEdgeKey, EdgeCurveId>,
    ) -> Result<EdgeCurveId, Error> {
        let forward = if half_edge.is_representative() {
            half_edge
        } else {
            half_edge.twin()
        };
        if let Some(&id) = edges.get(&forward.key()) {
            return Ok(id);
        }
        let mut ends = Vec::with_capacity(2);
        for end in [forward.origin(), forward.target()] {
            let vertex = if let Some(&vertex) = vertices.get(&end.key()) {
                vertex
            } else {
                let point = point(end.position(), self.scale);
                let vertex = self.builder.vertex(point).map_err(refused)?;
                vertices.insert(end.key(), vertex);
                vertex
            };
            ends.push(vertex);
        }
        let id = self.builder.edge(ends[0], ends[1], CurveInput::Line);
        let id = id.map_err(refused)?;
        edges.insert(forward.key(), id);
        Ok(id)
    }
}
