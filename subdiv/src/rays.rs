//! Ray tracing through the bintree (thesis 6.4): where parallel rays meet the true solid first.
//!
//! A bundle of rays descends together. Every simplex is halved once for all of them, the child
//! nearer to the eye comes first, and a ray that has hit leaves the bundle. Where solving costs
//! less than bisecting, each polynomial is restricted to each ray: a univariate Bernstein form,
//! whose sign changes say where the formula turns. No mesh, no tolerance; only the rounding of
//! double precision, about 1e-11 of the domain's side.

use crate::Criterion;
use crate::bernstein::count;
use crate::blossom::RootCoefficients;
use crate::error::Error;
use crate::lattice::MAX_LEVEL;
use crate::leaf_formula::MAX_LEAF_PRIMITIVES;
use crate::simplex::Simplex;
use crate::walk::{Frame, Sector, Walker};
use csg::{MaterialId, PrimitiveId, Sense, Solid};
use glam::DVec3;
use line::{Line, steps};

mod line;
mod roots;

/// Where a ray meets the solid.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Hit {
    /// The place, in model units.
    pub position: DVec3,
    /// Unit normal of the surface there, outward; against the ray where the gradient vanishes.
    pub normal: DVec3,
    /// The surface.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where its polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
}

/// A solid ready to be traced.
#[derive(Debug)]
pub struct Tracer<'a> {
    solid: &'a Solid,
    sectors: Vec<Sector>,
    /// By degree: operations that restrict a polynomial to a ray.
    restricting: Vec<f64>,
    /// By degree: operations that halve and classify a polynomial.
    halving: Vec<f64>,
}

/// The part of a ray in a simplex.
#[derive(Clone, Copy, Debug)]
struct Piece {
    ray: u32,
    /// Barycentric coordinates at parameter 0; they change by [`Place::speed`] a unit.
    start: [f64; 4],
    /// The parameters between which the ray is in the simplex.
    range: [f64; 2],
}

/// A simplex as all rays of a bundle see it.
#[derive(Clone, Copy, Debug)]
struct Place {
    simplex: Simplex,
    /// How fast barycentric coordinates change along the rays.
    speed: [f64; 4],
}

/// Slack of barycentric coordinates: rays through a facet belong to both sides of it.
const SLACK: f64 = 1e-9;

/// Operations, by measurement, that a polynomial on a ray takes besides its restriction.
const OVERHEAD: f64 = 200.0;

/// Operations that a ray must be spared to be handed to children instead. With 100 or 700 the
/// models of the bench `thesis` take up to 40 % longer.
const PATIENCE: f64 = 300.0;

/// How much of the dearest polynomial's work a bisection spares: the rays that miss it. Without
/// this, high degrees are solved in the roots; with more, single rays descend for ever.
const SPARED: f64 = 0.03;

impl<'a> Tracer<'a> {
    /// Converts the solid's primitives. Cost: as the beginning of a conversion.
    #[must_use]
    pub fn new(solid: &'a Solid) -> Self {
        let roots: Vec<_> = solid.primitives.iter().map(RootCoefficients::new).collect();
        let sectors = Walker::new(solid, Criterion::Bezier, None).roots(solid, &roots);
        let degrees = roots.iter().map(|root| root.degree).max().unwrap_or(0);
        Self {
            solid,
            sectors,
            restricting: (0..=degrees)
                .map(|n| OVERHEAD + 7.0 * steps(n) as f64)
                .collect(),
            halving: (0..=degrees)
                .map(|n| (count(n) * (n + 4)) as f64 / 2.0)
                .collect(),
        }
    }

