//! Surfaces of degree 2.

use super::{QuadricKind, Surface};
use crate::Polynomial;
use crate::bounds::symmetric_eigen;
use glam::{DMat3, DVec3};

/// How many errors of single coefficients an eigenvalue or a completed square may collect.
const COLLECTED: f64 = 64.0;

/// The surface of xᵀAx + 2b·x + c = 0, whose coefficients have errors up to `error`.
pub(super) fn classify(p: &Polynomial, error: f64) -> Surface {
    let c = p.coefficients();
    let matrix = DMat3::from_cols_array_2d(&[
        [c[0], 0.5 * c[1], 0.5 * c[2]],
        [0.5 * c[1], c[4], 0.5 * c[5]],
        [0.5 * c[2], 0.5 * c[5], c[7]],
    ]);
    let linear = DVec3::new(0.5 * c[3], 0.5 * c[6], 0.5 * c[8]);
    let allowed = COLLECTED * error;
    let (values, axes) = symmetric_eigen(matrix);
    let curved = [0, 1, 2].map(|k| values[k].abs() > allowed);
    if !curved.contains(&true) {
        // Quadratic in form only.
        return Surface::Algebraic { degree: 2 };
    }

    // Complete the squares along curved axes; what is linear along the others stays.
    let mut center = DVec3::ZERO;
    let mut level = c[9];
    let mut level_error = allowed;
    let mut slope = DVec3::ZERO;
    for k in 0..3 {
        let along = linear.dot(axes.col(k));
        if curved[k] {
            let at = -along / values[k];
            center += axes.col(k) * at;
            level += along * at;
            level_error += allowed * (at.abs() + at * at);
        } else {
            slope += axes.col(k) * along;
        }
    }
    let form = Form {
        values,
        axes,
        curved,
        center,
        level: if level.abs() > level_error {
            level
        } else {
            0.0
        },
        is_sloped: slope.length() > allowed,
        allowed,
    };
    match curved.iter().filter(|&&curved| curved).count() {
        3 => form.central(),
        2 => form.over_conic(),
        _ => form.over_points(),
    }
}

/// Σ values[k] yₖ² + level, with y from the centre along the axes, plus a linear term if sloped.
struct Form {
    values: DVec3,
    axes: DMat3,
    curved: [bool; 3],
    center: DVec3,
    level: f64,
    is_sloped: bool,
    allowed: f64,
}

impl Form {
    /// Three curved axes: ellipsoids, hyperboloids, cones.
    fn central(&self) -> Surface {
        let positive = (0..3).filter(|&k| self.values[k] > 0.0).count();
        let kind = match (positive, self.level) {
            (0 | 3, 0.0) => QuadricKind::Point,
            (0 | 3, level) if (level > 0.0) == (positive == 3) => QuadricKind::Imaginary,
            (0 | 3, level) => {
                let mean = self.values.element_sum() / 3.0;
                if (self.values - mean).abs().max_element() <= self.allowed {
                    return Surface::Sphere {
                        center: self.center,
                        radius: (-level / mean).sqrt(),
                    };
                }
                QuadricKind::Ellipsoid
            }
            (_, 0.0) => return self.cone(positive),
            (2, level) if level < 0.0 => QuadricKind::HyperboloidOfOneSheet,
            (1, level) if level > 0.0 => QuadricKind::HyperboloidOfOneSheet,
            _ => QuadricKind::HyperboloidOfTwoSheets,
        };
        Surface::Quadric(kind)
    }

    /// The axis is the one whose eigenvalue has a sign of its own.
    fn cone(&self, positive: usize) -> Surface {
        let is_axis = |k: &usize| (self.values[*k] > 0.0) == (positive == 1);
        let Some(k) = (0..3).find(is_axis) else {
            return Surface::Quadric(QuadricKind::Point);
        };
        let across = [self.values[(k + 1) % 3], self.values[(k + 2) % 3]];
        if (across[0] - across[1]).abs() > self.allowed {
            return Surface::Quadric(QuadricKind::EllipticCone);
        }
        // across · ρ² = −values[k] · z²
        let mean = 0.5 * (across[0] + across[1]);
        Surface::Cone {
            apex: self.center,
            axis: self.axes.col(k),
            half_angle_rad: (-self.values[k] / mean).sqrt().atan(),
        }
    }

    /// Two curved axes: paraboloids, cylinders, crossing planes.
    fn over_conic(&self) -> Surface {
        let straight = (0..3).find(|&k| !self.curved[k]).unwrap_or(0);
        let [a, b] = [1, 2].map(|step| self.values[(straight + step) % 3]);
        let is_elliptic = (a > 0.0) == (b > 0.0);
        let kind = match (self.is_sloped, is_elliptic, self.level) {
            (true, true, _) => QuadricKind::EllipticParaboloid,
            (true, false, _) => QuadricKind::HyperbolicParaboloid,
            (false, true, 0.0) => QuadricKind::Line,
            (false, false, 0.0) => QuadricKind::CrossingPlanes,
            (false, false, _) => QuadricKind::HyperbolicCylinder,
            (false, true, level) if (level > 0.0) == (a > 0.0) => QuadricKind::Imaginary,
            (false, true, level) if (a - b).abs() <= self.allowed => {
                return Surface::Cylinder {
                    point: self.center,
                    axis: self.axes.col(straight),
                    radius: (-level / (0.5 * (a + b))).sqrt(),
                };
            }
            (false, true, _) => QuadricKind::EllipticCylinder,
        };
        Surface::Quadric(kind)
    }

    /// One curved axis: parabolic cylinders, parallel planes.
    fn over_points(&self) -> Surface {
        let curved = (0..3).find(|&k| self.curved[k]).unwrap_or(0);
        Surface::Quadric(if self.is_sloped {
            QuadricKind::ParabolicCylinder
        } else if self.level == 0.0 {
            QuadricKind::DoublePlane
        } else if (self.level > 0.0) == (self.values[curved] > 0.0) {
            QuadricKind::Imaginary
        } else {
            QuadricKind::ParallelPlanes
        })
    }
}
