//! What we write is read back; what is cut off, changed or made to hurt is refused in bounded time
//! and memory.

use super::*;
use crate::write::samples::{cube, together, torus};
use crate::write::{
    gltf, obj as write_obj, ply as write_ply, stl as write_stl, threemf as write_threemf,
};
use proptest::prelude::*;
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;

/// Two solids in each of our own formats.
fn written() -> Vec<(MeshFormat, Vec<u8>)> {
    let fragments = together(&[cube([5.0, 0.0, 0.0], 1.0), torus(2.0, 0.5, 8, 6)]);
    let brep = brep::stitch(&fragments)
        .expect("closed")
        .validate()
        .expect("valid");
    let mut files: Vec<(MeshFormat, Vec<u8>)> = MeshFormat::ALL
        .into_iter()
        .map(|format| (format, Vec::new()))
        .collect();
    for (format, bytes) in &mut files {
        match format {
            MeshFormat::Obj => write_obj::write(&brep, &write_obj::Options::default(), bytes),
            MeshFormat::Glb => gltf::write(&brep, &[], &gltf::Options::default(), bytes),
            MeshFormat::Stl => write_stl::write(&brep, bytes).map(drop),
            MeshFormat::Threemf => {
                write_threemf::write(&brep, &[], &write_threemf::Options::default(), bytes)
            }
            MeshFormat::Ply => write_ply::write(&brep, &[], &write_ply::Options::default(), bytes),
        }
        .expect("memory");
    }
    files
}

fn inspected(mesh: &Mesh) -> brep::Inspection {
    let first = brep::join_equal(&mesh.positions, &mesh.bodies);
    let name = |v: u32| match mesh.joining {
        Joining::Positions => first.get(v as usize).copied().unwrap_or(v),
        _ => v,
    };
    let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(name)).collect();
    brep::Inspection::of(&mesh.positions, &triangles).expect("few triangles")
}

#[test]
fn what_we_write_is_read_back_sound() {
    for (format, bytes) in written() {
        assert_eq!(sniff(&bytes, "-"), Some(format));
        let mesh = read(&bytes, format, Limits::default()).expect("a mesh");
        let found = inspected(&mesh);
        assert!(found.is_sound(), "{format:?}");
        assert_eq!((found.components, found.genus), (2, Some(1)), "{format:?}");
        assert_eq!(mesh.triangles.len(), 12 + 2 * 8 * 6, "{format:?}");
    }
}

#[test]
fn obj_files_are_read_as_tobj_reads_them() {
    let (_, bytes) = written().swap_remove(0);
    let mesh = read(&bytes, MeshFormat::Obj, Limits::default()).expect("a mesh");
    let options = tobj::LoadOptions::default();
    let (models, _) = tobj::load_obj_buf(&mut bytes.as_slice(), &options, |_| {
        tobj::MTLLoadResult::Err(tobj::LoadError::GenericFailure)
    })
    .expect("tobj reads it");
    let corner = |model: &tobj::Model, v: u32| {
        let at = 3 * v as usize;
        DVec3::from_slice(&model.mesh.positions[at..at + 3])
    };
    let theirs: Vec<DVec3> = models
        .iter()
        .flat_map(|model| model.mesh.indices.iter().map(|v| corner(model, *v)))
        .collect();
    let ours = mesh.triangles.as_flattened().iter();
    let ours: Vec<DVec3> = ours.map(|v| mesh.positions[*v as usize]).collect();
    assert_eq!(ours, theirs);
}

