//! What shells and manual page readers want to know about the command line.

use crate::args::Cli;
use crate::failure::Failure;
use crate::output;
use crate::run::Target;
use clap::CommandFactory as _;
use clap_complete::Shell;

const NAME: &str = "csg2brep";

/// Prints the completion script of a shell.
pub(crate) fn completions(shell: Shell) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), NAME, &mut script);
    output::write_bytes(&Target::Stdout, &script)
}

/// Prints the manual page, in troff.
pub(crate) fn manual() -> Result<(), Failure> {
    let mut page = Vec::new();
    clap_mangen::Man::new(Cli::command())
        .render(&mut page)
        .map_err(|cause| Failure::writing("<memory>", cause))?;
    output::write_bytes(&Target::Stdout, &page)
}
