//! The boundary pieces on one primitive's polygon: connected sets of equally labelled cells, and
//! the loops around them.

use crate::arrange::{Arrangement, FACET};
use crate::leaf_formula::{Label, Pattern};
use crate::vertices::CellSide;

/// One half-edge of the labelled cells.
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

/// The labelled cells of one polygon, linked by half-edges.
#[derive(Debug, Default)]
pub(crate) struct CellComplex {
    labels: Vec<Option<Label>>,
    half_edges: Vec<HalfEdge>,
    visited: Vec<bool>,
    scan: usize,
    /// Half-edges of the component at hand, ascending.
    component: Vec<u32>,
}

impl CellComplex {
    /// Lists the half-edges of all labelled cells and pairs those between equal labels.
    pub(crate) fn link(
        &mut self,
        arrangement: &Arrangement,
        mut label: impl FnMut(Pattern) -> Option<Label>,
    ) {
        self.labels.clear();
        self.half_edges.clear();
        for (at, cell) in arrangement.cells().iter().enumerate() {
            self.labels.push(label(cell.pattern));
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
        self.pair_twins();
        self.visited.clear();
        self.visited.resize(self.half_edges.len(), false);
        self.scan = 0;
    }

    fn pair_twins(&mut self) {
        for a in 0..self.half_edges.len() {
            let edge = self.half_edges[a];
            if edge.plane >= FACET || edge.twin.is_some() {
                continue;
            }
            let opposite = |b: &usize| {
                let other = &self.half_edges[*b];
                other.from == edge.to && other.to == edge.from
            };
            let Some(b) = (a + 1..self.half_edges.len()).find(opposite) else {
                continue;
            };
            let label = |cell: u32| self.labels[cell as usize];
            if label(edge.cell) == label(self.half_edges[b].cell) {
                self.half_edges[a].twin = Some(b as u32);
                self.half_edges[b].twin = Some(a as u32);
            }
        }
    }

    /// Goes on to the next connected set of cells; their common label.
    pub(crate) fn next_component(&mut self) -> Option<Label> {
        while *self.visited.get(self.scan)? {
            self.scan += 1;
        }
        self.component.clear();
        self.component.push(self.scan as u32);
        self.visited[self.scan] = true;
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
        self.labels[self.half_edges[self.scan].cell as usize]
    }

    /// Finds the component's boundary; whether it is one loop that passes no vertex twice.
    pub(crate) fn is_simple(&self, boundary: &mut Vec<u32>) -> bool {
        let mut edges = self.component.iter().filter(|e| self.is_boundary(**e));
        let Some(&first) = edges.next() else {
            return false;
        };
        self.trace(first, boundary);
        boundary.len() == edges.count() + 1
            && boundary.iter().enumerate().all(|(at, a)| {
                let from = |e: u32| self.half_edges[e as usize].from;
                boundary[..at].iter().all(|b| from(*a) != from(*b))
            })
    }

    /// All boundary loops of the component.
    pub(crate) fn boundaries(&self) -> Vec<Vec<u32>> {
        let mut loops: Vec<Vec<u32>> = Vec::new();
        for &edge in self.component.iter().filter(|e| self.is_boundary(**e)) {
            if !loops.iter().any(|known| known.contains(&edge)) {
                let mut boundary = Vec::new();
                self.trace(edge, &mut boundary);
                loops.push(boundary);
            }
        }
        loops
    }

    /// The half-edges of each cell of the component, in order.
    pub(crate) fn cells(&self) -> Vec<Vec<u32>> {
        let of_cell = |edge: u32| self.half_edges[edge as usize].cell;
        self.component
            .chunk_by(|a, b| of_cell(*a) == of_cell(*b))
            .map(<[u32]>::to_vec)
            .collect()
    }

    /// Whether a half-edge bounds its component.
    pub(crate) fn is_boundary(&self, edge: u32) -> bool {
        self.half_edges[edge as usize].twin.is_none()
    }

    /// A half-edge with its cell's pattern.
    pub(crate) fn side(&self, edge: u32, arrangement: &Arrangement) -> CellSide {
        let edge = &self.half_edges[edge as usize];
        CellSide {
            from: edge.from,
            to: edge.to,
            plane: edge.plane,
            pattern: arrangement.cells()[edge.cell as usize].pattern,
        }
    }

    /// The boundary half-edges that follow each other around the component, from `first`.
    fn trace(&self, first: u32, edges: &mut Vec<u32>) {
        edges.clear();
        edges.push(first);
        let mut at = first;
        loop {
            at = self.half_edges[at as usize].next;
            while let Some(twin) = self.half_edges[at as usize].twin {
                at = self.half_edges[twin as usize].next;
            }
            if at == first {
                return;
            }
            edges.push(at);
        }
    }
}
