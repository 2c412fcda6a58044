//! Triangles without names become fragments: corners of exactly equal position are one vertex, as
//! far as the surface stays a 2-manifold.
//!
//! Where the boundary touches itself along an edge, triangles are paired by their angle around
//! it, so that the solid on each side of a pair is one wedge; in a touching vertex each fan of
//! triangles gets its own copy.

use crate::Error;
use crate::edges::{Faults, following, for_each_edge, previous};
use crate::join::join_equal;
use glam::DVec3;
use std::collections::HashMap;
use subdiv::{Fragments, Triangle, VertexKind};

/// Names the vertices of loose triangles; [`stitch`](crate::stitch) then takes them.
///
/// `corners`: positions, counter-clockwise seen from outside. `label` makes the triangle of index
/// i, whose vertices are filled in here. Triangles in which two corners coincide are dropped: the
/// sides that remain are each other's reverse. Cost: O(n log n).
///
/// # Errors
/// An edge that is open, or not used equally often in both directions.
pub fn weld(
    corners: &[[DVec3; 3]],
    mut label: impl FnMut(usize) -> Triangle,
) -> Result<Fragments, Error> {
    let positions = corners.as_flattened();
    if u32::try_from(positions.len()).is_err() {
        let triangles = corners.len();
        return Err(Error::TooManyTriangles { triangles });
    }
    let joined = join_equal(positions, &[]);
    let (triangles, _) = joined.as_chunks::<3>();
    let is_whole = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
    let (kept, triangles): (Vec<usize>, Vec<[u32; 3]>) = (0..)
        .zip(triangles)
        .filter(|(_, ids)| is_whole(ids))
        .unzip();
    let twins = pair(positions, &triangles)?;
    let ids = split(triangles.len(), &twins);
    let mut fragments = Fragments::default();
    let mut place: HashMap<u32, u32> = HashMap::new();
    for (t, at) in kept.into_iter().enumerate() {
        let mut triangle = label(at);
        for (k, vertex) in triangle.vertices.iter_mut().enumerate() {
            let next = fragments.positions.len();
            *vertex = *place.entry(ids[3 * t + k]).or_insert_with(|| {
                fragments
                    .positions
                    .push(positions[triangles[t][k] as usize]);
                fragments.kinds.push(VertexKind::Interior);
                u32::try_from(next).unwrap_or(u32::MAX)
            });
        }
        fragments.triangles.push(triangle);
    }
    Ok(fragments)
}

