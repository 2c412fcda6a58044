//! `linear_extrude` with a twist, in layers as OpenSCAD makes them: between two turned sections
//! each edge becomes two triangles, split along the shorter diagonal or, of equal ones, the one that
//! makes the layer convex there.

use super::super::{combine, polyhedron};
use super::loops::Loops;
use super::read::Twist;
use super::{doubled_area, solid::Refusal};
use csg::{ModelBuilder, Node, NodeId};
use glam::{DMat2, DVec2, DVec3};

/// Relative difference of squared lengths that are equal but for rounding.
const SAME: f64 = 1e-9;

/// The union of the layers.
pub(super) fn layers(
    loops: &Loops,
    [z0, z1]: [f64; 2],
    scale: DVec2,
    twist: &Twist,
    builder: &mut ModelBuilder,
) -> Result<NodeId, Refusal> {
    let section = |layer: u32| {
        let t = f64::from(layer) / f64::from(twist.slices);
        let turn = DMat2::from_angle(-(twist.degrees * t).to_radians());
        let factors = DVec2::ONE + (scale - DVec2::ONE) * t;
        let z = z0 + (z1 - z0) * t;
        move |p: DVec2| (factors * (turn * p)).extend(z)
    };
    let mut all = Vec::new();
    for layer in 0..twist.slices {
        let (below, above) = (section(layer), section(layer + 1));
        let mut triangles: Vec<[DVec3; 3]> = Vec::new();
        for one in &loops.all {
            let is_hole = doubled_area(one) < 0.0;
            for (&p, &q) in one.iter().zip(one.iter().cycle().skip(1)) {
                let (a, b, c, d) = (below(p), below(q), above(q), above(p));
                let (ac, bd) = (a.distance_squared(c), b.distance_squared(d));
                let are_equal = (ac - bd).abs() <= SAME * (ac + bd);
                let along_bd = if are_equal {
                    (twist.degrees > 0.0) == is_hole
                } else {
                    bd < ac
                };
                if along_bd {
                    triangles.extend([[a, b, d], [d, b, c]]);
                } else {
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        let walls = polyhedron::walls(triangles).map_err(|fault| match fault {
            polyhedron::Fault::Numbers(error) => Refusal::Numbers(error),
            polyhedron::Fault::Unsound(_) => Refusal::Twisted,
        })?;
        all.push(combine::formula(walls, builder));
    }
    Ok(builder.add(Node::Union(all)))
}
