//! Quadrics that STEP has no entity for, where they can be said exactly.
//!
//! A circle is a rational quadratic spline, and an affine map of a spline's control points maps the
//! spline: an ellipsoid is the image of a sphere. Readers find the right side of edges on it only if there are
//! none, so only whole ellipsoids are written. An elliptic cylinder is an ellipse that is moved along
//! a line. Source: Piegl and Tiller, *The NURBS Book*, chapters 7 and 8.

use super::describe::point;
use brep::{ExactBrep, ExactFace};
use csg::{QuadricForm, QuadricKind};
use glam::DVec3;
use std::f64::consts::FRAC_1_SQRT_2;
use step_io::build::{Frame, ProfileInput, SurfaceInput};
use step_io::scene::NurbsSurface;

/// A quadric in STEP's terms, in model units.
#[derive(Clone, Copy)]
pub(super) enum Quadric {
    /// All of an ellipsoid, with these semi-axes; its poles are on the third one.
    Ellipsoid([DVec3; 3]),
    /// A cylinder over the ellipse with the first two semi-axes; the third one is its direction.
    Cylinder([DVec3; 3]),
}

/// A circle about the origin: corners of its control polygon and their weights.
const CIRCLE: [[f64; 3]; 9] = [
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

/// The surface of a face, and at a point of it a direction out of the quadric; `None` where there
/// is no form.
pub(super) fn of(
    form: &QuadricForm,
    exact: &ExactBrep,
    face: &ExactFace,
    at: DVec3,
) -> Option<(Quadric, DVec3)> {
    let [x, y, z] = form.axes;
    let [a, b, c] = form.sizes;
    let from = at - form.center;
    match form.kind {
        QuadricKind::Ellipsoid if face.loops.is_empty() => {
            Some((Quadric::Ellipsoid([x * a, y * b, z * c]), from))
        }
        QuadricKind::EllipticCylinder => {
            // Readers cut it open where the ellipse begins: no edge may end there.
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
            (clearance(x * (a * side)) > CLEAR * b).then_some((
                Quadric::Cylinder([x * (a * side), y * (b * side), z]),
                from.reject_from_normalized(z),
            ))
        }
        _ => None,
    }
}

/// Least distance of ends of edges from where a cylinder is cut open, in semi-axes.
const CLEAR: f64 = 1e-3;

impl Quadric {
    /// The surface in millimetres.
    pub(super) fn input(&self, center: DVec3, scale: f64) -> SurfaceInput {
        match *self {
            Self::Ellipsoid(axes) => SurfaceInput::Nurbs(ellipsoid(center, axes, scale)),
            Self::Cylinder([x, y, z]) => {
                let frame = Frame {
                    origin: point(center, scale),
                    axis: z.to_array(),
                    ref_dir: x.normalize().to_array(),
                };
                let ellipse = ProfileInput::Ellipse(frame, x.length() * scale, y.length() * scale);
                SurfaceInput::LinearExtrusion(ellipse, z.to_array())
            }
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
