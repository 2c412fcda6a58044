//! What becomes of a node's children once they are all evaluated.

use super::evaluate::{Evaluator, Frame, Operand};
use super::figure::{self, Extrusion, Figure, FigureId, Offset, Refusal};
use super::polyhedron::{self, Part};
use super::reshape::Resize;
use super::rounded::Made;
use super::token::Span;
use csg::{MaterialId, ModelBuilder, Node, NodeId, Transform};
use glam::{DAffine2, DMat2, DVec2};

/// What a node does with its children.
pub(super) enum Operation {
    Union,
    Intersection,
    Difference,
    Move(Transform),
    Paint(MaterialId),
    Extrude(Extrusion),
    Hull,
    Minkowski,
    Offset(Offset),
    Fill,
    Resize(Resize),
    /// To the plane z = 0: the section, if `cut`, or the shadow.
    Projection {
        cut: bool,
    },
}

impl Evaluator<'_, '_> {
    /// Combines the operands of a node whose children are all evaluated.
    pub(super) fn close(&mut self, frame: &Frame) -> Operand {
        let operands = self
            .operands
            .split_off(frame.first.min(self.operands.len()));
        if operands.iter().any(|o| matches!(o, Operand::Unusable)) {
            return Operand::Unusable;
        }
        let empty_first = matches!(operands.first(), None | Some(Operand::Nothing));
        let any_empty = operands.iter().any(|o| matches!(o, Operand::Nothing));
        match &frame.operation {
            Operation::Difference if empty_first => return Operand::Nothing,
            Operation::Intersection if any_empty => return Operand::Nothing,
            _ => {}
        }
        let extrudes = matches!(frame.operation, Operation::Extrude(_));
        let mut kinds = operands.iter().filter_map(|o| match o {
            Operand::Flat(_, at) => Some(Some(*at)),
            Operand::Solid(_) => Some(None),
            _ => None,
        });
        let Some(first) = kinds.next() else {
            return Operand::Nothing;
        };
        let projects = matches!(frame.operation, Operation::Projection { .. });
        let flat_at = if projects {
            let solid = std::iter::once(first).chain(kinds).find(Option::is_none);
            solid.unwrap_or(first)
        } else if extrudes {
            std::iter::once(first).chain(kinds).flatten().next()
        } else {
            first
        };
        let (mut solids, mut figures) = (Vec::new(), Vec::new());
        for operand in operands {
            match operand {
                Operand::Solid(id) => solids.push(id),
                Operand::Flat(id, at) => figures.push((id, at)),
                Operand::Nothing | Operand::Unusable => {}
            }
        }
        if extrudes && !solids.is_empty() {
            let name = frame.name.of(self.text);
            let message =
                format!("`{name}` extrudes 2-D nodes; its 3-D ones are left out, as in OpenSCAD");
            self.complaints.warn(frame.name, message, None);
            solids.clear();
        }
        let Some(at) = flat_at else {
            for (_, at) in figures {
                let name = at.of(self.text);
                let message =
                    format!("`{name}` is 2-D among 3-D nodes; it is left out, as in OpenSCAD");
                self.complaints.warn(at, message, None);
            }
            return self.combine_solids(frame, solids);
        };
        if !solids.is_empty() {
            let message = "2-D and 3-D nodes are mixed: after this 2-D one, the 3-D ones are left out, as in OpenSCAD";
            self.complaints.warn(at, message, None);
        }
        let figures = figures.into_iter().map(|(id, _)| id).collect();
        self.combine_figures(frame, figures, at)
    }

