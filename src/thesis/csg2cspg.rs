//! CSG2CSPG: shapes to half-spaces, differences to intersections, power form to Bézier form in the
//! six simplices of a box (thesis A.2).

use super::half_spaces::HalfSpaces;
use super::pipe::{DialectArgs, Order, Pipe, read_input};
use crate::failure::Failure;
use crate::run::clip_box;
use crate::talk::Talk;
use clap::Args;
use csg::{Aabb, Axis, Polynomial, Sense, Solid};
use glam::DVec3;
use io::thesis::sectors::{self, Sector, SectorPrimitive, Sectors};
use io::thesis::solid::{self, Instance, MatrixForm, material_number};
use io::thesis::tree::{Operation, Tree, TreeNode};
use std::cell::RefCell;
use subdiv::sectors::{bernstein_on_cube, sector_corners};

/// Options of CSG2CSPG, as in the thesis.
#[derive(Args, Debug)]
pub(crate) struct Csg2CspgArgs {
    /// The defaults: a box from -5 to 5, with which the solid is intersected
    #[arg(short = 'D', short_alias = 'd')]
    default: bool,
    /// Do not intersect the solid with the box
    #[arg(short = 'L', short_alias = 'l')]
    unlimited: bool,
    /// The box to subdivide
    #[arg(
        short = 'B',
        short_alias = 'b',
        num_args = 6,
        allow_negative_numbers = true,
        conflicts_with = "default",
        value_names = ["XMIN", "YMIN", "ZMIN", "XMAX", "YMAX", "ZMAX"]
    )]
    bounds: Option<Vec<f64>>,
    #[command(flatten)]
    pipe: Pipe,
    #[command(flatten)]
    dialect: DialectArgs,
    #[command(flatten)]
    order: Order,
}

/// Most half-spaces: what one sector's coefficients may reasonably take.
const MAX_HALF_SPACES: usize = 1 << 20;

pub(crate) fn run(args: Csg2CspgArgs, talk: Talk) -> Result<(), Failure> {
    let bounds = match args.bounds {
        Some(numbers) => clip_box(&numbers)?,
        None => Aabb {
            min: DVec3::splat(-5.0),
            max: DVec3::splat(5.0),
        },
    };
    let form = args.dialect.form();
    let target = args.pipe.target()?;
    let operators = args.dialect.operators();
    let (name, tree) = read_input(&args.pipe.input, |bytes| {
        solid::read(bytes, operators, form)
    })?;
    let converted = convert(&tree.value, form, &bounds, !args.unlimited);
    let sectors = converted.map_err(|error| Failure::from(error).of_input(&name))?;
    talk.explain(|| {
        let count = sectors.sectors.first().map_or(0, |s| s.primitives.len());
        format!("{count} half-spaces in 6 sectors")
    });
    crate::output::to_target(&target, |mut out| {
        let order = args.order.bytes();
        Ok(sectors::write(&sectors, operators, order, &mut out)?)
    })
}

/// A half-space; its place in the list is its name.
struct Named {
    material: i32,
    polynomial: Polynomial,
}

fn convert(
    tree: &Tree<Instance>,
    form: MatrixForm,
    bounds: &Aabb,
    limited: bool,
) -> Result<Sectors, csg::Error> {
    let mut named: Vec<Named> = Vec::new();
    let mut nodes: Vec<TreeNode<i32>> = Vec::new();
    if limited {
        // The solid, and then the box's planes.
        nodes.push(TreeNode::Operator(Operation::Intersection));
    }
    let mut complements = vec![false];
    for node in tree.nodes() {
        let outside = complements.pop().unwrap_or_default();
        match node {
            TreeNode::Operator(operation) => {
                let right = outside != (*operation == Operation::Difference);
                complements.extend([right, outside]);
                let is_union = (*operation == Operation::Union) != outside;
                nodes.push(TreeNode::Operator(if is_union {
                    Operation::Union
                } else {
                    Operation::Intersection
                }));
            }
            TreeNode::Leaf(instance) => {
                let spaces = HalfSpaces::of(instance, form)?;
                let is_union = spaces.is_union != outside;
                let polynomials = spaces.polynomials.into_iter();
                let polynomials = polynomials.map(|p| if outside { p.negated() } else { p });
                append(
                    polynomials.collect(),
                    is_union,
                    instance.material,
                    &mut nodes,
                    &mut named,
                );
            }
        }
        if named.len() > MAX_HALF_SPACES {
            return Err(csg::Error::TooManyLiterals {
                what: "half-spaces",
                found: named.len() as u64,
                limit: MAX_HALF_SPACES as u64,
            });
        }
    }
    if limited {
        let planes = (0..3).flat_map(|axis| {
            let normal = DVec3::AXES[axis];
            [
                Polynomial::affine(-normal, -bounds.min[axis]),
                Polynomial::affine(normal, bounds.max[axis]),
            ]
        });
        let planes = planes.collect::<Result<Vec<_>, _>>()?;
        append(planes, false, 1, &mut nodes, &mut named);
    }
    let (center, half) = (
        0.5 * (bounds.min + bounds.max),
        0.5 * (bounds.max - bounds.min),
    );
    let to_box = [
        [half.x, 0.0, 0.0, 0.0],
        [0.0, half.y, 0.0, 0.0],
        [0.0, 0.0, half.z, 0.0],
        [center.x, center.y, center.z, 1.0],
    ];
    for half_space in &mut named {
        half_space.polynomial = half_space.polynomial.substituted(&to_box)?;
    }
    let tree = Tree::new(nodes).ok_or(csg::Error::MisplacedNode { node: 0, child: 0 })?;
    Ok(in_sectors(tree, named, bounds))
}

