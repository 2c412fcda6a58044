//! Paths to the smallest simplices instead of their geometry (thesis 6.3.4), to be measured.

use super::Cell;
use super::adaptive::cell;
use crate::Criterion;
use crate::blossom::RootCoefficients;
use crate::simplex::Simplex;
use crate::walk::{Frame, Visitor, Walker};
use csg::Solid;

/// Deepest level of a path: one bit each.
const LONGEST: u8 = 32;

/// The way from a root to one simplex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Path {
    root: u8,
    /// One bit a bisection, the first one highest: whether it goes to the far child.
    far: u32,
}

/// Paths to the simplices of one level that a criterion leaves open, in depth-first order.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Paths {
    level: u8,
    paths: Vec<Path>,
}

/// How the geometry of simplices is found.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Geometry {
    /// Each simplex' from its parent's, kept on a stack: what the descent does.
    Carried,
    /// Each simplex' from the root's, by its path: the thesis' proposal.
    FromPaths,
}

impl Paths {
    /// Subdivides down to `level`, 32 at most.
    #[must_use]
    pub fn new(solid: &Solid, criterion: Criterion, level: u8) -> Self {
        let level = level.min(LONGEST);
        let roots: Vec<_> = solid.primitives.iter().map(RootCoefficients::new).collect();
        let mut walker = Walker::new(solid, criterion, None);
        let mut record = Record {
            root: 0,
            open: Vec::new(),
            paths: Self {
                level,
                paths: Vec::new(),
            },
        };
        for sector in walker.roots(solid, &roots) {
            let all = Simplex::roots();
            let root = all.iter().position(|root| *root == sector.simplex);
            record.root = root.and_then(|at| u8::try_from(at).ok()).unwrap_or(0);
            record.open.clear();
            walker.walk(&sector, &mut record);
        }
        record.paths
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.paths.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.paths.is_empty()
    }

    /// Bytes that one path takes.
    #[must_use]
    pub fn bytes_per_path() -> usize {
        size_of::<Path>()
    }

    /// The simplices, found in one way or the other; the same ones.
    pub fn for_each(&self, geometry: Geometry, mut found: impl FnMut(Cell)) {
        let roots = Simplex::roots();
        let mut line: Vec<Simplex> = Vec::with_capacity(usize::from(self.level) + 1);
        let mut last: Option<Path> = None;
        for path in &self.paths {
            // As many bisections as two neighbours in the order share need not be done again.
            let common = match (geometry, last) {
                (Geometry::Carried, Some(last)) if last.root == path.root => {
                    let unused = 32 - u32::from(self.level);
                    (last.far ^ path.far).leading_zeros() - unused
                }
                _ => 0,
            };
            line.truncate(common as usize + 1);
            if common == 0 {
                line.clear();
                line.push(roots[usize::from(path.root)]);
            }
            let mut simplex = line[line.len() - 1];
            for step in (0..u32::from(self.level) - common).rev() {
                let [near, far] = simplex.children();
                simplex = if path.far >> step & 1 == 1 { far } else { near };
                if geometry == Geometry::Carried {
                    line.push(simplex);
                }
            }
            found(cell(&simplex));
            last = Some(*path);
        }
    }
}

/// Notes the paths.
struct Record {
    root: u8,
    /// The simplices above the one that is visited, and the path to each.
    open: Vec<(Simplex, u32)>,
    paths: Paths,
}

impl Visitor for Record {
    fn visit(&mut self, simplex: &Simplex, _: &mut Frame) -> bool {
        self.open.truncate(usize::from(simplex.level));
        let far = self.open.last().map_or(0, |(parent, path)| {
            path << 1 | u32::from(parent.children()[1] == *simplex)
        });
        if simplex.level == self.paths.level {
            let root = self.root;
            self.paths.paths.push(Path { root, far });
            return false;
        }
        self.open.push((*simplex, far));
        true
    }
}
