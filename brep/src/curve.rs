//! The true curves of the B-Rep's edges, and the true positions of its vertices.
//!
//! An edge of the B-Rep is a chain of mesh edges between two faces. Its true curve lies on the two
//! faces' surfaces: a line, a circle or an ellipse where one is found to satisfy both
//! polynomials at as many points as make it exact, but for rounding; otherwise it is traced, with
//! Newton's method, from the mesh's chain. Source: Patrikalakis and Maekawa, *Shape Interrogation for Computer
//! Aided Design and Manufacturing*, chapter 5.

mod closed_form;
mod guide;
mod meet;
mod plane_conic;
mod spline;
mod trace;

use crate::group::{Edge, Groups};
use crate::topology::{Brep, HalfEdgeKey, VertexKey, VertexView};
use crate::validate::Valid;
use csg::{PrimitiveId, Solid};
use glam::DVec3;
use meet::Meet;
use slotmap::SecondaryMap;
use std::f64::consts::TAU;

pub use spline::Spline;

/// A curve in model units. Parameters are lengths on lines, angles on circles and ellipses, and
/// positions in the list of points on traced curves.
#[derive(Clone, PartialEq, Debug)]
pub enum Curve {
    /// All points `point + t · direction`.
    Line {
        /// Where t = 0.
        point: DVec3,
        /// Unit vector.
        direction: DVec3,
    },
    /// All points `center + cos t · across[0] + sin t · across[1]`, with `across` perpendicular
    /// and equally long.
    Circle {
        /// Its centre.
        center: DVec3,
        /// Two radii.
        across: [DVec3; 2],
    },
    /// All points `center + cos t · across[0] + sin t · across[1]`, with `across` perpendicular.
    Ellipse {
        /// Its centre.
        center: DVec3,
        /// Two semi-axes.
        across: [DVec3; 2],
    },
    /// Points on both surfaces, in order; between them the curve leaves its chords by at most the
    /// chord error that was asked for.
    Traced {
        /// At least two points; for closed edges the first one is repeated at the end.
        points: Vec<DVec3>,
    },
}

/// The curve of one edge, traversed with the edge's first face to the left.
#[derive(Clone, PartialEq, Debug)]
pub struct EdgeCurve {
    /// The curve in order: one piece, or several that meet in points where the surfaces touch
    /// each other, which is where the curve may have a corner.
    pub pieces: Vec<Piece>,
    /// The primitives whose surfaces the curve lies on; one where no second one is known.
    pub primitives: Vec<PrimitiveId>,
    /// How many points of the mesh Newton's method could not put on both surfaces: they are left
    /// out.
    pub unsolved: usize,
}

/// A smooth piece of an edge's curve.
#[derive(Clone, PartialEq, Debug)]
pub struct Piece {
    /// The curve; its parameter grows along the edge.
    pub curve: Curve,
    /// Parameters at start and end; a closed circle spans 2π.
    pub range: [f64; 2],
    /// Positions of start and end.
    pub ends: [DVec3; 2],
}

/// True curves of all edges and true positions of all B-Rep vertices.
#[derive(Clone, Debug)]
pub struct Curves {
    /// Parallel to [`Groups::edges`].
    pub edges: Vec<EdgeCurve>,
    /// Positions of [`Groups::vertices`].
    pub vertices: SecondaryMap<VertexKey, DVec3>,
    /// Vertices that Newton's method could not put on all their surfaces: they stay where the
    /// mesh has them.
    pub unsolved_vertices: Vec<VertexKey>,
}

impl Curves {
    /// Finds curves and positions; traced curves deviate from their chords by at most
    /// `chord_error`, in model units. `solid` is what the boundary was made from.
    ///
    /// Cost: some Newton steps for each mesh edge in a chain.
    pub fn of(brep: &Valid<Brep>, groups: &Groups, solid: &Solid, chord_error: f64) -> Self {
        let mut this = Self {
            edges: Vec::with_capacity(groups.edges.len()),
            vertices: SecondaryMap::new(),
            unsolved_vertices: Vec::new(),
        };
        for &key in &groups.vertices {
            let vertex = brep.vertex(key);
            let mut primitives: Vec<PrimitiveId> =
                vertex.ring().map(|h| h.facet().primitive()).collect();
            primitives.sort_unstable();
            primitives.dedup();
            let near = vertex.position();
            let reach = guide::REACH * local_size(vertex, solid);
            let solved = Meet::new(solid, &primitives).solve(near, reach);
            if solved.is_none() {
                this.unsolved_vertices.push(key);
            }
            this.vertices.insert(key, solved.unwrap_or(near));
        }
        for edge in &groups.edges {
            let chain = Chain::of(brep, groups, edge, &this.vertices, solid);
            this.edges.push(chain.curve(solid, chord_error));
        }
        this
    }
}