    /// The first places where rays enter the solid, one for each origin, all in one direction.
    ///
    /// Origins lie outside of the solid; what is behind them counts, too: rays are lines that
    /// come from infinitely far away. Rays that are near to each other share most of the work.
    ///
    /// # Errors
    /// [`Error::TooManySurfaces`] where more meet than a leaf can hold.
    pub fn first_hits(
        &self,
        direction: DVec3,
        origins: &[DVec3],
    ) -> Result<Vec<Option<Hit>>, Error> {
        let mut hits = vec![None; origins.len()];
        let Some(direction) = direction.try_normalize() else {
            return Ok(hits);
        };
        let mut sectors: Vec<&Sector> = self.sectors.iter().collect();
        sectors.sort_by_key(|sector| passed_planes(&sector.simplex, direction));
        let mut bundle = Bundle {
            tracer: self,
            walker: Walker::new(self.solid, Criterion::Bezier, None),
            frames: Vec::new(),
            pieces: Vec::new(),
            line: Line::default(),
            direction,
            hits: &mut hits,
        };
        for sector in sectors {
            let place = Place {
                simplex: sector.simplex,
                speed: coordinates(&sector.simplex, direction, 0.0),
            };
            let mut pieces = std::mem::take(&mut bundle.pieces);
            for (ray, &origin) in (0..).zip(origins) {
                if bundle.hits[ray as usize].is_some() {
                    continue;
                }
                // From the middle of the domain's side on: parameters stay small.
                let unit = 0.5 * self.solid.domain.to_centered(origin) + 0.5;
                let unit = unit - direction * direction.dot(unit - DVec3::splat(0.5));
                let start = coordinates(&sector.simplex, unit, 1.0);
                if let Some(range) = range_inside(&start, &place.speed) {
                    pieces.push(Piece { ray, start, range });
                }
            }
            let (simplex, frame) = (&place, &sector.frame);
            bundle.visit(simplex, frame, &mut pieces, 0, 0)?;
            pieces.clear();
            bundle.pieces = pieces;
        }
        Ok(hits)
    }
}

/// How many of the planes x = y, y = z, x = z rays in this direction have crossed when they come
/// to a root simplex: which one is nearer to the eye.
fn passed_planes(simplex: &Simplex, direction: DVec3) -> usize {
    let middle: DVec3 = simplex.vertices.iter().map(|v| v.position()).sum();
    [(0, 1), (1, 2), (0, 2)]
        .into_iter()
        .filter(|&(a, b)| (middle[a] - middle[b]) * (direction[a] - direction[b]) > 0.0)
        .count()
}

/// Barycentric coordinates of a point (`weight` 1) or vector (`weight` 0) in a root simplex,
/// which climbs the unit cube along one axis after the other.
fn coordinates(root: &Simplex, at: DVec3, weight: f64) -> [f64; 4] {
    let [v0, v1, v2, v3] = root.vertices.map(crate::lattice::Point::position);
    let [a, b, c] = [v1 - v0, v2 - v1, v3 - v2].map(|axis| axis.dot(at));
    [weight - a, a - b, b - c, c]
}

/// Where a line is inside a simplex.
fn range_inside(start: &[f64; 4], speed: &[f64; 4]) -> Option<[f64; 2]> {
    let mut range = [f64::NEG_INFINITY, f64::INFINITY];
    for (start, speed) in start.iter().zip(speed) {
        range = clip(range, *start, *speed)?;
    }
    Some(range)
}

/// The part of a range in which a coordinate is not negative.
fn clip([from, to]: [f64; 2], start: f64, speed: f64) -> Option<[f64; 2]> {
    let start = start + SLACK;
    let zero = -start / speed;
    let [from, to] = if speed > 0.0 {
        [from.max(zero), to]
    } else if speed < 0.0 {
        [from, to.min(zero)]
    } else if start >= 0.0 {
        [from, to]
    } else {
        return None;
    };
    (from <= to).then_some([from, to])
}

/// Rays on their way through the bintree.
struct Bundle<'a, 'b> {
    tracer: &'b Tracer<'a>,
    walker: Walker,
    /// Two children for each level.
    frames: Vec<[Frame; 2]>,
    /// Those of all open simplices, one after the other.
    pieces: Vec<Piece>,
    line: Line,
    direction: DVec3,
    hits: &'b mut [Option<Hit>],
}

