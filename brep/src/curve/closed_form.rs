//! Lines, circles and ellipses.
//!
//! Candidates come from the axes, centres and normals of the surfaces, and from points of the
//! edge. Whichever rule proposed it, a candidate is taken only if both polynomials vanish along
//! it: restricted to a line they have degree n in the parameter, on an ellipse they are
//! trigonometric polynomials of degree n, so n + 1 and 2n + 1 zeros suffice.

use super::meet::Meet;
use super::{Chain, Curve, plane_conic};
use csg::{Primitive, PrimitiveId, Solid, Surface};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Largest distance of a curve from its surfaces, relative to the domain.
const ON_SURFACE: f64 = 1e-11;
/// Largest distance of the chain's points from the curve, relative to the domain.
const ON_CURVE: f64 = 1e-8;
/// How many points of the chain are used for candidates.
const SAMPLES: usize = 12;

/// The closed form of an edge's curve, and its range.
pub(super) fn find(
    solid: &Solid,
    primitives: &[PrimitiveId],
    chain: &Chain,
) -> Option<(Curve, [f64; 2])> {
    let pair: Vec<&Primitive> = primitives
        .iter()
        .filter_map(|id| solid.primitives.get(id.0 as usize))
        .collect();
    let &[p, q] = &pair[..] else {
        return None;
    };
    let search = Search {
        solid,
        pair: [p, q],
        surfaces: [p, q].map(|primitive| primitive.surface(&solid.domain)),
        samples: samples(Meet::new(solid, primitives), chain),
        chain,
    };
    search
        .lines()
        .into_iter()
        .chain(search.circles())
        .chain(search.ellipses())
        .find_map(|candidate| search.accept(&candidate))
}

/// Some of the chain's points, in order.
fn samples(meet: Meet<'_>, chain: &Chain) -> Vec<DVec3> {
    let last = chain.points.len() - 1;
    let count = SAMPLES.min(last);
    // A chain of one mesh edge has nothing but its ends.
    if last == 1 {
        let [a, b] = [chain.points[0], chain.points[1]];
        let middle = meet.solve(a.midpoint(b), 0.5 * a.distance(b));
        return [Some(a), middle, Some(b)].into_iter().flatten().collect();
    }
    let at = |k| chain.points[k * last / count];
    (0..=count).map(at).collect()
}

struct Search<'a> {
    solid: &'a Solid,
    pair: [&'a Primitive; 2],
    surfaces: [Surface; 2],
    samples: Vec<DVec3>,
    chain: &'a Chain,
}

