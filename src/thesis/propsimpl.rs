//! PROPSIMPL: a solid's area from its linear approximation, its volume from its subdivision
//! (thesis A.6).

use super::pipe::{Codes, read_input};
use crate::failure::Failure;
use crate::output::write_bytes;
use crate::run::Target;
use crate::talk::Talk;
use clap::Args;
use csg::{
    FormulaNode, Literal, LocalizeScratch, MaterialId, PrimitiveId, Sense, Ternary, localize,
};
use glam::DVec3;
use io::thesis::approximation::{self, Face};
use io::thesis::sectors::{SectorPrimitive, volume};
use io::thesis::subdivision::{self, Node, Subdivision};
use io::thesis::tree::Tree;
use std::path::PathBuf;

/// Options of PROPSIMPL, as in the thesis; the last of -A and -V counts.
#[derive(Args, Debug)]
#[command(group = clap::ArgGroup::new("property").required(true).multiple(true))]
pub(crate) struct PropsimplArgs {
    /// The area of a linear approximation
    #[arg(short = 'A', short_alias = 'a', group = "property", overrides_with_all = ["area", "volume"])]
    area: bool,
    /// The volume of a subdivision
    #[arg(short = 'V', group = "property", overrides_with_all = ["area", "volume"])]
    volume: bool,
    /// The file to read; `-` is standard input
    #[arg(value_name = "IN", default_value = "-")]
    input: PathBuf,
    #[command(flatten)]
    codes: Codes,
}

pub(crate) fn run(args: &PropsimplArgs, talk: Talk) -> Result<(), Failure> {
    let line = if args.area {
        let (_, faces) = read_input(&args.input, approximation::read)?;
        format!("area: {}\n", area(&faces.value))
    } else {
        let operators = args.codes.operators();
        let (_, trees) = read_input(&args.input, |bytes| subdivision::read(bytes, operators))?;
        let volume = Volume::of(&trees.value);
        talk.explain(|| {
            let most = volume.full + volume.front;
            format!("between {} and {most}", volume.full)
        });
        format!("volume: {}\n", volume.estimate)
    };
    write_bytes(&Target::Stdout, line.as_bytes())
}

fn area(faces: &[Face]) -> f64 {
    let triangle = |face: &Face| {
        let [a, b, c] = face.corners.map(DVec3::from);
        0.5 * (b - a).cross(c - a).length()
    };
    faces.iter().map(triangle).sum()
}

/// Volumes of a subdivision.
#[derive(Clone, Copy, Default, Debug)]
struct Volume {
    /// Of simplices inside the solid: a lower bound.
    full: f64,
    /// Of those that its boundary may cross.
    front: f64,
    /// With the part of the latter that lies inside the affine interpolants.
    estimate: f64,
}

impl Volume {
    fn of(trees: &[Subdivision]) -> Self {
        let mut sum = Self::default();
        for tree in trees {
            // Simplices still to come with their levels, the next one on top.
            let mut open = vec![(tree.vertices, 0_u8)];
            for node in &tree.nodes {
                let Some((vertices, level)) = open.pop() else {
                    break;
                };
                let size = volume(&vertices).abs() / 6.0;
                match node {
                    Node::Full => {
                        sum.full += size;
                        sum.estimate += size;
                    }
                    Node::Empty => {}
                    Node::Mixed => {
                        let [near, far] = children(&vertices, level);
                        let level = (level + 1) % 3;
                        open.extend([(far, level), (near, level)]);
                    }
                    Node::Front(front) => {
                        sum.front += size;
                        sum.estimate += size * fraction(front);
                    }
                }
            }
        }
        sum
    }
}

/// Table 4.1: what halving the edge v0–v3 gives, by the parent's type.
fn children(v: &[[f64; 3]; 4], kind: u8) -> [[[f64; 3]; 4]; 2] {
    let middle: [f64; 3] = std::array::from_fn(|x| 0.5 * (v[0][x] + v[3][x]));
    let near = [v[0], middle, v[1], v[2]];
    let far = match kind {
        0 => [v[3], middle, v[2], v[1]],
        _ => [v[3], middle, v[1], v[2]],
    };
    [near, far]
}

/// Bisections of a simplex in which several primitives meet: its part of the volume is known to
/// 2⁻⁴ of the cells that are cut then.
const BISECTIONS: u8 = 12;

