//! Quadrics in their own axes.

use super::QuadricKind;
use crate::Domain;
use glam::DVec3;

/// A quadric that has no [`Surface`](super::Surface) of its own: its equation in a right-handed
/// system of axes x, y, z through `center`.
///
/// | kind | equation | sizes |
/// | --- | --- | --- |
/// | `Ellipsoid` | x²/a² + y²/b² + z²/c² = 1 | a ≥ b ≥ c |
/// | `ImaginaryEllipsoid` | x²/a² + y²/b² + z²/c² = −1 | a ≥ b ≥ c |
/// | `HyperboloidOfOneSheet` | x²/a² + y²/b² − z²/c² = 1 | a ≥ b, c |
/// | `HyperboloidOfTwoSheets` | x²/a² + y²/b² − z²/c² = −1 | a ≥ b, c |
/// | `EllipticCone` | x²/a² + y²/b² = z² | a ≥ b, tangents of the half-angles |
/// | `Point` | x²/a² + y²/b² + z² = 0 | a ≥ b |
/// | `EllipticParaboloid` | x²/2a + y²/2b = z | a ≥ b, radii of curvature at the vertex |
/// | `HyperbolicParaboloid` | x²/2a − y²/2b = z | a ≥ b, radii of curvature at the saddle |
/// | `EllipticCylinder` | x²/a² + y²/b² = 1 | a ≥ b |
/// | `ImaginaryCylinder` | x²/a² + y²/b² = −1 | a ≥ b |
/// | `HyperbolicCylinder` | x²/a² − y²/b² = 1 | a, b |
/// | `ParabolicCylinder` | x²/2a = z | a, radius of curvature at the vertex |
/// | `CrossingPlanes` | y = ±x tan a | a, in (0, π/4] |
/// | `Line` | x²/a² + y² = 0 | a ≥ 1 |
/// | `ParallelPlanes` | x = ±a | a |
/// | `ImaginaryPlanes` | x² = −a² | a |
/// | `DoublePlane` | x² = 0 | – |
///
/// Sizes that are not there are 0. Where the surface repeats along axes, `center` is the point
/// nearest to the origin; elsewhere it is the centre, the apex or the vertex.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct QuadricForm {
    /// Which equation it is.
    pub kind: QuadricKind,
    /// Where x = y = z = 0.
    pub center: DVec3,
    /// Directions of x, y and z, of length 1. Those of equal sizes are arbitrary.
    pub axes: [DVec3; 3],
    /// a, b and c, in model units but for tangents, ratios and angles.
    pub sizes: [f64; 3],
}

impl QuadricForm {
    /// With z the axis of index `special`, and x and y the others in order of falling sizes.
    pub(super) fn around(
        kind: QuadricKind,
        center: DVec3,
        axes: [DVec3; 3],
        special: usize,
        sizes: [f64; 3],
    ) -> Self {
        let [mut i, mut j] = [(special + 1) % 3, (special + 2) % 3];
        if sizes[i] < sizes[j] {
            (i, j) = (j, i);
        }
        let sizes = [sizes[i], sizes[j], sizes[special]];
        Self::new(kind, center, axes[i], axes[special], sizes)
    }

    /// From the directions of x and z; z may be turned where only its line matters.
    pub(super) fn new(
        kind: QuadricKind,
        center: DVec3,
        x: DVec3,
        z: DVec3,
        sizes: [f64; 3],
    ) -> Self {
        Self {
            kind,
            center,
            axes: [x, z.cross(x), z],
            sizes,
        }
        .anchored()
    }

    /// The two planes of a pair that is real: a normal of length 1, and the offset along it.
    #[must_use]
    pub fn planes(&self) -> Option<[(DVec3, f64); 2]> {
        let [x, y, _] = self.axes;
        let [a, ..] = self.sizes;
        let through = |normal: DVec3, offset: f64| (normal, normal.dot(self.center) + offset);
        match self.kind {
            QuadricKind::CrossingPlanes => {
                let (sine, cosine) = a.sin_cos();
                Some([cosine, -cosine].map(|cosine| through(x * sine + y * cosine, 0.0)))
            }
            QuadricKind::ParallelPlanes => Some([through(x, a), through(x, -a)]),
            QuadricKind::DoublePlane => Some([through(x, 0.0); 2]),
            _ => None,
        }
    }

    /// Moves the centre to the point nearest to the origin, where it is free.
    fn anchored(mut self) -> Self {
        let [_, y, z] = self.axes;
        let free: &[DVec3] = match self.kind {
            QuadricKind::EllipticCylinder
            | QuadricKind::ImaginaryCylinder
            | QuadricKind::HyperbolicCylinder
            | QuadricKind::CrossingPlanes
            | QuadricKind::Line => &[z],
            QuadricKind::ParabolicCylinder => &[y],
            QuadricKind::ParallelPlanes
            | QuadricKind::ImaginaryPlanes
            | QuadricKind::DoublePlane => &[y, z],
            _ => &[],
        };
        for &direction in free {
            self.center = self.center.reject_from_normalized(direction);
        }
        self
    }

    /// The form given in a domain's centred coordinates, in model units.
    pub(super) fn in_model(self, domain: &Domain) -> Self {
        let scale = match self.kind {
            QuadricKind::EllipticCone
            | QuadricKind::Point
            | QuadricKind::CrossingPlanes
            | QuadricKind::Line => 1.0,
            _ => domain.half_size(),
        };
        Self {
            center: domain.from_centered(self.center),
            sizes: self.sizes.map(|size| size * scale),
            ..self
        }
        .anchored()
    }
}
