//! The Euler–Poincaré formula V − E + F = 2 (S − G) of closed surfaces.

/// Numbers of mesh elements on a closed surface.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct EulerCharacteristic {
    /// Vertices.
    pub vertices: usize,
    /// Undirected edges.
    pub edges: usize,
    /// Facets.
    pub facets: usize,
}

impl EulerCharacteristic {
    /// V − E + F.
    #[expect(
        clippy::cast_possible_wrap,
        reason = "slotmaps hold fewer than 2^32 elements"
    )]
    pub fn value(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.facets as i64
    }

    /// Number of handles of one connected, closed, orientable surface with this characteristic;
    /// `None` when there is no such surface (the value is odd or above 2).
    pub fn genus(&self) -> Option<u64> {
        let twice = u64::try_from(2 - self.value()).ok()?;
        twice.is_multiple_of(2).then_some(twice / 2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn genus_of_closed_surfaces_only() {
        let genus = |vertices, edges, facets| {
            EulerCharacteristic {
                vertices,
                edges,
                facets,
            }
            .genus()
        };
        assert_eq!(genus(4, 6, 4), Some(0)); // tetrahedron
        assert_eq!(genus(7, 21, 14), Some(1)); // Császár's torus
        assert_eq!(genus(6, 15, 10), None); // projective plane: no boundary of a solid
        assert_eq!(genus(8, 12, 8), None); // two tetrahedra are two surfaces
    }
}
