//! Wavefront OBJ with its material library.
//!
//! Vertices are shared, so the file is a watertight mesh by its indices alone; normals have
//! indices of their own. Facets are sorted into one group a face, named by primitive, sense and
//! material. Numbers are the shortest decimals that read back to the same 64-bit value.

use super::decimal::Decimal;
use super::{Error, GENERATOR, Unit, appearance};
use brep::{Brep, Corners, FaceId, FacetView, Groups, Shading, Valid};
use csg::{Material, MaterialId, PrimitiveId, Sense};
use std::fmt;
use std::io::Write;

/// What to write.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Options {
    /// Name of the material library beside the file, for `mtllib`; `None`: no materials.
    pub material_library: Option<String>,
    /// What a model unit is, for a comment: the format has no unit.
    pub unit: Option<Unit>,
}

/// Writes the boundary without normals.
///
/// # Errors
/// [`Error::Io`].
pub fn write(brep: &Valid<Brep>, options: &Options, out: &mut impl Write) -> Result<(), Error> {
    write_corners(brep, None, options, out)
}

/// Writes the boundary with normals, several at a vertex where faces meet in a crease.
///
/// Positions stay shared, but some readers give each corner a vertex of its own and no longer
/// see that the mesh is closed.
///
/// # Errors
/// [`Error::Io`].
pub fn write_shaded(
    brep: &Valid<Brep>,
    shading: &Shading,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    write_corners(brep, Some(&shading.corners), options, out)
}

