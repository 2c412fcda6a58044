//! The surfaces that bound the seven solids, with signed distances: the truth against which
//! meshes are measured, written by hand and sharing no code with the programs under test.

use glam::DVec3;

/// A surface; negative distances are inside.
#[derive(Clone, Copy, Debug)]
pub enum Surface {
    /// `normal · p = offset`, the normal of unit length.
    Plane {
        /// Points outside.
        normal: DVec3,
        /// Along the normal.
        offset: f64,
    },
    /// A sphere.
    Sphere {
        /// Its centre.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// An infinite cylinder whose axis is parallel to a coordinate axis.
    Cylinder {
        /// The coordinate along which it runs: 0, 1 or 2.
        axis: usize,
        /// A point on its axis.
        center: DVec3,
        /// Its radius.
        radius: f64,
    },
    /// A torus around the z axis.
    Torus {
        /// Radius of the ring.
        ring: f64,
        /// Radius of the tube.
        tube: f64,
    },
    /// `(x² + 9/4 y² + z² − 1)³ = x² z³ + 9/80 y² z³`.
    Heart,
}

impl Surface {
    /// Distance to the surface, negative inside: exact, but for the heart to first order.
    pub fn signed_distance(&self, p: DVec3) -> f64 {
        match *self {
            Self::Plane { normal, offset } => normal.dot(p) - offset,
            Self::Sphere { center, radius } => p.distance(center) - radius,
            Self::Cylinder {
                axis,
                center,
                radius,
            } => across(axis, p - center).length() - radius,
            Self::Torus { ring, tube } => (p.truncate().length() - ring).hypot(p.z) - tube,
            Self::Heart => {
                let (value, gradient) = heart(p);
                value / gradient.length().max(1e-9)
            }
        }
    }

    /// Unit vector along the gradient of the distance.
    pub fn normal(&self, p: DVec3) -> DVec3 {
        match *self {
            Self::Plane { normal, .. } => normal,
            Self::Sphere { center, .. } => (p - center).normalize_or(DVec3::X),
            Self::Cylinder { axis, center, .. } => {
                across(axis, p - center).normalize_or(DVec3::AXES[(axis + 1) % 3])
            }
            Self::Torus { ring, .. } => {
                let spine = p.with_z(0.0).normalize_or(DVec3::X) * ring;
                (p - spine).normalize_or(DVec3::Z)
            }
            Self::Heart => heart(p).1.normalize_or(DVec3::Z),
        }
    }

    /// The nearest point of the surface, or one little farther away.
    pub fn foot(&self, p: DVec3) -> DVec3 {
        if !matches!(self, Self::Heart) {
            return p - self.normal(p) * self.signed_distance(p);
        }
        let mut foot = heart_land(p);
        for _ in 0..4 {
            // Back over p in the foot's tangent plane, and down again.
            let normal = self.normal(foot);
            let tangent = p - normal * normal.dot(p - foot);
            let next = heart_land(tangent);
            if next.distance_squared(p) >= foot.distance_squared(p) {
                break;
            }
            foot = next;
        }
        foot
    }

    /// Points all over the surface, at most about `step` apart, where it passes through the cube
    /// around the origin with half side `reach`.
    pub fn samples(&self, step: f64, reach: f64) -> Vec<DVec3> {
        use std::f64::consts::{PI, TAU};
        let steps = |length: f64| (length / step).ceil() as usize;
        match *self {
            Self::Plane { normal, offset } => {
                let (u, v) = normal.any_orthonormal_pair();
                let n = steps(2.0 * reach);
                let at = |i: usize| -reach + 2.0 * reach * i as f64 / n as f64;
                grid(n + 1, n + 1)
                    .map(|(i, j)| normal * offset + u * at(i) + v * at(j))
                    .collect()
            }
            Self::Sphere { center, radius } => {
                let count = (4.0 * PI * radius * radius / (step * step)).ceil() as usize;
                directions(count).map(|d| center + d * radius).collect()
            }
            Self::Cylinder {
                axis,
                center,
                radius,
            } => {
                let (along, around) = (steps(2.0 * reach), steps(TAU * radius));
                let [e, u, v] = [0, 1, 2].map(|k| DVec3::AXES[(axis + k) % 3]);
                grid(along + 1, around)
                    .map(|(i, j)| {
                        let (s, c) = (TAU * j as f64 / around as f64).sin_cos();
                        let height = -reach + 2.0 * reach * i as f64 / along as f64;
                        center + (u * c + v * s) * radius + e * height
                    })
                    .collect()
            }
            Self::Torus { ring, tube } => {
                let (long, short) = (steps(TAU * (ring + tube)), steps(TAU * tube));
                grid(long, short)
                    .map(|(i, j)| {
                        let (s, c) = (TAU * i as f64 / long as f64).sin_cos();
                        let (t, d) = (TAU * j as f64 / short as f64).sin_cos();
                        let rho = ring + tube * d;
                        DVec3::new(rho * c, rho * s, tube * t)
                    })
                    .collect()
            }
            // Every ray from the origin leaves the heart once: along it the function is
            // a r² − b r^(5/3) − 1 with a > 0, which rises at each of its roots.
            Self::Heart => directions((4.0 * PI * 1.6 / (step * step)).ceil() as usize)
                .map(|d| {
                    let (mut inside, mut outside) = (0.0, 2.0);
                    for _ in 0..60 {
                        let middle = 0.5 * (inside + outside);
                        if heart(d * middle).0 < 0.0 {
                            inside = middle;
                        } else {
                            outside = middle;
                        }
                    }
                    d * inside
                })
                .collect(),
        }
    }
}

/// The part of a vector across an axis.
fn across(axis: usize, mut v: DVec3) -> DVec3 {
    v[axis] = 0.0;
    v
}

/// The heart's cube root form `x² + 9/4 y² + z² − 1 − z ∛(x² + 9/80 y²)` and its gradient: same
/// zero set and sign as the polynomial, but no vanishing gradient except at the two dents.
fn heart(p: DVec3) -> (f64, DVec3) {
    let root = (p.x * p.x + 9.0 / 80.0 * p.y * p.y).cbrt();
    let value = p.x * p.x + 2.25 * p.y * p.y + p.z * p.z - 1.0 - p.z * root;
    let slope = p.z / (3.0 * root * root).max(1e-12);
    let gradient = DVec3::new(
        2.0 * p.x - slope * 2.0 * p.x,
        4.5 * p.y - slope * (9.0 / 40.0) * p.y,
        2.0 * p.z - root,
    );
    (value, gradient)
}

/// Down (or up) the gradient to the heart's surface; a ray through the origin where that fails.
fn heart_land(start: DVec3) -> DVec3 {
    let mut p = start;
    for _ in 0..30 {
        let (value, gradient) = heart(p);
        if value.abs() < 1e-13 {
            return p;
        }
        p -= gradient * (value / gradient.length_squared().max(1e-12));
    }
    // Newton does not settle in the dents: the root along the ray through the origin.
    let d = start.normalize_or(DVec3::Z);
    let (mut inside, mut outside) = (0.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (inside + outside);
        if heart(d * middle).0 < 0.0 {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    d * inside
}

fn grid(n: usize, m: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (0..m).map(move |j| (i, j)))
}

/// Unit vectors spread evenly (a Fibonacci lattice).
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let golden = std::f64::consts::PI * (3.0 - 5f64.sqrt());
    (0..count).map(move |i| {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let (s, c) = (golden * i as f64).sin_cos();
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * c, r * s, z)
    })
}
