//! Which format a file is in: by its content first, then by its name's extension.

use std::path::Path;

/// A format that can be read.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Format {
    /// OpenSCAD's flat dump, see [`scad_csg`](super::scad_csg).
    ScadCsg,
    /// The thesis' Boolean tree of instances, see [`thesis::solid`](crate::thesis::solid).
    ThesisCsg,
    /// The thesis' Bézier forms, see [`thesis::sectors`](crate::thesis::sectors).
    ThesisCspg,
    /// The thesis' triangles, see [`thesis::approximation`](crate::thesis::approximation).
    ThesisApl,
    /// The mesh of the thesis' renderer, see [`thesis::wireframe`](crate::thesis::wireframe).
    ThesisWfr,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::ScadCsg,
        Self::ThesisCsg,
        Self::ThesisCspg,
        Self::ThesisApl,
        Self::ThesisWfr,
    ];

    /// The name by which users ask for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::ScadCsg => "csg",
            Self::ThesisCsg => "thesis-csg",
            Self::ThesisCspg => "cspg",
            Self::ThesisApl => "apl",
            Self::ThesisWfr => "wfr",
        }
    }

    /// What it is.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::ScadCsg => "flat CSG dump of OpenSCAD",
            Self::ThesisCsg => "the thesis' binary Boolean tree, .CSG",
            Self::ThesisCspg => "the thesis' half-spaces in Bézier form",
            Self::ThesisApl => "the thesis' linear approximation of a boundary",
            Self::ThesisWfr => "the mesh of the thesis' renderer",
        }
    }
}

/// A file that cannot be read.
#[derive(Clone, PartialEq, Eq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UnreadableFormat {
    /// Something well known that is no constructive model, or not yet one for us.
    #[error("this is {what}, not a CSG model ({advice})")]
    Foreign {
        /// What the file is.
        what: &'static str,
        /// What to do about it.
        advice: &'static str,
    },
    /// Nothing known.
    #[error(
        "unknown file format (known: csg, the flat dump of OpenSCAD; thesis-csg and apl, binary files of \
         the thesis; choose one with --from csg)"
    )]
    Unknown,
}

const MESH: &str = "a mesh has lost its set operations: start from the CSG model it was made of";
const LATER: &str = "reading it is not supported yet";
const UNPACK: &str = "unpack it first";
const SUBDIVISION: &str = "csg2brep thesis propsimpl -V tells its volume; for a boundary write triangles instead, \
                           as in csg2brep thesis subsimpl -O a, or start from the .cspg or .CSG file";

/// What begins with what, in bytes.
const SIGNATURES: [(&[u8], &str, &str); 9] = [
    (b"glTF", "a binary glTF mesh", MESH),
    (
        b"ISO-10303-21",
        "a STEP file",
        "its surfaces are a boundary already",
    ),
    (b"ply\n", "a PLY mesh", MESH),
    (b"PK\x03\x04", "a zip archive or 3MF mesh", MESH),
    (b"\x1f\x8b", "a gzip archive", UNPACK),
    (b"\x89PNG", "a PNG picture", "open a model instead"),
    (b"%PDF", "a PDF document", "open a model instead"),
    (b"title {", "a BRL-CAD database in text form", LATER),
    (b"<?xml", "an XML file", LATER),
];

/// The format of a file.
///
/// `bytes`: its whole content, or at least the first few hundred bytes. `name`: its name, whose
/// extension decides where the content does not.
///
/// # Errors
/// What else the file is, if that can be told.
pub fn sniff(bytes: &[u8], name: &str) -> Result<Format, UnreadableFormat> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    for (signature, what, advice) in SIGNATURES {
        if bytes.starts_with(signature) {
            return Err(UnreadableFormat::Foreign { what, advice });
        }
    }
    let extension = Path::new(name)
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let extension = extension.as_deref().unwrap_or_default();
    let foreign = |what, advice| Err(UnreadableFormat::Foreign { what, advice });
    let start = bytes.trim_ascii_start();
    if start.starts_with(b"solid ") && !start.contains(&b'{') || extension == "stl" {
        return foreign("an STL mesh", MESH);
    }
    if extension == "obj" {
        return foreign("an OBJ mesh", MESH);
    }
    match extension {
        "apl" => return Ok(Format::ThesisApl),
        "cspg" => return Ok(Format::ThesisCspg),
        "wfr" => return Ok(Format::ThesisWfr),
        _ => {}
    }
    // The letter and a count of sectors, whose first or last byte is zero.
    if let [b'S', 0, ..] | [b'S', _, _, _, 0, ..] = bytes {
        return foreign("a subdivision tree of the thesis", SUBDIVISION);
    }
    // The Boolean of its first node; no text begins so.
    if let [0 | 1, ..] = bytes {
        return Ok(Format::ThesisCsg);
    }
    if bytes.len() % 76 == 1 && bytes.starts_with(b"A") && bytes.contains(&0) {
        return Ok(Format::ThesisApl);
    }
    if looks_like_calls(start) || matches!(extension, "csg" | "scad") {
        return Ok(Format::ScadCsg);
    }
    Err(UnreadableFormat::Unknown)
}

