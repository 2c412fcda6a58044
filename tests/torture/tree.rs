//! A small language for solids, so that a case reads like the sentence that describes it:
//! `block([0.; 3], [2.; 3]) - cylinder(1.0, -1.0, 3.0).along_x()`.

use csg::{Model, ModelBuilder, Node, NodeId, Polynomial, Shape, Transform};
use glam::{DMat3, DVec3};
use std::ops::{BitAnd, BitOr, Sub};

/// A solid: shapes, maps of space and set operations.
#[derive(Clone, Debug)]
pub(crate) enum Tree {
    Shape(Shape),
    Moved(Transform, Box<Tree>),
    Union(Vec<Tree>),
    Intersection(Vec<Tree>),
    Difference(Vec<Tree>),
}

impl Tree {
    /// The model with this solid as its root. Cases are a few levels deep.
    pub(crate) fn model(&self) -> Model {
        let mut builder = ModelBuilder::new();
        let root = self.add_to(&mut builder);
        builder.finish(root)
    }

    fn add_to(&self, builder: &mut ModelBuilder) -> NodeId {
        let all = |builder: &mut ModelBuilder, children: &[Self]| {
            children.iter().map(|child| child.add_to(builder)).collect()
        };
        let node = match self {
            Self::Shape(shape) => Node::Shape(shape.clone()),
            Self::Moved(transform, child) => {
                Node::Instance(transform.clone(), child.add_to(builder))
            }
            Self::Union(children) => Node::Union(all(builder, children)),
            Self::Intersection(children) => Node::Intersection(all(builder, children)),
            Self::Difference(children) => Node::Difference(all(builder, children)),
        };
        builder.add(node)
    }

    /// Moved by a transform.
    pub(crate) fn by(self, transform: Transform) -> Self {
        Self::Moved(transform, Box::new(self))
    }

    /// Moved by a vector.
    pub(crate) fn at(self, x: f64, y: f64, z: f64) -> Self {
        self.by(Transform::translation(DVec3::new(x, y, z)).expect("finite"))
    }

    /// What stood along z stands along x: (x, y, z) → (z, x, y), exactly.
    pub(crate) fn along_x(self) -> Self {
        self.mapped([[0., 0., 1.], [1., 0., 0.], [0., 1., 0.]])
    }

    /// What stood along z stands along y: (x, y, z) → (y, z, x), exactly.
    pub(crate) fn along_y(self) -> Self {
        self.mapped([[0., 1., 0.], [0., 0., 1.], [1., 0., 0.]])
    }

    /// Mirrored at the plane x = 0.
    pub(crate) fn mirrored(self) -> Self {
        self.mapped([[-1., 0., 0.], [0., 1., 0.], [0., 0., 1.]])
    }

    /// Mapped by a matrix, given by rows, that column vectors are multiplied by.
    pub(crate) fn mapped(self, m: [[f64; 3]; 3]) -> Self {
        let [a, b, c] = m.map(|[x, y, z]| [x, y, z, 0.0]);
        self.by(Transform::from_columns(&[a, b, c, [0., 0., 0., 1.]]).expect("regular"))
    }

    /// Turned about an axis and by an angle (in radians) that no coordinate survives.
    pub(crate) fn turned(self) -> Self {
        let axis = DVec3::new(1.0, 2.0_f64.sqrt(), -3.0_f64.sqrt()).normalize();
        let turn = DMat3::from_axis_angle(axis, 1.0);
        self.mapped(turn.transpose().to_cols_array_2d())
    }
}

impl BitOr for Tree {
    type Output = Self;
    fn bitor(self, other: Self) -> Self {
        Self::Union(vec![self, other])
    }
}

impl BitAnd for Tree {
    type Output = Self;
    fn bitand(self, other: Self) -> Self {
        Self::Intersection(vec![self, other])
    }
}

impl Sub for Tree {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::Difference(vec![self, other])
    }
}

fn sound(shape: Result<Shape, csg::Error>) -> Tree {
    Tree::Shape(shape.expect("a sound shape"))
}

/// The union of many.
pub(crate) fn union(parts: impl IntoIterator<Item = Tree>) -> Tree {
    Tree::Union(parts.into_iter().collect())
}

/// Block between two corners.
pub(crate) fn block(min: [f64; 3], max: [f64; 3]) -> Tree {
    sound(Shape::block(min.into(), max.into()))
}

/// Cube about the origin.
pub(crate) fn cube(side: f64) -> Tree {
    block([-side / 2.0; 3], [side / 2.0; 3])
}

/// Ball about the origin.
pub(crate) fn ball(radius: f64) -> Tree {
    sound(Shape::sphere(radius))
}

/// Cylinder about the z axis.
pub(crate) fn cylinder(radius: f64, z0: f64, z1: f64) -> Tree {
    sound(Shape::cylinder(radius, z0, z1))
}

/// Cone or frustum about the z axis with radii `r0` at `z0` and `r1` at `z1`.
pub(crate) fn cone(r0: f64, r1: f64, z0: f64, z1: f64) -> Tree {
    sound(Shape::frustum(r0, r1, z0, z1))
}

/// Torus about the z axis.
pub(crate) fn torus(ring: f64, tube: f64) -> Tree {
    sound(Shape::torus(ring, tube))
}

/// Prism about the z axis, by circumradius.
pub(crate) fn prism(sides: u32, radius: f64, z0: f64, z1: f64) -> Tree {
    sound(Shape::prism(sides, radius, radius, z0, z1))
}

/// Pyramid about the z axis with its apex at (0, 0, z1).
pub(crate) fn pyramid(sides: u32, radius: f64, z0: f64, z1: f64) -> Tree {
    sound(Shape::prism(sides, radius, 0.0, z0, z1))
}

/// `normal · x ≤ offset`.
pub(crate) fn half_space(normal: [f64; 3], offset: f64) -> Tree {
    sound(Shape::half_space(normal.into(), offset))
}

/// Convex hull's faces given by vertices, counter-clockwise seen from outside.
pub(crate) fn polyhedron(vertices: &[[f64; 3]], faces: &[&[usize]]) -> Tree {
    let vertices: Vec<DVec3> = vertices.iter().map(|v| DVec3::from(*v)).collect();
    let faces: Vec<Vec<usize>> = faces.iter().map(|face| face.to_vec()).collect();
    sound(Shape::convex_polyhedron(&vertices, &faces))
}

/// All points where a polynomial is not positive.
pub(crate) fn polynomial(p: Polynomial) -> Tree {
    Tree::Shape(Shape::Polynomial(p))
}

/// All points where Σ c·xⁱyʲzᵏ ≤ 0, for terms ([i, j, k], c).
pub(crate) fn terms(degree: usize, terms: &[([usize; 3], f64)]) -> Tree {
    polynomial(Polynomial::from_terms(degree, terms).expect("a polynomial"))
}
