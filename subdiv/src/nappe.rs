//! One nappe of a quadric cone as one surface, for the metric rule (`crate::deviation`).
//!
//! A double cone is p = |u|² − v², with u two linear forms across the axis and v one along it, all
//! zero at the apex. A solid has one nappe only: its formula joins p with the plane v = 0, or the
//! plane is far away. The nappe is where f = |u| − v vanishes, and f is better than p by far:
//!
//! * p = f·(|u| + v). Where v ≥ μ ≥ 0, |f| ≥ δ(ω) = ω/(μ' + √(μ'² − ω)), μ' = max(μ, √ω), makes
//!   |p| ≥ ω; where v < 0 the plane decides. So with ω a bound on |p| in the mesh, the mesh has the
//!   nappe's side where |f| > δ(ω), the apex' own cell included (there δ = √ω).
//! * ∇f = û∘u − ∇v, û a unit vector, does not become small, and f is convex: where û is known but
//!   for σ, all gradients, those of the way included, are in a ball of radius |∇u|·σ. Where nothing is
//!   known of û, they make an angle with the axis whose tangent is |∇u|/|∇v|, so that even the
//!   apex has a direction in which it is left.

use crate::certify::{DegreeTable, Nappe, Sheet, remainder_bounds};
use crate::lattice::Point;
use crate::simplex::Simplex;
use crate::snap::RESIDUAL;
use crate::walk::Active;
use csg::{Domain, FormulaNode, Literal, Primitive, PrimitiveId, Sense, Surface, Ternary};
use glam::{DVec2, DVec3};

/// Planes that are off the one through the apex by more, relative to the cube, are other planes.
const SAME: f64 = 1e-9;

/// Most levels by which tips of needles are refined beyond the others: their cells grow in number as
/// they get thinner. Reached at half-angles of 0.9°.
const MOST_EXTRA: f64 = 18.0;

/// A primitive that is a double cone, in unit coordinates: p = ±(|u|² − v²).
#[derive(Clone, Debug)]
pub(crate) struct DoubleCone {
    apex: DVec3,
    /// Gradients of both parts of u.
    across: [DVec3; 2],
    /// Gradient of v, for one of its two orientations.
    along: DVec3,
    /// Whether p < 0 inside of the nappes, where |u| < |v|.
    negative_inside: bool,
    /// Bound on |p ∓ (|u|² − v²)|, the model's error included.
    error: f64,
    /// The plane v = 0.
    plane: Option<ApexPlane>,
}

/// A primitive that is a plane through the apex, across the axis.
#[derive(Clone, Copy, Debug)]
struct ApexPlane {
    primitive: PrimitiveId,
    /// Whether its polynomial grows with v.
    grows: bool,
    /// Bound on how far it is from v, in units of v.
    error: f64,
}

/// Which nappe a leaf has.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Facing {
    /// 1, or −1 where the nappe is that of negative v.
    sign: f64,
    /// Whether the formula's plane through the apex is what leaves only this one.
    pub(crate) by_plane: bool,
    /// That plane, if the formula has it for nothing else.
    pub(crate) absorbed: Option<u32>,
}

impl DoubleCone {
    /// Of each primitive.
    #[must_use]
    pub(crate) fn all(primitives: &[Primitive], domain: &Domain) -> Vec<Option<Self>> {
        let of = |primitive| Self::of(primitive, domain, primitives);
        primitives.iter().map(of).collect()
    }

    fn of(primitive: &Primitive, domain: &Domain, all: &[Primitive]) -> Option<Self> {
        if primitive.polynomial.degree() != 2 {
            return None;
        }
        let (apex, axis) = match primitive.surface(domain) {
            Surface::Cone { apex, axis, .. } => (apex, [axis.any_orthonormal_vector(), axis]),
            Surface::Quadric(form) if form.kind == csg::QuadricKind::EllipticCone => {
                (form.center, [form.axes[0], form.axes[2]])
            }
            _ => return None,
        };
        let apex = domain.to_centered(apex);
        let [x, z] = axis;
        let y = z.cross(x);
        let c = primitive.polynomial.coefficients();
        let value = |d: DVec3| {
            d.x * (c[0] * d.x + c[1] * d.y + c[2] * d.z)
                + d.y * (c[4] * d.y + c[5] * d.z)
                + c[7] * d.z * d.z
        };
        let values = [x, y, z].map(value);
        let negative_inside = values[2] < 0.0;
        // Σ values·(axis·(X − apex))², coefficient by coefficient against p's.
        let mut rest = [0.0; 10];
        rest.copy_from_slice(c.get(..10)?);
        for (axis, value) in [x, y, z].into_iter().zip(values) {
            let form = [axis.x, axis.y, axis.z, -axis.dot(apex)];
            let mut at = 0;
            for i in 0..4 {
                for j in i..4 {
                    let twice = if i == j { 1.0 } else { 2.0 };
                    rest[at] -= twice * value * form[i] * form[j];
                    at += 1;
                }
            }
        }
        let largest =
            values.iter().fold(0.0f64, |m, v| m.max(v.abs())) * (1.0 + apex.length_squared());
        let error = rest.iter().map(|r| r.abs()).sum::<f64>()
            + primitive.coefficient_error
            + 256.0 * f64::EPSILON * largest;
        // Half a unit is one centred one.
        let scaled = [x, y, z].into_iter().zip(values);
        let mut scaled = scaled.map(|(axis, value)| axis * (2.0 * value.abs().sqrt()));
        let across = [scaled.next()?, scaled.next()?];
        let along = scaled.next()?;
        let mut cone = Self {
            apex: 0.5 * apex + 0.5,
            across,
            along,
            negative_inside,
            error,
            plane: None,
        };
        cone.plane = (0..)
            .zip(all)
            .find_map(|(at, plane)| cone.as_apex_plane(at, plane));
        Some(cone)
    }