/// The point on all these primitives that is nearest to a point, at most `reach` away.
pub(crate) fn meeting_point(
    solid: &Solid,
    primitives: &[PrimitiveId],
    near: DVec3,
    reach: f64,
) -> Option<DVec3> {
    Meet::new(solid, primitives).solve(near, reach)
}

/// Largest distance of a point from these primitives, to first order, in model units.
pub(crate) fn distance(solid: &Solid, primitives: &[PrimitiveId], at: DVec3) -> f64 {
    Meet::new(solid, primitives).distance(at)
}

/// The point where all these primitives touch each other, at most `reach` away.
pub(crate) fn touching_point(
    solid: &Solid,
    primitives: &[PrimitiveId],
    near: DVec3,
    reach: f64,
) -> Option<DVec3> {
    Meet::new(solid, primitives).touching_point(near, reach)
}

/// Length of the longest mesh edge at a vertex, at least what rounding may make: how far it may be
/// moved.
fn local_size(vertex: VertexView<'_>, solid: &Solid) -> f64 {
    const LEAST: f64 = 1e-8;
    let least = LEAST * solid.domain.size();
    vertex
        .ring()
        .map(|h| h.vector().length())
        .fold(least, f64::max)
}

/// What the mesh knows of an edge.
struct Chain {
    primitives: Vec<PrimitiveId>,
    /// Vertex positions in order; a closed chain repeats its first one.
    points: Vec<DVec3>,
    /// How far each point may be from the true curve.
    reach: Vec<f64>,
    is_closed: bool,
}

