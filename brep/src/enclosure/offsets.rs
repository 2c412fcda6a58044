//! Two copies of a mesh, one displaced inward, one outward, just as far as its deviation asks for.

use super::field::Field;
use super::least::shortest;
use super::{Mesh, Open, Side, Surface};
use csg::{FormulaNode, PrimitiveId, Sense};
use glam::DVec3;
use smallvec::SmallVec;

/// The least distance that surfaces are passed by, in units of the domain's half side: some
/// hundred times the rounding of coordinates.
const LEAST: f64 = 2e-13;

/// The displacement's factor in the beginning: it is known to the first order only.
const FIRST: f64 = 1.02;

/// What displacements that do not suffice are multiplied by.
const GROWTH: f64 = 1.05;

/// What part of the displacement to one side there is to the other one, at least.
const SHARE: f64 = 0.5;

/// A surface at a vertex.
#[derive(Clone, Copy, Debug)]
struct Constraint {
    surface: Surface,
    /// Of the surface, away from the solid, of length 1.
    outward: DVec3,
    /// How far the facets around are to be moved inward and outward, to pass the surface.
    needs: [f64; 2],
    /// What these were found to be too small for.
    larger: [f64; 2],
}

/// A surface beside a vertex that the copy on one side must not cross.
#[derive(Clone, Copy, Debug)]
struct Guard {
    side: Side,
    primitive: PrimitiveId,
    /// Away from the surface, of length 1.
    away: DVec3,
    /// How far the copy must be away from the vertex in this direction; negative if it may come nearer.
    least: f64,
}

type Constraints = SmallVec<[Constraint; 2]>;

impl Constraint {
    /// Asks for more, since a facet is on the wrong side by `left`, or may be.
    fn enlarge(&mut self, side: Side, left: f64) {
        let need = self.needs[side as usize];
        let larger = &mut self.larger[side as usize];
        *larger = larger.max(GROWTH * need).max(need + FIRST * left);
    }
}

/// Displacements of all vertices, inward and outward.
pub(super) struct Offsets {
    /// By vertex.
    constraints: Vec<Constraints>,
    /// By vertex.
    guards: Vec<SmallVec<[Guard; 1]>>,
    /// By vertex and side.
    pub(super) places: Vec<[DVec3; 2]>,
}

impl Offsets {
    /// The first displacements.
    ///
    /// # Errors
    /// If there is a vertex that no way leads away from.
    pub(super) fn new(mesh: &Mesh, fields: &[Field<'_>]) -> Result<Self, Open> {
        // Corners by vertex and surface.
        let mut corners = Vec::with_capacity(3 * mesh.triangles.len());
        for (facet, (vertices, surface)) in mesh.triangles.iter().zip(&mesh.surfaces).enumerate() {
            let sense = surface.sense == Sense::Inside;
            corners.extend(vertices.map(|v| (v, surface.primitive.0, sense, facet)));
        }
        corners.sort_unstable();
        let needs: Vec<[f64; 2]> = (0..mesh.triangles.len())
            .map(|facet| needs(mesh, fields, facet))
            .collect();
        let mut constraints = vec![Constraints::new(); mesh.positions.len()];
        for group in corners.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
            let (vertex, primitive, is_inside, _) = group[0];
            let at = mesh.positions[vertex as usize];
            let field = &fields[primitive as usize];
            let mut of_facets = DVec3::ZERO;
            let mut needed = [0.0f64; 2];
            for &(.., facet) in group {
                of_facets += mesh.normal(facet);
                needed = [0, 1].map(|side| needed[side].max(needs[facet][side]));
            }
            let gradient = field.gradient(at) * if is_inside { 1.0 } else { -1.0 };
            // At an apex there is none: then facets tell.
            let is_clear = gradient.dot(of_facets) > 0.3 * gradient.length() * of_facets.length();
            let outward = if is_clear { gradient } else { of_facets };
            let outward = outward.try_normalize();
            constraints[vertex as usize].push(Constraint {
                surface: mesh.surfaces[group[0].3],
                outward: outward.ok_or_else(|| Open {
                    facets: vec![group[0].3],
                })?,
                needs: needed,
                larger: needed,
            });
        }
        let mut this = Self {
            constraints,
            guards: vec![SmallVec::new(); mesh.positions.len()],
            places: mesh.positions.iter().map(|&at| [at; 2]).collect(),
        };
        for vertex in 0..mesh.positions.len() {
            for side in [Side::Inner, Side::Outer] {
                this.place(mesh, vertex, side)?;
            }
        }
        Ok(this)
    }

