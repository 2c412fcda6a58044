//! `resize` of solids and figures, and `projection` of solids to figures.

use super::arguments::Arguments;
use super::body::{Body, bodies};
use super::complaints::{Complaints, Reported};
use super::evaluate::{Evaluator, Frame, Operand};
use super::facets::Facets;
use super::figure::{Figure, FigureId, Loops};
use csg::{Aabb, Node, NodeId, Transform};
use glam::{DAffine2, DVec2, DVec3};

/// Coarseness of the facets that sizes are measured at.
const FINE: f64 = 0.2;

/// What a box is to be resized to.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Resize {
    /// 0: as it is.
    size: [f64; 3],
    /// Whether a 0 means in proportion.
    auto: [bool; 3],
}

impl Resize {
    /// Reads `resize(newsize, auto)`.
    pub(super) fn read(
        arguments: &Arguments<'_>,
        complaints: &mut Complaints<'_>,
    ) -> Result<Self, Reported> {
        let mut size = [0.0; 3];
        if let Some(given) = arguments.numbers("newsize", 0, 3, complaints)? {
            for (to, from) in size.iter_mut().zip(given.value) {
                *to = if from.is_finite() { from.max(0.0) } else { 0.0 };
            }
        }
        let auto = match arguments.flags("auto", complaints)?[..] {
            [all] => [all; 3],
            [x, y] => [x, y, false],
            [x, y, z, ..] => [x, y, z],
            [] => [false; 3],
        };
        Ok(Self { size, auto })
    }

    /// The factors for a box of these sides.
    fn factors(&self, sides: [f64; 3]) -> DVec3 {
        let factor = |wanted: f64, side: f64| {
            if wanted > 0.0 && side > 0.0 {
                wanted / side
            } else {
                1.0
            }
        };
        // The largest of the new sides leads.
        let mut leading = 1.0;
        let mut largest = 0.0;
        for (wanted, side) in self.size.into_iter().zip(sides) {
            if wanted > largest {
                largest = wanted;
                leading = factor(wanted, side);
            }
        }
        let mut factors = [1.0; 3];
        let each = self.size.into_iter().zip(self.auto).zip(sides);
        for (to, ((wanted, auto), side)) in factors.iter_mut().zip(each) {
            *to = if wanted == 0.0 && auto {
                leading
            } else {
                factor(wanted, side)
            };
        }
        DVec3::from(factors)
    }
}

impl Evaluator<'_, '_> {
    pub(super) fn resized(&mut self, frame: &Frame, all: NodeId, resize: &Resize) -> Operand {
        let Some(bounds) = self.bounds(all) else {
            return self.not_closed(frame);
        };
        if bounds.is_empty() {
            return Operand::Nothing;
        }
        let factors = resize.factors((bounds.max - bounds.min).to_array());
        if factors == DVec3::ONE {
            return Operand::Solid(all);
        }
        match Transform::scale(factors) {
            Ok(by) => Operand::Solid(self.builder.add(Node::Instance(by, all))),
            Err(_) => self.out_of_range(frame),
        }
    }

    pub(super) fn resized_figure(&mut self, all: FigureId, resize: &Resize) -> FigureId {
        let [min, max] = self.figures.tight_bounds(all);
        let factors = resize.factors((max - min).extend(0.0).to_array());
        let by = DAffine2::from_scale(factors.truncate());
        self.figures.add(Figure::Moved(by, all))
    }

    /// The box around a solid: of shapes exactly, of what is cut by its facets.
    fn bounds(&mut self, root: NodeId) -> Option<Aabb> {
        let mut sum = Aabb::EMPTY;
        let mut waiting = vec![(Transform::identity(), root)];
        while let Some((at, id)) = waiting.pop() {
            match self.builder.get(id)? {
                Node::Union(all) => waiting.extend(all.iter().map(|c| (at.clone(), *c))),
                Node::Instance(by, child) => waiting.push((by.compose(&at).ok()?, *child)),
                Node::Painted(_, child) => waiting.push((at, *child)),
                Node::Shape(shape) => sum = sum.union(&shape.bounds(&at)),
                _ => {
                    let moved = self.builder.add(Node::Instance(at, id));
                    let facets = Facets::of(&self.builder, moved, FINE)?;
                    let points = facets.positions.iter();
                    sum = points.fold(sum, |sum, p| sum.union(&Aabb { min: *p, max: *p }));
                }
            }
        }
        (sum.is_empty() || sum.is_finite()).then_some(sum)
    }

