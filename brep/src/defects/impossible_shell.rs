use crate::euler::EulerCharacteristic;
use crate::shells::Components;
use crate::topology::{Brep, FacetKey};

/// A connected component whose element counts fit no closed, orientable surface.
#[derive(Clone, Copy, PartialEq, Debug, thiserror::Error)]
#[error(
    "a shell of {} vertices, {} edges and {} facets has no integer genus",
    counts.vertices, counts.edges, counts.facets
)]
pub struct ImpossibleShell {
    /// Its first facet.
    pub facet: FacetKey,
    /// What it consists of.
    pub counts: EulerCharacteristic,
}

impl ImpossibleShell {
    /// All of them. Twins must be paired and facets be triangles.
    pub(crate) fn find(brep: &Brep) -> Vec<Self> {
        let components = Components::of(brep);
        let shells = components.first.into_iter().zip(components.counts);
        shells
            .filter(|(_, counts)| counts.genus().is_none())
            .map(|(facet, counts)| Self { facet, counts })
            .collect()
    }
}