impl Search<'_> {
    fn lines(&self) -> Vec<Curve> {
        let mut directions = Vec::new();
        let [a, b] = &self.surfaces;
        if let [
            Surface::Plane { normal: m, .. },
            Surface::Plane { normal: n, .. },
        ] = [a, b]
        {
            directions.extend(m.cross(*n).try_normalize());
        }
        if self.chain.is_closed {
            return Vec::new();
        }
        let (Some(&first), Some(&last)) = (self.samples.first(), self.samples.last()) else {
            return Vec::new();
        };
        let middle = self.samples[self.samples.len() / 2];
        for surface in [a, b] {
            match *surface {
                Surface::Cylinder { axis, .. } => directions.push(axis),
                Surface::Cone { apex, .. } => {
                    let far = if first.distance(apex) > last.distance(apex) {
                        first
                    } else {
                        last
                    };
                    directions.extend((far - apex).try_normalize());
                }
                _ => {}
            }
        }
        directions.extend((last - first).try_normalize());
        directions
            .into_iter()
            .map(|direction| Curve::Line {
                point: middle,
                direction,
            })
            .collect()
    }

    fn circles(&self) -> Vec<Curve> {
        let Some(&point) = self.samples.get(self.samples.len() / 2) else {
            return Vec::new();
        };
        let [a, b] = &self.surfaces;
        let mut axes: Vec<(DVec3, DVec3)> = [a, b].into_iter().filter_map(axis).collect();
        for (this, other) in [(a, b), (b, a)] {
            let Surface::Sphere { center, .. } = *this else {
                continue;
            };
            match *other {
                Surface::Plane { normal, .. } => axes.push((center, normal)),
                Surface::Sphere { center: second, .. } => {
                    axes.extend((second - center).try_normalize().map(|d| (center, d)));
                }
                _ => {}
            }
        }
        for (this, other) in [(a, b), (b, a)] {
            if let (
                &Surface::Torus {
                    center, axis, ring, ..
                },
                &Surface::Plane { normal, .. },
            ) = (this, other)
            {
                let outward = (point - center).reject_from_normalized(axis);
                let outward = outward.reject_from_normalized(normal);
                axes.extend(outward.try_normalize().map(|d| (center + d * ring, normal)));
            }
        }
        let mut circles: Vec<Curve> = axes
            .into_iter()
            .filter_map(|(through, axis)| circle(through, axis, point))
            .collect();
        circles.extend(self.circle_through_samples());
        circles
    }

    /// For circles that no axis explains, such as Villarceau's.
    fn circle_through_samples(&self) -> Option<Curve> {
        let [a, b, c] = self.spread()?;
        let (u, v) = (b - a, c - a);
        let normal = u.cross(v);
        let square = normal.length_squared();
        let to_center = (u.length_squared() * v - v.length_squared() * u).cross(normal);
        let center = a + to_center / (2.0 * square);
        circle(center, normal.try_normalize()?, a)
    }

    /// Three points far from each other, if the edge bends visibly.
    fn spread(&self) -> Option<[DVec3; 3]> {
        let samples = &self.samples;
        let count = samples.len();
        if count < 3 {
            return None;
        }
        let triple = if self.chain.is_closed {
            [samples[0], samples[count / 3], samples[2 * count / 3]]
        } else {
            [samples[0], samples[count / 2], samples[count - 1]]
        };
        let [a, b, c] = triple;
        let area = (b - a).cross(c - a).length();
        (area > 0.02 * (c - a).length_squared().max((b - a).length_squared())).then_some(triple)
    }

    fn ellipses(&self) -> Vec<Curve> {
        let Some(&point) = self.samples.get(self.samples.len() / 2) else {
            return Vec::new();
        };
        let mut normals = Vec::new();
        match self.surfaces {
            [Surface::Plane { normal, .. }, _] | [_, Surface::Plane { normal, .. }] => {
                normals.push(normal);
            }
            [
                Surface::Cylinder { axis: a, .. } | Surface::Cone { axis: a, .. },
                Surface::Cylinder { axis: b, .. } | Surface::Cone { axis: b, .. },
            ] => {
                // Equal cylinders that cross, and their like.
                normals.extend((a + b).try_normalize());
                normals.extend((a - b).try_normalize());
            }
            _ => {}
        }
        if let Some([a, b, c]) = self.spread() {
            normals.extend((b - a).cross(c - a).try_normalize());
        }
        let domain = &self.solid.domain;
        let near = domain.to_centered(point);
        let mut ellipses = Vec::new();
        for normal in normals {
            for primitive in self.pair {
                if let Some((center, across)) =
                    plane_conic::ellipse(&primitive.polynomial, normal, near)
                {
                    let across = across.map(|axis| axis * domain.half_size());
                    let center = domain.from_centered(center);
                    ellipses.push(Curve::Ellipse { center, across });
                }
            }
        }
        ellipses
    }

    /// The candidate with its parameter growing along the chain, and its range, if the chain
    /// follows it and both surfaces hold it.
    fn accept(&self, candidate: &Curve) -> Option<(Curve, [f64; 2])> {
        let size = self.solid.domain.size();
        let off = |point: DVec3| candidate.point(candidate.parameter(point)).distance(point);
        let mut points = self.samples.iter().chain(&self.chain.points);
        if points.any(|&point| off(point) > ON_CURVE * size) {
            return None;
        }
        let (curve, range) = self.oriented(candidate)?;
        let holds = self
            .pair
            .iter()
            .all(|primitive| self.vanishes(primitive, &curve, range));
        holds.then_some((curve, range))
    }

    fn oriented(&self, candidate: &Curve) -> Option<(Curve, [f64; 2])> {
        let points = &self.chain.points;
        let (first, last) = (points[0], points[points.len() - 1]);
        match *candidate {
            Curve::Line { point, direction } => {
                let direction = if (last - first).dot(direction) < 0.0 {
                    -direction
                } else {
                    direction
                };
                let origin = point + direction * (first - point).dot(direction);
                let length = (last - first).dot(direction);
                let line = Curve::Line {
                    point: origin,
                    direction,
                };
                (length > 0.0).then_some((line, [0.0, length]))
            }
            Curve::Circle { center, across } => {
                // Start at the edge's start.
                let normal = across[0].cross(across[1]).try_normalize()?;
                let radius = across[0].length();
                let sweep = self.sweep(&Curve::Circle { center, across })?;
                let x = (first - center)
                    .reject_from_normalized(normal)
                    .try_normalize()?
                    * radius;
                let y = normal.cross(x) * sweep.signum();
                let across = [x, y];
                Some((Curve::Circle { center, across }, [0.0, sweep.abs()]))
            }
            Curve::Ellipse { center, across } => {
                let sweep = self.sweep(&Curve::Ellipse { center, across })?;
                let across = [across[0], across[1] * sweep.signum()];
                let ellipse = Curve::Ellipse { center, across };
                let start = ellipse.parameter(first);
                Some((ellipse, [start, start + sweep.abs()]))
            }
            Curve::Traced { .. } => None,
        }
    }

    /// The angle along the chain: a full turn, with its sign, if it is closed.
    fn sweep(&self, arc: &Curve) -> Option<f64> {
        let angles = self.chain.points.iter().map(|&point| arc.parameter(point));
        let mut angles = angles;
        let first = angles.next()?;
        let mut last = first;
        let mut sweep = 0.0;
        for angle in angles {
            let step = angle - last;
            sweep += step - TAU * ((step + PI) / TAU).floor();
            last = angle;
        }
        let returns = self.chain.points.first() == self.chain.points.last();
        let is_whole = (sweep.abs() - TAU).abs() < 0.5;
        match (returns, is_whole) {
            (true, true) => Some(TAU.copysign(sweep)),
            (true, false) => None,
            (false, _) => (sweep.abs() > 0.0 && sweep.abs() < TAU).then_some(sweep),
        }
    }

    /// Whether the primitive is zero along the curve.
    fn vanishes(&self, primitive: &Primitive, curve: &Curve, range: [f64; 2]) -> bool {
        let p = &primitive.polynomial;
        let degree = p.degree();
        let pieces = match curve {
            Curve::Line { .. } => degree.max(1),
            _ => 2 * degree,
        };
        let terms = p.coefficients().len() as f64;
        let noise = terms * (primitive.coefficient_error + 4.0 * f64::EPSILON);
        (0..=pieces).all(|k| {
            let t = range[0] + (range[1] - range[0]) * (k as f64 / pieces as f64);
            let at = self.solid.domain.to_centered(curve.point(t));
            p.evaluate(at).abs() <= noise + ON_SURFACE * p.gradient(at).length()
        })
    }
}

/// The axis of a surface of revolution: a point and a direction.
fn axis(surface: &Surface) -> Option<(DVec3, DVec3)> {
    match *surface {
        Surface::Cylinder { point, axis, .. } => Some((point, axis)),
        Surface::Cone { apex, axis, .. } => Some((apex, axis)),
        Surface::Torus { center, axis, .. } => Some((center, axis)),
        _ => None,
    }
}

/// The circle about an axis through a point.
fn circle(through: DVec3, axis: DVec3, point: DVec3) -> Option<Curve> {
    let from = point - through;
    let x = from.reject_from_normalized(axis);
    let center = through + from.project_onto_normalized(axis);
    let y = axis.cross(x);
    (x.length() > 0.0).then_some(Curve::Circle {
        center,
        across: [x, y],
    })
}
