use crate::topology::{Brep, FacetKey};

/// A facet that is no triangle with three different vertices.
#[derive(Clone, Copy, PartialEq, Eq, Debug, thiserror::Error)]
#[error("facet {facet:?} is not a triangle with three different vertices")]
pub struct MalformedFacet {
    /// The facet.
    pub facet: FacetKey,
}

impl MalformedFacet {
    /// All of them.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let well_formed = |facet: FacetKey, first| {
            let a = brep.half_edges.get(first)?;
            let b = brep.half_edges.get(a.next)?;
            let c = brep.half_edges.get(b.next)?;
            let closed = c.next == first;
            let owned = [a, b, c].iter().all(|half_edge| half_edge.facet == facet);
            let known = [a, b, c]
                .iter()
                .all(|h| brep.vertices.contains_key(h.origin));
            let different = a.origin != b.origin && b.origin != c.origin && c.origin != a.origin;
            Some(closed && owned && known && different)
        };
        let mut found: Vec<Self> = brep
            .facets
            .iter()
            .filter(|(key, facet)| well_formed(*key, facet.half_edge) != Some(true))
            .map(|(facet, _)| Self { facet })
            .collect();
        if found.is_empty() && brep.half_edges.len() != 3 * brep.facets.len() {
            // All facets are triangles, yet half-edges are left over: report their facets.
            let stray = brep.half_edges.iter().filter(|(key, half_edge)| {
                let facet = brep.facets.get(half_edge.facet);
                let first = facet.and_then(|facet| brep.half_edges.get(facet.half_edge));
                let second = first.and_then(|first| brep.half_edges.get(first.next));
                let ring = [
                    facet.map(|f| f.half_edge),
                    first.map(|f| f.next),
                    second.map(|s| s.next),
                ];
                !ring.contains(&Some(*key))
            });
            found.extend(stray.map(|(_, half_edge)| Self {
                facet: half_edge.facet,
            }));
        }
        found
    }
}
