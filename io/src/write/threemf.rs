//! 3MF, core specification 1.3: one mesh object a solid, shared vertices, a base material for each
//! colour. Several solids are components of one object, so that their places stay fixed.
//!
//! The archive's time stamps are fixed, so that the same model gives the same bytes.
//! Source: 3D Manufacturing Format core specification, 3MF Consortium.

use super::decimal::Decimal;
use super::{Error, GENERATOR, Unit, appearance};
use brep::{Brep, FacetView, Shells, Valid, VertexView};
use csg::{Material, MaterialId};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesStart, Event};
use std::io::{self, BufWriter, Cursor, Write};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

const CORE: &str = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
const MODEL: &str = "3D/3dmodel.model";
const CONTENT_TYPES: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    r#"<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">"#,
    r#"<Default Extension="rels" "#,
    r#"ContentType="application/vnd.openxmlformats-package.relationships+xml"/>"#,
    r#"<Default Extension="model" "#,
    r#"ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>"#,
);
const RELATIONSHIPS: &str = concat!(
    r#"<?xml version="1.0" encoding="UTF-8"?>"#,
    r#"<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">"#,
    r#"<Relationship Id="rel0" Target="/3D/3dmodel.model" "#,
    r#"Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>"#,
);

/// Id of the first solid's object; 1 is the list of materials.
const FIRST_OBJECT: usize = 2;

/// What to write.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// What a model unit is; millimetres if nothing is said, as in the format.
    pub unit: Unit,
}

/// Writes the boundary. The archive is put together in memory, compressed.
///
/// # Errors
/// [`Error::Io`].
pub fn write(
    brep: &Valid<Brep>,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    let entry = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::default());
    let parts = [
        ("[Content_Types].xml", CONTENT_TYPES),
        ("_rels/.rels", RELATIONSHIPS),
    ];
    for (name, text) in parts {
        archive.start_file(name, entry).map_err(io::Error::from)?;
        archive.write_all(text.as_bytes())?;
    }
    // An upper bound of the text: 64-bit numbers have at most 24 characters, indices 10.
    let size = 140 * brep.vertex_count() as u64 + 100 * brep.facet_count() as u64;
    let entry = entry.large_file(size > u64::from(u32::MAX / 2));
    archive.start_file(MODEL, entry).map_err(io::Error::from)?;
    let mut text = BufWriter::new(archive);
    model(brep, materials, options.unit, &mut Writer::new(&mut text))?;
    let archive = text.into_inner().map_err(io::IntoInnerError::into_error)?;
    let bytes = archive.finish().map_err(io::Error::from)?.into_inner();
    out.write_all(&bytes)?;
    Ok(())
}

fn model(
    brep: &Valid<Brep>,
    materials: &[Material],
    unit: Unit,
    xml: &mut Writer<impl Write>,
) -> io::Result<()> {
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let attributes = [
        ("unit", unit.name()),
        ("xml:lang", "en-US"),
        ("xmlns", CORE),
    ];
    let element = xml.create_element("model").with_attributes(attributes);
    let mut built = FIRST_OBJECT;
    element.write_inner_content(|xml| {
        let application = xml.create_element("metadata");
        application
            .with_attribute(("name", "Application"))
            .write_text_content(quick_xml::events::BytesText::new(GENERATOR))?;
        if brep.is_empty() {
            // An object needs triangles, a build needs no object.
            xml.create_element("resources").write_empty()?;
            xml.create_element("build").write_empty()?;
            return Ok(());
        }
        xml.create_element("resources").write_inner_content(|xml| {
            let mut used: Vec<MaterialId> = brep.facets().map(FacetView::material).collect();
            used.sort_unstable();
            used.dedup();
            base_materials(materials, &used, xml)?;
            let parts = Part::of_solids(brep);
            // Each object counts its own vertices.
            let mut numbers = brep.number_vertices();
            for part in &parts {
                for (number, vertex) in (0..).zip(&part.vertices) {
                    numbers[vertex.key()] = number;
                }
            }
            for (number, part) in parts.iter().enumerate() {
                part.write(number, &|vertex| numbers[vertex.key()], &used, xml)?;
            }
            if parts.len() > 1 {
                assembly(parts.len(), xml)?;
            }
            built = FIRST_OBJECT + if parts.len() > 1 { parts.len() } else { 0 };
            Ok(())
        })?;
        xml.create_element("build").write_inner_content(|xml| {
            let built = built.to_string();
            let item = xml.create_element("item");
            let item = item.with_attribute(("objectid", built.as_str()));
            item.write_empty().map(drop)
        })?;
        Ok(())
    })?;
    Ok(())
}

