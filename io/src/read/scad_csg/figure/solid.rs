//! From a figure and an extrusion to nodes of the model.

use super::revolve::{Sector, Turn, wedge};
use super::taper::Taper;
use super::{Curve, Extrusion, Figure, FigureId, Figures, Outline, Part, Rectangle, Region};
use csg::{Error, ModelBuilder, Node, NodeId, Shape, Transform};
use glam::{DAffine2, DVec2, DVec3};
use std::cell::RefCell;

/// Why there is no solid.
#[derive(Clone, PartialEq, Debug)]
pub(in super::super) enum Refusal {
    /// A rotated figure has points on both sides of the axis.
    AcrossTheAxis,
    /// A twisted figure crosses itself between two slices.
    Twisted,
    /// Numbers are beyond floating point.
    Numbers(Error),
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Self::Numbers(error)
    }
}

/// Convex polygons with more sides get a box, since bounds are not looked for among them.
const MOST_BOUNDING_SIDES: usize = 20;

/// Samples in each direction that tell on which side of the axis a profile lies.
const SAMPLES: u32 = 128;

/// Distance of that box from the figure, in sizes of the figure.
const MARGIN: f64 = 0.05;

/// How curves become surfaces.
enum Sweep {
    Straight { z0: f64, z1: f64 },
    Tapered(Taper),
    Turned(Turn),
    Across(Sector),
}

/// The solid that an extrusion makes of a figure; `None` if there is none.
pub(in super::super) fn extrude(
    figures: &Figures,
    figure: FigureId,
    extrusion: &Extrusion,
    builder: &mut ModelBuilder,
) -> Result<Option<NodeId>, Refusal> {
    let bounds = figures.bounds(figure);
    if !bounds.min.cmplt(bounds.max).all() {
        return Ok(None);
    }
    match *extrusion {
        Extrusion::Nothing => Ok(None),
        Extrusion::Linear {
            z0,
            z1,
            scale,
            lean,
            twist,
        } => {
            let upright = if let Some(twist) = twist {
                let loops = figures.loops(figure);
                super::twist::layers(&loops, [z0, z1], scale, &twist, builder)?
            } else if scale == DVec2::ONE {
                let sweep = Sweep::Straight { z0, z1 };
                lower(figures, figure, DAffine2::IDENTITY, &sweep, builder)?
            } else {
                let sweep = Sweep::Tapered(Taper::new(z0, z1, scale)?);
                let solid = lower(figures, figure, DAffine2::IDENTITY, &sweep, builder)?;
                let top = Rectangle {
                    min: bounds.min * scale,
                    max: bounds.max * scale,
                };
                let slab = boxed(&bounds.union(&top), z0, z1)?;
                let slab = builder.add(Node::Shape(slab));
                builder.add(Node::Intersection(vec![solid, slab]))
            };
            if lean == DVec2::ZERO {
                return Ok(Some(upright));
            }
            // Points at z0 + t move from t = 0 on.
            let shift = -lean * z0;
            let shear = Transform::from_columns(&[
                [1.0, 0.0, lean.x, shift.x],
                [0.0, 1.0, lean.y, shift.y],
                [0.0, 0.0, 1.0, 0.0],
                [0.0, 0.0, 0.0, 1.0],
            ])?;
            Ok(Some(builder.add(Node::Instance(shear, upright))))
        }
        Extrusion::Revolved {
            start,
            angle,
            steps,
        } => {
            let side = figures.side_of_axis(figure, &bounds)?;
            let (mirror, start, bounds) = match side {
                Side::Right => (DAffine2::IDENTITY, start, bounds),
                Side::Left => (
                    DAffine2::from_scale(DVec2::new(-1.0, 1.0)),
                    start + 180.0,
                    Rectangle {
                        min: DVec2::new(-bounds.max.x, bounds.min.y),
                        max: DVec2::new(-bounds.min.x, bounds.max.y),
                    },
                ),
            };
            revolve(
                figures,
                figure,
                mirror,
                &bounds,
                [start, angle],
                steps,
                builder,
            )
            .map(Some)
        }
    }
}

