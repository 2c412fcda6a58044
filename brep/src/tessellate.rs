//! Facets taken from the true surfaces: as few as the tolerance asks for.
//!
//! A subdivision knows how faces, edges and vertices are connected; where they lie, the
//! primitives know better. This stage keeps the connections and forgets the leaves:
//!
//! 1. each B-Rep edge gets points on both of its surfaces, spaced evenly by the deviation of
//!    their chords (`chains`), shared by the faces on both sides;
//! 2. vertices inside curved faces go where the rest stays within the tolerance, and come, on
//!    the surface, where it does not (`decimate`, `split`), by what is measured once for each
//!    vertex and each edge (`measure`);
//! 3. if volumes are to be unbiased, vertices move off the surfaces by a part of the tolerance
//!    (`fit`);
//! 4. planar faces are filled from their loops (`crate::triangulate`);
//! 5. triangles that pass through others are looked for (`crossings`) and split (`mend`); where
//!    that does not help, their faces are done again more finely.
//!
//! Everything happens by splitting, flipping and collapsing edges of one closed mesh, so it
//! stays closed, and of the topology it had.

mod assemble;
mod chains;
mod crossings;
mod decimate;
mod fit;
mod flips;
mod measure;
mod mend;
mod patchwork;
mod sheet;
mod split;
mod straighten;

use crate::enclosure::{Enclosure, Open, enclose};
use crate::group::{FaceId, Groups};
use crate::topology::{Brep, FacetView};
use crate::triangulate::retriangulate;
use crate::validate::Valid;
pub use crossings::passes_through_itself;
pub(crate) use crossings::side as side_of_plane;
use csg::{PrimitiveId, Solid};
pub use fit::Fit;
use glam::DVec3;
use patchwork::{NONE, Patchwork, Role, index};
use sheet::Sheet;

/// What is asked of facets.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Demand {
    /// Largest distance of facets from their surfaces, in model units.
    pub tolerance: f64,
    /// On which side of the surfaces facets are.
    pub fit: Fit,
    /// What becomes of faces that do not come out well.
    pub if_troubled: IfTroubled,
    /// What is to be proved.
    pub proof: Proof,
}

/// What is to be proved of facets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Proof {
    /// Nothing.
    Nothing,
    /// That they are near the solid's boundary.
    OneWay,
    /// Also that the boundary, which is proved to be a manifold of so many components, is near them.
    BothWays {
        /// How many.
        components: usize,
    },
}

/// What [`tessellate`] did.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tessellated {
    /// Faces whose facets were taken from their surfaces.
    pub faces: usize,
    /// Faces that keep the subdivision's facets, since others would pass through each other.
    pub kept_faces: usize,
    /// Times that a part had to be tessellated more finely than its own deviation asked for.
    pub refinements: usize,
    /// B-Rep edges that keep the subdivision's vertices, since their surfaces are tangent.
    pub kept_edges: usize,
    /// Number of facets before.
    pub facets_before: usize,
    /// Number of facets after.
    pub facets_after: usize,
    /// Largest distance of a facet from its surface, in model units; measured.
    pub largest_deviation: f64,
    /// What was proved, if it was asked for and could be.
    pub enclosure: Option<Enclosure>,
}

/// What part of the tolerance facets use where something is to be proved: the rest is for what
/// the proof takes for granted to be lost.
const SHARE: f64 = 0.97;

/// What part of the tolerance is aimed at by faces that come out of it: what is proved does not
/// shrink as fast as they do.
const AIM: f64 = 0.94;

/// Times that facets are made finer since the proof asks for it.
const PROOFS: usize = 4;

/// What the tolerance of faces is multiplied by of which nothing was proved.
const UNPROVED: f64 = 0.5;

/// A distance is not looked for beyond this, in tolerances.
const FARTHEST: f64 = 4.0;

/// Flips after one change, at most: they come to an end by themselves, but for rounding.
const FLIPS: usize = 64;

/// What to do with a face whose facets do not come out well: they pass through others, or do not
/// fill it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum IfTroubled {
    /// Take smaller facets, a few times; then give up.
    Refine,
    /// Let it keep the boundary's own facets. They should be within the tolerance, then.
    Keep,
}

