//! The seven solids: each as the file that our program reads and as a tree written by hand.

use crate::surfaces::Surface;
use glam::DVec3;

/// A set operation over surfaces' insides.
#[derive(Clone, Debug)]
pub enum Tree {
    /// Inside of the surface with this index.
    Leaf(usize),
    /// Points in any.
    Union(Vec<Tree>),
    /// Points in all.
    Intersection(Vec<Tree>),
    /// Points in the first but in none of the others.
    Difference(Vec<Tree>),
}

impl Tree {
    /// The usual min/max function: negative inside, zero on the boundary.
    pub fn value(&self, leaf: &impl Fn(usize) -> f64) -> f64 {
        let values = |all: &[Tree], sign: f64| {
            let each = all.iter().map(|t| sign * t.value(leaf));
            each.fold(f64::NEG_INFINITY, f64::max)
        };
        match self {
            Self::Leaf(at) => leaf(*at),
            Self::Union(all) => -values(all, -1.0),
            Self::Intersection(all) => values(all, 1.0),
            Self::Difference(all) => values(&all[..1], 1.0).max(values(&all[1..], -1.0)),
        }
    }
}

/// A solid to convert.
#[derive(Clone, Debug)]
pub struct Solid {
    /// Short name.
    pub name: &'static str,
    /// What it is.
    pub what: &'static str,
    /// The text of its file.
    pub source: &'static str,
    /// The surfaces that bound its parts.
    pub surfaces: Vec<Surface>,
    /// The operations.
    pub tree: Tree,
    /// Half the side of a cube around the origin that holds it.
    pub reach: f64,
}

/// Collects surfaces while a tree is written down.
#[derive(Default)]
struct Builder(Vec<Surface>);

impl Builder {
    fn leaf(&mut self, surface: Surface) -> Tree {
        self.0.push(surface);
        Tree::Leaf(self.0.len() - 1)
    }

    fn sphere(&mut self, center: DVec3, radius: f64) -> Tree {
        self.leaf(Surface::Sphere { center, radius })
    }

    /// Both planes that limit a coordinate to ±half.
    fn slab(&mut self, axis: usize, half: f64) -> [Tree; 2] {
        [1.0, -1.0].map(|sign| {
            self.leaf(Surface::Plane {
                normal: DVec3::AXES[axis] * sign,
                offset: half,
            })
        })
    }

    fn block(&mut self, half: DVec3) -> Tree {
        let planes = (0..3).flat_map(|axis| self.slab(axis, half[axis]));
        Tree::Intersection(planes.collect())
    }

    fn cylinder(&mut self, axis: usize, center: DVec3, radius: f64, half: f64) -> Tree {
        let mut parts = vec![self.leaf(Surface::Cylinder {
            axis,
            center,
            radius,
        })];
        parts.extend(self.slab(axis, half));
        Tree::Intersection(parts)
    }

    fn solid(
        self,
        name: &'static str,
        what: &'static str,
        source: &'static str,
        tree: Tree,
        reach: f64,
    ) -> Solid {
        let surfaces = self.0;
        Solid {
            name,
            what,
            source,
            surfaces,
            tree,
            reach,
        }
    }
}

macro_rules! source {
    ($file:literal) => {
        include_str!(concat!("../../../fixtures/solids/", $file))
    };
}

/// The seven, in order.
pub fn all() -> Vec<Solid> {
    vec![
        sphere(),
        demo(),
        torus_and_sphere(),
        grid(),
        ring(),
        plate(),
        heart(),
    ]
}

fn sphere() -> Solid {
    let mut b = Builder::default();
    let tree = b.sphere(DVec3::ZERO, 1.0);
    b.solid("S1", "sphere", source!("S1_sphere.csg"), tree, 1.0)
}

fn demo() -> Solid {
    let mut b = Builder::default();
    let body = vec![b.block(DVec3::ONE), b.sphere(DVec3::ZERO, 1.35)];
    let mut parts = vec![Tree::Intersection(body)];
    parts.extend([2, 0, 1].map(|axis| b.cylinder(axis, DVec3::ZERO, 0.6, 2.0)));
    let tree = Tree::Difference(parts);
    b.solid(
        "S2",
        "cube ∩ sphere \\ 3 cylinders",
        source!("S2_demo.csg"),
        tree,
        1.0,
    )
}

fn torus_and_sphere() -> Solid {
    let mut b = Builder::default();
    let torus = b.leaf(Surface::Torus {
        ring: 1.0,
        tube: 0.3,
    });
    let tree = Tree::Union(vec![torus, b.sphere(DVec3::ZERO, 0.6)]);
    b.solid(
        "S3",
        "torus ∪ sphere",
        source!("S3_torus_sphere.csg"),
        tree,
        1.3,
    )
}

fn grid() -> Solid {
    let mut b = Builder::default();
    let places = [-1.5, -0.5, 0.5, 1.5];
    let mut parts = Vec::new();
    for x in places {
        for y in places {
            parts.extend(places.map(|z| b.sphere(DVec3::new(x, y, z), 0.4)));
        }
    }
    b.solid(
        "S4",
        "64 apart spheres",
        source!("S4_64_spheres.csg"),
        Tree::Union(parts),
        1.9,
    )
}

fn ring() -> Solid {
    let mut b = Builder::default();
    let place = |i: i32| {
        let (s, c) = (std::f64::consts::TAU * f64::from(i) / 128.0).sin_cos();
        DVec3::new(4.0 * c, 4.0 * s, 0.0)
    };
    let parts = (0..128).map(|i| b.sphere(place(i), 0.3)).collect();
    b.solid(
        "S5",
        "ring of 128 spheres",
        source!("S5_ring128.csg"),
        Tree::Union(parts),
        4.3,
    )
}

fn plate() -> Solid {
    let mut b = Builder::default();
    let mut parts = vec![b.block(DVec3::new(5.0, 5.0, 0.5))];
    for i in 0..8 {
        for j in 0..8 {
            let place = |k: i32| -4.2 + 1.2 * f64::from(k);
            let center = DVec3::new(place(i), place(j), 0.0);
            parts.push(b.cylinder(2, center, 0.4, 1.0));
        }
    }
    let tree = Tree::Difference(parts);
    b.solid(
        "S6",
        "plate with 64 holes",
        source!("S6_plate64.csg"),
        tree,
        5.0,
    )
}

fn heart() -> Solid {
    let mut b = Builder::default();
    let tree = b.leaf(Surface::Heart);
    b.solid("S7", "heart (degree 6)", source!("S7_heart.csg"), tree, 1.3)
}