#[test]
fn no_prefix_of_a_file_panics_and_a_binary_one_is_never_whole() {
    for (format, bytes) in written() {
        for length in 0..bytes.len() {
            let found = read(&bytes[..length], format, Limits::default());
            if !matches!(format, MeshFormat::Obj) {
                assert!(found.is_err(), "{format:?}, {length} bytes");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn changed_bytes_never_panic(
        which in 0..5_usize,
        changes in proptest::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let (format, mut bytes) = written().swap_remove(which);
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        if let Ok(mesh) = read(&bytes, format, Limits { elements: 100_000 }) {
            let _ = inspected(&mesh);
        }
    }

    #[test]
    fn noise_never_panics(
        which in 0..5_usize,
        bytes in proptest::collection::vec(any::<u8>(), 0..400),
    ) {
        let _ = read(&bytes, MeshFormat::ALL[which], Limits::default());
    }
}

fn refused(bytes: &[u8], format: MeshFormat) -> String {
    read(bytes, format, Limits::default())
        .expect_err("refused")
        .to_string()
}

#[test]
fn counts_are_believed_only_as_far_as_there_are_bytes() {
    let mut stl = vec![0; 84];
    stl[80..].fill(0xFF);
    assert_eq!(
        refused(&stl, MeshFormat::Stl),
        "byte 80: the header announces 4294967295 triangles, which take 214748364834 bytes, but the file has 84 \
         (the file is damaged or cut off: write or copy it again)"
    );
    let axes = "property float x\nproperty float y\nproperty float z\n";
    for (encoding, count) in [
        ("ascii", "99999999999"),
        ("binary_little_endian", "4000000000"),
    ] {
        let ply = format!(
            "ply\nformat {encoding} 1.0\nelement vertex {count}\n{axes}end_header\n0 0 0\n"
        );
        let text = refused(ply.as_bytes(), MeshFormat::Ply);
        assert!(
            text.contains("are announced, but only 6 bytes are left"),
            "{text}"
        );
    }
    let list = "element vertex 0\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uint int vertex_indices\n";
    let mut ply = format!("ply\nformat binary_little_endian 1.0\n{list}end_header\n").into_bytes();
    ply.extend(u32::MAX.to_le_bytes());
    refused(&ply, MeshFormat::Ply);
    let ply = "ply\nformat binary_little_endian 1.0\nelement nothing 99999999999\nend_header\n";
    assert!(refused(ply.as_bytes(), MeshFormat::Ply).contains("has no properties"));
}

/// A GLB file of a description and binary data.
fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let length = u32::try_from(12 + 8 + text.len() + 8 + binary.len()).expect("short");
    let chunk = |kind: &[u8; 4], data: &[u8]| {
        let length = u32::try_from(data.len()).expect("short").to_le_bytes();
        [&length, kind.as_slice(), data].concat()
    };
    let header = [
        b"glTF".as_slice(),
        &2_u32.to_le_bytes(),
        &length.to_le_bytes(),
    ]
    .concat();
    [header, chunk(b"JSON", &text), chunk(b"BIN\0", binary)].concat()
}

#[test]
fn descriptions_that_lie_are_refused() {
    let mesh = |accessors: &str, nodes: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{nodes}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],"accessors":[{accessors}],
            "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"byteLength":36}}]}}"#
        )
    };
    let plain = r#"{"mesh":0}"#;
    let cases = [
        // Zeros without end.
        (
            r#"{"componentType":5126,"count":1000000000000000,"type":"VEC3"}"#,
            plain,
            "more vertices and triangles",
        ),
        (
            r#"{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"}"#,
            plain,
            "reach beyond the end",
        ),
        (
            r#"{"bufferView":0,"byteOffset":18446744073709551615,"componentType":5126,"count":1,"type":"VEC3"}"#,
            plain,
            "reach beyond the end",
        ),
        (
            r#"{"bufferView":7,"componentType":5126,"count":3,"type":"VEC3"}"#,
            plain,
            "no buffer view 7",
        ),
        (
            r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}"#,
            plain,
            "not the right type",
        ),
        (
            r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#,
            r#"{"children":[0],"mesh":0}"#,
            "the node occurs twice",
        ),
    ];
    for (accessors, nodes, expected) in cases {
        let text = refused(&glb(&mesh(accessors, nodes), &[0; 36]), MeshFormat::Glb);
        assert!(text.contains(expected), "{text}");
    }
    let whole = r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}"#;
    let whole = read(
        &glb(&mesh(whole, plain), &[0; 36]),
        MeshFormat::Glb,
        Limits::default(),
    );
    assert_eq!(whole.expect("a triangle").triangles, [[0, 1, 2]]);
    let deep = format!(
        r#"{{"asset":{{"version":"2.0"}},"extras":{}}}"#,
        "[".repeat(100_000)
    );
    refused(&glb(&deep, &[]), MeshFormat::Glb);
}

/// A 3MF package around a model.
fn package(model: impl Iterator<Item = Vec<u8>>) -> Vec<u8> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let entry = SimpleFileOptions::default();
    archive.start_file("_rels/.rels", entry).expect("memory");
    let relations = format!(
        r#"<Relationships><Relationship Type="{}" Target="/m.model"/></Relationships>"#,
        "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    );
    archive.write_all(relations.as_bytes()).expect("memory");
    archive.start_file("m.model", entry).expect("memory");
    for piece in model {
        archive.write_all(&piece).expect("memory");
    }
    archive.finish().expect("memory").into_inner()
}

fn refused_model(text: &str) -> String {
    refused(
        &package(std::iter::once(text.as_bytes().to_vec())),
        MeshFormat::Threemf,
    )
}

