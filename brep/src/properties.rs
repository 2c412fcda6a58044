//! Area, volume, centroid and inertia of what the boundary encloses.

use crate::shells::Shells;
use crate::sum::Sum;
use crate::topology::{Brep, FacetKey};
use crate::validate::Valid;
use csg::Aabb;
use glam::{DMat3, DVec3};

/// Measures of the solid inside a closed triangle mesh; exact for the mesh but for rounding.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Properties {
    /// Surface area, in square model units.
    pub area: f64,
    /// Signed volume, in cubic model units.
    pub volume: f64,
    /// Centre of mass at uniform density; the box centre when the volume is zero.
    pub centroid: DVec3,
    /// Inertia tensor about the centroid at density 1 (symmetric), in model units to the fifth
    /// power.
    pub inertia: DMat3,
    /// Bounding box; [`Aabb::EMPTY`] for the empty solid.
    pub bounds: Aabb,
}

impl Properties {
    /// Measures a boundary by the divergence theorem: one signed tetrahedron a facet.
    ///
    /// The apex is the centre of the bounding box, so digits are not lost far from the origin,
    /// and sums are compensated. Cost: linear. Source: Tonon, *Explicit exact formulas for the
    /// 3-D tetrahedron inertia tensor in terms of its vertex coordinates*, 2004.
    pub fn of(brep: &Valid<Brep>) -> Self {
        Self::of_facets(brep, brep.facets.keys())
    }

    /// Measures each solid by itself, in the order of [`Shells::solids`], its voids taken off.
    ///
    /// Facets of [stray voids](Shells::stray_voids) belong to no solid. Cost: linear.
    pub fn of_solids(brep: &Valid<Brep>, shells: &Shells) -> Vec<Self> {
        let mut solid_of = vec![None; shells.shells.len()];
        for (at, solid) in shells.solids.iter().enumerate() {
            for shell in solid.voids.iter().chain([&solid.outer]) {
                solid_of[shell.0 as usize] = Some(at);
            }
        }
        let mut facets = vec![Vec::new(); shells.solids.len()];
        for (key, shell) in &shells.shell_of {
            if let Some(at) = solid_of[shell.0 as usize] {
                facets[at].push(key);
            }
        }
        let measure = |keys: &Vec<FacetKey>| Self::of_facets(brep, keys.iter().copied());
        facets.iter().map(measure).collect()
    }

    /// The facets must close; without any, all measures are 0.
    fn of_facets(brep: &Brep, keys: impl Iterator<Item = FacetKey> + Clone) -> Self {
        let facets = keys.map(|key| brep.facet(key).positions());
        let mut bounds = Aabb::EMPTY;
        for position in facets.clone().flatten() {
            bounds.min = bounds.min.min(position);
            bounds.max = bounds.max.max(position);
        }
        if bounds.is_empty() {
            return Self {
                area: 0.0,
                volume: 0.0,
                centroid: DVec3::ZERO,
                inertia: DMat3::ZERO,
                bounds,
            };
        }
        let apex = bounds.min + (bounds.max - bounds.min) * 0.5;
        let mut area = Sum::default();
        let mut moments = [Sum::default(); 10];
        for positions in facets {
            let [a, b, c] = positions.map(|position| position - apex);
            area.add((b - a).cross(c - a).length());
            for (sum, term) in moments.iter_mut().zip(tetrahedron_moments(a, b, c)) {
                sum.add(term);
            }
        }
        let [v, x, y, z, xx, yy, zz, xy, yz, zx] = moments.map(Sum::value);
        let volume = v / 6.0;
        let arm = DVec3::new(x, y, z) / (4.0 * v);
        let (arm, centroid) = if v != 0.0 && arm.is_finite() {
            (arm, apex + arm)
        } else {
            (DVec3::ZERO, apex)
        };
        // Second moments about the centroid: the parallel axis theorem.
        let second = |sum: f64, p: f64, q: f64| sum / 120.0 - volume * p * q;
        let (xx, yy, zz) = (
            second(xx, arm.x, arm.x),
            second(yy, arm.y, arm.y),
            second(zz, arm.z, arm.z),
        );
        let (xy, yz, zx) = (
            second(xy, arm.x, arm.y),
            second(yz, arm.y, arm.z),
            second(zx, arm.z, arm.x),
        );
        let inertia = DMat3::from_cols(
            DVec3::new(yy + zz, -xy, -zx),
            DVec3::new(-xy, zz + xx, -yz),
            DVec3::new(-zx, -yz, xx + yy),
        );
        Self {
            area: area.value() / 2.0,
            volume,
            centroid,
            inertia,
            bounds,
        }
    }
}

