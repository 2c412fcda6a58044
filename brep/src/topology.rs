//! The half-edge structure: who is next to whom. Coordinates are stored here but never read.

use csg::{MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use slotmap::{SecondaryMap, SlotMap, new_key_type};

new_key_type! {
    /// Names a vertex of one [`Brep`].
    pub struct VertexKey;
    /// Names a half-edge of one [`Brep`].
    pub struct HalfEdgeKey;
    /// Names a facet of one [`Brep`].
    pub struct FacetKey;
}

/// One of the two directions of an edge.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct HalfEdge {
    /// The same edge in the other direction.
    pub twin: HalfEdgeKey,
    /// The half-edge that follows counter-clockwise around the facet.
    pub next: HalfEdgeKey,
    /// The vertex where it starts.
    pub origin: VertexKey,
    /// The facet to its left, seen from outside.
    pub facet: FacetKey,
}

/// A mesh vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Vertex {
    /// Where it is, in model units.
    pub position: DVec3,
    /// One of the half-edges that start here.
    pub outgoing: HalfEdgeKey,
}

/// A triangle of the boundary.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Facet {
    /// One of its three half-edges.
    pub half_edge: HalfEdgeKey,
    /// The primitive on which it lies.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
}

/// A closed, oriented triangle mesh as half-edges.
///
/// Invariants kept by every constructor: all keys resolve; `twin` pairs half-edges with swapped
/// ends; `next` has period three. What else holds is for [`Brep::validate`] to say.
#[derive(Clone, Debug, Default)]
pub struct Brep {
    pub(crate) vertices: SlotMap<VertexKey, Vertex>,
    pub(crate) half_edges: SlotMap<HalfEdgeKey, HalfEdge>,
    pub(crate) facets: SlotMap<FacetKey, Facet>,
}

impl Brep {
    /// Number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    /// Number of undirected edges.
    pub fn edge_count(&self) -> usize {
        self.half_edges.len() / 2
    }

    /// Number of facets.
    pub fn facet_count(&self) -> usize {
        self.facets.len()
    }

    /// Whether there is no facet at all: the empty solid.
    pub fn is_empty(&self) -> bool {
        self.facets.is_empty()
    }

    /// The vertex with this key.
    ///
    /// # Panics
    /// When the key belongs to another mesh, or its vertex was removed. So do all views.
    pub fn vertex(&self, key: VertexKey) -> VertexView<'_> {
        VertexView { brep: self, key }
    }

    /// The half-edge with this key.
    pub fn half_edge(&self, key: HalfEdgeKey) -> HalfEdgeView<'_> {
        HalfEdgeView { brep: self, key }
    }

    /// The facet with this key.
    pub fn facet(&self, key: FacetKey) -> FacetView<'_> {
        FacetView { brep: self, key }
    }

    /// All vertices, in a fixed order.
    pub fn vertices(&self) -> impl ExactSizeIterator<Item = VertexView<'_>> {
        self.vertices.keys().map(|key| self.vertex(key))
    }

    /// All half-edges, in a fixed order.
    pub fn half_edges(&self) -> impl ExactSizeIterator<Item = HalfEdgeView<'_>> {
        self.half_edges.keys().map(|key| self.half_edge(key))
    }

    /// All facets, in a fixed order.
    pub fn facets(&self) -> impl ExactSizeIterator<Item = FacetView<'_>> {
        self.facets.keys().map(|key| self.facet(key))
    }

    /// Numbers the vertices 0, 1, 2, … in the order of [`Brep::vertices`].
    pub fn number_vertices(&self) -> SecondaryMap<VertexKey, u32> {
        let mut numbers = SecondaryMap::with_capacity(self.vertices.capacity());
        for (number, key) in (0..).zip(self.vertices.keys()) {
            numbers.insert(key, number);
        }
        numbers
    }
}

/// A borrowed vertex, to walk from.
#[derive(Clone, Copy, Debug)]
pub struct VertexView<'a> {
    brep: &'a Brep,
    key: VertexKey,
}

