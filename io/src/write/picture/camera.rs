//! Parallel projection along a direction.

use super::View;
use glam::{Vec2, Vec3};

/// Right-handed unit axes of a parallel projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    pub right: Vec3,
    pub up: Vec3,
    /// Toward the eye.
    pub toward: Vec3,
}

impl Axes {
    /// Looking from `toward`, with `up` upward as far as possible.
    pub(super) fn looking_from(toward: Vec3, up: Vec3) -> Self {
        let toward = toward.normalize_or(Vec3::Z);
        let right = up.cross(toward).try_normalize();
        let right = right.unwrap_or_else(|| toward.any_orthonormal_vector());
        Self {
            right,
            up: toward.cross(right),
            toward,
        }
    }

    pub(super) fn of_view(view: View) -> Self {
        let (toward, up) = match view {
            View::Isometric => (Vec3::new(1.0, -1.0, 1.0), Vec3::Z),
            View::Front => (Vec3::NEG_Y, Vec3::Z),
            View::Back => (Vec3::Y, Vec3::Z),
            View::Left => (Vec3::NEG_X, Vec3::Z),
            View::Right => (Vec3::X, Vec3::Z),
            View::Top => (Vec3::Z, Vec3::Y),
            View::Bottom => (Vec3::NEG_Z, Vec3::NEG_Y),
            View::Direction {
                azimuth_deg,
                elevation_deg,
            } => {
                let elevation = elevation_deg.clamp(-90.0, 90.0).to_radians();
                let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
                let (sin_e, cos_e) = elevation.sin_cos();
                let toward = glam::DVec3::new(cos_e * cos_a, cos_e * sin_a, sin_e);
                // The derivative by the elevation: upward also straight from above.
                let up = glam::DVec3::new(-sin_e * cos_a, -sin_e * sin_a, cos_e);
                (toward.as_vec3(), up.as_vec3())
            }
        };
        Self::looking_from(toward, up)
    }

    /// Coordinates along the three axes.
    pub(super) fn coordinates(&self, point: Vec3) -> Vec3 {
        Vec3::new(
            point.dot(self.right),
            point.dot(self.up),
            point.dot(self.toward),
        )
    }

    /// The point with these coordinates.
    pub(super) fn point(&self, coordinates: Vec3) -> Vec3 {
        self.right * coordinates.x + self.up * coordinates.y + self.toward * coordinates.z
    }
}

/// Projection to a grid of samples; y runs downward there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Camera {
    pub axes: Axes,
    /// Samples a unit of length.
    pub scale: f32,
    /// Where coordinates (0, 0) fall on the grid.
    offset: Vec2,
}

impl Camera {
    /// Fits points into a grid of this size, leaving a margin.
    pub(super) fn fit(axes: Axes, points: &[Vec3], size: Vec2, margin: f32) -> Self {
        let mut min = Vec2::INFINITY;
        let mut max = Vec2::NEG_INFINITY;
        for &point in points {
            let coordinates = axes.coordinates(point).truncate();
            min = min.min(coordinates);
            max = max.max(coordinates);
        }
        if !(max - min).is_finite() {
            (min, max) = (Vec2::NEG_ONE, Vec2::ONE);
        }
        let free = size * (1.0 - 2.0 * margin);
        let scale = (free / (max - min).max(Vec2::splat(1e-6))).min_element();
        let middle = (min + max) * 0.5 * Vec2::new(1.0, -1.0);
        Self {
            axes,
            scale,
            offset: size * 0.5 - middle * scale,
        }
    }

    /// Position on the grid, and depth: larger is nearer to the eye.
    pub(super) fn project(&self, point: Vec3) -> Vec3 {
        let Vec3 { x, y, z } = self.axes.coordinates(point);
        Vec3::new(
            x * self.scale + self.offset.x,
            self.offset.y - y * self.scale,
            z,
        )
    }

    /// Coordinates along right and up of what is seen at a sample.
    pub(super) fn coordinates_of(&self, sample: Vec2) -> [f64; 2] {
        let x = f64::from(sample.x) - f64::from(self.offset.x);
        let y = f64::from(self.offset.y) - f64::from(sample.y);
        [x, y].map(|steps| steps / f64::from(self.scale))
    }

    /// The point that projects there.
    pub(super) fn unproject(&self, sample: Vec2, depth: f32) -> Vec3 {
        let x = (sample.x - self.offset.x) / self.scale;
        let y = (self.offset.y - sample.y) / self.scale;
        self.axes.point(Vec3::new(x, y, depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const VIEWS: [View; 8] = [
        View::Isometric,
        View::Front,
        View::Back,
        View::Left,
        View::Right,
        View::Top,
        View::Bottom,
        View::Direction {
            azimuth_deg: 20.0,
            elevation_deg: 90.0,
        },
    ];

    #[test]
    fn axes_are_right_handed_and_unit() {
        for view in VIEWS {
            let Axes { right, up, toward } = Axes::of_view(view);
            assert!((right.cross(up) - toward).length() < 1e-6, "{view:?}");
            assert!(right.is_normalized() && up.is_normalized(), "{view:?}");
        }
    }

    #[test]
    fn unproject_inverts_project() {
        let corners = [Vec3::NEG_ONE, Vec3::new(1.0, 0.5, 0.25)];
        for view in VIEWS {
            let size = Vec2::new(300.0, 200.0);
            let camera = Camera::fit(Axes::of_view(view), &corners, size, 0.1);
            for point in corners {
                let projected = camera.project(point);
                assert!(projected.x > 29.0 && projected.x < 271.0, "{view:?}");
                assert!(projected.y > 19.0 && projected.y < 181.0, "{view:?}");
                let back = camera.unproject(projected.truncate(), projected.z);
                assert!((back - point).length() < 1e-5, "{view:?}");
            }
        }
    }
}
