//! Mesh vertices of a leaf's arrangement: which of its vertices are real, and how many copies
//! each has.

use crate::arrange::{FACET, NO_PLANE};
use crate::leaf::LeafPolygon;
use crate::leaf_formula::{LeafFormula, Pattern};
use crate::mesh::{MeshBuilder, Name};
use crate::polygon::Corner;
use crate::sheets::{Octants, quadrant_copy};
use crate::snap::Snapper;

/// Ends, primitives and inside quadrant of a crease that needs a vertex in its middle.
type MiddleName = ([u32; 2], [u16; 2], u8);

/// A side of a cell as the naming needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CellSide {
    /// Arrangement vertex where it begins.
    pub(crate) from: u32,
    /// Where it ends.
    pub(crate) to: u32,
    /// The plane on which it lies.
    pub(crate) plane: u16,
    /// The cell's pattern.
    pub(crate) pattern: Pattern,
}

/// Finds and makes the mesh vertices of one leaf after the other.
#[derive(Debug, Default)]
pub(crate) struct VertexNamer {
    /// Finds true positions.
    pub(crate) snapper: Snapper,
    /// Copies of corners: (arrangement vertex, inside sheet, outside sheet) → mesh vertex.
    corners: Vec<((u32, u8, u8), u32)>,
    /// Middles of checkerboard creases → mesh vertex.
    middles: Vec<(MiddleName, u32)>,
    /// Arrangement vertices in facets that only this leaf's pieces use, by primitive.
    local: Vec<((u32, u16), u32)>,
}

impl VertexNamer {
    /// Forgets the last leaf.
    pub(crate) fn clear(&mut self) {
        self.corners.clear();
        self.middles.clear();
        self.local.clear();
    }

    /// The mesh vertex at the beginning of a cell's side; `None` where the boundary passes
    /// straight through an arrangement vertex in a facet, or inside a leaf of planes.
    pub(crate) fn real_vertex(
        &mut self,
        formula: &mut LeafFormula,
        polygon: &LeafPolygon<'_>,
        side: CellSide,
        mesh: &mut MeshBuilder,
    ) -> Option<Corner> {
        let name = polygon.arrangement.vertex(side.from).planes;
        let vertex = match name.iter().filter(|p| **p < FACET).count() {
            1 => polygon.edge_vertex(name, &mut self.snapper, mesh),
            2 => self.facet_vertex(formula, polygon, name, side.pattern, mesh)?,
            _ => self.corner_vertex(formula, polygon, side, mesh)?,
        };
        let position = mesh.positions[vertex as usize];
        let leaf = polygon.leaf;
        let mut affine = position;
        if leaf.is_curved() {
            affine = leaf.affine_position(name);
            mesh.note_home(vertex, affine);
            if !leaf.keeps_sides(name, side.pattern, position, &mut self.snapper) {
                mesh.tangles.objections.push(vertex);
            }
        }
        Some(Corner {
            vertex,
            planes: name,
            affine,
        })
    }

    fn facet_vertex(
        &mut self,
        formula: &mut LeafFormula,
        polygon: &LeafPolygon<'_>,
        planes: [u16; 3],
        pattern: Pattern,
        mesh: &mut MeshBuilder,
    ) -> Option<u32> {
        let [i, j] = [planes[0], planes[1]].map(usize::from);
        let other = if i == polygon.own { j } else { i };
        let bit = |p: usize| 1 << p;
        let real = formula.label(i, pattern & !bit(j)) != formula.label(i, pattern | bit(j))
            || formula.label(j, pattern & !bit(i)) != formula.label(j, pattern | bit(i));
        if !real {
            return None;
        }
        let quadrants = [0, 1, 2, 3].map(|q: u8| {
            let base = pattern & !bit(i) & !bit(j);
            let set = base | Pattern::from(q & 1) << i | Pattern::from(q >> 1) << j;
            formula.value(set)
        });
        // The inside quadrant at this cell: on its side of `other`, inside or outside of `own`.
        let side = u8::from(pattern >> other & 1 == 1);
        let of = |own_inside: u8| {
            if polygon.own == i {
                own_inside | side << 1
            } else {
                side | own_inside << 1
            }
        };
        let here = if quadrants[usize::from(of(1))] {
            of(1)
        } else {
            of(0)
        };
        let facet = usize::from(planes[2] - FACET);
        let mut sum = [0; 3];
        for (at, vertex) in polygon.leaf.simplex.vertices.iter().enumerate() {
            if at != facet {
                let c = vertex.coordinates();
                sum = [sum[0] + c[0], sum[1] + c[1], sum[2] + c[2]];
            }
        }
        let name = Name::Facet {
            sum,
            primitives: [
                polygon.leaf.planes.primitives[i],
                polygon.leaf.planes.primitives[j],
            ],
            copy: quadrant_copy(quadrants, here),
        };
        let snapper = &mut self.snapper;
        Some(mesh.facet_vertex(name, || polygon.leaf.position(planes, snapper)))
    }