/// Moments of the tetrahedron (0, a, b, c): 6 ∫1, 24 ∫(x, y, z), 120 ∫(xx, yy, zz, xy, yz, zx).
fn tetrahedron_moments(a: DVec3, b: DVec3, c: DVec3) -> [f64; 10] {
    let determinant = a.dot(b.cross(c));
    let sum = a + b + c;
    // 120 ∫pq = det · (Σ p_i q_i + Σp Σq) over the four corners, one of which is 0.
    let second = |p: fn(DVec3) -> f64, q: fn(DVec3) -> f64| {
        determinant * (p(a) * q(a) + p(b) * q(b) + p(c) * q(c) + p(sum) * q(sum))
    };
    let (x, y, z) = (|p: DVec3| p.x, |p: DVec3| p.y, |p: DVec3| p.z);
    [
        determinant,
        determinant * sum.x,
        determinant * sum.y,
        determinant * sum.z,
        second(x, x),
        second(y, y),
        second(z, z),
        second(x, y),
        second(y, z),
        second(z, x),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, cuboid, inside_out, moved, sphere, tetrahedron, together, torus};
    use crate::stitch;
    use proptest::prelude::*;
    use subdiv::Fragments;

    fn of(fragments: &Fragments) -> Properties {
        Properties::of(
            &stitch(fragments)
                .expect("closed")
                .validate()
                .expect("valid"),
        )
    }

    fn close(a: f64, b: f64, relative: f64) -> bool {
        (a - b).abs() <= relative * b.abs()
    }

    #[test]
    fn tetrahedron_against_formulas() {
        let found = of(&tetrahedron());
        assert!(close(found.volume, 1.0 / 6.0, 1e-15));
        assert!(close(found.area, 1.5 + 3.0_f64.sqrt() / 2.0, 1e-15));
        assert!((found.centroid - DVec3::splat(0.25)).length() < 1e-15);
        // ∫x² = 1/60 and ∫xy = 1/120 about the corner; moved to the centroid: −1/96 each.
        let (second, product) = (1.0 / 60.0 - 1.0 / 96.0, 1.0 / 120.0 - 1.0 / 96.0);
        let expected = DMat3::from_diagonal(DVec3::splat(2.0 * second + product))
            - DMat3::from_cols(
                DVec3::splat(product),
                DVec3::splat(product),
                DVec3::splat(product),
            );
        assert!(found.inertia.abs_diff_eq(expected, 1e-16), "{found:?}");
    }

    #[test]
    fn empty_solid_measures_nothing() {
        let found = of(&Fragments::default());
        assert!(found.bounds.is_empty());
        assert_eq!(
            (found.volume, found.area, found.inertia),
            (0.0, 0.0, DMat3::ZERO)
        );
    }

    #[test]
    fn a_void_counts_negative() {
        let found = of(&together(&[
            cube([0.0; 3], 2.0),
            inside_out(cube([0.5; 3], 1.0)),
        ]));
        assert!(close(found.volume, 64.0 - 8.0, 1e-15));
        assert!(close(found.area, 96.0 + 24.0, 1e-15));
        assert!((found.centroid + DVec3::splat(0.5 * 8.0 / 56.0)).length() < 1e-15);
    }

    #[test]
    fn solids_are_measured_one_by_one() {
        let brep = stitch(&together(&[
            cube([0.0; 3], 2.0),
            cuboid(DVec3::new(10.0, 0.0, 0.0), DVec3::new(11.0, 2.0, 3.0), 0),
            inside_out(cube([0.5; 3], 1.0)),
        ]))
        .expect("closed")
        .validate()
        .expect("valid");
        let solids = Properties::of_solids(&brep, &Shells::of(&brep));
        let [hollow, block] = solids.as_slice() else {
            panic!("{solids:?}")
        };
        assert!(close(hollow.volume, 64.0 - 8.0, 1e-15));
        assert!(close(hollow.area, 96.0 + 24.0, 1e-15));
        assert!((hollow.centroid + DVec3::splat(0.5 * 8.0 / 56.0)).length() < 1e-15);
        assert!(close(block.volume, 6.0, 1e-15));
        assert!(close(block.area, 22.0, 1e-15));
        assert!((block.centroid - DVec3::new(10.5, 1.0, 1.5)).length() < 1e-14);
        let expected = DVec3::new(4.0 + 9.0, 9.0 + 1.0, 1.0 + 4.0) * (6.0 / 12.0);
        let expected = DMat3::from_diagonal(expected);
        assert!(block.inertia.abs_diff_eq(expected, 1e-13), "{block:?}");
    }

    #[test]
    fn far_from_the_origin_digits_stay() {
        let shift = DVec3::new(1e9, -2e9, 4e9);
        let found = of(&moved(torus(2.0, 0.5, 64, 32), |p| p + shift));
        let near = of(&torus(2.0, 0.5, 64, 32));
        // Positions are rounded to 4e9 · 2⁻⁵³ = 5e-7.
        assert!(close(found.volume, near.volume, 1e-6));
        assert!((found.centroid - shift).length() < 2e-6);
        assert!(close(found.inertia.z_axis.z, near.inertia.z_axis.z, 1e-6));
    }

    #[test]
    fn spheres_converge_quadratically() {
        let exact = 4.0 / 3.0 * std::f64::consts::PI;
        let error = |level| exact - of(&sphere(level)).volume;
        for level in 2..5 {
            let ratio = error(level) / error(level + 1);
            assert!((3.6..4.4).contains(&ratio), "{level}: {ratio}");
        }
        // 2/5 m r² = 8π/15.
        let fine = of(&sphere(6));
        let inertia = 8.0 / 15.0 * std::f64::consts::PI;
        assert!(close(fine.inertia.x_axis.x, inertia, 2e-3));
        assert!(close(fine.inertia.z_axis.z, fine.inertia.x_axis.x, 1e-12));
    }

    proptest! {
        /// Box: volume abc, area 2(ab + bc + ca), inertia m (b² + c²) / 12.
        #[test]
        fn boxes_follow_their_formulas(
            x in -9.0..9.0, y in -9.0..9.0, z in -9.0..9.0,
            a in 0.1..9.0, b in 0.1..9.0, c in 0.1..9.0,
        ) {
            let (min, size) = (DVec3::new(x, y, z), DVec3::new(a, b, c));
            let found = of(&cuboid(min, min + size, 0));
            // Corners are rounded to about 2e-15, the thinnest side is 0.1.
            prop_assert!(close(found.volume, a * b * c, 1e-12));
            prop_assert!(close(found.area, 2.0 * (a * b + b * c + c * a), 1e-12));
            prop_assert!((found.centroid - (min + size / 2.0)).length() < 1e-12);
            let moment = |p: f64, q: f64| a * b * c * (p * p + q * q) / 12.0;
            let expected = DVec3::new(moment(b, c), moment(c, a), moment(a, b));
            let error = found.inertia - DMat3::from_diagonal(expected);
            let largest = error.to_cols_array().into_iter().fold(0.0, |m: f64, e| m.max(e.abs()));
            prop_assert!(largest <= 1e-11 * expected.max_element());
        }
    }
}
