//! `csg2brep thesis compare IN --level N`: the methods of thesis 6.2.2 and the criteria of 4.4 on
//! one model.

use crate::args::ClipArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::output;
use crate::run::Target;
use crate::summary::grouped;
use crate::talk::Talk;
use crate::thesis::pipe::DialectArgs;
use clap::Args;
use csg::Solid;
use std::path::PathBuf;
use std::time::Instant;
use subdiv::Criterion;
use subdiv::methods::{Found, Halt, Pattern, adaptive, complete, continuation};

/// Deepest level: its 100 million simplices are what complete evaluation can still look at.
const DEEPEST: i64 = 24;

/// Most primitives times simplices for which complete evaluation is run and not only counted.
const RUN_LIMIT: u64 = 1 << 30;

/// A model and a level.
#[derive(Args, Debug)]
pub(crate) struct CompareArgs {
    /// The model to read; `-` is standard input
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Bisection level of the smallest simplices; the regular methods need a multiple of 3
    #[arg(
        long,
        value_name = "N",
        default_value_t = 15,
        value_parser = clap::value_parser!(u8).range(0..=DEEPEST)
    )]
    level: u8,
    /// End where a single plane bounds the solid, as Algorithm 4.3 does. Its cells are larger, so
    /// the regular methods are not run
    #[arg(long)]
    stop_at_planes: bool,
    #[command(flatten)]
    clip: ClipArgs,
    #[command(flatten)]
    dialect: DialectArgs,
}

/// Prints the table on standard output.
pub(crate) fn run(args: CompareArgs, talk: Talk) -> Result<(), Failure> {
    let input = Input::new(args.input);
    let (solid, _) = input.solid(&args.clip, args.dialect, talk)?;
    let halt = if args.stop_at_planes {
        Halt::AtPlanes
    } else {
        Halt::Never
    };
    let table = table(&solid, &input.name(), args.level, halt);
    output::write_bytes(&Target::Stdout, table.as_bytes())
}

const HEAD: &str = "\
method           simplices   evaluations  poly. values  boundary  in vain  of MAO    seconds\n";

fn table(solid: &Solid, name: &str, level: u8, halt: Halt) -> String {
    let primitives = solid.primitives.len() as u64;
    let count = grouped(primitives);
    let mut text = format!("{name}: {count} primitives, level {level}\n{HEAD}");
    let mut optimum = Found::default();
    let criteria = [
        ("SSA Bézier", Criterion::Bezier),
        ("SSA Rivlin", Criterion::Rivlin),
        ("SSA Lipschitz", Criterion::Lipschitz),
    ];
    let mut adaptive_rows = String::new();
    for (name, criterion) in criteria {
        let start = Instant::now();
        let run = adaptive(solid, criterion, level, halt);
        let row = Row {
            name,
            simplices: Some(run.simplices),
            evaluations: run.classifications,
            values: Some(run.evaluations),
            boundary: Some(run.found.cells.len() as u64),
            in_vain: Some(run.wrongly_bisected),
            seconds: Some(start.elapsed().as_secs_f64()),
        };
        adaptive_rows += &row.line(run.found.optimal_evaluations);
        // Where bisection ends at planes, the sharpest criterion ends earliest.
        if criterion == Criterion::Rivlin {
            optimum = run.found;
        }
    }
    let best = optimum.optimal_evaluations;
    let regular = level.is_multiple_of(3) && halt == Halt::Never;
    let everything = (6 << level) * primitives;
    let run_complete = (regular && everything <= RUN_LIMIT).then(|| {
        let start = Instant::now();
        let run = complete(solid, level / 3, Pattern::Reflected);
        (run, start.elapsed().as_secs_f64())
    });
    let row = Row {
        name: "MAC",
        simplices: Some(6 << level),
        evaluations: everything,
        values: run_complete.as_ref().map(|(run, _)| run.values),
        boundary: run_complete
            .as_ref()
            .map(|(run, _)| run.found.cells.len() as u64),
        in_vain: None,
        seconds: run_complete.as_ref().map(|(_, seconds)| *seconds),
    };
    text += &row.line(best);
    let run_continuation = regular.then(|| {
        let start = Instant::now();
        let run = continuation(solid, level / 3, Pattern::Reflected, &optimum.cells);
        (run, start.elapsed().as_secs_f64())
    });
    let cells = optimum.cells.len() as u64;
    let row = Row {
        name: "MAI",
        simplices: Some(cells),
        evaluations: cells * primitives,
        values: run_continuation.as_ref().map(|(run, _)| run.values),
        boundary: run_continuation
            .as_ref()
            .map(|(run, _)| run.found.cells.len() as u64),
        in_vain: None,
        seconds: run_continuation.as_ref().map(|(_, seconds)| *seconds),
    };
    text += &row.line(best);
    let row = Row {
        name: "MAO",
        simplices: Some(cells),
        evaluations: best,
        values: None,
        boundary: Some(cells),
        in_vain: None,
        seconds: None,
    };
    text += &row.line(best);
    text + &adaptive_rows
}

struct Row<'a> {
    name: &'a str,
    simplices: Option<u64>,
    evaluations: u64,
    values: Option<u64>,
    boundary: Option<u64>,
    in_vain: Option<u64>,
    seconds: Option<f64>,
}

impl Row<'_> {
    fn line(&self, optimum: u64) -> String {
        let number = |n: Option<u64>| n.map_or("-".to_owned(), grouped);
        let ratio = if optimum == 0 {
            "-".to_owned()
        } else {
            format!("{:.2}", self.evaluations as f64 / optimum as f64)
        };
        let seconds = self.seconds.map_or("-".to_owned(), |s| format!("{s:.4}"));
        format!(
            "{:13} {:>12}  {:>12}  {:>12}  {:>8} {:>8} {ratio:>7} {seconds:>10}\n",
            self.name,
            number(self.simplices),
            grouped(self.evaluations),
            number(self.values),
            number(self.boundary),
            number(self.in_vain),
        )
    }
}
