//! One leaf of the subdivision with the primitives that cross it, and where its vertices lie.

use crate::arrange::{Arrangement, FACET, Planes, support};
use crate::barycentric::barycentric;
use crate::certify::barycentric_gradients;
use crate::leaf_formula::{Label, Pattern};
use crate::mesh::MeshBuilder;
use crate::simplex::Simplex;
use crate::snap::{LeafPolynomial, Snapper};
use arrayvec::ArrayVec;
use glam::DVec3;

/// What is known of a leaf.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf<'a> {
    /// Where it is.
    pub(crate) simplex: &'a Simplex,
    /// The affine interpolants.
    pub(crate) planes: Planes<'a>,
    /// The polynomials themselves, in the same order.
    pub(crate) polynomials: &'a [LeafPolynomial<'a>],
}

impl Leaf<'_> {
    /// Position of an arrangement vertex, in the domain's own coordinates: on the polynomials
    /// where Newton's method finds them inside the vertex' face, else on their interpolants.
    pub(crate) fn position(&self, name: [u16; 3], snapper: &mut Snapper) -> DVec3 {
        let (rows, columns) = support(name);
        let affine = barycentric(&self.planes, name);
        let polynomials: ArrayVec<_, 3> = rows.iter().map(|row| self.polynomials[*row]).collect();
        let curved = polynomials.iter().any(|p| p.degree > 1);
        let snapped = curved.then(|| snapper.crossing(&polynomials, &columns, affine));
        self.at(snapped.flatten().unwrap_or(affine))
    }

    /// Whether any of its surfaces is not a plane, so that vertices leave the interpolants.
    pub(crate) fn is_curved(&self) -> bool {
        self.polynomials.iter().any(|p| p.degree > 1)
    }

    /// Position of an arrangement vertex on the interpolants.
    pub(crate) fn affine_position(&self, name: [u16; 3]) -> DVec3 {
        self.at(barycentric(&self.planes, name))
    }

    fn at(&self, b: [f64; 4]) -> DVec3 {
        let corners = self.simplex.vertices.map(crate::lattice::Point::position);
        (0..4).map(|v| corners[v] * b[v]).sum()
    }

    /// Whether a position is on the side of every other primitive, and of its interpolant, on
    /// which the arrangement has the vertex `name`: bit j of `pattern` is set inside primitive j.
    ///
    /// A vertex moves along its edge or facet to its true place; where the surface grazes the
    /// edge that can be far, past another surface.
    pub(crate) fn keeps_sides(
        &self,
        name: [u16; 3],
        pattern: Pattern,
        position: DVec3,
        snapper: &mut Snapper,
    ) -> bool {
        let origin = self.simplex.vertices[0].position();
        let gradients = barycentric_gradients(self.simplex);
        let mut b = gradients.map(|g| g.dot(position - origin));
        b[0] += 1.0;
        (0..self.polynomials.len())
            .filter(|j| !name.contains(&(*j as u16)))
            .all(|j| {
                let inside = pattern >> j & 1 == 1;
                let values = &self.planes.values[j];
                let affine: f64 = (0..4).map(|v| b[v] * values[v]).sum();
                let polynomial = self.polynomials[j];
                (affine < 0.0) == inside
                    && (polynomial.degree == 1 || (snapper.value(polynomial, b) < 0.0) == inside)
            })
    }

    /// The mesh vertex where a primitive crosses the edge p–q of the simplex.
    pub(crate) fn edge_vertex(
        &self,
        primitive: usize,
        [p, q]: [usize; 2],
        snapper: &mut Snapper,
        mesh: &mut MeshBuilder,
    ) -> u32 {
        // In an order that depends on the edge alone, so that the position does, too.
        let v = &self.simplex.vertices;
        let (p, q) = if v[p] < v[q] { (p, q) } else { (q, p) };
        let midpoint = v[p].midpoint(v[q]);
        mesh.edge_vertex(midpoint, self.planes.primitives[primitive], || {
            let t = snapper.edge_root(self.polynomials[primitive], p, q);
            let (a, b) = (v[p].position(), v[q].position());
            a + (b - a) * t
        })
    }
}

/// One primitive's polygon in a leaf, arranged.
#[derive(Clone, Copy)]
pub(crate) struct LeafPolygon<'a> {
    /// The leaf.
    pub(crate) leaf: &'a Leaf<'a>,
    /// Its arrangement, last cut for `own`.
    pub(crate) arrangement: &'a Arrangement,
    /// Local number of the primitive.
    pub(crate) own: usize,
}

impl LeafPolygon<'_> {
    /// Global index of the primitive.
    pub(crate) fn primitive(&self) -> u32 {
        self.leaf.planes.primitives[self.own]
    }

    /// What its pieces have in common: plane in the leaf, primitive and label.
    pub(crate) fn piece(&self, label: Label) -> (u16, u32, Label) {
        (self.own as u16, self.primitive(), label)
    }

    /// The mesh vertex of an arrangement vertex on an edge.
    pub(crate) fn edge_vertex(
        &self,
        name: [u16; 3],
        snapper: &mut Snapper,
        mesh: &mut MeshBuilder,
    ) -> u32 {
        let mut ends = (0..4u16)
            .filter(|v| !name.contains(&(FACET + v)))
            .map(usize::from);
        let ends = [ends.next().unwrap_or(0), ends.next().unwrap_or(0)];
        self.leaf
            .edge_vertex(usize::from(name[0]), ends, snapper, mesh)
    }
}
