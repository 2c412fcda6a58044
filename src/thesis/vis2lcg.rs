//! VIS2LCG: a linear approximation for LCGRENDERER (thesis A.5).

use super::pipe::{Order, Pipe, read_input};
use crate::failure::Failure;
use crate::output;
use crate::run::Target;
use clap::Args;
use io::thesis::approximation;
use io::thesis::wireframe::{self, Wireframe};

/// Options of VIS2LCG.
#[derive(Args, Debug)]
pub(crate) struct Vis2LcgArgs {
    #[command(flatten)]
    pipe: Pipe,
    #[command(flatten)]
    order: Order,
}

pub(crate) fn run(args: Vis2LcgArgs) -> Result<(), Failure> {
    let (_, faces) = read_input(&args.pipe.input, approximation::read)?;
    let order = args.order.bytes();
    output::to_target(&Target::new(args.pipe.output), |mut out| {
        let mesh = Wireframe::from_faces(&faces.value)?;
        Ok(wireframe::write(&mesh, order, &mut out)?)
    })
}
