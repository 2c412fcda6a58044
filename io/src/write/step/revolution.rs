//! Surfaces of revolution.
//!
//! Readers close a belt around the axis themselves. Where the face goes on to a pole they do not:
//! such a face is cut open along a meridian, from a vertex of its loop to the pole.

use super::cut::{Cut, Start};
use super::meridian::{Meridian, SPANS, arc};
use super::quadric::{Found, Quadric};
use super::rational::{Coefficients, Rational, steps};
use super::region::Region;
use super::seam;
use brep::{ExactBrep, ExactFace};
use glam::DVec3;

/// Part of a distance that counts as none.
const SAME: f64 = 1e-6;
/// Halvings of an interval of parameters, until nothing is left to halve.
const BISECTIONS: usize = 60;

/// A torus of which the tube is wider than the ring, on the side of the axis where a point of it
/// is; `None` if the poles are nearly one.
pub(super) fn spindle(
    [center, axis, across]: [DVec3; 3],
    [ring, tube]: [f64; 2],
    at: DVec3,
) -> Option<Found> {
    /// Largest ratio of ring and tube: at 1 both poles are one.
    const HORN: f64 = 0.999;
    if ring > HORN * tube {
        return None;
    }
    let height = (at - center).dot(axis);
    let radius = (at - center).reject_from_normalized(axis).length();
    let off = |middle: f64| ((radius - middle).hypot(height) - tube).abs();
    let is_outer = off(ring) < off(-ring);
    let bound = if is_outer {
        (-ring / tube).acos()
    } else {
        (ring / tube).acos()
    };
    let ring = if is_outer { ring } else { -ring };
    let meridian = Meridian {
        radius: [ring + tube, 0.0, ring - tube],
        height: [0.0, 2.0 * tube, 0.0],
        weight: [1.0, 0.0, 1.0],
        breaks: arc(bound),
        poles: [true; 2],
    };
    Some(turned(center, axis, across, 1.0, &meridian))
}

/// A face on a surface of revolution. Within its only loop may be a pole: then the face is cut open
/// between both. `None` if that does not suffice.
pub(super) fn turned_face(
    exact: &ExactBrep,
    face: &ExactFace,
    region: &Region,
    [origin, axis]: [DVec3; 2],
    size: f64,
    meridian: &Meridian,
) -> Option<Found> {
    let across = seam::direction(exact, face, origin, axis);
    let plain = turned(origin, axis, across, size, meridian);
    let Quadric::Revolution(profile) = &plain.quadric else {
        return None;
    };
    let ends = [profile.breaks[0].first(), profile.breaks[0].last()];
    let mut within = Vec::new();
    for (at, end) in ends.into_iter().enumerate() {
        let pole = profile.homogeneous(*end?, 0.0);
        let pole = pole.truncate() / pole.w;
        // From within to the pole and on.
        let from = origin + axis * (plain.at - origin).dot(axis);
        if meridian.poles[at] && region.is_hit(from, pole - from) {
            within.push((at == 0, pole));
        }
    }
    let &[(is_from_pole, pole)] = &within[..] else {
        return within.is_empty().then_some(plain);
    };
    let [ring] = &face.loops[..] else {
        return None;
    };
    let start = |half_edge: usize| exact.edges[half_edge / 2].piece.ends[half_edge % 2];
    let place = (0..ring.len()).min_by(|&a, &b| {
        let far = |at: usize| start(ring[at]).distance(pole);
        far(a).total_cmp(&far(b))
    })?;
    let vertex = start(ring[place]);
    let across = (vertex - origin)
        .reject_from_normalized(axis)
        .try_normalize()?;
    // Nothing else of the boundary may be where it is cut.
    let side = axis.cross(across);
    let crosses = region.chords().any(|[from, to]| {
        let [u, v] = [from, to].map(|point| (point - origin).dot(side));
        let point = from.lerp(to, u / (u - v));
        u * v < 0.0
            && (point - origin).dot(across) > 0.0
            && point.distance(vertex) > SAME * vertex.distance(pole)
            && point.distance(pole) < vertex.distance(pole)
    });
    if crosses {
        return None;
    }
    let mut found = turned(origin, axis, across, size, meridian);
    let Quadric::Revolution(profile) = &found.quadric else {
        return None;
    };
    // The parameter of the vertex: distances from the pole grow along the meridian.
    let [mut near, mut far] = [*profile.breaks[0].first()?, *profile.breaks[0].last()?];
    if !is_from_pole {
        (near, far) = (far, near);
    }
    let end = near;
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (near + far);
        let point = profile.homogeneous(middle, 0.0);
        if (point.truncate() / point.w).distance(pole) < vertex.distance(pole) {
            near = middle;
        } else {
            far = middle;
        }
    }
    let ends = if is_from_pole { [end, far] } else { [far, end] };
    let mut curve = profile.clone();
    curve.breaks[0] = steps(ends, SPANS);
    found.cut = Some(Cut {
        starts: vec![Start {
            ring: 0,
            place,
            parameter: None,
        }],
        pole: Some(pole),
        curve,
        is_reversed: is_from_pole,
    });
    Some(found)
}

/// A surface of revolution.
fn turned(origin: DVec3, axis: DVec3, across: DVec3, size: f64, meridian: &Meridian) -> Found {
    let mut coefficients = Coefficients::default();
    for (i, row) in coefficients.iter_mut().enumerate() {
        let (radius, height) = (size * meridian.radius[i], meridian.height[i]);
        let weight = meridian.weight[i];
        let place = origin * weight + across * radius + axis * height;
        row[0] = place.extend(weight);
    }
    let profile = Rational {
        coefficients,
        breaks: [meridian.breaks.clone(), vec![0.0]],
    };
    let (at, along, _) = profile.tangents();
    Found {
        quadric: Quadric::Revolution(Box::new(profile)),
        origin,
        axis,
        across,
        outward: axis.cross(across).cross(along),
        at,
        cut: None,
    }
}