impl IfTroubled {
    /// Attempts, at most.
    fn rounds(self) -> usize {
        match self {
            Self::Refine => 6,
            Self::Keep => 24,
        }
    }
}

/// Replaces the facets of a boundary by such as its surfaces need at this tolerance. `solid` is what
/// the boundary was made from.
///
/// Faces, edges, vertices, shells and genus stay what they are. `None` if that cannot be had:
/// then the boundary's own facets are the answer. If a proof is asked for, facets are made finer
/// where it needs that; what was proved in the end is in the result.
pub fn tessellate(
    brep: &Valid<Brep>,
    solid: &Solid,
    demand: Demand,
) -> Option<(Valid<Brep>, Tessellated)> {
    let groups = Groups::of(brep);
    let sheets: Vec<Sheet<'_>> = solid
        .primitives
        .iter()
        .map(|primitive| Sheet::of(primitive, &solid.domain))
        .collect();
    let is_plane = |PrimitiveId(at): PrimitiveId| sheets[at as usize].is_plane();
    if (groups.faces.iter()).all(|face| is_plane(face.primitive)) {
        return Some(demand.planar(brep, solid, is_plane));
    }
    let tolerance = match demand.proof {
        Proof::Nothing => demand.tolerance,
        _ => SHARE * demand.tolerance,
    };
    let mut tolerances: Vec<f64> = (groups.faces.iter())
        .map(|face| {
            let sheet = &sheets[face.primitive.0 as usize];
            demand.fit.inscribed_tolerance(sheet, tolerance)
        })
        .collect();
    let mut kept = vec![false; groups.faces.len()];
    let (mut most_facets, mut fewest) = (usize::MAX, usize::MAX);
    let mut best: Option<(Valid<Brep>, Tessellated)> = None;
    let mut proofs = 0;
    for round in 0..demand.if_troubled.rounds() {
        let plan = Plan {
            groups: &groups,
            sheets: &sheets,
            tolerances: &tolerances,
            kept: &kept,
            most_facets,
        };
        let mut run = Run::new(brep, plan, solid);
        if round == 0 {
            let most = match demand.if_troubled {
                IfTroubled::Refine => 8 * run.mesh.face.len() + 1024,
                IfTroubled::Keep => 2 * brep.facet_count() + 1024,
            };
            run.most_facets = most;
            most_facets = most;
        }
        if demand.fit == Fit::Mean {
            run.fit_mean(tolerance);
        }
        match run.mended(tolerance) {
            Ok(result) => {
                let proved = demand.proved(&result, solid);
                let finer = demand.finer_faces(&result, proved.as_ref(), groups.faces.len());
                let counts = Tessellated {
                    faces: groups.faces.len() - kept_faces(&kept),
                    kept_faces: kept_faces(&kept),
                    refinements: round,
                    kept_edges: run.kept_edges,
                    facets_before: brep.facet_count(),
                    facets_after: result.facet_count(),
                    largest_deviation: run.largest_deviation(),
                    enclosure: proved.and_then(Result::ok),
                };
                let is_better = best
                    .as_ref()
                    .is_none_or(|(_, other)| counts.is_nearer_than(other));
                if is_better {
                    best = Some((result, counts));
                }
                if finer.is_empty() || proofs == demand.proofs() {
                    break;
                }
                proofs += 1;
                for (face, factor) in finer {
                    tolerances[face] *= factor;
                }
            }
            Err(troubles) => {
                let troubled = assemble::finer_faces(&troubles);
                let is_hopeless = match demand.if_troubled {
                    IfTroubled::Refine => {
                        troubled.len() >= fewest || run.mesh.face.len() > most_facets
                    }
                    IfTroubled::Keep => false,
                };
                if troubled.is_empty() || is_hopeless {
                    break;
                }
                fewest = troubled.len();
                for (face, finer) in troubled {
                    match demand.if_troubled {
                        IfTroubled::Refine => tolerances[face] *= finer,
                        IfTroubled::Keep => kept[face] = true,
                    }
                }
            }
        }
    }
    best
}

