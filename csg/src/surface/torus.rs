//! Tori among quartics.

use super::Surface;
use crate::Polynomial;
use crate::bounds::symmetric_eigen;
use glam::{DMat3, DVec3};

/// How many errors of single coefficients a coefficient may collect when the centre is moved to
/// the origin: there are 35 of them.
const COLLECTED: f64 = 256.0;

/// The torus that a quartic describes, if it does, with coefficient errors up to `error`.
///
/// About its centre and with its axis n, ring R and tube r it is a multiple of
/// |q|⁴ − 2(R² + r²)|q|² + 4R²(n·q)² + (R² − r²)².
pub(super) fn recognise(p: &Polynomial, error: f64) -> Option<Surface> {
    let at = |p: &Polynomial, i, j, k| p.coefficients()[Polynomial::index(4, i, j, k)];
    let factor = at(p, 4, 0, 0);
    let allowed = COLLECTED * error / factor.abs();
    let p = p.clone().scaled(1.0 / factor).ok()?;
    // −4 (m·q)|q|² are the cubic terms of a quartic with centre m.
    let center = DVec3::new(at(&p, 3, 0, 0), at(&p, 0, 3, 0), at(&p, 0, 0, 3)) * -0.25;
    let centered = p.substituted(&[
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 1.0, 0.0, 0.0],
        [0.0, 0.0, 1.0, 0.0],
        [center.x, center.y, center.z, 1.0],
    ]);
    let centered = centered.ok()?;

    let (xy, xz, yz) = (
        0.5 * at(&centered, 1, 1, 0),
        0.5 * at(&centered, 1, 0, 1),
        0.5 * at(&centered, 0, 1, 1),
    );
    let (xx, yy, zz) = (
        at(&centered, 2, 0, 0),
        at(&centered, 0, 2, 0),
        at(&centered, 0, 0, 2),
    );
    let matrix = DMat3::from_cols_array_2d(&[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
    let (values, axes) = symmetric_eigen(matrix);
    // The axis belongs to the largest eigenvalue 2(R² − r²), the others are −2(R² + r²).
    let k = values.max_position();
    let across = 0.5 * (values[(k + 1) % 3] + values[(k + 2) % 3]);
    let ring_square = 0.25 * (values[k] - across);
    let tube_square = -0.25 * (values[k] + across);
    if !(ring_square > allowed && tube_square > allowed) {
        return None;
    }
    let axis = axes.col(k);
    let expected = quartic(axis, ring_square, tube_square)?;
    let is_equal = centered.difference(&expected).ok()?.max_abs() <= allowed;
    is_equal.then_some(Surface::Torus {
        center,
        axis,
        ring: ring_square.sqrt(),
        tube: tube_square.sqrt(),
    })
}

/// The torus about the origin.
fn quartic(axis: DVec3, ring_square: f64, tube_square: f64) -> Option<Polynomial> {
    let n = axis;
    let round = -2.0 * (ring_square + tube_square);
    let flat = 4.0 * ring_square;
    let level = ring_square - tube_square;
    let terms = [
        ([4, 0, 0], 1.0),
        ([0, 4, 0], 1.0),
        ([0, 0, 4], 1.0),
        ([2, 2, 0], 2.0),
        ([2, 0, 2], 2.0),
        ([0, 2, 2], 2.0),
        ([2, 0, 0], round + flat * n.x * n.x),
        ([0, 2, 0], round + flat * n.y * n.y),
        ([0, 0, 2], round + flat * n.z * n.z),
        ([1, 1, 0], 2.0 * flat * n.x * n.y),
        ([1, 0, 1], 2.0 * flat * n.x * n.z),
        ([0, 1, 1], 2.0 * flat * n.y * n.z),
        ([0, 0, 0], level * level),
    ];
    Polynomial::from_terms(4, &terms).ok()
}
