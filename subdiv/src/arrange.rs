//! The exact arrangement of a few planes in one leaf (thesis 3.3; every polynomial there is
//! replaced by its affine interpolant).
//!
//! Each primitive's zero plane is a convex polygon in the simplex, which the other primitives'
//! planes cut into convex cells. All decisions come from [`crate::predicates`]; coordinates are
//! never looked at.
//!
//! Planes of a leaf are numbered: 0 ‥ n are the primitives in the order of their global
//! indices, [`FACET`] + m is the simplex' facet opposite to vertex m. A vertex is the
//! intersection of three planes and is named by them: (primitive, facet, facet) on an edge,
//! (primitive, primitive, facet) in a facet, three primitives inside.

use crate::lattice::Point;
use crate::leaf_formula::Pattern;
use crate::predicates::{Minor, Sign, clear_sign, minor_sign, vertex_sign};
use rustc_hash::FxHashMap;

/// Number of the first facet's plane.
pub(crate) const FACET: u16 = 1 << 12;

/// No plane: fills the name of a vertex that lies on fewer than three.
pub(crate) const NO_PLANE: u16 = u16::MAX;

/// What the arrangement is made of: vertex values of the primitives that cross a simplex.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes<'a> {
    /// The simplex' vertices.
    pub vertices: [Point; 4],
    /// Whether they are a right-handed frame.
    pub positive: bool,
    /// Global index of each primitive, ascending.
    pub primitives: &'a [u32],
    /// Value of each primitive at each vertex.
    pub values: &'a [[f64; 4]],
}

/// A vertex of the arrangement.
#[derive(Clone, Debug)]
pub(crate) struct ArrangementVertex {
    /// The three planes, ascending.
    pub planes: [u16; 3],
    /// Their [`support`].
    rows: Indices,
    columns: Indices,
    /// Sign that makes its homogeneous barycentric coordinates positive.
    normalization: Sign,
}

/// A side of a cell.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Side {
    /// Its first vertex, in the cell's counter-clockwise order.
    pub from: u32,
    /// The plane, besides the polygon's own, on which the side lies.
    pub plane: u16,
}

/// A convex cell of one primitive's polygon.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cell {
    /// The other primitives inside whose half-space it lies; the polygon's own bit is unset.
    pub pattern: Pattern,
    start: u32,
    len: u32,
}

/// Work space for the arrangements of one leaf after the other.
#[derive(Debug, Default)]
pub(crate) struct Arrangement {
    vertices: Vec<ArrangementVertex>,
    names: FxHashMap<[u16; 3], u32>,
    cells: Vec<Cell>,
    sides: Vec<Side>,
    next_cells: Vec<Cell>,
    next_sides: Vec<Side>,
    /// Side of the current cutting plane for each vertex, stamped with the cut's number.
    cut_sign: Vec<(u32, Sign)>,
    cut: u32,
}

impl Arrangement {
    /// Forgets the last leaf.
    pub(crate) fn clear(&mut self) {
        self.vertices.clear();
        self.names.clear();
        self.cut_sign.clear();
    }

    /// All vertices found so far in this leaf.
    pub(crate) fn vertex(&self, index: u32) -> &ArrangementVertex {
        &self.vertices[index as usize]
    }

    /// The cells of the last polygon.
    pub(crate) fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// The sides of a cell of the last polygon, counter-clockwise seen from where its primitive
    /// is positive.
    pub(crate) fn sides(&self, cell: &Cell) -> &[Side] {
        &self.sides[cell.start as usize..(cell.start + cell.len) as usize]
    }

    /// Begins with the whole polygon of primitive `own`; returns the others inside and those
    /// outside of which it lies.
    pub(crate) fn begin(&mut self, planes: &Planes<'_>, own: usize) -> [Pattern; 2] {
        self.start_polygon(planes, own);
        let [mut inside, mut outside]: [Pattern; 2] = [0; 2];
        for other in (0..planes.primitives.len()).filter(|other| *other != own) {
            self.cut += 1;
            let mut signs = [false; 2];
            for at in 0..self.sides.len() {
                let sign = self.side_of(planes, self.sides[at].from, other);
                signs[usize::from(sign == Sign::Negative)] = true;
            }
            match signs {
                [false, true] => inside |= 1 << other,
                [true, false] => outside |= 1 << other,
                _ => {}
            }
        }
        for cell in &mut self.cells {
            cell.pattern = inside;
        }
        [inside, outside]
    }

    /// Cuts the polygon of primitive `own` by those in `cutters`.
    pub(crate) fn cut(&mut self, planes: &Planes<'_>, own: usize, cutters: Pattern) {
        for other in 0..planes.primitives.len() {
            if cutters >> other & 1 == 1 {
                self.cut_cells(planes, own, other);
            }
        }
    }

