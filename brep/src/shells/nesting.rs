//! Which outer shell holds a void.

use super::{Shell, ShellId, ShellRole, Solid};
use crate::topology::{Brep, FacetKey};
use csg::Aabb;
use glam::DVec3;
use robust::{Coord, Coord3D, orient2d, orient3d};
use slotmap::SecondaryMap;

/// Outer shells with their voids, and the voids that lie in none.
///
/// A void belongs to the smallest outer shell that contains it. Boxes decide first; a point of
/// the void is tested against the facets only where several boxes hold it.
pub(super) fn solids(
    brep: &Brep,
    shells: &[Shell],
    shell_of: &SecondaryMap<FacetKey, ShellId>,
) -> (Vec<Solid>, Vec<ShellId>) {
    let ids = || (0..).map(ShellId);
    let mut solids: Vec<Solid> = ids()
        .zip(shells)
        .filter(|(_, shell)| shell.role == ShellRole::Outer)
        .map(|(outer, _)| Solid {
            outer,
            voids: Vec::new(),
        })
        .collect();
    let mut stray = Vec::new();
    for (id, void) in ids().zip(shells) {
        if void.role == ShellRole::Outer {
            continue;
        }
        let mut candidates: Vec<usize> = (0..solids.len())
            .filter(|&at| holds(&shells[solids[at].outer.0 as usize].bounds, &void.bounds))
            .collect();
        if candidates.len() > 1 {
            let winding = winding_numbers(brep, shells.len(), shell_of, id, void);
            candidates.retain(|&at| winding[solids[at].outer.0 as usize] != 0);
        }
        let volume = |&at: &usize| shells[solids[at].outer.0 as usize].volume;
        match candidates
            .into_iter()
            .min_by(|a, b| volume(a).total_cmp(&volume(b)))
        {
            Some(at) => solids[at].voids.push(id),
            None => stray.push(id),
        }
    }
    (solids, stray)
}

fn holds(outer: &Aabb, inner: &Aabb) -> bool {
    outer.min.cmple(inner.min).all() && outer.max.cmpge(inner.max).all()
}

/// How often each shell winds around a corner of the void's first facet: facets that a ray
/// upward from there passes, counted with their direction.
fn winding_numbers(
    brep: &Brep,
    shell_count: usize,
    shell_of: &SecondaryMap<FacetKey, ShellId>,
    id: ShellId,
    void: &Shell,
) -> Vec<i32> {
    let point = brep.facet(void.facet).positions()[0];
    let mut winding = vec![0; shell_count];
    for (key, &shell) in shell_of {
        if shell != id {
            winding[shell.0 as usize] += crossing(point, brep.facet(key).positions());
        }
    }
    winding
}

/// +1 when the ray upward from `point` leaves through the triangle, −1 when it enters, 0 when it
/// misses. A ray through an edge hits exactly one of the edge's two triangles.
fn crossing(point: DVec3, [a, b, c]: [DVec3; 3]) -> i32 {
    if a.z.max(b.z).max(c.z) < point.z {
        return 0;
    }
    // Crossing number in the projection: edges that pass the ray's foot on its right (+x).
    let turns = passes(point, a, b) + passes(point, b, c) + passes(point, c, a);
    if turns == 0 {
        return 0;
    }
    let spatial = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    // Positive when `point` lies on the side from which a, b, c appear clockwise.
    let side = orient3d(spatial(a), spatial(b), spatial(c), spatial(point));
    let below = if turns > 0 { side > 0.0 } else { side < 0.0 };
    if below { turns } else { 0 }
}

fn passes(point: DVec3, from: DVec3, to: DVec3) -> i32 {
    let upward = from.y <= point.y && to.y > point.y;
    let downward = to.y <= point.y && from.y > point.y;
    if !upward && !downward {
        return 0;
    }
    let flat = |p: DVec3| Coord { x: p.x, y: p.y };
    // Both triangles of an edge ask with the same order of ends.
    let (low, high) = if upward { (from, to) } else { (to, from) };
    let left = orient2d(flat(low), flat(high), flat(point)) > 0.0;
    match (left, upward) {
        (false, _) => 0,
        (true, true) => 1,
        (true, false) => -1,
    }
}
