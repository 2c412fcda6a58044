//! A proof that a mesh and the boundary of a solid are close to each other, whatever made the
//! mesh.
//!
//! Two copies of the mesh, one with its vertices displaced inward, one outward, by D at most: if
//! each facet of the first is inside the solid (`membership`, by bounds on the polynomials' values and
//! three-valued evaluation of the formula), and each of the second outside, then the boundary passes
//! between: **every point of the mesh has a point of the boundary within D**, since the segment from
//! its inner to its outer copy is that near.
//!
//! **Every point of the boundary has a point of the mesh within D**, too, if the boundary is a
//! manifold of as many components as the mesh, and each component of the mesh is passed by a short
//! way that passes no other (`witness`). For let F map the mesh's points times [0, 1] to those segments.
//! The ends are inside and outside, so what F maps to the boundary separates them; as a surface K it is
//! homologous to the mesh. K's part of a component M covers a component S of the boundary an
//! odd number of times, or an even number: F meets a generic point y of S so often, and this number's parity
//! is that of the times that M's outer copy surrounds y less those that its inner copy does. On the way past M
//! there is a point of the boundary. Seen from it the difference is odd for M and even for all other components
//! of the mesh. With equally many components that makes the matrix of parities regular: each S is covered an odd
//! number of times by some M. So each of its points is on some segment.
//!
//! Nothing is asked of the mesh: it may even pass through itself. See `docs/accuracy.md`.

mod field;
mod lattice;
mod least;
mod membership;
mod offsets;
mod witness;

#[cfg(test)]
mod tests;

use crate::hierarchy::Hierarchy;
use crate::topology::{Brep, FacetView, VertexView};
use crate::validate::Valid;
use csg::{FormulaNode, PrimitiveId, Sense, Solid, Ternary};
use field::Field;
use glam::DVec3;
use membership::Membership;
use offsets::Offsets;
use std::ops::Range;

/// A mesh that was proved to be near the boundary of a solid.
#[derive(Clone, PartialEq, Debug)]
pub struct Enclosure {
    /// Every point of the mesh is within this of the boundary, in model units; rounding included.
    pub distance: f64,
    /// Whether every point of the boundary is within it of the mesh, too.
    pub is_both_ways: bool,
    /// By facet: how far its points are from the boundary at most, about.
    pub by_facet: Vec<f64>,
}

/// A mesh that could not be enclosed. That says nothing about it.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Open {
    /// Numbers of the facets of which some copy was not proved to be on its side, or of the first ones
    /// that led too far; empty if there is no telling.
    pub facets: Vec<usize>,
}

/// Times that displacements may be enlarged.
const ROUNDS: usize = 16;

/// Rounds before it is looked at which surfaces are in the way: mostly it is the facet's own.
const PLAIN: usize = 4;

/// Which copy of the mesh.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Side {
    /// Inside the solid.
    Inner = 0,
    /// Outside.
    Outer = 1,
}

/// A facet's surface, and on which side of it the solid is.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
struct Surface {
    primitive: PrimitiveId,
    sense: Sense,
}

/// A mesh in centred coordinates.
struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    surfaces: Vec<Surface>,
}

/// Encloses a mesh between two displaced copies of itself, none by more than `limit`, in model units.
///
/// `components` is the number of components that the solid's boundary is proved to have, as a
/// manifold, if it is.
///
/// # Errors
/// [`Open`] if no such copies are found.
pub fn enclose(
    brep: &Valid<Brep>,
    solid: &Solid,
    components: Option<usize>,
    limit: f64,
) -> Result<Enclosure, Open> {
    let (component, count) = find_components(brep);
    let mesh = Mesh::of(brep, solid);
    let limit = limit / solid.domain.half_size();
    let fields: Vec<Field<'_>> = solid.primitives.iter().map(Field::of).collect();
    let offsets = displaced(&mesh, &fields, solid.formula.nodes(), limit)?;
    let largest = brep.vertices().map(|v| v.position().abs().max_element());
    let largest = largest.fold(solid.domain.size(), f64::max);
    let is_both_ways =
        components == Some(count) && witness::is_passed_once(&mesh, &offsets, &component, count);
    // Coordinates are rounded when they are centred, and once more.
    let rounding = 8.0 * f64::EPSILON * largest;
    let in_units = |distance: f64| distance * solid.domain.half_size() + rounding;
    let facets = 0..mesh.triangles.len();
    Ok(Enclosure {
        distance: if count == 0 {
            0.0
        } else {
            in_units(offsets.largest(&mesh))
        },
        is_both_ways,
        by_facet: facets
            .map(|facet| in_units(offsets.of_facet(&mesh, facet)))
            .collect(),
    })
}

