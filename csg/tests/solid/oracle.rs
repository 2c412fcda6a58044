//! Membership in a model by its definition, with closed formulas for the shapes, and random
//! models: what the lowered solids are compared with.

use csg::{Model, ModelBuilder, Node, NodeId, Polynomial, Shape, Transform};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

/// Whether a point lies in a model.
pub(crate) fn contains(model: &Model, point: DVec3) -> bool {
    node_contains(model, model.root(), point)
}

fn node_contains(model: &Model, id: NodeId, point: DVec3) -> bool {
    let holds = |child: &NodeId| node_contains(model, *child, point);
    match model.node(id) {
        Node::Shape(shape) => shape_contains(shape, point),
        Node::Union(children) => children.iter().any(holds),
        Node::Intersection(children) => !children.is_empty() && children.iter().all(holds),
        Node::Difference(children) => match children.split_first() {
            Some((first, rest)) => holds(first) && !rest.iter().any(holds),
            None => false,
        },
        Node::Complement(child) => !holds(child),
        Node::Painted(_, child) => holds(child),
        Node::Instance(transform, child) => transform
            .inverse()
            .apply(point)
            .is_some_and(|local| node_contains(model, *child, local)),
    }
}

/// Whether a point lies in a shape, by its geometric definition.
pub(crate) fn shape_contains(shape: &Shape, p: DVec3) -> bool {
    let across = p.truncate().length();
    let radius_at = |radii: [f64; 2], [z0, z1]: [f64; 2]| {
        radii[0] + (radii[1] - radii[0]) * (p.z - z0) / (z1 - z0)
    };
    let between = |[z0, z1]: [f64; 2]| z0 <= p.z && p.z <= z1;
    match shape {
        Shape::Block(s) => p.cmpge(s.min()).all() && p.cmple(s.max()).all(),
        Shape::Ellipsoid(s) => (p / s.radii()).length() <= 1.0,
        Shape::Cylinder(s) => across <= s.radius() && between(s.ends()),
        Shape::Frustum(s) => between(s.ends()) && across <= radius_at(s.radii(), s.ends()),
        Shape::Torus(s) => DVec2::new(across - s.ring(), p.z).length() <= s.tube(),
        Shape::HalfSpace(s) => s.normal().dot(p) <= s.offset(),
        Shape::Quadric(s) => s.polynomial().evaluate(p) <= 0.0,
        Shape::Polynomial(q) => q.evaluate(p) <= 0.0,
        Shape::Helicoid(_) => {
            let u = p.z - 0.5;
            let cubic = p.y * u * (2.265_481_6 * u * u - std::f64::consts::PI);
            across <= 1.0 && between([0.0, 1.0]) && p.x * (4.0 * u * u - 1.0) + cubic <= 0.0
        }
        Shape::Prism(s) => {
            // In the sector between two vertices, the distance along the middle counts.
            let step = std::f64::consts::TAU / f64::from(s.sides());
            let angle = p.y.atan2(p.x).rem_euclid(step) - step / 2.0;
            let apothem = (step / 2.0).cos() * radius_at(s.radii(), s.ends());
            between(s.ends()) && across * angle.cos() <= apothem
        }
        Shape::ConvexPolyhedron(s) => s.planes().iter().all(|h| h.normal().dot(p) <= h.offset()),
    }
}

/// Points near one another: where they do not all agree, a boundary is near.
pub(crate) fn near(point: DVec3, distance: f64) -> impl Iterator<Item = DVec3> {
    let corner = move |at: usize| {
        let side = |axis: usize| {
            if at >> axis & 1 == 1 {
                distance
            } else {
                -distance
            }
        };
        DVec3::new(side(0), side(1), side(2))
    };
    (0..8).map(move |at| point + corner(at))
}

/// The value at a point, unless a boundary is near.
pub(crate) fn clear_value(model: &Model, point: DVec3) -> Option<bool> {
    let value = contains(model, point);
    near(point, 1e-7)
        .all(|p| contains(model, p) == value)
        .then_some(value)
}

pub(crate) fn vector(low: f64, high: f64) -> impl Strategy<Value = DVec3> {
    proptest::array::uniform3(low..high).prop_map(DVec3::from)
}

/// An octahedron with its faces wound at random.
pub(crate) fn octahedron(flips: u8) -> Shape {
    let vertices = [
        DVec3::X,
        -DVec3::X,
        DVec3::Y,
        -DVec3::Y,
        DVec3::Z,
        -DVec3::Z,
    ];
    let mut faces = Vec::new();
    for at in 0..8_usize {
        let pick = |axis: usize| 2 * axis + (at >> axis & 1);
        let mut face = vec![pick(0), pick(1), pick(2)];
        if flips >> at & 1 == 1 {
            face.reverse();
        }
        faces.push(face);
    }
    Shape::convex_polyhedron(&vertices, &faces).unwrap()
}

/// (x² + 9/4 y² + z² − 1)³ − x² z³ − 9/80 y² z³.
pub(crate) fn heart() -> Polynomial {
    let form = |terms: &[([usize; 3], f64)], degree| Polynomial::from_terms(degree, terms).unwrap();
    let round = form(
        &[
            ([2, 0, 0], 1.0),
            ([0, 2, 0], 2.25),
            ([0, 0, 2], 1.0),
            ([0, 0, 0], -1.0),
        ],
        2,
    );
    let notch = form(&[([2, 0, 3], 1.0), ([0, 2, 3], 9.0 / 80.0)], 5);
    round.power(3).unwrap().difference(&notch).unwrap()
}

