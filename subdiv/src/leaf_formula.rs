//! The formula of one leaf, over the few primitives that cross it.

use crate::patterns::{CROWD, Patterns};
use csg::{
    FormulaNode, Literal, LocalizeScratch, MaterialId, PrimitiveId, Sense, Ternary, localize,
};

/// A set of local primitives inside whose half-space `p ≤ 0` a region lies, one bit each.
pub(crate) type Pattern = u128;

/// Most primitives that one leaf can arrange.
pub(crate) const MAX_LEAF_PRIMITIVES: usize = 128;

/// What a piece of a primitive's zero set is to the solid.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Label {
    /// On which side of the primitive the solid lies.
    pub sense: Sense,
    /// The material shown.
    pub material: MaterialId,
}

/// A formula whose primitives are numbered 0, 1, … in the order of their global indices.
#[derive(Clone, Debug, Default)]
pub(crate) struct LeafFormula {
    nodes: Vec<FormulaNode>,
    /// Global index of each local primitive, ascending.
    pub primitives: Vec<u32>,
    /// The only material of each local primitive's literals, if it is one only.
    single_material: Vec<Option<MaterialId>>,
    /// Those with literals of both senses.
    two_sided: Pattern,
    /// All values, for as many primitives as patterns have.
    table: Patterns,
    open: Vec<(usize, Patterns)>,
    scratch: LocalizeScratch,
    none: Vec<FormulaNode>,
}

impl LeafFormula {
    /// Takes over a pruned formula; its primitives get local numbers.
    pub(crate) fn load(&mut self, nodes: &[FormulaNode]) {
        self.primitives.clear();
        for node in nodes {
            if let FormulaNode::Literal(literal) = node
                && !self.primitives.contains(&literal.primitive.0)
            {
                self.primitives.push(literal.primitive.0);
            }
        }
        self.primitives.sort_unstable();
        self.nodes.clear();
        self.single_material.clear();
        self.single_material.resize(self.primitives.len(), None);
        let mut seen = [0 as Pattern; 2];
        for node in nodes {
            let FormulaNode::Literal(literal) = *node else {
                self.nodes.push(*node);
                continue;
            };
            let local = self
                .primitives
                .binary_search(&literal.primitive.0)
                .unwrap_or(0);
            let bit = 1 << (local % MAX_LEAF_PRIMITIVES);
            if (seen[0] | seen[1]) & bit == 0 {
                self.single_material[local] = Some(literal.material);
            } else if self.single_material[local] != Some(literal.material) {
                self.single_material[local] = None;
            }
            seen[usize::from(literal.sense == Sense::Inside)] |= bit;
            self.nodes.push(FormulaNode::Literal(Literal {
                primitive: PrimitiveId(local as u32),
                ..literal
            }));
        }
        self.two_sided = seen[0] & seen[1];
        if self.primitives.len() <= CROWD {
            self.table = Patterns::of_formula(&self.nodes, |local| local as usize, &mut self.open);
        }
    }

    /// Number of primitives.
    #[must_use]
    pub(crate) fn len(&self) -> usize {
        self.primitives.len()
    }

    /// Whether the material of a face may depend on where it is.
    #[must_use]
    pub(crate) fn has_mixed_materials(&self) -> bool {
        self.single_material.contains(&None)
    }

    /// The primitives that tell where on primitive `local` the boundary lies, where those in
    /// `inside` and `outside` are known to be so; `None` if there is no boundary.
    ///
    /// All of those not known are named where `local` and one of them have literals of both
    /// senses, so that four sheets may meet in their crease, or where a face's material depends
    /// on others.
    pub(crate) fn deciding(
        &mut self,
        local: usize,
        inside: Pattern,
        outside: Pattern,
    ) -> Option<Pattern> {
        let everything = Pattern::MAX >> (MAX_LEAF_PRIMITIVES - self.primitives.len());
        let bit = |at: usize| (1 as Pattern) << at;
        let crossing = everything & !(inside | outside | bit(local));
        let alternating = self.two_sided & bit(local) != 0 && self.two_sided & crossing != 0;
        if alternating || self.has_mixed_materials() {
            return Some(crossing);
        }
        let mut deciding = 0;
        let mut values = [Ternary::Unknown; 2];
        for (own, result) in [Ternary::In, Ternary::Out].into_iter().zip(&mut values) {
            let value = |p: PrimitiveId| {
                let at = p.0 as usize;
                if at == local {
                    own
                } else if inside & bit(at) != 0 {
                    Ternary::In
                } else if outside & bit(at) != 0 {
                    Ternary::Out
                } else {
                    Ternary::Unknown
                }
            };
            self.none.clear();
            *result = localize(&self.nodes, value, &mut self.none, &mut self.scratch);
            for node in &self.none {
                if let FormulaNode::Literal(literal) = node {
                    deciding |= bit(literal.primitive.0 as usize);
                }
            }
        }
        (deciding != 0 || values[0] != values[1]).then_some(deciding)
    }