/// Whether text begins as a dump or a program does: with a comment, a modifier, `name(`, `name =`
/// or a statement of programs. Reading a program then tells what to do about it.
fn looks_like_calls(start: &[u8]) -> bool {
    let marked = start.iter().take_while(|b| b"%#!*".contains(b)).count();
    let start = start.get(marked..).unwrap_or_default().trim_ascii_start();
    if start.starts_with(b"//") || start.starts_with(b"/*") {
        return true;
    }
    let is_name = |b: &u8| b.is_ascii_alphanumeric() || b"_$".contains(b);
    let length = start.iter().take_while(|b| is_name(b)).count();
    let (name, rest) = start.split_at(length);
    let is_statement = matches!(name, b"module" | b"function" | b"use" | b"include");
    let rest = rest.trim_ascii_start();
    is_statement || (!name.is_empty() && (rest.starts_with(b"(") || rest.starts_with(b"=")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_decides_before_the_name() {
        assert_eq!(sniff(b"\n group() {\n", "-"), Ok(Format::ScadCsg));
        assert_eq!(sniff(b"%cube();", "x.txt"), Ok(Format::ScadCsg));
        assert_eq!(sniff(b"use <gears.scad>", "-"), Ok(Format::ScadCsg));
        assert_eq!(sniff(b"$fn = 30;", "-"), Ok(Format::ScadCsg));
        assert_eq!(sniff(b"\xEF\xBB\xBF// FreeCAD", ""), Ok(Format::ScadCsg));
        let glb = sniff(b"glTF\x02\0\0\0", "model.csg").unwrap_err();
        assert!(glb.to_string().starts_with("this is a binary glTF mesh"));
    }

    #[test]
    fn the_name_decides_where_the_content_does_not() {
        assert_eq!(sniff(b"", "empty.CSG"), Ok(Format::ScadCsg));
        assert_eq!(sniff(b"w = 3;", "a.scad"), Ok(Format::ScadCsg));
        assert!(sniff(b"v 0 0 0\n", "a.obj").is_err());
        assert_eq!(sniff(b"", "empty"), Err(UnreadableFormat::Unknown));
        assert_eq!(
            sniff(b"hello world", "a.txt"),
            Err(UnreadableFormat::Unknown)
        );
    }

    #[test]
    fn the_thesis_binary_trees_share_an_extension_with_text() {
        assert_eq!(
            sniff(b"\x01\0\0\0\0\0\0\0\x01", "a.CSG"),
            Ok(Format::ThesisCsg)
        );
        assert_eq!(sniff(b"\0\x02\x01", "-"), Ok(Format::ThesisCsg));
        assert_eq!(sniff(b"cube(1);", "a.CSG"), Ok(Format::ScadCsg));
        let one_face = [b"A".as_slice(), &[0; 76]].concat();
        assert_eq!(sniff(&one_face, "-"), Ok(Format::ThesisApl));
        assert_eq!(sniff(b"A", "a.apl"), Ok(Format::ThesisApl));
    }

    #[test]
    fn subdivision_trees_are_told_apart_in_both_byte_orders() {
        for bytes in [b"S\0\0\0\x06@\0", b"S\x06\0\0\0\0@"] {
            let tree = sniff(bytes, "a.csg").unwrap_err().to_string();
            assert!(tree.contains("a subdivision tree") && tree.contains("propsimpl -V"));
        }
        assert_eq!(sniff(b"S = 3;", "a.csg"), Ok(Format::ScadCsg));
    }

    #[test]
    fn meshes_are_told_apart() {
        assert!(sniff(b"solid part\n facet normal 0 0 1", "a").is_err());
        assert!(sniff(b"PK\x03\x04....", "a.3mf").is_err());
    }
}