/// The twin of each half-edge; half-edge 3t + k goes from corner k of triangle t to the next one.
fn pair(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Vec<usize>, Error> {
    let triangle = |t: usize| triangles[t];
    let origin = |h: u32| triangles[h as usize / 3][h as usize % 3];
    let mut twins = vec![usize::MAX; 3 * triangles.len()];
    let mut faults = Faults::default();
    let mut half_edges = Vec::new();
    for_each_edge(positions.len(), triangles.len(), triangle, |edge| {
        half_edges.clear();
        half_edges.extend(edge.iter());
        let ends = half_edges
            .iter()
            .map(|&h| (origin(h), origin(following(h))));
        let (low, high) = ends
            .clone()
            .next()
            .map_or((0, 0), |(u, v)| (u.min(v), u.max(v)));
        let forward = ends.filter(|(from, _)| *from == low).count();
        if 2 * forward != edge.len() {
            faults.add(edge, &origin);
            return;
        }
        let (a, b) = (positions[low as usize], positions[high as usize]);
        for (g, h) in around(a, b, &half_edges, |h| {
            let apex = origin(previous(h));
            (positions[apex as usize], origin(h) == low)
        }) {
            twins[g as usize] = h as usize;
            twins[h as usize] = g as usize;
        }
    })?;
    faults.into_result(positions, &origin)?;
    Ok(twins)
}

/// Pairs the half-edges of one edge from `a` to `b` such that the solid between the two triangles
/// of a pair is one wedge. `apex`: a triangle's third corner, and whether it runs from `a` to `b`.
fn around(
    a: DVec3,
    b: DVec3,
    edge: &[u32],
    apex: impl Fn(u32) -> (DVec3, bool),
) -> Vec<(u32, u32)> {
    if let [g, h] = *edge {
        return vec![(g, h)];
    }
    let axis = (b - a).normalize_or_zero();
    let x = axis.any_orthonormal_vector();
    let y = axis.cross(x);
    let mut turned: Vec<(f64, bool, u32)> = edge
        .iter()
        .map(|&h| {
            let (point, forward) = apex(h);
            let arm = point - a;
            (arm.dot(y).atan2(arm.dot(x)), forward, h)
        })
        .collect();
    turned.sort_by(|g, h| g.0.total_cmp(&h.0).then(g.1.cmp(&h.1)).then(g.2.cmp(&h.2)));
    // Seen along the axis, a triangle that runs forward has the solid behind it, clockwise, so it
    // closes the wedge that a backward one opened. A stack matches them like parentheses, from a
    // place where nothing is open.
    let weight = |t: &(f64, bool, u32)| if t.1 { -1 } else { 1 };
    let mut open = 0_i32;
    let mut lowest = (0, 0);
    for (at, one) in turned.iter().enumerate() {
        open += weight(one);
        lowest = lowest.min((open, at + 1));
    }
    let start = lowest.1 % turned.len();
    turned.rotate_left(start);
    let mut pairs = Vec::with_capacity(edge.len() / 2);
    let mut stack = Vec::new();
    for (_, forward, h) in turned {
        match stack.pop() {
            Some(g) if forward => pairs.push((g, h)),
            previous => {
                stack.extend(previous);
                stack.push(h);
            }
        }
    }
    pairs
}

/// One name for all corners of a fan: those that twins connect.
fn split(triangle_count: usize, twins: &[usize]) -> Vec<u32> {
    let unset = u32::MAX;
    let mut names = vec![unset; 3 * triangle_count];
    let mut next = 0;
    for start in 0..names.len() {
        if names[start] != unset {
            continue;
        }
        let mut corner = start;
        // Around the vertex: the half-edge that ends here is the previous one, its twin starts here.
        while names[corner] == unset {
            names[corner] = next;
            let previous = corner / 3 * 3 + (corner + 2) % 3;
            corner = twins[previous];
        }
        next += 1;
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, together, torus};
    use csg::{MaterialId, PrimitiveId, Sense};

    fn welded(fragments: &Fragments) -> Result<Fragments, Error> {
        let corners = |t: &Triangle| t.vertices.map(|v| fragments.positions[v as usize]);
        let loose: Vec<[DVec3; 3]> = fragments.triangles.iter().map(corners).collect();
        weld(&loose, |at| fragments.triangles[at])
    }

    fn shells(fragments: &Fragments) -> usize {
        let brep = crate::stitch(fragments).expect("closed").validate();
        crate::Shells::of(&brep.expect("valid")).shells.len()
    }

    #[test]
    fn loose_triangles_become_the_mesh_again() {
        let ring = torus(2.0, 1.0, 12, 8);
        let again = welded(&ring).expect("closed");
        assert_eq!(again.positions.len(), ring.positions.len());
        assert_eq!(shells(&again), 1);
    }

    /// Two cubes that share a corner, and two that share an edge: each stays a solid.
    #[test]
    fn touching_solids_come_apart() {
        for offset in [[2.0, 2.0, 2.0], [2.0, 2.0, 0.0]] {
            let touching = together(&[cube([0.0; 3], 1.0), cube(offset, 1.0)]);
            let again = welded(&touching).expect("closed");
            assert_eq!(again.positions.len(), 16, "{offset:?}");
            assert_eq!(shells(&again), 2, "{offset:?}");
        }
    }

    #[test]
    fn an_open_surface_is_refused() {
        let corner = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let label = |_| Triangle {
            vertices: [0; 3],
            primitive: PrimitiveId(0),
            sense: Sense::Inside,
            material: MaterialId(0),
        };
        let open = weld(&[corner], label);
        assert!(
            matches!(open, Err(Error::OpenEdge { total: 3, .. })),
            "{open:?}"
        );
    }
}
