//! Clean-up of what rounding leaves. [`remove_degenerate`] changes neither topology nor shape.

mod collapse;
mod flip;
mod knots;

pub use knots::contract_knots;

use crate::topology::{Brep, VertexView};
use crate::validate::{Defects, Valid};
use glam::DVec3;

/// Edges up to this length, in sizes of the mesh, have no length: where several planes meet in a
/// point but for rounding, as at each vertex of an imported mesh, the arrangement is exact for the
/// rounded planes and has corners this close.
const NO_LENGTH: f64 = 1.0 / (1_u64 << 33) as f64;

/// What [`remove_degenerate`] did.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Simplified {
    /// Edges without length that were collapsed.
    pub collapsed_edges: usize,
    /// Length of the longest of them.
    pub longest_collapsed: f64,
    /// Facets without area that an edge flip removed.
    pub flipped_edges: usize,
    /// Edges without length that had to stay, since collapsing them would change topology.
    pub remaining_edges: usize,
    /// Facets without area that had to stay, those at such edges included.
    pub remaining_facets: usize,
}

/// The length up to which edges have none.
fn shortest(brep: &Brep) -> f64 {
    let [low, high] = brep
        .vertices()
        .map(VertexView::position)
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| {
            [low.min(p), high.max(p)]
        });
    NO_LENGTH * (high - low).max_element().max(0.0)
}

/// Removes edges without length and facets of area zero wherever topology allows.
///
/// An edge of up to 2⁻³³ of the mesh's size has no length; areas are zero exactly or not at all.
/// Vertices move by the lengths of collapsed edges at most. Cost: linear when there is nothing to
/// do.
///
/// # Errors
/// Never for meshes within the guarantees; the result is validated again all the same.
pub fn remove_degenerate(brep: Valid<Brep>) -> Result<(Valid<Brep>, Simplified), Defects> {
    let reach = shortest(&brep);
    remove(brep, reach, 0.0)
}

/// Removes edges no longer than `size`, in model units, and facets no higher than it over their
/// longest edge, wherever topology allows.
///
/// # Errors
/// Never; the result is validated again all the same.
pub fn remove_small(brep: Valid<Brep>, size: f64) -> Result<(Valid<Brep>, Simplified), Defects> {
    let (brep, first) = remove(brep, size, size)?;
    if first.flipped_edges == 0 {
        return Ok((brep, first));
    }
    // Flips make new edges, some of which are short.
    let (brep, second) = remove(brep, size, size)?;
    let counts = Simplified {
        collapsed_edges: first.collapsed_edges + second.collapsed_edges,
        longest_collapsed: first.longest_collapsed.max(second.longest_collapsed),
        flipped_edges: first.flipped_edges + second.flipped_edges,
        ..second
    };
    Ok((brep, counts))
}

