//! The solid's boundary inside one leaf, as triangles over named vertices (thesis 3.3, 4.3).
//!
//! One primitive gives a triangle or quadrilateral. Several are arranged exactly; the formula
//! then tells for each cell of each primitive's polygon whether the solid lies on exactly one
//! side of it. Equal neighbouring cells are joined, so only real creases and corners remain, and
//! vertices in facets are kept only if the boundary really turns there: neighbours with
//! differently pruned formulas then agree on them.

use crate::arrange::{Arrangement, Planes, polygon};
use crate::leaf::{Leaf, LeafPolygon};
use crate::leaf_formula::{Label, LeafFormula, MAX_LEAF_PRIMITIVES};
use crate::mesh::MeshBuilder;
use crate::pieces::CellComplex;
use crate::polygon::{Corner, PieceTriangulator};
use crate::predicates::{Sign, vertex_sign};
use crate::simplex::Simplex;
use crate::snap::LeafPolynomial;
use crate::vertices::{CellSide, VertexNamer};
use crate::volume::wedge;
use crate::walk::Frame;
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Sense, Ternary, localize};

/// A leaf that could not be extracted.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum LeafError {
    /// More primitives than can be arranged cross one leaf.
    TooManyPrimitives(usize),
}

/// Extracts leaves into a [`MeshBuilder`]; holds only work space between them.
#[derive(Debug, Default)]
pub(crate) struct Extractor {
    formula: LeafFormula,
    arrangement: Arrangement,
    complex: CellComplex,
    vertices: VertexNamer,
    ring: Vec<Corner>,
    boundary: Vec<u32>,
    triangulator: PieceTriangulator,
    pruned: Vec<FormulaNode>,
    scratch: LocalizeScratch,
    /// Where the last leaf had one primitive only: the fraction of the leaf on its negative side,
    /// and the sense in which the solid lies there.
    pub(crate) cut: Option<(f64, Sense)>,
}

impl Extractor {
    /// Appends the boundary of the affine functions in a frame (all of degree 1), whose signs at
    /// the vertices prune its formula first. Returns the number of nodes that are left of it; 0
    /// where there is no boundary.
    ///
    /// # Errors
    /// As [`Self::extract`].
    pub(crate) fn extract_affine(
        &mut self,
        simplex: &Simplex,
        frame: &Frame,
        mesh: &mut MeshBuilder,
    ) -> Result<usize, LeafError> {
        let value = |p: PrimitiveId| frame.side(p.0);
        let mut pruned = std::mem::take(&mut self.pruned);
        pruned.clear();
        let result = localize(&frame.formula, value, &mut pruned, &mut self.scratch);
        let extracted = if result == Ternary::Unknown {
            self.extract(simplex, &pruned, frame, mesh)
        } else {
            pruned.clear();
            Ok(())
        };
        let left = pruned.len();
        self.pruned = pruned;
        extracted.map(|()| left)
    }

    /// Appends the boundary in `simplex` to `mesh`.
    ///
    /// `formula`: pruned to primitives that change sign among the simplex' vertices; `frame`
    /// holds their coefficients.
    ///
    /// # Errors
    /// [`LeafError::TooManyPrimitives`] for more than 128 of them.
    pub(crate) fn extract(
        &mut self,
        simplex: &Simplex,
        formula: &[FormulaNode],
        frame: &Frame,
        mesh: &mut MeshBuilder,
    ) -> Result<(), LeafError> {
        self.cut = None;
        self.formula.load(formula);
        let count = self.formula.len();
        if count > MAX_LEAF_PRIMITIVES {
            return Err(LeafError::TooManyPrimitives(count));
        }
        let mut polynomials = arrayvec::ArrayVec::<_, MAX_LEAF_PRIMITIVES>::new();
        let mut values = arrayvec::ArrayVec::<_, MAX_LEAF_PRIMITIVES>::new();
        let mut primitives = arrayvec::ArrayVec::<_, MAX_LEAF_PRIMITIVES>::new();
        for active in &frame.active {
            if self
                .formula
                .primitives
                .binary_search(&active.primitive)
                .is_ok()
            {
                let polynomial = LeafPolynomial {
                    degree: active.degree as usize,
                    coefficients: frame.coefficients_of(active),
                };
                polynomials.push(polynomial);
                values.push(polynomial.vertex_values());
                primitives.push(active.primitive);
            }
        }
        let leaf = Leaf {
            simplex,
            planes: Planes {
                vertices: simplex.vertices,
                positive: simplex.is_positive(),
                primitives: &primitives,
                values: &values,
            },
            polynomials: &polynomials,
        };
        if count == 1 {
            self.extract_one(&leaf, mesh);
            return Ok(());
        }
        self.arrangement.clear();
        self.vertices.clear();
        self.triangulator.clear();
        let start = mesh.triangles.len();
        for own in 0..count {
            self.extract_polygon(&leaf, own, mesh);
        }
        if leaf.is_curved() && mesh.triangles.len() > start + 1 {
            let leaf = [start as u32, mesh.triangles.len() as u32];
            mesh.tangles.leaves.push(leaf);
        }
        Ok(())
    }

