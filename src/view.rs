//! `csg2brep view IN -o OUT.png`: a picture of a model, or a page to look at it from all sides.

use crate::args::ViewArgs;
use crate::convert::new_report;
use crate::failure::Failure;
use crate::output;
use crate::pipeline::{self, Boundary};
use crate::progress::Progress;
use crate::run::{Job, Target, check_targets};
use crate::summary::summary;
use crate::talk::Talk;
use crate::values::{PictureSize, Viewpoint};
use brep::Shading;
use glam::DVec3;
use io::write::page;
use io::write::picture::{self, Options, View};
use std::time::Instant;

/// Converts and draws.
pub(crate) fn run(args: ViewArgs, talk: Talk) -> Result<(), Failure> {
    let start = Instant::now();
    let target = Target::new(args.output);
    let job = Job::new(args.input, &args.model)?;
    check_targets(&job.input, &[&target])?;
    let is_page = is_page(&target);
    if is_page && args.raytrace {
        let text = "--raytrace draws pictures only: leave it out, or write a .png file";
        return Err(Failure::Usage(text.to_owned()));
    }
    let options = options(args.size, args.from);
    let page = page::Options {
        title: job.input.name(),
        toward_eye: args.from.0,
    };

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
        if is_page {
            return page::write(&boundary.brep, &shading, materials, &page, &mut out);
        }
        picture::write_shaded(&boundary.brep, &shading, materials, &options, &mut out)
    })?;
    drop(progress);
    report.total_seconds = start.elapsed().as_secs_f64();
    talk.say(&summary(&report, &[target.name()]));
    Ok(())
}

/// Whether the file's name asks for a page.
fn is_page(target: &Target) -> bool {
    let Target::File(path) = target else {
        return false;
    };
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    matches!(extension.as_deref(), Some("html" | "htm"))
}

fn options(size: PictureSize, Viewpoint(from): Viewpoint) -> Options {
    Options {
        width: size.width.get(),
        height: size.height.get(),
        view: view(from),
        ..Options::default()
    }
}

/// The view from a direction; those along axes are exact.
fn view(from: DVec3) -> View {
    let named = [
        (DVec3::new(1.0, -1.0, 1.0), View::Isometric),
        (DVec3::NEG_Y, View::Front),
        (DVec3::Y, View::Back),
        (DVec3::NEG_X, View::Left),
        (DVec3::X, View::Right),
        (DVec3::Z, View::Top),
        (DVec3::NEG_Z, View::Bottom),
    ];
    let found = named.into_iter().find(|(direction, _)| *direction == from);
    found.map_or_else(
        || View::Direction {
            azimuth_deg: from.y.atan2(from.x).to_degrees(),
            elevation_deg: from.z.atan2(from.truncate().length()).to_degrees(),
        },
        |(_, view)| view,
    )
}
