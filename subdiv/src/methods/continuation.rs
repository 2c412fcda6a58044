//! The continuation method (MAI, Algorithm 2.3) on the triangulations by six tetrahedra a cube.
//!
//! A simplex is its first vertex, an order of the axes and a direction on each; its neighbour
//! across the facet without vertex i follows from integer rules ("pivoting"), without a list of
//! neighbours. The order on the sphere of neighbours is breadth first instead of ProxSimp's walk:
//! the same simplices, and no restart where the domain ends.

use super::complete::{bit, inside};
use super::signs::{Judge, value};
use super::{Cell, Found, Pattern};
use crate::lattice::LATTICE_BITS;
use csg::{Solid, Ternary};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::VecDeque;

/// What the continuation did.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Continuation {
    /// What it found.
    pub found: Found,
    /// Seeds that began a component.
    pub components: u64,
    /// Simplices visited.
    pub simplices: u64,
    /// Primitives times simplices, as the thesis counts.
    pub evaluations: u64,
    /// Polynomial values taken when each vertex is evaluated once.
    pub values: u64,
    /// Facets crossed.
    pub pivots: u64,
}

/// Follows the boundary through a grid of `2^halvings` cubes a side, from each of the seeds that
/// was not reached before; seeds that are not simplices of the grid are passed over.
#[must_use]
pub fn continuation(solid: &Solid, halvings: u8, pattern: Pattern, seeds: &[Cell]) -> Continuation {
    let mut run = Run {
        solid,
        halvings,
        signs: FxHashMap::default(),
        judge: Judge::new(solid.primitives.len()),
        seen: FxHashSet::default(),
        queue: VecDeque::new(),
        done: Continuation::default(),
    };
    for seed in seeds {
        let Some(simplex) = Path::of(seed, halvings, pattern) else {
            continue;
        };
        if run.seen.insert(simplex.clone()) {
            run.done.components += 1;
            run.queue.push_back(simplex);
            run.follow();
        }
    }
    let primitives = solid.primitives.len() as u64;
    run.done.evaluations = run.done.simplices * primitives;
    run.done.values = run.signs.len() as u64 * primitives;
    run.done.found = run.done.found.sorted();
    run.done
}

struct Run<'a> {
    solid: &'a Solid,
    halvings: u8,
    signs: FxHashMap<[i32; 3], Vec<u64>>,
    judge: Judge,
    seen: FxHashSet<Path>,
    queue: VecDeque<Path>,
    done: Continuation,
}

impl Run<'_> {
    fn follow(&mut self) {
        while let Some(simplex) = self.queue.pop_front() {
            self.done.simplices += 1;
            let vertices = simplex.vertices();
            let left = self.undecided(&vertices);
            if left == 0 {
                continue;
            }
            self.done.found.optimal_evaluations += left;
            self.done.found.cells.push(simplex.cell(self.halvings));
            for without in 0..4 {
                let mut facet = vertices.to_vec();
                facet.remove(without);
                let neighbour = simplex.pivot(without);
                if self.undecided(&facet) > 0 && neighbour.is_within(1 << self.halvings) {
                    self.done.pivots += 1;
                    if self.seen.insert(neighbour.clone()) {
                        self.queue.push_back(neighbour);
                    }
                }
            }
        }
    }

    fn undecided(&mut self, vertices: &[[i32; 3]]) -> u64 {
        for vertex in vertices {
            let (solid, halvings) = (self.solid, self.halvings);
            self.signs.entry(*vertex).or_insert_with(|| {
                inside(solid, vertex.map(i32::unsigned_abs), halvings).collect()
            });
        }
        let corners: Vec<&Vec<u64>> = vertices.iter().map(|v| &self.signs[v]).collect();
        for primitive in 0..self.solid.primitives.len() {
            let inside = corners.iter().filter(|c| bit(c, primitive)).count();
            let value: Ternary = value(inside, vertices.len());
            self.judge.note(primitive, value);
        }
        self.judge.undecided(self.solid.formula.nodes())
    }
}

/// A simplex as a path of three unit steps, one along each axis.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub(super) struct Path {
    pattern: Pattern,
    start: [i32; 3],
    order: [usize; 3],
    /// By axis, +1 or −1.
    step: [i32; 3],
}

impl Path {
    /// The simplex with these vertices, if it is one.
    pub(super) fn of(cell: &Cell, halvings: u8, pattern: Pattern) -> Option<Self> {
        let shift = LATTICE_BITS - u32::from(halvings);
        let mut vertices = cell.map(|v| v.map(|c| (c >> shift).cast_signed()));
        match pattern {
            Pattern::Translated => vertices.sort_unstable_by_key(|v| v.iter().sum::<i32>()),
            Pattern::Reflected => {
                vertices.sort_unstable_by_key(|v| v.iter().filter(|c| **c % 2 == 0).count());
            }
            Pattern::Five => return None,
        }
        let mut path = Self {
            pattern,
            start: vertices[0],
            order: [0; 3],
            step: [0; 3],
        };
        for at in 0..3 {
            let axis = (0..3).find(|a| vertices[at][*a] != vertices[at + 1][*a])?;
            path.order[at] = axis;
            path.step[axis] = vertices[at + 1][axis] - vertices[at][axis];
        }
        (path.vertices() == vertices && path.cell(halvings) == *cell).then_some(path)
    }

    pub(super) fn vertices(&self) -> [[i32; 3]; 4] {
        let mut vertices = [self.start; 4];
        let mut at = self.start;
        for (vertex, axis) in vertices[1..].iter_mut().zip(self.order) {
            at[axis] += self.step[axis];
            *vertex = at;
        }
        vertices
    }

    fn cell(&self, halvings: u8) -> Cell {
        let shift = LATTICE_BITS - u32::from(halvings);
        let mut cell = self
            .vertices()
            .map(|v| v.map(|c| c.unsigned_abs() << shift));
        cell.sort_unstable();
        cell
    }

    fn is_within(&self, side: i32) -> bool {
        let mut coordinates = self.vertices().into_iter().flatten();
        coordinates.all(|c| (0..=side).contains(&c))
    }

    /// The neighbour across the facet without vertex number `without`.
    pub(super) fn pivot(&self, without: usize) -> Self {
        let mut next = self.clone();
        let [first, _, last] = self.order;
        match (without, self.pattern) {
            (0, Pattern::Translated) => {
                next.start[first] += 1;
                next.order.rotate_left(1);
            }
            (3, Pattern::Translated) => {
                next.start[last] -= 1;
                next.order.rotate_right(1);
            }
            (0, _) => {
                next.start[first] += 2 * self.step[first];
                next.step[first] = -self.step[first];
            }
            (3, _) => next.step[last] = -self.step[last],
            _ => next.order.swap(without - 1, without),
        }
        next
    }
}
