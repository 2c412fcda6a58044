//! What hangs together: triangles across edges, and corners around a vertex.

use crate::edges::{EdgeUses, following};

/// Corners (3t + k is corner k of triangle t) joined where two triangles share an edge.
pub(super) struct Pieces {
    /// Parents of corners in the fans around vertices.
    corners: Vec<u32>,
    /// Parents of triangles.
    triangles: Vec<u32>,
}

/// The fans around all vertices.
pub(super) struct Fans {
    /// How many there are.
    pub(super) count: usize,
    /// Vertices with more than one, and their first triangle.
    pub(super) pinched: Vec<(u32, u32)>,
}

impl Pieces {
    pub(super) fn new(triangle_count: usize) -> Self {
        Self {
            corners: (0..).take(3 * triangle_count).collect(),
            triangles: (0..).take(triangle_count).collect(),
        }
    }

    /// Joins what lies around an edge. `origin`: the vertex where a half-edge starts.
    pub(super) fn join(&mut self, edge: EdgeUses<'_>, origin: impl Fn(u32) -> u32) {
        let first = edge.get(0);
        let ends = [first, following(first)];
        for h in edge.iter().skip(1) {
            union(&mut self.triangles, first / 3, h / 3);
            for corner in [h, following(h)] {
                let same = ends.into_iter().find(|&end| origin(end) == origin(corner));
                if let Some(end) = same {
                    union(&mut self.corners, end, corner);
                }
            }
        }
    }

    pub(super) fn components(&self) -> usize {
        let roots = (0_u32..).zip(&self.triangles);
        roots.filter(|(t, parent)| t == *parent).count()
    }

    pub(super) fn fans(&self, vertices: usize, triangle: impl Fn(usize) -> [u32; 3]) -> Fans {
        let mut fans = Fans {
            count: 0,
            pinched: Vec::new(),
        };
        let mut seen = vec![0_u8; vertices];
        for (corner, &parent) in (0_u32..).zip(&self.corners) {
            if corner != parent {
                continue;
            }
            fans.count += 1;
            let v = triangle(corner as usize / 3)[corner as usize % 3];
            let seen = &mut seen[v as usize];
            if *seen == 1 {
                fans.pinched.push((v, corner / 3));
            }
            *seen = (*seen + 1).min(2);
        }
        fans
    }
}

/// The root of a tree, halving the path to it.
fn root(parents: &mut [u32], mut at: u32) -> u32 {
    while parents[at as usize] != at {
        let grandparent = parents[parents[at as usize] as usize];
        parents[at as usize] = grandparent;
        at = grandparent;
    }
    at
}

/// Joins two trees under the smaller root, so that roots are the first of their pieces.
fn union(parents: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(parents, a), root(parents, b));
    parents[a.max(b) as usize] = a.min(b);
}
