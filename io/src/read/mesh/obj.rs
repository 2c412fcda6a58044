//! Wavefront OBJ: `v` and `f` lines.
//!
//! Read here and not by a crate, as the crates that read OBJ number the vertices of each group
//! anew, which tears the faces of one surface apart, and do not keep lines.

use super::{Limits, Mesh, MeshError, MeshFormat, NO_VERTEX};
use glam::DVec3;
use std::borrow::Cow;

const VERTEX: &str = "a vertex is `v X Y Z`, with decimal numbers";
const FACE: &str = "a face is `f A B C …`, with numbers of vertices counted from 1";

/// Whether a file without a telling name may be OBJ: its first statement is one of OBJ's.
pub(super) fn looks_like_obj(text: &[u8]) -> bool {
    let lines = text.split(|byte| *byte == b'\n').take(200);
    let mut words =
        lines.filter_map(|line| line.split(u8::is_ascii_whitespace).find(|w| !w.is_empty()));
    let first = words.find(|word| !word.starts_with(b"#"));
    first.is_some_and(|word| matches!(word, b"v" | b"vn" | b"vt" | b"mtllib" | b"usemtl" | b"o"))
}

pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::new(MeshFormat::Obj, "line", limits);
    let mut corners = Vec::new();
    let mut polygons = 0_usize;
    let mut lines = (1_usize..).zip(bytes.split(|byte| *byte == b'\n'));
    while let Some((number, line)) = lines.next() {
        // Names may be in any encoding, numbers are ASCII.
        let mut line = String::from_utf8_lossy(line);
        while let Some(begun) = line.trim_end().strip_suffix('\\') {
            let Some((_, more)) = lines.next() else { break };
            line = Cow::Owned(format!("{begun} {}", String::from_utf8_lossy(more)));
        }
        let line = line.strip_prefix('\u{feff}').unwrap_or(&line);
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let position = position(&mut words);
                let position =
                    position.map_err(|found| MeshError::at_line(number, found, VERTEX))?;
                mesh.vertex(position)?;
            }
            Some("f") => {
                corners.clear();
                for word in words.take_while(|word| !word.starts_with('#')) {
                    let corner = corner(word, mesh.positions.len());
                    corners.push(corner.map_err(|found| MeshError::at_line(number, found, FACE))?);
                }
                polygons += usize::from(corners.len() > 3);
                // Lines are at most as many as bytes, elements below 2³².
                mesh.polygon(&corners, u32::try_from(number).unwrap_or(u32::MAX))?;
            }
            _ => {}
        }
    }
    if mesh.positions.is_empty() && mesh.triangles.is_empty() && !bytes.is_empty() {
        let message = "there is neither a `v` nor an `f` line";
        return Err(MeshError::new("", message, "is this an OBJ file?"));
    }
    if polygons > 0 {
        let text = format!("{polygons} faces have more than three corners and are cut into fans");
        mesh.notes.push(text);
    }
    Ok(mesh)
}

/// Three numbers, whatever comes after them; `nan` and `inf` are numbers here.
fn position<'a>(words: &mut impl Iterator<Item = &'a str>) -> Result<DVec3, String> {
    let mut position = DVec3::ZERO;
    for axis in 0..3 {
        let word = words
            .next()
            .ok_or_else(|| format!("{axis} coordinates, expected 3"))?;
        let number = word.parse::<f64>();
        let number = number.map_err(|_| format!("`{}` is no number", shortened(word)))?;
        match axis {
            0 => position.x = number,
            1 => position.y = number,
            _ => position.z = number,
        }
    }
    Ok(position)
}

/// The vertex of `V`, `V/T`, `V//N` or `V/T/N`, where negative numbers count back from the last one.
fn corner(word: &str, vertices: usize) -> Result<u32, String> {
    let vertex = word.split('/').next().unwrap_or_default();
    let number: i64 = vertex
        .parse()
        .map_err(|_| format!("`{}` is no vertex number", shortened(word)))?;
    let index = match number {
        1.. => number - 1,
        0 => -1,
        _ => i64::try_from(vertices).unwrap_or(i64::MAX) + number,
    };
    // A vertex may be defined further down, so the end is not checked here.
    Ok(u32::try_from(index).unwrap_or(NO_VERTEX))
}

/// Enough of a word to recognise it.
pub(super) fn shortened(word: &str) -> String {
    let mut short: String = word.chars().take(24).collect();
    if short.len() < word.len() {
        short.push('…');
    }
    short
}
