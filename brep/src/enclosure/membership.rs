//! Whether a triangle is proved to lie in a solid, or outside of it.

use super::field::Field;
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};
use glam::DVec3;
use smallvec::SmallVec;

/// Times that a triangle may be bisected.
const DEPTH: usize = 14;

/// From this depth on all signs of what is open are tried.
const CASES_FROM: usize = 3;

/// For so many surfaces at most.
const MOST_CASES: usize = 5;

/// Parts of one triangle that are looked at, at most.
const PARTS: usize = 256;

/// Work space for the questions about one solid.
pub(super) struct Membership<'a> {
    fields: &'a [Field<'a>],
    scratch: LocalizeScratch,
    /// By depth: the formula, pruned to what is open in the part of that depth that is looked at.
    pruned: Vec<Vec<FormulaNode>>,
    open: Vec<([DVec3; 3], usize)>,
}

impl<'a> Membership<'a> {
    pub(super) fn new(fields: &'a [Field<'a>]) -> Self {
        Self {
            fields,
            scratch: LocalizeScratch::default(),
            pruned: vec![Vec::new(); DEPTH + 2],
            open: Vec::new(),
        }
    }

    /// The formula in a ball: decided, or what is open of it, appended to `out`.
    pub(super) fn in_ball(
        &mut self,
        nodes: &[FormulaNode],
        center: DVec3,
        radius: f64,
        out: &mut Vec<FormulaNode>,
    ) -> Ternary {
        let value = |PrimitiveId(at): PrimitiveId| {
            self.fields[at as usize].over_ball(center, radius).side()
        };
        localize(nodes, value, out, &mut self.scratch)
    }

    /// Whether all of a triangle is proved to be on the side that is asked for.
    pub(super) fn is(
        &mut self,
        nodes: &[FormulaNode],
        triangle: [DVec3; 3],
        side: Ternary,
    ) -> bool {
        self.pruned[0].clear();
        self.pruned[0].extend_from_slice(nodes);
        self.open.clear();
        self.open.push((triangle, 0));
        let mut parts = 0;
        while let Some((corners, depth)) = self.open.pop() {
            parts += 1;
            let (above, below) = self.pruned.split_at_mut(depth + 1);
            let value = |PrimitiveId(at): PrimitiveId| {
                self.fields[at as usize].over_triangle(corners).side()
            };
            below[0].clear();
            let found = localize(&above[depth], value, &mut below[0], &mut self.scratch);
            if found == side {
                continue;
            }
            if found == Ternary::Unknown
                && depth >= CASES_FROM
                && self.is_for_all_signs(depth + 1, side)
            {
                continue;
            }
            if found != Ternary::Unknown || depth == DEPTH || parts > PARTS {
                return false;
            }
            let [a, b, c] = longest_first(corners);
            let middle = a.midpoint(b);
            self.open.push(([middle, b, c], depth + 1));
            self.open.push(([a, middle, c], depth + 1));
        }
        true
    }
}

impl Membership<'_> {
    /// Whether what is open of the formula at a depth has one value whatever the signs: of parts that are
    /// glued together along a surface each says that it is not known, and both together that it is inside.
    fn is_for_all_signs(&mut self, depth: usize, side: Ternary) -> bool {
        let nodes = &self.pruned[depth];
        let mut open: SmallVec<[PrimitiveId; 8]> = (nodes.iter())
            .filter_map(|node| match node {
                FormulaNode::Literal(literal) => Some(literal.primitive),
                _ => None,
            })
            .collect();
        open.sort_unstable();
        open.dedup();
        if nodes.len() < 2 || open.len() > MOST_CASES {
            return false;
        }
        let mut none = Vec::new();
        (0_u32..1 << open.len()).all(|signs| {
            let value = |primitive| match open.binary_search(&primitive) {
                Ok(at) if signs >> at & 1 == 1 => Ternary::In,
                _ => Ternary::Out,
            };
            none.clear();
            localize(nodes, value, &mut none, &mut self.scratch) == side
        })
    }
}

/// The corners in such an order that the longest side is the one between the first two.
fn longest_first([a, b, c]: [DVec3; 3]) -> [DVec3; 3] {
    let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| p.distance_squared(q));
    if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
