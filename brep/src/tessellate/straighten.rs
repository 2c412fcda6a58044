//! Facets that lean, turned upright.

use super::Run;
use super::patchwork::{NONE, Role};

/// Rounds, at most.
const ROUNDS: usize = 8;

/// What counts as less lean.
const LEAST: f64 = 1e-6;

impl Run<'_> {
    /// Turns facets that lean: by flips, and by taking away vertices that are out of place.
    ///
    /// A subdivision's facets do not lean against its own interpolants; they may against the
    /// true surfaces, or when their B-Rep edges have moved to where they should be.
    pub(super) fn straighten(&mut self) {
        for _ in 0..ROUNDS {
            let leaning: Vec<u32> = (self.mesh.facets())
                .filter(|&facet| self.shape_of(3 * facet).lean > 0.0)
                .filter(|&facet| !self.kept[self.face_of(3 * facet)])
                .collect();
            let mut done = 0;
            for facet in &leaning {
                done += usize::from(self.straighten_facet(*facet));
            }
            if done == 0 {
                break;
            }
        }
    }

    /// The flip or collapse that lessens the lean most.
    fn straighten_facet(&mut self, facet: u32) -> bool {
        let sides = [3 * facet, 3 * facet + 1, 3 * facet + 2];
        if self.mesh.origin[sides[0] as usize] == NONE || self.shape_of(sides[0]).lean == 0.0 {
            return false;
        }
        for h in sides {
            if self.is_inner(h) {
                let chord = self.other_chord(h);
                let [before, after] = self.around_flip(h, chord);
                if after.lean < before.lean - LEAST && self.mesh.may_flip(h) {
                    self.flip(h, chord);
                    return true;
                }
            }
        }
        let mut best = (LEAST, NONE);
        for corner in sides {
            let vertex = self.mesh.origin[corner as usize] as usize;
            let role = self.mesh.roles[vertex];
            let before = self.around(corner);
            for h in self.mesh.ring(corner) {
                let along = role == Role::Chain && self.mesh.crease[h as usize] != NONE;
                if role != Role::Inside && !along {
                    continue;
                }
                if let Some(after) = self.collapsed(h, before, f64::INFINITY)
                    && before.lean - after.lean > best.0
                {
                    best = (before.lean - after.lean, h);
                }
            }
        }
        if best.1 == NONE {
            return false;
        }
        self.collapse(best.1);
        true
    }
}