/// Collapses edges up to `reach`, and flips away facets up to `height`; zero is exact.
fn remove(
    brep: Valid<Brep>,
    reach: f64,
    height: f64,
) -> Result<(Valid<Brep>, Simplified), Defects> {
    let mut brep = brep.into_inner();
    let collapse::Collapsed {
        count: collapsed_edges,
        longest: longest_collapsed,
        remaining: remaining_edges,
    } = collapse::collapse_short_edges(&mut brep, reach);
    let (flipped_edges, remaining_facets) = flip::flip_flat_facets(&mut brep, height);
    let counts = Simplified {
        collapsed_edges,
        longest_collapsed,
        flipped_edges,
        remaining_edges,
        remaining_facets,
    };
    if collapsed_edges == 0 && flipped_edges == 0 {
        return Ok((Valid::untouched(brep), counts));
    }
    Ok((brep.validate()?, counts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, mesh, tetrahedron, torus};
    use crate::{Properties, Shells, stitch};
    use proptest::prelude::*;
    use subdiv::Fragments;

    fn valid(fragments: &Fragments) -> Valid<Brep> {
        stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid")
    }

    fn simplified(fragments: &Fragments) -> (Valid<Brep>, Simplified) {
        remove_degenerate(valid(fragments)).expect("stays valid")
    }

    #[test]
    fn good_meshes_stay_as_they_are() {
        let (brep, counts) = simplified(&torus(2.0, 1.0, 8, 6));
        assert_eq!(counts, Simplified::default());
        assert_eq!(brep.facet_count(), 96);
    }

    #[test]
    fn an_edge_of_length_zero_collapses() {
        // Two neighbouring vertices in one place.
        let mut fragments = torus(2.0, 1.0, 9, 7);
        fragments.positions[8] = fragments.positions[1];
        let (brep, counts) = simplified(&fragments);
        assert_eq!((counts.collapsed_edges, counts.remaining_edges), (1, 0));
        assert_eq!((brep.vertex_count(), brep.facet_count()), (62, 124));
        assert_eq!(Shells::of(&brep).genus(), 1);
    }

    #[test]
    fn topology_is_never_given_up() {
        // A tetrahedron cannot lose a vertex; a torus pulled together around its tube neither.
        let mut fragments = tetrahedron();
        fragments.positions[1] = DVec3::ZERO;
        let (brep, counts) = simplified(&fragments);
        assert_eq!(
            (
                brep.facet_count(),
                counts.collapsed_edges,
                counts.remaining_edges
            ),
            (4, 0, 1)
        );
        let mut fragments = torus(2.0, 1.0, 6, 3);
        for at in 0..3 {
            fragments.positions[at] = DVec3::X;
        }
        let (brep, counts) = simplified(&fragments);
        assert_eq!((counts.collapsed_edges, counts.remaining_edges), (0, 3));
        assert_eq!(Shells::of(&brep).genus(), 1);
    }

    #[test]
    fn a_vertex_on_an_edge_of_its_facet_is_flipped_away() {
        // A box' top edge 0–1 with a vertex 8 in its middle, seen by one side only.
        let mut fragments = cube([0.0; 3], 1.0);
        let middle = u32::try_from(fragments.positions.len()).expect("small");
        let at = fragments
            .triangles
            .iter()
            .position(|t| t.vertices == [0, 1, 5])
            .expect("front");
        let front = fragments.triangles[at];
        fragments
            .positions
            .push((fragments.positions[0] + fragments.positions[1]) * 0.5);
        // (0, 1, 5) becomes (0, 8, 5), (8, 1, 5) and the flat (0, 1, 8).
        fragments.triangles[at].vertices = [0, middle, 5];
        for vertices in [[middle, 1, 5], [0, 1, middle]] {
            fragments
                .triangles
                .push(subdiv::Triangle { vertices, ..front });
        }
        let before = Properties::of(&valid(&fragments));
        let (brep, counts) = simplified(&fragments);
        assert_eq!((counts.flipped_edges, counts.remaining_facets), (1, 0));
        assert!(
            brep.facets()
                .all(|facet| facet.area_vector() != DVec3::ZERO)
        );
        let after = Properties::of(&brep);
        assert!((before.volume - after.volume).abs() < 1e-15);
        assert!((before.area - after.area).abs() < 1e-14);
        // The bottom now owns both pieces beside the middle vertex.
        let groups = crate::Groups::of(&brep);
        assert_eq!(
            (
                groups.faces.len(),
                groups.edges.len(),
                groups.vertices.len()
            ),
            (6, 12, 8)
        );
    }

    #[test]
    fn flat_solids_stay() {
        let flat = mesh(
            &[[0.; 3], [1., 0., 0.], [2., 0., 0.], [3., 0., 0.]],
            &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        );
        let (_, counts) = simplified(&flat);
        assert_eq!((counts.flipped_edges, counts.remaining_facets), (0, 4));
    }

    proptest! {
        /// Whatever vertices fall together, the result is valid, has the same genus and volume,
        /// and no edge of length zero that could go.
        #[test]
        fn collapsing_keeps_topology(picks in proptest::collection::vec((0..48_usize, 0..48_usize), 0..30)) {
            let mut fragments = torus(2.0, 1.0, 8, 6);
            for (from, to) in picks {
                fragments.positions[from] = fragments.positions[to];
            }
            let brep = valid(&fragments);
            let (genus, volume) = (Shells::of(&brep).genus(), Properties::of(&brep).volume);
            let (brep, _) = remove_degenerate(brep)?;
            prop_assert_eq!(Shells::of(&brep).genus(), genus);
            prop_assert!((Properties::of(&brep).volume - volume).abs() < 1e-12);
        }
    }
}
