//! The boundary of functions that are no polynomials (thesis 6.3.5), as a linear approximation for
//! the thesis' other programs.

use super::pipe::Order;
use crate::failure::Failure;
use crate::output;
use crate::run::{Target, check_folder, clip_box};
use crate::talk::Talk;
use clap::Args;
use csg::{Aabb, Domain, Formula, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use io::thesis::approximation::{self, Face};
use std::path::PathBuf;
use subdiv::functions::{Bound, Expression, subdivide};

/// Functions and where to look at them.
#[derive(Args, Debug)]
pub(crate) struct ImplicitArgs {
    /// The solid is where all of these are negative: x, y, z, numbers, pi, + - * / ^, sqrt, sin,
    /// cos, exp, as in "sin(x)*cos(y) + sin(y)*cos(z) + sin(z)*cos(x)"; one that begins with - goes
    /// into parentheses
    #[arg(value_name = "FUNCTION", required = true)]
    functions: Vec<String>,
    /// Do not intersect the solid with the box
    #[arg(short = 'L', short_alias = 'l')]
    unlimited: bool,
    /// The box to subdivide [default: -5 to 5]
    #[arg(
        short = 'B',
        short_alias = 'b',
        num_args = 6,
        allow_negative_numbers = true,
        value_names = ["XMIN", "YMIN", "ZMIN", "XMAX", "YMAX", "ZMAX"]
    )]
    bounds: Option<Vec<f64>>,
    /// Bisections of the box' six simplices
    #[arg(
        short = 'N',
        short_alias = 'n',
        value_name = "N",
        default_value_t = 15,
        value_parser = clap::value_parser!(u8).range(0..=24)
    )]
    levels: u8,
    /// The file to write; `-` is standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    #[command(flatten)]
    order: Order,
}

pub(crate) fn run(args: ImplicitArgs, talk: Talk) -> Result<(), Failure> {
    let bounds = match args.bounds {
        Some(numbers) => clip_box(&numbers)?,
        None => Aabb {
            min: DVec3::splat(-5.0),
            max: DVec3::splat(5.0),
        },
    };
    let target = Target::new(args.output);
    check_folder(&target)?;
    let mut functions = Vec::with_capacity(args.functions.len() + 6);
    for text in &args.functions {
        let function = io::read::function(text);
        let wrong = |error| Failure::BadInput(format!("{text:?}: {error}"));
        functions.push(function.map_err(wrong)?);
    }
    if !args.unlimited {
        functions.extend(walls(&bounds));
    }
    let literals = (0..functions.len()).map(|at| {
        FormulaNode::Literal(Literal {
            primitive: PrimitiveId(u32::try_from(at).unwrap_or(u32::MAX)),
            sense: Sense::Inside,
            material: MaterialId(0),
        })
    });
    let mut nodes: Vec<FormulaNode> = literals.collect();
    if let Ok(len @ 2..) = u32::try_from(nodes.len()) {
        nodes.insert(0, FormulaNode::Intersection { len });
    }
    let formula = Formula::new(nodes).ok_or_else(|| Failure::Bug("no formula".to_owned()))?;
    let domain = Domain::around(&bounds);
    let outcome = subdivide(&functions, &formula, &domain, args.levels, Bound::Slope)?;
    talk.explain(|| {
        let (all, open) = (outcome.simplices, outcome.leaves);
        format!("{all} simplices, {open} of the last level open")
    });
    let positions = &outcome.fragments.positions;
    let faces = outcome.fragments.triangles.iter().map(|triangle| Face {
        material: 1,
        corners: triangle
            .vertices
            .map(|at| positions[at as usize].to_array()),
    });
    output::to_target(&target, |mut out| {
        Ok(approximation::write(faces, args.order.bytes(), &mut out)?)
    })
}

/// Functions that are negative in the box.
fn walls(bounds: &Aabb) -> impl Iterator<Item = Expression> {
    let (min, max) = (bounds.min.to_array(), bounds.max.to_array());
    (Expression::variables().into_iter().zip(min).zip(max))
        .flat_map(|((x, min), max)| [Expression::from(min) - x.clone(), x - Expression::from(max)])
}
