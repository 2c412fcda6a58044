//! The programs under test behind one call each: a solid and a fineness to a mesh, one thread.

pub use crate::measure::Mesh;
use crate::solids::{Solid, Tree};
use crate::surfaces::Surface;
use fidget::context::Tree as Expression;
use fidget::jit::JitShape;
use fidget::mesh::{Octree, Settings};
use glam::DVec3;

/// Our conversion up to the indexed triangles, which is what fidget yields too.
pub fn ours(model: &csg::Model, rule: subdiv::Rule) -> subdiv::Outcome {
    let solid = csg::Solid::build(model, None).expect("a bounded solid");
    let mut settings = subdiv::Settings::new(rule);
    settings.threads = Some(1);
    subdiv::convert(&solid, &settings, &()).expect("a conversion within the limits")
}

/// Topology proved, then facets from the true surfaces, as a validated B-Rep.
pub fn ours_from_surfaces(
    model: &csg::Model,
    tolerance: f64,
    fit: brep::Fit,
    is_proved: bool,
) -> Option<brep::Valid<brep::Brep>> {
    let solid = csg::Solid::build(model, None).expect("a bounded solid");
    let rule = subdiv::Rule::Topology { finest: tolerance };
    let mut settings = subdiv::Settings::new(rule);
    settings.threads = Some(1);
    let outcome = subdiv::convert(&solid, &settings, &()).expect("a conversion within the limits");
    let stitched = brep::stitch(&outcome.fragments).expect("paired half-edges");
    let coarse = stitched.validate().expect("a manifold");
    let components = coarse.component_count();
    let proof = if is_proved && outcome.report.proved_topology == Some(true) {
        brep::Proof::BothWays { components }
    } else {
        brep::Proof::Nothing
    };
    let demand = brep::Demand {
        tolerance,
        fit,
        if_troubled: brep::IfTroubled::Refine,
        proof,
    };
    Some(brep::tessellate(&coarse, &solid, demand)?.0)
}

/// A B-Rep's triangles as a mesh.
pub fn brep_mesh(brep: &brep::Brep) -> Mesh {
    let numbers = brep.number_vertices();
    let corners = |facet: brep::FacetView<'_>| facet.vertices().map(|v| numbers[v.key()]);
    Mesh::new(
        brep.vertices().map(|v| v.position()).collect(),
        brep.facets().map(corners).collect(),
    )
}

/// The model of a solid's file.
pub fn model(solid: &Solid) -> csg::Model {
    let options = io::read::ReadOptions::default();
    let reading = io::read::scad_csg::read(solid.source, solid.name, &options);
    reading.expect("a readable model").model
}

/// Our triangles as a mesh.
pub fn our_mesh(fragments: &subdiv::Fragments) -> Mesh {
    let triangles = fragments.triangles.iter().map(|t| t.vertices);
    Mesh::new(fragments.positions.clone(), triangles.collect())
}

/// How fine fidget's octree is.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Levels of the octree.
    pub depth: u8,
    /// Half the side of its cube.
    pub half: f64,
    /// The cube's middle.
    pub middle: DVec3,
}

/// fidget from the expression on: compile, octree, triangles.
pub fn fidget(expression: &Expression, grid: Grid) -> fidget::mesh::Mesh {
    let shape = JitShape::from(expression.clone());
    let shape = shape.try_into().expect("only x, y and z");
    let middle = nalgebra::Vector3::from(grid.middle.to_array().map(|c| c as f32));
    let scaling = nalgebra::Matrix4::new_scaling(grid.half as f32);
    let settings = Settings {
        depth: grid.depth,
        world_to_model: scaling.append_translation(&middle),
        threads: None,
        ..Settings::default()
    };
    Octree::build(&shape, &settings)
        .expect("not cancelled")
        .walk_dual()
}

