//! Quadrics, and tori that cross themselves: surfaces that STEP has no entity for, where splines
//! or bodies of revolution say them exactly.
//!
//! | surface | becomes |
//! | --- | --- |
//! | paraboloid, hyperboloid, spheroid of revolution, spindle torus | surface of revolution of a conic |
//! | whole ellipsoid | image of a sphere as a rational spline |
//! | elliptic cylinder | ellipse that is moved along a line |
//! | saddle, elliptic paraboloid, parabolic and hyperbolic cylinder | (rational) biquadratic patch |
//! | other elliptic ones, if the face leaves a gap | rational biquadratic patch, open in the gap |
//! | the same, all around | closed rational spline, cut open along a meridian |
//!
//! A patch that is open has no seam: readers of closed ones find the right side of edges only if
//! there are none. Source: Piegl and Tiller, *The NURBS Book*, chapters 7 and 8.

use super::closed;
use super::cut::Cut;
use super::describe::point;
use super::meridian::{self, Meridian, SPANS, arc};
use super::rational::{Coefficients, Rational, ratios, steps};
use super::region::Region;
use super::revolution::turned_face;
use brep::{ExactBrep, ExactFace};
use csg::{QuadricForm, QuadricKind};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use step_io::build::{CurveInput, Frame, ProfileInput, SurfaceInput};
use step_io::scene::NurbsSurface;

/// A surface in STEP's terms, in model units.
#[derive(Clone, Debug)]
pub(super) enum Quadric {
    /// All of an ellipsoid, with these semi-axes; its poles are on the third one.
    Ellipsoid([DVec3; 3]),
    /// A cylinder over the ellipse with the first two semi-axes; the third one is its direction.
    Cylinder([DVec3; 3]),
    /// What a curve, in the half-plane of the seam, leaves behind when it turns about the axis.
    Revolution(Box<Rational>),
    /// An open patch.
    Patch(Box<Rational>),
    /// A spline that is closed in its first parameter, in units of length 1.
    Closed(Box<NurbsSurface>),
}

/// A surface with the direction of STEP's normal at one of its points.
pub(super) struct Found {
    pub(super) quadric: Quadric,
    pub(super) origin: DVec3,
    pub(super) axis: DVec3,
    pub(super) across: DVec3,
    pub(super) outward: DVec3,
    pub(super) at: DVec3,
    /// Where a surface of revolution is to be cut open, from an edge to its pole.
    pub(super) cut: Option<Cut>,
}

/// A circle about the origin: corners of its control polygon and their weights.
pub(super) const CIRCLE: [[f64; 3]; 9] = [
    [1.0, 0.0, 1.0],
    [1.0, 1.0, FRAC_1_SQRT_2],
    [0.0, 1.0, 1.0],
    [-1.0, 1.0, FRAC_1_SQRT_2],
    [-1.0, 0.0, 1.0],
    [-1.0, -1.0, FRAC_1_SQRT_2],
    [0.0, -1.0, 1.0],
    [1.0, -1.0, FRAC_1_SQRT_2],
    [1.0, 0.0, 1.0],
];
/// Relative difference of semi-axes that are one: what is left of it is rounding.
const ROUND: f64 = 1e-10;
/// Narrowest cone about a direction, in radians, in which an ellipsoid may be left open.
const CLEARING: f64 = 0.2;
/// Least distance of ends of edges from where a cylinder is cut open, in semi-axes.
const CLEAR: f64 = 1e-3;

