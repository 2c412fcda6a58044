//! Large polyhedra have the topology and the volume of their meshes, which are known beforehand:
//! alone, where their faces are the result, and beside something else, where they are arranged as
//! Boolean formulas of their planes.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use brep::simplify::{contract_knots, remove_degenerate};
use brep::{Properties, Shells, retriangulate};
use glam::DVec3;
use stages::{Converted, convert};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Triangles, counter-clockwise from outside, and what is known of them.
struct Mesh {
    points: Vec<DVec3>,
    faces: Vec<[usize; 3]>,
    genus: usize,
}

/// With six digits, as OpenSCAD writes them.
fn six(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap()
}

impl Mesh {
    fn new(points: Vec<DVec3>, faces: Vec<[usize; 3]>, genus: usize) -> Self {
        let points: Vec<DVec3> = points
            .into_iter()
            .map(|p| DVec3::new(six(p.x), six(p.y), six(p.z)))
            .collect();
        // V − E + F = 2 − 2·genus, so that the mesh is what it is said to be.
        assert_eq!(points.len() + 2 * genus, faces.len() / 2 + 2);
        Self {
            points,
            faces,
            genus,
        }
    }

    /// By the divergence theorem.
    fn volume(&self) -> f64 {
        let tetrahedra = self.faces.iter().map(|f| {
            let [a, b, c] = f.map(|v| self.points[v]);
            a.dot(b.cross(c)) / 6.0
        });
        tetrahedra.sum()
    }

    /// OpenSCAD's faces turn the other way.
    fn source(&self) -> String {
        let points: Vec<[f64; 3]> = self.points.iter().map(DVec3::to_array).collect();
        let faces: Vec<[usize; 3]> = self.faces.iter().map(|&[a, b, c]| [a, c, b]).collect();
        format!("polyhedron(points = {points:?}, faces = {faces:?}, convexity = 1);")
    }
}

