//! Is a mesh of plain triangles a closed, oriented 2-manifold, and where is it not?
//!
//! Unlike [`stitch`](crate::stitch), which stops at the first fault, everything that is wrong is
//! counted, by its kind, with the first places of each. What is *not* looked for: triangles that
//! cross each other in space.

mod fans;
mod report;

use crate::Error;
use crate::edges::{EdgeUses, following, for_each_edge, previous};
use crate::sum::Sum;
use csg::Aabb;
use fans::Pieces;
use glam::DVec3;
pub use report::{DefectKind, Example, Inspection, Tally};

impl Inspection {
    /// Inspects triangles over numbered vertices; two share an edge when they name the same two
    /// vertices.
    ///
    /// Triangles that cannot be looked at (vertices out of range, a vertex twice) count as
    /// defects and are left out of everything else, as if they were not there; those with a
    /// position that is not finite are left out of lengths, areas and volumes. Cost:
    /// O(n log n), about 100 bytes a triangle.
    ///
    /// # Errors
    /// [`Error::TooManyTriangles`] above 1.4 billion triangles.
    pub fn of(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, Error> {
        if u32::try_from(triangles.len().saturating_mul(3)).is_err() {
            let triangles = triangles.len();
            return Err(Error::TooManyTriangles { triangles });
        }
        let mut this = Self::default();
        let kept = this.sift(positions, triangles);
        this.edges(positions, triangles, &kept)?;
        this.measure(positions, triangles, &kept);
        Ok(this)
    }

    /// Counts triangles that cannot be looked at; returns the others.
    fn sift(&mut self, positions: &[DVec3], triangles: &[[u32; 3]]) -> Vec<u32> {
        let mut kept = Vec::with_capacity(triangles.len());
        let mut is_used = vec![false; positions.len()];
        for (t, corners) in (0_u32..).zip(triangles) {
            let mut is_new_fault = None;
            let mut is_in_range = true;
            for &v in corners {
                let Some(used) = is_used.get_mut(v as usize) else {
                    is_in_range = false;
                    continue;
                };
                if !*used && !positions[v as usize].is_finite() {
                    is_new_fault = Some(v);
                    let example = Example::new(t, &[v], None);
                    self.tally(DefectKind::NotFinite).add(example);
                }
                *used = true;
            }
            let [a, b, c] = *corners;
            if !is_in_range {
                let missing = corners.iter().filter(|&&v| v as usize >= positions.len());
                let missing: Vec<u32> = missing.copied().collect();
                let example = Example::new(t, &missing, None);
                self.tally(DefectKind::VertexOutOfRange).add(example);
            } else if a == b || b == c || c == a {
                let place = is_new_fault.is_none().then(|| positions[a as usize]);
                let example = Example::new(t, corners, place);
                self.tally(DefectKind::DegenerateTriangle).add(example);
            } else {
                kept.push(t);
            }
        }
        self.unused_vertices = is_used.iter().filter(|used| !**used).count();
        kept
    }

    /// Judges each edge, then what hangs together around vertices and over all.
    fn edges(
        &mut self,
        positions: &[DVec3],
        triangles: &[[u32; 3]],
        kept: &[u32],
    ) -> Result<(), Error> {
        let triangle = |k: usize| triangles[kept[k] as usize];
        let origin = |h: u32| triangle(h as usize / 3)[h as usize % 3];
        let name = |h: u32| kept[h as usize / 3];
        let mut pieces = Pieces::new(kept.len());
        let mut edge_count = 0;
        let mut apexes = Vec::new();
        for_each_edge(positions.len(), kept.len(), triangle, |edge| {
            edge_count += 1;
            pieces.join(edge, origin);
            let ends = [origin(edge.get(0)), origin(following(edge.get(0)))];
            let forward = edge.iter().filter(|&h| origin(h) == ends[0]).count();
            self.is_cycle &= 2 * forward == edge.len();
            if let Some(kind) = edge_defect(edge, forward) {
                let place = ends.map(|v| positions[v as usize]);
                let place = place[0].midpoint(place[1]);
                let around: Vec<u32> = edge.iter().map(name).collect();
                let example = Example::of_several(&around, &ends, Some(place));
                self.tally(kind).add(example);
            }
            // Triangles over the same three vertices share all edges: they are counted at the one
            // whose opposite corner is the largest.
            apexes.clear();
            let above = edge.iter().map(|h| (origin(previous(h)), name(h)));
            apexes.extend(above.filter(|(apex, _)| *apex > ends[0].max(ends[1])));
            apexes.sort_unstable();
            for pair in apexes.windows(2).filter(|pair| pair[0].0 == pair[1].0) {
                let (earlier, later) = (pair[0].1, pair[1].1);
                let corners = triangles[later as usize];
                let mut example = Example::new(later, &corners, centroid(positions, corners));
                example.triangles.push(earlier);
                self.tally(DefectKind::DuplicateTriangle).add(example);
            }
        })?;

        let fans = pieces.fans(positions.len(), triangle);
        for (v, first) in fans.pinched {
            let place = Some(positions[v as usize]);
            let example = Example::new(kept[first as usize], &[v], place);
            self.tally(DefectKind::PinchedVertex).add(example);
        }
        self.components = pieces.components();
        if self.is_sound() {
            // V − E + F = 2 (components − handles), with a vertex for each fan.
            let cells = fans.count + kept.len();
            self.genus = Some((2 * self.components + edge_count - cells) / 2);
        }
        Ok(())
    }

    /// Area, box, and the volume if the triangles close.
    fn measure(&mut self, positions: &[DVec3], triangles: &[[u32; 3]], kept: &[u32]) {
        let corners = |t: u32| triangles[t as usize].map(|v| positions[v as usize]);
        let is_finite = |t: &&u32| corners(**t).iter().all(|p| p.is_finite());
        let mut bounds = Aabb::EMPTY;
        for p in kept.iter().filter(is_finite).flat_map(|&t| corners(t)) {
            bounds.min = bounds.min.min(p);
            bounds.max = bounds.max.max(p);
        }
        self.bounds = bounds;
        let apex = bounds.min.midpoint(bounds.max);
        let (mut area, mut volume) = (Sum::default(), Sum::default());
        for &t in kept.iter().filter(is_finite) {
            let [a, b, c] = corners(t).map(|p| p - apex);
            let normal = (b - a).cross(c - a);
            area.add(0.5 * normal.length());
            volume.add(a.dot(b.cross(c)) / 6.0);
            if is_flat(corners(t)) {
                let example = Example::new(t, &triangles[t as usize], Some(corners(t)[0]));
                self.zero_area.add(example);
            }
        }
        self.area = area.value();
        let is_whole = self.is_cycle && self.tally_of(DefectKind::NotFinite).count == 0;
        self.volume = is_whole.then_some(volume.value());
    }
}

/// What is wrong with an edge, `forward` of whose half-edges run like the first one.
fn edge_defect(edge: EdgeUses<'_>, forward: usize) -> Option<DefectKind> {
    match (edge.len(), forward) {
        (1, _) => Some(DefectKind::OpenEdge),
        (2, 1) => None,
        (2, _) => Some(DefectKind::OneWayEdge),
        _ => Some(DefectKind::CrowdedEdge),
    }
}

fn centroid(positions: &[DVec3], corners: [u32; 3]) -> Option<DVec3> {
    let sum: DVec3 = corners.iter().map(|&v| positions[v as usize] / 3.0).sum();
    sum.is_finite().then_some(sum)
}

/// Whether three points are exactly on one line: then they are in all three projections.
fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    [[0, 1], [1, 2], [2, 0]].iter().all(|&[i, j]| {
        let at = |p: DVec3| robust::Coord { x: p[i], y: p[j] };
        robust::orient2d(at(a), at(b), at(c)) == 0.0
    })
}

#[cfg(test)]
mod tests;
