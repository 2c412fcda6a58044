//! From [`Ast`] to [`csg::Model`], in one pass over the prefix order, without recursion.

use super::arguments::Arguments;
use super::ast::{Ast, Call};
use super::color;
use super::combine::Operation;
use super::complaints::{Complaints, Reported};
use super::figure::{self, Figure, FigureId, Figures};
use super::motion::{self, Moved};
use super::nodes::{self, Entry, Kind};
use super::reshape::Resize;
use super::shapes::{ShapeReader, Volume};
use super::token::Span;
use crate::read::diagnostic::{Diagnostics, Source};
use crate::read::{Files, ReadOptions, Reading};
use csg::{ModelBuilder, Node, NodeId};
use std::collections::BTreeSet;

/// Builds the model; the second part are warnings.
///
/// # Errors
/// Every error found, up to a limit.
pub(super) fn evaluate(
    text: &str,
    ast: &Ast,
    source: &Source<'_>,
    options: ReadOptions,
    files: &dyn Files,
) -> Result<Reading, Diagnostics> {
    let mut evaluator = Evaluator {
        text,
        ast,
        shapes: ShapeReader::new(options.facet_limit, options.max_degree, files),
        complaints: Complaints::new(source),
        builder: ModelBuilder::new(),
        figures: Figures::default(),
        operands: Vec::new(),
        frames: Vec::new(),
        approximated: BTreeSet::new(),
    };
    let result = evaluator.run();
    let approximated_nodes = evaluator.approximated.len() as u64;
    let mut builder = evaluator.builder;
    let mut complaints = evaluator.complaints;
    let root = match result {
        Operand::Solid(root) => root,
        Operand::Nothing | Operand::Unusable => builder.add(Node::Union(Vec::new())),
        Operand::Flat(_, at) => {
            let name = at.of(text);
            complaints.error(
                at,
                format!("the model is 2-D only: `{name}` has no volume"),
                "make a solid of it with linear_extrude or rotate_extrude".to_owned(),
            );
            builder.add(Node::Union(Vec::new()))
        }
    };
    let (errors, warnings) = complaints.finish();
    match Diagnostics::new(errors) {
        Some(errors) => Err(errors),
        None => Ok(Reading {
            model: builder.finish(root),
            warnings,
            approximated_nodes,
        }),
    }
}

/// The value of a subtree.
#[derive(Clone, Copy)]
pub(super) enum Operand {
    /// No point, as an empty `group` has it.
    Nothing,
    /// A solid.
    Solid(NodeId),
    /// A plane figure; the place of the first node that makes it one.
    Flat(FigureId, Span),
    /// An error was reported.
    Unusable,
}

/// A node whose children are being evaluated.
pub(super) struct Frame {
    pub(super) operation: Operation,
    /// Its name; empty for the whole file.
    pub(super) name: Span,
    /// Index after its subtree.
    end: u32,
    /// Number of operands before its own.
    pub(super) first: usize,
}

pub(super) struct Evaluator<'a, 's> {
    pub(super) text: &'a str,
    ast: &'a Ast,
    shapes: ShapeReader<'s>,
    pub(super) complaints: Complaints<'s>,
    pub(super) builder: ModelBuilder,
    pub(super) figures: Figures,
    pub(super) operands: Vec<Operand>,
    frames: Vec<Frame>,
    /// Where nodes stand for which something flat was taken.
    pub(super) approximated: BTreeSet<usize>,
}

impl Evaluator<'_, '_> {
    fn run(&mut self) -> Operand {
        let (mut at, end) = self.model();
        self.frames.push(Frame {
            operation: Operation::Union,
            name: Span::default(),
            end,
            first: 0,
        });
        while let Some(frame) = self.frames.last() {
            if at >= frame.end {
                if let Some(frame) = self.frames.pop() {
                    let value = self.close(&frame);
                    self.operands.push(value);
                }
            } else if let Some(call) = self.ast.nodes.get(at as usize) {
                at = self.visit(at, call);
            } else {
                break;
            }
            if self.complaints.are_too_many() {
                return Operand::Unusable;
            }
        }
        self.operands.pop().unwrap_or(Operand::Nothing)
    }

    /// The nodes that make up the model: all, or the first `!` subtree.
    fn model(&mut self) -> (u32, u32) {
        let count = u32::try_from(self.ast.nodes.len()).unwrap_or(u32::MAX);
        if count == 0 {
            let message = "the file holds no nodes; the model is empty";
            self.complaints.warn(Span::default(), message, None);
        }
        let mut root = None;
        let mut at = 0;
        while let Some(call) = self.ast.nodes.get(at as usize) {
            if call.modifiers.root && !call.modifiers.disabled {
                if root.is_some() {
                    let message = "a second root modifier `!` is ignored";
                    self.complaints.warn(call.name, message, None);
                    break;
                }
                root = Some((at, call.end));
            }
            at = if call.modifiers.disabled {
                call.end
            } else {
                at + 1
            };
        }
        root.unwrap_or((0, count))
    }