impl Demand {
    /// Times that facets may be made finer since the proof asks for it. What keeps facets of the
    /// subdivision is not done again.
    fn proofs(&self) -> usize {
        match self.if_troubled {
            IfTroubled::Refine => PROOFS,
            IfTroubled::Keep => 0,
        }
    }

    /// Facets of a solid that has planes only.
    fn planar(
        &self,
        brep: &Valid<Brep>,
        solid: &Solid,
        is_plane: impl Fn(PrimitiveId) -> bool,
    ) -> (Valid<Brep>, Tessellated) {
        let (result, counts) = retriangulate(brep.clone(), is_plane);
        let counts = Tessellated {
            faces: counts.faces,
            kept_faces: counts.kept,
            facets_before: counts.facets_before,
            facets_after: counts.facets_after,
            enclosure: self.proved(&result, solid).and_then(Result::ok),
            ..Tessellated::default()
        };
        (result, counts)
    }

    /// What can be proved of what is to be.
    fn proved(&self, brep: &Valid<Brep>, solid: &Solid) -> Option<Result<Enclosure, Open>> {
        let components = match self.proof {
            Proof::Nothing => return None,
            Proof::OneWay => None,
            Proof::BothWays { components } => Some(components),
        };
        Some(enclose(brep, solid, components, FARTHEST * self.tolerance))
    }

    /// Faces that are farther from the boundary, for all that is proved, than they should be, each with what its
    /// tolerance should be multiplied by.
    fn finer_faces(
        &self,
        brep: &Valid<Brep>,
        proved: Option<&Result<Enclosure, Open>>,
        faces: usize,
    ) -> Vec<(usize, f64)> {
        let mut factors = vec![1.0f64; faces];
        let groups = Groups::of(brep);
        if groups.faces.len() != faces {
            return Vec::new();
        }
        // A solid that touches itself, or has a cone's apex, has places where no facets are fine enough.
        let is_provable = matches!(self.proof, Proof::BothWays { .. });
        let of_facet = |(facet, view): (usize, FacetView<'_>)| {
            let factor = match proved {
                Some(Ok(enclosure)) => AIM * self.tolerance / enclosure.by_facet[facet],
                Some(Err(open)) if is_provable && open.facets.binary_search(&facet).is_ok() => {
                    UNPROVED
                }
                _ => 1.0,
            };
            (groups.face_of[view.key()], factor)
        };
        let is_near = matches!(proved, Some(Ok(enclosure)) if enclosure.distance <= self.tolerance);
        if !is_near {
            for (FaceId(face), factor) in brep.facets().enumerate().map(of_facet) {
                let of_face = &mut factors[face as usize];
                *of_face = of_face.min(factor);
            }
        }
        (0..)
            .zip(factors)
            .filter(|(_, factor)| *factor < SHARE)
            .collect()
    }
}

impl Tessellated {
    /// Whether more is proved than of another one.
    fn is_nearer_than(&self, other: &Self) -> bool {
        match (&self.enclosure, &other.enclosure) {
            (Some(own), Some(others)) => {
                (own.is_both_ways, -own.distance) > (others.is_both_ways, -others.distance)
            }
            (own, others) => own.is_some() && others.is_none(),
        }
    }
}

fn kept_faces(kept: &[bool]) -> usize {
    kept.iter().filter(|&&is_kept| is_kept).count()
}

/// What an attempt starts from.
#[derive(Clone, Copy)]
struct Plan<'a> {
    groups: &'a Groups,
    /// By primitive.
    sheets: &'a [Sheet<'a>],
    /// By face.
    tolerances: &'a [f64],
    /// By face: whether its facets stay, and with them all their corners.
    kept: &'a [bool],
    /// Splits end when there are more, removed ones included.
    most_facets: usize,
}

