//! SUBSIMPL: adaptive simplicial subdivision of a `.cspg` solid (thesis A.3).

use super::pipe::{Codes, Order, Pipe, read_input};
use super::sector_solid::{Group, SectorSolid};
use super::statistics::{Language, statistics};
use crate::failure::Failure;
use crate::output;
use crate::talk::Talk;
use clap::Args;
use csg::Sense;
use io::thesis::approximation::{self, Face, HYBRID};
use io::thesis::sectors::{self, SectorPrimitive, Sectors};
use io::thesis::subdivision::{self, Node, Subdivision};
use io::thesis::tree::Tree;
use std::time::Instant;
use subdiv::Criterion;
use subdiv::sectors::{Collect, LevelCount, SectorNode, SectorOutcome, SectorRule, subdivide};

/// Options of SUBSIMPL, as in the thesis.
#[derive(Args, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub(crate) struct SubsimplArgs {
    /// The defaults: -O a -P 0 -N 15 -M 0
    #[arg(short = 'D', short_alias = 'd')]
    default: bool,
    /// Print statistics instead of a result
    #[arg(short = 'E', short_alias = 'e', conflicts_with = "tolerance")]
    statistics: bool,
    /// What to write: the tree of the (S)ubdivision or the linear (A)pproximation; only the first
    /// letter counts
    #[arg(short = 'O', short_alias = 'o', value_name = "S|A", default_value = "a", value_parser = kind)]
    kind: Kind,
    /// Simplices with at most so many primitives are minimal; 0: none
    #[arg(short = 'P', short_alias = 'p', value_name = "N", default_value_t = 0)]
    max_primitives: usize,
    /// Bisections from each initial simplex to the minimal ones
    #[arg(
        short = 'N',
        short_alias = 'n',
        value_name = "N",
        default_value_t = 15,
        value_parser = clap::value_parser!(u8).range(0..=i64::from(subdiv::MAX_LEVEL))
    )]
    levels: u8,
    /// Level, counted from the minimal simplices, at which primitives become linear; only simplices
    /// with several primitives are bisected further
    #[arg(short = 'M', short_alias = 'm', value_name = "N", default_value_t = 0)]
    linear_levels: u8,
    /// Longest edge of the minimal simplices, in model units; overrides -N
    #[arg(short = 'T', short_alias = 't', value_name = "LENGTH", value_parser = length)]
    tolerance: Option<f64>,
    /// Classify by Rivlin's criterion instead of Bézier's
    #[arg(long)]
    rivlin: bool,
    /// Most minimal simplices
    #[arg(long, value_name = "N", default_value_t = 20_000_000)]
    max_cells: u64,
    /// Print statistics in Portuguese
    #[arg(long)]
    portuguese: bool,
    #[command(flatten)]
    pipe: Pipe,
    #[command(flatten)]
    codes: Codes,
    #[command(flatten)]
    order: Order,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Subdivision,
    Approximation,
}

fn kind(text: &str) -> Result<Kind, String> {
    match text
        .chars()
        .next()
        .map(|letter| letter.to_ascii_lowercase())
    {
        Some('s') => Ok(Kind::Subdivision),
        Some('a') => Ok(Kind::Approximation),
        _ => Err("expected a word that begins with S or A".to_owned()),
    }
}

fn length(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(length) if length > 0.0 && f64::is_finite(length) => Ok(length),
        _ => Err("expected a length above 0".to_owned()),
    }
}

pub(crate) fn run(args: &SubsimplArgs, talk: Talk) -> Result<(), Failure> {
    let start = Instant::now();
    let target = args.pipe.target()?;
    let operators = args.codes.operators();
    let (name, solid) = read_input(&args.pipe.input, |bytes| sectors::read(bytes, operators))?;
    let collect = match args.kind {
        _ if args.statistics => Collect::Nothing,
        Kind::Subdivision => Collect::Tree,
        Kind::Approximation => Collect::Faces,
    };
    let solid = solid.value;
    let sector_solid = SectorSolid::new(&solid);
    let mut outcomes = Vec::with_capacity(sector_solid.groups.len());
    for group in &sector_solid.groups {
        let rule = rule(args, group)?;
        let outcome = subdivide(&sector_solid.formula, &group.roots, &rule, collect);
        outcomes.push(outcome.map_err(|error| Failure::from(error).of_input(&name))?);
    }
    output::to_target(&target, |mut out| {
        let order = args.order.bytes();
        match collect {
            Collect::Nothing => {
                let language = if args.portuguese {
                    Language::Portuguese
                } else {
                    Language::English
                };
                out.write_all(statistics(&total(&outcomes), language).as_bytes())?;
            }
            Collect::Faces => {
                let faces = sector_solid.groups.iter().zip(&outcomes);
                let faces = faces.flat_map(|(group, outcome)| faces_of(&solid, group, outcome));
                approximation::write(faces, order, &mut out)?;
            }
            Collect::Tree => {
                let trees = sector_solid.groups.iter().zip(outcomes);
                let trees = trees
                    .flat_map(|(group, outcome)| group.vertices.iter().copied().zip(outcome.trees));
                let trees: Vec<Subdivision> = trees
                    .map(|(vertices, nodes)| Subdivision {
                        vertices,
                        nodes: nodes.into_iter().map(|node| front(&solid, node)).collect(),
                    })
                    .collect();
                subdivision::write(&trees, operators, order, &mut out)?;
            }
        }
        Ok(())
    })?;
    let word = if args.portuguese { "tempo" } else { "time" };
    talk.say(&format!("{word}: {:.3} s", start.elapsed().as_secs_f64()));
    Ok(())
}

