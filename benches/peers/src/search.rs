//! From coarse to fine: what each program yields at many settings, and the coarsest that is close
//! enough.

use crate::manifold::Manifold;
use crate::measure::{Distances, Spread, measure};
use crate::solids::Solid;
use crate::tools::{self, Form, Grid};
use crate::truth::Truth;
use subdiv::Rule;

/// What a program is told.
#[derive(Clone, Copy, Debug)]
pub enum Setting {
    /// Ours.
    Ours(Rule),
    /// Ours from the true surfaces, with a tolerance; whether it is proved.
    Surfaces(f64, brep::Fit, bool),
    /// manifold3d's number of segments a circle.
    Manifold(u32),
    /// fidget's.
    Fidget(Form, Grid),
}

/// A setting and the mesh it gave.
#[derive(Clone, Copy, Debug)]
pub struct Attempt {
    /// What the program was told.
    pub setting: Setting,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// Its vertices that were not numbers.
    pub not_numbers: usize,
    /// How far it is from the truth.
    pub distances: Distances,
}

impl Attempt {
    fn of(setting: Setting, mesh: &tools::Mesh, truth: &Truth<'_>) -> Option<Self> {
        Some(Self {
            setting,
            triangles: mesh.triangles.len(),
            not_numbers: mesh.not_numbers,
            distances: measure(mesh, truth)?,
        })
    }

    /// The larger of both distances, of those that `which` picks.
    pub fn error(&self, which: fn(Spread) -> f64) -> f64 {
        which(self.distances.to_boundary).max(which(self.distances.to_mesh))
    }
}

/// Adds attempts until one has no error above `finest`.
fn until(finest: f64, attempts: impl Iterator<Item = Option<Attempt>>) -> Vec<Attempt> {
    let mut list = Vec::new();
    for attempt in attempts.flatten() {
        list.push(attempt);
        if attempt.error(|spread| spread.worst) <= finest {
            break;
        }
    }
    list
}

fn ours(
    rules: impl Iterator<Item = Rule>,
    model: &csg::Model,
    truth: &Truth<'_>,
    finest: f64,
) -> Vec<Attempt> {
    let attempts = rules.map(|rule| {
        let mesh = tools::our_mesh(&tools::ours(model, rule).fragments);
        Attempt::of(Setting::Ours(rule), &mesh, truth)
    });
    until(finest, attempts)
}

/// Our meshes at falling tolerances, eight to a factor of four.
pub fn our_tolerances(model: &csg::Model, truth: &Truth<'_>, finest: f64) -> Vec<Attempt> {
    let rule =
        |k: i32| Rule::Tolerance(0.25 * truth.longest_side * 0.25f64.powf(f64::from(k) / 8.0));
    ours((0..64).map(rule), model, truth, finest)
}

/// Parts of a target error at which our tolerance is tried: it is what is measured, nearly.
const NEAR: [f64; 10] = [1.5, 1.35, 1.2, 1.1, 1.0, 0.95, 0.9, 0.8, 0.7, 0.5];

/// Our meshes from the true surfaces, at tolerances near the targets.
pub fn our_surfaces(
    model: &csg::Model,
    truth: &Truth<'_>,
    targets: &[f64],
    fit: brep::Fit,
    is_proved: bool,
) -> Vec<Attempt> {
    let mut list = Vec::new();
    for target in targets {
        for part in NEAR {
            let tolerance = part * target * truth.longest_side;
            let Some(brep) = tools::ours_from_surfaces(model, tolerance, fit, is_proved) else {
                continue;
            };
            let setting = Setting::Surfaces(tolerance, fit, is_proved);
            list.extend(Attempt::of(setting, &tools::brep_mesh(&brep), truth));
        }
    }
    list
}

/// manifold3d's meshes with more and more segments.
pub fn manifold_segments(
    manifold: &Manifold,
    solid: &Solid,
    truth: &Truth<'_>,
    finest: f64,
) -> Vec<Attempt> {
    let segments = (0..40).map(|k| 2 * (4.0 * 1.12f64.powi(k)).round() as u32);
    let attempts = segments.map(|segments| {
        let mesh = manifold.mesh(solid.name, segments)?;
        Attempt::of(Setting::Manifold(segments), &mesh, truth)
    });
    until(finest, attempts)
}

/// Our meshes at rising levels.
pub fn our_levels(model: &csg::Model, truth: &Truth<'_>, finest: f64) -> Vec<Attempt> {
    ours((3..28).map(Rule::Level), model, truth, finest)
}

/// Sides of fidget's cube, in longest sides of the solid: a depth more halves the cells, and
/// these are the steps between.
const CUBES: [f64; 4] = [1.75, 1.47, 1.24, 1.04];

/// Levels tried.
const DEPTHS: std::ops::RangeInclusive<u8> = 2..=9;

/// fidget's meshes, by falling cell size.
pub fn fidget_grids(solid: &Solid, form: Form, truth: &Truth<'_>, finest: f64) -> Vec<Attempt> {
    let expression = tools::expression(solid, form);
    let grids = DEPTHS.flat_map(|depth| {
        CUBES.map(|cube| Grid {
            depth,
            half: 0.5 * cube * truth.longest_side,
            middle: truth.middle,
        })
    });
    let attempts = grids.map(|grid| {
        let mesh = tools::fidget_mesh(&tools::fidget(&expression, grid));
        Attempt::of(Setting::Fidget(form, grid), &mesh, truth)
    });
    until(finest, attempts)
}