/// fidget's triangles as a mesh.
pub fn fidget_mesh(mesh: &fidget::mesh::Mesh) -> Mesh {
    let position = |v: &nalgebra::Vector3<f32>| DVec3::new(v.x.into(), v.y.into(), v.z.into());
    let corners = |t: &nalgebra::Vector3<usize>| [t.x, t.y, t.z].map(|i| i as u32);
    Mesh::new(
        mesh.vertices.iter().map(position).collect(),
        mesh.triangles.iter().map(corners).collect(),
    )
}

/// How a surface is written for fidget.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// The distance; for the heart the form with a cube root.
    Distance,
    /// The polynomial.
    Polynomial,
}

/// The solid as fidget wants it: min and max of implicit functions.
pub fn expression(solid: &Solid, form: Form) -> Expression {
    let leaves: Vec<_> = solid.surfaces.iter().map(|s| leaf(s, form)).collect();
    of_tree(&solid.tree, &leaves)
}

fn of_tree(tree: &Tree, leaves: &[Expression]) -> Expression {
    let all = |trees: &[Tree]| trees.iter().map(|t| of_tree(t, leaves)).collect();
    match tree {
        Tree::Leaf(at) => leaves[*at].clone(),
        Tree::Union(trees) => balanced(all(trees), |a, b| a.min(b)),
        Tree::Intersection(trees) => balanced(all(trees), |a, b| a.max(b)),
        Tree::Difference(trees) => {
            let first = of_tree(&trees[0], leaves);
            first.max(-balanced(all(&trees[1..]), |a, b| a.min(b)))
        }
    }
}

/// Pairs neighbours again and again, which suits fidget better than a chain.
fn balanced(
    mut all: Vec<Expression>,
    join: fn(Expression, Expression) -> Expression,
) -> Expression {
    while all.len() > 1 {
        let pairs = all.chunks(2).map(|pair| match pair {
            [a, b] => join(a.clone(), b.clone()),
            rest => rest[0].clone(),
        });
        all = pairs.collect();
    }
    all.pop().expect("operations have operands")
}

fn leaf(surface: &Surface, form: Form) -> Expression {
    let (x, y, z) = Expression::axes();
    let axes = [x.clone(), y.clone(), z.clone()];
    let from = |axis: usize, center: DVec3| axes[axis].clone() - center[axis] as f32;
    // r² − radius², or r − radius.
    let round = |square: Expression, radius: f64| match form {
        Form::Distance => square.sqrt() - radius as f32,
        Form::Polynomial => square - (radius * radius) as f32,
    };
    match *surface {
        Surface::Plane { normal, offset } => {
            let (axis, sign) = (0..3)
                .find_map(|k| (normal[k] != 0.0).then_some((k, normal[k])))
                .expect("axis-parallel planes only");
            let along = if sign > 0.0 {
                axes[axis].clone()
            } else {
                -axes[axis].clone()
            };
            along - offset as f32
        }
        Surface::Sphere { center, radius } => {
            let [u, v, w] = [0, 1, 2].map(|k| from(k, center).square());
            round(u + v + w, radius)
        }
        Surface::Cylinder {
            axis,
            center,
            radius,
        } => {
            let [u, v] = [1, 2].map(|k| from((axis + k) % 3, center).square());
            round(u + v, radius)
        }
        Surface::Torus { ring, tube } => match form {
            Form::Distance => {
                let rho = (x.square() + y.square()).sqrt() - ring as f32;
                (rho.square() + z.square()).sqrt() - tube as f32
            }
            Form::Polynomial => {
                let rho = x.square() + y.square();
                let s = rho.clone() + z.square() + (ring * ring - tube * tube) as f32;
                s.square() - rho * (4.0 * ring * ring) as f32
            }
        },
        Surface::Heart => {
            let u = x.square() + y.square() * 2.25 + z.square() - 1.0;
            let base = x.square() + y.square() * (9.0 / 80.0);
            match form {
                Form::Distance => u - z * (base.ln() * (1.0 / 3.0)).exp(),
                Form::Polynomial => u.square() * u - base * (z.square() * z),
            }
        }
    }
}
