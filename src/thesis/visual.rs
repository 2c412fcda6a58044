//! VISUAL: a picture of linear approximations (thesis A.4). Where the thesis has buttons, there
//! are options; where it has a window, there is a PNG file.

use super::pipe::read_input;
use crate::failure::Failure;
use crate::input::Input;
use crate::output;
use crate::run::{Target, check_targets};
use crate::values::PictureSize;
use clap::Args;
use glam::DVec3;
use io::thesis::Error;
use io::thesis::approximation::{self, Face};
use io::thesis::colors::{self, Colors};
use io::thesis::display::{Display, Mode};
use io::thesis::projection::{self, Projection};
use std::path::{Path, PathBuf};

/// What VISUAL asks for.
#[derive(Args, Debug)]
pub(crate) struct VisualArgs {
    /// The linear approximations to draw, one over the other; `-` is standard input
    #[arg(value_name = "IN", default_value = "-")]
    inputs: Vec<PathBuf>,
    /// The PNG picture to write; `-` is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    output: PathBuf,
    /// Fill the faces, with hidden parts removed, instead of drawing their edges
    #[arg(long)]
    solid: bool,
    /// Fill them with the table's colours as they are, without shades
    #[arg(long, requires = "solid")]
    flat: bool,
    /// Draw the axes: x red, y green, z blue
    #[arg(long)]
    axes: bool,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", default_value = "800x800")]
    size: PictureSize,
    /// The projective system [default: sisproj.dat here or in the home folder, else one that shows
    /// everything]
    #[arg(long, value_name = "FILE")]
    projection: Option<PathBuf>,
    /// The table of colours [default: tabcor.dat here or in the home folder, else a hue for each
    /// material on black]
    #[arg(long, value_name = "FILE")]
    colors: Option<PathBuf>,
}

pub(crate) fn run(args: VisualArgs) -> Result<(), Failure> {
    let target = Target::new(args.output);
    for path in &args.inputs {
        check_targets(&Input::new(path.clone()), &[&target])?;
    }
    let mut pictures = Vec::with_capacity(args.inputs.len());
    for path in &args.inputs {
        pictures.push(read_input(path, approximation::read)?.1.value);
    }
    let system = settings(args.projection, "sisproj.dat", projection::read)?;
    let system = system.unwrap_or_else(|| everything(&pictures));
    let table = settings(args.colors, "tabcor.dat", colors::read)?;
    let table: Colors = table.unwrap_or_default();
    let mode = match (args.solid, args.flat) {
        (false, _) => Mode::Wireframe,
        (true, false) => Mode::Shaded,
        (true, true) => Mode::Flat,
    };
    output::to_target(&target, |mut out| {
        let (width, height) = (args.size.width.get(), args.size.height.get());
        let mut display = Display::new(width, height, &system, &table)?;
        for faces in &pictures {
            display.draw(faces, mode, &table);
        }
        if args.axes {
            let [x0, y0, x1, y1] = system.window;
            display.draw_axes(0.5 * (x1 - x0).min(y1 - y0));
        }
        display.write_png(&mut out)
    })
}

/// A settings file that was named, or one of this name here or in the home folder.
fn settings<T>(
    named: Option<PathBuf>,
    name: &str,
    read: impl FnOnce(&str) -> Result<T, Error>,
) -> Result<Option<T>, Failure> {
    let home = std::env::home_dir().map(|home| home.join(name));
    let usual = [Some(PathBuf::from(name)), home].into_iter().flatten();
    let found = named.or_else(|| usual.into_iter().find(|path| path.is_file()));
    let Some(path) = found else { return Ok(None) };
    text(&path, read).map(Some)
}

fn text<T>(path: &Path, read: impl FnOnce(&str) -> Result<T, Error>) -> Result<T, Failure> {
    let bytes = Input::File(path.to_owned()).bytes()?;
    let text = String::from_utf8_lossy(&bytes);
    read(&text).map_err(|error| Failure::BadInput(format!("{}: {error}", path.display())))
}

/// From the right, the front and above, with everything in the window.
fn everything(pictures: &[Vec<Face>]) -> Projection {
    let (mut min, mut max) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let corners = pictures.iter().flatten().flat_map(|face| face.corners);
    for corner in corners.map(DVec3::from) {
        min = min.min(corner);
        max = max.max(corner);
    }
    if !min.is_finite() {
        (min, max) = (DVec3::NEG_ONE, DVec3::ONE);
    }
    let radius = (0.5 * (max - min).length()).max(f64::MIN_POSITIVE);
    let reach = 1.1 * radius;
    Projection {
        reference: 0.5 * (min + max),
        direction: DVec3::new(-1.0, 1.5, -1.0),
        distance: 4.0 * radius,
        window: [-reach, -reach, reach, reach],
    }
}