/// The surface of a face on a quadric; `None` where there is no form.
pub(super) fn of(
    form: &QuadricForm,
    exact: &ExactBrep,
    face: &ExactFace,
    region: &Region,
    at: DVec3,
) -> Option<Found> {
    let [x, y, z] = form.axes;
    let [a, b, c] = form.sizes;
    let origin = form.center;
    let local = |point: DVec3| {
        let from = point - origin;
        DVec3::new(from.dot(x), from.dot(y), from.dot(z))
    };
    let is_round = (a - b).abs() <= ROUND * a;
    if form.kind == QuadricKind::Ellipsoid && face.loops.is_empty() {
        return Some(Found {
            quadric: Quadric::Ellipsoid([x * a, y * b, z * c]),
            origin,
            axis: z,
            across: x,
            outward: at - origin,
            at,
            cut: None,
        });
    }
    if form.kind == QuadricKind::EllipticCylinder
        && let Some(found) = swept(form, exact, face, at)
    {
        return Some(found);
    }
    let spheroid = [(is_round, z, a, c), ((b - c).abs() <= ROUND * b, x, b, a)];
    let spheroid = spheroid.into_iter().find(|turn| turn.0);
    let mut turning = None;
    if let Some((_, axis, radius, height)) = spheroid
        && form.kind == QuadricKind::Ellipsoid
    {
        let meridian = Meridian {
            radius: [1.0, 0.0, -1.0],
            height: [0.0, 2.0 * height, 0.0],
            weight: [1.0, 0.0, 1.0],
            breaks: arc(0.5 * PI),
            poles: [true, true],
        };
        turning = Some((axis, radius, meridian));
    } else if is_round && let Some(meridian) = meridian::of(form, region, local(at), local) {
        turning = Some((z, a, meridian));
    }
    if let Some((axis, radius, meridian)) = turning
        && let Some(found) = turned_face(exact, face, region, [origin, axis], radius, &meridian)
    {
        return Some(found);
    }
    if let Some(coefficients) = rectangle(form, local(at)) {
        // Two of the coordinates are the parameters, up to growth.
        let breaks = if form.kind == QuadricKind::HyperbolicCylinder {
            let [low, high] = region.range(|point| (local(point).y / b).asinh());
            [
                ratios([low.exp(), high.exp()], SPANS),
                steps(region.range(|point| local(point).z), 1),
            ]
        } else {
            [
                steps(region.range(|point| local(point).x), SPANS),
                steps(region.range(|point| local(point).y), SPANS),
            ]
        };
        return patch(form, &coefficients, breaks);
    }
    if form.kind == QuadricKind::Ellipsoid {
        return stereographic(form, region);
    }
    let meridian = meridian::of(form, region, local(at), local)?;
    let gap = region.gap(|point| {
        let from = local(point);
        (from.y / b).atan2(from.x / a)
    });
    let Some([middle, half]) = gap else {
        return closed::face(form, exact, face, region, &meridian);
    };
    let turn = middle + PI;
    let (sine, cosine) = turn.sin_cos();
    let around = [
        [cosine, -2.0 * sine, -cosine],
        [sine, 2.0 * cosine, -sine],
        [1.0, 0.0, 1.0],
    ];
    let mut coefficients = Coefficients::default();
    for (i, row) in coefficients.iter_mut().enumerate() {
        for (j, coefficient) in row.iter_mut().enumerate() {
            *coefficient = DVec4::new(
                a * around[0][i] * meridian.radius[j],
                b * around[1][i] * meridian.radius[j],
                around[2][i] * meridian.height[j],
                around[2][i] * meridian.weight[j],
            );
        }
    }
    let breaks = [arc(PI - 0.5 * half), meridian.breaks];
    patch(form, &coefficients, breaks)
}

/// An elliptic cylinder. Readers cut it open where the ellipse begins: no edge may end there.
fn swept(form: &QuadricForm, exact: &ExactBrep, face: &ExactFace, at: DVec3) -> Option<Found> {
    let [x, y, z] = form.axes;
    let [a, b, _] = form.sizes;
    let clearance = |start: DVec3| {
        let ends = face.loops.iter().flatten();
        let ends = ends.flat_map(|half_edge| exact.edges[half_edge / 2].piece.ends);
        ends.map(|end| {
            let across = (end - form.center).reject_from_normalized(z);
            across.distance(start)
        })
        .fold(f64::INFINITY, f64::min)
    };
    let is_turned = clearance(x * -a) > clearance(x * a);
    let side = if is_turned { -1.0 } else { 1.0 };
    (clearance(x * (a * side)) > CLEAR * b).then(|| Found {
        quadric: Quadric::Cylinder([x * (a * side), y * (b * side), z]),
        origin: form.center,
        axis: z,
        across: x,
        outward: (at - form.center).reject_from_normalized(z),
        at,
        cut: None,
    })
}

