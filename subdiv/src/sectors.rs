//! The thesis' own subdivision: given simplices, each bisected to a uniform level, with its
//! statistics, its two stages and its early stop (thesis 4.3 and A.3.2).
//!
//! [`convert`](crate::convert) decides by proofs and moves vertices onto the surfaces. Here the
//! level decides, vertices lie on the affine interpolants, and primitives come as Bernstein
//! coefficients. Triangles close where all minimal simplices have one size: without
//! [`SectorRule::linear_levels`] and [`SectorRule::max_primitives`].

use crate::Criterion;
use crate::blossom::RootCoefficients;
use crate::error::Error;
use crate::fragments::Fragments;
use crate::lattice::MAX_LEVEL;
use crate::mesh::join;
use crate::simplex::Simplex;
use csg::{FormulaNode, MaterialId, Polynomial, Primitive, PrimitiveId};
use descent::Descent;
use glam::DVec3;

mod descent;

/// The material of triangles in cells where several primitives make the boundary.
pub const HYBRID: MaterialId = MaterialId(u32::MAX);

/// When subdivision ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SectorRule {
    /// Bisections from a sector to its smallest simplices (-N), at most [`MAX_LEVEL`].
    pub levels: u8,
    /// The last so many of them are made only where several primitives meet, with affine
    /// interpolants in the place of polynomials (-M).
    pub linear_levels: u8,
    /// Simplices with at most so many primitives are not bisected (-P); 0: none.
    pub max_primitives: usize,
    /// How polynomials are bounded.
    pub criterion: Criterion,
    /// Most front simplices.
    pub max_cells: u64,
}

/// What to collect besides the statistics.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Collect {
    /// Triangles.
    Faces,
    /// The bintree.
    Tree,
    /// Nothing.
    Nothing,
}

/// A simplex to begin with.
#[derive(Clone, PartialEq, Debug)]
pub struct SectorRoot {
    /// Which of the six simplices of the unit cube stands for it; no two of one call may be the
    /// same. Triangles of neighbours are joined.
    pub root: usize,
    /// Degree and Bernstein coefficients of each primitive, indexed by [`PrimitiveId`].
    pub primitives: Vec<(usize, Vec<f64>)>,
}

/// A simplex of the bintree, in prefix order.
#[derive(Clone, PartialEq, Debug)]
pub enum SectorNode {
    /// Inside.
    Full,
    /// Outside.
    Empty,
    /// Bisected: near and far child follow.
    Mixed,
    /// Neither, and not bisected.
    Front {
        /// What is left of the formula.
        formula: Vec<FormulaNode>,
        /// Degree and Bernstein coefficients of its primitives in the simplex.
        primitives: Vec<(PrimitiveId, usize, Vec<f64>)>,
    },
}

/// What happened at one level.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct LevelCount {
    /// Simplices classified.
    pub simplices: u64,
    /// Those that the boundary may cross.
    pub cut: u64,
    /// Those that were bisected.
    pub mixed: u64,
    /// Those that were bisected although no descendant is left that the boundary may cross.
    pub wasted: u64,
    /// Primitives classified.
    pub primitives: u64,
    /// Those whose zero set may cross the simplex and matter there.
    pub primitives_cut: u64,
}

impl LevelCount {
    /// Adds the counts of another level.
    pub fn add(&mut self, other: &Self) {
        self.simplices += other.simplices;
        self.cut += other.cut;
        self.mixed += other.mixed;
        self.wasted += other.wasted;
        self.primitives += other.primitives;
        self.primitives_cut += other.primitives_cut;
    }
}

/// What subdivision yields.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct SectorOutcome {
    /// Counts, indexed by the number of levels that are left: the sectors' own come last.
    pub levels: Vec<LevelCount>,
    /// Triangles, in the unit cube's coordinates.
    pub faces: Fragments,
    /// The bintrees, one for each root.
    pub trees: Vec<Vec<SectorNode>>,
}

/// Subdivides.
///
/// # Errors
/// [`Error::Level`], [`Error::TooManyCells`], [`Error::TooManySurfaces`] with a place in the unit
/// cube.
pub fn subdivide(
    formula: &[FormulaNode],
    roots: &[SectorRoot],
    rule: &SectorRule,
    collect: Collect,
) -> Result<SectorOutcome, Error> {
    if rule.levels > MAX_LEVEL {
        return Err(Error::Level {
            asked: rule.levels,
            deepest: MAX_LEVEL,
        });
    }
    let mut outcome = SectorOutcome {
        levels: vec![LevelCount::default(); usize::from(rule.levels) + 1],
        ..SectorOutcome::default()
    };
    let mut meshes = Vec::with_capacity(roots.len());
    let mut cells = 0;
    for sector in roots {
        let Some(simplex) = Simplex::roots().get(sector.root).copied() else {
            continue;
        };
        let mut descent = Descent::new(*rule, collect, simplex, &mut outcome.levels, cells);
        descent.run(formula, &sector.primitives)?;
        cells = descent.cells();
        let (mesh, nodes) = descent.finish();
        meshes.push(mesh);
        outcome.trees.push(nodes);
    }
    (outcome.faces, _) = join(meshes, |unit| unit);
    Ok(outcome)
}

/// Bernstein coefficients of a polynomial, given in the centred coordinates of a cube, −1 to 1, on
/// its six simplices in the order of [`sector_corners`].
#[must_use]
pub fn bernstein_on_cube(polynomial: &Polynomial) -> [Vec<f64>; 6] {
    RootCoefficients::new(&Primitive {
        polynomial: polynomial.clone(),
        coefficient_error: 0.0,
    })
    .roots
}

/// Corners v0 … v3 of the six simplices of the unit cube.
#[must_use]
pub fn sector_corners() -> [[DVec3; 4]; 6] {
    Simplex::roots().map(|simplex| simplex.vertices.map(crate::lattice::Point::position))
}

#[cfg(test)]
mod tests;