#[test]
fn archives_and_entities_do_not_unfold_without_end() {
    // 300 MB of spaces in 300 kB; elements that never end; limits for smaller memories.
    let spaces = || std::iter::repeat_n(vec![b' '; 1 << 20], 300);
    let bomb = package([b"<model>".to_vec()].into_iter().chain(spaces()));
    assert!(refused(&bomb, MeshFormat::Threemf).contains("longer than a megabyte"));
    let line = b"<metadata name='x'>y</metadata>".repeat(1 << 15);
    let bomb = package(
        [b"<model>".to_vec()]
            .into_iter()
            .chain(std::iter::repeat_n(line, 60)),
    );
    let small = read(&bomb, MeshFormat::Threemf, Limits { elements: 10_000 });
    let small = small.expect_err("too large");
    assert!(
        small.is_limit && small.to_string().contains("unfolds to more than memory"),
        "{small}"
    );

    let entities = r#"<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;">]><model unit="&b;"/>"#;
    assert!(refused_model(entities).contains("document type declaration"));
    assert!(refused_model(r#"<model unit="&b;"/>"#).contains("m.model, byte 0"));
}

#[test]
fn components_do_not_unfold_without_end() {
    let build = r#"</resources><build><item objectid="30"/></build></model>"#;
    // Each object holds the one before twice: 2³⁰ instances.
    let doubled = (1..=30).map(|id| {
        let below = id - 1;
        format!(
            r#"<object id="{id}"><components><component objectid="{below}"/><component objectid="{below}"/></components></object>"#
        )
    });
    let bomb: String = doubled.collect();
    let bomb = format!(r#"<model><resources><object id="0"/>{bomb}{build}"#);
    assert!(refused_model(&bomb).contains("unfold without end"));
    let cycle = r#"<object id="30"><components><component objectid="30"/></components></object>"#;
    let cycle = format!("<model><resources>{cycle}{build}");
    assert!(refused_model(&cycle).contains("unfold without end"));
    let missing = format!("<model><resources>{build}");
    assert!(refused_model(&missing).contains("object 30: there is no such object"));
}

#[test]
fn mirrored_instances_keep_their_outside() {
    let triangle = r#"<object id="1"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/><vertex x="0" y="1" z="0"/></vertices>
        <triangles><triangle v1="0" v2="1" v3="2"/><triangle v1="0" v2="1" v3="3"/></triangles></mesh></object>"#;
    let model = format!(
        r#"<model><resources>{triangle}</resources><build><item objectid="1"/><item objectid="1" transform="-1 0 0 0 1 0 0 0 1 0 0 5"/></build></model>"#
    );
    let bytes = package(std::iter::once(model.into_bytes()));
    let mesh = read(&bytes, MeshFormat::Threemf, Limits::default()).expect("a mesh");
    assert_eq!(
        mesh.triangles,
        [[0, 1, 2], [0, 1, NO_VERTEX], [3, 5, 4], [3, NO_VERTEX, 4]]
    );
    assert_eq!(mesh.positions[4], DVec3::new(-1.0, 0.0, 5.0));
    assert_eq!(mesh.place(3), "object 1, triangle 1");
    assert_eq!(mesh.bodies, [0, 3]);
}

#[test]
fn lines_and_bytes_are_told() {
    let cases = [
        (
            MeshFormat::Obj,
            "v 0 0 0\nv 1 x 0\n",
            "line 2: `x` is no number (a vertex is `v X Y Z`, with decimal numbers)",
        ),
        (
            MeshFormat::Obj,
            "v 0 0 0\nf 1 1 b/2\n",
            "line 2: `b/2` is no vertex number",
        ),
        (
            MeshFormat::Stl,
            "solid a\nfacet\nvertex 0 0 y\n",
            "line 3: `y` is no coordinate",
        ),
        (
            MeshFormat::Stl,
            "solid a\nfacet\nvertex 0 0 0\nendfacet\nendsolid",
            "line 4: `endfacet` after 1 vertices",
        ),
        (
            MeshFormat::Stl,
            "solid a\nfacet\n",
            "line 3: the text ends without `endsolid`",
        ),
        (
            MeshFormat::Ply,
            "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 q\n",
            "line 8: this is no element `vertex`",
        ),
    ];
    for (format, text, expected) in cases {
        let found = refused(text.as_bytes(), format);
        assert!(found.starts_with(expected), "{found}");
    }
}

#[test]
fn obj_counts_back_continues_lines_and_takes_polygons() {
    let text = "# a\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nf -4 -3 \\\n  -2/1/1 4//2 # end\nf 1 2 9\n";
    let mesh = read(text.as_bytes(), MeshFormat::Obj, Limits::default()).expect("a mesh");
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [0, 1, 8]]);
    assert_eq!(mesh.place(1), "line 6");
    assert_eq!(mesh.place(2), "line 8");
    assert_eq!(mesh.notes.len(), 1);
}