    /// The common case: one primitive, one triangle or quadrilateral.
    fn extract_one(&mut self, leaf: &Leaf<'_>, mesh: &mut MeshBuilder) {
        let (Some(label), Some((corners, count))) = (
            self.formula.label(0, 0),
            polygon(&leaf.planes.values[0], leaf.planes.positive),
        ) else {
            return;
        };
        let primitive = leaf.planes.primitives[0];
        let mut ring = [0; 4];
        for (slot, (ends, _)) in ring.iter_mut().zip(&corners[..count]) {
            *slot = leaf.edge_vertex(0, *ends, &mut self.vertices.snapper, mesh);
        }
        let [a, b, c, d] = ring;
        let p = ring.map(|v| mesh.positions[v as usize]);
        let part = |from: usize, to: usize| {
            // How far the corner on an edge is from its first end.
            let corners = corners[..count].iter();
            let at = |e: &[usize; 2]| *e == [from, to] || *e == [to, from];
            let found = corners.zip(p).find(|((ends, _), _)| at(ends));
            let ends = [from, to].map(|v| leaf.simplex.vertices[v].position());
            found.map_or(0.0, |(_, p)| {
                p.distance(ends[0]) / ends[1].distance(ends[0])
            })
        };
        let negative = leaf.planes.values[0].map(|v| vertex_sign(v) == Sign::Negative);
        let others = |v: usize| (0..4).filter(move |w| *w != v);
        if count == 3 {
            mesh.push_oriented([a, b, c], primitive, label);
            let alone = |v: &usize| others(*v).all(|w| negative[w] != negative[*v]);
            if let Some(apex) = (0..4).find(alone) {
                let cut: f64 = others(apex).map(|v| part(apex, v)).product();
                let fraction = if negative[apex] { cut } else { 1.0 - cut };
                self.cut = Some((fraction, label.sense));
            }
            return;
        }
        let first = if p[0].distance_squared(p[2]) <= p[1].distance_squared(p[3]) {
            mesh.push_oriented([a, b, c], primitive, label);
            mesh.push_oriented([a, c, d], primitive, label);
            corners[0].0
        } else {
            mesh.push_oriented([b, c, d], primitive, label);
            mesh.push_oriented([b, d, a], primitive, label);
            corners[1].0
        };
        // The diagonal joins the corners on u–w and v–x, with u and v on the negative side.
        let [u, w] = if negative[first[0]] {
            first
        } else {
            [first[1], first[0]]
        };
        let v = others(u).find(|v| negative[*v]).unwrap_or(u);
        let x = others(w).find(|x| !negative[*x]).unwrap_or(w);
        let fraction = wedge([part(u, w), part(u, x), part(v, w), part(v, x)]);
        self.cut = Some((fraction, label.sense));
    }

