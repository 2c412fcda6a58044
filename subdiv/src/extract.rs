//! The solid's boundary inside one leaf, as triangles over named vertices (thesis 3.3, 4.3).
//!
//! One primitive gives a triangle or quadrilateral. Several are arranged exactly; the formula
//! then tells for each cell of each primitive's polygon whether the solid lies on exactly one
//! side of it. Equal neighbouring cells are joined, so only real creases and corners remain, and
//! vertices in facets are kept only if the boundary really turns there: neighbours with
//! differently pruned formulas then agree on them.

use crate::arrange::{Arrangement, FACET, NO_PLANE, Planes, barycentric, polygon};
use crate::leaf_formula::{Label, LeafFormula, MAX_LEAF_PRIMITIVES, Pattern};
use crate::mesh::{MeshBuilder, Name};
use crate::polygon::{Corner, PieceTriangulator};
use crate::sheets::{Octants, quadrant_copy};
use crate::simplex::Simplex;
use csg::FormulaNode;
use glam::DVec3;

/// One half-edge of the labelled cells of a polygon.
#[derive(Clone, Copy, Debug)]
struct HalfEdge {
    from: u32,
    to: u32,
    plane: u16,
    cell: u32,
    /// Next one around the cell.
    next: u32,
    /// The opposite one in an equally labelled neighbour cell.
    twin: Option<u32>,
}

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
    values: Vec<[f64; 4]>,
    labels: Vec<Option<Label>>,
    half_edges: Vec<HalfEdge>,
    visited: Vec<bool>,
    component: Vec<u32>,
    ring: Vec<Corner>,
    /// Copies of corners: (arrangement vertex, inside sheet, outside sheet) → mesh vertex.
    corners: Vec<((u32, u8, u8), u32)>,
    /// Middles of checkerboard creases: (ends, primitives, inside quadrant) → mesh vertex.
    middles: Vec<(MiddleName, u32)>,
    /// Arrangement vertices in facets that only this leaf's pieces use.
    local: Vec<((u32, u16), u32)>,
    triangulator: PieceTriangulator,
}

/// Ends, primitives and inside quadrant of a crease that needs a vertex in its middle.
type MiddleName = ([u32; 2], [u16; 2], u8);

impl Extractor {
    /// Appends the boundary in `simplex` to `mesh`.
    ///
    /// `formula`: pruned to primitives that change sign among the simplex' vertices;
    /// `values(primitive)`: the vertex values of one of them.
    ///
    /// # Errors
    /// [`LeafError::TooManyPrimitives`] for more than 128 of them.
    pub(crate) fn extract(
        &mut self,
        simplex: &Simplex,
        formula: &[FormulaNode],
        values: impl Fn(u32) -> [f64; 4],
        mesh: &mut MeshBuilder,
    ) -> Result<(), LeafError> {
        self.formula.load(formula);
        let count = self.formula.len();
        if count > MAX_LEAF_PRIMITIVES {
            return Err(LeafError::TooManyPrimitives(count));
        }
        self.values.clear();
        self.values
            .extend(self.formula.primitives.iter().map(|p| values(*p)));
        if count == 1 {
            self.extract_one(simplex, mesh);
            return Ok(());
        }
        self.arrangement.clear();
        self.corners.clear();
        self.middles.clear();
        self.local.clear();
        self.triangulator.clear();
        for own in 0..count {
            self.extract_polygon(simplex, own, mesh);
        }
        Ok(())
    }

    /// The common case: one primitive, one triangle or quadrilateral.
    fn extract_one(&mut self, simplex: &Simplex, mesh: &mut MeshBuilder) {
        let values = self.values[0];
        let (Some(label), Some((corners, count))) = (
            self.formula.label(0, 0),
            polygon(&values, simplex.is_positive()),
        ) else {
            return;
        };
        let primitive = self.formula.primitives[0];
        let vertex = |mesh: &mut MeshBuilder, [p, q]: [usize; 2]| {
            let end = |v: usize| (simplex.vertices[v], values[v]);
            mesh.edge_vertex(end(p), end(q), primitive)
        };
        let mut ring = [0; 4];
        for (slot, corner) in ring.iter_mut().zip(&corners[..count]) {
            *slot = vertex(mesh, corner.0);
        }
        let [a, b, c, d] = ring;
        if count == 3 {
            mesh.push_oriented([a, b, c], primitive, label);
            return;
        }
        let p = [a, b, c, d].map(|v| mesh.positions[v as usize]);
        if p[0].distance_squared(p[2]) <= p[1].distance_squared(p[3]) {
            mesh.push_oriented([a, b, c], primitive, label);
            mesh.push_oriented([a, c, d], primitive, label);
        } else {
            mesh.push_oriented([b, c, d], primitive, label);
            mesh.push_oriented([b, d, a], primitive, label);
        }
    }

