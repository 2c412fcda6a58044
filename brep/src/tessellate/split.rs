//! Vertices put in where facets are too far from their surfaces.

use super::measure::UPRIGHT;
use super::patchwork::{NONE, Role, next};
use super::sheet::project_on_both;
use super::{FaceId, Run};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Splits in one boundary, at most: something is wrong with a surface that needs more.
const SPLITS: usize = 1 << 20;

/// A facet that deviates too much.
struct Candidate {
    error: f64,
    facet: u32,
    corners: [u32; 3],
}

impl PartialEq for Candidate {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error
            .total_cmp(&other.error)
            .then(other.facet.cmp(&self.facet))
    }
}

impl Run<'_> {
    /// Splits the worst facets first, until none deviates too much.
    pub(super) fn split_far_facets(&mut self) {
        let mut heap = BinaryHeap::new();
        let facets: Vec<u32> = self.mesh.facets().collect();
        for facet in facets {
            self.push(&mut heap, facet);
        }
        let mut left = SPLITS;
        let (mut open, mut touched) = (Vec::new(), Vec::new());
        while let Some(candidate) = heap.pop() {
            if left == 0 || self.mesh.face.len() > self.most_facets {
                break;
            }
            if self.mesh.corners(candidate.facet) != candidate.corners {
                continue;
            }
            // What lies on its face is no matter of size.
            if self.shape_of(3 * candidate.facet).lean > UPRIGHT {
                continue;
            }
            let Some(spoke) = self.split_worst_edge(candidate.facet) else {
                continue;
            };
            left -= 1;
            open.clear();
            open.extend(self.mesh.ring(spoke).map(next));
            touched.clear();
            touched.extend(open.iter().map(|h| h / 3));
            self.flip_from(&mut open, false, super::FLIPS, |h| touched.push(h / 3));
            touched.sort_unstable();
            touched.dedup();
            for &facet in &touched {
                self.push(&mut heap, facet);
            }
        }
    }

    fn push(&self, heap: &mut BinaryHeap<Candidate>, facet: u32) {
        let error = self.shape_of(3 * facet).error;
        if error > 1.0 && !self.kept[self.face_of(3 * facet)] {
            let corners = self.mesh.corners(facet);
            heap.push(Candidate {
                error,
                facet,
                corners,
            });
        }
    }

    /// Splits the edge of a facet that deviates most; returns a half-edge from the new vertex.
    fn split_worst_edge(&mut self, facet: u32) -> Option<u32> {
        let worst = [3 * facet, 3 * facet + 1, 3 * facet + 2]
            .into_iter()
            .max_by(|&g, &h| self.mesh.chord[g as usize].total_cmp(&self.mesh.chord[h as usize]))?;
        self.split_in_the_middle(worst)
    }

    /// Splits an edge of a curved face, or a B-Rep edge, above its middle; returns a half-edge from
    /// the new vertex.
    pub(super) fn split_in_the_middle(&mut self, h: u32) -> Option<u32> {
        let [a, b] =
            [self.mesh.origin[h as usize], self.mesh.target(h)].map(|v| self.mesh.position(v));
        let middle = a.midpoint(b);
        if [h, self.mesh.twin[h as usize]]
            .iter()
            .any(|&e| self.kept[self.face_of(e)])
        {
            return None;
        }
        let crease = self.mesh.crease[h as usize];
        let (position, role) = if crease == NONE {
            let sheet = self.sheets[self.face_of(h)];
            (sheet.project(middle, self.rounding)?, Role::Inside)
        } else {
            let faces = self.groups.edges[crease as usize].faces;
            let sheets = faces.map(|FaceId(face)| self.sheets[face as usize]);
            (project_on_both(sheets, middle, self.rounding)?, Role::Fixed)
        };
        if position.distance(middle) > 0.6 * a.distance(b) {
            return None;
        }
        Some(self.split(h, position, role))
    }
}
