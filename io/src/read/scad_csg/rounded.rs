//! Solids with closed forms among hulls and Minkowski sums: rounded polyhedra, prisms with
//! rounded edges, and what turns about an axis.

use super::ball_hull::{self, Ball, MAX_BALLS};
use super::figure::{self, Extrusion, Figures, Refusal};
use super::point_hull;
use super::polyhedron::dented;
use csg::{Error, ModelBuilder, Node, NodeId, Shape, Transform};
use glam::{DVec2, DVec3};

/// Relative distance within which positions count as equal: dumps hold six digits.
const SAME: f64 = 1e-6;

/// Relative error of computed points.
const ROUNDING: f64 = 1e-12;

/// Hulls with more triangles are written as formulas in which few planes matter in each place.
const MANY_FACES: usize = 600;

/// A solid, if it has volume.
pub(super) type Made = Result<Option<NodeId>, Error>;

/// The convex hull of points as a polyhedron; points less than `near` beyond the hull of the
/// others may be left out.
pub(super) fn polyhedron(points: &[DVec3], near: f64, builder: &mut ModelBuilder) -> Made {
    let near = near.max(ROUNDING * point_hull::span(points));
    let Some(mut faces) = point_hull::triangles(points, near) else {
        return Ok(None);
    };
    let vertices = point_hull::used(points, &mut faces);
    if faces.len() > MANY_FACES {
        let at = |v: &usize| vertices.get(*v).copied().unwrap_or_default();
        let polygons = faces.iter().map(|f| f.iter().map(at).collect()).collect();
        if let Ok(polyhedron) = dented(polygons) {
            return Ok(Some(polyhedron.add_to(builder)));
        }
    }
    let shape = Shape::convex_hull(&vertices, &faces)?;
    Ok(Some(builder.add(Node::Shape(shape))))
}

/// The convex hull of balls and points, `None` outside if there are too many.
pub(super) fn round_hull(
    points: &[DVec3],
    balls: &[Ball],
    builder: &mut ModelBuilder,
) -> Option<Made> {
    let corners = match point_hull::triangles(points, 0.0) {
        Some(mut faces) => point_hull::used(points, &mut faces),
        None => points.to_vec(),
    };
    let mut all: Vec<Ball> = corners.into_iter().map(|p| (p, 0.0)).collect();
    all.extend(balls);
    (all.len() <= MAX_BALLS).then(|| ball_hull::hull(&all, builder))
}

/// Coordinates in which an axis is z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    origin: DVec3,
    x: DVec3,
    y: DVec3,
    z: DVec3,
    size: f64,
}

impl Axis {
    /// `size`: of what is looked at, for what counts as equal.
    pub(super) fn new(origin: DVec3, along: DVec3, size: f64) -> Option<Self> {
        let z = along.try_normalize()?;
        let (x, y) = if z.z.abs() > 1.0 - 1e-12 {
            (DVec3::X, DVec3::Y * z.z.signum())
        } else {
            let (x, _) = z.any_orthonormal_pair();
            (x, z.cross(x))
        };
        Some(Self {
            origin,
            x,
            y,
            z,
            size,
        })
    }

    pub(super) fn local(&self, p: DVec3) -> DVec3 {
        let p = p - self.origin;
        DVec3::new(self.x.dot(p), self.y.dot(p), self.z.dot(p))
    }

    pub(super) fn is_same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= SAME * self.size
    }

    fn placed(&self, node: NodeId, builder: &mut ModelBuilder) -> Result<NodeId, Error> {
        let row = |k: usize| [self.x[k], self.y[k], self.z[k], self.origin[k]];
        let at = Transform::from_columns(&[row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]])?;
        Ok(builder.add(Node::Instance(at, node)))
    }

    /// The convex hull of discs in the plane, between two heights.
    pub(super) fn prism(
        &self,
        discs: Vec<(DVec2, f64)>,
        [z0, z1]: [f64; 2],
        figures: &mut Figures,
        builder: &mut ModelBuilder,
    ) -> Made {
        let Some(figure) = figures.hull_of_discs(discs) else {
            return Ok(None);
        };
        let extrusion = Extrusion::Linear {
            z0,
            z1,
            scale: DVec2::ONE,
            lean: DVec2::ZERO,
            twist: None,
        };
        self.extruded(figure, &extrusion, figures, builder)
    }

    /// The convex hull of discs beside the axis, (distance, height) and radius, turned about it.
    pub(super) fn turned(
        &self,
        discs: &[(DVec2, f64)],
        figures: &mut Figures,
        builder: &mut ModelBuilder,
    ) -> Made {
        let mirrored = discs.iter().map(|(p, r)| (DVec2::new(-p.x, p.y), *r));
        let both: Vec<(DVec2, f64)> = discs.iter().copied().chain(mirrored).collect();
        let reach = |p: &(DVec2, f64)| p.0.abs().max_element() + p.1;
        let reach = 2.0 * both.iter().map(reach).fold(0.0, f64::max);
        let Some(whole) = figures.hull_of_discs(both) else {
            return Ok(None);
        };
        let half = figures.right_of_axis(whole, reach);
        let extrusion = Extrusion::Revolved {
            start: 0.0,
            angle: 360.0,
            steps: None,
        };
        self.extruded(half, &extrusion, figures, builder)
    }

    fn extruded(
        &self,
        figure: figure::FigureId,
        extrusion: &Extrusion,
        figures: &Figures,
        builder: &mut ModelBuilder,
    ) -> Made {
        match figure::extrude(figures, figure, extrusion, builder) {
            Ok(Some(solid)) => self.placed(solid, builder).map(Some),
            Ok(None) | Err(Refusal::AcrossTheAxis | Refusal::Twisted) => Ok(None),
            Err(Refusal::Numbers(error)) => Err(error),
        }
    }
}

/// The two heights that all points have, and the plane positions of each height; `None` unless
/// both heights show the same positions.
pub(super) fn as_prism(points: &[DVec3], axis: &Axis) -> Option<(Vec<DVec2>, [f64; 2])> {
    let local: Vec<DVec3> = points.iter().map(|p| axis.local(*p)).collect();
    let low = local.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let high = local.iter().map(|p| p.z).fold(f64::NEG_INFINITY, f64::max);
    let at = |z: f64| -> Vec<DVec2> {
        let there = local.iter().filter(|p| axis.is_same(p.z, z));
        there.map(|p| p.truncate()).collect()
    };
    let (bottom, top) = (at(low), at(high));
    let within = |some: &[DVec2], others: &[DVec2]| {
        some.iter()
            .all(|p| others.iter().any(|q| axis.is_same(p.distance(*q), 0.0)))
    };
    let only_two = local
        .iter()
        .all(|p| axis.is_same(p.z, low) || axis.is_same(p.z, high));
    (only_two && within(&bottom, &top) && within(&top, &bottom)).then_some((bottom, [low, high]))
}
