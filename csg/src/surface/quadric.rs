//! Surfaces of degree 2.

use super::{QuadricForm, QuadricKind, Surface};
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
        slope: if slope.length() > allowed {
            slope
        } else {
            DVec3::ZERO
        },
        allowed,
    };
    match curved.iter().filter(|&&curved| curved).count() {
        3 => form.central(),
        2 => form.over_conic(),
        _ => form.over_points(),
    }
}

/// Σ values[k] yₖ² + 2 slope·y + level, with y from the centre along the axes.
struct Form {
    values: DVec3,
    axes: DMat3,
    curved: [bool; 3],
    center: DVec3,
    level: f64,
    /// Half the linear term, along axes that are not curved.
    slope: DVec3,
    allowed: f64,
}

impl Form {
    fn axes(&self) -> [DVec3; 3] {
        [0, 1, 2].map(|k| self.axes.col(k))
    }

    /// Square roots of |level / values[k]|, 0 along axes that are not curved.
    fn semi_axes(&self) -> [f64; 3] {
        [0, 1, 2].map(|k| {
            if self.curved[k] {
                (self.level / self.values[k]).abs().sqrt()
            } else {
                0.0
            }
        })
    }

    /// With the axis of index `special` as z.
    fn around(&self, kind: QuadricKind, special: usize, sizes: [f64; 3]) -> Surface {
        let form = QuadricForm::around(kind, self.center, self.axes(), special, sizes);
        Surface::Quadric(form)
    }

    /// Three curved axes: ellipsoids, hyperboloids, cones.
    fn central(&self) -> Surface {
        let sizes = self.semi_axes();
        let smallest = (1..3).fold(0, |s, k| if sizes[k] < sizes[s] { k } else { s });
        let positive = (0..3).filter(|&k| self.values[k] > 0.0).count();
        match (positive, self.level) {
            (0 | 3, 0.0) => self.point(),
            (0 | 3, level) if (level > 0.0) == (positive == 3) => {
                self.around(QuadricKind::ImaginaryEllipsoid, smallest, sizes)
            }
            (0 | 3, level) => {
                let mean = self.values.element_sum() / 3.0;
                if (self.values - mean).abs().max_element() <= self.allowed {
                    return Surface::Sphere {
                        center: self.center,
                        radius: (-level / mean).sqrt(),
                    };
                }
                self.around(QuadricKind::Ellipsoid, smallest, sizes)
            }
            (_, 0.0) => self.cone(self.lonely(positive)),
            // Two of the signs are those of the level in two sheets, one in one sheet.
            (_, level) => {
                let kind = if (positive == 2) == (level < 0.0) {
                    QuadricKind::HyperboloidOfOneSheet
                } else {
                    QuadricKind::HyperboloidOfTwoSheets
                };
                self.around(kind, self.lonely(positive), sizes)
            }
        }
    }

    /// The axis whose eigenvalue has a sign of its own, of which one or two are positive.
    fn lonely(&self, positive: usize) -> usize {
        let is_lonely = |k: &usize| (self.values[*k] > 0.0) == (positive == 1);
        (0..3).find(is_lonely).unwrap_or(0)
    }

    /// An imaginary cone, along its steepest axis.
    fn point(&self) -> Surface {
        let v = self.values.abs();
        let steepest = v.max_position();
        let sizes = [0, 1, 2].map(|k| (v[steepest] / v[k]).sqrt());
        self.around(QuadricKind::Point, steepest, sizes)
    }

