//! STEP AP242: true surfaces and curves instead of triangles.
//!
//! Solids are written one by one, each as its own `MANIFOLD_SOLID_BREP` or `BREP_WITH_VOIDS`. Where
//! one of a solid's surfaces or curves has no true form in STEP, all of the solid is written as plane facets, and
//! [`Outcome::faceted`] says why: half of a solid in facets would not fit the other half.
//!
//! The crate step-io puts the entities into a file. Source: ISO 10303-242, ISO 10303-42.

mod closed;
mod cut;
mod describe;
mod exact;
mod faceted;
mod meridian;
mod quadric;
mod rational;
mod region;
mod revolution;
mod seam;
mod surface;

use super::{Error, GENERATOR, appearance};
use brep::{Brep, Crumbs, Curves, ExactBrep, Groups, ShellId, Shells, Valid};
use csg::{Aabb, Material, MaterialId, PrimitiveId, Solid};
use describe::{Described, NoForm};
use std::io::Write;
use step_io::build::{CurveInput, Part, StyleTarget, UnitsInput, VoidShellNormals};
use step_io::model::AdvancedFaceId;
use step_io::scene::Rgb;
use step_io::{AuthorError, StepBuilder};

/// Smallest size of facets: readers drop edges shorter than the accuracy that the file claims.
const FACET_SIZE: f64 = 4.0;

/// Accuracy of what is exact but for rounding, relative to the solid.
const EXACT: f64 = 1e-9;

/// What to write.
#[derive(Clone, PartialEq, Debug)]
pub struct Options {
    /// How long a model unit is, in millimetres: files are in millimetres.
    pub millimetres_per_unit: f64,
    /// Largest distance of spline curves from their surfaces, in model units; also written into
    /// the file as its accuracy.
    pub tolerance: f64,
    /// Features not larger than this, in model units, are left out: the mesh's tolerance.
    pub crumb_size: f64,
    /// Name of the part.
    pub name: String,
}

/// What was written.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Outcome {
    /// Number of solids.
    pub solids: usize,
    /// Solids left out, since they were crumbs.
    pub specks: usize,
    /// Faces on true surfaces.
    pub faces: usize,
    /// Surfaces that STEP has no entity of their own for, and what says them instead.
    pub substitutes: Vec<Substitute>,
    /// Edges written as splines.
    pub spline_edges: usize,
    /// Solids written as plane facets.
    pub faceted: Vec<Faceted>,
    /// What was merged away.
    pub crumbs: Crumbs,
}

/// A surface that STEP has no entity of its own for, said exactly by a more general one.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Substitute {
    /// The primitive.
    pub surface: PrimitiveId,
    /// What it is in the file.
    pub entity: &'static str,
    /// How many faces are on it.
    pub faces: usize,
}

/// A solid that has no true form in STEP.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Faceted {
    /// Its name in the file.
    pub name: String,
    /// Why.
    pub reason: String,
}

/// A file before it is written: which solids have a true form in STEP.
pub struct Plan<'a> {
    solid: &'a Solid,
    options: Options,
    exact: ExactBrep,
    solids: Vec<Planned>,
    specks: usize,
}

/// A solid that is to be written.
struct Planned {
    bounds: Aabb,
    described: Result<Described, NoForm>,
}

