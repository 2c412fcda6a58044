//! Plane figures: set operations on polygons and discs in the plane z = 0, until something
//! extrudes them.
//!
//! A figure is kept as a formula over curves of degree 1 and 2, not as an outline, so that set
//! operations are exact and circles stay circles.

mod chain;
mod disc_hull;
mod loops;
mod offset;
mod partition;
mod polygon;
mod read;
mod revolve;
mod solid;
mod taper;
mod text;
mod twist;

pub(super) use chain::{doubled_area, hull as convex_ring, turn};
pub(super) use loops::Loops;
pub(super) use offset::Offset;
pub(super) use partition::widest_gap;
pub(super) use read::{Extrusion, FigureLeaf, extrusion, leaf, offset};
pub(super) use solid::{Refusal, extrude};
pub(super) use text::text;

use glam::{DAffine2, DMat3, DVec2, DVec3};
use std::convert::Infallible;

/// Index of a figure in [`Figures`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct FigureId(usize);

/// A figure in terms of earlier ones.
#[derive(Clone, Debug)]
pub(super) enum Figure {
    Region(Region),
    Union(Vec<FigureId>),
    Intersection(Vec<FigureId>),
    Difference(Vec<FigureId>),
    Moved(DAffine2, FigureId),
}

/// A polygon or a disc.
#[derive(Clone, Debug)]
pub(super) struct Region {
    /// A monotone formula in prefix order.
    parts: Vec<Part>,
    outline: Outline,
}

/// What a region is bounded by, for boxes and hulls.
#[derive(Clone, Debug)]
enum Outline {
    /// A circle about the origin.
    Circle(f64),
    /// Corners, whose hull is that of the region, and all loops, filled on their left.
    Corners {
        at: Vec<DVec2>,
        loops: Vec<Vec<DVec2>>,
        convex: bool,
    },
}

/// A part of a formula in prefix order.
#[derive(Clone, Copy, PartialEq, Debug)]
enum Part {
    Open { union: bool },
    Close,
    Side(Curve),
}

/// `c0 x² + c1 x y + c2 y² + c3 x + c4 y + c5 ≤ 0`.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Curve([f64; 6]);

impl Curve {
    /// The points to the left of a directed line.
    fn left_of(from: DVec2, to: DVec2) -> Self {
        let along = to - from;
        let normal = DVec2::new(along.y, -along.x).normalize_or_zero();
        // Of the two points, the nearer one to the origin loses fewer digits.
        let near = if from.length_squared() <= to.length_squared() {
            from
        } else {
            to
        };
        Self([0.0, 0.0, 0.0, normal.x, normal.y, -normal.dot(near)])
    }

    /// A disc about the origin.
    fn disc(radius: f64) -> Self {
        Self([1.0, 0.0, 1.0, 0.0, 0.0, -radius * radius])
    }

    fn is_line(&self) -> bool {
        self.0[..3].iter().all(|c| *c == 0.0)
    }

    fn negated(self) -> Self {
        Self(self.0.map(|c| -c))
    }

    /// The curve, moved. The map must be invertible.
    fn moved(&self, by: &DAffine2) -> Self {
        if *by == DAffine2::IDENTITY {
            return *self;
        }
        let [a, b, c, d, e, f] = self.0;
        let inverse = by.inverse();
        if self.is_line() {
            let n = inverse.matrix2.transpose() * DVec2::new(d, e);
            let length = n.length();
            let offset = n.dot(by.translation) - f;
            return Self([0.0, 0.0, 0.0, n.x, n.y, -offset].map(|c| c / length));
        }
        let form = DMat3::from_cols(
            DVec3::new(a, 0.5 * b, 0.5 * d),
            DVec3::new(0.5 * b, c, 0.5 * e),
            DVec3::new(0.5 * d, 0.5 * e, f),
        );
        let back = DMat3::from(inverse);
        let m = back.transpose() * form * back;
        let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
        Self([x.x, 2.0 * x.y, y.y, 2.0 * x.z, 2.0 * y.z, z.z])
    }

    fn value(&self, DVec2 { x, y }: DVec2) -> f64 {
        let [a, b, c, d, e, f] = self.0;
        (a * x + b * y + d) * x + (c * y + e) * y + f
    }
}

/// An axis-parallel rectangle; empty if `min` is not below `max`.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Rectangle {
    min: DVec2,
    max: DVec2,
}

impl Rectangle {
    const EMPTY: Self = Self {
        min: DVec2::INFINITY,
        max: DVec2::NEG_INFINITY,
    };

    fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    fn intersection(&self, other: &Self) -> Self {
        Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        }
    }
}

/// All figures of a file; children come before parents.
#[derive(Clone, Debug, Default)]
pub(super) struct Figures {
    nodes: Vec<Figure>,
}

impl Figures {
    pub(super) fn add(&mut self, figure: Figure) -> FigureId {
        self.nodes.push(figure);
        FigureId(self.nodes.len() - 1)
    }

    /// The union, without a node of its own if there is only one.
    pub(super) fn union(&mut self, all: Vec<FigureId>) -> FigureId {
        match all[..] {
            [only] => only,
            _ => self.add(Figure::Union(all)),
        }
    }

    fn node(&self, id: FigureId) -> Option<&Figure> {
        self.nodes.get(id.0)
    }

