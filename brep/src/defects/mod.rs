//! What can be wrong with a mesh: one defect a file, each with the function that finds it.

mod broken_vertex_link;
mod impossible_shell;
mod malformed_facet;
mod non_finite_position;
mod repeated_edge;
mod unpaired_half_edge;

pub use broken_vertex_link::BrokenVertexLink;
pub use impossible_shell::ImpossibleShell;
pub use malformed_facet::MalformedFacet;
pub use non_finite_position::NonFinitePosition;
pub use repeated_edge::RepeatedEdge;
pub use unpaired_half_edge::UnpairedHalfEdge;