    /// Whether a region with this pattern lies inside the solid.
    pub(crate) fn value(&mut self, pattern: Pattern) -> bool {
        if self.primitives.len() <= CROWD {
            self.table.holds(pattern as u8)
        } else {
            let inside = |local: usize| pattern >> local & 1 == 1;
            evaluate(&self.nodes, inside, &mut self.none, &mut self.scratch)
        }
    }

    /// What primitive `local` is where the others have this pattern; `None`: not boundary.
    pub(crate) fn label(&mut self, local: usize, pattern: Pattern) -> Option<Label> {
        let bit: Pattern = 1 << local;
        let inner = self.value(pattern | bit);
        if inner == self.value(pattern & !bit) {
            return None;
        }
        let sense = if inner { Sense::Inside } else { Sense::Outside };
        let material = self.single_material[local]
            .unwrap_or_else(|| self.decisive_material(local, pattern, inner));
        Some(Label { sense, material })
    }

    /// Material of the literal at which the formula's value turns when the literals of `local`
    /// are switched from out to in one after the other, in formula order.
    fn decisive_material(&mut self, local: usize, pattern: Pattern, inner: bool) -> MaterialId {
        // Switched literals get a number of their own, one past the last.
        let switched = self.primitives.len();
        let mut nodes = self.nodes.clone();
        let mut last = MaterialId(0);
        for at in 0..nodes.len() {
            let FormulaNode::Literal(literal) = &mut nodes[at] else {
                continue;
            };
            if literal.primitive.0 as usize != local {
                continue;
            }
            literal.primitive = PrimitiveId(switched as u32);
            last = literal.material;
            let inside = |p: usize| p == switched || (p != local && pattern >> p & 1 == 1);
            if evaluate(&nodes, inside, &mut self.none, &mut self.scratch) == inner {
                break;
            }
        }
        last
    }
}

/// Value of a formula whose literals all are decided.
fn evaluate(
    nodes: &[FormulaNode],
    inside: impl Fn(usize) -> bool,
    none: &mut Vec<FormulaNode>,
    scratch: &mut LocalizeScratch,
) -> bool {
    let value = |p: PrimitiveId| {
        if inside(p.0 as usize) {
            Ternary::In
        } else {
            Ternary::Out
        }
    };
    none.clear();
    localize(nodes, value, none, scratch) == Ternary::In
}

#[cfg(test)]
mod tests {
    use super::*;

    fn literal(primitive: u32, sense: Sense, material: u32) -> FormulaNode {
        FormulaNode::Literal(Literal {
            primitive: PrimitiveId(primitive),
            sense,
            material: MaterialId(material),
        })
    }

    /// (7 ∩ 3) ∪ (7 ∩ ¬3) in two materials: the half-space 7, red where 3 holds, else blue.
    #[test]
    fn material_is_the_decisive_literals() {
        let (red, blue) = (1, 2);
        let nodes = [
            FormulaNode::Union { len: 6 },
            FormulaNode::Intersection { len: 2 },
            literal(7, Sense::Inside, red),
            literal(3, Sense::Inside, red),
            FormulaNode::Intersection { len: 2 },
            literal(7, Sense::Inside, blue),
            literal(3, Sense::Outside, blue),
        ];
        let mut formula = LeafFormula::default();
        formula.load(&nodes);
        assert_eq!(formula.primitives, [3, 7]);
        let expected = |material| {
            Some(Label {
                sense: Sense::Inside,
                material: MaterialId(material),
            })
        };
        assert_eq!(formula.label(1, 0b01), expected(red));
        assert_eq!(formula.label(1, 0b00), expected(blue));
        assert_eq!(formula.label(0, 0b10), None);
        assert_eq!(formula.label(0, 0b00), None);
    }
}
