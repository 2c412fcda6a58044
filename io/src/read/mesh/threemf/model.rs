//! The XML of a model part: objects and build items.

use super::metered::Metered;
use crate::read::mesh::{MeshError, NO_VERTEX};
use glam::{DAffine3, DMat3, DVec3};
use quick_xml::XmlVersion;
use quick_xml::events::{BytesStart, Event};
use std::collections::BTreeMap;
use std::io::BufRead;

/// An object that is put somewhere.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub(super) object: u32,
    /// The part that it is in, if that is another one.
    pub(super) path: Option<String>,
    pub(super) transform: DAffine3,
}

/// A mesh, or components.
#[derive(Debug, Default)]
pub(super) struct Object {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) components: Vec<Reference>,
}

/// What a part says.
#[derive(Debug, Default)]
pub(super) struct Model {
    pub(super) unit: String,
    pub(super) objects: BTreeMap<u32, Object>,
    pub(super) items: Vec<Reference>,
}

/// Reads a part; `room` is how many vertices and triangles may still be kept.
pub(super) fn parse(
    source: Metered<impl BufRead>,
    part: &str,
    room: &mut usize,
) -> Result<Model, MeshError> {
    let mut xml = quick_xml::Reader::from_reader(source);
    let mut buffer = Vec::new();
    let mut model = Model {
        unit: "millimeter".to_owned(),
        ..Model::default()
    };
    let mut current: Option<(u32, Object)> = None;
    let mut depth = 0_usize;
    let mut is_model = false;
    loop {
        buffer.clear();
        xml.get_mut().begin_event();
        let at = xml.buffer_position();
        let wrong = |message: String| MeshError::damaged(format!("{part}, byte {at}"), message);
        let event = xml
            .read_event_into(&mut buffer)
            .map_err(|error| match error {
                quick_xml::Error::Io(error) if error.kind() == std::io::ErrorKind::FileTooLarge => {
                    MeshError {
                        is_limit: true,
                        remedy: "allow more with --memory if the file is to be trusted",
                        ..wrong(error.to_string())
                    }
                }
                error => wrong(error.to_string()),
            })?;
        let (element, is_empty) = match event {
            Event::Start(element) => (element, false),
            Event::Empty(element) => (element, true),
            Event::End(element) => {
                depth = depth.saturating_sub(1);
                if element.local_name().as_ref() == "object"
                    && let Some((id, object)) = current.take()
                {
                    model.objects.insert(id, object);
                }
                continue;
            }
            Event::DocType(_) => {
                let message = "a document type declaration, which 3MF does not allow".to_owned();
                let remedy = "remove it: it may define entities that unfold without end";
                return Err(MeshError {
                    remedy,
                    ..wrong(message)
                });
            }
            Event::Eof if !is_model => {
                let message = "there is no element `model`".to_owned();
                return Err(wrong(message));
            }
            Event::Eof if depth > 0 => return Err(wrong("the text is cut off".to_owned())),
            Event::Eof => return Ok(model),
            _ => continue,
        };
        let attributes = Attributes(&element);
        match element.local_name().as_ref() {
            "model" => {
                is_model = true;
                if let Some(unit) = attributes.text("unit").map_err(wrong)? {
                    model.unit = unit.chars().take(20).collect();
                }
            }
            "object" => {
                let id = attributes.number("id").map_err(wrong)?;
                if model.objects.contains_key(&id) {
                    return Err(wrong(format!("object {id} occurs twice")));
                }
                if is_empty {
                    model.objects.insert(id, Object::default());
                } else {
                    current = Some((id, Object::default()));
                }
            }
            "vertex" => {
                if let Some((_, object)) = &mut current {
                    *room = room.checked_sub(1).ok_or_else(MeshError::too_large)?;
                    object.positions.push(attributes.position().map_err(wrong)?);
                }
            }
            "triangle" => {
                if let Some((_, object)) = &mut current {
                    *room = room.checked_sub(1).ok_or_else(MeshError::too_large)?;
                    object.triangles.push(attributes.corners().map_err(wrong)?);
                }
            }
            "component" => {
                if let Some((_, object)) = &mut current {
                    object
                        .components
                        .push(attributes.reference().map_err(wrong)?);
                }
            }
            "item" => model.items.push(attributes.reference().map_err(wrong)?),
            _ => {}
        }
        depth += usize::from(!is_empty);
    }
}