    fn combine_solids(&mut self, frame: &Frame, solids: Vec<NodeId>) -> Operand {
        let Some(&first) = solids.first() else {
            return Operand::Nothing;
        };
        let is_alone = solids.len() == 1;
        Operand::Solid(match &frame.operation {
            Operation::Union
            | Operation::Intersection
            | Operation::Difference
            | Operation::Minkowski
                if is_alone =>
            {
                first
            }
            Operation::Intersection => self.builder.add(Node::Intersection(solids)),
            Operation::Difference => self.builder.add(Node::Difference(solids)),
            Operation::Union | Operation::Extrude(_) | Operation::Offset(_) | Operation::Fill => {
                self.builder.add(Node::Union(solids))
            }
            Operation::Move(transform) => {
                let all = self.union(solids);
                self.builder.add(Node::Instance(transform.clone(), all))
            }
            Operation::Paint(material) => {
                let all = self.union(solids);
                self.builder.add(Node::Painted(*material, all))
            }
            Operation::Hull => return self.hull(frame, &solids),
            Operation::Minkowski => return self.solid_sum(frame, &solids),
            Operation::Resize(resize) => {
                let all = self.union(solids);
                return self.resized(frame, all, resize);
            }
            Operation::Projection { cut } => {
                let all = self.union(solids);
                return self.projection(frame, all, *cut);
            }
        })
    }

    /// What a closed form gave.
    pub(super) fn made(&mut self, frame: &Frame, made: Made) -> Operand {
        match made {
            Ok(Some(solid)) => Operand::Solid(solid),
            Ok(None) => Operand::Nothing,
            Err(error) => {
                self.complaints.error(frame.name, error.to_string(), None);
                Operand::Unusable
            }
        }
    }

    /// Warns that a node has no closed form and became something flat within a distance.
    pub(super) fn approximate(&mut self, frame: &Frame, what: &str, error: f64) {
        // A node of many parts is told once.
        if !self.approximated.insert(frame.name.range().start) {
            return;
        }
        let name = frame.name.of(self.text);
        self.complaints.warn_once(
            &format!("approximate {name} {what}"),
            frame.name,
            format!(
                "`{name}` has no closed form here; it is taken as a {what} within {error:.2e} of it"
            ),
            None,
        );
    }

    /// An error: a node's result could not be made.
    pub(super) fn not_closed(&mut self, frame: &Frame) -> Operand {
        let name = frame.name.of(self.text);
        self.complaints.error_once(
            &format!("intricate {name}"),
            frame.name,
            format!("`{name}` of what stands here is unbounded or too intricate"),
            Some("write the result as a union of shapes".to_owned()),
        );
        Operand::Unusable
    }

    /// An error: numbers are too large or too small.
    pub(super) fn out_of_range(&mut self, frame: &Frame) -> Operand {
        let name = frame.name.of(self.text);
        let message = format!("numbers below `{name}` are beyond floating point");
        self.complaints.error(frame.name, message, None);
        Operand::Unusable
    }

    /// A polyhedron from polygons that close, counter-clockwise from outside.
    pub(super) fn closed_polyhedron(&mut self, polygons: Vec<Vec<glam::DVec3>>) -> Option<NodeId> {
        let polyhedron = polyhedron::dented(polygons).ok()?;
        Some(polyhedron.add_to(&mut self.builder))
    }

    /// The union, without a node of its own if there is only one.
    pub(super) fn union(&mut self, solids: Vec<NodeId>) -> NodeId {
        match solids[..] {
            [only] => only,
            _ => self.builder.add(Node::Union(solids)),
        }
    }

    /// `at`: the first node that makes it a figure.
    fn combine_figures(&mut self, frame: &Frame, figures: Vec<FigureId>, at: Span) -> Operand {
        let is_alone = figures.len() == 1;
        let figure = match &frame.operation {
            Operation::Intersection if !is_alone => self.figures.add(Figure::Intersection(figures)),
            Operation::Difference if !is_alone => self.figures.add(Figure::Difference(figures)),
            Operation::Union
            | Operation::Intersection
            | Operation::Difference
            | Operation::Paint(_) => self.figures.union(figures),
            Operation::Move(transform) => {
                let all = self.figures.union(figures);
                let Some(by) = in_plane(transform) else {
                    let message = "the matrix flattens these 2-D nodes; they are left out";
                    self.complaints.warn(frame.name, message, None);
                    return Operand::Nothing;
                };
                self.figures.add(Figure::Moved(by, all))
            }
            Operation::Extrude(extrusion) => {
                let all = self.figures.union(figures);
                return self.extrude(frame, all, extrusion, at);
            }
            Operation::Hull => {
                let all = self.figures.union(figures);
                let found = self.figures.hull(all);
                return self.found(frame, found, at);
            }
            Operation::Offset(by) => {
                let all = self.figures.union(figures);
                let found = self.figures.offset(all, *by);
                return self.found(frame, found, at);
            }
            Operation::Fill => {
                let all = self.figures.union(figures);
                let found = self.figures.fill(all);
                return self.found(frame, found, at);
            }
            Operation::Minkowski => return self.figure_sum(frame, figures, at),
            Operation::Resize(resize) => {
                let all = self.figures.union(figures);
                self.resized_figure(all, resize)
            }
            // Only solids are projected; a warning was given.
            Operation::Projection { .. } => return Operand::Nothing,
        };
        Operand::Flat(figure, at)
    }

