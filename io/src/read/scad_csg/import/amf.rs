//! AMF: XML with the vertices and triangles of objects.

use super::Polygons;
use glam::DVec3;
use quick_xml::Reader;
use quick_xml::events::Event;

/// Reads the text of an AMF file: all triangles of all objects, in the file's own unit.
pub(super) fn read(bytes: &[u8]) -> Result<Polygons, String> {
    if bytes.starts_with(b"PK") {
        return Err("the file is compressed: unpack it first".to_owned());
    }
    let mut reader = Reader::from_reader(bytes);
    let mut buffer = Vec::new();
    let mut polygons = Vec::new();
    let mut vertices: Vec<DVec3> = Vec::new();
    let mut text = String::new();
    let mut numbers = [None; 3];
    loop {
        let place = reader.buffer_position();
        let wrong = |what: &str| format!("byte {place}: {what}");
        let event = reader.read_event_into(&mut buffer);
        match event.map_err(|error| wrong(&error.to_string()))? {
            Event::Eof => break,
            Event::Start(tag) => {
                text.clear();
                match tag.local_name().as_ref() {
                    "object" => vertices.clear(),
                    "coordinates" | "triangle" => numbers = [None; 3],
                    _ => {}
                }
            }
            Event::Text(part) => text.push_str(&part),
            Event::End(tag) => match tag.local_name().as_ref() {
                "x" | "v1" => numbers[0] = text.trim().parse::<f64>().ok(),
                "y" | "v2" => numbers[1] = text.trim().parse::<f64>().ok(),
                "z" | "v3" => numbers[2] = text.trim().parse::<f64>().ok(),
                "coordinates" => match numbers {
                    [Some(x), Some(y), Some(z)] if [x, y, z].iter().all(|c| c.is_finite()) => {
                        vertices.push(DVec3::new(x, y, z));
                    }
                    _ => return Err(wrong("a vertex needs numbers x, y and z")),
                },
                "triangle" => {
                    let corner = |number: Option<f64>| {
                        let number =
                            number.filter(|n| n.fract() == 0.0 && *n >= 0.0 && *n < 4e9)?;
                        #[expect(
                            clippy::cast_possible_truncation,
                            clippy::cast_sign_loss,
                            reason = "a whole number within the range, as just checked"
                        )]
                        let at = number as usize;
                        vertices.get(at).copied()
                    };
                    let corners: Option<Vec<DVec3>> = numbers.map(corner).into_iter().collect();
                    let corners = corners.ok_or_else(|| {
                        wrong("a triangle needs v1, v2 and v3, numbers of vertices before it")
                    })?;
                    polygons.push(corners);
                }
                _ => {}
            },
            _ => {}
        }
        buffer.clear();
    }
    if polygons.is_empty() {
        return Err("there are no triangles".to_owned());
    }
    Ok(polygons)
}
