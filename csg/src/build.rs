//! From a model to a solid: survey, extent, domain, half-spaces, interning, simplification.

use crate::extent::extent;
use crate::facets::RootFacets;
use crate::intern::{Interned, intern};
use crate::lower::{Half, Lowered, Region, Token};
use crate::matrix::{Bounded, IDENTITY};
use crate::precision::imprecise;
use crate::simplify::{Simplified, simplify};
use crate::survey::Survey;
use crate::{
    Aabb, Domain, DomainFit, Error, Formula, FormulaNode, MaterialId, Model, NearlyEqual,
    Polynomial, Primitive, PrimitiveId, Sense, Solid,
};
use glam::DVec3;

impl Solid {
    /// Turns a model into a formula over interned primitives.
    ///
    /// `clip`, in model units, is intersected with the solid unless the solid is known to lie in
    /// it. Cost: near linear in the number of half-spaces that the model expands to.
    ///
    /// # Errors
    /// [`Error::BadClipBox`]; [`Error::MisplacedNode`], [`Error::UnknownMaterial`] and
    /// [`Error::TooManyLiterals`] for unsound or too large models; [`Error::Unbounded`] when no
    /// box is given and none is found; [`Error::NoDigitsLeft`] where coefficients cancel;
    /// [`Error::NonFinite`] and [`Error::ExtentOutOfRange`] when numbers are beyond floating point.
    pub fn build(model: &Model, clip: Option<Aabb>) -> Result<Self, Error> {
        Self::build_fitted(model, clip, DomainFit::default())
    }

    /// The same in a domain of another size and position.
    ///
    /// # Errors
    /// Those of [`Solid::build`].
    pub fn build_fitted(model: &Model, clip: Option<Aabb>, fit: DomainFit) -> Result<Self, Error> {
        if clip.is_some_and(|clip| !has_volume(&clip) || !clip.is_finite()) {
            return Err(Error::BadClipBox);
        }
        let survey = Survey::of(model)?;
        let constant = survey.constant(model.root());
        let mut bounds = match constant {
            Some(true) => Aabb::EVERYWHERE,
            Some(false) => Aabb::EMPTY,
            None => extent(model, &survey)?,
        };
        let clip = clip.filter(|clip| clip.intersection(&bounds) != bounds);
        if let Some(clip) = &clip {
            bounds = bounds.intersection(clip);
        }
        // Without interior there is no regularized solid.
        if !has_volume(&bounds) {
            return Ok(Self::empty(model, clip.is_some()));
        }
        if !bounds.is_finite() {
            return Err(Error::Unbounded);
        }
        let domain = domain_around(&bounds, fit)?;
        let mut lowered = match constant {
            Some(_) => Lowered::new(Region::Cube),
            None => Lowered::of(model, &survey, &to_model(&domain), Region::Cube)?,
        };
        if let Some(clip) = &clip {
            intersect(&mut lowered, clip, &domain)?;
        }
        // Its planes come last; the formula does not name these copies of them.
        let given = RootFacets::of(model).filter(|_| clip.is_none());
        let first_given = lowered.halves.len();
        if let Some(given) = &given {
            lowered.halves.extend(given.halves(&to_model(&domain))?);
        }
        let mut interned = intern(&lowered.halves)?;
        if clip.is_none() && !imprecise(&interned.primitives)?.is_empty() {
            // Outside of its extent noise could make the solid reach the domain's walls.
            let room = 0.01 * (bounds.max - bounds.min).max_element();
            let around = Aabb {
                min: bounds.min - room,
                max: bounds.max + room,
            };
            intersect(&mut lowered, &around, &domain)?;
            interned = intern(&lowered.halves)?;
        }
        let nodes = match simplify(&lowered.tokens, &interned.of_half) {
            Simplified::Nodes(nodes) => nodes,
            Simplified::Constant { all: false } => return Ok(Self::empty(model, clip.is_some())),
            Simplified::Constant { all: true } => return Err(Error::Unbounded),
        };
        // Facets may be too small for the formula to name their planes.
        let planes = interned.of_half.get(first_given..).unwrap_or_default();
        let planes: Vec<PrimitiveId> = planes.iter().map(|(plane, _)| *plane).collect();
        let used = used_only(nodes, &planes, &mut interned);
        let known_boundary =
            given.and_then(|given| given.boundary(&interned.of_half, first_given, &used.renamed));
        let Used {
            nodes,
            primitives,
            nearly_equal,
            ..
        } = used;
        let Some(formula) = Formula::new(nodes) else {
            return Ok(Self::empty(model, clip.is_some()));
        };
        Ok(Self {
            imprecise: imprecise(&primitives)?,
            domain,
            extent: bounds,
            primitives,
            formula,
            materials: model.materials().to_vec(),
            clipped: clip.is_some(),
            // Nothing depends on where the planes of a known boundary meet.
            nearly_equal: match known_boundary {
                Some(_) => Vec::new(),
                None => nearly_equal,
            },
            known_boundary,
        })
    }

