//! PLY, text and binary: elements `vertex` (x, y, z) and `face` (a list of vertex numbers).
//!
//! Headers and binary data are read by a crate. Lines of text are read here, as the crate's
//! grammar refuses numbers such as `.5`, `1.` and `nan`.

use super::error::DAMAGED;
use super::obj::shortened;
use super::{Limits, Mesh, MeshError, MeshFormat, NO_VERTEX};
use glam::DVec3;
use ply_rs_bw::parser::{Parser, Reader};
use ply_rs_bw::ply::{
    DefaultElement, ElementDef, Encoding, Header, Property, PropertyAccess, PropertyAccessResult,
    PropertyType, ScalarType,
};

const AXES: [&str; 3] = ["x", "y", "z"];
/// Both names are in use.
const LISTS: [&str; 2] = ["vertex_indices", "vertex_index"];

pub(super) fn read(bytes: &[u8], limits: Limits) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::new(MeshFormat::Ply, "face", limits);
    let mut reader = Reader::new(bytes);
    let header = Parser::<DefaultElement>::new().read_header(&mut reader);
    let header = header.map_err(|error| wrong(&error, "is this a PLY file?"))?;
    for (name, element) in &header.elements {
        check(element, &header, reader.get_ref().len())?;
        match (name.as_str(), header.encoding) {
            ("vertex", Encoding::Ascii) => {
                let axes = axes(element)?;
                lines(&mut reader, element, |words, number| {
                    let position = axes.map(|at| scalar(element, words, at));
                    match position {
                        [Some(x), Some(y), Some(z)] => mesh.vertex(DVec3::new(x, y, z)),
                        _ => Err(short(element, number)),
                    }
                })?;
            }
            ("vertex", _) => {
                axes(element)?;
                let parser = Parser::<Vertex>::new();
                let found = parser.read_payload_for_element(&mut reader, element, &header);
                for Vertex(position) in found.map_err(|error| wrong(&error, DAMAGED))? {
                    mesh.vertex(position)?;
                }
            }
            ("face", Encoding::Ascii) => {
                let at = list(element)?;
                let mut face = 0;
                lines(&mut reader, element, |words, number| {
                    let corners = list_words(element, words, at);
                    let corners = corners.ok_or_else(|| short(element, number))?;
                    let corners: Vec<u32> = corners.iter().map(|word| vertex(word)).collect();
                    mesh.polygon(&corners, face)?;
                    face += 1;
                    Ok(())
                })?;
            }
            ("face", _) => {
                list(element)?;
                let parser = Parser::<Face>::new();
                let found = parser.read_payload_for_element(&mut reader, element, &header);
                let found = found.map_err(|error| wrong(&error, DAMAGED))?;
                for (number, Face(corners)) in (0..).zip(found) {
                    mesh.polygon(&corners, number)?;
                }
            }
            ("tristrips", _) => {
                let message = "the triangles are in strips";
                let remedy = "save the mesh with faces, not strips";
                return Err(MeshError::new("header", message, remedy));
            }
            (_, Encoding::Ascii) => lines(&mut reader, element, |_, _| Ok(()))?,
            _ => {
                let parser = Parser::<Skipped>::new();
                let found = parser.read_payload_for_element(&mut reader, element, &header);
                found.map_err(|error| wrong(&error, DAMAGED))?;
            }
        }
    }
    if !["vertex", "face"]
        .iter()
        .all(|name| header.elements.contains_key(*name))
    {
        let message = "the header has no elements `vertex` and `face`";
        let remedy = "a cloud of points is no mesh";
        return Err(MeshError::new("header", message, remedy));
    }
    // Vertices may come after the faces.
    let count = mesh.positions.len();
    for corner in mesh.triangles.as_flattened_mut() {
        if *corner as usize >= count {
            *corner = NO_VERTEX;
        }
    }
    Ok(mesh)
}

/// Counts are believed only as far as there are bytes for them.
fn check(element: &ElementDef, header: &Header, left: usize) -> Result<(), MeshError> {
    let size = |kind: &ScalarType| match kind {
        ScalarType::Char | ScalarType::UChar => 1,
        ScalarType::Short | ScalarType::UShort => 2,
        ScalarType::Int | ScalarType::UInt | ScalarType::Float => 4,
        ScalarType::Double => 8,
    };
    // A line of text has at least its end.
    let least = match header.encoding {
        Encoding::Ascii => 1,
        _ => element
            .properties
            .values()
            .map(|property| match &property.data_type {
                PropertyType::Scalar(kind) | PropertyType::List(kind, _) => size(kind),
            })
            .sum(),
    };
    let ElementDef { name, count, .. } = element;
    let name = shortened(name);
    if least == 0 && *count > 0 {
        let message = format!("the element `{name}` has no properties");
        return Err(MeshError::new("header", message, "remove it"));
    }
    if count.saturating_mul(least) > left.saturating_add(1) {
        let message =
            format!("{count} elements `{name}` are announced, but only {left} bytes are left");
        return Err(MeshError::damaged("header", message));
    }
    Ok(())
}

