//! Arguments of plane figures and of the nodes that extrude them, with OpenSCAD's defaults.

use super::super::arguments::Arguments;
use super::super::complaints::{Complaints, Reported};
use super::super::shapes::radius;
use super::{Offset, Region};
use glam::DVec2;
use std::f64::consts::TAU;

/// The figures that have no children.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in super::super) enum FigureLeaf {
    /// `square(size, center)`.
    Square,
    /// `circle(r)`.
    Circle,
    /// `polygon(points, paths)`.
    Polygon,
}

/// Larger figures overflow further on.
pub(super) const MAX_SIZE: f64 = 1e50;

/// Vertices of one polygon, at most; its pockets may take quadratic time.
const MAX_VERTICES: usize = 50_000;

/// Reads a figure; `None` if it has no area, after a warning.
///
/// `sides`: the number of sides that a circle is meant to have, unless it is round.
pub(in super::super) fn leaf(
    leaf: FigureLeaf,
    sides: Option<u32>,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<Region>, Reported> {
    let paths = match leaf {
        FigureLeaf::Square => square(arguments, complaints)?,
        FigureLeaf::Polygon => polygon(arguments, complaints)?,
        FigureLeaf::Circle => {
            let radius = radius(arguments, "r", "d", complaints)?.unwrap_or(1.0);
            if !(radius > 0.0 && radius.is_finite()) {
                dropped(
                    arguments,
                    &format!("a circle of radius {radius}"),
                    complaints,
                );
                return Ok(None);
            }
            match sides {
                None => {
                    check_size(radius, arguments, complaints)?;
                    return Ok(Some(Region::disc(radius)));
                }
                Some(sides) => vec![regular(sides, radius)],
            }
        }
    };
    let Some(paths) = non_empty(paths) else {
        return Ok(None);
    };
    let size = paths.iter().flatten().map(|p| p.abs().max_element());
    check_size(size.fold(0.0, f64::max), arguments, complaints)?;
    let region = Region::polygon(&paths);
    if region.is_none() {
        dropped(arguments, &format!("this {}", arguments.node()), complaints);
    }
    Ok(region)
}

fn non_empty(paths: Vec<Vec<DVec2>>) -> Option<Vec<Vec<DVec2>>> {
    (!paths.is_empty()).then_some(paths)
}

fn check_size(
    size: f64,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<(), Reported> {
    if size <= MAX_SIZE {
        return Ok(());
    }
    Err(complaints.error(
        arguments.name,
        format!("{size:e} is too large a size to compute with"),
        format!("scale the model; sizes up to {MAX_SIZE} are possible"),
    ))
}

/// Leaves a figure out as OpenSCAD does.
fn dropped(arguments: &Arguments<'_>, what: &str, complaints: &mut Complaints<'_>) {
    let message = format!("{what} has no area; it is left out, as in OpenSCAD");
    complaints.warn(arguments.name, message, None);
}

/// OpenSCAD's circle: the first vertex is on the x axis.
fn regular(sides: u32, radius: f64) -> Vec<DVec2> {
    let vertex = |side: u32| {
        let angle = f64::from(side) * TAU / f64::from(sides);
        DVec2::from_angle(angle) * radius
    };
    (0..sides).map(vertex).collect()
}

fn square(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Vec<Vec<DVec2>>, Reported> {
    let size = if arguments.is_number("size") {
        let size = arguments.number("size", complaints)?;
        size.map_or(DVec2::ONE, |size| DVec2::splat(size.value))
    } else {
        let size = arguments.numbers("size", 2, 2, complaints)?;
        size.map_or(DVec2::ONE, |size| DVec2::from_slice(&size.value))
    };
    if !(size.is_finite() && size.min_element() > 0.0) {
        let DVec2 { x, y } = size;
        dropped(
            arguments,
            &format!("a square of size [{x}, {y}]"),
            complaints,
        );
        return Ok(Vec::new());
    }
    let min = if arguments.flag("center", complaints)? {
        -0.5 * size
    } else {
        DVec2::ZERO
    };
    let max = min + size;
    let (a, b) = (DVec2::new(max.x, min.y), DVec2::new(min.x, max.y));
    Ok(vec![vec![min, a, max, b]])
}

fn polygon(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Vec<Vec<DVec2>>, Reported> {
    let Some(points) = arguments.rows("points", 2..=3, complaints)? else {
        dropped(arguments, "a polygon without points", complaints);
        return Ok(Vec::new());
    };
    let vertices: Vec<DVec2> = points.value.iter().map(|p| DVec2::from_slice(p)).collect();
    if let Some(p) = vertices.iter().find(|p| !p.is_finite()) {
        let message = format!(
            "a polygon with a vertex at [{}, {}] is no polygon; it is left out",
            p.x, p.y
        );
        complaints.warn(points.at, message, None);
        return Ok(Vec::new());
    }
    let paths = match arguments.rows("paths", 0..=usize::MAX, complaints)? {
        Some(paths) if !paths.value.is_empty() => paths,
        _ => {
            check_count(vertices.len(), arguments, complaints)?;
            return Ok(vec![vertices]);
        }
    };
    check_count(
        paths.value.iter().map(Vec::len).sum(),
        arguments,
        complaints,
    )?;
    let resolve = |index: &f64| {
        let found = (index.fract() == 0.0 && *index >= 0.0).then(|| {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number; too large ones saturate and are not found"
            )]
            vertices.get(*index as usize).copied()
        });
        found.flatten().ok_or(*index)
    };
    let resolved: Result<Vec<Vec<DVec2>>, f64> = paths
        .value
        .iter()
        .map(|path| path.iter().map(resolve).collect())
        .collect();
    resolved.map_err(|index| {
        complaints.error(
            paths.at,
            format!(
                "a path names point {index}, but the points are 0 to {}",
                vertices.len().saturating_sub(1)
            ),
            "list indices of `points`, counted from 0".to_owned(),
        )
    })
}

fn check_count(
    count: usize,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<(), Reported> {
    if count <= MAX_VERTICES {
        return Ok(());
    }
    Err(complaints.error(
        arguments.name,
        format!("a polygon of {count} vertices is too large"),
        format!("split it, or simplify it to at most {MAX_VERTICES}"),
    ))
}

/// A turn along the way.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in super::super) struct Twist {
    /// By how much the last section is turned, clockwise from above, in degrees.
    pub(super) degrees: f64,
    /// Layers of plane facets that stand for it.
    pub(super) slices: u32,
}

/// Layers of one extrusion, at most.
const MAX_SLICES: f64 = 2000.0;

/// Reads `twist` and `slices`.
fn twist(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<Twist>, Reported> {
    let degrees = arguments
        .number("twist", complaints)?
        .map_or(0.0, |t| t.value);
    if degrees == 0.0 {
        return Ok(None);
    }
    let given = arguments.number("slices", complaints)?.map(|s| s.value);
    let sides = arguments.fragments();
    // 30 layers a turn are OpenSCAD's at $fa = 12.
    let sides = if sides > 0.0 { sides } else { 30.0 };
    let slices = given
        .unwrap_or(sides * degrees.abs() / 360.0)
        .ceil()
        .max(1.0);
    if !(degrees.is_finite() && slices <= MAX_SLICES) {
        return Err(complaints.error(
            arguments.name,
            format!("a twist of {degrees}° in {slices} slices is too much"),
            format!("use at most {MAX_SLICES} slices"),
        ));
    }
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 1 and the most slices"
    )]
    let slices = slices as u32;
    Ok(Some(Twist { degrees, slices }))
}

/// Reads `offset(r)` or `offset(delta, chamfer)`; `None` if nothing is to be moved.
pub(in super::super) fn offset(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<Offset>, Reported> {
    let chamfer = arguments.flag("chamfer", complaints)?;
    let delta = arguments.number("delta", complaints)?;
    let r = arguments.number("r", complaints)?;
    let given = delta.or(r);
    if let Some(given) = given.filter(|g| g.value.is_nan() || g.value.abs() > MAX_SIZE) {
        let message = format!("an outline cannot be moved by {}", given.value);
        return Err(complaints.error(given.at, message, None));
    }
    Ok(match (delta, r) {
        (Some(delta), _) => Some(Offset::Straight {
            delta: delta.value,
            chamfer,
        }),
        (None, Some(r)) => Some(Offset::Round(r.value)),
        (None, None) => None,
    })
}

/// What makes a solid of a figure.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(in super::super) enum Extrusion {
    /// Along z.
    Linear {
        z0: f64,
        z1: f64,
        /// Scale at z1; it is 1 at z0 and linear between.
        scale: DVec2,
        /// How far a point moves in x and y for each step in z.
        lean: DVec2,
        /// Turned by layers, if at all.
        twist: Option<Twist>,
    },
    /// About the z axis, y becoming z.
    Revolved {
        /// Where the sweep begins and how far it goes, positive and at most 360, in degrees.
        start: f64,
        angle: f64,
        /// The plane pieces that the author wants instead of a round sweep.
        steps: Option<u32>,
    },
    /// To nothing; a warning was given.
    Nothing,
}

/// Reads `linear_extrude`, or `rotate_extrude` if `revolved`.
///
/// `sides`: the number of sides that a full turn is meant to have, unless it is round.
pub(in super::super) fn extrusion(
    revolved: bool,
    sides: Option<u32>,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Extrusion, Reported> {
    if arguments.is_string("file") {
        let message = format!("`{}` of a file is not supported", arguments.node());
        let remedy = "write the file's outline as a polygon, its child".to_owned();
        return Err(complaints.error(arguments.name, message, remedy));
    }
    if revolved {
        turned(sides, arguments, complaints)
    } else {
        linear(arguments, complaints)
    }
}

fn linear(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Extrusion, Reported> {
    let given = arguments.number("height", complaints)?.map(|h| h.value);
    let direction = arguments.vector("v", complaints)?.map(|v| v.value);
    let along = match (given, direction) {
        (height, None) => glam::DVec3::Z * height.unwrap_or(100.0),
        (None, Some(v)) => glam::DVec3::from(v),
        (Some(height), Some(v)) => glam::DVec3::from(v).normalize_or_zero() * height,
    };
    let scale = if arguments.is_number("scale") {
        let scale = arguments.number("scale", complaints)?;
        scale.map_or(DVec2::ONE, |s| DVec2::splat(s.value))
    } else {
        let scale = arguments.numbers("scale", 2, 3, complaints)?;
        scale.map_or(DVec2::ONE, |s| DVec2::from_slice(&s.value))
    };
    let twist = twist(arguments, complaints)?;
    if !(along.is_finite() && along.z > 0.0 && scale.is_finite()) {
        let message = format!(
            "an extrusion of height {} and scale [{}, {}] has no volume; it is left out, as in OpenSCAD",
            along.z, scale.x, scale.y
        );
        complaints.warn(arguments.name, message, None);
        return Ok(Extrusion::Nothing);
    }
    check_size(
        along.length().max(scale.max_element()),
        arguments,
        complaints,
    )?;
    let scale = if scale.min_element() < 0.0 {
        let message = "a negative scale is taken as 0, as in OpenSCAD";
        complaints.warn(arguments.name, message, None);
        scale.max(DVec2::ZERO)
    } else {
        scale
    };
    let z0 = if arguments.flag("center", complaints)? {
        -0.5 * along.z
    } else {
        0.0
    };
    Ok(Extrusion::Linear {
        z0,
        z1: z0 + along.z,
        scale,
        lean: along.truncate() / along.z,
        twist,
    })
}

fn turned(
    sides: Option<u32>,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Extrusion, Reported> {
    let angle = arguments
        .number("angle", complaints)?
        .map_or(360.0, |a| a.value);
    let start = arguments.number("start", complaints)?.map(|a| a.value);
    if angle == 0.0 || start.is_some_and(|start| !start.is_finite()) {
        let message = "a sweep by this angle has no volume; it is left out, as in OpenSCAD";
        complaints.warn(arguments.name, message, None);
        return Ok(Extrusion::Nothing);
    }
    // What is no angle is a full turn in OpenSCAD.
    let is_full = angle.is_nan() || angle.abs() >= 360.0;
    let (start, angle) = match start {
        _ if is_full => (start.unwrap_or(180.0), 360.0),
        start if angle < 0.0 => (start.unwrap_or(0.0) + angle, -angle),
        start => (start.unwrap_or(0.0), angle),
    };
    let steps = sides.map(|sides| {
        let steps = (f64::from(sides) * angle / 360.0).ceil().max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and sides"
        )]
        (steps as u32)
    });
    Ok(Extrusion::Revolved {
        start,
        angle,
        steps,
    })
}
