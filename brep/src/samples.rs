//! Small meshes with known measures, for tests.

use csg::{MaterialId, PrimitiveId, Sense};
use glam::DVec3;
use subdiv::{Fragments, Triangle, VertexKind};

/// Triangles over positions, all on primitive 0.
pub(crate) fn mesh(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Fragments {
    Fragments {
        positions: positions.iter().map(|&position| position.into()).collect(),
        kinds: vec![VertexKind::Interior; positions.len()],
        triangles: triangles
            .iter()
            .map(|&vertices| triangle(vertices, 0))
            .collect(),
    }
}

pub(crate) fn triangle(vertices: [u32; 3], primitive: u32) -> Triangle {
    Triangle {
        vertices,
        primitive: PrimitiveId(primitive),
        sense: Sense::Inside,
        material: MaterialId(0),
    }
}

/// The corner of the unit cube at the origin: volume 1/6.
pub(crate) fn tetrahedron() -> Fragments {
    let positions = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
    mesh(&positions, &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
}

/// An axis-parallel box of 12 triangles with its six sides on primitives `first` ‥ `first` + 5.
pub(crate) fn cuboid(min: DVec3, max: DVec3, first: u32) -> Fragments {
    let corner = |at: usize| {
        let pick = |axis: usize| {
            if at >> axis & 1 == 1 {
                max[axis]
            } else {
                min[axis]
            }
        };
        DVec3::new(pick(0), pick(1), pick(2))
    };
    // Corner numbers are bits z y x; sides −x, +x, −y, +y, −z, +z, counter-clockwise from outside.
    let sides = [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ];
    let triangles = (first..).zip(sides).flat_map(|(primitive, [a, b, c, d])| {
        [
            triangle([a, b, c], primitive),
            triangle([a, c, d], primitive),
        ]
    });
    Fragments {
        positions: (0..8).map(corner).collect(),
        kinds: vec![VertexKind::Interior; 8],
        triangles: triangles.collect(),
    }
}

pub(crate) fn cube(centre: [f64; 3], half: f64) -> Fragments {
    let centre = DVec3::from(centre);
    cuboid(centre - half, centre + half, 0)
}

/// A torus around the z axis as a grid of `2 · major · minor` triangles.
pub(crate) fn torus(ring: f64, tube: f64, major: u32, minor: u32) -> Fragments {
    let angle = |at: u32, count: u32| f64::from(at) / f64::from(count) * std::f64::consts::TAU;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..major {
        for j in 0..minor {
            let (u, v) = (angle(i, major), angle(j, minor));
            let radius = ring + tube * v.cos();
            positions.push([radius * u.cos(), radius * u.sin(), tube * v.sin()]);
            let at = |i: u32, j: u32| (i % major) * minor + j % minor;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh(&positions, &triangles)
}

/// An octahedron on the unit sphere whose triangles are quartered `level` times, vertices pushed
/// onto the sphere: 8 · 4^`level` triangles.
pub(crate) fn sphere(level: u32) -> Fragments {
    let mut positions: Vec<DVec3> = [DVec3::X, DVec3::Y, DVec3::Z]
        .into_iter()
        .flat_map(|axis| [axis, -axis])
        .collect();
    // +x 0, −x 1, +y 2, −y 3, +z 4, −z 5
    let mut triangles = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..level {
        let mut middles = std::collections::BTreeMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum: DVec3 = positions[a as usize] + positions[b as usize];
                positions.push(sum.normalize());
                u32::try_from(positions.len() - 1).expect("small")
            })
        };
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    let positions: Vec<[f64; 3]> = positions.iter().map(DVec3::to_array).collect();
    mesh(&positions, &triangles)
}

/// All meshes side by side in one, primitives kept.
pub(crate) fn together(parts: &[Fragments]) -> Fragments {
    let mut all = Fragments::default();
    for part in parts {
        let shift = u32::try_from(all.positions.len()).expect("small");
        all.positions.extend(&part.positions);
        all.kinds.extend(&part.kinds);
        all.triangles
            .extend(part.triangles.iter().map(|&triangle| Triangle {
                vertices: triangle.vertices.map(|vertex| vertex + shift),
                ..triangle
            }));
    }
    all
}

/// The same surface with inside and outside exchanged: a cavity.
pub(crate) fn inside_out(mut part: Fragments) -> Fragments {
    for triangle in &mut part.triangles {
        triangle.vertices.swap(1, 2);
    }
    part
}

/// Every position mapped, for instance moved; the map must keep orientation.
pub(crate) fn moved(mut part: Fragments, map: impl Fn(DVec3) -> DVec3) -> Fragments {
    for position in &mut part.positions {
        *position = map(*position);
    }
    part
}

/// All facets on another primitive and of another material.
pub(crate) fn painted(mut part: Fragments, primitive: u32, material: u32) -> Fragments {
    for triangle in &mut part.triangles {
        triangle.primitive = PrimitiveId(triangle.primitive.0 + primitive);
        triangle.material = MaterialId(material);
    }
    part
}
