//! From [`Ast`] to [`csg::Model`], in one pass over the prefix order, without recursion.

use super::arguments::Arguments;
use super::ast::{Ast, Call};
use super::color;
use super::complaints::{Complaints, Reported};
use super::motion::{self, Moved};
use super::nodes::{self, Entry, Kind};
use super::shapes::{ShapeReader, Volume};
use super::token::Span;
use crate::read::ReadOptions;
use crate::read::diagnostic::{Diagnostic, Diagnostics, Source};
use csg::{MaterialId, Model, ModelBuilder, Node, NodeId, Transform};

/// Builds the model; the second part are warnings.
///
/// # Errors
/// Every error found, up to a limit.
pub(super) fn evaluate(
    text: &str,
    ast: &Ast,
    source: &Source<'_>,
    options: ReadOptions,
) -> Result<(Model, Vec<Diagnostic>), Diagnostics> {
    let mut evaluator = Evaluator {
        text,
        ast,
        shapes: ShapeReader::new(options.facet_limit, options.max_degree),
        complaints: Complaints::new(source),
        builder: ModelBuilder::new(),
        operands: Vec::new(),
        frames: Vec::new(),
    };
    let result = evaluator.run();
    let mut builder = evaluator.builder;
    let mut complaints = evaluator.complaints;
    let root = match result {
        Operand::Solid(root) => root,
        Operand::Nothing | Operand::Unusable => builder.add(Node::Union(Vec::new())),
        Operand::Flat(at) => {
            let name = at.of(text);
            complaints.error(
                at,
                format!("the model is 2-D only: `{name}` has no volume"),
                "only 3-D models can be converted; linear_extrude and rotate_extrude are not \
                 supported yet"
                    .to_owned(),
            );
            builder.add(Node::Union(Vec::new()))
        }
    };
    let (errors, warnings) = complaints.finish();
    match Diagnostics::new(errors) {
        Some(errors) => Err(errors),
        None => Ok((builder.finish(root), warnings)),
    }
}

/// The value of a subtree.
#[derive(Clone, Copy)]
enum Operand {
    /// No point, as an empty `group` has it.
    Nothing,
    /// A solid.
    Solid(NodeId),
    /// A plane figure; the place of the first node that makes it one.
    Flat(Span),
    /// An error was reported.
    Unusable,
}

/// A node whose children are being evaluated.
struct Frame {
    operation: Operation,
    /// Index after its subtree.
    end: u32,
    /// Number of operands before its own.
    first: usize,
}

enum Operation {
    Union,
    Intersection,
    Difference,
    Move(Transform),
    Paint(MaterialId),
}

struct Evaluator<'a, 's> {
    text: &'a str,
    ast: &'a Ast,
    shapes: ShapeReader,
    complaints: Complaints<'s>,
    builder: ModelBuilder,
    operands: Vec<Operand>,
    frames: Vec<Frame>,
}

impl Evaluator<'_, '_> {
    fn run(&mut self) -> Operand {
        let (mut at, end) = self.model();
        self.frames.push(Frame {
            operation: Operation::Union,
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
        match entry.kind {
            Kind::NotYet => {
                let name = entry.name;
                self.complaints.error_once(
                    name,
                    call.name,
                    format!("`{name}` is not supported yet"),
                    Some(
                        "remove it, or write the part as a union or intersection of shapes"
                            .to_owned(),
                    ),
                );
                return Err(Reported);
            }
            Kind::Flat => return Ok(Step::Done(Operand::Flat(call.name))),
            _ => {}
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
            Kind::Leaf(leaf) => {
                let volume = self.shapes.read(leaf, &arguments, complaints)?;
                if !is_leaf {
                    let message = format!("`{}` has no children; they are ignored", entry.name);
                    complaints.warn(call.name, message, None);
                }
                Step::Done(match volume {
                    Volume::Shape(shape) => Operand::Solid(self.builder.add(Node::Shape(shape))),
                    Volume::Nothing => Operand::Nothing,
                    Volume::Everything => {
                        let nothing = self.builder.add(Node::Union(Vec::new()));
                        Operand::Solid(self.builder.add(Node::Complement(nothing)))
                    }
                })
            }
            Kind::Union | Kind::Flat | Kind::NotYet => Step::Open(Operation::Union),
        })
    }

    fn unknown(&mut self, at: Span) {
        let name: String = at.of(self.text).chars().take(60).collect();
        let remedy = nodes::nearest_node(&name).map(|known| format!("did you mean `{known}`?"));
        let message = format!("unknown node `{name}`");
        self.complaints.error_once(&name, at, message, remedy);
    }

    /// Combines the operands of a node whose children are all evaluated.
    fn close(&mut self, frame: &Frame) -> Operand {
        let operands = self
            .operands
            .split_off(frame.first.min(self.operands.len()));
        if operands.iter().any(|o| matches!(o, Operand::Unusable)) {
            return Operand::Unusable;
        }
        let first_dimension = operands.iter().find(|o| !matches!(o, Operand::Nothing));
        if let Some(&Operand::Flat(at)) = first_dimension {
            if operands.iter().any(|o| matches!(o, Operand::Solid(_))) {
                let message = "2-D and 3-D nodes are mixed: after this 2-D one, the 3-D ones are left out, as in OpenSCAD";
                self.complaints.warn(at, message, None);
            }
            return Operand::Flat(at);
        }
        let empty_first = matches!(operands.first(), None | Some(Operand::Nothing));
        let any_empty = operands.iter().any(|o| matches!(o, Operand::Nothing));
        let mut solids = Vec::with_capacity(operands.len());
        for operand in operands {
            match operand {
                Operand::Solid(id) => solids.push(id),
                Operand::Flat(at) => {
                    let name = at.of(self.text);
                    let message =
                        format!("`{name}` is 2-D among 3-D nodes; it is left out, as in OpenSCAD");
                    self.complaints.warn(at, message, None);
                }
                Operand::Nothing | Operand::Unusable => {}
            }
        }
        let Some(&first) = solids.first() else {
            return Operand::Nothing;
        };
        let is_alone = solids.len() == 1;
        Operand::Solid(match &frame.operation {
            Operation::Difference if empty_first => return Operand::Nothing,
            Operation::Intersection if any_empty => return Operand::Nothing,
            Operation::Union | Operation::Intersection | Operation::Difference if is_alone => first,
            Operation::Intersection => self.builder.add(Node::Intersection(solids)),
            Operation::Difference => self.builder.add(Node::Difference(solids)),
            Operation::Union => self.builder.add(Node::Union(solids)),
            Operation::Move(transform) => {
                let all = self.union(solids);
                self.builder.add(Node::Instance(transform.clone(), all))
            }
            Operation::Paint(material) => {
                let all = self.union(solids);
                self.builder.add(Node::Painted(*material, all))
            }
        })
    }

    fn union(&mut self, solids: Vec<NodeId>) -> NodeId {
        match solids[..] {
            [only] => only,
            _ => self.builder.add(Node::Union(solids)),
        }
    }
}

/// What a visited node asks for.
enum Step {
    /// Evaluate the children and combine them.
    Open(Operation),
    /// The subtree has this value.
    Done(Operand),
}
