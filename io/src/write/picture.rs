//! A shaded picture of the boundary as PNG: hidden surfaces by a depth buffer, soft light from a
//! bright sky and a broad lamp (so creases darken and the solid stands in its own shadow), edges
//! of the B-Rep drawn as dark lines, and every pixel averaged over many samples.
//!
//! Same input, same pixels, for any number of threads. Transparent materials are drawn opaque.

mod camera;
mod light;
mod lines;
mod raster;
mod scene;
mod seen;
mod shade;
mod truth;

use super::Error;
use brep::{Brep, Shading, Valid};
use csg::{Material, Solid};
use std::io::Write;

/// From where to look; z is up, and the front is seen when looking along +y.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub enum View {
    /// From the right, the front and above, with all three axes equally short.
    #[default]
    Isometric,
    /// Along +y.
    Front,
    /// Along −y.
    Back,
    /// Along +x.
    Left,
    /// Along −x.
    Right,
    /// From above, y upward.
    Top,
    /// From below, y downward.
    Bottom,
    /// From any direction.
    Direction {
        /// Where the eye stands around the z axis: 0 on +x, 90 on +y, in degrees.
        azimuth_deg: f64,
        /// How high it stands: 90 straight above, in degrees, clamped to ±90.
        elevation_deg: f64,
    },
}

/// What to draw.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Options {
    /// Pixels a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// From where to look.
    pub view: View,
    /// Samples a pixel on each axis, 1 to 8.
    pub samples: u32,
    /// Colours of the background at the top and at the bottom, sRGB.
    pub background: [[u8; 3]; 2],
    /// Width of the edges in pixels; 0 draws none.
    pub line_width: f32,
    /// Whether the solid stands on ground that catches its shadow; seen from above only.
    pub ground: bool,
}

impl Options {
    /// Most pixels of a picture.
    pub const MAX_PIXELS: u64 = 1 << 26;
}

impl Default for Options {
    fn default() -> Self {
        Self {
            width: 1200,
            height: 900,
            view: View::default(),
            samples: 4,
            background: [[250, 251, 252], [226, 231, 236]],
            line_width: 1.5,
            ground: true,
        }
    }
}

/// Draws the boundary; the empty solid gives the background alone.
///
/// # Errors
/// [`Error::PictureSize`] for no pixel or more than [`Options::MAX_PIXELS`], [`Error::Png`].
pub fn write(
    brep: &Valid<Brep>,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    write_shaded(brep, &Shading::of(brep), materials, options, out)
}

/// As [`write()`], with normals of the caller's choice.
///
/// # Errors
/// As [`write()`].
pub fn write_shaded(
    brep: &Valid<Brep>,
    shading: &Shading,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    check_size(options)?;
    let scene = scene::Scene::new(brep, shading, materials);
    encode(&shade::render(&scene, None, options)?, options, out)
}

/// As [`write()`], of the true solid: each sample shows where its ray meets it first, with the
/// surface's normal there. Frame and shadows come from the mesh.
///
/// `solid` is what the boundary was made from. Cost: about a microsecond a sample for quadrics,
/// several for quartics.
///
/// # Errors
/// As [`write()`]; [`Error::Rays`].
pub fn write_traced(
    brep: &Valid<Brep>,
    solid: &Solid,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    check_size(options)?;
    let scene = scene::Scene::new(brep, &Shading::of(brep), &solid.materials);
    let truth = truth::Truth::new(solid, &scene);
    encode(&shade::render(&scene, Some(&truth), options)?, options, out)
}

fn check_size(options: &Options) -> Result<(), Error> {
    let Options { width, height, .. } = *options;
    if width == 0 || height == 0 || u64::from(width) * u64::from(height) > Options::MAX_PIXELS {
        return Err(Error::PictureSize { width, height });
    }
    Ok(())
}

