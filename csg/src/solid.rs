//! What the subdivision works on: interned primitives, one formula, a domain.

use crate::{Aabb, Domain, Formula, KnownBoundary, Polynomial, PrimitiveId};

/// A polynomial half-space boundary shared by all literals that mean the same surface.
#[derive(Clone, PartialEq, Debug)]
pub struct Primitive {
    /// `p`, in the domain's centred coordinates, scaled so that the largest coefficient has absolute
    /// value 1; negative inside.
    pub polynomial: Polynomial,
    /// Bound on the sum of its coefficients' absolute errors against the model as written, so also
    /// on the error of its values in the domain.
    pub coefficient_error: f64,
}

/// What a facet looks like.
#[derive(Clone, PartialEq, Debug)]
pub struct Material {
    /// Red, green, blue, alpha, each in [0, 1]; `None` for parts that were given no colour.
    pub color: Option<[f32; 4]>,
}

/// Two primitives that differ by so little that they were probably meant to be one.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct NearlyEqual {
    /// The first primitive.
    pub first: PrimitiveId,
    /// The second one.
    pub second: PrimitiveId,
    /// Largest difference of their coefficients, both scaled to a largest coefficient of 1.
    pub difference: f64,
}

/// A primitive whose coefficients have lost digits to cancellation.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Imprecise {
    /// The primitive.
    pub primitive: PrimitiveId,
    /// Bound on the error of its values in the domain, relative to the size that three quarters of
    /// them exceed.
    pub uncertainty: f64,
}

/// A solid ready for subdivision: a Boolean formula over interned polynomial half-spaces.
///
/// Guarantees: every literal's primitive and material exist; no two primitives are equal up to a
/// factor; the solid (the formula's point set) lies inside `extent`, which lies strictly inside
/// `domain`. An empty solid has the formula `Union { len: 0 }` and no primitives.
#[derive(Clone, PartialEq, Debug)]
pub struct Solid {
    /// The cube to subdivide.
    pub domain: Domain,
    /// Bounding box of the solid, in model units (exact for most shapes, never too small).
    pub extent: Aabb,
    /// The primitives, indexed by [`PrimitiveId`].
    pub primitives: Vec<Primitive>,
    /// The formula over them.
    pub formula: Formula,
    /// The materials, indexed by [`MaterialId`](crate::MaterialId).
    pub materials: Vec<Material>,
    /// Whether a clip box was intersected with the solid (asked for, or needed since unbounded).
    pub clipped: bool,
    /// Pairs of primitives that are suspiciously close to each other.
    pub nearly_equal: Vec<NearlyEqual>,
    /// Primitives with few digits left.
    pub imprecise: Vec<Imprecise>,
    /// The boundary, where the whole solid is one polyhedron that was given by its faces.
    pub known_boundary: Option<KnownBoundary>,
}
