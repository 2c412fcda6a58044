//! Convex hulls of solids with flat faces: of boxes, prisms and convex polyhedra.

use csg::{ModelBuilder, Node, NodeId, Shape, Transform};
use glam::DVec3;
use robust::{Coord3D, orient3d};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// Vertices of one hull, at most; it may take quadratic time.
const MAX_POINTS: usize = 5000;

/// Why there is no hull.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum NoHull {
    /// Something has curved faces or is cut.
    Curved,
    /// Too many vertices.
    Many,
}

/// The vertices whose hull is that of the union of these nodes.
pub(super) fn vertices(builder: &ModelBuilder, nodes: &[NodeId]) -> Result<Vec<DVec3>, NoHull> {
    let mut found = Vec::new();
    let mut waiting: Vec<(Transform, NodeId)> = nodes
        .iter()
        .map(|id| (Transform::identity(), *id))
        .collect();
    while let Some((at, id)) = waiting.pop() {
        let shape = match builder.get(id).ok_or(NoHull::Curved)? {
            Node::Union(all) => {
                waiting.extend(all.iter().map(|child| (at.clone(), *child)));
                continue;
            }
            Node::Instance(by, child) => {
                let both = by.compose(&at).map_err(|_| NoHull::Curved)?;
                waiting.push((both, *child));
                continue;
            }
            Node::Painted(_, child) => {
                waiting.push((at, *child));
                continue;
            }
            Node::Shape(shape) => shape,
            _ => return Err(NoHull::Curved),
        };
        for corner in corners(shape).ok_or(NoHull::Curved)? {
            // Adding 0 turns −0 into 0.
            found.push(at.apply(corner).ok_or(NoHull::Curved)? + DVec3::ZERO);
        }
        if found.len() > MAX_POINTS {
            return Err(NoHull::Many);
        }
    }
    Ok(found)
}

fn corners(shape: &Shape) -> Option<Vec<DVec3>> {
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

/// The triangles of the convex hull of points, counter-clockwise from outside; `None` if it has
/// no volume.
///
/// Points are added one by one; the faces that a point sees give way to new ones at their rim.
pub(super) fn triangles(points: &[DVec3]) -> Option<Vec<Vec<usize>>> {
    let at = |i: usize| points.get(i).copied().unwrap_or_default();
    let n = points.len();
    let b = (1..n).find(|&i| at(i) != at(0))?;
    let c = (1..n).find(|&i| (at(b) - at(0)).cross(at(i) - at(0)) != DVec3::ZERO)?;
    let d = (1..n).find(|&i| behind(at(0), at(b), at(c), at(i)) != 0.0)?;
    let mut faces = if behind(at(0), at(b), at(c), at(d)) > 0.0 {
        vec![[0, b, c], [b, 0, d], [c, b, d], [0, c, d]]
    } else {
        vec![[0, c, b], [0, b, d], [b, c, d], [c, 0, d]]
    };
    for i in 0..n {
        let (seen, mut kept): (Vec<[usize; 3]>, Vec<[usize; 3]>) = faces
            .iter()
            .partition(|[a, b, c]| behind(at(*a), at(*b), at(*c), at(i)) < 0.0);
        if seen.is_empty() {
            continue;
        }
        let edges = |[a, b, c]: [usize; 3]| [(a, b), (b, c), (c, a)];
        let all: BTreeSet<(usize, usize)> = seen.iter().copied().flat_map(edges).collect();
        let rim = all.iter().filter(|(a, b)| !all.contains(&(*b, *a)));
        kept.extend(rim.map(|&(a, b)| [a, b, i]));
        faces = kept;
    }
    Some(faces.into_iter().map(|face| face.to_vec()).collect())
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
