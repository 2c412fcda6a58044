//! The proved volume interval of solids whose volume has a formula.

mod stages;

use stages::convert;
use std::f64::consts::PI;

fn moved(x: f64, y: f64, z: f64, body: &str) -> String {
    format!("multmatrix([[1,0,0,{x}],[0,1,0,{y}],[0,0,1,{z}],[0,0,0,1]]) {{ {body} }}")
}

fn lying(body: &str) -> String {
    format!("multmatrix([[0,0,1,0],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]) {{ {body} }}")
}

fn ball(r: f64) -> f64 {
    4.0 / 3.0 * PI * r.powi(3)
}

fn tube(r: f64, h: f64) -> f64 {
    PI * r * r * h
}

/// Frustum of a cone: πh(a² + ab + b²)/3.
fn frustum(a: f64, b: f64, h: f64) -> f64 {
    PI * h * (a * a + a * b + b * b) / 3.0
}

/// Torus: 2π²Rr².
fn ring(big: f64, small: f64) -> f64 {
    2.0 * PI * PI * big * small * small
}

/// Cap of height h of a ball: πh²(3r − h)/3.
fn cap(r: f64, h: f64) -> f64 {
    PI * h * h * (3.0 * r - h) / 3.0
}

/// Two balls of one radius, centres d apart: two caps of height r − d/2.
fn lens(r: f64, d: f64) -> f64 {
    2.0 * cap(r, r - d / 2.0)
}

/// Solids, their volumes, and whether all their faces are planes.
#[expect(clippy::too_many_lines, reason = "a list")]
fn solids() -> Vec<(String, f64, bool)> {
    let mut all: Vec<(String, f64, bool)> = Vec::new();
    let mut add = |source: String, volume: f64| all.push((source, volume, false));
    for r in [0.3, 1.0, 7.0] {
        add(format!("sphere(r={r});"), ball(r));
    }
    for (r, h) in [(1.0, 1.0), (0.5, 3.0), (2.0, 0.4)] {
        add(format!("cylinder(h={h}, r={r});"), tube(r, h));
    }
    for (a, b, h) in [(1.0, 0.5, 1.0), (2.0, 0.3, 1.5), (0.2, 0.8, 2.0)] {
        add(
            format!("cylinder(h={h}, r1={a}, r2={b});"),
            frustum(a, b, h),
        );
    }
    for (big, small) in [(1.0, 0.3), (2.0, 0.5), (1.0, 0.9)] {
        add(format!("torus(r1={big}, r2={small});"), ring(big, small));
    }
    for (x, y, z) in [(1.0, 2.0, 3.0), (0.5, 0.7, 0.9)] {
        let source = format!(
            "multmatrix([[{x},0,0,0],[0,{y},0,0],[0,0,{z},0],[0,0,0,1]]) {{ sphere(r=1); }}"
        );
        add(source, ball(1.0) * x * y * z);
    }
    // A shear keeps the volume.
    let sheared = "multmatrix([[1,0.4,0,0],[0,1,0.3,0],[0,0,1,0],[0,0,0,1]])";
    add(format!("{sheared} {{ sphere(r=1); }}"), ball(1.0));
    add(
        format!("{sheared} {{ cylinder(h=1, r=1); }}"),
        tube(1.0, 1.0),
    );
    // Turned by the angle whose cosine is 0.6.
    let turned = "multmatrix([[0.6,-0.8,0,1],[0.8,0.6,0,2],[0,0,1,3],[0,0,0,1]])";
    add(
        format!("{turned} {{ torus(r1=1, r2=0.4); }}"),
        ring(1.0, 0.4),
    );
    for d in [0.5, 1.0, 1.5] {
        let other = moved(d, 0.0, 0.0, "sphere(r=1);");
        add(
            format!("intersection() {{ sphere(r=1); {other} }}"),
            lens(1.0, d),
        );
        add(
            format!("union() {{ sphere(r=1); {other} }}"),
            2.0 * ball(1.0) - lens(1.0, d),
        );
        add(
            format!("difference() {{ sphere(r=1); {other} }}"),
            ball(1.0) - lens(1.0, d),
        );
    }
    // Half a ball, and a cap of it.
    add(
        format!(
            "difference() {{ sphere(r=1); {} }}",
            moved(-2.0, -2.0, 0.0, "cube(size=[4,4,4]);")
        ),
        ball(1.0) / 2.0,
    );
    add(
        format!(
            "intersection() {{ sphere(r=1); {} }}",
            moved(-2.0, -2.0, 0.7, "cube(size=[4,4,4]);")
        ),
        cap(1.0, 0.3),
    );
    add(
        "difference() { sphere(r=1); sphere(r=0.5); }".into(),
        ball(1.0) - ball(0.5),
    );
    add(
        "difference() { cube(size=[2,2,2], center=true); sphere(r=0.8); }".into(),
        8.0 - ball(0.8),
    );
    add(
        "difference() { cube(size=[2,2,2], center=true); cylinder(h=3, r=0.5, center=true); }"
            .into(),
        8.0 - tube(0.5, 2.0),
    );
    add(
        "difference() { cylinder(h=2, r=1); cylinder(h=5, r=0.6, center=true); }".into(),
        tube(1.0, 2.0) - tube(0.6, 2.0),
    );
    // Steinmetz: 16r³/3.
    let crossed = lying("cylinder(h=4, r=1, center=true);");
    let upright = "cylinder(h=4, r=1, center=true);";
    add(
        format!("intersection() {{ {upright} {crossed} }}"),
        16.0 / 3.0,
    );
    add(
        format!("union() {{ {upright} {crossed} }}"),
        2.0 * tube(1.0, 4.0) - 16.0 / 3.0,
    );
    // The napkin ring: a ball of radius √(1 + 0.5²) with a bore that leaves the height 2.
    let radius = 1.25_f64.sqrt();
    add(
        format!("difference() {{ sphere(r={radius}); cylinder(h=4, r=0.5, center=true); }}"),
        ball(1.0),
    );
    // A capsule.
    add(
        format!(
            "union() {{ cylinder(h=2, r=0.5); sphere(r=0.5); {} }}",
            moved(0.0, 0.0, 2.0, "sphere(r=0.5);")
        ),
        tube(0.5, 2.0) + ball(0.5),
    );
    // Dirichlet: |x|ⁿ + |y|ⁿ + |z|ⁿ ≤ 1 has the volume 8Γ(1 + 1/n)³/Γ(1 + 3/n).
    let (quarter, three_quarters) = (0.906_402_477_055_477_f64, 0.919_062_526_848_883_2_f64);
    add(
        "polynomial(\"x^4+y^4+z^4-1\");".into(),
        8.0 * quarter.powi(3) / three_quarters,
    );
    let mut plane = |source: String, volume: f64| all.push((source, volume, true));
    for (x, y, z) in [(1.0, 1.0, 1.0), (2.0, 0.1, 5.0)] {
        plane(format!("cube(size=[{x},{y},{z}]);"), x * y * z);
    }
    plane(format!("{turned} {{ cube(size=[1,2,3]); }}"), 6.0);
    plane(
        format!(
            "union() {{ cube(size=[1,1,1]); {} }}",
            moved(0.5, 0.5, 0.5, "cube(size=[1,1,1]);")
        ),
        1.875,
    );
    plane(
        format!(
            "difference() {{ cube(size=[3,3,3]); {} }}",
            moved(1.0, 1.0, 1.0, "cube(size=[1,1,1]);")
        ),
        26.0,
    );
    // A wall of 1e-6 of the size.
    plane("cube(size=[1,1,1e-6]);".into(), 1e-6);
    all
}

