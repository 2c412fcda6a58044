//! VIS2LCG: a linear approximation for LCGRENDERER (thesis A.5).

use super::pipe::{Order, Pipe, read_input};
use crate::failure::Failure;
use crate::output;
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

pub(crate) fn run(args: &Vis2LcgArgs) -> Result<(), Failure> {
    let target = args.pipe.target()?;
    let (_, faces) = read_input(&args.pipe.input, approximation::read)?;
    let order = args.order.bytes();
    output::to_target(&target, |mut out| {
        let mesh = Wireframe::from_faces(&faces.value)?;
        Ok(wireframe::write(&mesh, order, &mut out)?)
    })
}