impl Chain {
    fn of(
        brep: &Brep,
        groups: &Groups,
        edge: &Edge,
        vertices: &SecondaryMap<VertexKey, DVec3>,
        solid: &Solid,
    ) -> Self {
        let origin = |&key: &HalfEdgeKey| brep.half_edge(key).origin();
        let last = edge.chain.last().map(|&key| brep.half_edge(key).target());
        let chain: Vec<VertexView<'_>> = edge.chain.iter().map(origin).chain(last).collect();
        let position = |vertex: &VertexView<'_>| {
            let solved = vertices.get(vertex.key()).copied();
            solved.unwrap_or_else(|| vertex.position())
        };
        let points: Vec<DVec3> = chain.iter().map(position).collect();
        let reach = chain
            .iter()
            .map(|&vertex| local_size(vertex, solid))
            .collect();
        let mut primitives = edge
            .faces
            .map(|face| groups.faces[face.0 as usize].primitive)
            .to_vec();
        primitives.dedup();
        if primitives.len() == 1 {
            primitives.extend(hidden_surface(solid, primitives[0], &points));
        }
        Self {
            primitives,
            points,
            reach,
            is_closed: edge.ends.is_none(),
        }
    }

    fn curve(mut self, solid: &Solid, chord_error: f64) -> EdgeCurve {
        let primitives = std::mem::take(&mut self.primitives);
        let meet = Meet::new(solid, &primitives);
        let corners = self.corners(meet);
        if let [.., (_, last)] = corners[..]
            && self.is_closed
        {
            // Closed edges begin anywhere: begin at a corner.
            self.turn(last);
        } else if self.is_closed {
            self.start_on_curve(meet);
        }
        let mut unsolved = 0;
        let pieces = self
            .pieces(corners)
            .into_iter()
            .map(|mut chain| {
                unsolved += chain.settle(meet);
                let ends = [chain.points[0], chain.points[chain.points.len() - 1]];
                let form = closed_form::find(solid, &primitives, &chain);
                let (curve, range) = form.unwrap_or_else(|| {
                    let points = trace::at(meet, &chain.points, chord_error);
                    let last = (points.len() - 1) as f64;
                    (Curve::Traced { points }, [0.0, last])
                });
                Piece { curve, range, ends }
            })
            .collect();
        EdgeCurve {
            pieces,
            primitives,
            unsolved,
        }
    }

    /// Points where the surfaces touch, with the places of the chain's points nearest to them.
    fn corners(&self, meet: Meet<'_>) -> Vec<(DVec3, usize)> {
        /// Sine below which a touching point may be near.
        const SUSPICIOUS: f64 = 0.3;
        let near = |at: usize| guide::REACH * self.reach[at];
        let slant = |(at, &point): (usize, &DVec3)| {
            meet.slant_at(meet.solve(point, near(at)).unwrap_or(point))
        };
        let slants: Vec<f64> = self.points.iter().enumerate().map(slant).collect();
        // Surfaces may also touch all along.
        if slants.iter().all(|&slant| slant < meet::TOUCHING) {
            return Vec::new();
        }
        let last = self.points.len() - 1;
        let mut corners: Vec<(DVec3, usize)> = Vec::new();
        for (at, &point) in self.points.iter().enumerate() {
            let is_near = |corner: DVec3| corner.distance(point) <= near(at);
            if slants[at] > SUSPICIOUS || corners.iter().any(|&(corner, _)| is_near(corner)) {
                continue;
            }
            let Some(corner) = meet.touching_point(point, near(at)) else {
                continue;
            };
            let distance = |&at: &usize| self.points[at].distance(corner);
            let nearest = (0..last).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            let nearest = nearest.unwrap_or(0);
            let ends = [self.points[0], self.points[last]];
            let is_end = !self.is_closed
                && ends
                    .iter()
                    .any(|&end| end.distance(corner) <= near(nearest));
            let is_known = corners.iter().any(|&(_, other)| other == nearest);
            if !is_end && !is_known {
                corners.push((corner, nearest));
            }
        }
        corners.sort_unstable_by_key(|&(_, at)| at);
        corners
    }

    /// Lets a closed chain begin at a point of the curve: the image of its first point that has one.
    fn start_on_curve(&mut self, meet: Meet<'_>) {
        let last = self.points.len() - 1;
        let image = |at: usize| meet.solve(self.points[at], guide::REACH * self.reach[at]);
        if let Some((first, start)) = (0..last).find_map(|at| Some((at, image(at)?))) {
            self.turn(first);
            self.points[0] = start;
            self.points[last] = start;
        }
    }

    /// Lets a closed chain begin at one of its points.
    fn turn(&mut self, first: usize) {
        self.points.pop();
        self.reach.pop();
        self.points.rotate_left(first);
        self.reach.rotate_left(first);
        self.points.push(self.points[0]);
        self.reach.push(self.reach[0]);
    }

    /// The chain between corners. Of a closed chain with corners the last one is where it begins.
    fn pieces(mut self, corners: Vec<(DVec3, usize)>) -> Vec<Self> {
        if corners.is_empty() {
            return vec![self];
        }
        let count = self.points.len();
        let mut cuts = corners;
        if self.is_closed
            && let Some((start, first)) = cuts.pop()
        {
            for (_, at) in &mut cuts {
                *at = (*at + count - 1 - first) % (count - 1);
            }
            self.points[0] = start;
            self.points[count - 1] = start;
        }
        cuts.sort_unstable_by_key(|(_, at)| *at);
        for &(corner, at) in &cuts {
            self.points[at] = corner;
        }
        let stops = cuts.iter().map(|&(_, at)| at).chain([count - 1]);
        let mut from = 0;
        let mut pieces = Vec::new();
        for to in stops {
            let ends = [self.points[from], self.points[to]];
            // Near a corner the mesh does not know which branch it follows.
            let keep = |&at: &usize| {
                let near = 2.0 * self.reach[at];
                at == from
                    || at == to
                    || ends.iter().all(|end| end.distance(self.points[at]) > near)
            };
            let kept: Vec<usize> = (from..=to).filter(keep).collect();
            pieces.push(Self {
                primitives: Vec::new(),
                points: kept.iter().map(|&at| self.points[at]).collect(),
                reach: kept.iter().map(|&at| 4.0 * self.reach[at]).collect(),
                is_closed: self.is_closed && cuts.is_empty(),
            });
            from = to;
        }
        pieces
    }
}

/// Two faces on one surface, of different material or sense, part where another surface crosses:
/// the first one that is zero along the chain.
fn hidden_surface(solid: &Solid, own: PrimitiveId, points: &[DVec3]) -> Option<PrimitiveId> {
    const NEAR: f64 = 1e-9;
    let on = |polynomial: &csg::Polynomial| {
        points.iter().all(|&point| {
            let at = solid.domain.to_centered(point);
            polynomial.evaluate(at).abs() <= NEAR * polynomial.gradient(at).length()
        })
    };
    (0..)
        .map(PrimitiveId)
        .zip(&solid.primitives)
        .find(|(id, primitive)| *id != own && on(&primitive.polynomial))
        .map(|(id, _)| id)
}

impl Curve {
    /// The point at a parameter.
    pub fn point(&self, t: f64) -> DVec3 {
        match self {
            Self::Line { point, direction } => *point + *direction * t,
            Self::Circle { center, across } | Self::Ellipse { center, across } => {
                *center + across[0] * t.cos() + across[1] * t.sin()
            }
            Self::Traced { points } => {
                let (at, part) = place(t, points.len());
                points[at].lerp(points[at + 1], part)
            }
        }
    }