    /// Moves the corners of facets whose copies are not proved to be on their sides farther: past their own
    /// surfaces where that is what is left, else past all surfaces there. Says which vertices moved.
    pub(super) fn grow<'a>(
        &mut self,
        mesh: &Mesh,
        fields: &[Field<'_>],
        failed: &[(usize, Side)],
        open_in: impl Fn(usize) -> &'a [FormulaNode],
        with_guards: bool,
    ) -> Result<Vec<[bool; 2]>, Open> {
        let mut moved = vec![[false; 2]; mesh.positions.len()];
        let mut others = Vec::new();
        for &(facet, side) in failed {
            let surface = mesh.surfaces[facet];
            let left = depth(surface, fields, self.facet(mesh, facet, side))[side as usize];
            if left <= 0.0 {
                others.push((facet, side));
                continue;
            }
            for vertex in mesh.triangles[facet].map(|v| v as usize) {
                moved[vertex][side as usize] = true;
                for constraint in &mut self.constraints[vertex] {
                    if constraint.surface == surface {
                        constraint.enlarge(side, left);
                    }
                }
            }
        }
        // Where a neighbour moves anyway, that may do.
        let is_waiting = |facet: usize, side: Side| {
            let mut vertices = mesh.triangles[facet].iter();
            vertices.any(|&v| moved[v as usize][side as usize])
        };
        others.retain(|&(facet, side)| !is_waiting(facet, side));
        for (facet, side) in others {
            let is_guarded = with_guards && self.guard(mesh, fields, open_in(facet), facet, side);
            for vertex in mesh.triangles[facet].map(|v| v as usize) {
                moved[vertex][side as usize] = true;
                for constraint in self.constraints[vertex].iter_mut().filter(|_| !is_guarded) {
                    constraint.enlarge(side, 0.0);
                }
            }
        }
        for (vertex, moved) in moved.iter().enumerate() {
            for side in [Side::Inner, Side::Outer] {
                if moved[side as usize] {
                    self.place(mesh, vertex, side)?;
                }
            }
        }
        Ok(moved)
    }