    /// With the axis of index `k`.
    fn cone(&self, k: usize) -> Surface {
        let across = [self.values[(k + 1) % 3], self.values[(k + 2) % 3]];
        if (across[0] - across[1]).abs() > self.allowed {
            let tangents = [0, 1, 2].map(|j| (self.values[k] / self.values[j]).abs().sqrt());
            return self.around(QuadricKind::EllipticCone, k, tangents);
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
        let [i, j] = [(straight + 1) % 3, (straight + 2) % 3];
        let [a, b] = [self.values[i], self.values[j]];
        let is_elliptic = (a > 0.0) == (b > 0.0);
        if self.slope != DVec3::ZERO {
            return self.paraboloid([i, j], is_elliptic);
        }
        let sizes = self.semi_axes();
        let z = self.axes.col(straight);
        let along = |kind, x: usize, sizes| {
            let form = QuadricForm::new(kind, self.center, self.axes.col(x), z, sizes);
            Surface::Quadric(form)
        };
        match (is_elliptic, self.level) {
            (true, 0.0) => {
                // x is the flatter direction.
                let [x, y] = if a.abs() < b.abs() { [i, j] } else { [j, i] };
                let ratio = (self.values[y] / self.values[x]).sqrt();
                along(QuadricKind::Line, x, [ratio, 0.0, 0.0])
            }
            (false, 0.0) => {
                let [x, y] = if a.abs() < b.abs() { [i, j] } else { [j, i] };
                let half_angle_rad = (self.values[x] / self.values[y]).abs().sqrt().atan();
                along(QuadricKind::CrossingPlanes, x, [half_angle_rad, 0.0, 0.0])
            }
            (false, level) => {
                let [x, y] = if (a > 0.0) == (level < 0.0) {
                    [i, j]
                } else {
                    [j, i]
                };
                let sizes = [sizes[x], sizes[y], 0.0];
                along(QuadricKind::HyperbolicCylinder, x, sizes)
            }
            (true, level) if (level > 0.0) == (a > 0.0) => {
                self.around(QuadricKind::ImaginaryCylinder, straight, sizes)
            }
            (true, level) if (a - b).abs() <= self.allowed => Surface::Cylinder {
                point: self.center,
                axis: z,
                radius: (-level / (0.5 * (a + b))).sqrt(),
            },
            (true, _) => self.around(QuadricKind::EllipticCylinder, straight, sizes),
        }
    }

    /// Two curved axes, and a slope along the third: Σ values y² = −2 |slope| (t − t₀).
    fn paraboloid(&self, curved: [usize; 2], is_elliptic: bool) -> Surface {
        let radius = |k: usize| self.slope.length() / self.values[k].abs();
        let [i, j] = curved;
        let [x, y] = if radius(i) < radius(j) {
            [j, i]
        } else {
            [i, j]
        };
        let kind = if is_elliptic {
            QuadricKind::EllipticParaboloid
        } else {
            QuadricKind::HyperbolicParaboloid
        };
        let sizes = [radius(x), radius(y), 0.0];
        self.sloped(kind, x, sizes)
    }

    /// A vertex where the level is reached along the slope; z is where the curve along x opens.
    fn sloped(&self, kind: QuadricKind, x: usize, sizes: [f64; 3]) -> Surface {
        let length = self.slope.length();
        let direction = self.slope / length;
        let vertex = self.center - direction * (self.level / (2.0 * length));
        let z = -direction * self.values[x].signum();
        let form = QuadricForm::new(kind, vertex, self.axes.col(x), z, sizes);
        Surface::Quadric(form)
    }

    /// One curved axis: parabolic cylinders, parallel planes.
    fn over_points(&self) -> Surface {
        let x = (0..3).find(|&k| self.curved[k]).unwrap_or(0);
        if self.slope != DVec3::ZERO {
            let radius = self.slope.length() / self.values[x].abs();
            return self.sloped(QuadricKind::ParabolicCylinder, x, [radius, 0.0, 0.0]);
        }
        let kind = if self.level == 0.0 {
            QuadricKind::DoublePlane
        } else if (self.level > 0.0) == (self.values[x] > 0.0) {
            QuadricKind::ImaginaryPlanes
        } else {
            QuadricKind::ParallelPlanes
        };
        let (size, z) = (self.semi_axes()[x], self.axes.col((x + 2) % 3));
        let direction = self.axes.col(x);
        let form = QuadricForm::new(kind, self.center, direction, z, [size, 0.0, 0.0]);
        Surface::Quadric(form)
    }
}