#[test]
fn intervals_hold_the_exact_volume() {
    let solids = solids();
    assert!(solids.len() >= 40, "{}", solids.len());
    for (source, volume, planes) in solids {
        let extent = volume.cbrt();
        let tolerance = 0.004 * extent;
        let converted = convert(&source, tolerance);
        let [low, high] = converted.report.volume_interval.expect("an interval");
        let width = (high - low) / volume;
        let area = converted.properties.area;
        // In units of what the boundary sweeps when it moves by the tolerance to either side.
        let relative = (high - low) / (2.0 * tolerance * area);
        println!("{width:.1e} {relative:.2} {source}");
        // The formula's own rounding, and that of the decimals in the source.
        let rounding = 1e-14 * volume;
        assert!(
            low <= volume + rounding && volume - rounding <= high,
            "{source}: {low} {volume} {high}"
        );
        assert!(relative <= 3.0, "{source}: {relative}");
        // Rounding is relative to the domain: signs of values of some 1 that went through some
        // thirty bisections of 1e-16 each, over the boundary's area.
        let blurred = 1e-9 * area * area.sqrt();
        assert!(!planes || high - low <= blurred, "{source}: {width}");
    }
}

#[test]
fn intervals_do_not_depend_on_threads() {
    let source = "difference() { sphere(r=1); cylinder(h=4, r=0.5, center=true); }";
    let interval = |threads| {
        let solid = csg::Solid::build(&stages::read(source), None).expect("a solid");
        let settings = subdiv::Settings {
            threads: Some(threads),
            ..subdiv::Settings::new(subdiv::Rule::Tolerance(0.02))
        };
        subdiv::convert(&solid, &settings, &())
            .expect("a subdivision")
            .report
            .volume_interval
    };
    let one = interval(1);
    assert!(one.is_some());
    assert_eq!(one, interval(2));
    assert_eq!(one, interval(7));
}
