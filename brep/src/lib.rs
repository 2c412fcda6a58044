//! Half-edge boundary representation: from named triangles to a checked, measured solid boundary.
//!
//! ```text
//!              twin.next
//!        w <──────────────
//!       ╱ ╲                      h.origin = u, h.next.origin = v, h.twin.origin = v
//!  prev╱   ╲next                 h.facet is the facet to the left of h, seen from outside
//!     ╱  h  ╲                    next runs counter-clockwise around the facet
//!    u ─────> v                  h.prev.twin is the next half-edge counter-clockwise around u
//!      <─────
//!       twin
//! ```
//!
//! [`stitch`] joins the triangles of a subdivision by the names of their vertices;
//! [`Brep::validate`] then proves what every writer relies on and returns a [`Valid`].
//!
//! Guaranteed by [`Valid<Brep>`](Valid): facets are triangles with three different vertices; every
//! directed edge occurs once and its reverse once; the facets around each vertex form one cycle;
//! each shell satisfies the Euler–Poincaré formula with an integer genus ≥ 0; positions are finite.
//! **Not** guaranteed: that facets do not cross each other in space, that positions differ, that
//! facets have an area. Those are the subdivision's promises.
//!
//! ```
//! # use brep::stitch;
//! # let fragments = subdiv::Fragments::default();
//! let boundary = stitch(&fragments)?.validate()?;
//! let properties = brep::Properties::of(&boundary);
//! assert_eq!(properties.volume, 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod curve;
mod edges;
mod enclosure;
mod error;
mod euler;
mod exact;
mod geometry;
mod ghosts;
mod group;
mod hierarchy;
mod inspect;
mod join;
mod properties;
mod quality;
mod shells;
mod smooth;
mod stitch;
mod sum;
mod tessellate;
mod topology;
mod triangulate;
mod validate;
mod weld;

pub mod defects;
pub mod simplify;

#[cfg(test)]
mod samples;

pub use curve::{Curve, Curves, EdgeCurve, Piece, Spline};
pub use enclosure::{Enclosure, Open, enclose};
pub use error::Error;
pub use euler::EulerCharacteristic;
pub use exact::{Crumbs, ExactBrep, ExactEdge, ExactFace, ExactShell};
pub use ghosts::dissolve_ghosts;
pub use group::{Edge, Face, FaceId, Groups};
pub use inspect::{DefectKind, Example, Inspection, Tally};
pub use join::join_equal;
pub use properties::Properties;
pub use quality::Quality;
pub use shells::{Shell, ShellId, ShellRole, Shells, Solid};
pub use smooth::{Corner, CornerId, Corners, Shading};
pub use stitch::{check_manifold, stitch};
pub use tessellate::{
    Demand, Fit, IfTroubled, Proof, Tessellated, passes_through_itself, tessellate,
};
pub use topology::{
    Brep, Facet, FacetKey, FacetView, HalfEdge, HalfEdgeKey, HalfEdgeView, Vertex, VertexKey,
    VertexView,
};
pub use triangulate::{Retriangulated, retriangulate};
pub use validate::{Defect, Defects, Valid};
pub use weld::weld;
