//! Binary glTF 2.0 (GLB), with `EXT_mesh_manifold`.
//!
//! Vertices are doubled at creases only, where normals differ. The extension tells readers which
//! doubles are one vertex, so that the file is a watertight solid without any welding: the base
//! index list is the drawing order, sparse replacements lead each double to the vertex' first
//! corner. Source: glTF 2.0 specification; `EXT_mesh_manifold`, Khronos vendor extensions, 2023.

use super::stl::single_precision;
use super::{Error, GENERATOR, appearance};
use brep::{Brep, Corners, FacetView, Shading, Valid};
use csg::{Aabb, Material, MaterialId};
use glam::DVec3;
use gltf_json as json;
use json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type, sparse};
use json::buffer::{Stride, Target, View};
use json::material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use json::mesh::{Mode, Primitive, Semantic};
use json::validation::{Checked, USize64};
use json::{Accessor, Index};
use std::borrow::Cow;
use std::io::Write;

/// What to write.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Options {
    /// Length of a model unit in metres, the unit of glTF; 1 when the model has no unit.
    pub metres_per_unit: f32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            metres_per_unit: 1.0,
        }
    }
}

/// Writes the boundary as one mesh with one primitive a material, in a node that turns the
/// model's z axis up.
///
/// Positions are 32-bit numbers; a model far from the origin is stored around its own centre and
/// moved back by its node.
///
/// # Errors
/// [`Error::Io`], [`Error::BeyondSinglePrecision`], [`Error::TooLarge`] above 4 GiB.
pub fn write(
    brep: &Valid<Brep>,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    write_shaded(brep, &Shading::of(brep), materials, options, out)
}

/// As [`write()`], with normals of the caller's choice.
///
/// # Errors
/// As [`write()`].
pub fn write_shaded(
    brep: &Valid<Brep>,
    shading: &Shading,
    materials: &[Material],
    options: &Options,
    out: &mut impl Write,
) -> Result<(), Error> {
    let mut file = Document::new();
    if brep.is_empty() {
        // A scene without any node is valid, but widespread readers refuse it.
        file.add_node(json::Node::default());
    } else {
        let origin = local_origin(&brep.bounds());
        let mesh = file.add_mesh(brep, &shading.corners, materials, origin)?;
        file.add_node(upright(mesh, origin, options.metres_per_unit));
    }
    file.finish(out)
}

/// Where 32-bit positions count from: the origin, unless the model is so far from it that digits
/// would be lost.
pub(super) fn local_origin(bounds: &Aabb) -> DVec3 {
    const FAR: f64 = 8.0;
    let centre = bounds.min + (bounds.max - bounds.min) * 0.5;
    if centre.length() > FAR * bounds.diagonal() {
        // Rounded as it will be stored, so that the sum stays right.
        centre.as_vec3().as_dvec3()
    } else {
        DVec3::ZERO
    }
}

/// The description and the binary part, growing together.
struct Document {
    root: json::Root,
    binary: Vec<u8>,
}

impl Document {
    fn new() -> Self {
        let mut root = json::Root {
            asset: json::Asset {
                generator: Some(GENERATOR.to_owned()),
                ..json::Asset::default()
            },
            ..json::Root::default()
        };
        let scene = root.push(json::Scene {
            extensions: None,
            extras: None,
            name: None,
            nodes: Vec::new(),
        });
        root.scene = Some(scene);
        Self {
            root,
            binary: Vec::new(),
        }
    }

