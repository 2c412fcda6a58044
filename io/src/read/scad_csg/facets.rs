//! The boundary of a part of the model as triangles, for the nodes that ask for measures of it:
//! hulls, shadows and sections of what was cut, sizes of what is to be resized.

use brep::{Brep, Demand, Fit, IfTroubled, Proof, Valid};
use csg::{ModelBuilder, NodeId, PrimitiveId, Solid};
use glam::DVec3;
use subdiv::{Rule, Settings};

/// Distance of facets from curved faces, in sizes of the part.
const SAGITTA: f64 = 5e-4;

/// Cells of the subdivision, at most.
const MAX_CELLS: u64 = 3_000_000;

fn boundary(solid: &Solid, rule: Rule) -> Option<Valid<Brep>> {
    if solid.primitives.is_empty() {
        return None;
    }
    let mut settings = Settings::new(rule);
    settings.max_cells = MAX_CELLS;
    let outcome = subdiv::convert(solid, &settings, &()).ok()?;
    brep::stitch(&outcome.fragments).ok()?.validate().ok()
}

/// A closed, oriented surface.
#[derive(Clone, Debug, Default)]
pub(super) struct Facets {
    pub(super) positions: Vec<DVec3>,
    /// Counter-clockwise from outside.
    pub(super) triangles: Vec<[usize; 3]>,
    /// Whether it is the boundary itself: all faces are plane.
    pub(super) exact: bool,
    /// Largest distance from the boundary.
    pub(super) sagitta: f64,
}

impl Facets {
    /// The boundary of a node; `None` if it cannot be made, an unbounded one for instance.
    pub(super) fn of(builder: &ModelBuilder, root: NodeId, coarseness: f64) -> Option<Self> {
        let solid = Solid::build(&builder.subtree(root), None).ok()?;
        if solid.primitives.is_empty() {
            return Some(Self::default());
        }
        let sagitta = SAGITTA * coarseness * solid.extent.diagonal();
        let brep = boundary(&solid, Rule::Tolerance(sagitta))?;
        Some(Self::of_boundary(brep, &solid, sagitta))
    }

    /// The boundary as above, with as few facets as its surfaces allow.
    pub(super) fn few(builder: &ModelBuilder, root: NodeId, coarseness: f64) -> Option<Self> {
        let solid = Solid::build(&builder.subtree(root), None).ok()?;
        let finest = SAGITTA * coarseness * solid.extent.diagonal();
        let demand = Demand {
            tolerance: finest,
            fit: Fit::default(),
            if_troubled: IfTroubled::Refine,
            proof: Proof::Nothing,
        };
        let few = boundary(&solid, Rule::Topology { finest })
            .and_then(|brep| brep::tessellate(&brep, &solid, demand));
        match few {
            Some((brep, _)) => Some(Self::of_boundary(brep, &solid, finest)),
            None => Self::of(builder, root, coarseness),
        }
    }

    fn of_boundary(brep: Valid<Brep>, solid: &Solid, sagitta: f64) -> Self {
        let is_plane = |PrimitiveId(at): PrimitiveId| {
            let primitive = solid.primitives.get(at as usize);
            primitive.is_some_and(|p| p.polynomial.degree() == 1)
        };
        let (brep, _) = brep::retriangulate(brep, is_plane);
        let mut facets = Self {
            exact: brep.facets().all(|f| is_plane(f.primitive())),
            sagitta,
            ..Self::default()
        };
        let numbers = brep.number_vertices();
        facets.positions = brep.vertices().map(brep::VertexView::position).collect();
        for facet in brep.facets() {
            let corner =
                |v: brep::VertexView<'_>| numbers.get(v.key()).map_or(usize::MAX, |n| *n as usize);
            facets.triangles.push(facet.vertices().map(corner));
        }
        facets
    }

    /// The corners of each triangle.
    pub(super) fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> {
        let at = |i: usize| self.positions.get(i).copied().unwrap_or_default();
        self.triangles.iter().map(move |t| t.map(at))
    }

    /// Whether no corner lies before a facet.
    pub(super) fn is_convex(&self) -> bool {
        let near = 1e-7 * super::point_hull::span(&self.positions);
        self.corners().all(|[a, b, c]| {
            let normal = (b - a).cross(c - a).normalize_or_zero();
            self.positions.iter().all(|p| normal.dot(*p - a) <= near)
        })
    }

    /// The facets, joined to convex polygons where they are coplanar.
    pub(super) fn convex_faces(&self) -> Vec<Vec<DVec3>> {
        let at = |i: usize| self.positions.get(i).copied().unwrap_or_default();
        let near = 1e-7 * super::point_hull::span(&self.positions);
        let normal = |p: &[usize]| match *p {
            [a, b, c, ..] => (at(b) - at(a)).cross(at(c) - at(a)).normalize_or_zero(),
            _ => DVec3::ZERO,
        };
        let normals: Vec<DVec3> = self.triangles.iter().map(|t| normal(t)).collect();
        let mut faces: Vec<Vec<usize>> = self.triangles.iter().map(|t| t.to_vec()).collect();
        let mut owner = std::collections::BTreeMap::new();
        for (face, t) in self.triangles.iter().enumerate() {
            let [a, b, c] = *t;
            owner.extend([((a, b), face), ((b, c), face), ((c, a), face)]);
        }
        let edges: Vec<(usize, usize)> = owner.keys().copied().filter(|(a, b)| a < b).collect();
        for (a, b) in edges {
            let (Some(&p), Some(&q)) = (owner.get(&(a, b)), owner.get(&(b, a))) else {
                continue;
            };
            let (Some(&up), Some(&other)) = (normals.get(p), normals.get(q)) else {
                continue;
            };
            if p == q || up.dot(other) < 1.0 - 1e-10 {
                continue;
            }
            let from = |face: usize, start: usize| -> Vec<usize> {
                let ring = faces.get(face).cloned().unwrap_or_default();
                let first = ring.iter().position(|v| *v == start).unwrap_or(0);
                let (head, tail) = ring.split_at(first);
                tail.iter().chain(head).copied().collect()
            };
            // p from b around to a, then q from a on, without both ends.
            let mut joined = from(p, b);
            let rest = from(q, a);
            joined.extend(rest.iter().skip(1).take(rest.len().saturating_sub(2)));
            let n = joined.len();
            let corner = |i: usize| joined.get(i % n).map_or(DVec3::ZERO, |v| at(*v));
            let is_convex = (0..n).all(|i| {
                let (u, v) = (corner(i + 1) - corner(i), corner(i + 2) - corner(i + 1));
                up.dot(u.cross(v)) >= -near * (u.length() + v.length())
            });
            if !is_convex {
                continue;
            }
            for (i, v) in joined.iter().enumerate() {
                if let Some(next) = joined.get((i + 1) % n) {
                    owner.insert((*v, *next), p);
                }
            }
            owner.remove(&(a, b));
            owner.remove(&(b, a));
            if let Some(face) = faces.get_mut(q) {
                face.clear();
            }
            if let Some(face) = faces.get_mut(p) {
                *face = joined;
            }
        }
        let joined = faces.into_iter().filter(|f| !f.is_empty());
        joined.map(|f| f.into_iter().map(at).collect()).collect()
    }
}