/// A torus with bumps and sides of flat triangles.
fn torus(rings: usize, sides: usize) -> Mesh {
    let mut points = Vec::new();
    for i in 0..rings {
        for j in 0..sides {
            let (a, b) = (TAU * i as f64 / rings as f64, TAU * j as f64 / sides as f64);
            let tube = 4.0 + 0.5 * (7.0 * a + 3.0 * b).sin();
            let radius = 10.0 + 0.9 * (5.0 * a).cos() + tube * b.cos();
            points.push(DVec3::new(
                radius * a.cos(),
                radius * a.sin(),
                tube * b.sin(),
            ));
        }
    }
    let corner = |i: usize, j: usize| (i % rings) * sides + j % sides;
    let faces = (0..rings).flat_map(|i| {
        (0..sides).flat_map(move |j| {
            let [a, b] = [corner(i, j), corner(i + 1, j)];
            let [c, d] = [corner(i + 1, j + 1), corner(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
    });
    let faces = faces.collect();
    Mesh::new(points, faces, 1)
}

/// A ball of triangles around two poles, whose vertices are at the distance that `radius` says.
fn ball(rings: usize, sides: usize, mut radius: impl FnMut(usize) -> f64) -> Mesh {
    let mut points = Vec::new();
    for i in 1..rings {
        for j in 0..sides {
            let (polar, around) = (PI * i as f64 / rings as f64, TAU * j as f64 / sides as f64);
            let ring = DVec3::new(around.cos(), around.sin(), 0.0) * polar.sin();
            points.push((ring + DVec3::Z * polar.cos()) * radius(points.len()));
        }
    }
    let (north, south) = (points.len(), points.len() + 1);
    points.extend([DVec3::Z * radius(north), DVec3::NEG_Z * radius(south)]);
    let corner = |i: usize, j: usize| (i - 1) * sides + j % sides;
    let mut faces = Vec::new();
    for j in 0..sides {
        faces.push([north, corner(1, j), corner(1, j + 1)]);
        faces.push([south, corner(rings - 1, j + 1), corner(rings - 1, j)]);
        for i in 1..rings - 1 {
            let [a, b] = [corner(i, j), corner(i + 1, j)];
            let [c, d] = [corner(i + 1, j + 1), corner(i, j + 1)];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    Mesh::new(points, faces, 0)
}

/// Numbers between 0 and 1 that are the same each time.
fn noise(at: usize) -> f64 {
    let mixed = (at as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (mixed >> 11) as f64 / (1_u64 << 53) as f64
}

/// A plate of 7 × 3 cells with three holes, each cell side divided into `n` × `n` squares, bent.
fn plate(n: i64) -> Mesh {
    let is_full = |[x, y, z]: [i64; 3]| {
        (0..7).contains(&x) && (0..3).contains(&y) && z == 0 && !(y == 1 && x % 2 == 1)
    };
    let mut numbers: HashMap<[i64; 3], usize> = HashMap::new();
    let mut points = Vec::new();
    let mut number = |at: [i64; 3]| {
        *numbers.entry(at).or_insert_with(|| {
            let p = DVec3::from(at.map(|c| c as f64 / n as f64));
            let bend = DVec3::new(
                (2.0 * p.y + p.z).sin(),
                (1.5 * p.z + p.x).sin(),
                (1.3 * p.x + p.y).cos(),
            );
            points.push(p + 0.15 * bend);
            points.len() - 1
        })
    };
    let mut faces = Vec::new();
    for (x, y) in (0..7).flat_map(|x| (0..3).map(move |y| (x, y))) {
        let cell = [x, y, 0];
        if !is_full(cell) {
            continue;
        }
        for axis in 0..3 {
            for outward in [-1, 1] {
                let mut beside = cell;
                beside[axis] += outward;
                if is_full(beside) {
                    continue;
                }
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    let mut corner = |a: i64, b: i64| {
                        let mut at = cell.map(|c| c * n);
                        at[axis] += n * i64::from(outward > 0);
                        at[u] += i + a;
                        at[v] += j + b;
                        number(at)
                    };
                    let ring = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                    let [a, b, c, d] = ring;
                    faces.extend(if outward > 0 {
                        [[a, b, c], [a, c, d]]
                    } else {
                        [[a, c, b], [a, d, c]]
                    });
                }
            }
        }
    }
    Mesh::new(points, faces, 3)
}

/// Needles: in every third triangle's first edge a vertex that its neighbour does not use, and
/// a triangle without area between them.
fn with_needles(mut mesh: Mesh) -> Mesh {
    for at in (0..mesh.faces.len()).step_by(3) {
        let [a, b, c] = mesh.faces[at];
        // Halves of numbers with six digits in steps of two are exact.
        let middle = mesh.points.len();
        mesh.points.push(0.5 * (mesh.points[a] + mesh.points[b]));
        mesh.faces[at] = [a, middle, c];
        mesh.faces.extend([[middle, b, c], [a, b, middle]]);
    }
    mesh
}

/// As it comes out: counts of the mesh itself, to the last digit.
fn is_itself(mesh: &Mesh, source: &str) -> Converted {
    let found = convert(source, 0.01);
    assert_eq!(found.brep.facet_count(), mesh.faces.len());
    assert_eq!(found.brep.vertex_count(), mesh.points.len());
    assert_eq!(found.shells.solids.len(), 1);
    assert_eq!(found.shells.genus(), mesh.genus as u64);
    let volume = mesh.volume();
    assert!((found.properties.volume - volume).abs() <= 1e-12 * volume);
    let [low, high] = found.report.volume_interval.unwrap();
    assert!(low <= volume && volume <= high && high - low < 1e-9 * volume);
    assert_eq!(found.report.uncertified_leaves, 0);
    found
}

/// Beside a cube, as the program does it.
fn keeps_its_topology(mesh: &Mesh) {
    let far = "multmatrix([[1,0,0,40],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube([1, 2, 3]); }";
    let found = convert(&format!("{}\n{far}", mesh.source()), 0.05);
    assert!(found.report.leaves > 0, "an arrangement");
    let (clean, _) = remove_degenerate(found.brep).unwrap();
    let (clean, _) = contract_knots(clean).unwrap();
    let (flat, _) = retriangulate(clean, |_| true);
    let shells = Shells::of(&flat);
    assert_eq!(shells.solids.len(), 2);
    assert_eq!(shells.genus(), mesh.genus as u64);
    let volume = mesh.volume() + 6.0;
    assert!((Properties::of(&flat).volume - volume).abs() <= 1e-7 * volume);
}

/// `CSG2BREP_MESH`: number of triangles, about.
fn triangles() -> usize {
    let asked = std::env::var("CSG2BREP_MESH").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(600)
}

#[test]
fn meshes_of_twenty_thousand_triangles_are_themselves() {
    for mesh in [
        torus(200, 50),
        torus(400, 6),
        plate(13),
        ball(100, 100, |at| 10.0 + 0.05 * noise(at)),
        // A star with thousands of points.
        ball(100, 24, |at| 8.0 + 4.0 * noise(at)),
    ] {
        is_itself(&mesh, &mesh.source());
    }
}

#[test]
fn placement_and_colour_leave_a_mesh_what_it_is() {
    let mesh = torus(30, 12);
    let turned = "multmatrix([[0,-1,0,5],[1,0,0,-3],[0,0,1,100],[0,0,0,1]])";
    let source = format!(
        "group() {{ color([1,0,0,1]) {turned} {{ {} }} }}",
        mesh.source()
    );
    let found = is_itself(&mesh, &source);
    let [r, ..] = found.solid.materials[1].color.unwrap();
    assert!((r - 1.0).abs() < 1e-6);
    assert!(found.brep.facets().all(|f| f.material().0 == 1));
    let mirrored = "multmatrix([[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";
    is_itself(&mesh, &format!("{mirrored} {{ {} }}", mesh.source()));
}

#[test]
fn triangles_without_area_are_no_holes() {
    let mesh = with_needles(ball(12, 16, |_| 8.0));
    is_itself(&mesh, &mesh.source());
}

/// The mesh of an import is a polyhedron like any other.
#[test]
fn an_imported_mesh_is_itself() {
    struct Folder(Vec<u8>);
    impl io::read::Files for Folder {
        fn read(&self, _: &str) -> Result<Vec<u8>, io::read::FileRefusal> {
            Ok(self.0.clone())
        }
    }
    let mesh = torus(100, 50);
    let mut stl = String::from("solid bumps\n");
    for face in &mesh.faces {
        stl += "facet normal 0 0 0\nouter loop\n";
        for &v in face {
            let p = mesh.points[v];
            writeln!(stl, "vertex {} {} {}", p.x, p.y, p.z).unwrap();
        }
        stl += "endloop\nendfacet\n";
    }
    stl += "endsolid bumps\n";
    let options = io::read::ReadOptions::default();
    let source = "import(file = \"bumps.stl\", layer = \"\", origin = [0, 0], scale = 1);";
    let files = Folder(stl.into_bytes());
    let model = io::read::scad_csg::read_with(source, "test.csg", &options, &files);
    let found = stages::convert_model(&model.unwrap().model, subdiv::Rule::Tolerance(0.01));
    assert_eq!(
        (found.shells.genus(), found.brep.facet_count()),
        (1, 10_000)
    );
    assert_eq!(found.brep.vertex_count(), 5_000);
}

#[test]
fn bumpy_meshes_keep_their_topology_beside_others() {
    let n = triangles();
    let sides = (n / 4).isqrt();
    keeps_its_topology(&torus(2 * sides, sides));
    keeps_its_topology(&ball(2 * sides, sides, |at| 10.0 + noise(at)));
    let squares = i64::try_from((n / 100).isqrt()).unwrap();
    keeps_its_topology(&plate(squares.max(2)));
}