    /// The derivative by the parameter; on traced curves that of the chord.
    pub fn tangent(&self, t: f64) -> DVec3 {
        match self {
            Self::Line { direction, .. } => *direction,
            Self::Circle { across, .. } | Self::Ellipse { across, .. } => {
                across[1] * t.cos() - across[0] * t.sin()
            }
            Self::Traced { points } => {
                let (at, _) = place(t, points.len());
                points[at + 1] - points[at]
            }
        }
    }

    /// Whether both are one circle, or one ellipse, in the same sense: the other's centre and axes
    /// are this one's up to `near`, in model units.
    pub(crate) fn is_one_conic(&self, other: &Self, near: f64) -> bool {
        let ((
            Self::Circle { center, across },
            Self::Circle {
                center: middle,
                across: axes,
            },
        )
        | (
            Self::Ellipse { center, across },
            Self::Ellipse {
                center: middle,
                across: axes,
            },
        )) = (self, other)
        else {
            return false;
        };
        let turn = |[x, y]: [DVec3; 2]| x.cross(y);
        let is_on = |at: DVec3| self.point(self.parameter(at)).distance(at) <= near;
        center.distance(*middle) <= near
            && turn(*across).dot(turn(*axes)) > 0.0
            && axes.iter().all(|&axis| is_on(*center + axis))
    }

    /// The parameter of a point on or near the curve; for angles in (−π, π].
    pub fn parameter(&self, point: DVec3) -> f64 {
        match self {
            Self::Line {
                point: origin,
                direction,
            } => (point - *origin).dot(*direction),
            Self::Circle { center, across } | Self::Ellipse { center, across } => {
                let from = point - *center;
                let [x, y] = across.map(|axis| from.dot(axis) / axis.length_squared());
                y.atan2(x)
            }
            Self::Traced { points } => {
                let mut best = (f64::INFINITY, 0.0);
                for (at, pair) in points.windows(2).enumerate() {
                    let chord = pair[1] - pair[0];
                    let part =
                        ((point - pair[0]).dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
                    let part = if part.is_finite() { part } else { 0.0 };
                    let distance = point.distance(pair[0].lerp(pair[1], part));
                    if distance < best.0 {
                        best = (distance, at as f64 + part);
                    }
                }
                best.1
            }
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the list"
)]
fn place(t: f64, count: usize) -> (usize, f64) {
    let at = (t.max(0.0) as usize).min(count - 2);
    (at, t - at as f64)
}

impl EdgeCurve {
    /// Positions of start and end.
    pub fn ends(&self) -> [DVec3; 2] {
        let (first, last) = (&self.pieces[0], &self.pieces[self.pieces.len() - 1]);
        [first.ends[0], last.ends[1]]
    }

    /// Whether the edge is a loop without a vertex, or through one.
    pub fn is_closed(&self) -> bool {
        let [start, end] = self.ends();
        start == end
    }

    /// Points along the edge, as those of its pieces.
    pub fn polyline(&self, solid: &Solid, chord_error: f64) -> Vec<DVec3> {
        let mut points = vec![self.ends()[0]];
        for piece in &self.pieces {
            let line = piece.polyline(solid, &self.primitives, chord_error);
            points.extend_from_slice(&line[1..]);
        }
        points
    }
}

impl Piece {
    /// Points along the piece whose chords leave the curve by at most `chord_error`, in model
    /// units; first and last are exactly its ends. Closed circles have at least three chords:
    /// none spans more than a third of a turn.
    ///
    /// A traced curve is thinned out, or refined with Newton's method; `solid` is what the
    /// boundary was made from, `primitives` are the edge's.
    pub fn polyline(
        &self,
        solid: &Solid,
        primitives: &[PrimitiveId],
        chord_error: f64,
    ) -> Vec<DVec3> {
        let radius = match &self.curve {
            Curve::Line { .. } => return self.ends.to_vec(),
            Curve::Traced { points } => {
                let meet = Meet::new(solid, primitives);
                return trace::at(meet, points, chord_error);
            }
            Curve::Circle { across, .. } | Curve::Ellipse { across, .. } => {
                across[0].length().max(across[1].length())
            }
        };
        // An ellipse is the image of a circle that stretches its sagittas by at most the radius.
        let step = 2.0 * (1.0 - (chord_error / radius).clamp(0.0, 1.0)).acos();
        let sweep = self.range[1] - self.range[0];
        let count = (sweep / step.clamp(1e-4, TAU / 3.0)).ceil().max(1.0);
        let mut points = vec![self.ends[0]];
        let mut k = 1.0;
        while k < count {
            points.push(self.curve.point(self.range[0] + sweep * (k / count)));
            k += 1.0;
        }
        points.push(self.ends[1]);
        points
    }
}

#[cfg(test)]
mod tests;
