use super::*;
use crate::write::samples::{cube, moved, painted, sphere, together, torus};
use subdiv::Fragments;

fn valid(fragments: &Fragments) -> Valid<Brep> {
    brep::stitch(fragments)
        .expect("closed")
        .validate()
        .expect("valid")
}

fn bytes(brep: &Valid<Brep>, materials: &[Material], options: Options) -> Vec<u8> {
    let mut bytes = Vec::new();
    write(brep, materials, &options, &mut bytes).expect("memory");
    bytes
}

/// Positions, normals and indices of a primitive.
type Streams = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u32>);

/// A file as another program reads it.
struct ReadBack {
    document: gltf::Document,
    binary: Vec<u8>,
}

impl ReadBack {
    fn new(bytes: &[u8]) -> Self {
        let file = gltf::Gltf::from_slice(bytes).expect("a valid file");
        Self {
            document: file.document,
            binary: file.blob.unwrap_or_default(),
        }
    }

    fn primitives(&self) -> Vec<Streams> {
        let mesh = self.document.meshes().next().expect("a mesh");
        let read = |primitive: gltf::Primitive<'_>| {
            let reader = primitive.reader(|_| Some(&self.binary[..]));
            (
                reader.read_positions().expect("positions").collect(),
                reader.read_normals().expect("normals").collect(),
                reader.read_indices().expect("indices").into_u32().collect(),
            )
        };
        mesh.primitives().map(read).collect()
    }
}

#[test]
fn another_reader_finds_the_same_mesh() {
    let fragments = torus(2.0, 0.7, 12, 8);
    let brep = valid(&fragments);
    let read = ReadBack::new(&bytes(&brep, &[], Options::default()));
    let [(positions, normals, indices)] = &read.primitives()[..] else {
        panic!("one material, one primitive");
    };
    let expected: Vec<[f32; 3]> = fragments
        .positions
        .iter()
        .map(|p| p.as_vec3().to_array())
        .collect();
    assert_eq!(positions.len(), expected.len());
    assert!(
        positions
            .iter()
            .flatten()
            .zip(expected.iter().flatten())
            .all(|(a, b)| (a - b).abs() == 0.0)
    );
    let triangles: Vec<u32> = fragments
        .triangles
        .iter()
        .flat_map(|t| t.vertices)
        .collect();
    assert_eq!(indices, &triangles);
    assert!(normals.iter().all(|&n| glam::Vec3::from(n).is_normalized()));
}

#[test]
fn bounds_are_exact_and_z_is_up() {
    let fragments = moved(cube([0.0; 3], 0.3), |p| p + DVec3::new(0.1, 0.2, 0.4));
    let read = ReadBack::new(&bytes(
        &valid(&fragments),
        &[],
        Options {
            metres_per_unit: 0.5,
        },
    ));
    let mesh = read.document.meshes().next().expect("a mesh");
    let bounds = mesh
        .primitives()
        .next()
        .expect("a primitive")
        .bounding_box();
    let (positions, ..) = &read.primitives()[0];
    for axis in 0..3 {
        let values = || positions.iter().map(|p| p[axis]);
        assert!((values().fold(f32::INFINITY, f32::min) - bounds.min[axis]).abs() == 0.0);
        assert!((values().fold(f32::NEG_INFINITY, f32::max) - bounds.max[axis]).abs() == 0.0);
    }
    let node = read.document.nodes().next().expect("a node");
    let matrix = glam::Mat4::from_cols_array_2d(&node.transform().matrix());
    let up = matrix.transform_vector3(glam::Vec3::Z);
    assert!((up - glam::Vec3::Y * 0.5).length() < 1e-6);
}