impl<'a> VertexView<'a> {
    /// Its key.
    pub fn key(self) -> VertexKey {
        self.key
    }

    /// Where it is, in model units.
    pub fn position(self) -> DVec3 {
        self.brep.vertices[self.key].position
    }

    /// One of the half-edges that start here.
    pub fn outgoing(self) -> HalfEdgeView<'a> {
        self.brep.half_edge(self.brep.vertices[self.key].outgoing)
    }

    /// The half-edges that start here, counter-clockwise seen from outside, first `outgoing`.
    pub fn ring(self) -> impl Iterator<Item = HalfEdgeView<'a>> {
        self.outgoing().ring()
    }
}

/// A borrowed half-edge, to walk from.
#[derive(Clone, Copy, Debug)]
pub struct HalfEdgeView<'a> {
    brep: &'a Brep,
    key: HalfEdgeKey,
}

impl<'a> HalfEdgeView<'a> {
    /// Its key.
    pub fn key(self) -> HalfEdgeKey {
        self.key
    }

    /// The same edge in the other direction.
    #[must_use]
    pub fn twin(self) -> Self {
        self.brep.half_edge(self.brep.half_edges[self.key].twin)
    }

    /// The half-edge that follows counter-clockwise around the facet.
    #[must_use]
    pub fn next(self) -> Self {
        self.brep.half_edge(self.brep.half_edges[self.key].next)
    }

    /// The half-edge before this one around the facet.
    #[must_use]
    pub fn prev(self) -> Self {
        self.next().next()
    }

    /// The vertex where it starts.
    pub fn origin(self) -> VertexView<'a> {
        self.brep.vertex(self.brep.half_edges[self.key].origin)
    }

    /// The vertex where it ends.
    pub fn target(self) -> VertexView<'a> {
        self.next().origin()
    }

    /// The facet to its left, seen from outside.
    pub fn facet(self) -> FacetView<'a> {
        self.brep.facet(self.brep.half_edges[self.key].facet)
    }

    /// The half-edges that start at the same vertex, counter-clockwise seen from outside,
    /// beginning with this one.
    pub fn ring(self) -> impl Iterator<Item = Self> {
        let first = self.key;
        std::iter::successors(Some(self), move |half_edge| {
            let following = half_edge.prev().twin();
            (following.key != first).then_some(following)
        })
    }

    /// Whether this half-edge represents its edge: exactly one of the two twins does.
    pub fn is_representative(self) -> bool {
        self.key < self.twin().key
    }
}

/// A borrowed facet, to walk from.
#[derive(Clone, Copy, Debug)]
pub struct FacetView<'a> {
    brep: &'a Brep,
    key: FacetKey,
}

impl<'a> FacetView<'a> {
    /// Its key.
    pub fn key(self) -> FacetKey {
        self.key
    }

    /// One of its half-edges; always the same one.
    pub fn half_edge(self) -> HalfEdgeView<'a> {
        self.brep.half_edge(self.brep.facets[self.key].half_edge)
    }

    /// Its half-edges, counter-clockwise seen from outside.
    pub fn half_edges(self) -> [HalfEdgeView<'a>; 3] {
        let first = self.half_edge();
        let second = first.next();
        [first, second, second.next()]
    }

    /// Its vertices, counter-clockwise seen from outside.
    pub fn vertices(self) -> [VertexView<'a>; 3] {
        self.half_edges().map(HalfEdgeView::origin)
    }

    /// The facets across its edges.
    pub fn neighbours(self) -> [FacetView<'a>; 3] {
        self.half_edges().map(|half_edge| half_edge.twin().facet())
    }

    /// The primitive on which it lies.
    pub fn primitive(self) -> PrimitiveId {
        self.brep.facets[self.key].primitive
    }

    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub fn sense(self) -> Sense {
        self.brep.facets[self.key].sense
    }

    /// The material it shows.
    pub fn material(self) -> MaterialId {
        self.brep.facets[self.key].material
    }
}
