//! A polyhedron's boundary as it was given: no arrangement of its planes, rounded as they are, can
//! be nearer to what was meant.

use crate::lower::Half;
use crate::matrix::Bounded;
use crate::{Error, MaterialId, Model, Node, PrimitiveId, Sense, Shape, Transform};
use glam::DVec3;

/// A closed, oriented triangle mesh that bounds a node of a [`Model`], in the node's coordinates.
///
/// Whoever makes one vouches that it is a 2-manifold whose triangles do not pass through each
/// other, and that the node holds what it encloses.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Facets {
    /// The vertices; sheets that touch have their own.
    pub positions: Vec<DVec3>,
    /// The planes of the faces, as half-spaces `normal · x ≤ offset`.
    pub planes: Vec<(DVec3, f64)>,
    /// The triangles.
    pub triangles: Vec<FacetOnPlane>,
}

/// A triangle of [`Facets`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct FacetOnPlane {
    /// Indices of its vertices, counter-clockwise seen from outside.
    pub vertices: [u32; 3],
    /// Index of its plane, which the model's half-spaces contain.
    pub plane: u32,
    /// `Inside` when its outward normal is the plane's.
    pub sense: Sense,
}

/// A triangle of a solid's boundary, where that is known beforehand.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct KnownFacet {
    /// Indices of its vertices, counter-clockwise seen from outside.
    pub vertices: [u32; 3],
    /// The primitive on which it lies.
    pub primitive: PrimitiveId,
    /// `Inside` when the solid lies where the primitive's polynomial is negative.
    pub sense: Sense,
    /// The material it shows.
    pub material: MaterialId,
}

/// The boundary of a solid that is one polyhedron, as that was given.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct KnownBoundary {
    /// The vertices, in model units.
    pub positions: Vec<DVec3>,
    /// The triangles: a closed, oriented 2-manifold.
    pub facets: Vec<KnownFacet>,
}

/// The facets of the root, and how they stand in the model.
pub(crate) struct RootFacets<'a> {
    facets: &'a Facets,
    /// From the outermost to the innermost.
    transforms: Vec<&'a Transform>,
    material: MaterialId,
}

impl<'a> RootFacets<'a> {
    /// Looks for facets below the root, with nothing on the way but placement and colour.
    pub(crate) fn of(model: &'a Model) -> Option<Self> {
        let mut transforms = Vec::new();
        let mut material = None;
        let mut at = model.root();
        loop {
            if let Some(facets) = model.facets(at) {
                let material = material.unwrap_or(MaterialId(0));
                return Some(Self {
                    facets,
                    transforms,
                    material,
                });
            }
            at = match model.node(at) {
                Node::Instance(transform, child) if transform.is_affine() => {
                    transforms.push(transform);
                    *child
                }
                Node::Painted(outer, child) => {
                    material.get_or_insert(*outer);
                    *child
                }
                Node::Union(all) | Node::Intersection(all) | Node::Difference(all) => {
                    let [only] = all[..] else { return None };
                    only
                }
                _ => return None,
            };
        }
    }

    /// The half-spaces of the planes, as lowering makes them.
    ///
    /// `frame`: from the frame's coordinates to the model's, for row vectors.
    pub(crate) fn halves(&self, frame: &Bounded) -> Result<Vec<Half>, Error> {
        let mut to_shape = *frame;
        for transform in &self.transforms {
            to_shape = to_shape.then(transform.bounded_inverse()).finite()?;
        }
        let mut halves = Vec::with_capacity(self.facets.planes.len());
        for &(normal, offset) in &self.facets.planes {
            for plane in Shape::half_space(normal, offset)?.half_spaces()?.concat() {
                halves.push(Half {
                    error: plane.substitution_error(&to_shape.rows, &to_shape.error),
                    polynomial: plane.substituted(&to_shape.rows)?.without_w_factors(),
                });
            }
        }
        Ok(halves)
    }

    /// The boundary in model units; `None` if a plane is none of the formula's.
    ///
    /// `first`: index of the first of the planes among the half-spaces; `renamed`: the primitives
    /// that are left.
    pub(crate) fn boundary(
        &self,
        interned: &[(PrimitiveId, Sense)],
        first: usize,
        renamed: &[Option<PrimitiveId>],
    ) -> Option<KnownBoundary> {
        let mut positions = self.facets.positions.clone();
        let before = six_volumes(&positions, self.facets);
        for position in &mut positions {
            for transform in self.transforms.iter().rev() {
                *position = transform.apply(*position)?;
            }
        }
        let mirrored = before * six_volumes(&positions, self.facets) < 0.0;
        let facets = self.facets.triangles.iter().map(|facet| {
            let &(old, relative) = interned.get(first + facet.plane as usize)?;
            let [a, b, c] = facet.vertices;
            Some(KnownFacet {
                vertices: if mirrored { [a, c, b] } else { [a, b, c] },
                primitive: (*renamed.get(old.0 as usize)?)?,
                sense: match facet.sense {
                    Sense::Inside => relative,
                    Sense::Outside => relative.complement(),
                },
                material: self.material,
            })
        });
        Some(KnownBoundary {
            facets: facets.collect::<Option<_>>()?,
            positions,
        })
    }
}

/// Six times the volume that the triangles enclose; negative where they are seen from inside.
fn six_volumes(positions: &[DVec3], facets: &Facets) -> f64 {
    let at = |v: u32| positions.get(v as usize).copied().unwrap_or_default();
    let apex = positions.first().copied().unwrap_or_default();
    let tetrahedra = facets.triangles.iter().map(|facet| {
        let [a, b, c] = facet.vertices.map(|v| at(v) - apex);
        a.dot(b.cross(c))
    });
    tetrahedra.sum()
}