    fn as_apex_plane(&self, at: u32, plane: &Primitive) -> Option<ApexPlane> {
        let [a, b, c, d] = *plane.polynomial.coefficients() else {
            return None;
        };
        let normal = DVec3::new(a, b, c);
        // The same factor for all: v in centred coordinates is along·(X − apex)/2.
        let scale = 0.5 * self.along.length() / normal.length();
        let grows = normal.dot(self.along) > 0.0;
        let factor = if grows { scale } else { -scale };
        let off = normal * factor - 0.5 * self.along;
        let offset = d * factor + 0.5 * self.along.dot(2.0 * self.apex - 1.0);
        let error = off.abs().element_sum()
            + offset.abs()
            + scale * plane.coefficient_error
            + 64.0 * f64::EPSILON * self.along.length();
        (plane.polynomial.degree() == 1 && error <= SAME * self.along.length()).then_some(
            ApexPlane {
                primitive: PrimitiveId(at),
                grows,
                error,
            },
        )
    }

    /// The apex, in unit coordinates.
    #[must_use]
    pub(crate) fn apex(&self) -> DVec3 {
        self.apex
    }

    /// Largest distance of a simplex' vertices from the apex.
    #[must_use]
    pub(crate) fn reach_of(&self, simplex: &Simplex) -> f64 {
        let corners = simplex.vertices.map(|v| v.position().distance(self.apex));
        corners.into_iter().fold(0.0, f64::max)
    }

    /// The primitive that is the plane through the apex across the axis, if there is one.
    #[must_use]
    pub(crate) fn apex_plane(&self) -> Option<PrimitiveId> {
        self.plane.map(|plane| plane.primitive)
    }

    /// u and v of a way from the apex, in any unit.
    #[must_use]
    pub(crate) fn across_and_along(&self, way: DVec3) -> (DVec2, f64) {
        let [x, y] = self.across;
        (DVec2::new(x.dot(way), y.dot(way)), self.along.dot(way))
    }

    /// How many levels deeper than elsewhere its tip is bisected: until cells are as much smaller
    /// than the tolerance as the cone is thinner than it is long.
    #[must_use]
    pub(crate) fn extra_levels(&self) -> u8 {
        let sharpness = self.widest() / self.along.length();
        let levels = (3.0 * sharpness.log2()).ceil().clamp(0.0, MOST_EXTRA);
        levels as u8
    }

    /// Largest |∇(e·u)| for unit vectors e.
    fn widest(&self) -> f64 {
        self.across[0].length().max(self.across[1].length())
    }

    /// v at the vertices.
    fn heights(&self, simplex: &Simplex) -> [f64; 4] {
        let at = |v: Point| self.along.dot(v.position() - self.apex);
        simplex.vertices.map(at)
    }