#[test]
fn materials_become_primitives_in_linear_colours() {
    let parts = [
        painted(cube([0.0; 3], 1.0), 0, 2),
        painted(cube([5.0; 3], 1.0), 6, 0),
    ];
    let materials = [
        Material { color: None },
        Material {
            color: Some([0.0; 4]),
        },
        Material {
            color: Some([1.0, 0.5, 0.0, 0.5]),
        },
    ];
    let read = ReadBack::new(&bytes(
        &valid(&together(&parts)),
        &materials,
        Options::default(),
    ));
    let names: Vec<_> = read
        .document
        .materials()
        .filter_map(|m| m.name().map(str::to_owned))
        .collect();
    assert_eq!(names, ["material_0", "material_2"]);
    let orange = read.document.materials().nth(1).expect("two");
    let [red, green, blue, alpha] = orange.pbr_metallic_roughness().base_color_factor();
    // sRGB 0.5 is 0.214 in linear light.
    assert!((red - 1.0).abs() + (green - 0.214).abs() + blue + (alpha - 0.5).abs() < 1e-3);
    assert_eq!(orange.alpha_mode(), gltf::material::AlphaMode::Blend);
    assert_eq!(
        read.primitives()
            .iter()
            .map(|(.., i)| i.len())
            .collect::<Vec<_>>(),
        [36, 36]
    );
}

#[test]
fn the_manifold_primitive_undoes_all_doubles() {
    let parts = [painted(cube([0.0; 3], 1.0), 0, 1), painted(sphere(2), 6, 0)];
    let parts = [parts[0].clone(), moved(parts[1].clone(), |p| p + 5.0)];
    let brep = valid(&together(&parts));
    let read = ReadBack::new(&bytes(&brep, &[], Options::default()));
    let json = read.document.clone().into_json();
    assert_eq!(json.extensions_used, ["EXT_mesh_manifold"]);
    let extension = &json.meshes[0].extensions.as_ref().expect("one").others["EXT_mesh_manifold"];
    let accessor = |value: &serde_json::Value| {
        let index = usize::try_from(value.as_u64().expect("an index")).expect("small");
        read.document.accessors().nth(index).expect("an accessor")
    };
    let manifold = &extension["manifoldPrimitive"];
    let data = |accessor: gltf::Accessor<'_>| -> Vec<u32> {
        let binary = &read.binary;
        gltf::accessor::Iter::<u32>::new(accessor, |_| Some(&binary[..]))
            .expect("data")
            .collect()
    };
    let indices = data(accessor(&manifold["indices"]));
    assert_eq!(indices.len(), 3 * brep.facet_count());
    let triangles: Vec<[u32; 3]> = indices
        .chunks_exact(3)
        .map(|t| [t[0], t[1], t[2]])
        .collect();
    let vertex_count = accessor(&manifold["attributes"]["POSITION"]).count();
    // 24 corners of the cube, which has 8 vertices: without the merges it is open.
    assert_eq!(vertex_count, brep.vertex_count() + 16);
    assert_eq!(brep::check_manifold(vertex_count, &triangles), Ok(()));
    let drawn: Vec<u32> = read
        .primitives()
        .into_iter()
        .flat_map(|(.., i)| i)
        .collect();
    let drawn: Vec<[u32; 3]> = drawn.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect();
    assert!(brep::check_manifold(vertex_count, &drawn).is_err());
    // The merge lists repeat the sparse data: places in the index list, ascending.
    let places = data(accessor(&extension["mergeIndices"]));
    let values = data(accessor(&extension["mergeValues"]));
    assert!(places.is_sorted() && places.len() == values.len());
    for (place, value) in places.iter().zip(values) {
        assert_eq!(indices[*place as usize], value);
    }
}

#[test]
fn far_from_the_origin_digits_stay() {
    let shift = DVec3::new(1e6, -2e6, 3e6);
    let fragments = moved(sphere(3), |p| p + shift);
    let read = ReadBack::new(&bytes(&valid(&fragments), &[], Options::default()));
    let (positions, ..) = &read.primitives()[0];
    let node = read.document.nodes().next().expect("a node");
    let gltf::scene::Transform::Decomposed {
        translation: [x, y, z],
        ..
    } = node.transform()
    else {
        panic!("a decomposed transform");
    };
    for (local, exact) in positions.iter().zip(&fragments.positions) {
        let local = glam::Vec3::from(*local).as_dvec3();
        // (x, z, −y) in the scene.
        let origin = DVec3::new(x.into(), (-z).into(), y.into());
        assert!((origin + local - *exact).length() < 1e-6);
    }
}

#[test]
fn the_empty_solid_is_an_empty_scene() {
    let read = ReadBack::new(&bytes(
        &valid(&Fragments::default()),
        &[],
        Options::default(),
    ));
    assert_eq!(
        (read.document.scenes().len(), read.document.nodes().len()),
        (1, 1)
    );
    assert!(read.binary.is_empty() && read.document.meshes().len() == 0);
}