/// The levels of a group: -T decides before -N (A.3.2).
fn rule(args: &SubsimplArgs, group: &Group) -> Result<SectorRule, Failure> {
    let levels = match args.tolerance {
        None => args.levels,
        Some(tolerance) => {
            // Three levels halve the longest edge.
            let halvings = (group.longest_edge() / tolerance).log2().ceil().max(0.0);
            let deepest = f64::from(subdiv::MAX_LEVEL);
            if 3.0 * halvings > deepest {
                return Err(Failure::Usage(format!(
                    "-T {tolerance}: {} levels would be needed, the deepest is {deepest}",
                    3.0 * halvings
                )));
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "checked to lie in 0 ..= MAX_LEVEL"
            )]
            let levels = (3.0 * halvings) as u8;
            levels
        }
    };
    if args.linear_levels > levels {
        return Err(Failure::Usage(format!(
            "-M {} is above the number of levels, {levels}",
            args.linear_levels
        )));
    }
    Ok(SectorRule {
        levels,
        linear_levels: args.linear_levels,
        max_primitives: args.max_primitives,
        criterion: if args.rivlin {
            Criterion::Rivlin
        } else {
            Criterion::Bezier
        },
        max_cells: args.max_cells,
    })
}

/// The triangles of a group with the thesis' materials.
fn faces_of<'a>(
    solid: &'a Sectors,
    group: &'a Group,
    outcome: &'a SectorOutcome,
) -> impl Iterator<Item = Face> + 'a {
    let primitives = solid.sectors.first().map(|s| s.primitives.as_slice());
    let primitives = primitives.unwrap_or_default();
    outcome.faces.triangles.iter().map(move |triangle| {
        let own = primitives.get(triangle.material.0 as usize);
        Face {
            material: own.map_or(HYBRID, |p| p.material),
            corners: triangle.vertices.map(|v| {
                let unit = outcome.faces.positions[v as usize];
                group.to_model(unit).to_array()
            }),
        }
    })
}

/// A node with the names, materials and senses of the file.
fn front(solid: &Sectors, node: SectorNode) -> Node {
    let (formula, primitives) = match node {
        SectorNode::Full => return Node::Full,
        SectorNode::Empty => return Node::Empty,
        SectorNode::Mixed => return Node::Mixed,
        SectorNode::Front {
            formula,
            primitives,
        } => (formula, primitives),
    };
    let listed = solid.sectors.first().map(|s| s.primitives.as_slice());
    let listed = listed.unwrap_or_default();
    let constant = |all: bool| SectorPrimitive {
        name: -1,
        material: 0,
        degree: 0,
        coefficients: vec![if all { -1.0 } else { 1.0 }],
    };
    Node::Front(Tree::from_formula(
        &formula,
        |literal| {
            let found = primitives.binary_search_by_key(&literal.primitive, |p| p.0);
            let own = listed.get(literal.material.0 as usize);
            let (Ok(at), Some(own)) = (found, own) else {
                return constant(false);
            };
            let (_, degree, coefficients) = &primitives[at];
            let sign = match literal.sense {
                Sense::Inside => 1.0,
                Sense::Outside => -1.0,
            };
            SectorPrimitive {
                name: own.name,
                material: own.material,
                degree: *degree,
                coefficients: coefficients.iter().map(|c| sign * c).collect(),
            }
        },
        constant,
    ))
}

/// The counts of all groups, level by level.
fn total(outcomes: &[SectorOutcome]) -> Vec<LevelCount> {
    let mut sum: Vec<LevelCount> = Vec::new();
    for outcome in outcomes {
        sum.resize(sum.len().max(outcome.levels.len()), LevelCount::default());
        for (sum, count) in sum.iter_mut().zip(&outcome.levels) {
            sum.add(count);
        }
    }
    sum
}