fn revolve(
    figures: &Figures,
    figure: FigureId,
    mirror: DAffine2,
    bounds: &Rectangle,
    [start, angle]: [f64; 2],
    steps: Option<u32>,
    builder: &mut ModelBuilder,
) -> Result<NodeId, Refusal> {
    let range = [bounds.min.y, bounds.max.y];
    let Some(steps) = steps else {
        let margin = MARGIN * (bounds.max - bounds.min.min(DVec2::ZERO)).max_element();
        let [bottom, top] = [range[0] - margin, range[1] + margin];
        let sweep = Sweep::Turned(Turn {
            range: [bottom, top],
        });
        let mut all = vec![lower(figures, figure, mirror, &sweep, builder)?];
        all.extend(wedge(start, angle, builder)?);
        let can = Shape::cylinder(bounds.max.x + margin, bottom, top)?;
        all.push(builder.add(Node::Shape(can)));
        return Ok(builder.add(Node::Intersection(all)));
    };
    let step = angle / f64::from(steps);
    let stretch = 1.0 / (0.5 * step).to_radians().cos();
    let mut sectors = Vec::new();
    for at in 0..steps {
        let from = start + f64::from(at) * step;
        let middle = DVec2::from_angle((from + 0.5 * step).to_radians());
        let sweep = Sweep::Across(Sector {
            rho: middle * stretch,
        });
        let mut all = vec![lower(figures, figure, mirror, &sweep, builder)?];
        all.extend(wedge(from, step, builder)?);
        sectors.push(builder.add(Node::Intersection(all)));
    }
    let all = builder.add(Node::Union(sectors));
    let reach = DVec2::splat(bounds.max.x);
    let around = Rectangle {
        min: -reach,
        max: reach,
    };
    let margin = MARGIN * (range[1] - range[0]).max(bounds.max.x);
    let around = boxed(&around, range[0] - margin, range[1] + margin)?;
    let around = builder.add(Node::Shape(around));
    Ok(builder.add(Node::Intersection(vec![all, around])))
}

/// A box around a rectangle, wider by a margin, between two heights.
fn boxed(around: &Rectangle, z0: f64, z1: f64) -> Result<Shape, Error> {
    let margin = DVec2::splat(MARGIN * (around.max - around.min).max_element());
    let (min, max) = (around.min - margin, around.max + margin);
    Shape::block(min.extend(z0), max.extend(z1))
}

/// Lowers a figure, each region by itself.
fn lower(
    figures: &Figures,
    figure: FigureId,
    place: DAffine2,
    sweep: &Sweep,
    builder: &mut ModelBuilder,
) -> Result<NodeId, Error> {
    let builder = RefCell::new(builder);
    let node = figures.fold(
        figure,
        place,
        |region, at| sweep.region(region, at, &mut builder.borrow_mut()),
        |figure, all| {
            builder.borrow_mut().add(match figure {
                Figure::Intersection(_) => Node::Intersection(all),
                Figure::Difference(_) => Node::Difference(all),
                _ => Node::Union(all),
            })
        },
    )?;
    Ok(match node {
        Some(node) => node,
        None => builder.borrow_mut().add(Node::Union(Vec::new())),
    })
}