    /// The section with z = 0 of solids, or their shadow on it.
    pub(super) fn projection(&mut self, frame: &Frame, all: NodeId, cut: bool) -> Operand {
        let exact = bodies(&self.builder, &[all]).and_then(|bodies| {
            let figures: Option<Vec<_>> = bodies
                .iter()
                .map(|body| self.flat_body(body, cut))
                .collect();
            figures
        });
        if let Some(figures) = exact {
            let figures: Vec<FigureId> = figures.into_iter().flatten().collect();
            if figures.is_empty() {
                return Operand::Nothing;
            }
            return Operand::Flat(self.figures.union(figures), frame.name);
        }
        let Some(facets) = Facets::of(&self.builder, all, 1.0) else {
            return self.not_closed(frame);
        };
        if !facets.exact {
            self.approximate(frame, "polygon", 2.0 * facets.sagitta);
        }
        let loops = if cut {
            section(&facets)
        } else {
            shadow(&facets)
        };
        let mut loops = loops.resolved();
        if !facets.exact {
            loops = loops.thinned(facets.sagitta);
        }
        match self.figures.of_loops(&loops) {
            Some(figure) => Operand::Flat(figure, frame.name),
            None => Operand::Nothing,
        }
    }

    /// The section or shadow of a body; `None` inside if it is empty, outside if there is no
    /// closed form.
    #[expect(
        clippy::option_option,
        reason = "two kinds of absence, told apart at once"
    )]
    fn flat_body(&mut self, body: &Body, cut: bool) -> Option<Option<FigureId>> {
        let disc = |center: DVec3, radius: f64| vec![(center.truncate(), radius)];
        let discs: Vec<(DVec2, f64)> = match body {
            Body::Ball(center, radius) if cut => {
                let square = radius * radius - center.z * center.z;
                if square <= 0.0 {
                    return Some(None);
                }
                disc(*center, square.sqrt())
            }
            Body::Ball(center, radius) => disc(*center, *radius),
            Body::Can([(a, r), (b, s)]) => {
                if a.truncate().distance(b.truncate()) > 1e-9 * (r + s) {
                    return None;
                }
                if !cut {
                    disc(*a, r.max(*s))
                } else if a.z.min(b.z) <= 0.0 && a.z.max(b.z) >= 0.0 {
                    disc(*a, r + (s - r) * (-a.z / (b.z - a.z)))
                } else {
                    return Some(None);
                }
            }
            Body::Points(points) if cut => {
                // The hull of where the edges between any two points pass.
                let mut found: Vec<(DVec2, f64)> = Vec::new();
                for (i, p) in points.iter().enumerate() {
                    if p.z == 0.0 {
                        found.push((p.truncate(), 0.0));
                    }
                    for q in points.iter().skip(i + 1).filter(|q| p.z * q.z < 0.0) {
                        found.push(((*p + (*q - *p) * (p.z / (p.z - q.z))).truncate(), 0.0));
                    }
                }
                found
            }
            Body::Points(points) => points.iter().map(|p| (p.truncate(), 0.0)).collect(),
            Body::Sampled { .. } | Body::Cut(..) => return None,
        };
        Some(self.figures.hull_of_discs(discs))
    }
}

/// The outline of the section with z = 0.
fn section(facets: &Facets) -> Loops {
    // Corners in the plane count as above it, unless nothing is below.
    let lowest = facets
        .positions
        .iter()
        .map(|p| p.z)
        .fold(f64::INFINITY, f64::min);
    let is_above = |p: DVec3| if lowest < 0.0 { p.z >= 0.0 } else { p.z > 0.0 };
    let at = |i: usize| facets.positions.get(i).copied().unwrap_or_default();
    // From the mesh edge where a segment begins to the one where it ends.
    let mut next = std::collections::BTreeMap::new();
    for triangle in &facets.triangles {
        let [a, b, c] = *triangle;
        let (mut up, mut down) = (None, None);
        for (p, q) in [(a, b), (b, c), (c, a)] {
            match (is_above(at(p)), is_above(at(q))) {
                (false, true) => up = Some((p.min(q), p.max(q))),
                (true, false) => down = Some((p.min(q), p.max(q))),
                _ => {}
            }
        }
        if let (Some(up), Some(down)) = (up, down) {
            next.insert(down, up);
        }
    }
    let crossing = |(a, b): (usize, usize)| {
        let (p, q) = (at(a), at(b));
        (p + (q - p) * (p.z / (p.z - q.z)).clamp(0.0, 1.0)).truncate()
    };
    let mut all = Vec::new();
    while let Some((start, mut edge)) = next.pop_first() {
        let mut one = vec![crossing(start)];
        while edge != start {
            one.push(crossing(edge));
            match next.remove(&edge) {
                Some(following) => edge = following,
                None => break,
            }
        }
        all.push(one);
    }
    if super::figure::signed_area(&all) < 0.0 {
        for one in &mut all {
            one.reverse();
        }
    }
    Loops {
        all,
        exact: facets.exact,
    }
}

/// The outlines of all facets that are seen from above.
fn shadow(facets: &Facets) -> Loops {
    let flat = facets.corners().map(|t| t.map(DVec3::truncate));
    let seen = flat.filter(|[a, b, c]| (*b - *a).perp_dot(*c - *a) > 0.0);
    Loops {
        all: seen.map(|t| t.to_vec()).collect(),
        exact: facets.exact,
    }
}