    fn add_mesh(
        &mut self,
        brep: &Valid<Brep>,
        corners: &Corners,
        materials: &[Material],
        origin: DVec3,
    ) -> Result<Index<json::Mesh>, Error> {
        let attributes = self.add_vertices(brep, corners, origin)?;
        let mut facets: Vec<FacetView<'_>> = brep.facets().collect();
        facets.sort_by_key(|facet| facet.material());

        let mut indices: Vec<u32> = Vec::with_capacity(3 * facets.len());
        for half_edge in facets.iter().flat_map(|facet| facet.half_edges()) {
            indices.push(corners.corner_of[half_edge.key()].0);
        }
        let target = Some(Target::ElementArrayBuffer);
        let index_view = self.add_view(bytemuck::cast_slice(&indices), None, target);
        let mut primitives = Vec::new();
        let mut start = 0;
        for group in facets.chunk_by(|a, b| a.material() == b.material()) {
            let material = self.add_material(materials, group[0].material());
            let accessor = self.add_indices(index_view, 12 * start, 3 * group.len(), None);
            start += group.len();
            primitives.push(primitive(attributes.clone(), accessor, Some(material)));
        }

        let merge = self.add_merges(corners, &indices);
        let sparse = merge.as_ref().map(|merge| merge.sparse.clone());
        let all = self.add_indices(index_view, 0, indices.len(), sparse);
        let only_positions = attributes
            .into_iter()
            .filter(|(semantic, _)| *semantic == Checked::Valid(Semantic::Positions))
            .collect();
        let manifold = primitive(only_positions, all, None);
        let mut extension = serde_json::json!({ "manifoldPrimitive": manifold });
        if let Some(merge) = merge {
            extension["mergeIndices"] = merge.indices.value().into();
            extension["mergeValues"] = merge.values.value().into();
        }
        let mut extensions = json::extensions::mesh::Mesh::default();
        extensions
            .others
            .insert("EXT_mesh_manifold".to_owned(), extension);
        self.root
            .extensions_used
            .push("EXT_mesh_manifold".to_owned());
        Ok(self.root.push(json::Mesh {
            extensions: Some(extensions),
            extras: None,
            name: None,
            primitives,
            weights: None,
        }))
    }

    fn add_vertices(
        &mut self,
        brep: &Valid<Brep>,
        corners: &Corners,
        origin: DVec3,
    ) -> Result<Attributes, Error> {
        let mut positions: Vec<[f32; 3]> = Vec::with_capacity(corners.corners.len());
        let mut normals: Vec<[f32; 3]> = Vec::with_capacity(corners.corners.len());
        let mut min = [f32::INFINITY; 3];
        let mut max = [f32::NEG_INFINITY; 3];
        for corner in &corners.corners {
            let position = brep.vertex(corner.vertex).position() - origin;
            let position = single_precision(position)?.to_array();
            min = std::array::from_fn(|axis| min[axis].min(position[axis]));
            max = std::array::from_fn(|axis| max[axis].max(position[axis]));
            positions.push(position);
            normals.push(corner.normal.as_vec3().to_array());
        }
        let mut attributes = Attributes::new();
        let bounds = Some((min, max));
        let streams = [
            (Semantic::Positions, positions, bounds),
            (Semantic::Normals, normals, None),
        ];
        for (semantic, values, bounds) in streams {
            let bytes = bytemuck::cast_slice(&values);
            let view = self.add_view(bytes, Some(Stride(12)), Some(Target::ArrayBuffer));
            let accessor = self.root.push(Accessor {
                min: bounds.map(|(min, _)| min.to_vec().into()),
                max: bounds.map(|(_, max)| max.to_vec().into()),
                ..accessor(view, 0, values.len(), ComponentType::F32, Type::Vec3)
            });
            attributes.insert(Checked::Valid(semantic), accessor);
        }
        Ok(attributes)
    }

    /// The places of the index list that name a double, and what they should name; `None`
    /// without doubles.
    fn add_merges(&mut self, corners: &Corners, indices: &[u32]) -> Option<Merge> {
        let list = &corners.corners;
        // Corners of one vertex stand together: lead each to the first one.
        let mut first: Vec<u32> = (0..).take(list.len()).collect();
        for at in 1..list.len() {
            if list[at].vertex == list[at - 1].vertex {
                first[at] = first[at - 1];
            }
        }
        let (places, values): (Vec<u32>, Vec<u32>) = (0_u32..)
            .zip(indices)
            .map(|(place, &corner)| (place, corner, first[corner as usize]))
            .filter(|(_, corner, first)| corner != first)
            .map(|(place, _, first)| (place, first))
            .unzip();
        if places.is_empty() {
            return None;
        }
        let [indices_view, values_view] =
            [&places, &values].map(|list| self.add_view(bytemuck::cast_slice(list), None, None));
        let sparse = sparse::Sparse {
            count: USize64::from(places.len()),
            indices: sparse::Indices {
                buffer_view: indices_view,
                byte_offset: USize64::from(0_usize),
                component_type: Checked::Valid(IndexComponentType(ComponentType::U32)),
                extensions: None,
                extras: None,
            },
            values: sparse::Values {
                buffer_view: values_view,
                byte_offset: USize64::from(0_usize),
                extensions: None,
                extras: None,
            },
            extensions: None,
            extras: None,
        };
        Some(Merge {
            sparse,
            indices: self.add_indices(indices_view, 0, places.len(), None),
            values: self.add_indices(values_view, 0, places.len(), None),
        })
    }