impl Sweep {
    /// A region, extruded; unbounded along z if tapered.
    fn region(
        &self,
        region: &Region,
        at: &DAffine2,
        builder: &mut ModelBuilder,
    ) -> Result<NodeId, Error> {
        let Self::Straight { z0, z1 } = *self else {
            return self.formula(&region.parts, at, builder);
        };
        match &region.outline {
            Outline::Circle(radius) => {
                let cylinder = builder.add(Node::Shape(Shape::cylinder(*radius, z0, z1)?));
                if *at == DAffine2::IDENTITY {
                    return Ok(cylinder);
                }
                let (x, y, t) = (at.matrix2.x_axis, at.matrix2.y_axis, at.translation);
                let transform = Transform::from_columns(&[
                    [x.x, y.x, 0.0, t.x],
                    [x.y, y.y, 0.0, t.y],
                    [0.0, 0.0, 1.0, 0.0],
                    [0.0, 0.0, 0.0, 1.0],
                ])?;
                Ok(builder.add(Node::Instance(transform, cylinder)))
            }
            Outline::Corners {
                at: corners,
                convex,
                ..
            } => {
                let mut all = Vec::new();
                if *convex && corners.len() <= MOST_BOUNDING_SIDES {
                    for part in &region.parts {
                        if let Part::Side(curve) = part {
                            let side = straight(&curve.moved(at))?;
                            all.push(builder.add(Node::Shape(side)));
                        }
                    }
                    let planes = [(DVec3::NEG_Z, -z0), (DVec3::Z, z1)];
                    for (normal, offset) in planes {
                        let plane = Shape::half_space(normal, offset)?;
                        all.push(builder.add(Node::Shape(plane)));
                    }
                } else {
                    all.push(self.formula(&region.parts, at, builder)?);
                    let around = boxed(&region.bounds(at), z0, z1)?;
                    all.push(builder.add(Node::Shape(around)));
                }
                Ok(builder.add(Node::Intersection(all)))
            }
        }
    }

    fn formula(
        &self,
        parts: &[Part],
        at: &DAffine2,
        builder: &mut ModelBuilder,
    ) -> Result<NodeId, Error> {
        let mut open: Vec<(bool, Vec<NodeId>)> = vec![(true, Vec::new())];
        for part in parts {
            let node = match part {
                Part::Open { union } => {
                    open.push((*union, Vec::new()));
                    continue;
                }
                Part::Side(curve) => self.side(&curve.moved(at), builder)?,
                Part::Close => match open.pop() {
                    Some((true, all)) => builder.add(Node::Union(all)),
                    Some((false, all)) => builder.add(Node::Intersection(all)),
                    None => continue,
                },
            };
            if let Some((_, all)) = open.last_mut() {
                all.push(node);
            }
        }
        let all = open.pop().map(|(_, all)| all).unwrap_or_default();
        Ok(builder.add(Node::Union(all)))
    }

    fn side(&self, curve: &Curve, builder: &mut ModelBuilder) -> Result<NodeId, Error> {
        let shape = match self {
            Self::Turned(turn) => return turn.side(curve, builder),
            Self::Straight { .. } => straight(curve)?,
            Self::Tapered(taper) => taper.side(curve)?,
            Self::Across(sector) => sector.side(curve)?,
        };
        Ok(builder.add(Node::Shape(shape)))
    }
}

/// The plane through a line along z.
fn straight(line: &Curve) -> Result<Shape, Error> {
    let [_, _, _, x, y, one] = line.0;
    Shape::half_space(DVec3::new(x, y, 0.0), -one)
}

/// Where a profile lies.
enum Side {
    Right,
    Left,
}

impl Figures {
    /// The side of the y axis on which a figure lies.
    ///
    /// Where boxes leave it open, as in differences, samples of the figure decide.
    fn side_of_axis(&self, figure: FigureId, bounds: &Rectangle) -> Result<Side, Refusal> {
        let size = bounds.max - bounds.min;
        let near = 1e-9 * size.max_element();
        if bounds.min.x >= -near {
            return Ok(Side::Right);
        }
        if bounds.max.x <= near {
            return Ok(Side::Left);
        }
        let (mut left, mut right) = (false, false);
        for i in 0..SAMPLES {
            for j in 0..SAMPLES {
                let part = DVec2::new(f64::from(i) + 0.43, f64::from(j) + 0.57);
                let point = bounds.min + size * part / f64::from(SAMPLES);
                let seen = if point.x < 0.0 { &mut left } else { &mut right };
                *seen = *seen || self.contains(figure, point);
            }
        }
        match (left, right) {
            (true, true) => Err(Refusal::AcrossTheAxis),
            (true, false) => Ok(Side::Left),
            _ => Ok(Side::Right),
        }
    }
}