    /// Keeps a facet's copy on the side of other surfaces on which the facet's corners are, of those surfaces that are
    /// open around it: a chord beside an edge of the solid may pass beyond it. Whether there are such.
    fn guard(
        &mut self,
        mesh: &Mesh,
        fields: &[Field<'_>],
        open: &[FormulaNode],
        facet: usize,
        side: Side,
    ) -> bool {
        let mut is_any = false;
        for node in open {
            let FormulaNode::Literal(literal) = *node else {
                continue;
            };
            let field = &fields[literal.primitive.0 as usize];
            let Some(is_inside) = mesh.side_of(field, facet) else {
                continue;
            };
            let surface = Surface {
                primitive: literal.primitive,
                sense: if is_inside == (side == Side::Inner) {
                    Sense::Inside
                } else {
                    Sense::Outside
                },
            };
            let left = depth(surface, fields, self.facet(mesh, facet, side))[side as usize];
            if left <= 0.0 || surface.primitive == mesh.surfaces[facet].primitive {
                continue;
            }
            is_any = true;
            for vertex in mesh.triangles[facet].map(|v| v as usize) {
                let mut of = self.constraints[vertex].iter_mut();
                if let Some(of) = of.find(|of| of.surface.primitive == surface.primitive) {
                    if of.surface == surface {
                        of.enlarge(side, left);
                    }
                    continue;
                }
                let at = mesh.positions[vertex];
                let Some(direction) = field.gradient(at).try_normalize() else {
                    continue;
                };
                let away = if is_inside { -direction } else { direction };
                let least = (self.places[vertex][side as usize] - at).dot(away) + FIRST * left;
                let guards = &mut self.guards[vertex];
                match guards
                    .iter_mut()
                    .find(|of| of.side == side && of.primitive == surface.primitive)
                {
                    Some(guard) => guard.least = guard.least.max(least),
                    None => guards.push(Guard {
                        side,
                        primitive: surface.primitive,
                        away,
                        least,
                    }),
                }
            }
        }
        is_any
    }

    /// Finds the place of a vertex' copy, if some way leads past its surfaces.
    fn place(&mut self, mesh: &Mesh, vertex: usize, side: Side) -> Result<(), Open> {
        let of = &mut self.constraints[vertex];
        if of.is_empty() {
            return Ok(());
        }
        let conditions = of.iter_mut().map(|constraint| {
            constraint.needs = constraint.larger;
            let need = constraint.needs[side as usize];
            match side {
                Side::Inner => (-constraint.outward, need),
                Side::Outer => (constraint.outward, need),
            }
        });
        let guards = self.guards[vertex].iter().filter(|of| of.side == side);
        let guards = guards.map(|of| (of.away, of.least));
        let mut conditions: SmallVec<[_; 8]> = conditions.collect();
        let own = conditions.len();
        conditions.extend(guards);
        // Guards are wishes.
        let way = shortest(&conditions).or_else(|| shortest(&conditions[..own]));
        let Some(way) = way else {
            let is_here = |corners: &[u32; 3]| corners.iter().any(|&v| v as usize == vertex);
            let facets = (0..)
                .zip(&mesh.triangles)
                .filter(|(_, corners)| is_here(corners));
            return Err(Open {
                facets: facets.map(|(facet, _)| facet).collect(),
            });
        };
        self.places[vertex][side as usize] = mesh.positions[vertex] + way;
        Ok(())
    }

    /// A facet's displaced copy.
    pub(super) fn facet(&self, mesh: &Mesh, facet: usize, side: Side) -> [DVec3; 3] {
        mesh.triangles[facet].map(|v| self.places[v as usize][side as usize])
    }

    /// Whether values are bounded where the copies are.
    pub(super) fn are_in_domain(&self) -> bool {
        let mut places = self.places.iter().flatten();
        places.all(|place| place.abs().max_element() <= 1.0)
    }

    /// The largest displacement of a facet's corners.
    pub(super) fn of_facet(&self, mesh: &Mesh, facet: usize) -> f64 {
        let distance = |v: u32| {
            let at = mesh.positions[v as usize];
            self.places[v as usize].map(|place| place.distance(at))
        };
        let distances = mesh.triangles[facet].map(distance);
        distances.into_iter().flatten().fold(0.0, f64::max)
    }

    /// The largest displacement.
    pub(super) fn largest(&self, mesh: &Mesh) -> f64 {
        let places = self.places.iter().zip(&mesh.positions);
        places
            .flat_map(|(places, at)| places.map(|place| place.distance(*at)))
            .fold(0.0, f64::max)
    }
}

/// How far a facet is to be moved inward and outward to leave its surface behind, to the first order.
fn needs(mesh: &Mesh, fields: &[Field<'_>], facet: usize) -> [f64; 2] {
    let depths = depth(mesh.surfaces[facet], fields, mesh.corners(facet));
    // A copy that just touches the surface takes many bisections to be proved to be off it, and to be as far
    // on both sides costs nothing.
    let more = SHARE * depths[0].max(depths[1]);
    depths.map(|depth| FIRST * depth.max(more).max(0.0) + LEAST)
}

/// How far a triangle is on the outer side of a surface and on its inner side, to the first order and
/// with the values' error.
fn depth(surface: Surface, fields: &[Field<'_>], corners: [DVec3; 3]) -> [f64; 2] {
    let PrimitiveId(primitive) = surface.primitive;
    let field = &fields[primitive as usize];
    let [a, b, c] = corners;
    let range = field.roughly_over_triangle(corners);
    let slope = field.gradient((a + b + c) / 3.0).length();
    let sides = match surface.sense {
        Sense::Inside => [range.high, -range.low],
        Sense::Outside => [-range.low, range.high],
    };
    sides.map(|value| (value + field.error()) / slope)
}
