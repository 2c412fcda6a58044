//! Three surfaces in a leaf: their normals are independent, or they have no common point.

use crate::patterns::Patterns;
use crate::topology::combination::{Combination, excluded, nearest};
use crate::topology::surface::{Cone, Surface};
use glam::DVec3;

/// Whether the gradients of three surfaces stay independent during the deformation.
///
/// With r the direction of an interpolant's gradient and u those of the true gradients at one
/// point, each r must satisfy det(rᵢ, uⱼ, uₖ) > |det(uᵢ, rᵢ, uₖ)| + |det(uᵢ, uⱼ, rᵢ)|: then its
/// coordinates in the dual basis of the u are dominated by its own. With n the axes, D their
/// determinant, s the sines between them, e the chords of the cones and l the axes' errors:
///
/// * det(rᵢ, uⱼ, uₖ) ≥ D − lᵢ − eⱼsᵢₖ − eₖsᵢⱼ − eⱼeₖ;
/// * det(uᵢ, rᵢ, uₖ) ± det(uᵢ, uⱼ, rᵢ) = (uᵢ − rᵢ)·(rᵢ × (uₖ ∓ uⱼ)), at most
///   eᵢ·(|nᵢ × (nₖ ∓ nⱼ)| + eⱼ + eₖ + 2lᵢ).
#[must_use]
pub(crate) fn independent(cones: &[Cone; 3]) -> bool {
    let axes = [0, 1, 2].map(|m| cones[m].axis);
    let [a, b, c] = axes;
    // Determinant and sines of unit vectors: off by at most 16u each, 64u in the sums below.
    let determinant = a.dot(b.cross(c)).abs() - 1e-13;
    let chords = [0, 1, 2].map(|m| cones[m].chord());
    let sines = [
        b.cross(c).length(),
        c.cross(a).length(),
        a.cross(b).length(),
    ];
    (0..3).all(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        // The sine opposite to an index is that between the two others.
        let (sine_ij, sine_ik) = (sines[k], sines[j]);
        let own = cones[i].wobble;
        let lost = own + chords[j] * sine_ik + chords[k] * sine_ij + chords[j] * chords[k];
        let (n, p, q) = (axes[i], axes[j], axes[k]);
        let across = n.cross(p + q).length().max(n.cross(p - q).length());
        let others = across + chords[j] + chords[k] + 2.0 * own;
        lost + chords[i] * others < determinant
    })
}

/// The sign pattern that does not occur, if three surfaces are proved to have no common point.
#[must_use]
pub(crate) fn apart(surfaces: &[Surface<'_>], members: [usize; 3]) -> Option<Patterns> {
    let three = members.map(|at| &surfaces[at]);
    let points = std::array::from_fn(|v| {
        DVec3::from_array(three.map(|surface| surface.values[v] / surface.steepness))
    });
    let direction = nearest(&points, true)?.to_array();
    let factors = std::array::from_fn(|m| (members[m], direction[m] / three[m].steepness));
    let combination: [(usize, f64); 3] = factors;
    excluded(surfaces, &Combination::from_iter(combination))
}