    /// The value of a figure from those of its regions, which are given with their places.
    fn fold<T, E>(
        &self,
        root: FigureId,
        place: DAffine2,
        mut region: impl FnMut(&Region, &DAffine2) -> Result<T, E>,
        mut combine: impl FnMut(&Figure, Vec<T>) -> T,
    ) -> Result<Option<T>, E> {
        enum Task {
            Enter(FigureId, DAffine2),
            Combine(FigureId, usize),
        }
        let mut done: Vec<T> = Vec::new();
        let mut tasks = vec![Task::Enter(root, place)];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Enter(id, at) => match self.node(id) {
                    None => {}
                    Some(Figure::Region(found)) => done.push(region(found, &at)?),
                    Some(Figure::Moved(by, child)) => tasks.push(Task::Enter(*child, at * *by)),
                    Some(
                        Figure::Union(all) | Figure::Intersection(all) | Figure::Difference(all),
                    ) => {
                        tasks.push(Task::Combine(id, done.len()));
                        tasks.extend(all.iter().rev().map(|child| Task::Enter(*child, at)));
                    }
                },
                Task::Combine(id, first) => {
                    let all = done.split_off(first.min(done.len()));
                    if let Some(figure) = self.node(id) {
                        done.push(combine(figure, all));
                    }
                }
            }
        }
        Ok(done.pop())
    }

    /// A box around a figure: tight for unions, never too small.
    fn bounds(&self, root: FigureId) -> Rectangle {
        let bounds = self.fold(
            root,
            DAffine2::IDENTITY,
            |region, at| Ok::<_, Infallible>(region.bounds(at)),
            |figure, all| match figure {
                Figure::Intersection(_) => {
                    let mut all = all.into_iter();
                    let first = all.next().unwrap_or(Rectangle::EMPTY);
                    all.fold(first, |sum, one| sum.intersection(&one))
                }
                Figure::Difference(_) => all.first().copied().unwrap_or(Rectangle::EMPTY),
                _ => all.iter().fold(Rectangle::EMPTY, |sum, one| sum.union(one)),
            },
        );
        bounds.unwrap_or_default().unwrap_or(Rectangle::EMPTY)
    }

    /// Whether a point lies in a figure.
    fn contains(&self, root: FigureId, point: DVec2) -> bool {
        let inside = self.fold(
            root,
            DAffine2::IDENTITY,
            |region, at| {
                let local = at.inverse().transform_point2(point);
                Ok::<_, Infallible>(region.contains(local))
            },
            |figure, all| match figure {
                Figure::Intersection(_) => all.iter().all(|inside| *inside),
                Figure::Difference(_) => match all.split_first() {
                    Some((first, rest)) => *first && !rest.contains(&true),
                    None => false,
                },
                _ => all.contains(&true),
            },
        );
        matches!(inside, Ok(Some(true)))
    }

    /// The regions with their places if the figure is nothing but their union.
    fn united_regions(&self, root: FigureId) -> Option<Vec<(DAffine2, &Region)>> {
        let mut found = Vec::new();
        let mut waiting = vec![(DAffine2::IDENTITY, root)];
        while let Some((at, id)) = waiting.pop() {
            match self.node(id)? {
                Figure::Region(region) => found.push((at, region)),
                Figure::Moved(by, child) => waiting.push((at * *by, *child)),
                Figure::Union(all) => waiting.extend(all.iter().map(|c| (at, *c))),
                Figure::Intersection(all) | Figure::Difference(all) => match all[..] {
                    [only] => waiting.push((at, only)),
                    _ => return None,
                },
            }
        }
        Some(found)
    }
}

impl Region {
    /// The box around the region, moved.
    fn bounds(&self, at: &DAffine2) -> Rectangle {
        match &self.outline {
            Outline::Circle(radius) => {
                let rows = at.matrix2.transpose();
                let reach = DVec2::new(rows.x_axis.length(), rows.y_axis.length()) * *radius;
                Rectangle {
                    min: at.translation - reach,
                    max: at.translation + reach,
                }
            }
            Outline::Corners { at: corners, .. } => {
                let moved = corners.iter().map(|c| at.transform_point2(*c));
                moved.fold(Rectangle::EMPTY, |all, p| {
                    all.union(&Rectangle { min: p, max: p })
                })
            }
        }
    }

    fn contains(&self, point: DVec2) -> bool {
        let mut open = vec![(true, false)];
        for part in &self.parts {
            let value = match part {
                Part::Open { union } => {
                    open.push((*union, !*union));
                    continue;
                }
                Part::Side(curve) => curve.value(point) <= 0.0,
                Part::Close => open.pop().is_some_and(|(_, value)| value),
            };
            if let Some((union, all)) = open.last_mut() {
                *all = if *union { *all || value } else { *all && value };
            }
        }
        open.pop().is_some_and(|(_, value)| value)
    }
}

/// The corners of the convex hull of points.
pub(super) fn convex_corners(points: &[DVec2]) -> Vec<DVec2> {
    let ring = convex_ring(points).into_iter();
    ring.filter_map(|i| points.get(i).copied()).collect()
}

/// The area within loops, those that turn clockwise counted as negative.
pub(super) fn signed_area(loops: &[Vec<DVec2>]) -> f64 {
    loops.iter().map(|one| 0.5 * doubled_area(one)).sum()
}