/// The target of the first relationship of a type.
pub(super) fn relation(text: &str, kind: &str) -> Result<Option<String>, String> {
    let mut xml = quick_xml::Reader::from_str(text);
    loop {
        match xml.read_event().map_err(|error| error.to_string())? {
            Event::Start(element) | Event::Empty(element) => {
                let attributes = Attributes(&element);
                if attributes.text("Type")?.as_deref() == Some(kind) {
                    return attributes.text("Target");
                }
            }
            Event::DocType(_) => {
                return Err("a document type declaration is not allowed".to_owned());
            }
            Event::Eof => return Ok(None),
            _ => {}
        }
    }
}

/// The attributes of an element; namespaces are not told apart.
struct Attributes<'a>(&'a BytesStart<'a>);

impl Attributes<'_> {
    fn text(&self, name: &str) -> Result<Option<String>, String> {
        for attribute in self.0.attributes() {
            let attribute = attribute.map_err(|error| error.to_string())?;
            if attribute.key.local_name().as_ref() == name {
                // Entities of the file's own are not known, and an error.
                let value = attribute.normalized_value(XmlVersion::Explicit1_0);
                return value
                    .map(|value| Some(value.into_owned()))
                    .map_err(|error| error.to_string());
            }
        }
        Ok(None)
    }

    fn parsed<T: std::str::FromStr>(&self, name: &str) -> Result<T, String> {
        let text = self.text(name)?;
        let text = text.ok_or_else(|| format!("the attribute `{name}` is missing"))?;
        let parsed = text.trim().parse();
        parsed.map_err(|_| {
            let short = crate::read::mesh::obj::shortened(&text);
            format!("`{short}` is not what `{name}` may be")
        })
    }

    fn number(&self, name: &str) -> Result<u32, String> {
        self.parsed(name)
    }

    fn position(&self) -> Result<DVec3, String> {
        Ok(DVec3::new(
            self.parsed("x")?,
            self.parsed("y")?,
            self.parsed("z")?,
        ))
    }

    /// Numbers below 0 or beyond 32 bits are vertices that do not exist.
    fn corners(&self) -> Result<[u32; 3], String> {
        let corner = |name| -> Result<u32, String> {
            let number: i64 = self.parsed(name)?;
            Ok(u32::try_from(number).unwrap_or(NO_VERTEX))
        };
        Ok([corner("v1")?, corner("v2")?, corner("v3")?])
    }

    /// `objectid`, `transform` of twelve numbers for row vectors, `path` of another part.
    fn reference(&self) -> Result<Reference, String> {
        let transform = match self.text("transform")? {
            None => DAffine3::IDENTITY,
            Some(text) => {
                let numbers: Result<Vec<f64>, _> =
                    text.split_whitespace().map(str::parse).collect();
                let numbers = numbers
                    .ok()
                    .and_then(|list| <[f64; 12]>::try_from(list).ok());
                let m = numbers.ok_or("`transform` must have twelve numbers")?;
                let [a, b, c, d, e, f, g, h, i, x, y, z] = m;
                let rows = [[a, b, c], [d, e, f], [g, h, i]];
                DAffine3::from_mat3_translation(
                    DMat3::from_cols_array_2d(&rows),
                    DVec3::new(x, y, z),
                )
            }
        };
        let path = self.text("path")?;
        Ok(Reference {
            object: self.number("objectid")?,
            path: path.map(|path| path.trim_start_matches('/').to_owned()),
            transform,
        })
    }
}