impl<'a> Plan<'a> {
    /// Finds true surfaces and curves. `solid` is what the boundary was made from; the boundary
    /// may be any mesh of it, however coarse: its faces, edges and vertices are what matters.
    ///
    /// # Errors
    /// [`Error::StrayVoid`] if a cavity lies in no solid.
    pub fn of(solid: &'a Solid, topology: &Valid<Brep>, options: Options) -> Result<Self, Error> {
        let groups = Groups::of(topology);
        let shells = Shells::of(topology);
        if !shells.stray_voids.is_empty() {
            return Err(Error::StrayVoid);
        }
        let diagonal = solid.extent.diagonal();
        let curves = Curves::of(topology, &groups, solid, 1e-3 * diagonal);
        let crumb_size = options.crumb_size;
        let exact = ExactBrep::of(topology, &groups, &shells, &curves, solid, crumb_size);
        let mut plan = Self {
            solid,
            options,
            exact,
            solids: Vec::new(),
            specks: 0,
        };
        for component in &shells.solids {
            let ShellId(outer) = component.outer;
            if plan.exact.shells[outer as usize].faces.is_empty() {
                plan.specks += 1;
                continue;
            }
            let voids = component.voids.iter().map(|&ShellId(at)| at as usize);
            let voids = voids.filter(|&at| !plan.exact.shells[at].faces.is_empty());
            let numbers: Vec<usize> = std::iter::once(outer as usize).chain(voids).collect();
            let described = plan.describe(topology, &numbers);
            let bounds = shells.shells[outer as usize].bounds;
            plan.solids.push(Planned { bounds, described });
        }
        Ok(plan)
    }

    /// Whether facets are needed for want of a true form.
    #[must_use]
    pub fn needs_facets(&self) -> bool {
        self.solids.iter().any(|solid| solid.described.is_err())
    }

    /// Solids that have no true form since the boundary's faces or edges were not told apart: a
    /// finer subdivision may do that.
    #[must_use]
    pub fn unresolved(&self) -> usize {
        let all = self.solids.iter();
        all.filter(|solid| matches!(&solid.described, Err(none) if none.is_unresolved))
            .count()
    }

    /// What the file claims: nothing but splines is less exact than numbers are.
    fn accuracy(&self) -> f64 {
        let diagonal = self.solid.extent.diagonal();
        let has_splines = self.solids.iter().any(|solid| {
            let curves = solid
                .described
                .iter()
                .flat_map(|described| &described.curves);
            curves
                .into_iter()
                .any(|(_, curve)| matches!(curve, CurveInput::Nurbs(_)))
        });
        if has_splines {
            self.options.tolerance
        } else {
            self.options.tolerance.min(EXACT * diagonal)
        }
    }

    /// Writes the file. `facets` is a mesh of the same solid, good enough for solids that have no
    /// true form.
    ///
    /// # Errors
    /// [`Error::Io`]; [`Error::Step`] if the file cannot be put together.
    pub fn write(self, facets: &Valid<Brep>, out: &mut impl Write) -> Result<Outcome, Error> {
        let options = &self.options;
        let accuracy = self.accuracy();
        let mut builder = StepBuilder::new_with(&UnitsInput {
            uncertainty: accuracy * options.millimetres_per_unit,
            ..UnitsInput::default()
        })
        .map_err(refused)?;
        let header = builder.header_mut();
        // A date would make every file different.
        header.time_stamp = String::new();
        header.file_name.clone_from(&options.name);
        GENERATOR.clone_into(&mut header.originating_system);
        let part = builder.part(&options.name);
        let mut file = File {
            builder,
            part,
            materials: &self.solid.materials,
            exact: &self.exact,
            scale: options.millimetres_per_unit,
            facet_size: FACET_SIZE * accuracy,
            outcome: Outcome {
                specks: self.specks,
                crumbs: self.exact.crumbs,
                ..Outcome::default()
            },
        };
        file.add_solids(&self.solids, facets)?;
        let outcome = file.outcome;
        step_io::write(&file.builder.finish(), out)?;
        Ok(outcome)
    }
}

#[expect(clippy::needless_pass_by_value, reason = "as map_err wants it")]
fn refused(error: AuthorError) -> Error {
    Error::Step {
        reason: error.to_string(),
    }
}

struct File<'a> {
    builder: StepBuilder,
    part: Part,
    materials: &'a [Material],
    exact: &'a ExactBrep,
    /// Millimetres in a model unit.
    scale: f64,
    /// Facets must be higher and longer than this, in model units.
    facet_size: f64,
    outcome: Outcome,
}

/// The faces of a solid, shell by shell, each with its material.
type ShellFaces = Vec<Vec<(AdvancedFaceId, MaterialId)>>;