    /// The whole polygon: a triangle or quadrilateral between the simplex' edges.
    fn start_polygon(&mut self, planes: &Planes<'_>, own: usize) {
        self.cells.clear();
        self.sides.clear();
        let Some((corners, count)) = polygon(&planes.values[own], planes.positive) else {
            return;
        };
        for &(edge, across) in &corners[..count] {
            // The edge p–q lies in the facets opposite to the two other vertices.
            let mut others = (0..4u16).filter(|v| !edge.contains(&usize::from(*v)));
            let facets = [others.next().unwrap_or(0), others.next().unwrap_or(0)];
            let name = [own as u16, FACET + facets[0], FACET + facets[1]];
            let from = self.find_vertex(planes, name);
            self.sides.push(Side {
                from,
                plane: FACET + across as u16,
            });
        }
        self.cells.push(Cell {
            pattern: 0,
            start: 0,
            len: count as u32,
        });
    }

    fn cut_cells(&mut self, planes: &Planes<'_>, own: usize, other: usize) {
        self.cut += 1;
        self.next_cells.clear();
        self.next_sides.clear();
        let cells = std::mem::take(&mut self.cells);
        let sides = std::mem::take(&mut self.sides);
        for cell in &cells {
            let ring = &sides[cell.start as usize..(cell.start + cell.len) as usize];
            let sign = |this: &mut Self, at: usize| this.side_of(planes, ring[at].from, other);
            let first = sign(self, 0);
            // Leaving `first`'s side at `out`, coming back at `back`: a convex ring does so once.
            let mut out = None;
            let mut back = None;
            for at in 1..ring.len() {
                let here = sign(self, at);
                if out.is_none() && here != first {
                    out = Some(at);
                } else if out.is_some() && back.is_none() && here == first {
                    back = Some(at);
                }
            }
            let Some(out) = out else {
                self.push_cell(cell, other, first, ring.iter().copied());
                continue;
            };
            let back = back.unwrap_or(ring.len());
            let crossing = |this: &mut Self, plane: u16| {
                let mut name = [own as u16, other as u16, plane];
                name.sort_unstable();
                this.find_vertex(planes, name)
            };
            let leaving = crossing(self, ring[out - 1].plane);
            let coming = crossing(self, ring[back - 1].plane);
            let line = other as u16;
            let cut_side = |from, plane| std::iter::once(Side { from, plane });
            let kept = ring[..out]
                .iter()
                .copied()
                .chain(cut_side(leaving, line))
                .chain(cut_side(coming, ring[back - 1].plane))
                .chain(ring[back..].iter().copied());
            self.push_cell(cell, other, first, kept);
            let cut_off = cut_side(leaving, ring[out - 1].plane)
                .chain(ring[out..back].iter().copied())
                .chain(cut_side(coming, line));
            let opposite = first.times(Sign::Negative);
            self.push_cell(cell, other, opposite, cut_off);
        }
        // The old buffers serve the next cut.
        self.cells = std::mem::replace(&mut self.next_cells, cells);
        self.sides = std::mem::replace(&mut self.next_sides, sides);
    }

    fn push_cell(
        &mut self,
        from: &Cell,
        other: usize,
        sign: Sign,
        ring: impl Iterator<Item = Side>,
    ) {
        let start = self.next_sides.len();
        self.next_sides.extend(ring);
        let inside = Pattern::from(sign == Sign::Negative);
        self.next_cells.push(Cell {
            pattern: from.pattern | inside << other,
            start: start as u32,
            len: (self.next_sides.len() - start) as u32,
        });
    }

    fn find_vertex(&mut self, planes: &Planes<'_>, name: [u16; 3]) -> u32 {
        if let Some(&found) = self.names.get(&name) {
            return found;
        }
        let index = self.vertices.len() as u32;
        let (rows, columns) = support(name);
        let normalization = normalization(planes, &rows, &columns);
        self.vertices.push(ArrangementVertex {
            planes: name,
            rows,
            columns,
            normalization,
        });
        self.cut_sign.push((0, Sign::Positive));
        self.names.insert(name, index);
        index
    }

