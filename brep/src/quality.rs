//! Shapes of the facets: how far they are from slivers.

use crate::sum::Sum;
use crate::topology::Brep;
use crate::validate::Valid;
use glam::DVec3;

/// Facets with an angle below this are counted as slivers, in degrees.
const SLIVER_DEG: f64 = 1.0;

/// Statistics of the facets' angles and proportions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Quality {
    /// The smallest angle of all facets, in degrees: at most 60; 0 for facets without area.
    pub smallest_angle_deg: f64,
    /// Mean over the facets of each one's smallest angle, in degrees.
    pub mean_angle_deg: f64,
    /// Facets with an angle below one degree.
    pub slivers: u64,
    /// Largest ratio of a facet's longest edge to its height over it, at least 2/√3; infinite for
    /// facets without area.
    pub largest_aspect: f64,
    /// Length of the shortest edge, in model units.
    pub shortest_edge: f64,
}

impl Quality {
    /// Measures all facets; `None` for the empty boundary. Cost: linear.
    pub fn of(brep: &Valid<Brep>) -> Option<Self> {
        let mut found = Self {
            smallest_angle_deg: 60.0,
            mean_angle_deg: 0.0,
            slivers: 0,
            largest_aspect: 0.0,
            shortest_edge: f64::INFINITY,
        };
        let mut angles = Sum::default();
        for facet in brep.facets() {
            let shape = Shape::of(facet.positions());
            angles.add(shape.angle_deg);
            found.smallest_angle_deg = found.smallest_angle_deg.min(shape.angle_deg);
            found.slivers += u64::from(shape.angle_deg < SLIVER_DEG);
            found.largest_aspect = found.largest_aspect.max(shape.aspect);
            found.shortest_edge = found.shortest_edge.min(shape.shortest);
        }
        found.mean_angle_deg = angles.value() / brep.facet_count() as f64;
        (!brep.is_empty()).then_some(found)
    }
}

/// One triangle's smallest angle, aspect and shortest edge.
struct Shape {
    angle_deg: f64,
    aspect: f64,
    shortest: f64,
}

impl Shape {
    fn of([a, b, c]: [DVec3; 3]) -> Self {
        let mut lengths = [a.distance(b), b.distance(c), c.distance(a)];
        lengths.sort_by(f64::total_cmp);
        let [shortest, middle, longest] = lengths;
        let twice_area = (b - a).cross(c - a).length();
        // The smallest angle lies between the two longer edges and is at most 60°.
        let sine = (twice_area / (middle * longest)).min(1.0);
        Self {
            angle_deg: if sine.is_nan() {
                0.0
            } else {
                sine.asin().to_degrees()
            },
            aspect: if twice_area > 0.0 {
                longest * longest / twice_area
            } else {
                f64::INFINITY
            },
            shortest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, mesh};
    use crate::stitch;
    use subdiv::Fragments;

    fn of(fragments: &Fragments) -> Option<Quality> {
        let brep = stitch(fragments).expect("closed");
        Quality::of(&brep.validate().expect("valid"))
    }

    fn close(a: f64, b: f64) -> bool {
        (a - b).abs() < 1e-12
    }

    #[test]
    fn a_cube_has_right_isosceles_facets() {
        let found = of(&cube([0.0; 3], 1.0)).expect("facets");
        assert!(close(found.smallest_angle_deg, 45.0) && close(found.mean_angle_deg, 45.0));
        assert!(close(found.largest_aspect, 2.0) && close(found.shortest_edge, 2.0));
        assert_eq!(found.slivers, 0);
    }

    /// A regular tetrahedron with one corner pulled away to a needle: its three long facets have
    /// the angle whose half has the sine ½/√(h² + 1/3).
    #[test]
    fn a_needle_has_slivers() {
        let h = 200.0_f64;
        let r = 1.0 / 3.0_f64.sqrt();
        let needle = mesh(
            &[
                [r, 0., 0.],
                [-r / 2.0, 0.5, 0.],
                [-r / 2.0, -0.5, 0.],
                [0., 0., h],
            ],
            &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        );
        let found = of(&needle).expect("facets");
        let side = (h * h + r * r).sqrt();
        let angle = 2.0 * (0.5 / side).asin().to_degrees();
        assert!((found.smallest_angle_deg - angle).abs() < 1e-9, "{found:?}");
        assert!((found.mean_angle_deg - (3.0 * angle + 60.0) / 4.0).abs() < 1e-9);
        assert_eq!(found.slivers, 3);
        assert!(close(found.shortest_edge, 1.0));
        // The longest edge over the height across it: ℓ / (sin α · 1 · …) = ℓ²/(2·area).
        let area = 0.5 * (h * h + r * r / 4.0).sqrt();
        assert!((found.largest_aspect - side * side / (2.0 * area)).abs() < 1e-6);
    }

    #[test]
    fn the_empty_boundary_has_no_shape() {
        assert_eq!(of(&Fragments::default()), None);
    }
}