/// Places of x, y and z among the properties.
fn axes(element: &ElementDef) -> Result<[usize; 3], MeshError> {
    let at = |axis: &str| element.properties.keys().position(|name| name == axis);
    let [Some(x), Some(y), Some(z)] = AXES.map(at) else {
        let message = "vertices have no properties x, y and z";
        return Err(MeshError::new("header", message, "name them so"));
    };
    Ok([x, y, z])
}

/// Place of the list among the properties.
fn list(element: &ElementDef) -> Result<usize, MeshError> {
    let mut properties = element.properties.iter();
    let found = properties.position(|(name, property)| {
        LISTS.contains(&name.as_str()) && matches!(property.data_type, PropertyType::List(..))
    });
    found.ok_or_else(|| {
        let message = "faces have no list `vertex_indices`";
        MeshError::new("header", message, "name it so")
    })
}

/// Hands the words of each line of an element to `take`, with the line's number.
fn lines(
    reader: &mut Reader<&[u8]>,
    element: &ElementDef,
    mut take: impl FnMut(&[&str], usize) -> Result<(), MeshError>,
) -> Result<(), MeshError> {
    let first = reader.line();
    for at in 0..element.count {
        let number = first + at;
        let rest = *reader.get_ref();
        if rest.is_empty() {
            let ElementDef { name, count, .. } = element;
            let message = format!("the text ends after {at} of {count} elements `{name}`");
            return Err(MeshError::damaged(format!("line {number}"), message));
        }
        let end = rest.iter().position(|byte| *byte == b'\n');
        let (line, rest) = rest.split_at(end.map_or(rest.len(), |end| end + 1));
        *reader.get_mut() = rest;
        let line = String::from_utf8_lossy(line);
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        take(&words, number)?;
    }
    Ok(())
}

/// The words of the property of index `at`: one, or those of a list without their count.
fn list_words<'a>(element: &ElementDef, words: &'a [&'a str], at: usize) -> Option<&'a [&'a str]> {
    let mut words = words;
    for (k, property) in element.properties.values().enumerate() {
        let length = match property.data_type {
            PropertyType::Scalar(_) => 1,
            PropertyType::List(..) => {
                let (count, rest) = words.split_first()?;
                words = rest;
                count.parse().ok()?
            }
        };
        let (these, rest) = words.split_at_checked(length)?;
        if k == at {
            return Some(these);
        }
        words = rest;
    }
    None
}

fn scalar(element: &ElementDef, words: &[&str], at: usize) -> Option<f64> {
    list_words(element, words, at)?.first()?.parse().ok()
}

fn vertex(word: &str) -> u32 {
    word.parse().unwrap_or(NO_VERTEX)
}

fn short(element: &ElementDef, line: usize) -> MeshError {
    let message = format!("this is no element `{}`", shortened(&element.name));
    MeshError::at_line(line, message, "its numbers must be those of the header")
}

fn wrong(error: &ply_rs_bw::parser::ParseError, remedy: &'static str) -> MeshError {
    // The crate's messages may quote a whole line.
    let text = error.to_string();
    let text = text.lines().next().unwrap_or_default();
    let text: String = text.chars().take(200).collect();
    MeshError::new("", text.trim_end_matches(['.', ':']), remedy)
}

/// A vertex of binary data.
struct Vertex(DVec3);

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self(DVec3::NAN)
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        let Some(axis) = AXES.iter().position(|axis| *axis == name) else {
            return PropertyAccessResult::Ignored;
        };
        let value = match property {
            Property::Char(value) => value.into(),
            Property::UChar(value) => value.into(),
            Property::Short(value) => value.into(),
            Property::UShort(value) => value.into(),
            Property::Int(value) => value.into(),
            Property::UInt(value) => value.into(),
            Property::Float(value) => value.into(),
            Property::Double(value) => value,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        match axis {
            0 => self.0.x = value,
            1 => self.0.y = value,
            _ => self.0.z = value,
        }
        PropertyAccessResult::Set
    }
}

/// Vertex numbers of any kind.
fn all<T: TryInto<u32>>(list: Vec<T>) -> Vec<u32> {
    let number = |item: T| item.try_into().unwrap_or(NO_VERTEX);
    list.into_iter().map(number).collect()
}

/// A face of binary data.
struct Face(Vec<u32>);

impl PropertyAccess for Face {
    fn new() -> Self {
        Self(Vec::new())
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if !LISTS.contains(&name) {
            return PropertyAccessResult::Ignored;
        }
        self.0 = match property {
            Property::ListChar(list) => all(list),
            Property::ListUChar(list) => all(list),
            Property::ListShort(list) => all(list),
            Property::ListUShort(list) => all(list),
            Property::ListInt(list) => all(list),
            Property::ListUInt(list) => list,
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is of no interest.
struct Skipped;

impl PropertyAccess for Skipped {
    fn new() -> Self {
        Self
    }
}