/// Quadrics over a rectangle of two parameters.
fn rectangle(form: &QuadricForm, at: DVec3) -> Option<Coefficients> {
    let [a, b, _] = form.sizes;
    let mut all = Coefficients::default();
    all[0][0] = DVec4::W;
    all[1][0] = DVec4::X;
    all[0][1] = DVec4::Y;
    match form.kind {
        QuadricKind::EllipticParaboloid => {
            all[2][0] = DVec4::Z / (2.0 * a);
            all[0][2] = DVec4::Z / (2.0 * b);
        }
        QuadricKind::HyperbolicParaboloid => {
            all[2][0] = DVec4::Z / (2.0 * a);
            all[0][2] = -DVec4::Z / (2.0 * b);
        }
        QuadricKind::ParabolicCylinder => all[2][0] = DVec4::Z / (2.0 * a),
        QuadricKind::HyperbolicCylinder => {
            // x = ±a (s + 1/s) / 2, y = b (s − 1/s) / 2 on one of the branches.
            let a = a.copysign(at.x);
            all = Coefficients::default();
            all[0][0] = DVec4::new(0.5 * a, -0.5 * b, 0.0, 0.0);
            all[1][0] = DVec4::W;
            all[2][0] = DVec4::new(0.5 * a, 0.5 * b, 0.0, 0.0);
            all[1][1] = DVec4::Z;
        }
        _ => return None,
    }
    Some(all)
}

/// A patch, from coefficients in the quadric's own axes.
fn patch(form: &QuadricForm, own: &Coefficients, breaks: [Vec<f64>; 2]) -> Option<Found> {
    let [x, y, z] = form.axes;
    let coefficients =
        own.map(|row| row.map(|p| (form.center * p.w + x * p.x + y * p.y + z * p.z).extend(p.w)));
    let patch = Rational {
        coefficients,
        breaks,
    };
    patch.spline(1.0)?;
    let (at, along_u, along_v) = patch.tangents();
    Some(Found {
        quadric: Quadric::Patch(Box::new(patch)),
        origin: form.center,
        axis: z,
        across: x,
        outward: along_u.cross(along_v),
        at,
        cut: None,
    })
}

/// Part of an ellipsoid, projected from a point of it that is not on the face.
fn stereographic(form: &QuadricForm, region: &Region) -> Option<Found> {
    let [x, y, z] = form.axes;
    let [a, b, c] = form.sizes;
    let (pole, clear) = region.clearing(|point| {
        let from = point - form.center;
        DVec3::new(from.dot(x) / a, from.dot(y) / b, from.dot(z) / c).normalize_or_zero()
    });
    if clear < CLEARING {
        return None;
    }
    let (e, f) = pole.any_orthonormal_pair();
    let sizes = DVec3::new(a, b, c);
    // (2u, 2v, u² + v² − 1) / (1 + u² + v²): the origin is opposite to the pole.
    let mut own = Coefficients::default();
    own[0][0] = (-pole * sizes).extend(1.0);
    own[1][0] = (e * 2.0 * sizes).extend(0.0);
    own[0][1] = (f * 2.0 * sizes).extend(0.0);
    own[2][0] = (pole * sizes).extend(1.0);
    own[0][2] = own[2][0];
    let breaks = arc(PI - 0.7 * clear);
    patch(form, &own, [breaks.clone(), breaks])
}