    fn corner_vertex(
        &mut self,
        formula: &mut LeafFormula,
        polygon: &LeafPolygon<'_>,
        side: CellSide,
        mesh: &mut MeshBuilder,
    ) -> Option<u32> {
        let (vertex, pattern) = (side.from, side.pattern);
        let planes = polygon.arrangement.vertex(vertex).planes;
        let octants = octants(formula, planes, pattern);
        // Creases of curved leaves keep such points, which lie on the true curves.
        if !polygon.leaf.is_curved() && !octants.is_corner() && !formula.has_mixed_materials() {
            return None;
        }
        let (inside, outside) = octants.sheet(octant(planes, polygon.own, pattern));
        let key = (vertex, inside, outside);
        if let Some((_, found)) = self.corners.iter().find(|(k, _)| *k == key) {
            return Some(*found);
        }
        let position = polygon.leaf.position(planes, &mut self.snapper);
        let created = mesh.interior_vertex(position);
        mesh.split_vertices +=
            u64::from(self.corners.iter().any(|((other, ..), _)| *other == vertex));
        self.corners.push((key, created));
        Some(created)
    }

    /// The vertex in the middle of a crease along which four sheets meet, when neither end is
    /// split into one copy for each inside quadrant.
    pub(crate) fn middle_vertex(
        &mut self,
        formula: &mut LeafFormula,
        polygon: &LeafPolygon<'_>,
        side: CellSide,
        mesh: &mut MeshBuilder,
    ) -> Option<Corner> {
        let CellSide {
            from,
            to,
            plane,
            pattern,
        } = side;
        if plane >= FACET {
            return None;
        }
        let (own, other) = (polygon.own, usize::from(plane));
        let mut value = |flip_other: bool, own_inside: bool| {
            let flipped = pattern ^ (Pattern::from(flip_other) << other);
            formula.value(flipped & !(1 << own) | Pattern::from(own_inside) << own)
        };
        let here = value(false, true);
        if here == value(false, false) || here != value(true, false) || here == value(true, true) {
            return None;
        }
        // Both inside quadrants reach an unsplit end in one sheet.
        for end in [from, to] {
            let planes = polygon.arrangement.vertex(end).planes;
            if planes[2] >= FACET {
                return None;
            }
            let octants = octants(formula, planes, pattern);
            let this_side = octant(planes, own, pattern);
            let that_side = octant(planes, own, pattern ^ (1 << other));
            if octants.sheet(this_side) != octants.sheet(that_side) {
                return None;
            }
        }
        let lower = own.min(other);
        let side = u8::from(pattern >> other & 1 == 1);
        let quadrant = if lower == own {
            u8::from(here) | side << 1
        } else {
            side | u8::from(here) << 1
        };
        let primitives = [lower as u16, own.max(other) as u16];
        let name = ([from.min(to), from.max(to)], primitives, quadrant);
        let planes = [primitives[0], primitives[1], NO_PLANE];
        let ends = [from, to].map(|v| polygon.arrangement.vertex(v).planes);
        let homes = ends.map(|name| polygon.leaf.affine_position(name));
        let affine = (homes[0] + homes[1]) * 0.5;
        let known = self.middles.iter().find(|(n, _)| *n == name);
        let vertex = known.map_or_else(
            || {
                let at = ends.map(|name| polygon.leaf.position(name, &mut self.snapper));
                mesh.split_vertices += 1;
                mesh.interior_vertex((at[0] + at[1]) * 0.5)
            },
            |(_, vertex)| *vertex,
        );
        if known.is_none() {
            self.middles.push((name, vertex));
            mesh.note_home(vertex, affine);
        }
        Some(Corner {
            vertex,
            planes,
            affine,
        })
    }

    /// A mesh vertex that only pieces of this polygon use.
    pub(crate) fn local_vertex(
        &mut self,
        polygon: &LeafPolygon<'_>,
        vertex: u32,
        mesh: &mut MeshBuilder,
    ) -> Corner {
        let key = (vertex, polygon.own as u16);
        let planes = polygon.arrangement.vertex(vertex).planes;
        let affine = polygon.leaf.affine_position(planes);
        let known = self.local.iter().find(|(k, _)| *k == key);
        let created = known.map_or_else(
            || mesh.interior_vertex(polygon.leaf.position(planes, &mut self.snapper)),
            |(_, found)| *found,
        );
        if known.is_none() {
            self.local.push((key, created));
            mesh.note_home(created, affine);
        }
        Corner {
            vertex: created,
            planes,
            affine,
        }
    }
}

/// The solid around the corner with these planes.
fn octants(formula: &mut LeafFormula, planes: [u16; 3], pattern: Pattern) -> Octants {
    let mut base = pattern;
    for plane in planes {
        base &= !(1 << plane);
    }
    Octants::new([0, 1, 2, 3, 4, 5, 6, 7].map(|octant: u8| {
        let mut set = base;
        for (bit, plane) in planes.into_iter().enumerate() {
            set |= Pattern::from(octant >> bit & 1) << plane;
        }
        formula.value(set)
    }))
}

/// The two octants, one inside the solid, that a cell of primitive `own` separates at a corner.
fn octant(planes: [u16; 3], own: usize, pattern: Pattern) -> [u8; 2] {
    let mut base = 0;
    let mut own_bit = 0;
    for (bit, plane) in planes.into_iter().enumerate() {
        if usize::from(plane) == own {
            own_bit = 1 << bit;
        } else {
            base |= u8::from(pattern >> plane & 1 == 1) << bit;
        }
    }
    [base, base | own_bit]
}
