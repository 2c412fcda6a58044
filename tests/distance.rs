//! The proved distance, checked from outside: an independent program (`tests/python/distance.py`)
//! reads the model itself and measures how far samples of the mesh are from the true boundary, and
//! samples of the true boundary from the mesh.
//!
//! `CSG2BREP_SAMPLES`: samples a solid in each direction (default 300).

mod stages;
mod support;

use brep::{Brep, Demand, Fit, IfTroubled, Proof, Valid, tessellate};
use io::write::obj;
use serde::Deserialize;
use stages::{convert, convert_model, read};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::Path;
use std::process::Command;
use subdiv::Rule;

#[derive(Debug, Deserialize)]
struct Measured {
    mesh_to_true: f64,
    true_to_mesh: f64,
}

/// Name, source or fixture, tolerance; whether the solid is smooth.
const SOLIDS: [(&str, &str, f64, bool); 18] = [
    ("S1_sphere", "", 0.01, true),
    ("S2_demo", "", 0.01, false),
    ("S3_torus_sphere", "", 0.01, true),
    ("S4_64_spheres", "", 0.03, true),
    ("S5_ring128", "", 0.03, false),
    ("S6_plate64", "", 0.03, false),
    ("torus", "torus(r1=2, r2=0.5);", 0.02, true),
    (
        "ellipsoid",
        "multmatrix([[2,0,0,1],[0,1,0,0],[0,0.3,0.5,0],[0,0,0,1]]) { sphere(r=1); }",
        0.01,
        true,
    ),
    ("cube", "cube(size=[1,2,3], center=true);", 0.01, false),
    (
        "turned_cube",
        "multmatrix([[0.36,0.48,-0.8,0],[-0.8,0.6,0,0],[0.48,0.64,0.6,7],[0,0,0,1]]) { cube(size=[1,2,3]); }",
        0.01,
        false,
    ),
    ("frustum", "cylinder(h=2, r1=1, r2=0.4);", 0.01, false),
    (
        "tee",
        "union() { cylinder(h=4, r=0.5, center=true); \
         multmatrix([[0,0,1,0],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]) { cylinder(h=3, r=0.4); } }",
        0.01,
        false,
    ),
    (
        "lens",
        "intersection() { sphere(r=1); \
         multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1.6],[0,0,0,1]]) { sphere(r=1); } }",
        0.005,
        false,
    ),
    (
        "wedge",
        "intersection() { cylinder(h=2, r=1, center=true); \
         multmatrix([[1,0,0,0.8],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { sphere(r=1.1); } }",
        0.01,
        false,
    ),
    (
        "thin_shell",
        "difference() { sphere(r=1); sphere(r=0.999); }",
        0.02,
        true,
    ),
    (
        "drilled_torus",
        "difference() { torus(r1=2, r2=0.6); \
         multmatrix([[1,0,0,2],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cylinder(h=3, r=0.25, center=true); } }",
        0.02,
        false,
    ),
    (
        "cavity",
        "difference() { cube(size=[4,4,4], center=true); sphere(r=1.5); }",
        0.02,
        false,
    ),
    ("quartic", "polynomial(\"x^4+y^4+z^4-1\");", 0.01, true),
];

/// Facets from the true surfaces, and how near they are proved to be to the boundary, both ways.
fn from_surfaces(source: &str, tolerance: f64) -> Option<(Valid<Brep>, f64)> {
    let coarse = convert_model(&read(source), Rule::Topology { finest: tolerance });
    assert_eq!(coarse.report.proved_topology, Some(true));
    let demand = Demand {
        tolerance,
        fit: Fit::Inscribed,
        if_troubled: IfTroubled::Refine,
        proof: Proof::BothWays {
            components: coarse.brep.component_count(),
        },
    };
    let (brep, counts) = tessellate(&coarse.brep, &coarse.solid, demand)?;
    let enclosure = counts.enclosure.filter(|of| of.is_both_ways)?;
    Some((brep, enclosure.distance))
}

#[test]
fn measured_distances_are_within_what_is_proved() {
    let samples = std::env::var("CSG2BREP_SAMPLES").unwrap_or_else(|_| "300".to_owned());
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = Command::new(support::validators());
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    command
        .arg(root.join("tests/python/distance.py"))
        .arg(&samples);
    let mut proved = Vec::new();
    for (name, source, tolerance, smooth) in SOLIDS {
        let model = folder.path().join(format!("{name}.csg"));
        let source = if source.is_empty() {
            let fixture = root.join(format!("fixtures/solids/{name}.csg"));
            fs::read_to_string(fixture).expect("a fixture")
        } else {
            source.to_owned()
        };
        fs::write(&model, &source).expect("a model file");
        let converted = convert(&source, tolerance);
        let mesh = folder.path().join(format!("{name}.obj"));
        let mut file = BufWriter::new(File::create(&mesh).expect("a new file"));
        obj::write(&converted.brep, &obj::Options::default(), &mut file).expect("an OBJ file");
        command.arg(model).arg(mesh);
        assert_eq!(converted.report.uncertified_leaves, 0, "{name}");
        let bound = converted.report.largest_deviation.expect("a tolerance");
        assert!(bound <= tolerance, "{name}: {bound}");
        proved.push((name, bound, smooth));
        // Facets from the true surfaces, with a proof of their own.
        let Some((brep, bound)) = from_surfaces(&source, tolerance) else {
            // Its wall is a twentieth of the tolerance: a copy within it is asked of finer facets.
            assert_eq!(name, "thin_shell");
            continue;
        };
        assert!(bound <= tolerance, "{name}: {bound}");
        let mesh = folder.path().join(format!("{name}-surfaces.obj"));
        let mut file = BufWriter::new(File::create(&mesh).expect("a new file"));
        obj::write(&brep, &obj::Options::default(), &mut file).expect("an OBJ file");
        let model = folder.path().join(format!("{name}.csg"));
        command.arg(model).arg(mesh);
        proved.push((name, bound, smooth));
    }
    let output = command.output().expect("Python runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let measured: Vec<Measured> = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(measured.len(), proved.len());
    for ((name, proved, smooth), measured) in proved.into_iter().zip(&measured) {
        let worst = measured.mesh_to_true.max(measured.true_to_mesh);
        println!(
            "{name}: proved {proved:.3e}, mesh to true {:.3e}, true to mesh {:.3e}, ratio {:.2}",
            measured.mesh_to_true,
            measured.true_to_mesh,
            proved / worst
        );
        // What the measurement itself cannot tell: it looks 1e-8 of the size around a point.
        let blur = 2e-7;
        assert!(worst <= proved + blur, "{name}: {proved}, {measured:?}");
        assert!(
            !smooth || proved <= 4.0 * worst,
            "{name}: {proved}, {measured:?}"
        );
    }
}
