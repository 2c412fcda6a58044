//! Pictures of the true solid by rays beside those of its mesh: two ways that share the camera
//! only.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use glam::DVec3;
use io::write::picture::{self, Options, View};
use stages::{Converted, convert_solid, read};
use std::f64::consts::PI;
use std::path::Path;
use subdiv::rays::Tracer;
use subdiv::{Rule, Settings};

/// Nothing that is lit looks like this.
const NOTHING: [u8; 3] = [255, 0, 255];

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

/// A fixture with a mesh that is proved to be within half a pixel.
fn convert(fixture: &str) -> Converted {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fixtures")
        .join(fixture);
    convert_source(&std::fs::read_to_string(path).unwrap())
}

fn convert_source(source: &str) -> Converted {
    let solid = csg::Solid::build(&read(source), None).unwrap();
    let rule = Rule::Tolerance(0.003 * solid.extent.diagonal());
    convert_solid(solid, &Settings::new(rule))
}

fn options(view: View) -> Options {
    Options {
        width: u32::try_from(WIDTH).unwrap(),
        height: u32::try_from(HEIGHT).unwrap(),
        view,
        samples: 1,
        background: [NOTHING; 2],
        line_width: 0.0,
        ground: false,
    }
}

fn pixels(png: &[u8]) -> Vec<[u8; 3]> {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut buffer).unwrap();
    let pixels: Vec<_> = buffer.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
    assert_eq!(pixels.len(), WIDTH * HEIGHT);
    pixels
}

/// By facets, and by rays.
fn both(converted: &Converted, view: View) -> [Vec<[u8; 3]>; 2] {
    let Converted { solid, brep, .. } = converted;
    let options = options(view);
    let (mut drawn, mut traced) = (Vec::new(), Vec::new());
    picture::write(brep, &solid.materials, &options, &mut drawn).unwrap();
    picture::write_traced(brep, solid, &options, &mut traced).unwrap();
    [pixels(&drawn), pixels(&traced)]
}

/// Pixels that show the solid, or do not, while none of the other picture's nine does the same.
fn strays(one: &[[u8; 3]], other: &[[u8; 3]]) -> Vec<[usize; 2]> {
    let near = |at: usize, size: usize| at.saturating_sub(1)..(at + 2).min(size);
    let all = (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| [column, row]));
    all.filter(|&[column, row]| {
        let here = one[row * WIDTH + column] == NOTHING;
        let mut around = near(row, HEIGHT).flat_map(|y| near(column, WIDTH).map(move |x| [x, y]));
        !around.any(|[x, y]| (other[y * WIDTH + x] == NOTHING) == here)
    })
    .collect()
}

/// Pixels that show the solid.
fn shown(picture: &[[u8; 3]]) -> usize {
    picture.iter().filter(|pixel| **pixel != NOTHING).count()
}

/// Silhouettes within a pixel, and about the same light inside them.
fn agree(fixture: &str, views: &[View]) {
    let converted = convert(fixture);
    for &view in views {
        let [drawn, traced] = both(&converted, view);
        for (one, other) in [(&drawn, &traced), (&traced, &drawn)] {
            assert_eq!(strays(one, other), [[0; 2]; 0], "{fixture} {view:?}");
        }
        assert!(shown(&traced) > WIDTH * HEIGHT / 20, "{fixture} {view:?}");
        let inner = drawn.iter().zip(&traced);
        let inner = inner.filter(|(a, b)| **a != NOTHING && **b != NOTHING);
        let off = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > 24);
        let different = inner.filter(|pair| off(*pair)).count();
        // Along creases a pixel may show the other side.
        assert!(
            different < WIDTH * HEIGHT / 50,
            "{fixture} {view:?}: {different}"
        );
    }
}

#[test]
fn quadrics_and_tori_look_as_their_meshes() {
    agree("models/tee.csg", &[View::Isometric, View::Front, View::Top]);
    agree("solids/S3_torus_sphere.csg", &[View::Right]);
    agree("solids/S6_plate64.csg", &[View::Isometric, View::Top]);
}

#[test]
fn many_parts_look_as_their_meshes() {
    agree("solids/S2_demo.csg", &[View::Back]);
    agree("solids/S4_64_spheres.csg", &[View::Isometric]);
    agree("third_party/openscad/example001.csg", &[View::Bottom]);
}

#[test]
fn higher_degrees_look_as_their_meshes() {
    agree("thesis/atomo.csg", &[View::Isometric]);
    agree("thesis/manchete.csg", &[View::Left]);
    agree("thesis/chupeta.csg", &[View::Isometric]);
    agree("solids/S7_heart.csg", &[View::Front]);
}

