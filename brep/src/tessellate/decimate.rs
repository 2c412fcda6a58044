//! Vertices taken away where the rest stays near its surface and faces the same way.

use super::Run;
use super::measure::Shape;
use super::patchwork::{NONE, Role, next, prev};

/// How often a vertex is looked at, at most, on average.
const LOOKS: usize = 8;

impl Run<'_> {
    /// The facets around the vertex where a half-edge starts, as they are.
    pub(super) fn around(&self, h: u32) -> Shape {
        (self.mesh.ring(h)).fold(Shape::default(), |all, spoke| {
            all.worse_of(self.shape_of(spoke))
        })
    }

    /// What collapsing a → b makes of the facets around a, which are `before` now; `None` if
    /// one deviates by more than `within` (and, beyond 1, by more than before), if they lean
    /// more, or if it must not be.
    pub(super) fn collapsed(&self, h: u32, before: Shape, within: f64) -> Option<Shape> {
        let most = if within > 1.0 {
            within.max(before.error)
        } else {
            within
        };
        let t = self.mesh.twin[h as usize];
        let to = self.mesh.position(self.mesh.target(h));
        let sides = [(next(h), self.face_of(h)), (t, self.face_of(t))];
        let end = next(t);
        let mut spoke = self.mesh.twin[prev(h) as usize];
        // The new edge to the spoke's target: in which face, and what it deviates.
        let mut known = (sides[0].1, self.mesh.chord[next(h) as usize]);
        let mut after = Shape::default();
        while spoke != end {
            let following = self.mesh.twin[prev(spoke) as usize];
            let face = self.face_of(spoke);
            if self.sheets[face].is_plane() {
                known.0 = usize::MAX;
                spoke = following;
                continue;
            }
            let [far, ahead] = [next(spoke), prev(spoke)].map(|e| self.mesh.origin[e as usize]);
            let [far, ahead] = [far, ahead].map(|v| self.mesh.position(v));
            let first = if known.0 == face {
                known.1
            } else {
                self.chord(face, to, far)
            };
            let second = if following == end && face == sides[1].1 {
                self.mesh.chord[prev(t) as usize]
            } else {
                self.chord(face, to, ahead)
            };
            // Most collapses fail here: one new edge is enough.
            if first.max(second) > most {
                return None;
            }
            let normal = self.mesh.normal[sides[usize::from(face != sides[0].1)].0 as usize];
            let [far_normal, ahead_normal] =
                [next(spoke), prev(spoke)].map(|e| self.mesh.normal[e as usize]);
            let outer = self.mesh.chord[next(spoke) as usize];
            after = after.worse_of(Shape::new(
                [to, far, ahead],
                [normal, far_normal, ahead_normal],
                [first, outer, second],
            ));
            if after.error > most || after.lean > before.lean {
                return None;
            }
            known = (face, second);
            spoke = following;
        }
        self.mesh.may_collapse(h).then_some(after)
    }

    /// Takes vertices of the subdivision off the B-Rep edges that have got points of their own.
    pub(super) fn collapse_along_chains(&mut self, mut vertices: Vec<u32>) {
        // In the end by all means, for the edge may have a double elsewhere: where two solids
        // touch along it. What leans then is straightened afterwards.
        for (limit, may_lean) in [
            (1.0, 0.0),
            (4.0, 0.0),
            (f64::INFINITY, 0.0),
            (f64::INFINITY, f64::INFINITY),
        ] {
            loop {
                let before = vertices.len();
                vertices.retain(|&vertex| {
                    let first = self.mesh.outgoing[vertex as usize];
                    let mut around = self.around(first);
                    around.lean += may_lean;
                    let best = (self.mesh.ring(first))
                        .filter(|&h| self.mesh.crease[h as usize] != NONE)
                        .filter_map(|h| Some((self.collapsed(h, around, limit)?, h)))
                        .min_by(|(a, _), (b, _)| a.error.total_cmp(&b.error));
                    if let Some((_, h)) = best {
                        self.collapse(h);
                    }
                    best.is_none()
                });
                if vertices.len() == before {
                    break;
                }
            }
        }
    }

    /// Takes away vertices inside faces as long as that keeps the tolerance.
    pub(super) fn decimate(&mut self) {
        self.flip_all(false);
        let inside = |role: &Role| *role == Role::Inside;
        let mut waits: Vec<bool> = self.mesh.roles.iter().map(inside).collect();
        let mut open: std::collections::VecDeque<u32> = (0..super::index(waits.len()))
            .filter(|&vertex| waits[vertex as usize])
            .collect();
        let mut left = LOOKS * open.len();
        let mut flips = Vec::new();
        while let Some(vertex) = open.pop_front() {
            waits[vertex as usize] = false;
            let first = self.mesh.outgoing[vertex as usize];
            if first == NONE || left == 0 {
                continue;
            }
            left -= 1;
            let around = self.around(first);
            let best = (self.mesh.ring(first))
                .filter_map(|h| Some((self.collapsed(h, around, 1.0)?, h)))
                .min_by(|(a, _), (b, _)| a.error.total_cmp(&b.error));
            let Some((_, h)) = best else {
                continue;
            };
            let target = self.mesh.target(h);
            let at = self.collapse(h);
            flips.clear();
            flips.extend(self.mesh.ring(at).flat_map(|spoke| [spoke, next(spoke)]));
            self.flip_from(&mut flips, false, super::FLIPS, |_| {});
            for spoke in self.mesh.ring(self.mesh.outgoing[target as usize]) {
                let near = self.mesh.target(spoke);
                if self.mesh.roles[near as usize] == Role::Inside && !waits[near as usize] {
                    waits[near as usize] = true;
                    open.push_back(near);
                }
            }
        }
    }
}