impl Bundle<'_, '_> {
    /// Follows the pieces from `first` on through a simplex whose formula is undecided.
    ///
    /// The recursion is as deep as the lattice has levels, whatever the input.
    fn visit(
        &mut self,
        place: &Place,
        frame: &Frame,
        pieces: &mut Vec<Piece>,
        first: usize,
        depth: usize,
    ) -> Result<(), Error> {
        if !self.is_worth_bisecting(place, frame, pieces.len() - first) {
            return self.solve(place, frame, &pieces[first..]);
        }
        if self.frames.len() == depth {
            self.frames.push([Frame::default(), Frame::default()]);
        }
        let mut frames = std::mem::take(&mut self.frames[depth]);
        let children = place.simplex.children();
        let kind = place.simplex.kind();
        let undecided = self.walker.descend(frame, kind, &children, &mut frames);
        let last = pieces.len();
        let speed = place.speed[0] - place.speed[3];
        // The near child is where coordinate 0 exceeds coordinate 3.
        let order = if speed > 0.0 { [1, 0] } else { [0, 1] };
        for side in order {
            if !undecided[side] {
                continue;
            }
            let below = Place {
                simplex: children[side],
                speed: in_child(kind, side, place.speed),
            };
            for at in first..last {
                let piece = pieces[at];
                if self.hits[piece.ray as usize].is_some() {
                    continue;
                }
                let start = in_child(kind, side, piece.start);
                if let Some(range) = clip(piece.range, start[0], below.speed[0]) {
                    pieces.push(Piece {
                        start,
                        range,
                        ..piece
                    });
                }
            }
            if pieces.len() > last {
                self.visit(&below, &frames[side], pieces, last, depth + 1)?;
                pieces.truncate(last);
            }
        }
        self.frames[depth] = frames;
        Ok(())
    }

    fn is_worth_bisecting(&self, place: &Place, frame: &Frame, rays: usize) -> bool {
        if place.simplex.level == MAX_LEVEL {
            return false;
        }
        if frame.active.len() > MAX_LEAF_PRIMITIVES {
            return true;
        }
        // All operators are read for each ray, and for each child.
        let pruning = 10.0 * frame.formula.len() as f64;
        let (mut solving, mut dearest, mut halving) = (pruning, 0.0_f64, pruning);
        for active in &frame.active {
            let degree = active.degree as usize;
            let own = self.tracer.restricting[degree];
            solving += own;
            dearest = dearest.max(own);
            halving += self.tracer.halving[degree];
        }
        let spared = solving - (1.0 - SPARED) * dearest;
        rays as f64 * (spared - PATIENCE) > 2.0 * halving
    }

    /// Finds out where each ray enters the solid in a simplex, if it does.
    fn solve(&mut self, place: &Place, frame: &Frame, pieces: &[Piece]) -> Result<(), Error> {
        let solid = self.tracer.solid;
        if frame.active.len() > MAX_LEAF_PRIMITIVES {
            let at = solid.domain.from_unit(place.simplex.vertices[0].position());
            return Err(Error::TooManySurfaces {
                count: frame.active.len(),
                x: at.x,
                y: at.y,
                z: at.z,
            });
        }
        self.line.load(frame);
        let corners = place.simplex.vertices.map(crate::lattice::Point::position);
        for piece in pieces {
            let at = |t: f64| std::array::from_fn(|v| piece.start[v] + place.speed[v] * t);
            let ends = piece.range.map(at);
            let Some(entry) = self.line.entry(frame, ends) else {
                continue;
            };
            let [from, to] = piece.range;
            let weights: [f64; 4] = at(from + (to - from) * entry.part);
            let unit: DVec3 = corners.iter().zip(weights).map(|(c, w)| *c * w).sum();
            let polynomial = &solid.primitives[entry.primitive.0 as usize].polynomial;
            let gradient = polynomial.gradient(2.0 * unit - 1.0).try_normalize();
            let outward = match entry.label.sense {
                Sense::Inside => gradient,
                Sense::Outside => gradient.map(|g| -g),
            };
            self.hits[piece.ray as usize] = Some(Hit {
                position: solid.domain.from_unit(unit),
                normal: outward.unwrap_or(-self.direction),
                primitive: entry.primitive,
                sense: entry.label.sense,
                material: entry.label.material,
            });
        }
        Ok(())
    }
}

/// Barycentric coordinates in a child, given those in its parent of this type.
///
/// v3 = 2m − v0 in the near child, v0 = 2m − v3 in the far one.
fn in_child(kind: u8, side: usize, [b0, b1, b2, b3]: [f64; 4]) -> [f64; 4] {
    match (side, kind) {
        (0, _) => [b0 - b3, 2.0 * b3, b1, b2],
        (_, 0) => [b3 - b0, 2.0 * b0, b2, b1],
        _ => [b3 - b0, 2.0 * b0, b1, b2],
    }
}

#[cfg(test)]
mod tests;
