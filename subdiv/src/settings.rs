//! What a run may be asked for, and what it reports.

use crate::Criterion;
use csg::PrimitiveId;
use glam::DVec3;

/// When subdivision ends.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Rule {
    /// When mesh and true boundary are proved to be at most this far apart, in model units.
    Tolerance(f64),
    /// When the interpolants are proved to have the solid's topology: components, holes, faces,
    /// creases and corners, whatever the deviation (`docs/topology.md`). Cells no larger than
    /// `finest`, in model units, are not bisected any more but listed.
    Topology {
        /// The longest edge of the finest cells.
        finest: f64,
    },
    /// At this bisection level everywhere on the boundary (three levels halve the cells).
    Level(u8),
}

/// How to subdivide.
#[derive(Clone, PartialEq, Debug)]
pub struct Settings {
    /// When to stop.
    pub rule: Rule,
    /// Deepest level that a rule may lead to; `None`: the one at which cells are as small as the
    /// tolerance, or the finest cell.
    pub max_level: Option<u8>,
    /// How polynomials are bounded.
    pub criterion: Criterion,
    /// Number of threads; `None`: one for each core.
    pub threads: Option<usize>,
    /// Most leaves that meet the boundary.
    pub max_cells: u64,
    /// Most memory that the subdivision may take, by estimate.
    pub max_memory_bytes: u64,
}

impl Settings {
    /// The usual settings with this rule.
    #[must_use]
    pub fn new(rule: Rule) -> Self {
        Self {
            rule,
            max_level: None,
            criterion: Criterion::Bezier,
            threads: None,
            max_cells: 100_000_000,
            max_memory_bytes: 16 << 30,
        }
    }
}

/// Why a leaf was not certified.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reason {
    /// A primitive's gradient nearly vanishes or turns too much: a singular point.
    Singular,
    /// Surfaces meet at too small an angle, or nearly touch.
    Tangent,
    /// More surfaces meet than the certificate handles.
    Crowded,
    /// Four surfaces pass through one point, or nearly.
    Concurrent,
    /// The solid comes close to the domain's walls.
    Wall,
}

/// A leaf at the deepest level for which the rule proves nothing.
#[derive(Clone, PartialEq, Debug)]
pub struct Spot {
    /// Its middle, in model units.
    pub position: DVec3,
    /// Its longest edge, in model units.
    pub size: f64,
    /// The primitives involved.
    pub primitives: Vec<PrimitiveId>,
    /// What went wrong.
    pub reason: Reason,
}

/// What happened.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Report {
    /// Bisections made in the final traversal.
    pub bisections: u64,
    /// Leaves that meet the boundary.
    pub leaves: u64,
    /// Simplices visited in both traversals.
    pub visited: u64,
    /// Midpoints inserted by the closure beyond those that the rule asked for.
    pub balance_points: u64,
    /// Deepest level of a leaf.
    pub deepest_level: u8,
    /// Largest proved distance between mesh and true boundary over all certified leaves, in model
    /// units, rounding included; `None` when no leaf was tested (fixed level).
    pub largest_deviation: Option<f64>,
    /// Whether the topology is proved everywhere; `None` when another rule decided.
    pub proved_topology: Option<bool>,
    /// Extractions that were repeated since a leaf of the closure failed the rule.
    pub rounds: u64,
    /// Proved bounds of the true solid's volume, in model units; `None` with the topological rule.
    pub volume_interval: Option<[f64; 2]>,
    /// Number of certified leaves in whose neighbourhood only the mesh is proved to be near the
    /// true boundary, not the other way round.
    pub one_way_leaves: u64,
    /// Number of leaves that are not certified.
    pub uncertified_leaves: u64,
    /// The first of them, at most [`MAX_SPOTS`].
    pub uncertified: Vec<Spot>,
    /// Closed pieces as small as the leaves that are not certified, beside such leaves, that were
    /// dropped: at a cone's apex, or where surfaces touch.
    pub specks: u64,
    /// Faces like that which became part of a neighbour.
    pub crumbs: u64,
    /// Vertices duplicated since the boundary touches itself there.
    pub split_vertices: u64,
    /// Leaves in which triangles of different surfaces cross by rounding of their positions;
    /// otherwise none do anywhere.
    pub crossing_leaves: u64,
    /// Seconds taken by: proving (first traversal), balancing, extraction.
    pub seconds: [f64; 3],
}

/// Most uncertified leaves listed one by one.
pub const MAX_SPOTS: usize = 1000;

/// Receives progress; also asked whether to go on.
pub trait Observer: Sync {
    /// A stage begins, of `total` steps where known.
    fn stage(&self, name: &str, total: Option<u64>);
    /// So many more steps are done.
    fn advance(&self, steps: u64);
    /// Whether the user wants to stop.
    fn cancelled(&self) -> bool;
}

/// Watches nothing.
impl Observer for () {
    fn stage(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        false
    }
}
