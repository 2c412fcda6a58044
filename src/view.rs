//! `csg2brep view IN -o OUT.png`: a picture of a model.

use crate::args::{Side, ViewArgs};
use crate::convert::new_report;
use crate::failure::Failure;
use crate::output;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::run::{Job, Target, check_targets};
use crate::summary::summary;
use crate::talk::Talk;
use crate::values::PictureSize;
use brep::Shading;
use io::write::picture::{self, Options, View};
use std::time::Instant;

/// Converts and draws.
pub(crate) fn run(args: ViewArgs, talk: Talk) -> Result<(), Failure> {
    let start = Instant::now();
    let target = Target::new(args.output);
    let job = Job::new(args.input, &args.model)?;
    check_targets(&job.input, &[&target])?;
    let options = options(args.size, args.from);

    let mut report = new_report(&job);
    let progress = Progress::new(talk.is_quiet());
    let boundary = pipeline::run(&job, None, talk, &progress, &mut report)?;
    progress.begin("drawing");
    if args.raytrace && boundary.is_mesh {
        let text = "the input is a mesh, which has lost its surfaces: draw it without --raytrace";
        return Err(Failure::BadInput(text.to_owned()));
    }
    output::to_target(&target, |mut out| {
        if args.raytrace {
            let Boundary { brep, solid, .. } = &boundary;
            return picture::write_traced(brep, solid, &options, &mut out);
        }
        let shading = Shading::on_surfaces(&boundary.brep, &boundary.solid);
        let materials = &boundary.solid.materials;
        picture::write_shaded(&boundary.brep, &shading, materials, &options, &mut out)
    })?;
    drop(progress);
    report.total_seconds = start.elapsed().as_secs_f64();
    talk.say(&summary(&report, &[target.name()]));
    Ok(())
}

fn options(size: PictureSize, from: Side) -> Options {
    Options {
        width: size.width.get(),
        height: size.height.get(),
        view: match from {
            Side::Iso => View::Isometric,
            Side::Front => View::Front,
            Side::Back => View::Back,
            Side::Left => View::Left,
            Side::Right => View::Right,
            Side::Top => View::Top,
            Side::Bottom => View::Bottom,
        },
        ..Options::default()
    }
}