/// The share of a simplex that lies inside the affine interpolants' solid.
fn fraction(front: &Tree<SectorPrimitive>) -> f64 {
    let mut values: Vec<[f64; 4]> = Vec::new();
    let formula = front.to_formula(|primitive| {
        values.push(vertex_values(primitive));
        Literal {
            primitive: PrimitiveId(u32::try_from(values.len() - 1).unwrap_or(u32::MAX)),
            sense: Sense::Inside,
            material: MaterialId(0),
        }
    });
    let mut scratch = LocalizeScratch::default();
    // A simplex by the values in its corners; which corners they are does not matter.
    let mut open = vec![(formula, values, 0_u8, 1.0)];
    let mut inside = 0.0;
    while let Some((formula, values, level, share)) = open.pop() {
        let value = |p: PrimitiveId| match values.get(p.0 as usize) {
            Some(v) if v.iter().all(|x| *x < 0.0) => Ternary::In,
            Some(v) if v.iter().all(|x| *x >= 0.0) => Ternary::Out,
            _ => Ternary::Unknown,
        };
        let mut pruned = Vec::new();
        match localize(&formula, value, &mut pruned, &mut scratch) {
            Ternary::In => inside += share,
            Ternary::Out => {}
            Ternary::Unknown => match pruned.as_slice() {
                [FormulaNode::Literal(literal)] => {
                    let part = values.get(literal.primitive.0 as usize).map_or(0.0, below);
                    inside += share
                        * match literal.sense {
                            Sense::Inside => part,
                            Sense::Outside => 1.0 - part,
                        };
                }
                _ if level == BISECTIONS => inside += 0.5 * share,
                _ => {
                    let halves = values.iter().map(|[a, b, c, d]| {
                        let middle = 0.5 * (a + d);
                        let far = if level % 3 == 0 {
                            [*d, middle, *c, *b]
                        } else {
                            [*d, middle, *b, *c]
                        };
                        ([*a, middle, *b, *c], far)
                    });
                    let (near, far) = halves.unzip();
                    open.push((pruned.clone(), far, level + 1, 0.5 * share));
                    open.push((pruned, near, level + 1, 0.5 * share));
                }
            },
        }
    }
    inside
}

fn vertex_values(primitive: &SectorPrimitive) -> [f64; 4] {
    let c = &primitive.coefficients;
    let n = primitive.degree;
    // v0 is first, v3 last; before v1 stand all with lower powers of the others.
    let at = |m: usize, q: usize, l: usize| {
        c.get(m * (m + 1) * (m + 2) / 6 + q * (q + 1) / 2 + l)
            .copied()
            .unwrap_or_default()
    };
    [at(0, 0, 0), at(n, 0, 0), at(n, n, 0), at(n, n, n)]
}

/// The share of a simplex in which an affine function is negative, exactly.
fn below(values: &[f64; 4]) -> f64 {
    let mut sorted = *values;
    sorted.sort_by(f64::total_cmp);
    let [a, b, c, d] = sorted;
    // How far from x the zero lies on the edge to y.
    let cut = |x: f64, y: f64| x / (x - y);
    match sorted.iter().filter(|x| **x < 0.0).count() {
        0 => 0.0,
        1 => cut(a, b) * cut(a, c) * cut(a, d),
        2 => {
            // A wedge of three simplices between the edges a–b and the four cuts.
            let (p, q, r, s) = (cut(a, c), cut(a, d), cut(b, c), cut(b, d));
            p * q + p * s * (1.0 - q) + r * s * (1.0 - p)
        }
        3 => 1.0 - cut(d, a) * cut(d, b) * cut(d, c),
        _ => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Halves, an eighth, and its rest, by hand.
    #[test]
    fn shares_of_a_simplex() {
        for (values, share) in [
            ([-1.0, 1.0, 1.0, 1.0], 0.125),
            ([-1.0, -1.0, 1.0, 1.0], 0.5),
            ([1.0, -1.0, -1.0, -1.0], 0.875),
            ([0.0, 0.0, 1.0, -3.0], 0.75),
        ] {
            assert!((below(&values) - share).abs() < f64::EPSILON, "{values:?}");
        }
    }
}
