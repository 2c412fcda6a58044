//! Letters against OpenSCAD 2021.01's meshes of the same texts in the same font.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;

use io::read::{FileRefusal, Files, FontFile, ReadOptions, scad_csg};
use stages::convert_model;
use subdiv::Rule;

/// One font, under every name.
struct Letters;

impl Files for Letters {
    fn read(&self, _: &str) -> Result<Vec<u8>, FileRefusal> {
        Err(FileRefusal {
            message: "no files".to_owned(),
            remedy: String::new(),
        })
    }

    fn font(&self, name: &str) -> Result<FontFile, FileRefusal> {
        let bytes = include_bytes!("../fixtures/third_party/dejavu/letters.ttf");
        Ok(FontFile {
            bytes: bytes.to_vec(),
            index: 0,
            name: "letters".to_owned(),
            is_substitute: name != "DejaVu Sans",
        })
    }
}

/// Volume, box, solids and genus of what OpenSCAD makes of an extrusion by 1.
fn matches(arguments: &str, volume: f64, [low, high]: [[f64; 2]; 2], counts: (usize, u64)) {
    let source = format!("linear_extrude(height = 1) text({arguments}, font = \"DejaVu Sans\");");
    let read = scad_csg::read_with(&source, "t.csg", &ReadOptions::default(), &Letters).unwrap();
    assert_eq!(read.warnings, []);
    let found = convert_model(&read.model, Rule::Tolerance(0.01));
    let measured = found.properties.volume;
    // OpenSCAD rounds to thousandths, and hints.
    assert!(
        (measured - volume).abs() < 1e-3 * volume,
        "{arguments}: {measured}"
    );
    let points = || found.brep.vertices().map(brep::VertexView::position);
    for (axis, (low, high)) in low.into_iter().zip(high).enumerate() {
        let least = points().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let most = points().map(|p| p[axis]).fold(f64::NEG_INFINITY, f64::max);
        let off = (least - low).abs().max((most - high).abs());
        assert!(off < 4e-3, "{arguments}: {least} to {most}");
    }
    assert_eq!(
        (found.shells.solids.len(), found.shells.genus()),
        counts,
        "{arguments}"
    );
}

#[test]
fn letters_are_where_openscad_puts_them() {
    matches(
        "\"Hello, OpenSCAD! AVTo\", size = 10",
        470.596_324,
        [[1.362_99, -2.886_4], [158.186, 10.553_6]],
        (19, 9),
    );
    matches(
        "\"gb\", size = 12, valign = \"bottom\"",
        92.173_425_8,
        [[0.919_556, -0.081_176_8], [19.998_8, 16.046_8]],
        (2, 2),
    );
}

#[test]
fn another_font_is_a_warning() {
    let source = "linear_extrude(height = 1) text(\"gb\", font = \"Gone:style=Bold\");";
    let read = scad_csg::read_with(source, "t.csg", &ReadOptions::default(), &Letters).unwrap();
    let [told] = &read.warnings[..] else {
        panic!("{:?}", read.warnings)
    };
    let told = told.to_string();
    assert!(
        told.contains("the font \"Gone:style=Bold\" is not on this machine"),
        "{told}"
    );
    let source = "linear_extrude(height = 1) text(\"g\u{416}\", font = \"DejaVu Sans\");";
    let read = scad_csg::read_with(source, "t.csg", &ReadOptions::default(), &Letters).unwrap();
    assert!(
        read.warnings[0]
            .to_string()
            .contains("no letters for 1 of the characters")
    );
}