    fn extrude(
        &mut self,
        frame: &Frame,
        figure: FigureId,
        extrusion: &Extrusion,
        at: Span,
    ) -> Operand {
        match figure::extrude(&self.figures, figure, extrusion, &mut self.builder) {
            Ok(Some(solid)) => Operand::Solid(solid),
            Ok(None) => Operand::Nothing,
            Err(Refusal::AcrossTheAxis) => {
                self.complaints.error(
                    at,
                    "what rotate_extrude turns must lie on one side of the y axis, and this \
                     lies on both",
                    "cut it at x = 0".to_owned(),
                );
                Operand::Unusable
            }
            Err(Refusal::Twisted) => {
                self.complaints.error(
                    frame.name,
                    "the figure is twisted so much from slice to slice that it crosses itself",
                    "use more slices".to_owned(),
                );
                Operand::Unusable
            }
            Err(Refusal::Numbers(error)) => {
                self.complaints.error(frame.name, error.to_string(), None);
                Operand::Unusable
            }
        }
    }

    fn figure_sum(&mut self, frame: &Frame, figures: Vec<FigureId>, at: Span) -> Operand {
        let mut figures = figures.into_iter();
        let Some(mut sum) = figures.next() else {
            return Operand::Nothing;
        };
        let mut is_exact = true;
        for figure in figures {
            match self.figures.minkowski(sum, figure) {
                None => return self.not_closed(frame),
                Some((None, _)) => return Operand::Nothing,
                Some((Some(found), exact)) => {
                    sum = found;
                    is_exact &= exact;
                }
            }
        }
        self.found(frame, (Some(sum), is_exact), at)
    }

    /// A figure, with a warning unless it is exact.
    fn found(
        &mut self,
        frame: &Frame,
        (figure, exact): (Option<FigureId>, bool),
        at: Span,
    ) -> Operand {
        let Some(figure) = figure else {
            return Operand::Nothing;
        };
        if !exact {
            let error = self.figures.sagitta(figure);
            self.approximate(frame, "polygon", error);
        }
        Operand::Flat(figure, at)
    }
}

/// What a transform does in the plane z = 0, seen from above, if it does not flatten it.
fn in_plane(transform: &Transform) -> Option<DAffine2> {
    let [x, y, ..] = transform.to_columns();
    let matrix = DMat2::from_cols(DVec2::new(x[0], y[0]), DVec2::new(x[1], y[1]));
    let by = DAffine2::from_mat2_translation(matrix, DVec2::new(x[3], y[3]));
    let size = matrix.x_axis.length() * matrix.y_axis.length();
    (matrix.determinant().abs() > 1e-12 * size && by.is_finite()).then_some(by)
}

/// The nodes of a formula.
pub(super) fn formula(parts: Vec<Part>, builder: &mut ModelBuilder) -> NodeId {
    let mut open: Vec<(bool, Vec<NodeId>)> = vec![(true, Vec::new())];
    for part in parts {
        let node = match part {
            Part::Open { union } => {
                open.push((union, Vec::new()));
                continue;
            }
            Part::Shape { shape, inside } => {
                let shape = builder.add(Node::Shape(shape));
                if inside {
                    shape
                } else {
                    builder.add(Node::Complement(shape))
                }
            }
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
    match all[..] {
        [only] => only,
        _ => builder.add(Node::Union(all)),
    }
}
