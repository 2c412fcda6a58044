//! Binary PLY, little endian: 64-bit positions, shared vertices, a colour for each triangle.
//!
//! Source: Greg Turk, *The PLY Polygon File Format*, 1994.

use super::{Error, GENERATOR, Unit, appearance};
use brep::{Brep, Valid};
use csg::Material;
use glam::DVec3;
use std::io::Write;

/// What to write.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// What a model unit is, for a comment: the format has no unit.
    pub unit: Option<Unit>,
}

/// Writes the boundary. Every bit of the positions survives; vertices at one place stay apart,
/// because triangles name them by index.
///
/// # Errors
/// [`Error::Io`].
pub fn write(
    brep: &Valid<Brep>,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    let (vertices, facets) = (brep.vertex_count(), brep.facet_count());
    let unit = options.unit.map_or("not said", Unit::name);
    write!(
        out,
        "ply\nformat binary_little_endian 1.0\n\
         comment {GENERATOR}\ncomment unit: {unit}\n\
         element vertex {vertices}\n\
         property double x\nproperty double y\nproperty double z\n\
         element face {facets}\n\
         property list uchar uint vertex_indices\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\n\
         property uchar alpha\nend_header\n"
    )?;
    for vertex in brep.vertices() {
        // Adding zero turns −0 into 0.
        for number in (vertex.position() + DVec3::ZERO).to_array() {
            out.write_all(&number.to_le_bytes())?;
        }
    }
    let numbers = brep.number_vertices();
    for facet in brep.facets() {
        let mut record = [3; 17];
        let corners = facet.vertices().map(|vertex| numbers[vertex.key()]);
        for (field, corner) in record[1..13].chunks_exact_mut(4).zip(corners) {
            field.copy_from_slice(&corner.to_le_bytes());
        }
        record[13..].copy_from_slice(&appearance::bytes(materials, facet.material()));
        out.write_all(&record)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::samples::{cube, painted, together};
    use super::*;
    use subdiv::Fragments;

    fn written(fragments: &Fragments, materials: &[Material]) -> Vec<u8> {
        let brep = brep::stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let mut bytes = Vec::new();
        write(&brep, materials, &Options::default(), &mut bytes).expect("memory");
        bytes
    }

    fn body(bytes: &[u8]) -> &[u8] {
        let end = b"end_header\n";
        let at = bytes.windows(end.len()).position(|window| window == end);
        &bytes[at.expect("a header") + end.len()..]
    }

    #[test]
    fn bytes_follow_the_format() {
        let red = Material {
            color: Some([1.0, 0.0, 0.0, 0.5]),
        };
        let fragments = painted(cube([0.0; 3], 1.0), 0, 0);
        let bytes = written(&fragments, &[red]);
        let body = body(&bytes);
        assert_eq!(body.len(), 8 * 24 + 12 * 17);
        for (read, position) in body.chunks_exact(24).zip(&fragments.positions) {
            let expected: Vec<u8> = position
                .to_array()
                .iter()
                .flat_map(|number| number.to_le_bytes())
                .collect();
            assert_eq!(read, expected);
        }
        for (read, triangle) in body[192..].chunks_exact(17).zip(&fragments.triangles) {
            assert_eq!(read[0], 3);
            let indices = triangle.vertices.map(u32::to_le_bytes).concat();
            assert_eq!(read[1..13], indices);
            assert_eq!(read[13..], [255, 0, 0, 128]);
        }
    }

    #[test]
    fn vertices_at_one_place_stay_apart() {
        let bytes = written(&together(&[cube([0.0; 3], 1.0), cube([2.0; 3], 1.0)]), &[]);
        assert_eq!(body(&bytes).len(), 16 * 24 + 24 * 17);
    }

    #[test]
    fn the_empty_solid_is_a_header() {
        assert!(body(&written(&Fragments::default(), &[])).is_empty());
    }
}
