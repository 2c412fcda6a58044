//! Pictures of the true solid by rays beside those of its mesh: two ways that share the camera
//! only.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use io::write::picture::{self, Options, View};
use stages::{Converted, convert_solid, read};
use std::path::Path;
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
    let model = read(&std::fs::read_to_string(path).unwrap());
    let solid = csg::Solid::build(&model, None).unwrap();
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

/// Silhouettes within a pixel, and about the same light inside them.
fn agree(fixture: &str, views: &[View]) {
    let converted = convert(fixture);
    for &view in views {
        let [drawn, traced] = both(&converted, view);
        for (one, other) in [(&drawn, &traced), (&traced, &drawn)] {
            assert_eq!(strays(one, other), [[0; 2]; 0], "{fixture} {view:?}");
        }
        let solid = |picture: &[[u8; 3]]| picture.iter().filter(|p| **p != NOTHING).count();
        assert!(solid(&traced) > WIDTH * HEIGHT / 20, "{fixture} {view:?}");
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
    agree("solids/S6_plate64.csg", &[View::Isometric]);
}

#[test]
fn many_parts_look_as_their_meshes() {
    agree("solids/S2_demo.csg", &[View::Back]);
    agree("thesis/spheres_064.csg", &[View::Isometric]);
    agree("third_party/openscad/example001.csg", &[View::Bottom]);
}

#[test]
fn higher_degrees_look_as_their_meshes() {
    agree("thesis/atomo.csg", &[View::Isometric]);
    agree("thesis/manchete.csg", &[View::Left]);
    agree("thesis/chupeta.csg", &[View::Isometric]);
    agree("solids/S7_heart.csg", &[View::Front]);
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