/// Silhouettes whose area has a formula: as many pixels show the solid as its shadow has room for.
///
/// From `View::Isometric` axes are seen under the cosine 1/√3; `high` is the shadow's height and
/// `wide` its width.
#[test]
fn silhouettes_have_the_areas_of_their_formulas() {
    let cosine = 1.0 / 3.0_f64.sqrt();
    let sine = (2.0_f64 / 3.0).sqrt();
    // A disc of radius r in projection, and a point of its axis at height h: tangents to an
    // ellipse, which is a circle in coordinates stretched by 1/cosine.
    let cone = |r: f64, h: f64| {
        let far = h * sine / cosine;
        let tangents = r * (far * far - r * r).sqrt();
        cosine * (tangents + r * r * (PI - (r / far).acos()))
    };
    // Semi-axes 2, 1, 0.5: right is (1, 1, 0)/√2, so (4 + 1)/2; up (−1, 1, 2)/√6, so (4 + 1 + 4/4)/6.
    let ellipsoid = PI * ((0.25 + 1.0 + 4.0) / 3.0_f64).sqrt();
    let [wide, high] = [2.5_f64, 1.0].map(|s| 2.0 * s.sqrt());
    let ring = PI * (1.25_f64.powi(2) - 0.75_f64.powi(2));
    let stadium = 2.0 * 0.5 + PI * 0.0625;
    let cases = [
        ("sphere(r = 1);", View::Left, PI, [2.0, 2.0]),
        ("sphere(r = 1);", View::Isometric, PI, [2.0, 2.0]),
        (
            "cube(1);",
            View::Isometric,
            3.0 * cosine,
            [2.0_f64.sqrt(), 2.0 * sine],
        ),
        (
            "cylinder(r = 1, h = 2);",
            View::Isometric,
            PI * cosine + 4.0 * sine,
            [2.0, 2.0 * sine + 2.0 * cosine],
        ),
        (
            "cylinder(r1 = 1, r2 = 0, h = 3);",
            View::Isometric,
            cone(1.0, 3.0),
            [2.0, 3.0 * sine + cosine],
        ),
        (
            "multmatrix([[2, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0.5, 0], [0, 0, 0, 1]]) sphere(r = 1);",
            View::Isometric,
            ellipsoid,
            [wide, high],
        ),
        ("torus(1, 0.25);", View::Top, ring, [2.5, 2.5]),
        ("torus(1, 0.25);", View::Front, stadium, [2.5, 0.5]),
        (
            "difference() { cube(2, center = true); cylinder(r = 0.5, h = 3, center = true); }",
            View::Top,
            4.0 - 0.25 * PI,
            [2.0, 2.0],
        ),
    ];
    for (source, view, area, [wide, high]) in cases {
        let converted = convert_source(source);
        // The picture keeps 9 % free on each side.
        let scale = (0.82 * WIDTH as f64 / wide).min(0.82 * HEIGHT as f64 / high);
        let expected = area * scale * scale;
        for picture in both(&converted, view) {
            let off = shown(&picture) as f64 / expected - 1.0;
            println!("{source} {view:?} {off:+.4}");
            assert!(off.abs() < 0.01, "{source} {view:?}: {off}");
        }
    }
}

/// The heart's polynomial, by hand.
fn heart(p: DVec3) -> f64 {
    let [x2, y2, z2] = (p * p).to_array();
    (x2 + 2.25 * y2 + z2 - 1.0).powi(3) - (x2 + 9.0 / 80.0 * y2) * z2 * p.z
}

/// The smallest value on a line: samples, and then the minimum between each that is smaller than
/// both neighbours and those, by ternary search.
fn smallest(value: impl Fn(f64) -> f64) -> f64 {
    const STEPS: i32 = 8000;
    let at = |step: i32| 1.8 * f64::from(step) / f64::from(STEPS / 2);
    let samples: Vec<f64> = (-STEPS / 2..=STEPS / 2)
        .map(|step| value(at(step)))
        .collect();
    let mut smallest = f64::INFINITY;
    for (step, three) in (1 - STEPS / 2..).zip(samples.windows(3)) {
        if three[1] > three[0] || three[1] > three[2] {
            continue;
        }
        let (mut low, mut high) = (at(step - 1), at(step + 1));
        for _ in 0..60 {
            let (a, b) = ((2.0 * low + high) / 3.0, (low + 2.0 * high) / 3.0);
            if value(a) < value(b) {
                high = b;
            } else {
                low = a;
            }
        }
        smallest = smallest.min(value(low));
    }
    smallest
}

/// The heart's tip is a cusp, and from the side and above it stands out behind the belly. That
/// looks like a notch, and it is one: rays around it hit where the formula is negative.
#[test]
fn the_hearts_tip_is_where_its_formula_says() {
    const SIDE: i32 = 40;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/solids/S7_heart.csg");
    let model = read(&std::fs::read_to_string(path).unwrap());
    let solid = csg::Solid::build(&model, None).unwrap();
    let direction = DVec3::new(-1.0, 1.0, -1.0).normalize();
    let right = DVec3::new(1.0, 1.0, 0.0).normalize();
    let up = right.cross(direction);
    let origins: Vec<DVec3> = (0..SIDE * SIDE)
        .map(|at| [at % SIDE, at / SIDE].map(|x| 0.004 * (f64::from(x - SIDE / 2) + 0.37)))
        .map(|[x, y]| DVec3::NEG_Z + right * x + up * y)
        .collect();
    let hits = Tracer::new(&solid).first_hits(direction, &origins).unwrap();
    let mut seen = 0;
    for (hit, origin) in hits.iter().zip(&origins) {
        let deepest = smallest(|t| heart(*origin + direction * t));
        // Values of the tracer are rounded by some 1e-15.
        if deepest.abs() > 1e-14 {
            assert_eq!(hit.is_some(), deepest < 0.0, "{origin} {deepest}");
        }
        seen += usize::from(hit.is_some());
    }
    let all = origins.len();
    assert!(all / 5 < seen && seen < 4 * all / 5, "{seen} of {all}");
}

/// Nothing depends on which rays travel together.
#[test]
fn threads_do_not_matter() {
    let converted = convert("solids/S3_torus_sphere.csg");
    let draw = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| both(&converted, View::Isometric))
    };
    assert!(draw(1) == draw(3));
}
