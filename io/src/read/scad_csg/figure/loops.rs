//! Figures as outlines: closed loops with the filled side on their left.
//!
//! What has no closed form over lines and circles, such as the offset of a cut disc, is computed
//! on outlines whose arcs are chords.

use super::chain::doubled_area;
use super::polygon::Known;
use super::{Figure, FigureId, Figures, Outline, Rectangle, Region};
use glam::{DAffine2, DVec2};
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;
use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

/// Distance of chords from arcs, in sizes of the figure.
const SAGITTA: f64 = 2e-4;

/// An outline.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Loops {
    /// Counter-clockwise around what is filled, clockwise around holes.
    pub(in super::super) all: Vec<Vec<DVec2>>,
    /// Whether no arc was replaced by chords.
    pub(in super::super) exact: bool,
}

impl Loops {
    /// Number of edges.
    pub(super) fn edge_count(&self) -> usize {
        self.all.iter().map(Vec::len).sum()
    }

    /// The edges, each with the loop's next vertex.
    pub(super) fn edges(&self) -> impl Iterator<Item = [DVec2; 2]> {
        self.all.iter().flat_map(|one| {
            let next = one.iter().cycle().skip(1);
            one.iter().zip(next).map(|(a, b)| [*a, *b])
        })
    }

    /// Only the loop, if there is one only and it is convex.
    pub(super) fn convex(&self) -> Option<&[DVec2]> {
        let [only] = &self.all[..] else { return None };
        (super::chain::hull(only).len() == only.len()).then_some(only)
    }

    /// The outlines around the points that are in one, in both, or only in the first of two
    /// figures; loops of either may overlap.
    pub(super) fn combine(&self, other: &Self, rule: OverlayRule) -> Self {
        let plain = |loops: &Self| -> Vec<Vec<[f64; 2]>> {
            let one = |one: &Vec<DVec2>| one.iter().map(DVec2::to_array).collect();
            loops.all.iter().map(one).collect()
        };
        let (subject, clip) = (plain(self), plain(other));
        let shapes = subject.overlay_as::<i64>(&clip, rule, FillRule::NonZero);
        let given: Vec<DVec2> = self
            .all
            .iter()
            .chain(&other.all)
            .flatten()
            .copied()
            .collect();
        let known = Known::new(&given);
        let mut all = Vec::new();
        for shape in shapes {
            for (at, contour) in shape.into_iter().enumerate() {
                let points = contour.into_iter().map(|p| known.nearest(DVec2::from(p)));
                let mut points: Vec<DVec2> = points.collect();
                points.dedup();
                if (doubled_area(&points) > 0.0) != (at == 0) {
                    points.reverse();
                }
                if points.len() > 2 {
                    all.push(points);
                }
            }
        }
        Self {
            all,
            exact: self.exact && other.exact,
        }
    }

    /// The same without overlaps.
    pub(in super::super) fn resolved(&self) -> Self {
        self.combine(
            &Self {
                all: Vec::new(),
                exact: true,
            },
            OverlayRule::Subject,
        )
    }

    /// The loops without vertices that lie within `near` of the edges that remain.
    pub(in super::super) fn thinned(mut self, near: f64) -> Self {
        for one in &mut self.all {
            let mut kept: Vec<DVec2> = Vec::with_capacity(one.len());
            let mut skipped: Vec<DVec2> = Vec::new();
            for pair in one.windows(2) {
                let [p, q] = *pair else { continue };
                let Some(&start) = kept.last() else {
                    kept.push(p);
                    continue;
                };
                skipped.push(p);
                let along = (q - start).normalize_or_zero();
                let strays = |s: &DVec2| (*s - start).perp_dot(along).abs() > near;
                if skipped.len() > 30 || skipped.iter().any(strays) {
                    kept.push(p);
                    skipped.clear();
                }
            }
            kept.extend(one.last());
            *one = kept;
        }
        self
    }

    /// The box around all loops.
    pub(super) fn bounds(&self) -> Rectangle {
        let points = self.all.iter().flatten();
        points.fold(Rectangle::EMPTY, |all, p| {
            all.union(&Rectangle { min: *p, max: *p })
        })
    }
}