/// `pixels`: RGB, row by row.
fn encode(pixels: &[u8], options: &Options, out: &mut impl Write) -> Result<(), Error> {
    let mut encoder = png::Encoder::new(out, options.width, options.height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_compression(png::Compression::Balanced);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::samples::{cube, painted, sphere};
    use super::*;
    use subdiv::Fragments;

    const SMALL: Options = Options {
        width: 96,
        height: 72,
        view: View::Isometric,
        samples: 4,
        background: [[250, 251, 252], [226, 231, 236]],
        line_width: 1.0,
        ground: true,
    };

    /// Draws and decodes: rows of pixels.
    fn pixels(
        fragments: &Fragments,
        materials: &[Material],
        options: &Options,
    ) -> Vec<Vec<[u8; 3]>> {
        let brep = brep::stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let mut bytes = Vec::new();
        write(&brep, materials, options, &mut bytes).expect("a picture");
        let decoder = png::Decoder::new(std::io::Cursor::new(bytes));
        let mut reader = decoder.read_info().expect("a header");
        let mut buffer = vec![0; reader.output_buffer_size().expect("small")];
        let frame = reader.next_frame(&mut buffer).expect("a frame");
        assert_eq!((frame.width, frame.height), (options.width, options.height));
        let row = |row: &[u8]| row.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect();
        buffer
            .chunks_exact(3 * options.width as usize)
            .map(row)
            .collect()
    }

    fn brightness([red, green, blue]: [u8; 3]) -> u32 {
        u32::from(red) + u32::from(green) + u32::from(blue)
    }

    #[test]
    fn the_empty_solid_is_background() {
        let rows = pixels(&Fragments::default(), &[], &SMALL);
        for row in &rows {
            assert!(row.iter().all(|pixel| *pixel == row[0]));
        }
        assert_eq!(rows[0][0], [250, 251, 252]);
        assert!(brightness(rows[71][0]) < brightness(rows[0][0]));
    }

    #[test]
    fn colours_and_background_are_where_they_should_be() {
        let green = [
            Material { color: None },
            Material {
                color: Some([0.1, 0.8, 0.1, 1.0]),
            },
        ];
        let fragments = painted(sphere(4), 0, 1);
        for view in [View::Front, View::Top, View::Bottom, View::Isometric] {
            let rows = pixels(&fragments, &green, &Options { view, ..SMALL });
            let [red, middle, blue] = rows[36][48];
            assert!(middle > 2 * red && middle > 2 * blue, "{view:?}");
            // The ball fills 82 % of the height: corners stay free.
            assert!(brightness(rows[2][2]) > 700, "{view:?}");
        }
    }

    #[test]
    fn lines_are_dark_and_can_be_left_out() {
        let darkest = |line_width| {
            let options = Options {
                line_width,
                ..SMALL
            };
            let rows = pixels(&cube([0.0; 3], 1.0), &[], &options);
            rows.into_iter()
                .flatten()
                .map(brightness)
                .min()
                .unwrap_or(0)
        };
        assert!(darkest(2.0) < 200 && darkest(0.0) > 200);
    }

    #[test]
    fn hidden_edges_are_not_drawn() {
        // From the front a cube shows its outline only: the middle of the picture is even.
        let options = Options {
            view: View::Front,
            ..SMALL
        };
        let rows = pixels(&cube([0.0; 3], 1.0), &[], &options);
        let inner: Vec<u32> = rows[20..52]
            .iter()
            .flat_map(|row| &row[32..64])
            .map(|p| brightness(*p))
            .collect();
        let (darkest, brightest) = (inner.iter().min(), inner.iter().max());
        assert!(
            brightest.zip(darkest).is_some_and(|(a, b)| a - b < 30),
            "{brightest:?} {darkest:?}"
        );
    }

    #[test]
    fn the_ground_catches_a_shadow() {
        let total = |ground| {
            let rows = pixels(&cube([0.0; 3], 1.0), &[], &Options { ground, ..SMALL });
            rows.into_iter().flatten().map(brightness).sum::<u32>()
        };
        assert!(total(true) < total(false));
    }

    #[test]
    fn threads_do_not_matter() {
        let draw = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads")
                .install(|| pixels(&sphere(3), &[], &SMALL))
        };
        assert!(draw(1) == draw(3));
    }

    #[test]
    fn any_sampling_gives_about_the_same_picture() {
        let draw = |samples| pixels(&sphere(3), &[], &Options { samples, ..SMALL });
        let best = draw(4);
        for samples in [0, 1, 2, 3, 5, 8, 100] {
            let other = draw(samples);
            let difference: u32 = best
                .iter()
                .flatten()
                .zip(other.iter().flatten())
                .map(|(a, b)| brightness(*a).abs_diff(brightness(*b)))
                .sum();
            // Along lines whole pixels may differ; on average little does.
            assert!(difference < 96 * 72 * 12, "{samples}: {difference}");
        }
    }

    #[test]
    fn impossible_sizes_are_errors() {
        let brep = brep::stitch(&Fragments::default())
            .expect("closed")
            .validate()
            .expect("valid");
        for (width, height) in [(0, 9), (9, 0), (u32::MAX, u32::MAX)] {
            let options = Options {
                width,
                height,
                ..SMALL
            };
            let error = write(&brep, &[], &options, &mut Vec::new());
            assert!(matches!(error, Err(Error::PictureSize { .. })));
        }
    }

    #[test]
    fn solids_without_extent_do_no_harm() {
        let mut fragments = cube([0.0; 3], 1.0);
        fragments.positions.fill(glam::DVec3::ONE);
        pixels(&fragments, &[], &SMALL);
    }
}
