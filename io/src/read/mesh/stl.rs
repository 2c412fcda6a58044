//! STL, text and binary.
//!
//! Read here and not by a crate, to know the line or byte of each triangle and to read decimals
//! with all their digits.

use super::obj::shortened;
use super::{Joining, Limits, Mesh, MeshError, MeshFormat, Part};
use glam::{DVec3, Vec3};

const HEADER: usize = 84;
const RECORD: usize = 50;
const FACET: &str =
    "a facet is `facet normal … outer loop vertex X Y Z` (three times) `endloop endfacet`";

/// Whether the content is STL: of binary form the length tells, of text the first words.
pub(super) fn is_stl(bytes: &[u8]) -> bool {
    (stated(bytes).is_some_and(|length| length == bytes.len()) && bytes.len() > HEADER)
        || is_text(bytes)
}

/// `solid` at the start, and a facet or the end in the first lines; some binary files begin with
/// `solid` too.
fn is_text(bytes: &[u8]) -> bool {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let start = bytes.trim_ascii_start();
    let start = start.get(..start.len().min(1000)).unwrap_or(start);
    let text = String::from_utf8_lossy(start).to_ascii_lowercase();
    text.starts_with("solid") && (text.contains("facet") || text.contains("endsolid"))
}

/// The length that a binary file must have by its count.
fn stated(bytes: &[u8]) -> Option<usize> {
    let count = bytes.get(80..HEADER)?.try_into().ok()?;
    let count = u32::from_le_bytes(count) as usize;
    count.checked_mul(RECORD)?.checked_add(HEADER)
}

pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Mesh, MeshError> {
    let mesh = Mesh::new(MeshFormat::Stl, "triangle", limits);
    let mut mesh = if stated(bytes) != Some(bytes.len()) && is_text(bytes) {
        text(bytes, mesh)?
    } else {
        binary(bytes, mesh)?
    };
    mesh.joining = Joining::Positions;
    Ok(mesh)
}

fn binary(bytes: &[u8], mut mesh: Mesh) -> Result<Mesh, MeshError> {
    let Some(stated) = stated(bytes) else {
        let message = format!(
            "the file has {} bytes, and neither `solid` at its start nor the 84 bytes of a binary header",
            bytes.len()
        );
        return Err(MeshError::damaged("", message));
    };
    if bytes.len() < stated {
        let message = format!(
            "the header announces {} triangles, which take {stated} bytes, but the file has {}",
            (stated - HEADER) / RECORD,
            bytes.len()
        );
        return Err(MeshError::damaged("byte 80", message));
    }
    if bytes.len() > stated {
        let more = bytes.len() - stated;
        mesh.notes
            .push(format!("{more} bytes after the last triangle are not read"));
    }
    let records = bytes.get(HEADER..stated).unwrap_or_default();
    for (at, record) in (0_u32..).zip(records.chunks_exact(RECORD)) {
        let corners = record.get(12..48).unwrap_or_default();
        let first = mesh.next_vertex();
        for corner in corners.chunks_exact(12) {
            // Records are not aligned to their numbers.
            let corner: [f32; 3] = bytemuck::pod_read_unaligned(corner);
            let little_endian = corner.map(|x| f32::from_bits(u32::from_le(x.to_bits())));
            mesh.vertex(Vec3::from(little_endian).as_dvec3())?;
        }
        mesh.triangle([first, first + 1, first + 2], at)?;
    }
    Ok(mesh)
}

fn text(bytes: &[u8], mut mesh: Mesh) -> Result<Mesh, MeshError> {
    mesh.counted = "line";
    let mut facet = 0;
    let mut corners = 0;
    let mut is_solid_open = false;
    let mut last = 0;
    for (number, line) in (1_usize..).zip(bytes.split(|byte| *byte == b'\n')) {
        last = number;
        let line = String::from_utf8_lossy(line);
        let line = line.strip_prefix('\u{feff}').unwrap_or(&line);
        let wrong = |message: String| Err(MeshError::at_line(number, message, FACET));
        let mut words = line.split_ascii_whitespace();
        while let Some(word) = words.next() {
            match word.to_ascii_lowercase().as_str() {
                "solid" => {
                    let name = words.by_ref().collect::<Vec<_>>().join(" ");
                    let label = if name.is_empty() || mesh.parts.is_empty() {
                        String::new()
                    } else {
                        format!("solid {}", shortened(&name))
                    };
                    mesh.parts.push(Part {
                        label,
                        first_triangle: mesh.triangles.len(),
                    });
                    is_solid_open = true;
                }
                // The rest is the name.
                "endsolid" => {
                    words.by_ref().for_each(drop);
                    is_solid_open = false;
                }
                "facet" if corners == 0 => {
                    facet = number;
                    if words
                        .next()
                        .is_some_and(|word| word.eq_ignore_ascii_case("normal"))
                    {
                        words.by_ref().take(3).for_each(drop);
                    }
                }
                "outer" | "loop" | "endloop" => {}
                "vertex" if corners < 3 => {
                    let mut position = DVec3::ZERO.to_array();
                    for coordinate in &mut position {
                        let word = words.next().unwrap_or_default();
                        let Ok(found) = word.parse() else {
                            let found = shortened(word);
                            return wrong(format!("`{found}` is no coordinate"));
                        };
                        *coordinate = found;
                    }
                    mesh.vertex(DVec3::from(position))?;
                    corners += 1;
                }
                "endfacet" if corners == 3 => {
                    corners = 0;
                    let first = mesh.next_vertex() - 3;
                    let line = u32::try_from(facet).unwrap_or(u32::MAX);
                    mesh.triangle([first, first + 1, first + 2], line)?;
                }
                "facet" | "endfacet" | "vertex" => {
                    return wrong(format!("`{word}` after {corners} vertices of a facet"));
                }
                _ => return wrong(format!("`{}` is not known", shortened(word))),
            }
        }
    }
    if is_solid_open || corners > 0 {
        let message = "the text ends without `endsolid`";
        return Err(MeshError::damaged(format!("line {last}"), message));
    }
    Ok(mesh)
}
