//! Kuhn simplices and their bisection (thesis 4.2, Table 4.1).

use crate::lattice::{LATTICE_BITS, Point};

/// A tetrahedron of the bintree.
///
/// ```text
///        v3            refinement edge: v0-v3, its midpoint m
///       /|\            near child holds v0, far child holds v3:
///      / | \             parent type 0:     (v0,m,v1,v2)  (v3,m,v2,v1)
///    v1--+--v2           parent types 1, 2: (v0,m,v1,v2)  (v3,m,v1,v2)
///      \ | /
///        v0
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Simplex {
    /// The vertices, in the order that fixes the refinement edge of all descendants.
    pub vertices: [Point; 4],
    /// Number of bisections since the root; the type is `level % 3`.
    pub level: u8,
}

/// The six orders of the axes, each the path along which one root simplex climbs the cube.
pub(crate) const ROOT_AXES: [[usize; 3]; 6] = [
    [0, 1, 2],
    [0, 2, 1],
    [1, 0, 2],
    [1, 2, 0],
    [2, 0, 1],
    [2, 1, 0],
];

impl Simplex {
    /// The six simplices of the domain's Kuhn triangulation, in the order of [`ROOT_AXES`].
    #[must_use]
    pub(crate) fn roots() -> [Self; 6] {
        ROOT_AXES.map(|axes| {
            let mut corner = [0; 3];
            let mut vertices = [Point::new(corner); 4];
            for (step, axis) in axes.into_iter().enumerate() {
                corner[axis] = 1 << LATTICE_BITS;
                vertices[step + 1] = Point::new(corner);
            }
            Self { vertices, level: 0 }
        })
    }

    /// Type 0, 1 or 2: which of the three shapes it has.
    #[must_use]
    pub(crate) fn kind(&self) -> u8 {
        self.level % 3
    }

    /// The middle of the refinement edge.
    #[must_use]
    pub(crate) fn midpoint(&self) -> Point {
        self.vertices[0].midpoint(self.vertices[3])
    }

    /// The near and the far child.
    #[must_use]
    pub(crate) fn children(&self) -> [Self; 2] {
        let [v0, v1, v2, v3] = self.vertices;
        let m = self.midpoint();
        let level = self.level + 1;
        let far = if self.kind() == 0 {
            [v3, m, v2, v1]
        } else {
            [v3, m, v1, v2]
        };
        [
            Self {
                vertices: [v0, m, v1, v2],
                level,
            },
            Self {
                vertices: far,
                level,
            },
        ]
    }

    /// Whether `(v1−v0, v2−v0, v3−v0)` is a right-handed frame.
    #[must_use]
    pub(crate) fn is_positive(&self) -> bool {
        volume(self.vertices) > 0
    }

    /// Whether a point lies in the closed simplex.
    #[must_use]
    pub(crate) fn contains(&self, point: Point) -> bool {
        let whole = volume(self.vertices);
        (0..4).all(|v| {
            let mut vertices = self.vertices;
            vertices[v] = point;
            // Has the sign of the whole, or is zero.
            volume(vertices).signum() * whole.signum() >= 0
        })
    }
}

/// Six times the signed volume, in lattice units.
fn volume(vertices: [Point; 4]) -> i64 {
    let [o, a, b, c] = vertices.map(|v| v.coordinates().map(i64::from));
    let edge = |v: [i64; 3]| [v[0] - o[0], v[1] - o[1], v[2] - o[2]];
    let (a, b, c) = (edge(a), edge(b), edge(c));
    // Coordinates have 21 bits: six products of three of them fit an i64 with its sign, since the
    // volume in the cube is at most a third of the cube's.
    let cross = [
        b[1] * c[2] - b[2] * c[1],
        b[2] * c[0] - b[0] * c[2],
        b[0] * c[1] - b[1] * c[0],
    ];
    a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A point of the cube lies in one root or in several that share it; the lattice point of a
        /// descendant lies in all its ancestors.
        #[test]
        fn containment_follows_the_tree(root in 0usize..6, turns in proptest::collection::vec(any::<bool>(), 0..57)) {
            let mut simplex = Simplex::roots()[root];
            let mut ancestors = vec![simplex];
            for far in turns {
                let siblings = simplex.children();
                let m = simplex.midpoint();
                prop_assert!(siblings.iter().all(|sibling| sibling.contains(m)));
                simplex = siblings[usize::from(far)];
                ancestors.push(simplex);
            }
            for ancestor in &ancestors {
                prop_assert!(simplex.vertices.iter().all(|v| ancestor.contains(*v)));
            }
            // The apex that the other sibling alone has.
            for pair in ancestors.windows(2) {
                let [near, far] = pair[0].children();
                let (here, other) = if near == pair[1] { (near, far) } else { (far, near) };
                prop_assert!(!here.contains(other.vertices[0]));
            }
        }
    }

    fn six_volumes(s: &Simplex) -> i64 {
        let [o, a, b, c] = s.vertices.map(|v| v.coordinates().map(i64::from));
        let e = |v: [i64; 3]| [v[0] - o[0], v[1] - o[1], v[2] - o[2]];
        let (a, b, c) = (e(a), e(b), e(c));
        (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))
            .abs()
    }

    #[test]
    fn children_partition_parent() {
        let mut layer: Vec<Simplex> = Simplex::roots().into();
        let whole: i64 = layer.iter().map(six_volumes).sum();
        assert_eq!(whole, 6 << (3 * LATTICE_BITS));
        for _ in 0..9 {
            layer = layer.iter().flat_map(Simplex::children).collect();
            assert_eq!(layer.iter().map(six_volumes).sum::<i64>(), whole);
        }
    }

    /// Table 4.2: the shape recurs, halved, after three levels.
    #[test]
    fn three_levels_halve_the_edges() {
        let lengths = |s: &Simplex| {
            let mut squares: Vec<i64> = Vec::new();
            for a in 0..4 {
                for b in a + 1..4 {
                    let p = s.vertices[a].coordinates().map(i64::from);
                    let q = s.vertices[b].coordinates().map(i64::from);
                    squares.push((0..3).map(|x| (p[x] - q[x]).pow(2)).sum());
                }
            }
            squares.sort_unstable();
            squares
        };
        for root in Simplex::roots() {
            let mut layer = vec![root];
            for _ in 0..3 {
                layer = layer.iter().flat_map(Simplex::children).collect();
            }
            let halved: Vec<i64> = lengths(&root).iter().map(|s| s / 4).collect();
            for descendant in layer {
                assert_eq!(lengths(&descendant), halved);
            }
        }
    }
}