/// One attempt, at given tolerances.
struct Run<'a> {
    mesh: Patchwork,
    groups: &'a Groups,
    /// By face.
    sheets: Vec<&'a Sheet<'a>>,
    /// By face: 1 where the surface's normals point outward, else −1.
    outward: Vec<f64>,
    /// By face.
    tolerances: &'a [f64],
    /// By face: whether its facets stay.
    kept: &'a [bool],
    /// Distances that count as none.
    rounding: f64,
    kept_edges: usize,
    /// Splits end when there are more, removed ones included.
    most_facets: usize,
}

impl<'a> Run<'a> {
    fn new(brep: &Brep, plan: Plan<'a>, solid: &Solid) -> Self {
        let groups = plan.groups;
        let of_face: Vec<&Sheet<'_>> = (groups.faces.iter())
            .map(|face| &plan.sheets[face.primitive.0 as usize])
            .collect();
        let is_capped = |FaceId(face)| {
            let face = face as usize;
            of_face[face].is_plane() && !plan.kept[face]
        };
        let (mut mesh, chains) = Patchwork::of(brep, groups, is_capped);
        mesh.hold(plan.kept);
        let largest = (mesh.positions.iter()).fold(0.0, |m: f64, p| m.max(p.abs().max_element()));
        let mut this = Self {
            outward: vec![1.0; of_face.len()],
            mesh,
            groups,
            sheets: of_face,
            tolerances: plan.tolerances,
            kept: plan.kept,
            rounding: 4.0 * f64::EPSILON * largest.max(solid.domain.size()),
            kept_edges: 0,
            most_facets: plan.most_facets,
        };
        this.orient();
        this.settle();
        this.place_apexes();
        this.trace(&chains);
        this.refine();
        this
    }

    /// Finds out on which side of its surface each face has the outside.
    fn orient(&mut self) {
        let mut votes = vec![0.0; self.sheets.len()];
        for facet in self.mesh.facets() {
            let face = self.mesh.face[facet as usize] as usize;
            let [a, b, c] = self.mesh.corners(facet).map(|v| self.mesh.position(v));
            let area = (b - a).cross(c - a);
            votes[face] += [a, b, c]
                .map(|p| area.dot(self.sheets[face].at(p).1))
                .iter()
                .sum::<f64>();
        }
        for (outward, vote) in self.outward.iter_mut().zip(votes) {
            *outward = if vote < 0.0 { -1.0 } else { 1.0 };
        }
    }

    /// Moves vertices onto their surfaces: inside faces onto one, B-Rep vertices onto all.
    fn settle(&mut self) {
        let mut around: Vec<usize> = Vec::new();
        for vertex in 0..index(self.mesh.positions.len()) {
            let role = self.mesh.roles[vertex as usize];
            if !matches!(role, Role::Inside | Role::Fixed) {
                continue;
            }
            let first = self.mesh.outgoing[vertex as usize];
            if first == NONE {
                continue;
            }
            around.clear();
            around.extend(
                self.mesh
                    .ring(first)
                    .map(|h| self.mesh.face[h as usize / 3] as usize),
            );
            around.sort_unstable_by_key(|&face| self.groups.faces[face].primitive);
            around.dedup_by_key(|face| self.groups.faces[*face].primitive);
            let sheets: Vec<&Sheet<'_>> = around.iter().map(|&face| self.sheets[face]).collect();
            let from = self.mesh.position(vertex);
            let near = 4.0
                * (self.mesh.ring(first))
                    .map(|h| self.mesh.position(self.mesh.target(h)).distance(from))
                    .fold(0.0, f64::max);
            let to = match sheets[..] {
                [sheet] => sheet.project(from, self.rounding),
                [one, other] => sheet::project_on_both([one, other], from, self.rounding),
                _ => sheet::project_on_all(&sheets, from, self.rounding),
            };
            if let Some(to) = to.filter(|to| to.distance(from) <= near) {
                self.mesh.positions[vertex as usize] = to;
            }
        }
    }