    fn add_material(&mut self, materials: &[Material], id: MaterialId) -> Index<json::Material> {
        let [red, green, blue, alpha] = appearance::color(materials, id);
        let linear = [red, green, blue].map(appearance::linear);
        let alpha_mode = if alpha < 1.0 {
            AlphaMode::Blend
        } else {
            AlphaMode::Opaque
        };
        self.root.push(json::Material {
            name: Some(format!("material_{}", id.0)),
            alpha_mode: Checked::Valid(alpha_mode),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor([linear[0], linear[1], linear[2], alpha]),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(0.6),
                ..PbrMetallicRoughness::default()
            },
            ..json::Material::default()
        })
    }

    fn add_node(&mut self, node: json::Node) {
        let node = self.root.push(node);
        for scene in &mut self.root.scenes {
            scene.nodes.push(node);
        }
    }

    fn add_view(
        &mut self,
        bytes: &[u8],
        byte_stride: Option<Stride>,
        target: Option<Target>,
    ) -> Index<View> {
        // All data are 32-bit numbers, so offsets stay multiples of four.
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.root.push(View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(offset)),
            byte_stride,
            name: None,
            target: target.map(Checked::Valid),
            extensions: None,
            extras: None,
        })
    }

    fn add_indices(
        &mut self,
        view: Index<View>,
        byte_offset: usize,
        count: usize,
        sparse: Option<sparse::Sparse>,
    ) -> Index<Accessor> {
        let plain = accessor(view, byte_offset, count, ComponentType::U32, Type::Scalar);
        self.root.push(Accessor { sparse, ..plain })
    }

    fn finish(mut self, out: &mut impl Write) -> Result<(), Error> {
        if !self.binary.is_empty() {
            self.root.push(json::Buffer {
                byte_length: USize64::from(self.binary.len()),
                name: None,
                uri: None,
                extensions: None,
                extras: None,
            });
        }
        let json = self.root.to_vec()?;
        let size = self.binary.len() + json.len() + 64;
        if u32::try_from(size).is_err() {
            return Err(Error::TooLarge {
                size,
                unit: "bytes",
            });
        }
        let file = gltf::Glb {
            // The length is computed when the file is written.
            header: gltf::binary::Header {
                magic: *b"glTF",
                version: 2,
                length: 0,
            },
            json: Cow::Owned(json),
            bin: (!self.binary.is_empty()).then_some(Cow::Owned(self.binary)),
        };
        file.to_writer(out).map_err(Error::Glb)
    }
}

/// A node that turns the model's z axis up, scales by `unit` and moves it back to `origin`.
fn upright(mesh: Index<json::Mesh>, origin: DVec3, unit: f32) -> json::Node {
    // −90° about x turns (x, y, z) into (x, z, −y).
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let origin = origin.as_vec3() * unit;
    let moved = origin != glam::Vec3::ZERO;
    let scaled = unit.to_bits() != 1.0_f32.to_bits();
    json::Node {
        mesh: Some(mesh),
        rotation: Some(json::scene::UnitQuaternion([-half, 0.0, 0.0, half])),
        scale: scaled.then_some([unit; 3]),
        translation: moved.then_some([origin.x, origin.z, -origin.y]),
        ..json::Node::default()
    }
}

type Attributes = std::collections::BTreeMap<Checked<Semantic>, Index<Accessor>>;

/// Where the extension says which doubles are one vertex.
struct Merge {
    sparse: sparse::Sparse,
    indices: Index<Accessor>,
    values: Index<Accessor>,
}

fn accessor(
    view: Index<View>,
    byte_offset: usize,
    count: usize,
    component_type: ComponentType,
    shape: Type,
) -> Accessor {
    Accessor {
        buffer_view: Some(view),
        byte_offset: Some(USize64::from(byte_offset)),
        count: USize64::from(count),
        component_type: Checked::Valid(GenericComponentType(component_type)),
        extensions: None,
        extras: None,
        type_: Checked::Valid(shape),
        min: None,
        max: None,
        name: None,
        normalized: false,
        sparse: None,
    }
}

fn primitive(
    attributes: Attributes,
    indices: Index<Accessor>,
    material: Option<Index<json::Material>>,
) -> Primitive {
    Primitive {
        attributes,
        extensions: None,
        extras: None,
        indices: Some(indices),
        material,
        mode: Checked::Valid(Mode::Triangles),
        targets: None,
    }
}

#[cfg(test)]
mod tests;