/// Bounded shapes of every kind, about one unit large.
pub(crate) fn bounded_shape() -> impl Strategy<Value = Shape> {
    let size = || 0.3..1.5_f64;
    let ends = || (-1.0..0.0_f64, 0.2..1.0_f64);
    prop_oneof![
        vector(0.2, 1.0).prop_map(|v| Shape::block(-v, v * 0.7).unwrap()),
        vector(0.3, 1.5).prop_map(|v| Shape::ellipsoid(v).unwrap()),
        size().prop_map(|r| Shape::sphere(r).unwrap()),
        (size(), ends()).prop_map(|(r, (a, b))| Shape::cylinder(r, a, b).unwrap()),
        (size(), size(), ends()).prop_map(|(r, s, (a, b))| Shape::frustum(r, s, a, b).unwrap()),
        (size(), ends(), any::<bool>()).prop_map(|(r, (a, b), up)| {
            let (low, high) = if up { (r, 0.0) } else { (0.0, r) };
            Shape::frustum(low, high, a, b).unwrap()
        }),
        (0.0..1.2_f64, 0.2..0.8_f64).prop_map(|(r, t)| Shape::torus(r, t).unwrap()),
        Just(Shape::helicoid()),
        (3..9_u32, size(), 0.0..1.0_f64, ends())
            .prop_map(|(n, r, s, (a, b))| Shape::prism(n, r, s, a, b).unwrap()),
        any::<u8>().prop_map(octahedron),
        Just(Shape::Polynomial(heart())),
    ]
}

/// Shapes that may be unbounded as well.
pub(crate) fn any_shape() -> impl Strategy<Value = Shape> {
    let cubic = proptest::collection::vec(-1.0..1.0, 20)
        .prop_map(|c| Shape::Polynomial(Polynomial::new(3, c).unwrap()));
    let quadric = proptest::array::uniform4(proptest::array::uniform4(-1.0..1.0))
        .prop_map(|m| Shape::quadric(&m).unwrap());
    let plane = (vector(-1.0, 1.0), -0.5..0.5_f64)
        .prop_filter_map("zero normal", |(n, o)| Shape::half_space(n, o).ok());
    prop_oneof![5 => bounded_shape(), 1 => cubic, 1 => quadric, 1 => plane]
}

/// Affine transforms, every second one mirroring, not too flat.
pub(crate) fn affine() -> impl Strategy<Value = Transform> {
    let turn = (vector(-1.0, 1.0), -3.2..3.2_f64).prop_filter_map("zero axis", |(axis, angle)| {
        Transform::rotation(axis, angle).ok()
    });
    let stretch = (vector(0.4, 1.6), any::<bool>()).prop_map(|(s, mirror)| {
        if mirror {
            s * DVec3::new(-1.0, 1.0, 1.0)
        } else {
            s
        }
    });
    (stretch, turn, vector(-1.0, 1.0)).prop_map(|(s, turn, by)| {
        let scaled = Transform::scale(s).unwrap().compose(&turn).unwrap();
        scaled
            .compose(&Transform::translation(by).unwrap())
            .unwrap()
    })
}

/// Projective transforms, some of which send planes near the origin to infinity.
pub(crate) fn projective() -> impl Strategy<Value = Transform> {
    (affine(), vector(-0.7, 0.7)).prop_filter_map("singular", |(t, p)| {
        let mut rows = t.to_rows();
        for axis in 0..3 {
            rows[axis][3] = p[axis];
        }
        Transform::from_rows(&rows).ok()
    })
}

/// A tree to build a model from.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Shape(Shape),
    Moved(Transform, Box<Tree>),
    Union(Vec<Tree>),
    Intersection(Vec<Tree>),
    Difference(Vec<Tree>),
    Complement(Box<Tree>),
}

pub(crate) fn tree(
    shape: impl Strategy<Value = Shape> + 'static,
    transform: impl Strategy<Value = Transform> + 'static,
) -> impl Strategy<Value = Tree> {
    let transform = transform.boxed();
    let leaf =
        (shape, transform.clone()).prop_map(|(s, t)| Tree::Moved(t, Box::new(Tree::Shape(s))));
    leaf.prop_recursive(4, 16, 4, move |inner| {
        let several = || proptest::collection::vec(inner.clone(), 0..4);
        prop_oneof![
            several().prop_map(Tree::Union),
            several().prop_map(Tree::Intersection),
            several().prop_map(Tree::Difference),
            inner.clone().prop_map(|t| Tree::Complement(Box::new(t))),
            (transform.clone(), inner.clone()).prop_map(|(t, i)| Tree::Moved(t, Box::new(i))),
        ]
    })
}

pub(crate) fn model(tree: &Tree) -> Model {
    let mut builder = ModelBuilder::new();
    let root = add(&mut builder, tree);
    builder.finish(root)
}

fn add(builder: &mut ModelBuilder, tree: &Tree) -> NodeId {
    let all = |builder: &mut ModelBuilder, children: &[Tree]| -> Vec<NodeId> {
        children.iter().map(|c| add(builder, c)).collect()
    };
    let node = match tree {
        Tree::Shape(shape) => Node::Shape(shape.clone()),
        Tree::Moved(t, child) => Node::Instance(t.clone(), add(builder, child)),
        Tree::Union(children) => Node::Union(all(builder, children)),
        Tree::Intersection(children) => Node::Intersection(all(builder, children)),
        Tree::Difference(children) => Node::Difference(all(builder, children)),
        Tree::Complement(child) => Node::Complement(add(builder, child)),
    };
    builder.add(node)
}
