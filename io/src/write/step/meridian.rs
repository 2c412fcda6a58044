//! Meridians: the curves that quadrics about an axis are made of.

use super::rational::{ratios, steps};
use super::region::Region;
use csg::{QuadricForm, QuadricKind};
use glam::DVec3;

/// Spans of a spline in one direction: the more, the closer together its weights.
pub(super) const SPANS: u32 = 8;

/// Polynomials of one parameter, by powers.
type Quadratic = [f64; 3];

/// A meridian: distance from the axis, in semi-axes, height along it, and weight.
pub(super) struct Meridian {
    pub(super) radius: Quadratic,
    pub(super) height: Quadratic,
    pub(super) weight: Quadratic,
    pub(super) breaks: Vec<f64>,
    /// Whether it begins and ends on the axis.
    pub(super) poles: [bool; 2],
}

impl Meridian {
    /// Distance from the axis, height, and weight, as they are in homogeneous coordinates.
    pub(super) fn at(&self, s: f64) -> [f64; 3] {
        [self.radius, self.height, self.weight].map(|[a, b, c]| a + s * (b + s * c))
    }
}

/// Tangents of halves of angles up to a bound on both sides, in equal steps of the angle.
pub(super) fn arc(bound: f64) -> Vec<f64> {
    let angles = steps([-0.5 * bound, 0.5 * bound], 2 * SPANS);
    angles.into_iter().map(f64::tan).collect()
}

/// The meridian of a quadric about z, on the side of a point of the face.
pub(super) fn of(
    form: &QuadricForm,
    region: &Region,
    at: DVec3,
    local: impl Fn(DVec3) -> DVec3,
) -> Option<Meridian> {
    let [a, b, c] = form.sizes;
    let side = at.z.signum();
    Some(match form.kind {
        QuadricKind::EllipticCylinder => Meridian {
            radius: [1.0, 0.0, 0.0],
            height: [0.0, 1.0, 0.0],
            weight: [1.0, 0.0, 0.0],
            breaks: steps(region.range(|point| local(point).z), SPANS),
            poles: [false; 2],
        },
        QuadricKind::EllipticCone => {
            let [low, high] = region.range(|point| local(point).z * side);
            Meridian {
                radius: [0.0, 1.0, 0.0],
                height: [0.0, side, 0.0],
                weight: [1.0, 0.0, 0.0],
                breaks: steps([low.max(0.0), high], SPANS),
                poles: [false; 2],
            }
        }
        QuadricKind::EllipticParaboloid => {
            // Only where a = b.
            let radius = |point: DVec3| local(point).truncate().length();
            let [_, high] = region.range(radius);
            Meridian {
                radius: [0.0, 1.0 / a, 0.0],
                height: [0.0, 0.0, 0.5 / b],
                weight: [1.0, 0.0, 0.0],
                breaks: steps([0.0, high], SPANS),
                poles: [true, false],
            }
        }
        QuadricKind::HyperboloidOfOneSheet => {
            let [low, high] = region.range(|point| (local(point).z / c).asinh());
            Meridian {
                radius: [1.0, 0.0, 1.0],
                height: [-c, 0.0, c],
                weight: [0.0, 2.0, 0.0],
                breaks: ratios([low.exp(), high.exp()], SPANS),
                poles: [false; 2],
            }
        }
        QuadricKind::HyperboloidOfTwoSheets => {
            let rise = |point: DVec3| (local(point).z * side / c).max(1.0).acosh();
            let [_, high] = region.range(rise);
            Meridian {
                radius: [-1.0, 0.0, 1.0],
                height: [c * side, 0.0, c * side],
                weight: [0.0, 2.0, 0.0],
                breaks: ratios([1.0, high.exp()], SPANS),
                poles: [true, false],
            }
        }
        _ => return None,
    })
}

/// The parameter of a point of such a meridian, from its height.
pub(super) fn parameter(form: &QuadricForm, height: f64) -> f64 {
    let [.., c] = form.sizes;
    match form.kind {
        QuadricKind::EllipticCone => height.abs(),
        QuadricKind::HyperboloidOfOneSheet => (height / c).asinh().exp(),
        QuadricKind::HyperboloidOfTwoSheets => (height.abs() / c).max(1.0).acosh().exp(),
        _ => height,
    }
}
