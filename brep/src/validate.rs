//! The proof that a boundary is one, carried by a type.

use crate::defects::{
    BrokenVertexLink, ImpossibleShell, MalformedFacet, NonFinitePosition, RepeatedEdge,
    UnpairedHalfEdge,
};
use crate::topology::Brep;
use std::fmt;
use std::ops::Deref;

/// A value that has passed validation; only that makes one.
#[derive(Clone, Debug)]
pub struct Valid<T>(T);

impl<T> Valid<T> {
    /// Gives the value back, to be changed and validated again.
    pub fn into_inner(self) -> T {
        self.0
    }

    /// Takes back a value that was looked at and not changed.
    pub(crate) fn untouched(value: T) -> Self {
        Self(value)
    }
}

impl<T> Deref for Valid<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

/// One thing that is wrong with a mesh, and where.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
#[expect(
    missing_docs,
    reason = "each variant's only field is documented by its own type"
)]
pub enum Defect {
    #[error(transparent)]
    UnpairedHalfEdge(#[from] UnpairedHalfEdge),
    #[error(transparent)]
    MalformedFacet(#[from] MalformedFacet),
    #[error(transparent)]
    BrokenVertexLink(#[from] BrokenVertexLink),
    #[error(transparent)]
    RepeatedEdge(#[from] RepeatedEdge),
    #[error(transparent)]
    ImpossibleShell(#[from] ImpossibleShell),
    #[error(transparent)]
    NonFinitePosition(#[from] NonFinitePosition),
}

/// Everything that is wrong with a mesh; never empty.
#[derive(Clone, PartialEq, Debug)]
pub struct Defects(Vec<Defect>);

impl Defects {
    /// The defects, in a fixed order.
    pub fn as_slice(&self) -> &[Defect] {
        &self.0
    }
}

impl fmt::Display for Defects {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        const SHOWN: usize = 3;
        for (at, defect) in self.0.iter().take(SHOWN).enumerate() {
            let separator = if at == 0 { "" } else { "; " };
            write!(formatter, "{separator}{defect}")?;
        }
        match self.0.len().saturating_sub(SHOWN) {
            0 => Ok(()),
            more => write!(formatter, "; and {more} more defects"),
        }
    }
}

impl std::error::Error for Defects {}

impl Brep {
    /// Checks that this is the boundary of a solid, as far as topology goes (see the crate's
    /// introduction for the list).
    ///
    /// Cost: linear, but for a sort of the edges around each vertex.
    ///
    /// # Errors
    /// All defects found. Later checks rely on earlier ones and are left out when those fail.
    pub fn validate(self) -> Result<Valid<Self>, Defects> {
        let defects = self.defects();
        if defects.is_empty() {
            Ok(Valid(self))
        } else {
            Err(Defects(defects))
        }
    }

    fn defects(&self) -> Vec<Defect> {
        let mut defects: Vec<Defect> = Vec::new();
        defects.extend(MalformedFacet::find(self).into_iter().map(Defect::from));
        defects.extend(UnpairedHalfEdge::find(self).into_iter().map(Defect::from));
        defects.extend(NonFinitePosition::find(self).into_iter().map(Defect::from));
        if defects.is_empty() {
            defects.extend(BrokenVertexLink::find(self).into_iter().map(Defect::from));
        }
        if defects.is_empty() {
            defects.extend(RepeatedEdge::find(self).into_iter().map(Defect::from));
            defects.extend(ImpossibleShell::find(self).into_iter().map(Defect::from));
        }
        defects
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, mesh, tetrahedron, together, torus};
    use crate::stitch;
    use glam::DVec3;
    use slotmap::Key;

    fn sample() -> Brep {
        stitch(&cube([0.0; 3], 1.0)).expect("closed")
    }

    fn kinds(brep: Brep) -> Vec<Defect> {
        brep.validate()
            .err()
            .map(|defects| defects.0)
            .unwrap_or_default()
    }

    #[test]
    fn closed_surfaces_are_valid() {
        for fragments in [tetrahedron(), cube([1.0; 3], 2.0), torus(2.0, 1.0, 5, 4)] {
            assert!(stitch(&fragments).expect("closed").validate().is_ok());
        }
        assert!(Brep::default().validate().is_ok());
    }

    #[test]
    fn a_missing_twin_is_found() {
        let mut brep = sample();
        let key = brep.half_edges.keys().next().expect("some");
        let twin = brep.half_edges[key].twin;
        brep.half_edges[key].twin = crate::HalfEdgeKey::null();
        let found: Vec<_> = kinds(brep)
            .into_iter()
            .map(|defect| match defect {
                Defect::UnpairedHalfEdge(unpaired) => Some(unpaired.half_edge),
                _ => None,
            })
            .collect();
        // The half-edge itself, and the one that still names it.
        assert_eq!(found.len(), 2);
        assert!(found.contains(&Some(key)) && found.contains(&Some(twin)));
    }

    #[test]
    fn a_missing_facet_is_found() {
        let mut brep = sample();
        let key = brep.facets.keys().next().expect("some");
        brep.facets.remove(key);
        let found = kinds(brep);
        assert_eq!(found.len(), 3);
        assert!(
            found
                .iter()
                .all(|d| matches!(d, Defect::MalformedFacet(m) if m.facet == key))
        );
    }

    #[test]
    fn a_facet_with_a_repeated_vertex_is_found() {
        let mut brep = sample();
        let half_edge = brep.half_edges().next().expect("some");
        let (key, other) = (half_edge.key(), half_edge.target().key());
        let facet = half_edge.facet().key();
        brep.half_edges[key].origin = other;
        let found = kinds(brep);
        let is_malformed = |d: &Defect| matches!(d, Defect::MalformedFacet(m) if m.facet == facet);
        assert!(found.iter().any(is_malformed));
    }

    #[test]
    fn a_bow_tie_vertex_is_found() {
        let first = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let second = first.map(|corners: [u32; 3]| corners.map(|c| if c == 0 { 0 } else { c + 3 }));
        let up = [[0., 0., 0.], [1., 0., 1.], [0., 1., 1.], [0., 0., 1.]];
        let down = [[-1., 0., -1.], [0., -1., -1.], [0., 0., -1.]];
        let brep = stitch(&mesh(&[&up[..], &down].concat(), &[first, second].concat()));
        let found = kinds(brep.expect("edges are paired"));
        let [Defect::BrokenVertexLink(link)] = found[..] else {
            panic!("{found:?}");
        };
        assert_eq!(
            (link.position, link.facets, link.in_cycle),
            (DVec3::ZERO, 6, 3)
        );
    }

    #[test]
    fn an_edge_that_occurs_twice_is_found() {
        // Two tetrahedra, cut open along an edge each and sewn to each other there: the two edges
        // then have the same ends, but every link is one cycle.
        let mut brep = stitch(&together(&[tetrahedron(), tetrahedron()])).expect("closed");
        let vertices: Vec<_> = brep.vertices.keys().collect();
        let edge = |brep: &Brep, from: usize, to: usize| {
            let between = |h: &crate::HalfEdgeView<'_>| {
                h.origin().key() == vertices[from] && h.target().key() == vertices[to]
            };
            brep.half_edges()
                .find(between)
                .map(crate::HalfEdgeView::key)
                .expect("an edge")
        };
        let [forth, back] = [edge(&brep, 0, 1), edge(&brep, 1, 0)];
        let [other_forth, other_back] = [edge(&brep, 4, 5), edge(&brep, 5, 4)];
        for [first, second] in [[forth, other_back], [other_forth, back]] {
            brep.half_edges[first].twin = second;
            brep.half_edges[second].twin = first;
        }
        for half_edge in brep.half_edges.values_mut() {
            for (double, kept) in [(4, 0), (5, 1)] {
                if half_edge.origin == vertices[double] {
                    half_edge.origin = vertices[kept];
                }
            }
        }
        brep.vertices.remove(vertices[4]);
        brep.vertices.remove(vertices[5]);
        let found = kinds(brep);
        let ends: Vec<_> = found
            .iter()
            .map(|defect| match defect {
                Defect::RepeatedEdge(edge) => (edge.from, edge.to),
                other => panic!("{other:?}"),
            })
            .collect();
        assert_eq!(ends, [(DVec3::ZERO, DVec3::X), (DVec3::X, DVec3::ZERO)]);
    }

    #[test]
    fn a_position_that_is_no_number_is_found() {
        let mut brep = sample();
        let key = brep.vertices.keys().next().expect("some");
        brep.vertices[key].position.y = f64::NAN;
        let found = kinds(brep);
        assert!(matches!(found[..], [Defect::NonFinitePosition(p)] if p.vertex == key));
    }

    #[test]
    fn messages_name_places_and_stay_short() {
        let mut brep = sample();
        for vertex in brep.vertices.values_mut() {
            vertex.position.x = f64::INFINITY;
        }
        let message = brep.validate().expect_err("infinite").to_string();
        assert!(
            message.contains("inf") && message.ends_with("and 5 more defects"),
            "{message}"
        );
    }
}
