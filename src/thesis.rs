//! `csg2brep thesis`: the programs and experiments of da Silva's thesis.

mod compare;

use crate::failure::Failure;
use crate::talk::Talk;
use clap::Subcommand;

/// What to repeat.
#[derive(Subcommand, Debug)]
pub(crate) enum ThesisCommand {
    /// Count what each of its methods evaluates on a model (Tables 6.2 to 6.8)
    Compare(compare::CompareArgs),
}

/// Runs one of them.
pub(crate) fn run(command: ThesisCommand, talk: Talk) -> Result<(), Failure> {
    match command {
        ThesisCommand::Compare(args) => compare::run(args, talk),
    }
}