    fn extract_polygon(&mut self, leaf: &Leaf<'_>, own: usize, mesh: &mut MeshBuilder) {
        let mut arrangement = std::mem::take(&mut self.arrangement);
        let [inside, outside] = arrangement.begin(&leaf.planes, own);
        let crossing = !(inside | outside | 1 << own);
        let cutters = if leaf.is_curved() {
            // Vertices are held to the right side of all others.
            Some(crossing)
        } else {
            self.formula.deciding(own, inside, outside)
        };
        let Some(cutters) = cutters else {
            self.arrangement = arrangement;
            return;
        };
        arrangement.cut(&leaf.planes, own, cutters & crossing);
        self.complex
            .link(&arrangement, |pattern| self.formula.label(own, pattern));
        let polygon = LeafPolygon {
            leaf,
            arrangement: &arrangement,
            own,
        };
        let mut complex = std::mem::take(&mut self.complex);
        while let Some(label) = complex.next_component() {
            self.extract_component(&polygon, &complex, label, mesh);
        }
        self.complex = complex;
        self.arrangement = arrangement;
    }

    fn extract_component(
        &mut self,
        polygon: &LeafPolygon<'_>,
        complex: &CellComplex,
        label: Label,
        mesh: &mut MeshBuilder,
    ) {
        let mut boundary = std::mem::take(&mut self.boundary);
        if complex.is_simple(&mut boundary) {
            self.ring.clear();
            for &edge in &boundary {
                let side = complex.side(edge, polygon.arrangement);
                self.push_corner(polygon, side, true, false, mesh);
            }
            let ring = &mut self.ring;
            self.triangulator
                .triangulate(ring, polygon.piece(label), mesh);
        } else {
            self.extract_cells(polygon, complex, label, mesh);
        }
        self.boundary = boundary;
    }

    /// A piece with holes or one that touches itself: each of its cells alone.
    ///
    /// Vertices in facets that are not real become the leaf's own here, and a sliver of no area
    /// between them and the straight side that the neighbour sees closes the surface.
    fn extract_cells(
        &mut self,
        polygon: &LeafPolygon<'_>,
        complex: &CellComplex,
        label: Label,
        mesh: &mut MeshBuilder,
    ) {
        for cell in complex.cells() {
            self.ring.clear();
            for edge in cell {
                let side = complex.side(edge, polygon.arrangement);
                self.push_corner(polygon, side, complex.is_boundary(edge), true, mesh);
            }
            let ring = &mut self.ring;
            self.triangulator
                .triangulate(ring, polygon.piece(label), mesh);
        }
        for boundary in complex.boundaries() {
            self.close_slivers(polygon, complex, label, &boundary, mesh);
        }
    }

    /// Fills between a facet's straight side and the leaf's own vertices on it.
    fn close_slivers(
        &mut self,
        polygon: &LeafPolygon<'_>,
        complex: &CellComplex,
        label: Label,
        boundary: &[u32],
        mesh: &mut MeshBuilder,
    ) {
        let mut real = Vec::with_capacity(boundary.len());
        for &edge in boundary {
            let side = complex.side(edge, polygon.arrangement);
            let formula = &mut self.formula;
            let corner = self.vertices.real_vertex(formula, polygon, side, mesh);
            real.push(corner.map(|corner| corner.vertex));
        }
        let n = boundary.len();
        for start in 0..n {
            let Some(mut nearer) = real[start] else {
                continue;
            };
            let mut between = Vec::new();
            let mut at = (start + 1) % n;
            while real[at].is_none() && at != start {
                let from = complex.side(boundary[at], polygon.arrangement).from;
                between.push(self.vertices.local_vertex(polygon, from, mesh).vertex);
                at = (at + 1) % n;
            }
            let Some(end) = real[at] else { continue };
            for vertex in between {
                mesh.push_oriented([nearer, end, vertex], polygon.primitive(), label);
                nearer = vertex;
            }
        }
    }

    /// Appends the mesh vertex where a side begins, and one in its middle where needed.
    fn push_corner(
        &mut self,
        polygon: &LeafPolygon<'_>,
        side: CellSide,
        is_boundary: bool,
        keep_unreal: bool,
        mesh: &mut MeshBuilder,
    ) {
        let formula = &mut self.formula;
        let corner = match self.vertices.real_vertex(formula, polygon, side, mesh) {
            None if keep_unreal => Some(self.vertices.local_vertex(polygon, side.from, mesh)),
            corner => corner,
        };
        self.ring.extend(corner);
        if is_boundary {
            let middle = self.vertices.middle_vertex(formula, polygon, side, mesh);
            self.ring.extend(middle);
        }
    }
}