    /// A cone's apex is a point of the solid like no other: the nearest vertex becomes it.
    fn place_apexes(&mut self) {
        let mut nearest = vec![(f64::INFINITY, NONE); self.sheets.len()];
        for facet in self.mesh.facets() {
            let face = self.mesh.face[facet as usize] as usize;
            let Sheet::Cone { apex, .. } = self.sheets[face] else {
                continue;
            };
            for vertex in self.mesh.corners(facet) {
                let distance = self.mesh.position(vertex).distance(*apex);
                if self.mesh.roles[vertex as usize] == Role::Inside && distance < nearest[face].0 {
                    nearest[face] = (distance, vertex);
                }
            }
        }
        for (face, (distance, vertex)) in nearest.into_iter().enumerate() {
            if let Sheet::Cone { apex, .. } = self.sheets[face]
                && distance <= 2.0 * self.tolerances[face]
            {
                self.mesh.positions[vertex as usize] = *apex;
                self.mesh.roles[vertex as usize] = Role::Fixed;
            }
        }
    }

    /// Gives every B-Rep edge the points that it needs, and takes those that it does not.
    fn trace(&mut self, chains: &[Vec<u32>]) {
        let mut all_targets = Vec::with_capacity(chains.len());
        for (edge, chain) in self.groups.edges.iter().zip(chains) {
            let faces = edge.faces.map(|FaceId(face)| face as usize);
            if faces.iter().any(|&face| self.kept[face]) {
                all_targets.push(None);
                continue;
            }
            let sheets = faces.map(|face| self.sheets[face]);
            let primitives = faces.map(|face| self.groups.faces[face].primitive);
            // All but the ends of an open chain, which stay where they are.
            let movable = match edge.ends {
                None => &chain[..chain.len() - 1],
                Some(_) => &chain[1..chain.len() - 1],
            };
            for &vertex in movable {
                let from = self.mesh.position(vertex);
                if let Some(to) = sheet::project_on_both(sheets, from, self.rounding) {
                    self.mesh.positions[vertex as usize] = to;
                }
            }
            let points: Vec<DVec3> = chain.iter().map(|&v| self.mesh.position(v)).collect();
            let tolerance = self.tolerances[faces[0]].min(self.tolerances[faces[1]]);
            let is_closed = chain.first() == chain.last();
            all_targets.push(if primitives[0] == primitives[1] {
                None
            } else {
                chains::resample(sheets, &points, is_closed, tolerance, self.rounding)
            });
        }
        self.measure_all();
        let mut old = Vec::new();
        for ((name, chain), targets) in (0..).zip(chains).zip(all_targets) {
            let inner = &chain[1..chain.len() - 1];
            let Some(targets) = targets else {
                self.kept_edges += 1;
                for &vertex in inner {
                    let role = &mut self.mesh.roles[vertex as usize];
                    if *role == Role::Chain {
                        *role = Role::Fixed;
                    }
                }
                continue;
            };
            let FaceId(left) = self.groups.edges[name as usize].faces[0];
            let mut at = (usize::MAX, NONE);
            for target in targets {
                if at.0 != target.segment {
                    at = (
                        target.segment,
                        self.crease_from(chain[target.segment], name, left as usize),
                    );
                }
                if at.1 != NONE {
                    at.1 = self.split(at.1, target.position, Role::Fixed);
                }
            }
            old.extend(inner);
            // The point where a closed chain begins is as good as any.
            let first = &mut self.mesh.roles[chain[0] as usize];
            if *first == Role::Chain {
                *first = Role::Fixed;
            }
        }
        self.collapse_along_chains(old);
    }

    /// Decimates, refines, decimates again.
    fn refine(&mut self) {
        self.straighten();
        self.decimate();
        self.split_far_facets();
        self.decimate();
        self.flip_all(true);
    }

    fn largest_deviation(&self) -> f64 {
        let facets = self.mesh.facets();
        facets
            .map(|facet| self.deviation(facet))
            .fold(0.0, f64::max)
    }

    /// The half-edge that leaves a vertex along a B-Rep edge with this face to the left.
    fn crease_from(&self, vertex: u32, name: u32, left: usize) -> u32 {
        let first = self.mesh.outgoing[vertex as usize];
        let mut ring = self.mesh.ring(first);
        ring.find(|&h| {
            self.mesh.crease[h as usize] == name && self.mesh.face[h as usize / 3] as usize == left
        })
        .unwrap_or(NONE)
    }
}