impl File<'_> {
    /// Adds all solids: exactly if possible, else as facets.
    fn add_solids(&mut self, solids: &[Planned], facets: &Valid<Brep>) -> Result<(), Error> {
        let is_needed = solids.iter().any(|solid| solid.described.is_err());
        let clean = is_needed.then(|| faceted::without_slivers(facets, self.facet_size));
        let clean = clean.transpose()?;
        let facets = clean.as_ref().unwrap_or(facets);
        let mut lists = vec![Vec::new(); solids.len()];
        if is_needed {
            let boxes: Vec<Aabb> = solids.iter().map(|solid| solid.bounds).collect();
            match faceted::matching(&boxes, facets) {
                Some(matching) => lists = matching,
                None => return self.add_faceted_solids(solids, facets),
            }
        }
        for (at, (solid, facet_lists)) in solids.iter().zip(lists).enumerate() {
            let name = format!("solid {}", at + 1);
            let faces = match &solid.described {
                Ok(described) => self.exact_faces(described)?,
                Err(none) => {
                    self.outcome.faceted.push(Faceted {
                        name: name.clone(),
                        reason: none.reason.clone(),
                    });
                    self.faceted(facets, &facet_lists)?
                }
            };
            self.add(&name, &faces)?;
        }
        Ok(())
    }

    /// Adds the solids of a mesh as facets, for want of correspondence.
    fn add_faceted_solids(
        &mut self,
        solids: &[Planned],
        facets: &Valid<Brep>,
    ) -> Result<(), Error> {
        let reason = solids
            .iter()
            .find_map(|solid| solid.described.as_ref().err());
        let reason = reason.map_or("", |none| none.reason.as_str());
        let lists = faceted::of_solids(facets, &Shells::of(facets));
        for (at, lists) in lists.iter().enumerate() {
            let name = format!("solid {}", at + 1);
            let faces = self.faceted(facets, lists)?;
            self.add(&name, &faces)?;
            self.outcome.faceted.push(Faceted {
                name,
                reason: reason.to_owned(),
            });
        }
        Ok(())
    }

    /// Adds the solid with these faces.
    fn add(&mut self, name: &str, faces: &ShellFaces) -> Result<(), Error> {
        let ids = |list: &[(AdvancedFaceId, MaterialId)]| {
            list.iter().map(|&(id, _)| id).collect::<Vec<_>>()
        };
        let (builder, part) = (&mut self.builder, self.part);
        let target = if faces.len() == 1 {
            let id = builder.solid(part, name, ids(&faces[0])).map_err(refused)?;
            StyleTarget::Solid(id)
        } else {
            let voids = faces[1..].iter().map(|list| ids(list)).collect();
            let normals = VoidShellNormals::AwayFromMaterial;
            let id = builder.solid_with_voids(part, name, ids(&faces[0]), voids, normals);
            StyleTarget::VoidSolid(id.map_err(refused)?)
        };
        self.outcome.solids += 1;
        self.paint(target, faces)
    }

    /// Colours the solid, or its faces where they differ.
    fn paint(&mut self, solid: StyleTarget, faces: &ShellFaces) -> Result<(), Error> {
        let all: Vec<(AdvancedFaceId, MaterialId)> = faces.iter().flatten().copied().collect();
        let is_uniform = all.windows(2).all(|pair| pair[0].1 == pair[1].1);
        let targets: Vec<(StyleTarget, MaterialId)> = if is_uniform {
            all.first()
                .map(|&(_, material)| (solid, material))
                .into_iter()
                .collect()
        } else {
            let of_face = |(id, material)| (StyleTarget::Face(id), material);
            all.into_iter().map(of_face).collect()
        };
        for (target, id) in targets {
            let materials = self.materials;
            let is_painted = materials
                .get(id.0 as usize)
                .is_some_and(|material| material.color.is_some());
            if !is_painted {
                continue;
            }
            let [red, green, blue, alpha] = appearance::color(materials, id).map(f64::from);
            let transparency = (alpha < 1.0).then_some(1.0 - alpha);
            let color = Rgb { red, green, blue };
            self.builder
                .style(target, color, transparency)
                .map_err(refused)?;
        }
        Ok(())
    }
}
