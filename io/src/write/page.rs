//! A page that shows the boundary: one HTML file with everything in it, to turn, move and zoom the
//! solid in any browser. It holds the GLB file, the edges of the B-Rep and a small viewer, and its
//! own policy forbids it any access to a network.

use super::gltf::{self, local_origin};
use super::stl::single_precision;
use super::{Error, GENERATOR};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use brep::{Brep, Shading, Valid};
use csg::Material;
use glam::DVec3;
use std::io::Write;

/// The page, with places for what is put into it.
const TEMPLATE: &str = include_str!("page/viewer.html");

/// What to show.
#[derive(Clone, PartialEq, Debug)]
pub struct Options {
    /// The page's title.
    pub title: String,
    /// Direction from the solid to the eye at first; z is up.
    pub toward_eye: DVec3,
}

/// Writes the page. Normals are the caller's choice; positions are 32-bit numbers as in GLB.
///
/// # Errors
/// As [`gltf::write`].
pub fn write(
    brep: &Valid<Brep>,
    shading: &Shading,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    let mut glb = Vec::new();
    gltf::write_shaded(
        brep,
        shading,
        materials,
        &gltf::Options::default(),
        &mut glb,
    )?;
    let origin = local_origin(&brep.bounds());
    let mut edges: Vec<[f32; 3]> = Vec::new();
    for edge in &shading.groups.edges {
        for &key in &edge.chain {
            let half_edge = brep.half_edge(key);
            for vertex in [half_edge.origin(), half_edge.target()] {
                edges.push(single_precision(vertex.position() - origin)?.to_array());
            }
        }
    }
    let [x, y, z] = options.toward_eye.to_array();
    let eye = format!("[{x}, {y}, {z}]");
    let values = [
        ("TITLE", escaped(&options.title)),
        ("GENERATOR", escaped(GENERATOR)),
        ("EYE", eye),
        ("EDGES", STANDARD.encode(bytemuck::cast_slice(&edges))),
        ("GLB", STANDARD.encode(&glb)),
    ];
    // The template's places look like %TITLE%; what is put in is never looked at again.
    let mut rest = TEMPLATE;
    while let Some((before, after)) = rest.split_once('%') {
        out.write_all(before.as_bytes())?;
        let found = values
            .iter()
            .find_map(|(name, value)| Some((value, after.strip_prefix(name)?.strip_prefix('%')?)));
        if let Some((value, _)) = found {
            out.write_all(value.as_bytes())?;
        } else {
            out.write_all(b"%")?;
        }
        rest = found.map_or(after, |(_, after)| after);
    }
    out.write_all(rest.as_bytes())?;
    Ok(())
}

/// Text for HTML.
fn escaped(text: &str) -> String {
    quick_xml::escape::escape(text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::super::samples::cube;
    use super::*;
    use brep::stitch;

    fn page(title: &str) -> String {
        let brep = stitch(&cube([0.0; 3], 1.0)).expect("closed").validate();
        let brep = brep.expect("valid");
        let options = Options {
            title: title.to_owned(),
            toward_eye: DVec3::new(1.0, -2.0, 0.5),
        };
        let mut bytes = Vec::new();
        write(&brep, &Shading::of(&brep), &[], &options, &mut bytes).expect("memory");
        String::from_utf8(bytes).expect("text")
    }

    /// What stands between two texts.
    fn between<'a>(page: &'a str, before: &str, after: &str) -> &'a str {
        let (_, rest) = page.split_once(before).expect("the beginning");
        rest.split_once(after).expect("the end").0
    }

    #[test]
    fn it_holds_the_glb_file_and_every_edge() {
        let page = page("a cube");
        let glb = STANDARD.decode(between(&page, "const glb = \"", "\""));
        let glb = glb.expect("base 64");
        let mesh = crate::read::mesh::read(
            &glb,
            crate::read::mesh::MeshFormat::Glb,
            crate::read::mesh::Limits::default(),
        );
        assert_eq!(mesh.expect("a mesh").triangles.len(), 12);
        let edges = STANDARD.decode(between(&page, "const edges = \"", "\""));
        // 12 edges of two ends of three numbers.
        assert_eq!(edges.expect("base 64").len(), 12 * 2 * 3 * 4);
        assert!(page.contains("const eye = [1, -2, 0.5]"));
    }

    #[test]
    fn it_asks_for_nothing_from_outside_and_titles_are_text() {
        let page = page("</title><script>alert(1)</script> 50%GLB%");
        assert!(page.contains("default-src 'none'"));
        for outside in ["http://", "https://", "src=", "href=", "import ", "fetch("] {
            assert!(!page.contains(outside), "{outside}");
        }
        assert!(!page.contains("<script>alert"));
        assert!(page.contains("50%GLB%"));
    }
}
