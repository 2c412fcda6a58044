//! `import` and `surface`, with files in memory.

use super::{contains, lines};
use crate::read::{Diagnostics, FileRefusal, Files, FontFile, ReadOptions, Reading, scad_csg};
use glam::DVec3;

/// Files by name.
struct Memory(Vec<(&'static str, Vec<u8>)>);

impl Files for Memory {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileRefusal> {
        let found = self.0.iter().find(|(name, _)| *name == path);
        found.map(|(_, bytes)| bytes.clone()).ok_or(FileRefusal {
            message: "it does not exist".to_owned(),
            remedy: "put it there".to_owned(),
        })
    }

    fn font(&self, name: &str) -> Result<FontFile, FileRefusal> {
        Ok(FontFile {
            bytes: include_bytes!("../../../../../fixtures/third_party/dejavu/letters.ttf")
                .to_vec(),
            index: 0,
            name: "Letters".to_owned(),
            is_substitute: !name.is_empty(),
        })
    }
}

pub(super) fn read(
    text: &str,
    files: Vec<(&'static str, Vec<u8>)>,
) -> Result<Reading, Diagnostics> {
    scad_csg::read_with(text, "t.csg", &ReadOptions::default(), &Memory(files))
}

/// Whether points lie in the solid.
fn holds(reading: &Reading, points: &[[f64; 3]]) -> Vec<bool> {
    let model = &reading.model;
    let at = points
        .iter()
        .map(|p| contains(model, model.root(), DVec3::from(*p)));
    at.collect()
}

fn told(result: Result<Reading, Diagnostics>) -> String {
    lines(result.expect_err("unreadable").as_slice()).join("\n")
}

pub(super) const TETRAHEDRON: &str = "OFF # a corner of the unit cube\n4 4 6\n0 0 0\n1 0 0\n\n0 1 0\n0 0 1\n\
                           3 0 2 1 255 0 0\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// Binary STL of the same, its 32-bit corners equal where they meet.
fn stl() -> Vec<u8> {
    let corners = [
        [0.0_f32, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
    ];
    let mut bytes = vec![b' '; 80];
    bytes.extend(4_u32.to_le_bytes());
    for face in [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] {
        bytes.extend([0; 12]);
        bytes.extend(
            face.into_iter()
                .flat_map(|v: usize| corners[v])
                .flat_map(f32::to_le_bytes),
        );
        bytes.extend([0; 2]);
    }
    bytes
}

const AMF: &str = r#"<?xml version="1.0"?><amf unit="millimeter"><object id="0"><mesh><vertices>
<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex>
<vertex><coordinates><x>0</x><y>0</y><z> 1 </z></coordinates></vertex></vertices>
<volume><triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle><triangle><v1>0</v1><v2>1</v2><v3>3</v3></triangle>
<triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle><triangle><v1>1</v1><v2>2</v2><v3>3</v3></triangle></volume>
</mesh></object></amf>"#;

#[test]
fn meshes_are_imported_as_polyhedra() {
    for (name, bytes) in [
        ("t.off", TETRAHEDRON.into()),
        ("sub/t.AMF", AMF.into()),
        ("t.obj", OBJ.into()),
        ("t.stl", stl()),
    ] {
        let node = format!(
            "import(file = \"{name}\", layer = \"\", origin = [0, 0], scale = 1, timestamp = 1);"
        );
        let reading = read(&node, vec![(name, bytes)]).expect("sound");
        assert!(reading.warnings.is_empty(), "{:?}", reading.warnings);
        let found = holds(
            &reading,
            &[
                [0.2, 0.2, 0.2],
                [0.32, 0.32, 0.32],
                [0.35, 0.35, 0.35],
                [-0.1, 0.2, 0.2],
            ],
        );
        assert_eq!(found, [true, true, false, false], "{name}");
    }
}

#[test]
fn what_cannot_be_imported_is_told() {
    let cases: [(&str, &str, &str); 10] = [
        (
            "nix.off",
            "",
            "\"nix.off\": it does not exist (put it there)",
        ),
        ("t.dxf", "", "\"t.dxf\" is a drawing, which is not read"),
        ("t.xyz", "", "\"t.xyz\" is no mesh that can be imported"),
        ("t.off", "", "the file is empty"),
        ("t.off", "NOFF\n", "line 1: no OFF header"),
        (
            "t.off",
            "OFF\n3 9999999999999999999999 0",
            "line 2: the counts",
        ),
        (
            "t.off",
            "OFF 3 1 0\n0 0 0\n0 0 x\n",
            "line 3: a vertex needs three numbers",
        ),
        (
            "t.off",
            "OFF 3 1 0\n0 0 0\n0 0 1\n1 0 0\n9999999999 0 1 2",
            "line 5: a corner of the face is missing",
        ),
        (
            "t.off",
            "OFF 4000000000 1 0\n0 0 0\n",
            "after 1 of 4000000000 vertices",
        ),
        (
            "t.amf",
            "<amf><object><triangle><v1>0</v1></triangle>",
            "a triangle needs v1, v2 and v3",
        ),
    ];
    for (name, text, expected) in cases {
        let files = match name {
            "nix.off" => Vec::new(),
            _ => vec![(name, text.into())],
        };
        let told = told(read(&format!("import(\"{name}\");"), files));
        assert!(told.contains(expected), "{told}");
    }
    let open = TETRAHEDRON.replace("4 4 6", "4 3 6");
    let error = told(read("import(\"t.off\");", vec![("t.off", open.into())]));
    assert!(error.contains("the polyhedron is open"), "{error}");
    let nothing = read("import(file = \"\"); surface(file = \"\");", Vec::new()).expect("nothing");
    assert_eq!(nothing.warnings.len(), 2);
}

/// As OpenSCAD 2021.01: rows along y, the bottom 1 below the lowest height but at most at 0;
/// in the middle of a square the mean of its corners.
#[test]
fn heights_stand_where_openscad_puts_them() {
    let files = || vec![("h.dat", b"# heights\n5 6 7\n\n7 8 9\n".to_vec())];
    let reading = read(
        "surface(file = \"h.dat\", center = false, invert = false);",
        files(),
    );
    let found = holds(
        &reading.expect("sound"),
        &[
            [0.5, 0.5, 6.49],
            [0.5, 0.5, 6.51],
            [1.9, 0.9, 8.6],
            [0.1, 0.1, 0.01],
            [0.1, 0.1, -0.01],
            [2.1, 0.5, 1.0],
        ],
    );
    assert_eq!(found, [true, false, true, true, false, false]);
    let files = vec![("h.dat", b"-5 6\n7 8 9\n".to_vec())];
    let reading = read("surface(file = \"h.dat\", center = true);", files).expect("sound");
    // The missing height is 0, the bottom −6.
    let found = holds(
        &reading,
        &[
            [0.9, -0.45, 1.0],
            [0.9, -0.45, -0.5],
            [-0.9, -0.45, -5.9],
            [-0.9, -0.45, -6.1],
        ],
    );
    assert_eq!(found, [false, true, true, false]);
}

/// Red, green, blue above white, black and a grey-blue: OpenSCAD 2021.01 puts the heights 100, 0,
/// 56.0706 at y = 0 and 21.26, 71.52, 7.22 at y = 1.
#[test]
fn pictures_are_heights() {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
    encoder.set_color(png::ColorType::Rgb);
    let pixels = [
        255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255, 0, 0, 0, 100, 150, 200,
    ];
    let mut writer = encoder.write_header().expect("memory");
    writer.write_image_data(&pixels).expect("memory");
    writer.finish().expect("memory");
    let read = |invert: bool| {
        let text = format!("surface(file = \"h.png\", invert = {invert});");
        read(&text, vec![("h.png", bytes.clone())]).expect("sound")
    };
    let e = 1e-3;
    let corners = [
        [e, e, 99.5],
        [e, 1.0 - e, 21.0],
        [e, 1.0 - e, 21.5],
        [2.0 - e, e, 55.8],
        [2.0 - e, e, 56.2],
        [1.0, 1.0 - e, 71.3],
    ];
    assert_eq!(
        holds(&read(false), &corners),
        [true, true, false, true, false, true]
    );
    let corners = [
        [e, e, -99.4],
        [e, e, -99.8],
        [1.0, e, 0.2],
        [1.0, e, 0.6],
        [e, e, -100.5],
        [e, e, -100.7],
    ];
    assert_eq!(
        holds(&read(true), &corners),
        [false, true, true, false, true, false]
    );
    let damaged = scad_csg::read_with(
        "surface(file = \"h.png\");",
        "t.csg",
        &ReadOptions::default(),
        &Memory(vec![("h.png", bytes[..40].to_vec())]),
    );
    assert!(told(damaged).contains("cannot read \"h.png\""));
}