fn write_corners(
    brep: &Valid<Brep>,
    corners: Option<&Corners>,
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    writeln!(out, "# {GENERATOR}")?;
    writeln!(
        out,
        "# {} vertices, {} triangles, unit: {}, counter-clockwise seen from outside",
        brep.vertex_count(),
        brep.facet_count(),
        options.unit.map_or("not said", Unit::name)
    )?;
    if let Some(library) = &options.material_library {
        writeln!(out, "mtllib {library}")?;
    }
    for vertex in brep.vertices() {
        let [x, y, z] = vertex.position().to_array().map(Decimal);
        writeln!(out, "v {x} {y} {z}")?;
    }
    for corner in corners.iter().flat_map(|corners| &corners.corners) {
        // Adding zero turns −0 into 0.
        let [x, y, z] = corner
            .normal
            .as_vec3()
            .to_array()
            .map(|number| number + 0.0);
        writeln!(out, "vn {x} {y} {z}")?;
    }
    let numbers = brep.number_vertices();
    let faces = Groups::of(brep);
    let mut facets: Vec<(Group, FacetView<'_>)> = brep
        .facets()
        .map(|facet| (Group::of(facet, &faces), facet))
        .collect();
    facets.sort_by_key(|(group, _)| *group);
    let mut current: Option<Group> = None;
    for (group, facet) in facets {
        if current != Some(group) {
            writeln!(out, "g {group}")?;
            let painted = current.is_some_and(|before| before.material == group.material);
            if options.material_library.is_some() && !painted {
                writeln!(out, "usemtl material_{}", group.material.0)?;
            }
            current = Some(group);
        }
        out.write_all(b"f")?;
        for half_edge in facet.half_edges() {
            let vertex = numbers[half_edge.origin().key()] + 1;
            match corners {
                None => write!(out, " {vertex}")?,
                Some(corners) => {
                    let normal = corners.corner_of[half_edge.key()].0 + 1;
                    write!(out, " {vertex}//{normal}")?;
                }
            }
        }
        out.write_all(b"\n")?;
    }
    Ok(())
}

/// Writes the material library that [`Options::material_library`] names: the materials that the
/// boundary's facets show.
///
/// # Errors
/// [`Error::Io`].
pub fn write_materials(
    brep: &Valid<Brep>,
    materials: &[Material],
    out: &mut impl Write,
) -> Result<(), Error> {
    writeln!(out, "# {GENERATOR}")?;
    let mut used: Vec<MaterialId> = brep.facets().map(FacetView::material).collect();
    used.sort_unstable();
    used.dedup();
    for id in used {
        let [red, green, blue, alpha] = appearance::color(materials, id);
        writeln!(out, "newmtl material_{}", id.0)?;
        writeln!(out, "Kd {red} {green} {blue}")?;
        writeln!(out, "Ks 0.1 0.1 0.1")?;
        writeln!(out, "Ns 50")?;
        writeln!(out, "d {alpha}")?;
        writeln!(out, "illum 2")?;
    }
    Ok(())
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Group {
    material: MaterialId,
    face: FaceId,
    primitive: PrimitiveId,
    sense: Sense,
}

impl Group {
    fn of(facet: FacetView<'_>, faces: &Groups) -> Self {
        Self {
            material: facet.material(),
            face: faces.face_of[facet.key()],
            primitive: facet.primitive(),
            sense: facet.sense(),
        }
    }
}

impl fmt::Display for Group {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let side = match self.sense {
            Sense::Inside => "inside",
            Sense::Outside => "outside",
        };
        let (face, primitive, material) = (self.face.0, self.primitive.0, self.material.0);
        write!(
            formatter,
            "face_{face}_primitive_{primitive}_{side}_material_{material}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{cube, moved, painted, sphere, together, torus};
    use super::*;
    use glam::DVec3;
    use subdiv::Fragments;

    fn valid(fragments: &Fragments) -> Valid<Brep> {
        brep::stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid")
    }

    fn text(brep: &Valid<Brep>, options: &Options) -> String {
        let mut bytes = Vec::new();
        write(brep, options, &mut bytes).expect("memory");
        String::from_utf8(bytes).expect("ASCII")
    }

    /// Positions and triangles as another program reads them.
    fn read_back(text: &str) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let no_materials = |_: &std::path::Path| Ok(Default::default());
        let mut reader = std::io::Cursor::new(text);
        let options = tobj::LoadOptions::default();
        let (models, _) =
            tobj::load_obj_buf(&mut reader, &options, no_materials).expect("readable");
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for model in models {
            positions.extend(
                model
                    .mesh
                    .positions
                    .chunks_exact(3)
                    .map(|p| [p[0], p[1], p[2]]),
            );
            triangles.extend(
                model
                    .mesh
                    .indices
                    .chunks_exact(3)
                    .map(|t| [t[0], t[1], t[2]]),
            );
        }
        (positions, triangles)
    }

    #[test]
    fn another_reader_finds_the_same_mesh() {
        // Not short in decimals, tiny and huge: every bit must survive.
        let fragments = moved(torus(2.0, 1.0 / 3.0, 12, 7), |p| {
            p * DVec3::new(1e-9, 1.0 / 7.0, 1e19)
        });
        let brep = valid(&fragments);
        let (positions, triangles) = read_back(&text(&brep, &Options::default()));
        let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let find = |p: DVec3| positions.iter().position(|&q| bits(q.into()) == bits(p));
        assert_eq!(positions.len(), fragments.positions.len());
        for (written, triangle) in triangles.iter().zip(&fragments.triangles) {
            let expected = triangle
                .vertices
                .map(|v| find(fragments.positions[v as usize]));
            assert_eq!(written.map(|v| Some(v as usize)), expected);
        }
        assert_eq!(triangles.len(), fragments.triangles.len());
    }

    #[test]
    fn groups_and_materials_are_named_once_each() {
        let parts = [painted(cube([0.0; 3], 1.0), 0, 1), painted(sphere(1), 6, 0)];
        let apart = [parts[0].clone(), moved(parts[1].clone(), |p| p + 5.0)];
        let options = Options {
            material_library: Some("part.mtl".to_owned()),
            unit: None,
        };
        let written = text(&valid(&together(&apart)), &options);
        let starting = |word: &str| -> Vec<&str> {
            written
                .lines()
                .filter(|line| line.split(' ').next() == Some(word))
                .collect()
        };
        assert_eq!(starting("mtllib"), ["mtllib part.mtl"]);
        assert_eq!(
            starting("usemtl"),
            ["usemtl material_0", "usemtl material_1"]
        );
        assert_eq!(starting("g").len(), 7);
        assert_eq!(starting("g")[0], "g face_6_primitive_6_inside_material_0");
    }

    #[test]
    fn materials_are_those_that_show() {
        let brep = valid(&painted(cube([0.0; 3], 1.0), 0, 1));
        let materials = [
            Material { color: None },
            Material {
                color: Some([1.0, 0.5, 0.0, 0.25]),
            },
        ];
        let mut bytes = Vec::new();
        write_materials(&brep, &materials, &mut bytes).expect("memory");
        let (read, _) = tobj::load_mtl_buf(&mut &bytes[..]).expect("readable");
        assert_eq!(read.len(), 1);
        assert_eq!(
            (read[0].name.as_str(), read[0].diffuse),
            ("material_1", Some([1.0, 0.5, 0.0]))
        );
        assert_eq!(read[0].dissolve, Some(0.25));
    }

    #[test]
    fn normals_are_optional_and_split_at_creases() {
        let brep = valid(&cube([0.0; 3], 1.0));
        let plain = text(&brep, &Options::default());
        assert!(!plain.contains("vn ") && plain.contains("\nf 1 5 7\n"));
        let mut bytes = Vec::new();
        let shading = Shading::of(&brep);
        write_shaded(&brep, &shading, &Options::default(), &mut bytes).expect("memory");
        let smooth = String::from_utf8(bytes).expect("ASCII");
        assert_eq!(smooth.matches("\nvn ").count(), 24);
        assert_eq!(smooth.matches("\nv ").count(), 8);
        assert_eq!(smooth.matches("//").count(), 36);
    }

    #[test]
    fn faces_on_one_primitive_are_groups_of_their_own() {
        let parts = [cube([0.0; 3], 1.0), moved(cube([0.0; 3], 1.0), |p| p + 5.0)];
        let written = text(&valid(&together(&parts)), &Options::default());
        assert_eq!(written.matches("\ng face_").count(), 12);
    }

    #[test]
    fn the_unit_is_said() {
        let options = Options {
            unit: Some(Unit::Inch),
            ..Options::default()
        };
        let written = text(&valid(&cube([0.0; 3], 1.0)), &options);
        assert!(written.contains("unit: inch,"));
    }

    #[test]
    fn the_empty_solid_has_no_facets() {
        let written = text(&valid(&Fragments::default()), &Options::default());
        assert!(written.lines().all(|line| line.starts_with('#')));
    }
}