fn base_materials(
    materials: &[Material],
    used: &[MaterialId],
    xml: &mut Writer<impl Write>,
) -> io::Result<()> {
    let list = xml.create_element("basematerials");
    list.with_attribute(("id", "1"))
        .write_inner_content(|xml| {
            for &id in used {
                let [red, green, blue, alpha] = appearance::bytes(materials, id);
                let name = format!("material_{}", id.0);
                let color = format!("#{red:02X}{green:02X}{blue:02X}{alpha:02X}");
                let attributes = [("name", name.as_str()), ("displaycolor", color.as_str())];
                xml.create_element("base")
                    .with_attributes(attributes)
                    .write_empty()?;
            }
            Ok(())
        })?;
    Ok(())
}

/// The facets of one solid, and its vertices in the mesh's order.
struct Part<'a> {
    facets: Vec<FacetView<'a>>,
    vertices: Vec<VertexView<'a>>,
}

impl<'a> Part<'a> {
    /// One for each solid, its cavities included.
    ///
    /// Cavities that lie in no solid (by rounding, almost empty) go with the first one, so that
    /// no facet is lost.
    fn of_solids(brep: &'a Valid<Brep>) -> Vec<Self> {
        let shells = Shells::of(brep);
        let mut part_of = vec![0; shells.shells.len()];
        for (at, solid) in shells.solids.iter().enumerate() {
            for shell in solid.voids.iter().chain([&solid.outer]) {
                part_of[shell.0 as usize] = at;
            }
        }
        let blank = || Self {
            facets: Vec::new(),
            vertices: Vec::new(),
        };
        let mut parts: Vec<Self> = (0..shells.solids.len().max(1)).map(|_| blank()).collect();
        let part_of = |facet: FacetView<'_>| {
            let shell = shells.shell_of.get(facet.key());
            shell.map_or(0, |shell| part_of[shell.0 as usize])
        };
        for facet in brep.facets() {
            parts[part_of(facet)].facets.push(facet);
        }
        for vertex in brep.vertices() {
            // All facets around a vertex are of one shell.
            let facet = vertex.outgoing().facet();
            parts[part_of(facet)].vertices.push(vertex);
        }
        parts
    }

    fn write(
        &self,
        number: usize,
        count: &impl Fn(VertexView<'_>) -> u32,
        used: &[MaterialId],
        xml: &mut Writer<impl Write>,
    ) -> io::Result<()> {
        let id = (FIRST_OBJECT + number).to_string();
        let name = format!("solid_{}", number + 1);
        // The object's own material, which triangles need not repeat.
        let own = self.facets.first().map(|facet| index(used, *facet));
        let own = own.unwrap_or_default();
        let own_index = own.to_string();
        let attributes = [
            ("id", id.as_str()),
            ("name", name.as_str()),
            ("type", "model"),
            ("pid", "1"),
            ("pindex", own_index.as_str()),
        ];
        let object = xml.create_element("object").with_attributes(attributes);
        object.write_inner_content(|xml| {
            xml.create_element("mesh").write_inner_content(|xml| {
                xml.create_element("vertices")
                    .write_inner_content(|xml| self.write_vertices(xml))?;
                xml.create_element("triangles")
                    .write_inner_content(|xml| self.write_triangles(own, count, used, xml))?;
                Ok(())
            })?;
            Ok(())
        })?;
        Ok(())
    }

    fn write_vertices(&self, xml: &mut Writer<impl Write>) -> io::Result<()> {
        for vertex in &self.vertices {
            let [x, y, z] = vertex
                .position()
                .to_array()
                .map(|number| Decimal(number).to_string());
            let attributes = [("x", x.as_str()), ("y", y.as_str()), ("z", z.as_str())];
            xml.write_event(Event::Empty(
                BytesStart::new("vertex").with_attributes(attributes),
            ))?;
        }
        Ok(())
    }

    fn write_triangles(
        &self,
        own: usize,
        count: &impl Fn(VertexView<'_>) -> u32,
        used: &[MaterialId],
        xml: &mut Writer<impl Write>,
    ) -> io::Result<()> {
        for &facet in &self.facets {
            let [a, b, c] = facet.vertices().map(|vertex| count(vertex).to_string());
            let attributes = [("v1", a.as_str()), ("v2", b.as_str()), ("v3", c.as_str())];
            let mut triangle = BytesStart::new("triangle").with_attributes(attributes);
            let material = index(used, facet);
            if material != own {
                triangle.push_attribute(("pid", "1"));
                triangle.push_attribute(("p1", material.to_string().as_str()));
            }
            xml.write_event(Event::Empty(triangle))?;
        }
        Ok(())
    }
}

/// The place of a facet's material among the base materials.
fn index(used: &[MaterialId], facet: FacetView<'_>) -> usize {
    used.partition_point(|&id| id < facet.material())
}

/// The object that holds all solids.
fn assembly(solids: usize, xml: &mut Writer<impl Write>) -> io::Result<()> {
    let id = (FIRST_OBJECT + solids).to_string();
    let attributes = [("id", id.as_str()), ("name", "model"), ("type", "model")];
    let object = xml.create_element("object").with_attributes(attributes);
    object.write_inner_content(|xml| {
        xml.create_element("components")
            .write_inner_content(|xml| {
                for number in 0..solids {
                    let id = (FIRST_OBJECT + number).to_string();
                    let component = xml.create_element("component");
                    component
                        .with_attribute(("objectid", id.as_str()))
                        .write_empty()?;
                }
                Ok(())
            })?;
        Ok(())
    })?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::samples::{cube, moved, painted, together};
    use super::*;
    use std::io::Read as _;
    use subdiv::Fragments;

    fn written(fragments: &Fragments, options: Options) -> Vec<u8> {
        let brep = brep::stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let materials = [
            Material { color: None },
            Material {
                color: Some([0.0, 0.5, 1.0, 0.25]),
            },
        ];
        let mut bytes = Vec::new();
        write(&brep, &materials, &options, &mut bytes).expect("memory");
        bytes
    }

    fn model_text(bytes: Vec<u8>) -> String {
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).expect("an archive");
        let mut text = String::new();
        let mut entry = archive.by_name(MODEL).expect("a model");
        entry.read_to_string(&mut text).expect("a text");
        text
    }

    #[test]
    fn counts_colours_and_unit_are_there() {
        let parts = [
            painted(cube([0.0; 3], 1.0), 0, 0),
            painted(cube([2.0; 3], 1.0), 6, 1),
        ];
        let options = Options { unit: Unit::Inch };
        let text = model_text(written(&together(&parts), options));
        // The cubes touch in a corner: two vertices at one place.
        assert_eq!(text.matches("<vertex ").count(), 16);
        assert_eq!(text.matches("<triangle ").count(), 24);
        // A solid each, of one material each, together in one object.
        assert_eq!(
            text.matches(r#"<object id="2" name="solid_1" type="model" pid="1" pindex="0""#)
                .count(),
            1
        );
        assert_eq!(
            text.matches(r#"<object id="3" name="solid_2" type="model" pid="1" pindex="1""#)
                .count(),
            1
        );
        assert_eq!(text.matches("p1=").count(), 0);
        assert!(text.contains(r#"<item objectid="4"/>"#));
        assert!(text.contains(r##"displaycolor="#0080FF40""##));
        assert!(text.contains(r#"unit="inch""#));
    }

    #[test]
    fn numbers_keep_every_bit() {
        let fragments = moved(cube([0.0; 3], 1.0), |p| p / 3.0 * 1e-7);
        let text = model_text(written(&fragments, Options::default()));
        assert!(text.contains(&format!(r#"x="{:e}""#, 1.0 / 3.0 * 1e-7)));
    }

    #[test]
    fn the_same_model_gives_the_same_bytes() {
        let fragments = cube([0.0; 3], 1.0);
        let write = || written(&fragments, Options::default());
        assert!(write() == write());
        let mut archive = zip::ZipArchive::new(Cursor::new(write())).expect("an archive");
        let entry = archive.by_name(MODEL).expect("a model");
        assert_eq!(entry.last_modified().map(|time| time.year()), Some(1980));
    }

    #[test]
    fn the_empty_solid_builds_nothing() {
        let text = model_text(written(&Fragments::default(), Options::default()));
        assert!(text.contains("<build/>"));
    }
}