/// A circle as chords within `sagitta`.
pub(super) fn chords(center: DVec2, radius: f64, sagitta: f64) -> Vec<DVec2> {
    let count = PI / (2.0 * sagitta / radius).sqrt();
    let count = count.ceil().clamp(8.0, 400.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped"
    )]
    let count = count as u32;
    let vertex =
        |i: u32| center + radius * DVec2::from_angle(TAU * f64::from(i) / f64::from(count));
    (0..count).map(vertex).collect()
}

impl Figures {
    /// How far chords may be from the arcs of a figure.
    pub(in super::super) fn sagitta(&self, root: FigureId) -> f64 {
        let bounds = self.bounds(root);
        SAGITTA * (bounds.max - bounds.min).max_element()
    }

    /// The outline of a figure, its arcs as chords.
    pub(in super::super) fn loops(&self, root: FigureId) -> Loops {
        let sagitta = self.sagitta(root);
        let found = self.fold(
            root,
            DAffine2::IDENTITY,
            |region, at| Ok::<_, Infallible>(region.loops(at, sagitta)),
            |figure, all| {
                let mut all = all.into_iter();
                let first = all.next().unwrap_or_default();
                let joined = |rest: &mut dyn Iterator<Item = Loops>| {
                    let mut sum = Loops {
                        all: Vec::new(),
                        exact: true,
                    };
                    for one in rest {
                        sum.all.extend(one.all);
                        sum.exact &= one.exact;
                    }
                    sum
                };
                match figure {
                    Figure::Intersection(_) => {
                        all.fold(first, |sum, one| sum.combine(&one, OverlayRule::Intersect))
                    }
                    Figure::Difference(_) => {
                        first.combine(&joined(&mut all), OverlayRule::Difference)
                    }
                    _ => first.combine(&joined(&mut all), OverlayRule::Union),
                }
            },
        );
        found.unwrap_or_default().unwrap_or_default()
    }

    /// The figure within an outline; `None` if it has no area.
    pub(in super::super) fn of_loops(&mut self, loops: &Loops) -> Option<FigureId> {
        let region = Region::polygon(&loops.all)?;
        Some(self.add(Figure::Region(region)))
    }

    /// The part of a figure where x is positive, within `reach`.
    pub(in super::super) fn right_of_axis(&mut self, whole: FigureId, reach: f64) -> FigureId {
        let corner = |x: f64, y: f64| DVec2::new(x * reach, y * reach);
        let half = [
            corner(0.0, -1.0),
            corner(1.0, -1.0),
            corner(1.0, 1.0),
            corner(0.0, 1.0),
        ];
        match Region::polygon(&[half.to_vec()]) {
            Some(half) => {
                let half = self.add(Figure::Region(half));
                self.add(Figure::Intersection(vec![whole, half]))
            }
            None => whole,
        }
    }

    /// A box around a figure: tight, but for chords in place of arcs where it is cut.
    pub(in super::super) fn tight_bounds(&self, root: FigureId) -> [DVec2; 2] {
        let bounds = if self.united_regions(root).is_some() {
            self.bounds(root)
        } else {
            self.loops(root).bounds()
        };
        [bounds.min, bounds.max]
    }
}

impl Region {
    /// The outline, moved.
    pub(super) fn loops(&self, at: &DAffine2, sagitta: f64) -> Loops {
        let (all, exact) = match &self.outline {
            Outline::Circle(radius) => {
                let stretch = at.matrix2.x_axis.length().max(at.matrix2.y_axis.length());
                let sagitta = (sagitta / stretch.max(f64::MIN_POSITIVE)).max(1e-6 * radius);
                (vec![chords(DVec2::ZERO, *radius, sagitta)], false)
            }
            Outline::Corners { loops, .. } => (loops.clone(), true),
        };
        let flips = at.matrix2.determinant() < 0.0;
        let moved = all.into_iter().map(|one| {
            let mut one: Vec<DVec2> = one.iter().map(|p| at.transform_point2(*p)).collect();
            if flips {
                one.reverse();
            }
            one
        });
        Loops {
            all: moved.collect(),
            exact,
        }
    }
}
