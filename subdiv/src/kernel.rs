//! The points of a planar polygon from which all of it is seen.

use glam::DVec3;

/// Work space for [`Kernel::center`].
#[derive(Debug, Default)]
pub(crate) struct Kernel {
    region: Vec<DVec3>,
    clipped: Vec<DVec3>,
}

impl Kernel {
    /// A point strictly on the inner side of every side, if there is one; `normal`: about which
    /// the ring runs counter-clockwise, of any length.
    pub(crate) fn center(
        &mut self,
        ring: impl Iterator<Item = DVec3> + Clone,
        normal: DVec3,
    ) -> Option<DVec3> {
        let origin = ring.clone().next()?;
        let reach = ring.clone().map(|p| p.distance(origin)).fold(0.0, f64::max);
        let normal = normal.try_normalize()?;
        let u = normal.any_orthonormal_vector() * reach;
        let v = normal.cross(u);
        self.region.clear();
        self.region
            .extend([u + v, v - u, -u - v, u - v].map(|corner| origin + corner));
        let next = ring.clone().skip(1).chain([origin]);
        let sides = ring
            .zip(next)
            .map(|(from, to)| (from, normal.cross(to - from)));
        for (from, inward) in sides.clone() {
            self.clip(from, inward);
        }
        let count = self.region.len() as f64;
        let center = self.region.iter().copied().sum::<DVec3>() / count;
        // Of an empty region the sum is not a number, which is above nothing.
        let sees = |(from, inward): (DVec3, DVec3)| {
            inward == DVec3::ZERO || inward.dot(center - from) > f64::EPSILON * reach * reach
        };
        sides.clone().all(sees).then_some(center)
    }

    /// Keeps what lies on the side to which `inward` points.
    fn clip(&mut self, from: DVec3, inward: DVec3) {
        self.clipped.clear();
        for (at, &here) in self.region.iter().enumerate() {
            let next = self.region[(at + 1) % self.region.len()];
            let (h, n) = (inward.dot(here - from), inward.dot(next - from));
            if h >= 0.0 {
                self.clipped.push(here);
            }
            if (h < 0.0 && n > 0.0) || (h > 0.0 && n < 0.0) {
                self.clipped.push(here + (next - here) * (h / (h - n)));
            }
        }
        std::mem::swap(&mut self.region, &mut self.clipped);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn center(ring: &[[f64; 2]]) -> Option<DVec3> {
        // In a slanted plane.
        let ring: Vec<DVec3> = ring
            .iter()
            .map(|[x, y]| DVec3::new(*x, *y, x + 2.0 * y))
            .collect();
        let normal = DVec3::new(-1.0, -2.0, 1.0);
        Kernel::default().center(ring.iter().copied(), normal)
    }

    #[test]
    fn what_sees_all_is_found() {
        let square = [[0., 0.], [2., 0.], [2., 2.], [0., 2.]];
        assert!(center(&square).is_some_and(|c| c.distance(DVec3::new(1., 1., 3.)) < 1e-12));
        // An L is seen from its corner only; its mean lies outside of that.
        let l = [[0., 0.], [9., 0.], [9., 1.], [1., 1.], [1., 9.], [0., 9.]];
        assert!(center(&l).is_some_and(|c| c.x < 1.0 && c.y < 1.0));
        let u = [
            [0., 0.],
            [3., 0.],
            [3., 3.],
            [2., 3.],
            [2., 1.],
            [1., 1.],
            [1., 3.],
            [0., 3.],
        ];
        assert_eq!(center(&u), None);
        assert_eq!(center(&[[0., 0.], [1., 1.], [2., 2.]]), None);
    }
}
