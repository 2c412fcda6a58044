//! Where on its surface a face is.

use brep::{Brep, ExactBrep, ExactFace, Valid};
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::TAU;

/// Points on an edge.
const SAMPLES: usize = 32;
/// Half of the narrowest gap in which a surface may be cut open, in steps of a circle's samples.
const WIDER: f64 = 0.75;

/// Points of a face: on its edges, and the mesh's on what hangs together with it and lies on the
/// same surface.
pub(super) struct Region {
    edges: Vec<DVec3>,
    inner: Vec<DVec3>,
    facets: Vec<[DVec3; 3]>,
}

impl Region {
    pub(super) fn of(brep: &Valid<Brep>, exact: &ExactBrep, face: &ExactFace) -> Self {
        let mut edges = Vec::new();
        for half_edge in face.loops.iter().flatten() {
            let piece = &exact.edges[half_edge / 2].piece;
            let [from, to] = piece.range;
            edges.extend((0..=SAMPLES).map(|k| {
                let t = from + (to - from) * (k as f64 / SAMPLES as f64);
                piece.curve.point(t)
            }));
        }
        let (mut inner, mut facets) = (Vec::new(), Vec::new());
        let mut seen = HashSet::from([face.facet]);
        let mut stack = vec![face.facet];
        while let Some(key) = stack.pop() {
            let facet = brep.facet(key);
            let [a, b, c] = facet.positions();
            facets.push([a, b, c]);
            inner.extend([
                a,
                (a + b + c) / 3.0,
                a.midpoint(b),
                b.midpoint(c),
                c.midpoint(a),
            ]);
            for half_edge in facet.half_edges() {
                let next = half_edge.twin().facet();
                let is_same = next.primitive() == face.primitive && next.sense() == face.sense;
                if is_same && seen.insert(next.key()) {
                    stack.push(next.key());
                }
            }
        }
        Self {
            edges,
            inner,
            facets,
        }
    }

    /// Whether the mesh's facets are where a ray from a point passes.
    pub(super) fn is_hit(&self, from: DVec3, direction: DVec3) -> bool {
        /// Barycentric coordinates that count as zero: a ray may pass between two facets.
        const NONE: f64 = -1e-9;
        self.facets.iter().any(|&[a, b, c]| {
            let [a, b, c] = [a, b, c].map(|corner| corner - from);
            let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|area| area.dot(direction));
            let all: f64 = volumes.iter().sum();
            let [u, v, w] = volumes.map(|volume| volume / all);
            u >= NONE && v >= NONE && w >= NONE && (a * u + b * v + c * w).dot(direction) >= 0.0
        })
    }

    /// Consecutive points of the face's edges.
    pub(super) fn chords(&self) -> impl Iterator<Item = [DVec3; 2]> {
        let pieces = self.edges.chunks(SAMPLES + 1);
        pieces.flat_map(|piece| piece.windows(2).map(|pair| [pair[0], pair[1]]))
    }

    pub(super) fn points(&self) -> impl Iterator<Item = DVec3> {
        self.edges.iter().chain(&self.inner).copied()
    }

    /// Smallest and largest value of a function on the face, and some more on both sides.
    pub(super) fn range(&self, value: impl Fn(DVec3) -> f64) -> [f64; 2] {
        /// Part of the range that is added: the mesh's points do not reach as far as the face.
        const MARGIN: f64 = 0.3;
        let (low, high) = self
            .points()
            .map(value)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                (low.min(value), high.max(value))
            });
        let margin = MARGIN * (high - low);
        [low - margin, high + margin]
    }

    /// The middle of the widest gap between the angles of the face's edges, and half of its width;
    /// `None` if they are all around. A face that reaches to infinity within the gap has no
    /// edges there, and no other face is in it.
    pub(super) fn gap(&self, angle: impl Fn(DVec3) -> f64) -> Option<[f64; 2]> {
        let mut angles: Vec<f64> = self.edges.iter().map(|&point| angle(point)).collect();
        angles.sort_unstable_by(f64::total_cmp);
        let first = *angles.first()?;
        angles.push(first + TAU);
        let mut widest = [0.0, 0.0];
        for pair in angles.windows(2) {
            let half = 0.5 * (pair[1] - pair[0]);
            if half > widest[1] + 1e-9 {
                widest = [pair[0] + half, half];
            }
        }
        // A gap between two points of one edge is none: they are at most a turn by SAMPLES apart.
        (widest[1] > WIDER * TAU / SAMPLES as f64).then_some(widest)
    }

    /// The direction, of some that are evenly spread, that is farthest from those of all points,
    /// and the angle between, in radians.
    pub(super) fn clearing(&self, direction: impl Fn(DVec3) -> DVec3) -> (DVec3, f64) {
        /// Directions tried: about a tenth of a radian apart.
        const TRIED: u32 = 800;
        let all: Vec<DVec3> = self.points().map(direction).collect();
        let golden = TAU * 0.618_033_988_749_894_9;
        let mut best = (DVec3::Z, f64::NEG_INFINITY);
        for k in 0..TRIED {
            let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(TRIED);
            let (sine, cosine) = (golden * f64::from(k)).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let tried = DVec3::new(radius * cosine, radius * sine, z);
            let nearest = all.iter().map(|point| point.dot(tried));
            let nearest = nearest.fold(-1.0, f64::max);
            if -nearest > best.1 {
                best = (tried, -nearest);
            }
        }
        (best.0, (-best.1).clamp(-1.0, 1.0).acos())
    }
}
