//! A `.cspg` file's solid as the subdivision takes it: numbered primitives, a formula, and sectors
//! that share a box.

use csg::{Aabb, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use io::thesis::sectors::{Sector, SectorPrimitive, Sectors, volume};
use std::collections::HashMap;
use subdiv::sectors::{SectorRoot, sector_corners};

use super::csg2cspg::in_box;

/// The solid. A literal's "material" is the place of its primitive in the sectors' lists.
pub(super) struct SectorSolid {
    pub(super) formula: Vec<FormulaNode>,
    pub(super) groups: Vec<Group>,
}

/// Sectors that are subdivided together.
pub(super) struct Group {
    pub(super) roots: Vec<SectorRoot>,
    /// Corners of each sector.
    pub(super) vertices: Vec<[[f64; 3]; 4]>,
    place: Place,
}

/// Where a group is.
enum Place {
    /// Six sectors that are a box.
    Box(Aabb),
    /// One simplex, for which that of this index in the unit cube stands.
    Simplex(usize, [DVec3; 4]),
}

impl SectorSolid {
    pub(super) fn new(solid: &Sectors) -> Self {
        // Where each primitive of the first sector stands in every sector.
        let first = solid.sectors.first();
        let names: Vec<i32> =
            first.map_or_else(Vec::new, |s| s.primitives.iter().map(|p| p.name).collect());
        let sorted: Vec<Vec<&SectorPrimitive>> = solid
            .sectors
            .iter()
            .map(|sector| {
                let by_name: HashMap<i32, &SectorPrimitive> =
                    sector.primitives.iter().map(|p| (p.name, p)).collect();
                let found = names.iter().filter_map(|name| by_name.get(name).copied());
                found.collect()
            })
            .collect();
        let (kept, meaning) = join_equal(&sorted, names.len());
        let place: HashMap<i32, usize> = names
            .iter()
            .enumerate()
            .map(|(at, name)| (*name, at))
            .collect();
        let formula = solid.tree.to_formula(|name| {
            let at = place.get(name).copied().unwrap_or_default();
            let (primitive, sense) = meaning[at];
            Literal {
                primitive: PrimitiveId(number(primitive)),
                sense,
                material: MaterialId(number(at)),
            }
        });
        let roots: Vec<Vec<(usize, Vec<f64>)>> = sorted
            .iter()
            .map(|sector| {
                let kept = kept.iter().filter_map(|at| sector.get(*at));
                kept.map(|p| (p.degree, p.coefficients.clone())).collect()
            })
            .collect();
        Self {
            formula,
            groups: groups(&solid.sectors, roots),
        }
    }
}

fn number(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

/// Primitives whose coefficients are equal in all sectors, or all the negated ones, are one: flush
/// faces then cancel. Returns the places of those that stay, and which of them each one is.
fn join_equal(
    sectors: &[Vec<&SectorPrimitive>],
    count: usize,
) -> (Vec<usize>, Vec<(usize, Sense)>) {
    let mut known: HashMap<Vec<u64>, (usize, bool)> = HashMap::new();
    let mut kept = Vec::new();
    let mut meaning = Vec::with_capacity(count);
    for at in 0..count {
        let polynomials = sectors.iter().filter_map(|sector| sector.get(at));
        let coefficients = || polynomials.clone().flat_map(|p| &p.coefficients);
        // Zero differs only in a sign that means nothing.
        let leading = coefficients().find(|c| **c != 0.0).copied().unwrap_or(1.0);
        let negated = leading < 0.0;
        let sign = if negated { -1.0 } else { 1.0 };
        let degrees = polynomials.clone().map(|p| p.degree as u64);
        let key: Vec<u64> = degrees
            .chain(coefficients().map(|c| (sign * c + 0.0).to_bits()))
            .collect();
        let next = (kept.len(), negated);
        let found = *known.entry(key).or_insert(next);
        if found.0 == kept.len() {
            kept.push(at);
        }
        let sense = if found.1 == negated {
            Sense::Inside
        } else {
            Sense::Outside
        };
        meaning.push((found.0, sense));
    }
    (kept, meaning)
}

/// Six sectors in a row that make a box share their facets; others stand alone.
fn groups(sectors: &[Sector], roots: Vec<Vec<(usize, Vec<f64>)>>) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut roots = roots.into_iter();
    let mut rest = sectors;
    while let Some(first) = rest.first() {
        let (count, place) = if let Some(bounds) = box_of(rest) {
            (6, Place::Box(bounds))
        } else {
            // A simplex of the same handedness stands for it.
            let root = usize::from(volume(&first.vertices) < 0.0);
            (1, Place::Simplex(root, first.vertices.map(DVec3::from)))
        };
        let (these, others) = rest.split_at(count);
        rest = others;
        let offset = match place {
            Place::Box(_) => 0,
            Place::Simplex(root, _) => root,
        };
        groups.push(Group {
            roots: (offset..)
                .zip(roots.by_ref().take(count))
                .map(|(root, primitives)| SectorRoot { root, primitives })
                .collect(),
            vertices: these.iter().map(|s| s.vertices).collect(),
            place,
        });
    }
    groups
}

fn box_of(sectors: &[Sector]) -> Option<Aabb> {
    let six = sectors.get(..6)?;
    let [min, _, _, max] = six[0].vertices.map(DVec3::from);
    let bounds = Aabb { min, max };
    let corners = sector_corners();
    let fits = corners.iter().zip(six).all(|(corners, sector)| {
        corners.map(|c| in_box(&bounds, c)) == sector.vertices.map(DVec3::from)
    });
    fits.then_some(bounds)
}

impl Group {
    /// A point of the unit cube in model units.
    pub(super) fn to_model(&self, unit: DVec3) -> DVec3 {
        match &self.place {
            Place::Box(bounds) => bounds.min * (DVec3::ONE - unit) + bounds.max * unit,
            Place::Simplex(root, vertices) => {
                let [x, y, z] = unit.to_array();
                // The paths along x, y, z and along x, z, y.
                let (second, third) = if *root == 0 { (y, z) } else { (z, y) };
                let weights = [1.0 - x, x - second, second - third, third];
                weights.into_iter().zip(vertices).map(|(w, v)| w * *v).sum()
            }
        }
    }

    /// The longest edge of its simplices.
    pub(super) fn longest_edge(&self) -> f64 {
        let edges = self.vertices.iter().flat_map(|vertices| {
            let v = vertices.map(DVec3::from);
            (0..4).flat_map(move |a| (0..a).map(move |b| v[a].distance(v[b])))
        });
        edges.fold(0.0, f64::max)
    }
}
