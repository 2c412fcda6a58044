//! Quadrics, and tori that cross themselves, that STEP has no entity for.

use crate::opencascade::Part;
use crate::solids::{TOLERANCE, check, near, reread};
use std::f64::consts::PI;

/// A box as `x`, `y` and `z` from and to.
fn within(x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> String {
    let [a, b, c] = [x, y, z].map(|[from, _]| from);
    let [d, e, f] = [x, y, z].map(|[from, to]| to - from);
    format!("multmatrix([[1,0,0,{a}],[0,1,0,{b}],[0,0,1,{c}],[0,0,0,1]]) cube(size=[{d},{e},{f}]);")
}

fn cut(what: &str, x: [f64; 2], y: [f64; 2], z: [f64; 2]) -> String {
    format!("intersection() {{ {what} {} }}", within(x, y, z))
}

fn stretched(x: f64, y: f64, z: f64, what: &str) -> String {
    format!("multmatrix([[{x},0,0,0],[0,{y},0,0],[0,0,{z},0],[0,0,0,1]]) {what}")
}

fn zero(polynomial: &str) -> String {
    format!("polynomial(\"{polynomial}\");")
}

/// All, each with its volume and the kinds of its surfaces; volumes are integrals over z, x or y
/// that can be looked up.
#[expect(clippy::too_many_lines, reason = "a table")]
fn models() -> Vec<(&'static str, String, f64, &'static str)> {
    let wide = [-9.0, 9.0];
    // Part of a ball of radius 1 on one side of a plane at a distance.
    let cap = |from: f64| PI * ((1.0 - from) - (1.0 - from.powi(3)) / 3.0);
    let ball = "sphere(r=1);";
    // x² + y² = z² ± 1 between -1, or 1, and 2 or 3.
    let (one, two) = (PI * (3.0 + 3.0), PI * (26.0 / 3.0 - 2.0));
    // The circle about (1, 0) with radius 2 turns about x = 0; its angle reaches to 2π/3.
    let angle = (-0.5_f64).acos();
    let (sine, double) = (angle.sin(), (2.0 * angle).sin());
    let apple = 2.0
        * PI
        * (2.0 * sine + 8.0 * (angle / 2.0 + double / 4.0) + 8.0 * (sine - sine.powi(3) / 3.0));
    let root = 5.0_f64.sqrt();
    vec![
        (
            "paraboloid",
            cut(&zero("x^2+y^2-2*z"), wide, wide, [-1.0, 2.0]),
            4.0 * PI,
            "plane 1 surfaceofrevolution 1",
        ),
        (
            "elliptic_paraboloid",
            cut(&zero("x^2/4+y^2-2*z"), wide, wide, [-1.0, 2.0]),
            8.0 * PI,
            "bsplinesurface 1 plane 1",
        ),
        (
            "dent",
            format!(
                "difference() {{ {} {} }}",
                within([-3.0, 3.0], [-3.0, 3.0], [0.0, 4.0]),
                zero("x^2+y^2+z-3")
            ),
            144.0 - 4.5 * PI,
            "plane 6 surfaceofrevolution 1",
        ),
        (
            "hyperboloid",
            cut(&zero("x^2+y^2-z^2-1"), wide, wide, [-1.0, 2.0]),
            one,
            "plane 2 surfaceofrevolution 1",
        ),
        (
            "elliptic_hyperboloid",
            cut(&zero("x^2/4+y^2-z^2-1"), wide, wide, [-1.0, 2.0]),
            2.0 * one,
            "bsplinesurface 1 plane 2",
        ),
        (
            "half_hyperboloid",
            cut(&zero("x^2/4+y^2-z^2-1"), wide, [0.0, 9.0], [-1.0, 2.0]),
            one,
            "bsplinesurface 1 plane 3",
        ),
        (
            "bowl",
            cut(&zero("x^2+y^2-z^2+1"), wide, wide, [0.0, 3.0]),
            two,
            "plane 1 surfaceofrevolution 1",
        ),
        (
            "elliptic_bowl",
            cut(&zero("x^2/4+y^2-z^2+1"), wide, wide, [0.0, 3.0]),
            2.0 * two,
            "bsplinesurface 1 plane 1",
        ),
        (
            "spheroid_cap",
            cut(&stretched(2.0, 2.0, 1.0, ball), wide, wide, [0.25, 9.0]),
            4.0 * cap(0.25),
            "plane 1 surfaceofrevolution 1",
        ),
        (
            "spheroid_side",
            cut(&stretched(2.0, 2.0, 1.0, ball), [0.5, 9.0], wide, wide),
            4.0 * cap(0.25),
            "plane 1 surfaceofrevolution 1",
        ),
        (
            "ellipsoid_cap",
            cut(&stretched(3.0, 2.0, 1.0, ball), wide, wide, [0.25, 9.0]),
            6.0 * cap(0.25),
            "bsplinesurface 1 plane 1",
        ),
        (
            "elliptic_cone",
            stretched(2.0, 1.0, 1.0, "cylinder(h=1, r1=1, r2=0);"),
            2.0 * PI / 3.0,
            "bsplinesurface 1 plane 1",
        ),
        (
            "elliptic_frustum",
            stretched(2.0, 1.0, 1.0, "cylinder(h=1, r1=1, r2=0.5);"),
            7.0 * PI / 6.0,
            "bsplinesurface 1 plane 2",
        ),
        (
            "half_frustum",
            cut(
                &stretched(2.0, 1.0, 1.0, "cylinder(h=1, r1=1, r2=0.5);"),
                wide,
                [0.0, 9.0],
                wide,
            ),
            7.0 * PI / 12.0,
            "bsplinesurface 1 plane 3",
        ),
        (
            "saddle",
            cut(
                &zero("z-x^2/4+y^2/3"),
                [-1.0, 2.0],
                [-2.0, 2.0],
                [-4.0, 4.0],
            ),
            48.0 + 3.0 - 16.0 / 3.0,
            "bsplinesurface 1 plane 5",
        ),
        (
            "trough",
            cut(&zero("x^2-2*z"), wide, [-1.0, 1.0], [-1.0, 2.0]),
            32.0 / 3.0,
            "bsplinesurface 1 plane 3",
        ),
        (
            "waist",
            cut(&zero("x^2-y^2-1"), [-3.0, 3.0], [-2.0, 2.0], [-1.0, 1.0]),
            4.0 * (2.0 * root + 2.0_f64.asinh()),
            "bsplinesurface 2 plane 4",
        ),
        (
            "apple",
            "torus(r1=1, r2=2);".to_owned(),
            apple,
            "surfaceofrevolution 1",
        ),
    ]
}

#[test]
fn quadrics_are_true_surfaces_with_the_volumes_of_the_formulas() {
    let models = models();
    let sources: Vec<(String, String)> = models
        .iter()
        .map(|(name, source, ..)| ((*name).to_owned(), source.clone()))
        .collect();
    for ((name, _, volume, surfaces), (written, file)) in
        models.iter().zip(reread(&sources, TOLERANCE))
    {
        check(name, &written, &file, TOLERANCE);
        let faceted = &written.outcome.faceted;
        assert!(faceted.is_empty(), "{name}: {faceted:?}");
        let part: &Part = &file.solids[0];
        assert!(near(part.volume, *volume), "{name}: {part:?}, {volume}");
        let kinds: Vec<String> = part
            .surfaces
            .iter()
            .map(|(kind, count)| format!("{kind} {count}"))
            .collect();
        assert_eq!(kinds.join(" "), *surfaces, "{name}");
    }
}