    /// The empty solid.
    fn empty(model: &Model, clipped: bool) -> Self {
        let unit = Aabb {
            min: DVec3::ZERO,
            max: DVec3::ONE,
        };
        Self {
            domain: Domain::around(&unit),
            extent: Aabb::EMPTY,
            primitives: Vec::new(),
            formula: Formula::empty(),
            materials: model.materials().to_vec(),
            clipped,
            nearly_equal: Vec::new(),
            imprecise: Vec::new(),
            known_boundary: None,
        }
    }
}

fn has_volume(bounds: &Aabb) -> bool {
    bounds.min.cmplt(bounds.max).all()
}

/// The domain of a solid, if it has enough digits to tell the solid's points apart.
fn domain_around(bounds: &Aabb, fit: DomainFit) -> Result<Domain, Error> {
    let domain = Domain::fitted(bounds, fit);
    let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let size = domain.size();
    let exponent_in_range = (1e-100..1e100).contains(&size);
    if exponent_in_range && domain.center().is_finite() && size > 1e-12 * farthest {
        Ok(domain)
    } else {
        Err(Error::ExtentOutOfRange)
    }
}

/// From the domain's centred coordinates to the model's, for row vectors.
fn to_model(domain: &Domain) -> Bounded {
    let mut rows = IDENTITY;
    for (axis, row) in rows.iter_mut().take(3).enumerate() {
        row[axis] = domain.half_size();
    }
    rows[3][..3].copy_from_slice(&domain.center().to_array());
    Bounded::exact(rows)
}

/// Intersects a lowered formula with the clip box.
fn intersect(lowered: &mut Lowered, clip: &Aabb, domain: &Domain) -> Result<(), Error> {
    let frame = to_model(domain);
    let mut planes = Vec::with_capacity(6);
    for (axis, normal) in DVec3::AXES.into_iter().enumerate() {
        planes.push(Polynomial::affine(-normal, -clip.min[axis])?);
        planes.push(Polynomial::affine(normal, clip.max[axis])?);
    }
    lowered.tokens.insert(0, Token::Open { union: false });
    for plane in planes {
        let half = Half {
            error: plane.substitution_error(&frame.rows, &frame.error),
            polynomial: plane.substituted(&frame.rows)?,
        };
        lowered.push(half, Sense::Inside, MaterialId(0));
    }
    lowered.tokens.push(Token::Close);
    Ok(())
}

/// What of the interned primitives a formula needs.
struct Used {
    nodes: Vec<FormulaNode>,
    primitives: Vec<Primitive>,
    nearly_equal: Vec<NearlyEqual>,
    /// By old number.
    renamed: Vec<Option<PrimitiveId>>,
}

/// Drops primitives that neither the formula needs nor `others` name, and numbers the rest by first
/// occurrence.
fn used_only(mut nodes: Vec<FormulaNode>, others: &[PrimitiveId], interned: &mut Interned) -> Used {
    let all = std::mem::take(&mut interned.primitives);
    let mut known: Vec<Option<Primitive>> = all.into_iter().map(Some).collect();
    let mut renamed: Vec<Option<PrimitiveId>> = vec![None; known.len()];
    let mut primitives = Vec::new();
    let mut rename = |PrimitiveId(old): PrimitiveId| {
        let old = old as usize;
        if let Some(primitive) = known[old].take() {
            renamed[old] = Some(PrimitiveId(
                u32::try_from(primitives.len()).unwrap_or(u32::MAX),
            ));
            primitives.push(primitive);
        }
        renamed[old]
    };
    for node in &mut nodes {
        if let FormulaNode::Literal(literal) = node
            && let Some(id) = rename(literal.primitive)
        {
            literal.primitive = id;
        }
    }
    for other in others {
        rename(*other);
    }
    let pair = |pair: &NearlyEqual| {
        let first = renamed[pair.first.0 as usize]?;
        let second = renamed[pair.second.0 as usize]?;
        Some(NearlyEqual {
            first: first.min(second),
            second: first.max(second),
            difference: pair.difference,
        })
    };
    let nearly_equal = interned.nearly_equal.iter().filter_map(pair).collect();
    Used {
        nodes,
        primitives,
        nearly_equal,
        renamed,
    }
}
