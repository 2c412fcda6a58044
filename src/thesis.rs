//! `csg2brep thesis`: the programs and experiments of da Silva's thesis.

mod compare;
pub(crate) mod csg2cspg;
mod half_spaces;
mod implicit;
pub(crate) mod pipe;
mod propsimpl;
mod sector_solid;
mod statistics;
mod subsimpl;
mod vis2lcg;
mod visual;

use crate::failure::Failure;
use crate::talk::Talk;
use clap::Subcommand;

/// What to repeat.
#[derive(Subcommand, Debug)]
pub(crate) enum ThesisCommand {
    /// Count what each of its methods evaluates on a model (Tables 6.2 to 6.8)
    Compare(compare::CompareArgs),
    /// Turn a .CSG solid into half-spaces in Bézier form, .cspg (A.2)
    Csg2cspg(csg2cspg::Csg2CspgArgs),
    /// Approximate a solid bounded by functions that are no polynomials, .apl (6.3.5)
    Implicit(implicit::ImplicitArgs),
    /// Subdivide a .cspg solid into a linear approximation, .apl, or a tree (A.3)
    Subsimpl(subsimpl::SubsimplArgs),
    /// Print the area or the volume of what subsimpl wrote (A.6)
    Propsimpl(propsimpl::PropsimplArgs),
    /// Draw linear approximations (A.4)
    Visual(visual::VisualArgs),
    /// Turn a linear approximation into LCGRENDERER's .wfr (A.5)
    Vis2lcg(vis2lcg::Vis2LcgArgs),
}

/// Runs one of them.
pub(crate) fn run(command: ThesisCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        ThesisCommand::Compare(args) => compare::run(args, talk),
        ThesisCommand::Csg2cspg(args) => csg2cspg::run(args, talk),
        ThesisCommand::Implicit(args) => implicit::run(args, talk),
        ThesisCommand::Subsimpl(args) => subsimpl::run(&args, talk),
        ThesisCommand::Propsimpl(args) => propsimpl::run(&args, talk),
        ThesisCommand::Visual(args) => visual::run(args),
        ThesisCommand::Vis2lcg(args) => vis2lcg::run(&args),
    }
}
