//! One planar face: loops in, triangles over the same vertices out.

use glam::DVec3;
use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, InsertionError, Point2, Triangulation};

/// Why loops were not filled.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Refusal {
    /// A loop of less than three corners.
    ShortLoop,
    /// Two neighbouring corners in one place.
    ZeroEdge,
    /// A coordinate that the triangulation cannot take.
    Coordinate(InsertionError),
    /// Two edges that cross.
    Crossing,
    /// An edge through another vertex, or the same edge twice.
    Overlapping,
    /// Loops that do not bound a region of the plane, or not on their left.
    NoRegion,
    /// A region that is connected differently.
    OtherTopology,
}

/// Loops of vertex numbers with the face to their left.
#[derive(Debug, Default)]
pub(super) struct Outline {
    /// All corners; edge k starts at corner k.
    corners: Vec<u32>,
    /// The corner after each one in its loop.
    following: Vec<u32>,
}

impl Outline {
    /// Adds a loop.
    pub(super) fn add_loop(&mut self, corners: impl Iterator<Item = u32>) -> Result<(), Refusal> {
        let start = self.corners.len();
        self.corners.extend(corners);
        let end = self.corners.len();
        if end - start < 3 {
            return Err(Refusal::ShortLoop);
        }
        // Corners are fewer than half-edges, which are counted with 32 bits.
        let number = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
        self.following.extend((start + 1..end).map(number));
        self.following.push(number(start));
        Ok(())
    }

    /// Number of corners, and of edges.
    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }
}

/// No edge of the outline, or no vertex.
const NONE: u32 = u32::MAX;

/// Triangulates the region to the left of an outline.
///
/// `positions` by vertex number; `normal` points outward, `expected` is the number of triangles.
/// The triangles use exactly the outline's edges as their boundary, counter-clockwise seen from
/// outside, and touch in the same corners: a vertex that has several copies in one place, or
/// occurs in several corners, is told apart by the sector between two edges of the outline.
pub(super) fn fill(
    outline: &Outline,
    positions: &[DVec3],
    normal: DVec3,
    expected: i64,
) -> Result<Vec<[u32; 3]>, Refusal> {
    let places = Places::of(outline, positions, normal);
    let edges = places.edges(outline)?;
    let mut crossing = false;
    let cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(
        places.points,
        edges,
        |_| crossing = true,
    )
    .map_err(Refusal::Coordinate)?;
    if crossing {
        return Err(Refusal::Crossing);
    }

    // The outline's edge of each directed edge, and back.
    let mut outline_edge = vec![NONE; cdt.num_directed_edges()];
    let mut starts = Vec::with_capacity(outline.len());
    for (at, &following) in (0..).zip(&outline.following) {
        let [from, to] = [at, following]
            .map(|corner| FixedVertexHandle::from_index(places.of_corner[corner as usize]));
        let edge = cdt.get_edge_from_neighbors(from, to);
        let edge = edge.ok_or(Refusal::Overlapping)?;
        let slot = &mut outline_edge[edge.fix().index()];
        if std::mem::replace(slot, at) != NONE {
            return Err(Refusal::Overlapping);
        }
        starts.push(edge);
    }

    let mut triangles = vec![[NONE; 3]; cdt.num_all_faces()];
    for (at, &start) in (0..).zip(&starts) {
        let vertex = outline.corners[at as usize];
        // Counter-clockwise through the sector that this edge opens.
        let mut edge = start;
        loop {
            let face = edge.face();
            let triangle = face.as_inner().ok_or(Refusal::NoRegion)?;
            let spokes = triangle.adjacent_edges();
            for (corner, spoke) in triangles[face.fix().index()].iter_mut().zip(spokes) {
                if spoke == edge {
                    *corner = vertex;
                }
            }
            edge = edge.ccw();
            match outline_edge[edge.rev().fix().index()] {
                NONE if outline_edge[edge.fix().index()] != NONE => return Err(Refusal::NoRegion),
                NONE => {}
                closing if outline.following[closing as usize] == at => break,
                _ => return Err(Refusal::OtherTopology),
            }
        }
    }
    triangles.retain(|corners| corners != &[NONE; 3]);
    if triangles.iter().flatten().any(|&corner| corner == NONE) {
        return Err(Refusal::NoRegion);
    }
    // Regions of the plane with equally many loops are connected alike if they have equally many
    // triangles (Euler).
    if i64::try_from(triangles.len()) != Ok(expected) {
        return Err(Refusal::OtherTopology);
    }
    Ok(triangles)
}

/// A coordinate as the triangulation takes it: what it calls too small is zero.
fn coordinate(value: f64) -> f64 {
    if value.abs() < spade::MIN_ALLOWED_VALUE {
        0.0
    } else {
        value
    }
}

/// The different places of an outline's corners in the plane.
struct Places {
    points: Vec<Point2<f64>>,
    /// Index of the point of each corner.
    of_corner: Vec<usize>,
}

impl Places {
    /// Coordinates are copied, not computed: exact predicates see what the mesh has.
    fn of(outline: &Outline, positions: &[DVec3], normal: DVec3) -> Self {
        let largest = normal.abs().max_position();
        let (u, v) = ((largest + 1) % 3, (largest + 2) % 3);
        let (u, v) = if normal[largest] < 0.0 {
            (v, u)
        } else {
            (u, v)
        };
        let projected: Vec<Point2<f64>> = (outline.corners.iter())
            .map(|&vertex| positions[vertex as usize])
            .map(|p| Point2::new(coordinate(p[u]), coordinate(p[v])))
            .collect();
        let mut order: Vec<usize> = (0..projected.len()).collect();
        let key = |at: usize| (projected[at].x, projected[at].y);
        order.sort_by(|&a, &b| {
            let (a, b) = (key(a), key(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        let mut points = Vec::with_capacity(order.len());
        let mut of_corner = vec![0; order.len()];
        for at in order {
            if points.last() != Some(&projected[at]) {
                points.push(projected[at]);
            }
            of_corner[at] = points.len() - 1;
        }
        Self { points, of_corner }
    }

    /// The outline's edges between points, each once.
    fn edges(&self, outline: &Outline) -> Result<Vec<[usize; 2]>, Refusal> {
        let mut edges = Vec::with_capacity(outline.len());
        for (&from, &following) in self.of_corner.iter().zip(&outline.following) {
            let to = self.of_corner[following as usize];
            if from == to {
                return Err(Refusal::ZeroEdge);
            }
            edges.push([from.min(to), from.max(to)]);
        }
        edges.sort_unstable();
        edges.dedup();
        Ok(edges)
    }
}
