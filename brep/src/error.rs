//! Why triangles could not be stitched.

use glam::DVec3;

/// Triangles that do not form a closed, oriented surface.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A directed edge whose reverse occurs nowhere: a hole.
    #[error(
        "triangle {triangle} has an open edge from {from} to {to} ({total} edges are open or overused)"
    )]
    OpenEdge {
        /// Index of the triangle in the fragments.
        triangle: usize,
        /// Where the edge starts.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// How many edges of the whole mesh are open or overused.
        total: usize,
    },
    /// An edge used twice in one direction: more than two triangles meet, or two are oriented
    /// differently.
    #[error(
        "triangle {triangle} uses the edge from {from} to {to} a second time in this direction ({total} edges are open or overused)"
    )]
    OverusedEdge {
        /// Index of the second triangle that uses it.
        triangle: usize,
        /// Where the edge starts.
        from: DVec3,
        /// Where it ends.
        to: DVec3,
        /// How many edges of the whole mesh are open or overused.
        total: usize,
    },
    /// A triangle that names one vertex twice.
    #[error("triangle {triangle} names a vertex twice")]
    RepeatedVertex {
        /// Index of the triangle in the fragments.
        triangle: usize,
    },
    /// A triangle that names a vertex which does not exist.
    #[error("triangle {triangle} names a vertex beyond the last position")]
    VertexOutOfRange {
        /// Index of the triangle in the fragments.
        triangle: usize,
    },
    /// A vertex where the triangles around it form more than one cycle.
    #[error("the triangles around vertex {vertex} form more than one cycle")]
    PinchedVertex {
        /// Index of the vertex.
        vertex: usize,
    },
    /// More half-edges than 32-bit indices can count.
    #[error("{triangles} triangles are more than this program can index")]
    TooManyTriangles {
        /// How many there are.
        triangles: usize,
    },
}
