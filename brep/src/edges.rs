//! Which half-edges of plain triangles lie on one edge.
//!
//! Half-edge 3t + k runs from corner k of triangle t to the next corner; an edge is an unordered
//! pair of vertex numbers.

#![expect(
    clippy::cast_possible_truncation,
    reason = "the number of half-edges is checked to fit 32 bits"
)]

use crate::Error;
use glam::DVec3;

/// The half-edge after this one around its triangle.
pub(crate) fn following(half_edge: u32) -> u32 {
    if half_edge % 3 == 2 {
        half_edge - 2
    } else {
        half_edge + 1
    }
}

/// The half-edge before this one around its triangle.
pub(crate) fn previous(half_edge: u32) -> u32 {
    if half_edge.is_multiple_of(3) {
        half_edge + 2
    } else {
        half_edge - 1
    }
}

/// The half-edges on one edge, in increasing order.
#[derive(Clone, Copy)]
pub(crate) struct EdgeUses<'a>(&'a [u64]);

impl<'a> EdgeUses<'a> {
    /// How many there are, at least one.
    pub(crate) fn len(self) -> usize {
        self.0.len()
    }

    /// The half-edge at a place below [`len`](Self::len).
    pub(crate) fn get(self, at: usize) -> u32 {
        // The lower half of the packed number.
        self.0[at] as u32
    }

    /// All of them.
    pub(crate) fn iter(self) -> impl Iterator<Item = u32> + Clone + 'a {
        self.0.iter().map(|&packed| packed as u32)
    }
}

/// Visits every edge, ordered by its smaller and then by its larger vertex.
///
/// Every half-edge is dropped into the bucket of its smaller vertex, and each (short) bucket is
/// sorted by the larger one. Cost: O(n log d) for n triangles and d the largest number of
/// triangles around a vertex, without hashing; 24 bytes a triangle and 4 a vertex.
///
/// # Errors
/// The first triangle that names a vertex beyond `vertex_count`, or a vertex twice; more
/// half-edges than 32 bits can count.
pub(crate) fn for_each_edge(
    vertex_count: usize,
    triangle_count: usize,
    triangle: impl Fn(usize) -> [u32; 3],
    mut visit: impl FnMut(EdgeUses<'_>),
) -> Result<(), Error> {
    let half_edge_count = triangle_count.saturating_mul(3);
    if u32::try_from(half_edge_count).is_err() {
        let triangles = triangle_count;
        return Err(Error::TooManyTriangles { triangles });
    }
    // Start of each vertex' bucket, shifted by one while filling.
    let mut start = vec![0_u32; vertex_count + 2];
    for t in 0..triangle_count {
        let [a, b, c] = triangle(t);
        if [a, b, c].iter().any(|&v| v as usize >= vertex_count) {
            return Err(Error::VertexOutOfRange { triangle: t });
        }
        if a == b || b == c || c == a {
            return Err(Error::RepeatedVertex { triangle: t });
        }
        for smaller in [a.min(b), b.min(c), c.min(a)] {
            start[smaller as usize + 2] += 1;
        }
    }
    for v in 2..start.len() {
        start[v] += start[v - 1];
    }
    // (larger vertex, half-edge), packed so that it sorts as one number.
    let mut buckets = vec![0_u64; half_edge_count];
    for t in 0..triangle_count {
        let [a, b, c] = triangle(t);
        for (k, (from, to)) in [(a, b), (b, c), (c, a)].into_iter().enumerate() {
            let at = &mut start[from.min(to) as usize + 1];
            buckets[*at as usize] = u64::from(from.max(to)) << 32 | (3 * t + k) as u64;
            *at += 1;
        }
    }
    for v in 0..vertex_count {
        let bucket = &mut buckets[start[v] as usize..start[v + 1] as usize];
        bucket.sort_unstable();
        for edge in bucket.chunk_by(|x, y| x >> 32 == y >> 32) {
            visit(EdgeUses(edge));
        }
    }
    Ok(())
}

/// Edges that do not close.
#[derive(Default)]
pub(crate) struct Faults {
    total: usize,
    /// The half-edge with the smallest index at fault, and whether its edge is overused.
    first: Option<(u32, bool)>,
}

impl Faults {
    /// Takes in an edge that is at fault. `origin`: the vertex at which a half-edge starts.
    pub(crate) fn add(&mut self, edge: EdgeUses<'_>, origin: &impl Fn(u32) -> u32) {
        self.total += 1;
        // A half-edge that repeats an earlier one's direction, else the lonely one itself.
        let start = origin(edge.get(0));
        let mut seen = [false; 2];
        let repeated = edge.iter().position(|half_edge| {
            let direction = usize::from(origin(half_edge) == start);
            std::mem::replace(&mut seen[direction], true)
        });
        let found = (edge.get(repeated.unwrap_or(0)), repeated.is_some());
        if self.first.is_none_or(|first| found < first) {
            self.first = Some(found);
        }
    }

    /// The first fault in the order of triangles, if there is any.
    pub(crate) fn into_result(
        self,
        positions: &[DVec3],
        origin: &impl Fn(u32) -> u32,
    ) -> Result<(), Error> {
        let Some((half_edge, overused)) = self.first else {
            return Ok(());
        };
        let triangle = half_edge as usize / 3;
        let from = positions[origin(half_edge) as usize];
        let to = positions[origin(following(half_edge)) as usize];
        let total = self.total;
        Err(if overused {
            Error::OverusedEdge {
                triangle,
                from,
                to,
                total,
            }
        } else {
            Error::OpenEdge {
                triangle,
                from,
                to,
                total,
            }
        })
    }
}