    fn extract_polygon(&mut self, simplex: &Simplex, own: usize, mesh: &mut MeshBuilder) {
        // The arrangement and the values are borrowed apart from the rest of `self`.
        let mut arrangement = std::mem::take(&mut self.arrangement);
        let values = std::mem::take(&mut self.values);
        let primitives = std::mem::take(&mut self.formula.primitives);
        let planes = Planes {
            vertices: simplex.vertices,
            positive: simplex.is_positive(),
            primitives: &primitives,
            values: &values,
        };
        arrangement.arrange(&planes, own);
        self.formula.primitives.clone_from(&primitives);
        self.labels.clear();
        for cell in arrangement.cells() {
            self.labels.push(self.formula.label(own, cell.pattern));
        }
        if self.labels.iter().any(Option::is_some) {
            self.link_cells(&arrangement);
            let leaf = LeafPolygon {
                planes: &planes,
                arrangement: &arrangement,
                own,
            };
            self.extract_components(&leaf, mesh);
        }
        self.arrangement = arrangement;
        self.values = values;
    }

    /// Lists the half-edges of all labelled cells and pairs those between equal labels.
    fn link_cells(&mut self, arrangement: &Arrangement) {
        self.half_edges.clear();
        for (at, cell) in arrangement.cells().iter().enumerate() {
            if self.labels[at].is_none() {
                continue;
            }
            let sides = arrangement.sides(cell);
            let first = self.half_edges.len() as u32;
            for (s, side) in sides.iter().enumerate() {
                let next = (s + 1) % sides.len();
                self.half_edges.push(HalfEdge {
                    from: side.from,
                    to: sides[next].from,
                    plane: side.plane,
                    cell: at as u32,
                    next: first + next as u32,
                    twin: None,
                });
            }
        }
        for a in 0..self.half_edges.len() {
            let edge = self.half_edges[a];
            if edge.plane >= FACET || edge.twin.is_some() {
                continue;
            }
            let twin = (a + 1..self.half_edges.len()).find(|&b| {
                let other = &self.half_edges[b];
                other.from == edge.to && other.to == edge.from
            });
            let Some(b) = twin else { continue };
            let cells = [edge.cell, self.half_edges[b].cell];
            if self.labels[cells[0] as usize] == self.labels[cells[1] as usize] {
                self.half_edges[a].twin = Some(b as u32);
                self.half_edges[b].twin = Some(a as u32);
            }
        }
    }

    /// Emits each connected set of equally labelled cells.
    fn extract_components(&mut self, leaf: &LeafPolygon<'_>, mesh: &mut MeshBuilder) {
        self.visited.clear();
        self.visited.resize(self.half_edges.len(), false);
        for start in 0..self.half_edges.len() {
            if self.visited[start] {
                continue;
            }
            self.collect_component(start as u32);
            let cell = self.half_edges[start].cell as usize;
            if let Some(label) = self.labels[cell] {
                self.extract_component(leaf, label, mesh);
            }
        }
    }

    /// All half-edges of the cells joined to that of `start`, which become visited.
    fn collect_component(&mut self, start: u32) {
        self.component.clear();
        self.component.push(start);
        self.visited[start as usize] = true;
        let mut at = 0;
        while at < self.component.len() {
            let edge = self.half_edges[self.component[at] as usize];
            for next in [Some(edge.next), edge.twin].into_iter().flatten() {
                if !self.visited[next as usize] {
                    self.visited[next as usize] = true;
                    self.component.push(next);
                }
            }
            at += 1;
        }
        self.component.sort_unstable();
    }

