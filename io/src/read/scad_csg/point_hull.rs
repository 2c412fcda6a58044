//! Convex hulls of points, such as the vertices of boxes, prisms and convex polyhedra.

use csg::Shape;
use glam::DVec3;
use robust::{Coord3D, orient3d};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// The vertices of a shape that is a convex polyhedron.
pub(super) fn corners(shape: &Shape) -> Option<Vec<DVec3>> {
    match shape {
        Shape::Block(block) => {
            let [low, high] = [block.min(), block.max()];
            let pick = |at: u32, axis: u32| if at >> axis & 1 == 1 { high } else { low };
            let corner = |at| DVec3::new(pick(at, 0).x, pick(at, 1).y, pick(at, 2).z);
            Some((0..8).map(corner).collect())
        }
        Shape::Prism(prism) => {
            let (radii, ends) = (prism.radii(), prism.ends());
            let mut all = Vec::new();
            for (radius, z) in radii.into_iter().zip(ends) {
                all.extend((0..prism.sides()).map(|side| {
                    let angle = TAU * f64::from(side) / f64::from(prism.sides());
                    DVec3::new(radius * angle.cos(), radius * angle.sin(), z)
                }));
            }
            Some(all)
        }
        Shape::ConvexPolyhedron(solid) => Some(solid.vertices().to_vec()),
        _ => None,
    }
}

/// Positive if d lies behind the plane of a, b, c, which are counter-clockwise from before;
/// exact.
fn behind(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// A triangle of a hull with its plane.
struct Facet {
    corners: [usize; 3],
    normal: DVec3,
    offset: f64,
}

/// The triangles of the convex hull of points, counter-clockwise from outside; `None` if it has
/// no volume. Points less than `near` beyond the hull of the others may be left out.
///
/// Points are added one by one; the faces that a point sees give way to new ones at their rim.
pub(super) fn triangles(points: &[DVec3], near: f64) -> Option<Vec<Vec<usize>>> {
    let at = |i: usize| points.get(i).copied().unwrap_or_default();
    let order = outermost_first(points);
    let farthest = |measure: &dyn Fn(usize) -> f64| {
        let all = order.iter().copied();
        all.max_by(|a, b| measure(*a).total_cmp(&measure(*b)))
    };
    // A large first tetrahedron makes for well-shaped triangles.
    let a = *order.first()?;
    let b = farthest(&|i| at(i).distance(at(a)))?;
    let c = farthest(&|i| (at(b) - at(a)).cross(at(i) - at(a)).length())?;
    let d = farthest(&|i| behind(at(a), at(b), at(c), at(i)).abs())?;
    let facet = |corners: [usize; 3]| {
        let [p, q, r] = corners.map(at);
        let normal = (q - p).cross(r - p).normalize_or_zero();
        Facet {
            corners,
            normal,
            offset: normal.dot(p),
        }
    };
    let first = match behind(at(a), at(b), at(c), at(d)) {
        0.0 => return None,
        side if side > 0.0 => [[a, b, c], [b, a, d], [c, b, d], [a, c, d]],
        _ => [[a, c, b], [a, b, d], [b, c, d], [c, a, d]],
    };
    let mut faces: Vec<Facet> = first.into_iter().map(facet).collect();
    for i in order {
        let p = at(i);
        if near > 0.0 && faces.iter().all(|f| f.normal.dot(p) - f.offset <= near) {
            continue;
        }
        let (seen, mut kept): (Vec<Facet>, Vec<Facet>) = faces.into_iter().partition(|f| {
            let [a, b, c] = f.corners;
            behind(at(a), at(b), at(c), p) < 0.0
        });
        let edges = |f: &Facet| {
            let [a, b, c] = f.corners;
            [(a, b), (b, c), (c, a)]
        };
        let all: BTreeSet<(usize, usize)> = seen.iter().flat_map(edges).collect();
        let rim = all.iter().filter(|(a, b)| !all.contains(&(*b, *a)));
        kept.extend(rim.map(|&(a, b)| facet([a, b, i])));
        faces = kept;
    }
    Some(faces.into_iter().map(|f| f.corners.to_vec()).collect())
}

/// The indices of points, those first that are farthest out in some direction.
fn outermost_first(points: &[DVec3]) -> Vec<usize> {
    const DIRECTIONS: u32 = 200;
    let mut first = BTreeSet::new();
    if points.len() > 50 {
        // Fibonacci's spiral covers the sphere evenly.
        for i in 0..DIRECTIONS {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(DIRECTIONS);
            let (sine, cosine) = (f64::from(i) * TAU * 0.618_033_988_749_895).sin_cos();
            let across = (1.0 - z * z).sqrt();
            let direction = DVec3::new(across * cosine, across * sine, z);
            let reach = |i: usize| points.get(i).map_or(0.0, |p| p.dot(direction));
            let all = 0..points.len();
            first.extend(all.max_by(|a, b| reach(*a).total_cmp(&reach(*b))));
        }
    }
    let rest = (0..points.len()).filter(|i| !first.contains(i));
    first.iter().copied().chain(rest).collect()
}

/// Only the vertices that faces use, renumbered.
pub(super) fn used(points: &[DVec3], faces: &mut [Vec<usize>]) -> Vec<DVec3> {
    let mut place: BTreeMap<usize, usize> = BTreeMap::new();
    let mut kept = Vec::new();
    for vertex in faces.iter_mut().flatten() {
        *vertex = *place.entry(*vertex).or_insert_with(|| {
            kept.push(points.get(*vertex).copied().unwrap_or_default());
            kept.len() - 1
        });
    }
    kept
}

/// Only the corners of the hull; all points if it has no volume.
pub(super) fn reduced(points: &[DVec3]) -> Vec<DVec3> {
    if let Some(mut faces) = triangles(points, 0.0) {
        return used(points, &mut faces);
    }
    let mut all = points.to_vec();
    all.sort_by(|a, b| {
        let order = a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y));
        order.then(a.z.total_cmp(&b.z))
    });
    all.dedup();
    all
}

/// Longest side of the box around points.
pub(super) fn span(points: &[DVec3]) -> f64 {
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element().max(0.0)
}