    /// Begins or evaluates the node at an index; the next index to visit.
    fn visit(&mut self, at: u32, call: &Call) -> u32 {
        if call.modifiers.removed {
            return call.end;
        }
        let Some(entry) = nodes::find(call.name.of(self.text)) else {
            self.unknown(call.name);
            self.operands.push(Operand::Unusable);
            return call.end;
        };
        let is_leaf = call.end == at + 1;
        let value = match self.value_or_operation(call, is_leaf, entry) {
            Ok(Step::Open(operation)) => {
                self.frames.push(Frame {
                    operation,
                    name: call.name,
                    end: call.end,
                    first: self.operands.len(),
                });
                return at + 1;
            }
            Ok(Step::Done(value)) => value,
            Err(Reported) => Operand::Unusable,
        };
        self.operands.push(value);
        call.end
    }

    fn value_or_operation(
        &mut self,
        call: &Call,
        is_leaf: bool,
        entry: &'static Entry,
    ) -> Result<Step, Reported> {
        if let Kind::Refused(remedy) = entry.kind {
            let name = entry.name;
            self.complaints.error_once(
                name,
                call.name,
                format!("`{name}` is not supported"),
                Some(remedy.to_owned()),
            );
            return Err(Reported);
        }
        let complaints = &mut self.complaints;
        let arguments = Arguments::new(self.text, self.ast, call, entry, complaints);
        Ok(match entry.kind {
            Kind::Intersection => Step::Open(Operation::Intersection),
            Kind::Difference => Step::Open(Operation::Difference),
            Kind::Motion(motion) => match motion::read(motion, &arguments, complaints)? {
                Moved::Not => Step::Open(Operation::Union),
                Moved::By(transform) => Step::Open(Operation::Move(transform)),
                Moved::Dropped => Step::Done(Operand::Nothing),
            },
            Kind::Color => Step::Open(match color::read(&arguments, complaints)? {
                Some(material) => Operation::Paint(self.builder.material(material)),
                None => Operation::Union,
            }),
            Kind::LinearExtrude | Kind::RotateExtrude => {
                let sides = self.shapes.sides(&arguments);
                let revolved = entry.kind == Kind::RotateExtrude;
                let extrusion = figure::extrusion(revolved, sides, &arguments, complaints)?;
                Step::Open(Operation::Extrude(extrusion))
            }
            Kind::Hull => Step::Open(Operation::Hull),
            Kind::Minkowski => Step::Open(Operation::Minkowski),
            Kind::Fill => Step::Open(Operation::Fill),
            Kind::Offset => Step::Open(match figure::offset(&arguments, complaints)? {
                Some(by) => Operation::Offset(by),
                None => Operation::Union,
            }),
            Kind::Resize => Step::Open(Operation::Resize(Resize::read(&arguments, complaints)?)),
            Kind::Projection => Step::Open(Operation::Projection {
                cut: arguments.flag("cut", complaints)?,
            }),
            Kind::Figure(leaf) => {
                let sides = self.shapes.sides(&arguments);
                let region = figure::leaf(leaf, sides, &arguments, complaints)?;
                if !is_leaf {
                    childless(entry, call.name, complaints);
                }
                Step::Done(match region {
                    Some(region) => {
                        let id = self.figures.add(Figure::Region(region));
                        Operand::Flat(id, call.name)
                    }
                    None => Operand::Nothing,
                })
            }
            Kind::Text => {
                let regions = figure::text(&arguments, self.shapes.files(), complaints)?;
                let letters = regions.into_iter().map(Figure::Region);
                let letters: Vec<FigureId> = letters.map(|l| self.figures.add(l)).collect();
                Step::Done(if letters.is_empty() {
                    Operand::Nothing
                } else {
                    Operand::Flat(self.figures.union(letters), call.name)
                })
            }
            Kind::Leaf(leaf) => {
                let volume = self.shapes.read(leaf, &arguments, complaints)?;
                if !is_leaf {
                    childless(entry, call.name, complaints);
                }
                Step::Done(match volume {
                    Volume::Shape(shape) => Operand::Solid(self.builder.add(Node::Shape(shape))),
                    Volume::Polyhedron(polyhedron) => {
                        Operand::Solid(polyhedron.add_to(&mut self.builder))
                    }
                    Volume::Nothing => Operand::Nothing,
                    Volume::Everything => {
                        let nothing = self.builder.add(Node::Union(Vec::new()));
                        Operand::Solid(self.builder.add(Node::Complement(nothing)))
                    }
                })
            }
            Kind::Union | Kind::Refused(_) => Step::Open(Operation::Union),
        })
    }

    fn unknown(&mut self, at: Span) {
        let name: String = at.of(self.text).chars().take(60).collect();
        let remedy = nodes::nearest_node(&name).map(|known| format!("did you mean `{known}`?"));
        let message = format!("unknown node `{name}`");
        self.complaints.error_once(&name, at, message, remedy);
    }
}

fn childless(entry: &Entry, at: Span, complaints: &mut Complaints<'_>) {
    let message = format!("`{}` has no children; they are ignored", entry.name);
    complaints.warn(at, message, None);
}

/// What a visited node asks for.
enum Step {
    /// Evaluate the children and combine them.
    Open(Operation),
    /// The subtree has this value.
    Done(Operand),
}
