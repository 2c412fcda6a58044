//! `csg2brep`: constructive solid geometry to watertight meshes. See `csg2brep --help`.
//!
//! [`args`] is what was typed, [`run`] what it means, [`pipeline`] the stages; everything that is
//! said goes through [`talk`], every failure through [`failure`].

mod args;
mod check;
mod convert;
mod excerpt;
mod failure;
mod folder;
mod fonts;
mod info;
mod input;
mod loose;
mod memory;
mod mesh_file;
mod output;
mod pipeline;
mod progress;
mod properties;
mod report;
mod run;
mod schema;
mod shell;
mod streams;
mod summary;
mod talk;
mod thesis;
mod true_surfaces;
mod values;
mod view;

use args::{Cli, Command, SchemaOf};
use clap::Parser as _;
use failure::Failure;
use report::Report;
use run::{Conversion, Target};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use talk::Talk;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let talk = Talk::new(cli.talk);
    progress::watch_interrupts();
    // A panic is this program's fault; the message has been printed, files are whole or absent.
    let outcome = catch_unwind(AssertUnwindSafe(|| dispatch(cli, talk)));
    match outcome {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(failure)) => {
            talk.fail(&failure);
            failure.exit_code()
        }
        Err(_) => {
            let text = "the program stopped at the place above".to_owned();
            let failure = Failure::Bug(text);
            talk.fail(&failure);
            failure.exit_code()
        }
    }
}

fn dispatch(cli: Cli, talk: Talk) -> Result<(), Failure> {
    match cli.command {
        None => convert::run(&Conversion::new(cli.convert)?, talk),
        Some(Command::Convert(args)) => convert::run(&Conversion::new(args)?, talk),
        Some(Command::View(args)) => view::run(args, talk),
        Some(Command::Info(args)) => info::run(args, talk),
        Some(Command::Properties(args)) => properties::run(args, talk),
        Some(Command::Thesis(command)) => thesis::run(command, talk),
        Some(Command::Completions { shell }) => shell::completions(shell),
        Some(Command::Man) => shell::manual(),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::ReportSchema { of }) => report_schema(of),
    }
}

fn report_schema(of: SchemaOf) -> Result<(), Failure> {
    let schema = match of {
        SchemaOf::Convert => schema::of::<Report>(),
        SchemaOf::Check => schema::of::<check::CheckReport>(),
        SchemaOf::Properties => schema::of::<properties::PropertiesReport>(),
    };
    let schema = schema.map_err(|error| Failure::Bug(error.to_string()))?;
    output::write_bytes(&Target::Stdout, schema.as_bytes())
}
