//! One sector's bintree, depth first.

use super::{Collect, HYBRID, LevelCount, SectorNode, SectorRule};
use crate::classify::{Class, classify};
use crate::error::Error;
use crate::extract::{Extractor, LeafError};
use crate::halving::halve;
use crate::mesh::MeshBuilder;
use crate::rounding::of_halving;
use crate::simplex::Simplex;
use crate::walk::{Active, Frame};
use csg::{FormulaNode, LocalizeScratch, PrimitiveId, Ternary, localize};

/// A traversal of one sector.
pub(super) struct Descent<'a> {
    rule: SectorRule,
    collect: Collect,
    root: Simplex,
    counts: &'a mut [LevelCount],
    cells: u64,
    mesh: MeshBuilder,
    nodes: Vec<SectorNode>,
    extractor: Extractor,
    /// Two children for each level.
    frames: Vec<[Frame; 2]>,
    /// Parallel to the active primitives of the frame at hand.
    values: Vec<Ternary>,
    pruned: Vec<FormulaNode>,
    linear: Frame,
    scratch: LocalizeScratch,
}

/// How a simplex is treated.
#[derive(Clone, Copy)]
struct Stage {
    /// Levels below it.
    left: u8,
    /// Whether polynomials have become affine (-M).
    linear: bool,
    /// Whether it counts: a plane's triangles are cut where its neighbours' are, but the thesis
    /// visits no simplex for that.
    counted: bool,
}

impl<'a> Descent<'a> {
    pub(super) fn new(
        rule: SectorRule,
        collect: Collect,
        root: Simplex,
        counts: &'a mut [LevelCount],
        cells: u64,
    ) -> Self {
        Self {
            rule,
            collect,
            root,
            counts,
            cells,
            mesh: MeshBuilder::new(&root),
            nodes: Vec::new(),
            extractor: Extractor::default(),
            frames: Vec::new(),
            values: Vec::new(),
            pruned: Vec::new(),
            linear: Frame::default(),
            scratch: LocalizeScratch::default(),
        }
    }

    /// Front simplices so far.
    pub(super) fn cells(&self) -> u64 {
        self.cells
    }

    pub(super) fn finish(mut self) -> (MeshBuilder, Vec<SectorNode>) {
        self.mesh.finish();
        (self.mesh, self.nodes)
    }

    pub(super) fn run(
        &mut self,
        formula: &[FormulaNode],
        primitives: &[(usize, Vec<f64>)],
    ) -> Result<(), Error> {
        let mut frame = Frame::default();
        frame.formula.extend_from_slice(formula);
        for (at, (degree, coefficients)) in primitives.iter().enumerate() {
            let offset = frame.coefficients.len() as u32;
            frame
                .active
                .push(Active::unbounded(at as u32, *degree as u32, offset));
            frame.coefficients.extend_from_slice(coefficients);
        }
        drop_unused(&mut frame);
        let stage = Stage {
            left: self.rule.levels,
            linear: false,
            counted: true,
        };
        let root = self.root;
        self.visit(&root, &mut frame, stage).map(|_| ())
    }

    /// Visits a simplex; whether the boundary may cross one of its smallest descendants.
    ///
    /// The recursion is as deep as there are levels, whatever the input.
    fn visit(
        &mut self,
        simplex: &Simplex,
        frame: &mut Frame,
        mut stage: Stage,
    ) -> Result<bool, Error> {
        let level = usize::from(stage.left);
        if stage.counted {
            self.counts[level].simplices += 1;
            self.counts[level].primitives += frame.active.len() as u64;
        }
        match self.localize(frame, simplex.kind()) {
            Ternary::Unknown => {}
            decided => {
                self.push_node(|| match decided {
                    Ternary::In => SectorNode::Full,
                    _ => SectorNode::Empty,
                });
                return Ok(false);
            }
        }
        if stage.counted {
            self.counts[level].cut += 1;
            self.counts[level].primitives_cut += frame.active.len() as u64;
        }
        let simple = frame.formula.len() == 1;
        let last_levels = self.rule.linear_levels;
        if last_levels > 0 && stage.left == last_levels && !stage.linear && !simple {
            linearize(frame);
            stage.linear = true;
        }
        let at_end = stage.left == 0
            || simple && (stage.linear || stage.left <= self.rule.linear_levels)
            || frame.active.len() <= self.rule.max_primitives;
        let plane = simple && frame.active.iter().all(|a| a.degree == 1);
        if plane && !at_end && self.collect == Collect::Faces {
            stage.counted = false;
        }
        if at_end || plane && self.collect != Collect::Faces {
            return self.front(simplex, frame).map(|()| true);
        }
        self.push_node(|| SectorNode::Mixed);
        let found = self.visit_children(simplex, frame, stage)?;
        if stage.counted {
            self.counts[level].mixed += 1;
            self.counts[level].wasted += u64::from(!found);
        }
        Ok(found)
    }

    fn visit_children(
        &mut self,
        simplex: &Simplex,
        frame: &Frame,
        stage: Stage,
    ) -> Result<bool, Error> {
        let depth = usize::from(self.rule.levels - stage.left);
        if self.frames.len() <= depth {
            self.frames.resize_with(depth + 1, Default::default);
        }
        let mut frames = std::mem::take(&mut self.frames[depth]);
        halve_frame(frame, simplex.kind(), &mut frames);
        let below = Stage {
            left: stage.left - 1,
            ..stage
        };
        let mut found = false;
        for (child, frame) in simplex.children().iter().zip(&mut frames) {
            found |= self.visit(child, frame, below)?;
        }
        self.frames[depth] = frames;
        Ok(found)
    }

