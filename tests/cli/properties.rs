//! `csg2brep properties` against the formulas of boxes, balls and cylinders.

use serde_json::Value;
use std::f64::consts::PI;

/// What the program prints for a model, with options.
fn properties(model: &str, options: &[&str]) -> Value {
    let output = super::csg2brep()
        .args(["properties", "-", "--json", "-q"])
        .args(options)
        .write_stdin(model)
        .assert()
        .success();
    serde_json::from_slice(&output.get_output().stdout).expect("JSON")
}

fn float(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Area, volume, centroid, diagonal of the inertia tensor.
fn check(found: &Value, area: f64, volume: f64, centroid: [f64; 3], inertia: [f64; 3], error: f64) {
    let close = |found: &Value, expected: f64, scale: f64| {
        let found = float(found);
        let allowed = error * scale;
        assert!((found - expected).abs() <= allowed, "{found} {expected}");
    };
    close(&found["area"], area, area);
    close(&found["volume"], volume, volume);
    let largest = inertia.into_iter().fold(0.0, f64::max);
    for axis in 0..3 {
        close(&found["centroid"][axis], centroid[axis], 1.0);
        for other in 0..3 {
            let expected = if axis == other { inertia[axis] } else { 0.0 };
            close(&found["inertia"][axis][other], expected, largest);
        }
    }
}

#[test]
fn a_box_and_a_hollow_box_are_exact() {
    let cube = "multmatrix([[1,0,0,10],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) \
                { cube(size = [1, 2, 3], center = true); }";
    let hollow = "difference() { cube(size = [4, 4, 4], center = true); \
                  cube(size = [2, 2, 2], center = true); }";
    let found = properties(&format!("{cube}\n{hollow}"), &[]);
    let solids = found["solids"].as_array().expect("solids");
    assert_eq!(solids.len(), 2);
    // The order of solids is that of their first facets.
    let first_is_cube = solids[0]["shells"] == 1;
    let [block, shell] = if first_is_cube { [0, 1] } else { [1, 0] }.map(|at| &solids[at]);
    let of_block = [13.0, 10.0, 5.0].map(|sum| 6.0 * sum / 12.0);
    check(block, 22.0, 6.0, [10.0, 0.0, 0.0], of_block, 1e-12);
    // m (b² + c²) / 12 of 64 · 32, less that of 8 · 8.
    let of_shell = (64.0 * 32.0 - 8.0 * 8.0) / 12.0;
    check(shell, 96.0 + 24.0, 56.0, [0.0; 3], [of_shell; 3], 1e-12);
    assert_eq!(shell["shells"], 2);

    // Together: masses 6 and 56 at distance 10 along x.
    let reduced = 6.0 * 56.0 / 62.0 * 100.0;
    let [x, y, z] = of_block;
    let inertia = [x + of_shell, y + of_shell + reduced, z + of_shell + reduced];
    let centroid = [60.0 / 62.0, 0.0, 0.0];
    check(&found["total"], 142.0, 62.0, centroid, inertia, 1e-12);
}

#[test]
fn a_ball_and_a_cylinder_converge_to_their_formulas() {
    // Facets within 0.001 of the surface: volume and area err by less than 3 · 0.001 of
    // themselves, second moments by 5 · 0.001.
    let error = 0.005;
    let options = ["--tolerance", "0.001"];
    let ball = properties("sphere(r = 1, $fn = 0);", &options);
    let (volume, inertia) = (4.0 / 3.0 * PI, 8.0 / 15.0 * PI);
    let (area, centre) = (4.0 * PI, [0.0; 3]);
    check(&ball["total"], area, volume, centre, [inertia; 3], error);

    let cylinder = properties("cylinder(h = 2, r1 = 1, r2 = 1, $fn = 0);", &options);
    let mass = 2.0 * PI;
    // m (3 r² + h²) / 12 and m r² / 2.
    let inertia = [mass * 7.0 / 12.0, mass * 7.0 / 12.0, mass / 2.0];
    let solids = cylinder["solids"].as_array().expect("solids");
    assert_eq!(solids.len(), 1);
    check(&solids[0], 6.0 * PI, mass, [0.0, 0.0, 1.0], inertia, error);
    assert_eq!(solids[0]["genus"], 0);
}

#[test]
fn the_empty_solid_has_no_centroid() {
    let found = properties("group();", &[]);
    assert_eq!(found["solids"], Value::Array(Vec::new()));
    assert!(found["total"]["centroid"].is_null());
}
