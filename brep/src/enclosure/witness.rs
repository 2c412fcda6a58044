//! For each component of a mesh a short way that passes it once, and nothing else.

use super::{Mesh, Side, offsets::Offsets};
use crate::tessellate::side_of_plane;
use glam::DVec3;

/// Ways that are tried for a component.
const TRIALS: usize = 16;

/// Whether for each component some way from an inner to an outer copy of a vertex is found which
/// meets no displaced copy of a facet in between, and whose inner end is inside of its own
/// component's outer copy, its outer end not inside of the inner copy, and both outside of, or
/// inside of, both copies of each other component.
pub(super) fn is_passed_once(
    mesh: &Mesh,
    offsets: &Offsets,
    component: &[u32],
    count: usize,
) -> bool {
    let mut of_component: Vec<Vec<u32>> = vec![Vec::new(); count];
    for (triangle, vertices) in (0..).zip(&mesh.triangles) {
        of_component[component[vertices[0] as usize] as usize].push(triangle);
    }
    let boxes: Vec<[DVec3; 2]> = of_component
        .iter()
        .map(|facets| {
            let mut bounds = [DVec3::INFINITY, DVec3::NEG_INFINITY];
            for &facet in facets {
                for side in [Side::Inner, Side::Outer] {
                    for p in offsets.facet(mesh, facet as usize, side) {
                        bounds = [bounds[0].min(p), bounds[1].max(p)];
                    }
                }
            }
            bounds
        })
        .collect();
    (0..count).all(|own| {
        let facets = &of_component[own];
        let step = (facets.len() / TRIALS).max(1);
        let mut candidates = facets.iter().step_by(step);
        candidates.any(|&facet| {
            let vertex = mesh.triangles[facet as usize][0];
            let [from, to] = offsets.places[vertex as usize];
            (0..count).all(|other| {
                let [low, high] = boxes[other];
                let is_apart = from.max(to).cmplt(low).any() || from.min(to).cmpgt(high).any();
                if is_apart {
                    return other != own;
                }
                let facets = &of_component[other];
                let is_free = |side| is_free(mesh, offsets, facets, vertex, side);
                if !(is_free(Side::Inner) && is_free(Side::Outer)) {
                    return false;
                }
                let far = high + (high - low) + DVec3::new(0.917, 1.331, 0.713);
                let copy = |side| {
                    facets
                        .iter()
                        .map(move |&f| offsets.facet(mesh, f as usize, side))
                };
                let in_outer = is_inside(from, far, copy(Side::Outer));
                let in_inner = is_inside(to, far, copy(Side::Inner));
                match (in_outer, in_inner) {
                    (Some(in_outer), Some(in_inner)) => (in_outer != in_inner) == (other == own),
                    _ => false,
                }
            })
        })
    })
}

/// Whether the way between a vertex' copies meets no facet of a copy of the mesh, but at its end.
fn is_free(mesh: &Mesh, offsets: &Offsets, facets: &[u32], vertex: u32, side: Side) -> bool {
    let [inner, outer] = offsets.places[vertex as usize];
    let start = match side {
        Side::Inner => outer,
        Side::Outer => inner,
    };
    facets.iter().all(|&facet| {
        let corners = offsets.facet(mesh, facet as usize, side);
        if mesh.triangles[facet as usize].contains(&vertex) {
            let [a, b, c] = corners;
            return side_of_plane(a, b, c, start) != 0.0;
        }
        meets([inner, outer], corners) == Some(false)
    })
}

/// Whether a point is inside of a closed mesh, by the parity of a ray; `None` if the ray hits it
/// where that says nothing.
fn is_inside(from: DVec3, far: DVec3, facets: impl Iterator<Item = [DVec3; 3]>) -> Option<bool> {
    let mut is_inside = false;
    for corners in facets {
        is_inside ^= meets([from, far], corners)?;
    }
    Some(is_inside)
}

/// Whether a segment meets a triangle, exactly; `None` if it touches its border or ends on it.
fn meets([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Option<bool> {
    let (low, high) = (p.min(q), p.max(q));
    let (least, most) = (a.min(b).min(c), a.max(b).max(c));
    if low.cmpgt(most).any() || least.cmpgt(high).any() {
        return Some(false);
    }
    let (from, to) = (side_of_plane(a, b, c, p), side_of_plane(a, b, c, q));
    if (from > 0.0 && to > 0.0) || (from < 0.0 && to < 0.0) {
        return Some(false);
    }
    let around = [
        side_of_plane(p, q, a, b),
        side_of_plane(p, q, b, c),
        side_of_plane(p, q, c, a),
    ];
    let (any_left, any_right) = (
        around.iter().any(|&s| s > 0.0),
        around.iter().any(|&s| s < 0.0),
    );
    if any_left && any_right {
        return Some(false);
    }
    let is_clear = from != 0.0 && to != 0.0 && around.iter().all(|&s| s != 0.0);
    is_clear.then_some(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLAT: [DVec3; 3] = [
        DVec3::ZERO,
        DVec3::new(2.0, 0.0, 0.0),
        DVec3::new(0.0, 2.0, 0.0),
    ];

    #[test]
    fn touching_is_neither_meeting_nor_missing() {
        let of = |x, y| {
            let at = |z| DVec3::new(x, y, z);
            meets([at(-1.0), at(1.0)], FLAT)
        };
        assert_eq!(of(0.5, 0.5), Some(true));
        assert_eq!(of(1.5, 1.0), Some(false));
        assert_eq!(of(1.0, 1.0), None);
        assert_eq!(of(0.0, 0.0), None);
        assert_eq!(of(3.0, 0.0), Some(false));
        let ends_there = [DVec3::new(0.5, 0.5, 0.0), DVec3::new(0.5, 0.5, 1.0)];
        assert_eq!(meets(ends_there, FLAT), None);
    }
}