    fn extract_component(&mut self, leaf: &LeafPolygon<'_>, label: Label, mesh: &mut MeshBuilder) {
        let boundary = self
            .component
            .iter()
            .filter(|e| self.half_edges[**e as usize].twin.is_none())
            .count();
        let first = self
            .component
            .iter()
            .copied()
            .find(|e| self.half_edges[*e as usize].twin.is_none());
        let Some(first) = first else { return };
        let loop_edges = self.trace_loop(first);
        let mut seen: Vec<u32> = loop_edges
            .iter()
            .map(|e| self.half_edges[*e as usize].from)
            .collect();
        seen.sort_unstable();
        let simple = loop_edges.len() == boundary && seen.windows(2).all(|w| w[0] != w[1]);
        if simple {
            let mut ring = std::mem::take(&mut self.ring);
            ring.clear();
            for &e in &loop_edges {
                self.push_corner(leaf, e, false, &mut ring, mesh);
            }
            self.triangulator
                .triangulate(&mut ring, leaf.piece(label), mesh);
            self.ring = ring;
        } else {
            self.extract_cells(leaf, label, mesh);
        }
    }

    /// A piece with holes or one that touches itself: each of its cells alone.
    ///
    /// Vertices in facets that are not real become the leaf's own here, and a sliver of no area
    /// between them and the straight side that the neighbour sees closes the surface.
    fn extract_cells(&mut self, leaf: &LeafPolygon<'_>, label: Label, mesh: &mut MeshBuilder) {
        let component = self.component.clone();
        let mut ring = std::mem::take(&mut self.ring);
        let mut done = vec![false; self.half_edges.len()];
        for &start in &component {
            if done[start as usize] {
                continue;
            }
            ring.clear();
            let mut at = start;
            loop {
                done[at as usize] = true;
                self.push_corner(leaf, at, true, &mut ring, mesh);
                at = self.half_edges[at as usize].next;
                if at == start {
                    break;
                }
            }
            self.triangulator
                .triangulate(&mut ring, leaf.piece(label), mesh);
        }
        done.fill(false);
        for &start in &component {
            if done[start as usize] || self.half_edges[start as usize].twin.is_some() {
                continue;
            }
            let edges = self.trace_loop(start);
            for e in &edges {
                done[*e as usize] = true;
            }
            self.close_slivers(leaf, label, &edges, mesh);
        }
        self.ring = ring;
    }

    /// Fills between a facet's straight side and the leaf's own vertices on it.
    fn close_slivers(
        &mut self,
        leaf: &LeafPolygon<'_>,
        label: Label,
        edges: &[u32],
        mesh: &mut MeshBuilder,
    ) {
        let real: Vec<Option<u32>> = edges
            .iter()
            .map(|e| self.real_vertex(leaf, *e, mesh))
            .collect();
        let n = edges.len();
        for start in 0..n {
            let Some(a) = real[start] else { continue };
            let mut between = Vec::new();
            let mut at = (start + 1) % n;
            while real[at].is_none() && at != start {
                let vertex = self.half_edges[edges[at] as usize].from;
                between.push(self.local_vertex(leaf, vertex, mesh));
                at = (at + 1) % n;
            }
            let Some(b) = real[at] else { continue };
            for pair in 0..between.len() {
                let nearer = if pair == 0 { a } else { between[pair - 1] };
                mesh.push_oriented([nearer, b, between[pair]], leaf.primitive(), label);
            }
        }
    }

    /// The boundary half-edges that follow each other around the component, from `first`.
    fn trace_loop(&self, first: u32) -> Vec<u32> {
        let mut edges = vec![first];
        loop {
            let mut next = self.half_edges[edges[edges.len() - 1] as usize].next;
            while let Some(twin) = self.half_edges[next as usize].twin {
                next = self.half_edges[twin as usize].next;
            }
            if next == first {
                return edges;
            }
            edges.push(next);
        }
    }

    /// Appends the mesh vertex at a half-edge's origin, and one in its middle where needed.
    fn push_corner(
        &mut self,
        leaf: &LeafPolygon<'_>,
        edge: u32,
        keep_unreal: bool,
        ring: &mut Vec<Corner>,
        mesh: &mut MeshBuilder,
    ) {
        let HalfEdge { from, twin, .. } = self.half_edges[edge as usize];
        let planes = leaf.arrangement.vertex(from).planes;
        let vertex = match self.real_vertex(leaf, edge, mesh) {
            None if keep_unreal => Some(self.local_vertex(leaf, from, mesh)),
            vertex => vertex,
        };
        if let Some(vertex) = vertex {
            ring.push(Corner { vertex, planes });
        }
        if twin.is_none()
            && let Some(corner) = self.middle_vertex(leaf, edge, mesh)
        {
            ring.push(corner);
        }
    }