    /// On which side of primitive `other` a vertex lies.
    fn side_of(&mut self, planes: &Planes<'_>, vertex: u32, other: usize) -> Sign {
        let (stamp, known) = self.cut_sign[vertex as usize];
        if stamp == self.cut {
            return known;
        }
        let ArrangementVertex {
            rows,
            columns,
            normalization,
            ..
        } = &self.vertices[vertex as usize];
        if let (&[row], &[a, b]) = (&rows[..], &columns[..]) {
            // On an edge of the simplex: most of all calls, and few are close.
            let (own, across) = (&planes.values[row], &planes.values[other]);
            let (p, q) = (own[a] * across[b], own[b] * across[a]);
            if let Some(sign) = clear_sign(p - q, p.abs() + q.abs()) {
                let sign = sign.times(*normalization);
                self.cut_sign[vertex as usize] = (self.cut, sign);
                return sign;
            }
        }
        let mut minor = select(planes, rows, columns);
        minor.order += 1;
        minor.rows[minor.order - 1] = planes.primitives[other];
        for (at, &column) in columns.iter().enumerate() {
            minor.entries[minor.order - 1][at] = planes.values[other][column];
        }
        let sign = minor_sign(&minor).times(*normalization);
        self.cut_sign[vertex as usize] = (self.cut, sign);
        sign
    }
}

/// A list of at most four indices of primitives or simplex vertices.
pub(crate) type Indices = arrayvec::ArrayVec<usize, 4>;

/// The primitives through a vertex, and the simplex vertices of the face in which it lies.
pub(crate) fn support(name: [u16; 3]) -> (Indices, Indices) {
    let mut rows = Indices::default();
    let mut on_face = [true; 4];
    for plane in name {
        if plane < FACET {
            rows.push(usize::from(plane));
        } else {
            on_face[usize::from(plane - FACET)] = false;
        }
    }
    let mut columns = Indices::default();
    for (vertex, on) in on_face.into_iter().enumerate() {
        if on {
            columns.push(vertex);
        }
    }
    (rows, columns)
}

/// The matrix with these rows and columns; its order is the number of rows.
fn select(planes: &Planes<'_>, rows: &[usize], columns: &[usize]) -> Minor {
    let mut minor = Minor {
        order: rows.len(),
        entries: [[0.0; 4]; 4],
        rows: [0; 4],
        columns: planes.vertices,
    };
    for (r, &row) in rows.iter().enumerate() {
        minor.rows[r] = planes.primitives[row];
        for (c, &column) in columns.iter().enumerate() {
            minor.entries[r][c] = planes.values[row][column];
        }
    }
    for (c, &column) in columns.iter().enumerate() {
        minor.columns[c] = planes.vertices[column];
    }
    minor
}

/// Sign of the cofactor that is the vertex' first homogeneous barycentric coordinate.
///
/// Expanding `det [R; f_j]` along its last row gives Σ_c f_jc · (−1)^(r+c) M_c, so with
/// `b_c = (−1)^(r+c) M_c` the determinant is the value of j at b; all b_c have one sign, since the
/// vertex lies in the face.
fn normalization(planes: &Planes<'_>, rows: &[usize], columns: &[usize]) -> Sign {
    let minor = select(planes, rows, &columns[1..]);
    minor_sign(&minor).times(Sign::of(rows.len().is_multiple_of(2)))
}

/// An edge of the simplex that a polygon's vertex lies on, and the facet (by its opposite
/// vertex) through which the polygon's boundary goes on from there.
pub(crate) type PolygonCorner = ([usize; 2], usize);

/// The zero set of one affine function in a simplex: three or four corners, counter-clockwise
/// seen from its positive side; `None` when all vertex signs agree.
#[must_use]
pub(crate) fn polygon(values: &[f64; 4], positive: bool) -> Option<([PolygonCorner; 4], usize)> {
    let mut inside = [0; 4];
    let mut outside = [0; 4];
    let (mut ins, mut outs) = (0, 0);
    for (vertex, value) in values.iter().enumerate() {
        if vertex_sign(*value) == Sign::Negative {
            inside[ins] = vertex;
            ins += 1;
        } else {
            outside[outs] = vertex;
            outs += 1;
        }
    }
    let order = match ins {
        1 => [inside[0], outside[0], outside[1], outside[2]],
        2 => [inside[0], inside[1], outside[0], outside[1]],
        3 => [outside[0], inside[0], inside[1], inside[2]],
        _ => return None,
    };
    let mut inversions = 0;
    for i in 0..4 {
        for j in i + 1..4 {
            inversions += usize::from(order[i] > order[j]);
        }
    }
    let [a, b, c, d] = order;
    // Right as written for an even order in a positive simplex with `a` (or a, b) inside.
    let forward = (inversions % 2 == 0) == positive;
    Some(if ins == 2 {
        let ring = if forward {
            [([a, c], b), ([a, d], c), ([b, d], a), ([b, c], d)]
        } else {
            [([a, c], d), ([b, c], a), ([b, d], c), ([a, d], b)]
        };
        (ring, 4)
    } else {
        let ring = if forward == (ins == 1) {
            [([a, b], d), ([a, c], b), ([a, d], c), ([a, a], a)]
        } else {
            [([a, b], c), ([a, d], b), ([a, c], d), ([a, a], a)]
        };
        (ring, 3)
    })
}
