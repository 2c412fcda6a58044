use crate::topology::{Brep, VertexKey};
use glam::DVec3;

/// A vertex whose position is infinite or not a number.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error("vertex {vertex:?} has the position {position}")]
pub struct NonFinitePosition {
    /// The vertex.
    pub vertex: VertexKey,
    /// Where it pretends to be.
    pub position: DVec3,
}

impl NonFinitePosition {
    /// All of them.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let vertices = brep.vertices.iter();
        vertices
            .filter(|(_, vertex)| !vertex.position.is_finite())
            .map(|(key, vertex)| Self {
                vertex: key,
                position: vertex.position,
            })
            .collect()
    }
}