    /// The mesh vertex at a half-edge's origin as seen from its cell; `None` where the boundary
    /// passes straight through a facet's arrangement vertex.
    fn real_vertex(
        &mut self,
        leaf: &LeafPolygon<'_>,
        edge: u32,
        mesh: &mut MeshBuilder,
    ) -> Option<u32> {
        let HalfEdge { from, cell, .. } = self.half_edges[edge as usize];
        let pattern = leaf.arrangement.cells()[cell as usize].pattern;
        let planes = leaf.arrangement.vertex(from).planes;
        match planes.iter().filter(|p| **p < FACET).count() {
            1 => Some(leaf.edge_vertex(planes, mesh)),
            2 => self.facet_vertex(leaf, planes, pattern, mesh),
            _ => Some(self.corner_vertex(leaf, from, pattern, mesh)),
        }
    }

    fn facet_vertex(
        &mut self,
        leaf: &LeafPolygon<'_>,
        planes: [u16; 3],
        pattern: Pattern,
        mesh: &mut MeshBuilder,
    ) -> Option<u32> {
        let [i, j] = [planes[0], planes[1]].map(usize::from);
        let other = if i == leaf.own { j } else { i };
        let bit = |p: usize| 1 << p;
        let real = self.formula.label(i, pattern & !bit(j))
            != self.formula.label(i, pattern | bit(j))
            || self.formula.label(j, pattern & !bit(i)) != self.formula.label(j, pattern | bit(i));
        if !real {
            return None;
        }
        let quadrants = [0, 1, 2, 3].map(|q: u8| {
            let base = pattern & !bit(i) & !bit(j);
            let set = base | Pattern::from(q & 1) << i | Pattern::from(q >> 1) << j;
            self.formula.value(set)
        });
        // The inside quadrant at this cell: on its side of `other`, inside or outside of `own`.
        let side = u8::from(pattern >> other & 1 == 1);
        let of = |own_inside: u8| {
            if leaf.own == i {
                own_inside | side << 1
            } else {
                side | own_inside << 1
            }
        };
        let here = if quadrants[usize::from(of(1))] {
            of(1)
        } else {
            of(0)
        };
        let facet = usize::from(planes[2] - FACET);
        let mut sum = [0; 3];
        for (at, vertex) in leaf.planes.vertices.iter().enumerate() {
            if at != facet {
                let c = vertex.coordinates();
                sum = [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]];
            }
        }
        let name = Name::Facet {
            sum,
            primitives: [leaf.planes.primitives[i], leaf.planes.primitives[j]],
            copy: quadrant_copy(quadrants, here),
        };
        Some(mesh.facet_vertex(name, || leaf.position(planes)))
    }

    fn corner_vertex(
        &mut self,
        leaf: &LeafPolygon<'_>,
        vertex: u32,
        pattern: Pattern,
        mesh: &mut MeshBuilder,
    ) -> u32 {
        let planes = leaf.arrangement.vertex(vertex).planes;
        let octants = self.octants(planes, pattern);
        let (inside, outside) = octants.sheet(octant(planes, leaf.own, pattern));
        let key = (vertex, inside, outside);
        if let Some((_, found)) = self.corners.iter().find(|(k, _)| *k == key) {
            return *found;
        }
        let position = leaf.position(planes);
        let created = mesh.interior_vertex(position);
        mesh.split_vertices +=
            u64::from(self.corners.iter().any(|((other, ..), _)| *other == vertex));
        self.corners.push((key, created));
        created
    }

    fn octants(&mut self, planes: [u16; 3], pattern: Pattern) -> Octants {
        let mut base = pattern;
        for plane in planes {
            base &= !(1 << plane);
        }
        Octants::new([0, 1, 2, 3, 4, 5, 6, 7].map(|octant: u8| {
            let mut set = base;
            for (bit, plane) in planes.into_iter().enumerate() {
                set |= Pattern::from(octant >> bit & 1) << plane;
            }
            self.formula.value(set)
        }))
    }

    /// The vertex in the middle of a crease along which four sheets meet, when neither end is
    /// split into one copy for each inside quadrant.
    fn middle_vertex(
        &mut self,
        leaf: &LeafPolygon<'_>,
        edge: u32,
        mesh: &mut MeshBuilder,
    ) -> Option<Corner> {
        let HalfEdge {
            from,
            to,
            plane,
            cell,
            ..
        } = self.half_edges[edge as usize];
        if plane >= FACET {
            return None;
        }
        let (own, other) = (leaf.own, usize::from(plane));
        let pattern = leaf.arrangement.cells()[cell as usize].pattern;
        let value = |this: &mut Self, flip_other: bool, own_inside: bool| {
            let flipped = pattern ^ (Pattern::from(flip_other) << other);
            this.formula
                .value(flipped & !(1 << own) | Pattern::from(own_inside) << own)
        };
        let here = value(self, false, true);
        if here == value(self, false, false)
            || here != value(self, true, false)
            || here == value(self, true, true)
        {
            return None;
        }
        // Both inside quadrants reach an unsplit end in one sheet.
        for end in [from, to] {
            let planes = leaf.arrangement.vertex(end).planes;
            if planes[2] >= FACET {
                return None;
            }
            let octants = self.octants(planes, pattern);
            let this_side = octant(planes, own, pattern);
            let that_side = octant(planes, own, pattern ^ (1 << other));
            if octants.sheet(this_side) != octants.sheet(that_side) {
                return None;
            }
        }
        let lower = own.min(other);
        let side = u8::from(pattern >> other & 1 == 1);
        let quadrant = if lower == own {
            u8::from(here) | side << 1
        } else {
            side | u8::from(here) << 1
        };
        let primitives = [lower as u16, own.max(other) as u16];
        let name = ([from.min(to), from.max(to)], primitives, quadrant);
        let planes = [primitives[0], primitives[1], NO_PLANE];
        if let Some((_, vertex)) = self.middles.iter().find(|(n, _)| *n == name) {
            return Some(Corner {
                vertex: *vertex,
                planes,
            });
        }
        let ends = [from, to].map(|v| leaf.position(leaf.arrangement.vertex(v).planes));
        let vertex = mesh.interior_vertex((ends[0] + ends[1]) * 0.5);
        mesh.split_vertices += 1;
        self.middles.push((name, vertex));
        Some(Corner { vertex, planes })
    }

    fn local_vertex(&mut self, leaf: &LeafPolygon<'_>, vertex: u32, mesh: &mut MeshBuilder) -> u32 {
        let key = (vertex, leaf.own as u16);
        if let Some((_, found)) = self.local.iter().find(|(k, _)| *k == key) {
            return *found;
        }
        let position = leaf.position(leaf.arrangement.vertex(vertex).planes);
        let created = mesh.interior_vertex(position);
        self.local.push((key, created));
        created
    }
}