/// Displacements with which all facets are proved to be inside, and outside.
fn displaced(
    mesh: &Mesh,
    fields: &[Field<'_>],
    formula: &[FormulaNode],
    limit: f64,
) -> Result<Offsets, Open> {
    let mut membership = Membership::new(fields);
    let (nodes, of_facet) = localized(mesh, &mut membership, formula, limit)?;
    let mut offsets = Offsets::new(mesh, fields)?;
    let facets = 0..mesh.triangles.len();
    let mut open: Vec<(usize, Side)> = facets
        .flat_map(|facet| [(facet, Side::Inner), (facet, Side::Outer)])
        .collect();
    let mut is_open = vec![[false; 2]; mesh.triangles.len()];
    for round in 0..ROUNDS {
        let is_too_far = |facet: &usize| offsets.of_facet(mesh, *facet) > limit;
        let too_far: Vec<usize> = (0..mesh.triangles.len()).filter(is_too_far).collect();
        if !too_far.is_empty() || !offsets.are_in_domain() {
            return Err(Open { facets: too_far });
        }
        open.retain(|&(facet, side)| {
            let wanted = match side {
                Side::Inner => Ternary::In,
                Side::Outer => Ternary::Out,
            };
            let corners = offsets.facet(mesh, facet, side);
            !membership.is(&nodes[of_facet[facet].clone()], corners, wanted)
        });
        if open.is_empty() {
            return Ok(offsets);
        }
        let moved = offsets.grow(
            mesh,
            fields,
            &open,
            |facet| &nodes[of_facet[facet].clone()],
            round >= PLAIN,
        )?;
        for &(facet, side) in &open {
            is_open[facet][side as usize] = true;
        }
        open.clear();
        for (facet, vertices) in mesh.triangles.iter().enumerate() {
            for side in [Side::Inner, Side::Outer] {
                let was_open = std::mem::take(&mut is_open[facet][side as usize]);
                if was_open || vertices.iter().any(|&v| moved[v as usize][side as usize]) {
                    open.push((facet, side));
                }
            }
        }
    }
    let mut facets: Vec<usize> = open.into_iter().map(|(facet, _)| facet).collect();
    facets.dedup();
    Err(Open { facets })
}

/// For each facet what is open of the formula around it. Something is, if the boundary is near.
fn localized(
    mesh: &Mesh,
    membership: &mut Membership<'_>,
    formula: &[FormulaNode],
    limit: f64,
) -> Result<(Vec<FormulaNode>, Vec<Range<usize>>), Open> {
    if mesh.triangles.is_empty() {
        return Ok((Vec::new(), Vec::new()));
    }
    let hierarchy = Hierarchy::of(&mesh.positions, &mesh.triangles);
    let mut nodes = formula.to_vec();
    let mut of_facet = vec![0..0; mesh.triangles.len()];
    let mut open = vec![(0, 0..formula.len())];
    let mut above = Vec::new();
    while let Some((at, range)) = open.pop() {
        let (bounds, children, triangles) = hierarchy.node(at);
        let [low, high] = bounds.0;
        let radius = 0.5 * low.distance(high) + limit;
        above.clear();
        above.extend_from_slice(&nodes[range]);
        let start = nodes.len();
        let found = membership.in_ball(&above, low.midpoint(high), radius, &mut nodes);
        if found != Ternary::Unknown {
            return Err(Open {
                facets: triangles.collect(),
            });
        }
        let range = start..nodes.len();
        for triangle in triangles {
            of_facet[triangle] = range.clone();
        }
        for child in children.into_iter().flatten() {
            open.push((child, range.clone()));
        }
    }
    Ok((nodes, of_facet))
}

impl Mesh {
    fn of(brep: &Brep, solid: &Solid) -> Self {
        let numbers = brep.number_vertices();
        let corners = |facet: FacetView<'_>| facet.vertices().map(|v| numbers[v.key()]);
        Self {
            positions: (brep.vertices())
                .map(|vertex| solid.domain.to_centered(VertexView::position(vertex)))
                .collect(),
            triangles: brep.facets().map(corners).collect(),
            surfaces: (brep.facets())
                .map(|facet| Surface {
                    primitive: facet.primitive(),
                    sense: facet.sense(),
                })
                .collect(),
        }
    }

    fn corners(&self, facet: usize) -> [DVec3; 3] {
        self.triangles[facet].map(|v| self.positions[v as usize])
    }

    /// Whether the corners of a facet are inside a surface, if they are on one side of it or on it.
    fn side_of(&self, field: &Field<'_>, facet: usize) -> Option<bool> {
        let values = self.corners(facet).map(|corner| field.value(corner));
        let is_outside = values.iter().any(|&value| value > field.error());
        let is_inside = values.iter().any(|&value| value < -field.error());
        (is_inside != is_outside).then_some(is_inside)
    }

    /// Outward, as long as twice the area.
    fn normal(&self, facet: usize) -> DVec3 {
        let [a, b, c] = self.corners(facet);
        (b - a).cross(c - a)
    }
}

/// The component of each vertex, and how many there are.
fn find_components(brep: &Brep) -> (Vec<u32>, usize) {
    let numbers = brep.number_vertices();
    let mut component = vec![u32::MAX; brep.vertex_count()];
    let mut count = 0;
    let mut open = Vec::new();
    for seed in brep.vertices() {
        if component[numbers[seed.key()] as usize] != u32::MAX {
            continue;
        }
        open.push(seed);
        component[numbers[seed.key()] as usize] = count;
        while let Some(vertex) = open.pop() {
            for half_edge in vertex.ring() {
                let other = half_edge.target();
                let of_other = &mut component[numbers[other.key()] as usize];
                if *of_other == u32::MAX {
                    *of_other = count;
                    open.push(other);
                }
            }
        }
        count += 1;
    }
    (component, count as usize)
}

/// How many components a boundary has.
impl Brep {
    /// The number of connected components.
    #[must_use]
    pub fn component_count(&self) -> usize {
        find_components(self).1
    }
}