    fn push_node(&mut self, node: impl FnOnce() -> SectorNode) {
        if self.collect == Collect::Tree {
            self.nodes.push(node());
        }
    }

    /// Classifies the primitives of a frame and prunes it (Algorithm 4.2).
    fn localize(&mut self, frame: &mut Frame, kind: u8) -> Ternary {
        self.values.clear();
        for at in 0..frame.active.len() {
            let active = frame.active[at];
            let coefficients = frame.coefficients_of(&active);
            let degree = active.degree as usize;
            let class = if degree == 0 {
                // A constant is decided, zero being inside.
                Class::of_constant(coefficients[0])
            } else {
                classify(
                    self.rule.criterion,
                    kind,
                    degree,
                    coefficients,
                    active.error(),
                )
            };
            frame.active[at].largest = class.largest();
            self.values.push(class.value());
        }
        if self.values.iter().all(|v| *v == Ternary::Unknown) {
            return Ternary::Unknown;
        }
        let (active, values) = (&frame.active, &self.values);
        let value = |p: PrimitiveId| {
            let at = active.binary_search_by_key(&p.0, |a| a.primitive);
            at.map_or(Ternary::Unknown, |at| values[at])
        };
        self.pruned.clear();
        let result = localize(&frame.formula, value, &mut self.pruned, &mut self.scratch);
        if result == Ternary::Unknown {
            std::mem::swap(&mut frame.formula, &mut self.pruned);
            drop_unused(frame);
        }
        result
    }

    /// A simplex that is not bisected any more.
    fn front(&mut self, simplex: &Simplex, frame: &Frame) -> Result<(), Error> {
        self.cells += 1;
        if self.cells > self.rule.max_cells {
            let limit = self.rule.max_cells;
            return Err(Error::TooManyCells { limit });
        }
        match self.collect {
            Collect::Nothing => Ok(()),
            Collect::Tree => {
                let primitives = frame.active.iter().map(|active| {
                    let coefficients = frame.coefficients_of(active).to_vec();
                    let degree = active.degree as usize;
                    (PrimitiveId(active.primitive), degree, coefficients)
                });
                self.nodes.push(SectorNode::Front {
                    formula: frame.formula.clone(),
                    primitives: primitives.collect(),
                });
                Ok(())
            }
            Collect::Faces => self.extract(simplex, frame),
        }
    }

    /// The pieces of the affine interpolants' boundary.
    fn extract(&mut self, simplex: &Simplex, frame: &Frame) -> Result<(), Error> {
        let linear = &mut self.linear;
        linear.clone_from(frame);
        linearize(linear);
        let start = self.mesh.triangles.len();
        let extracted = self
            .extractor
            .extract_affine(simplex, linear, &mut self.mesh);
        let left = extracted.map_err(|LeafError::TooManyPrimitives(count)| {
            let place = simplex.vertices[0].position();
            Error::TooManySurfaces {
                count,
                x: place.x,
                y: place.y,
                z: place.z,
            }
        })?;
        if left > 1 {
            for triangle in &mut self.mesh.triangles[start..] {
                triangle.material = HYBRID;
            }
        }
        Ok(())
    }
}

/// Keeps only the active primitives that the formula mentions.
fn drop_unused(frame: &mut Frame) {
    let mut used: Vec<u32> = frame
        .formula
        .iter()
        .filter_map(|node| match node {
            FormulaNode::Literal(literal) => Some(literal.primitive.0),
            _ => None,
        })
        .collect();
    used.sort_unstable();
    frame
        .active
        .retain(|active| used.binary_search(&active.primitive).is_ok());
}

/// Every polynomial becomes its affine interpolant.
fn linearize(frame: &mut Frame) {
    let mut coefficients = Vec::with_capacity(4 * frame.active.len());
    for at in 0..frame.active.len() {
        let values = match frame.active[at].degree {
            0 => [frame.coefficients_of(&frame.active[at])[0]; 4],
            _ => frame.values_of(&frame.active[at]),
        };
        frame.active[at].degree = 1;
        frame.active[at].offset = coefficients.len() as u32;
        coefficients.extend(values);
    }
    frame.coefficients = coefficients;
}

/// The coefficients in both children, with the parent's formula.
fn halve_frame(parent: &Frame, kind: u8, frames: &mut [Frame; 2]) {
    let [near, far] = frames;
    for child in [&mut *near, &mut *far] {
        child.coefficients.clear();
        child.active.clear();
        child.formula.clone_from(&parent.formula);
    }
    for active in &parent.active {
        let degree = active.degree as usize;
        let coefficients = parent.coefficients_of(active);
        let start = near.coefficients.len();
        let end = start + coefficients.len();
        near.coefficients.resize(end, 0.0);
        far.coefficients.resize(end, 0.0);
        halve(
            degree,
            kind,
            coefficients,
            &mut near.coefficients[start..],
            &mut far.coefficients[start..],
        );
        let child = Active {
            offset: start as u32,
            rounding: of_halving(degree, active.rounding, active.largest),
            ..*active
        };
        near.active.push(child);
        far.active.push(child);
    }
}