    /// The only nappe that a simplex' surroundings may have: because v has one sign within
    /// `radius`, or because the formula joins each literal of `primitive`, which is this cone, with
    /// the plane through the apex.
    #[must_use]
    pub(crate) fn facing(
        &self,
        primitive: u32,
        formula: &[FormulaNode],
        simplex: &Simplex,
        radius: f64,
    ) -> Option<Facing> {
        let slack = self.along.length() * (radius + 1e-12);
        let heights = self.heights(simplex);
        let one_way = |sign: f64| heights.iter().all(|v| sign * v > slack);
        if let Some(sign) = [1.0, -1.0].into_iter().find(|&sign| one_way(sign)) {
            return Some(Facing {
                sign,
                by_plane: false,
                absorbed: None,
            });
        }
        let plane = self.plane?;
        let (mut joined, mut sign) = (0, None);
        for (at, node) in formula.iter().enumerate() {
            let is_union = match node {
                FormulaNode::Union { .. } => true,
                FormulaNode::Intersection { .. } => false,
                FormulaNode::Literal(_) => continue,
            };
            let children = || Children {
                formula,
                next: at + 1,
                end: at + node.span(),
            };
            let sense_of = |wanted: PrimitiveId| {
                children()
                    .find(|literal| literal.primitive == wanted)
                    .map(|literal| literal.sense)
            };
            let Some(sense) = sense_of(PrimitiveId(primitive)) else {
                continue;
            };
            // Inside of the nappe and of the plane, or outside of either.
            let is_inner = (sense == Sense::Inside) == self.negative_inside;
            let of_plane = sense_of(plane.primitive)?;
            if is_inner == is_union {
                return None;
            }
            let selects_negative = (of_plane == Sense::Inside) == is_inner;
            let this = if selects_negative == plane.grows {
                -1.0
            } else {
                1.0
            };
            if sign.is_some_and(|sign| sign != this) {
                return None;
            }
            sign = Some(this);
            joined += 1;
        }
        let count = |wanted: u32| {
            let is_it = |node: &&FormulaNode| matches!(node, FormulaNode::Literal(literal) if literal.primitive.0 == wanted);
            formula.iter().filter(is_it).count()
        };
        if joined == 0 || count(primitive) != joined {
            return None;
        }
        Some(Facing {
            sign: sign?,
            by_plane: true,
            absorbed: (count(plane.primitive.0) == joined).then_some(plane.primitive.0),
        })
    }

    /// The nappe in a simplex, for neighbourhoods of up to `tolerance`.
    ///
    /// `coefficients`: those of p.
    #[must_use]
    pub(crate) fn sheet(
        &self,
        facing: Facing,
        (active, coefficients): (&Active, &[f64]),
        table: &DegreeTable,
        simplex: &Simplex,
        tolerance: f64,
    ) -> Sheet {
        let swing = if active.value == Ternary::Unknown {
            let (low, high) = remainder_bounds(table, coefficients);
            8.0 * active.error() + high - low + 2.0 * RESIDUAL * active.largest
        } else {
            0.0
        };
        let swing = swing + self.error;
        let least = self.heights(simplex).map(|v| facing.sign * v).into_iter();
        let least = least.fold(f64::INFINITY, f64::min);
        let farther = least - 2.0 * tolerance * self.along.length();
        let plane = self.plane.map_or(0.0, |plane| plane.error);
        let swing_of_nappe = thickness(swing, least) + thickness(self.error, farther) + 2.0 * plane;

        let corners = simplex.vertices.map(Point::position);
        let middle = corners.iter().sum::<DVec3>() * 0.25;
        let radius = corners
            .iter()
            .map(|c| c.distance(middle))
            .fold(0.0, f64::max)
            + 2.0 * tolerance;
        let [x, y] = self.across;
        let widest = self.widest();
        let inward = self.along * facing.sign;
        let height = self.along.length();
        // Anywhere around the axis.
        let mut normal = -inward;
        let mut spread = height * widest / height.hypot(widest);
        let (across, _) = self.across_and_along(middle - self.apex);
        let sine = widest * radius / across.length();
        if sine < 1.0 {
            // The chord to an angle of that sine is no longer than √2 times it.
            let unit = across / across.length();
            let here = x * unit.x + y * unit.y - inward;
            let around = std::f64::consts::SQRT_2 * sine * widest;
            if around * normal.length() < spread * here.length() {
                (normal, spread) = (here, around);
            }
        }
        let sign = if self.negative_inside { 1.0 } else { -1.0 };
        let slope = normal.length();
        let least_across = x.length().min(y.length());
        let nappe = Nappe {
            by_plane: facing.by_plane,
            blunt: least < 0.0 || least * least < swing,
        };
        Sheet::of_nappe(
            nappe,
            crate::bernstein::vertex_values(2, coefficients),
            normal * (sign / slope),
            [slope, spread * (1.0 + 1e-12)],
            [
                swing_of_nappe * (1.0 + 1e-12),
                height.hypot(least_across) * (1.0 - 1e-12),
            ],
        )
    }
}

/// δ(ω) where v ≥ μ.
fn thickness(swing: f64, least: f64) -> f64 {
    let least = least.max(swing.sqrt());
    if least == 0.0 {
        return 0.0;
    }
    swing / (least + (least * least - swing).max(0.0).sqrt())
}

/// The literals that are direct children of an operator.
struct Children<'a> {
    formula: &'a [FormulaNode],
    next: usize,
    end: usize,
}

impl Iterator for Children<'_> {
    type Item = Literal;

    fn next(&mut self) -> Option<Literal> {
        while self.next < self.end {
            let node = self.formula.get(self.next)?;
            self.next += node.span();
            if let FormulaNode::Literal(literal) = node {
                return Some(*literal);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests;