/// The two octants, one inside the solid, that a cell of primitive `own` separates at a corner.
fn octant(planes: [u16; 3], own: usize, pattern: Pattern) -> [u8; 2] {
    let mut base = 0;
    let mut own_bit = 0;
    for (bit, plane) in planes.into_iter().enumerate() {
        if usize::from(plane) == own {
            own_bit = 1 << bit;
        } else {
            base |= u8::from(pattern >> plane & 1 == 1) << bit;
        }
    }
    [base, base | own_bit]
}

/// One primitive's polygon in the leaf at hand.
struct LeafPolygon<'a> {
    planes: &'a Planes<'a>,
    arrangement: &'a Arrangement,
    own: usize,
}

impl LeafPolygon<'_> {
    fn primitive(&self) -> u32 {
        self.planes.primitives[self.own]
    }

    fn piece(&self, label: Label) -> (u16, u32, Label) {
        (self.own as u16, self.primitive(), label)
    }

    /// Position of an arrangement vertex, in the domain's own coordinates.
    fn position(&self, planes: [u16; 3]) -> DVec3 {
        let corners = self.planes.vertices.map(crate::lattice::Point::position);
        let b = barycentric(self.planes, planes).unwrap_or_else(|| {
            // All minors vanish: the planes coincide on the face. Any of its points will do.
            let on = |v: u16| !planes.contains(&(FACET + v));
            let weights = [0, 1, 2, 3].map(|v| f64::from(u8::from(on(v))));
            let sum: f64 = weights.iter().sum();
            weights.map(|w| w / sum)
        });
        (0..4).map(|v| corners[v] * b[v]).sum()
    }

    fn edge_vertex(&self, planes: [u16; 3], mesh: &mut MeshBuilder) -> u32 {
        let primitive = usize::from(planes[0]);
        let mut ends = (0..4u16)
            .filter(|v| !planes.contains(&(FACET + v)))
            .map(usize::from);
        let (p, q) = (ends.next().unwrap_or(0), ends.next().unwrap_or(0));
        let end = |v: usize| (self.planes.vertices[v], self.planes.values[primitive][v]);
        mesh.edge_vertex(end(p), end(q), self.planes.primitives[primitive])
    }
}
