//! Facets that pass through others, or stand across their surface, split where they are.
//!
//! Where two surfaces meet at a small angle their facets must be smaller than the tolerance asks
//! for, near the edge only.

use super::Run;
use super::assemble::Trouble;
use super::patchwork::{NONE, next};
use crate::stitch::stitch;
use crate::topology::Brep;
use crate::validate::Valid;

/// Times that all facets in trouble may be split: halves their edges about half as often.
const MENDINGS: usize = 8;

/// Times as many troubles as in the beginning say that splitting makes it worse.
const WORSE: usize = 4;

impl Run<'_> {
    /// The boundary, after what did not come out well has been split; what still does not.
    pub(super) fn mended(&mut self, tolerance: f64) -> Result<Valid<Brep>, Vec<Trouble>> {
        let mut result = self.boundary(tolerance);
        let mut most = usize::MAX;
        for _ in 0..MENDINGS {
            let Err(troubles) = &result else {
                break;
            };
            most = most.min(WORSE * troubles.len());
            let is_too_large = self.mesh.face.len() > self.most_facets;
            if is_too_large || troubles.len() > most || !self.split_troubled(troubles) {
                break;
            }
            self.straighten();
            self.split_far_facets();
            result = self.boundary(tolerance);
        }
        result
    }

    fn boundary(&self, tolerance: f64) -> Result<Valid<Brep>, Vec<Trouble>> {
        let facets = self.facets(tolerance)?;
        let brep = stitch(&facets.fragments).map_err(|_| self.doubled(&facets))?;
        brep.validate().map_err(|_| self.doubled(&facets))
    }

    /// Splits the longest edge of each facet, and those edges of planar ones that are B-Rep
    /// edges; whether there was one.
    fn split_troubled(&mut self, troubles: &[Trouble]) -> bool {
        let mut edges = Vec::new();
        for trouble in troubles {
            let Some([a, b, c]) = trouble.corners else {
                return false;
            };
            if let Some([p, q]) = trouble.side {
                edges.push([p.min(q), p.max(q)]);
                continue;
            }
            let sides = [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
            if self.is_capped(trouble.face) {
                edges.extend(sides);
            } else {
                let length = |[p, q]: &[u32; 2]| {
                    self.mesh
                        .position(*p)
                        .distance_squared(self.mesh.position(*q))
                };
                edges.extend(
                    sides
                        .into_iter()
                        .max_by(|one, other| length(one).total_cmp(&length(other))),
                );
            }
        }
        edges.sort_unstable();
        edges.dedup();
        let mut is_any = false;
        for edge in edges {
            let Some(h) = self.edge_between(edge) else {
                continue;
            };
            let t = self.mesh.twin[h as usize];
            if self.mesh.crease[h as usize] == NONE && self.is_planar(h) && self.is_planar(t) {
                continue;
            }
            if let Some(spoke) = self.split_in_the_middle(h) {
                let mut open: Vec<u32> = self.mesh.ring(spoke).map(next).collect();
                self.flip_from(&mut open, false, super::FLIPS, |_| {});
                is_any = true;
            }
        }
        is_any
    }

    fn edge_between(&self, [a, b]: [u32; 2]) -> Option<u32> {
        let first = self.mesh.outgoing[a as usize];
        if first == NONE {
            return None;
        }
        self.mesh.ring(first).find(|&h| self.mesh.target(h) == b)
    }
}