/// A solid in the six sectors of its domain.
pub(crate) fn sectors_of(solid: &Solid) -> Sectors {
    let named = RefCell::new(Vec::new());
    let name = |material, polynomial| {
        let mut named = named.borrow_mut();
        named.push(Named {
            material,
            polynomial,
        });
        i32::try_from(named.len() - 1).unwrap_or(i32::MAX)
    };
    let tree = Tree::from_formula(
        solid.formula.nodes(),
        |literal| {
            let polynomial = &solid.primitives[literal.primitive.0 as usize].polynomial;
            let polynomial = match literal.sense {
                Sense::Inside => polynomial.clone(),
                Sense::Outside => polynomial.clone().negated(),
            };
            name(material_number(literal.material), polynomial)
        },
        |all| {
            let one = Polynomial::affine(DVec3::ZERO, if all { 1.0 } else { -1.0 });
            name(1, one.unwrap_or_else(|_| Polynomial::variable(Axis::X)))
        },
    );
    let cube = Aabb {
        min: solid.domain.from_unit(DVec3::ZERO),
        max: solid.domain.from_unit(DVec3::ONE),
    };
    in_sectors(tree, named.into_inner(), &cube)
}

/// Half-spaces, in coordinates from −1 to 1 in the box, in its six sectors.
fn in_sectors(tree: Tree<i32>, named: Vec<Named>, bounds: &Aabb) -> Sectors {
    let mut sectors: Vec<Sector> = sector_corners()
        .iter()
        .map(|corners| Sector {
            vertices: corners.map(|c| in_box(bounds, c).to_array()),
            primitives: Vec::with_capacity(named.len()),
        })
        .collect();
    for (name, half_space) in (0..).zip(named) {
        let polynomial = half_space.polynomial.without_w_factors();
        let forms = bernstein_on_cube(&polynomial);
        for (sector, coefficients) in sectors.iter_mut().zip(forms) {
            sector.primitives.push(SectorPrimitive {
                name,
                material: half_space.material,
                degree: polynomial.degree(),
                coefficients,
            });
        }
    }
    Sectors { tree, sectors }
}

/// The corner of the box at which a corner of the unit cube comes to lie, exactly.
pub(super) fn in_box(bounds: &Aabb, corner: DVec3) -> DVec3 {
    DVec3::select(corner.cmpgt(DVec3::splat(0.5)), bounds.max, bounds.min)
}

/// Half-spaces joined by one operation.
fn append(
    polynomials: Vec<Polynomial>,
    is_union: bool,
    material: i32,
    nodes: &mut Vec<TreeNode<i32>>,
    named: &mut Vec<Named>,
) {
    let operation = if is_union {
        Operation::Union
    } else {
        Operation::Intersection
    };
    let count = polynomials.len();
    for (at, polynomial) in polynomials.into_iter().enumerate() {
        if at + 1 < count {
            nodes.push(TreeNode::Operator(operation));
        }
        nodes.push(TreeNode::Leaf(
            i32::try_from(named.len()).unwrap_or(i32::MAX),
        ));
        named.push(Named {
            material,
            polynomial,
        });
    }
}
