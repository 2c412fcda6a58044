//! Elliptic cones, hyperboloids and cylinders all around their axis: rational splines that are closed,
//! and cut open along a meridian that crosses each loop once.

use super::cut::{Cut, Start};
use super::meridian::{Meridian, SPANS, parameter};
use super::quadric::{CIRCLE, Found, Quadric};
use super::rational::{Coefficients, Rational, steps};
use super::region::Region;
use brep::{Curve, ExactBrep, ExactFace};
use csg::QuadricForm;
use glam::{DVec3, DVec4};
use std::f64::consts::TAU;
use step_io::scene::NurbsSurface;

/// Meridians tried.
const TRIED: u32 = 24;
/// Points on an edge between which it may cross a meridian.
const SAMPLES: usize = 64;
/// Halvings of an interval of parameters, until nothing is left to halve.
const BISECTIONS: usize = 60;

/// A face that goes around the axis, with a loop on both sides, or one and a pole.
pub(super) fn face(
    form: &QuadricForm,
    exact: &ExactBrep,
    face: &ExactFace,
    region: &Region,
    meridian: &Meridian,
) -> Option<Found> {
    let [x, y, z] = form.axes;
    let [a, b, _] = form.sizes;
    let local = |point: DVec3| {
        let from = point - form.center;
        DVec3::new(from.dot(x) / a, from.dot(y) / b, from.dot(z))
    };
    let begin = *meridian.breaks.first()?;
    let pole = {
        let [radius, height, weight] = meridian.at(begin);
        let pole = form.center + z * (height / weight);
        let middle = 0.5 * (begin + meridian.breaks.last()?);
        let [_, inside, weight] = meridian.at(middle);
        let inside = form.center + z * (inside / weight);
        let is_pole = radius.abs() <= 1e-12 && region.is_hit(inside, pole - inside);
        is_pole.then_some(pole)
    };
    if face.loops.len() != 2 - usize::from(pole.is_some()) {
        return None;
    }
    let (angle, starts) = (0..TRIED).find_map(|k| {
        // Off the axes, on which edges like to begin.
        let angle = TAU * ((f64::from(k) + 0.37) / f64::from(TRIED));
        let starts = (0..face.loops.len()).map(|ring| crossing(exact, face, ring, angle, local));
        Some((angle, starts.collect::<Option<Vec<_>>>()?))
    })?;
    let heights: Vec<f64> = starts
        .iter()
        .map(|(_, point)| parameter(form, local(*point).z))
        .collect();
    let first = *heights.first()?;
    let second = heights.get(1).copied().unwrap_or(begin);
    let (sine, cosine) = angle.sin_cos();
    let spoke = x * (a * cosine) + y * (b * sine);
    let mut coefficients = Coefficients::default();
    for (i, row) in coefficients.iter_mut().enumerate() {
        let (radius, height) = (meridian.radius[i], meridian.height[i]);
        let weight = meridian.weight[i];
        row[0] = (form.center * weight + spoke * radius + z * height).extend(weight);
    }
    let curve = Rational {
        coefficients,
        breaks: [
            steps([first.min(second), first.max(second)], SPANS),
            vec![0.0],
        ],
    };
    let (at, along, _) = curve.tangents();
    let around = y * (b * cosine) - x * (a * sine);
    let spline = spline(form, meridian, angle)?;
    Some(Found {
        quadric: Quadric::Closed(Box::new(spline)),
        origin: form.center,
        axis: z,
        across: spoke.normalize_or(x),
        outward: around.cross(along),
        at,
        cut: Some(Cut {
            starts: starts.into_iter().map(|(start, _)| start).collect(),
            pole,
            curve: Box::new(curve),
            is_reversed: first > second,
        }),
    })
}

/// Where a loop crosses the half-plane at an angle, if it does so once, and on a conic.
fn crossing(
    exact: &ExactBrep,
    face: &ExactFace,
    ring: usize,
    angle: f64,
    local: impl Fn(DVec3) -> DVec3,
) -> Option<(Start, DVec3)> {
    let (sine, cosine) = angle.sin_cos();
    let side = |point: DVec3| {
        let from = local(point);
        (
            from.y * cosine - from.x * sine,
            from.x * cosine + from.y * sine,
        )
    };
    let mut found = None;
    for (place, half_edge) in face.loops[ring].iter().enumerate() {
        let piece = &exact.edges[half_edge / 2].piece;
        let [from, to] = piece.range;
        let t = |k: usize| from + (to - from) * (k as f64 / SAMPLES as f64);
        for k in 0..SAMPLES {
            let [mut low, mut high] = [t(k), t(k + 1)];
            let [(u, ahead), (v, _)] = [low, high].map(|t| side(piece.curve.point(t)));
            if (u < 0.0) == (v < 0.0) || ahead < 0.0 {
                continue;
            }
            let is_conic = matches!(piece.curve, Curve::Circle { .. } | Curve::Ellipse { .. });
            if found.is_some() || !is_conic {
                return None;
            }
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (low + high);
                if (side(piece.curve.point(middle)).0 < 0.0) == (u < 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let start = Start {
                ring,
                place,
                parameter: Some(low),
            };
            found = Some((start, piece.curve.point(low)));
        }
    }
    found
}

/// All of the surface, beginning at an angle.
fn spline(form: &QuadricForm, meridian: &Meridian, angle: f64) -> Option<NurbsSurface> {
    let [x, y, z] = form.axes;
    let [a, b, _] = form.sizes;
    let mut coefficients = Coefficients::default();
    for (i, row) in coefficients.iter_mut().enumerate() {
        let (radius, height) = (meridian.radius[i], meridian.height[i]);
        row[0] = DVec4::new(radius, 0.0, height, meridian.weight[i]);
    }
    let profile = Rational {
        coefficients,
        breaks: [meridian.breaks.clone(), vec![0.0]],
    };
    let profile = profile.curve(1.0)?;
    let (sine, cosine) = angle.sin_cos();
    let row = |[u, v, _]: [f64; 3]| {
        let spoke = x * (a * (u * cosine - v * sine)) + y * (b * (u * sine + v * cosine));
        let corner = |&[radius, _, height]: &[f64; 3]| {
            (form.center + spoke * radius + z * height).to_array()
        };
        profile.control_points.iter().map(corner).collect()
    };
    let weights = |across: [f64; 3]| profile.weights.iter().map(|w| across[2] * w).collect();
    Some(NurbsSurface {
        degree_u: 2,
        degree_v: 2,
        control_points: CIRCLE.map(row).to_vec(),
        weights: CIRCLE.map(weights).to_vec(),
        knots_u: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
        knots_v: profile.knots,
    })
}