impl Quadric {
    /// The surface in millimetres.
    pub(super) fn input(&self, origin: DVec3, axis: DVec3, scale: f64) -> Option<SurfaceInput> {
        Some(match self {
            Self::Ellipsoid(axes) => SurfaceInput::Nurbs(ellipsoid(origin, *axes, scale)),
            Self::Cylinder([x, y, z]) => {
                let frame = Frame {
                    origin: point(origin, scale),
                    axis: z.to_array(),
                    ref_dir: x.normalize().to_array(),
                };
                let ellipse = ProfileInput::Ellipse(frame, x.length() * scale, y.length() * scale);
                SurfaceInput::LinearExtrusion(ellipse, z.to_array())
            }
            Self::Revolution(profile) => SurfaceInput::Revolution(
                ProfileInput::Nurbs(profile.curve(scale)?),
                point(origin, scale),
                axis.to_array(),
            ),
            Self::Patch(patch) => SurfaceInput::Nurbs(patch.spline(scale)?),
            Self::Closed(spline) => {
                let mut spline = NurbsSurface::clone(spline);
                for point in spline.control_points.iter_mut().flatten() {
                    *point = point.map(|coordinate| coordinate * scale + 0.0);
                }
                SurfaceInput::Nurbs(spline)
            }
        })
    }

    /// The meridian of a closed surface, from pole to pole, in millimetres, with its ends.
    pub(super) fn closing(&self, origin: DVec3, scale: f64) -> Option<(CurveInput, [[f64; 3]; 2])> {
        match self {
            Self::Ellipsoid([x, _, pole]) => {
                let frame = Frame {
                    origin: point(origin, scale),
                    axis: x.cross(*pole).normalize().to_array(),
                    ref_dir: x.normalize().to_array(),
                };
                let (a, c) = (x.length() * scale, pole.length() * scale);
                let ends = [-1.0, 1.0].map(|side| point(origin + *pole * side, scale));
                Some((CurveInput::Ellipse(frame, a, c), ends))
            }
            Self::Revolution(profile) => {
                let curve = profile.curve(scale)?;
                let ends = [
                    *curve.control_points.first()?,
                    *curve.control_points.last()?,
                ];
                Some((CurveInput::Nurbs(curve), ends))
            }
            Self::Cylinder(_) | Self::Patch(_) | Self::Closed(_) => None,
        }
    }

    /// What it is in the file.
    pub(super) fn entity(&self) -> &'static str {
        match self {
            Self::Ellipsoid(_) | Self::Patch(_) | Self::Closed(_) => "rational B-spline surface",
            Self::Cylinder(_) => "surface of linear extrusion",
            Self::Revolution(_) => "surface of revolution",
        }
    }
}

fn ellipsoid(center: DVec3, [x, y, z]: [DVec3; 3], scale: f64) -> NurbsSurface {
    // Half a circle from pole to pole: radius, height, weight.
    const PROFILE: [[f64; 3]; 5] = [
        [0.0, -1.0, 1.0],
        [1.0, -1.0, FRAC_1_SQRT_2],
        [1.0, 0.0, 1.0],
        [1.0, 1.0, FRAC_1_SQRT_2],
        [0.0, 1.0, 1.0],
    ];
    let corner = |[u, v, _]: [f64; 3], [radius, height, _]: [f64; 3]| {
        point(center + (x * u + y * v) * radius + z * height, scale)
    };
    let row = |across: [f64; 3]| PROFILE.map(|along| corner(across, along)).to_vec();
    let weights = |across: [f64; 3]| PROFILE.map(|along| across[2] * along[2]).to_vec();
    NurbsSurface {
        degree_u: 2,
        degree_v: 2,
        control_points: CIRCLE.map(row).to_vec(),
        weights: CIRCLE.map(weights).to_vec(),
        knots_u: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0, 3.0, 4.0, 4.0, 4.0],
        knots_v: vec![0.0, 0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 2.0],
    }
}
