//! What becomes of a node's children once they are all evaluated.

use super::evaluate::{Evaluator, Frame, Operand};
use super::figure::{self, Extrusion, Figure, FigureId, Refusal, Unhullable};
use super::point_hull::{self, NoHull};
use super::polyhedron::Part;
use super::token::Span;
use csg::{MaterialId, Node, NodeId, Shape, Transform};
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
        let flat_at = if extrudes {
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
            Operation::Union | Operation::Intersection | Operation::Difference if is_alone => first,
            Operation::Intersection => self.builder.add(Node::Intersection(solids)),
            Operation::Difference => self.builder.add(Node::Difference(solids)),
            Operation::Union | Operation::Extrude(_) => self.builder.add(Node::Union(solids)),
            Operation::Move(transform) => {
                let all = self.union(solids);
                self.builder.add(Node::Instance(transform.clone(), all))
            }
            Operation::Paint(material) => {
                let all = self.union(solids);
                self.builder.add(Node::Painted(*material, all))
            }
            Operation::Hull => return self.hull(frame, &solids),
        })
    }

    fn hull(&mut self, frame: &Frame, solids: &[NodeId]) -> Operand {
        let found = point_hull::vertices(&self.builder, solids);
        let what = match found {
            Err(NoHull::Curved) => "of solids that have curved faces or are cut",
            Err(NoHull::Many) => "of solids with so many vertices",
            Ok(points) => {
                let Some(mut faces) = point_hull::triangles(&points) else {
                    return Operand::Nothing;
                };
                let vertices = point_hull::used(&points, &mut faces);
                return match Shape::convex_polyhedron(&vertices, &faces) {
                    Ok(shape) => Operand::Solid(self.builder.add(Node::Shape(shape))),
                    Err(error) => {
                        self.complaints.error(frame.name, error.to_string(), None);
                        Operand::Unusable
                    }
                };
            }
        };
        self.complaints.error_once(
            &format!("hull {what}"),
            frame.name,
            format!("`hull` {what} is not supported"),
            Some("write the hull as a union of shapes".to_owned()),
        );
        Operand::Unusable
    }

    /// The nodes of a formula.
    pub(super) fn formula(&mut self, parts: Vec<Part>) -> NodeId {
        let mut open: Vec<(bool, Vec<NodeId>)> = vec![(true, Vec::new())];
        for part in parts {
            let node = match part {
                Part::Open { union } => {
                    open.push((union, Vec::new()));
                    continue;
                }
                Part::Shape { shape, inside } => {
                    let shape = self.builder.add(Node::Shape(shape));
                    if inside {
                        shape
                    } else {
                        self.builder.add(Node::Complement(shape))
                    }
                }
                Part::Close => match open.pop() {
                    Some((true, all)) => self.builder.add(Node::Union(all)),
                    Some((false, all)) => self.builder.add(Node::Intersection(all)),
                    None => continue,
                },
            };
            if let Some((_, all)) = open.last_mut() {
                all.push(node);
            }
        }
        let all = open.pop().map(|(_, all)| all).unwrap_or_default();
        self.union(all)
    }

    fn union(&mut self, solids: Vec<NodeId>) -> NodeId {
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
                match self.figures.hull(all) {
                    Ok(Some(hull)) => hull,
                    Ok(None) => return Operand::Nothing,
                    Err(why) => return self.no_hull(frame, why),
                }
            }
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
            Err(Refusal::Numbers(error)) => {
                self.complaints.error(frame.name, error.to_string(), None);
                Operand::Unusable
            }
        }
    }

    fn no_hull(&mut self, frame: &Frame, why: Unhullable) -> Operand {
        let what = match why {
            Unhullable::Cut => "of intersections and differences",
            Unhullable::Ellipse => "of stretched circles",
            Unhullable::Many => "of more than 200 circles and points",
        };
        self.complaints.error_once(
            &format!("hull {what}"),
            frame.name,
            format!("`hull` {what} is not supported"),
            Some("write the resulting outline as polygons and circles".to_owned()),
        );
        Operand::Unusable
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
