//! Our files in the eyes of other programs.

mod stages;
mod support;

use brep::Shading;
use io::write::{Unit, gltf, obj, ply, threemf};
use stages::{Converted, convert};
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;
use support::{file_reports, manifold_report};
use tempfile::TempDir;

const MODELS: [(&str, &str); 6] = [
    ("cube", "cube(size=[1,2,3], center=true);"),
    (
        "cavity",
        "difference() { cube(size=[4,4,4], center=true); sphere(r=1); }",
    ),
    (
        "drilled",
        "difference() { sphere(r=2); cylinder(h=9, r1=0.8, r2=0.8, center=true); }",
    ),
    (
        "coloured",
        "union() { color([1,0,0,1]) { sphere(r=1); } color([0,0,1,1]) { cube(size=[1,1,1]); } }",
    ),
    (
        "apart",
        "union() { sphere(r=1); multmatrix([[1,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(); } }",
    ),
    (
        "empty",
        "difference() { sphere(r=1); cube(size=[9,9,9], center=true); }",
    ),
];

fn write(folder: &TempDir, name: &str, converted: &Converted) -> [PathBuf; 2] {
    let [obj, glb] = ["obj", "glb"].map(|end| folder.path().join(format!("{name}.{end}")));
    let create = |path: &PathBuf| BufWriter::new(File::create(path).expect("a new file"));
    let brep = &converted.brep;
    let shading = Shading::on_surfaces(brep, &converted.solid);
    let options = obj::Options::default();
    obj::write_shaded(brep, &shading, &options, &mut create(&obj)).expect("an OBJ file");
    let materials = &converted.solid.materials;
    let options = gltf::Options::default();
    gltf::write(brep, materials, &options, &mut create(&glb)).expect("a GLB file");
    [obj, glb]
}

#[test]
fn manifold_accepts_what_we_write() {
    let folder = tempfile::tempdir().expect("a folder");
    let converted: Vec<Converted> = MODELS
        .iter()
        .map(|(_, source)| convert(source, 0.02))
        .collect();
    let paths: Vec<PathBuf> = MODELS
        .iter()
        .zip(&converted)
        .flat_map(|((name, _), converted)| write(&folder, name, converted))
        .collect();
    let reports = manifold_report(&paths);
    assert_eq!(reports.len(), paths.len());
    for (report, converted) in reports.iter().zip(converted.iter().flat_map(|c| [c, c])) {
        let properties = &converted.properties;
        assert_eq!(report.status, "NoError", "{report:?}");
        assert_eq!(
            report.triangles,
            Some(converted.brep.facet_count()),
            "{report:?}"
        );
        assert_eq!(
            report.components,
            Some(converted.shells.shells.len()),
            "{report:?}"
        );
        assert_eq!(
            report.genus,
            i64::try_from(converted.shells.genus()).ok(),
            "{report:?}"
        );
        // A GLB file rounds positions by 2⁻²⁴ of their size, below 6 here.
        let rounding = if report.file.extension().is_some_and(|end| end == "obj") {
            1e-12
        } else {
            4e-7
        };
        let volume = report.volume.expect("a volume");
        let allowed = rounding * properties.area.max(1.0);
        assert!((volume - properties.volume).abs() <= allowed, "{report:?}");
        let area = report.area.expect("an area");
        assert!(
            (area - properties.area).abs() <= 1e3 * allowed,
            "{report:?}"
        );
    }
}

#[test]
fn manifold_refuses_a_file_with_a_hole() {
    let folder = tempfile::tempdir().expect("a folder");
    let [obj, _] = write(&folder, "cube", &convert(MODELS[0].1, 0.02));
    let text = fs::read_to_string(&obj).expect("a text");
    let last = text.trim_end().rfind('\n').expect("many lines");
    fs::write(&obj, &text[..=last]).expect("a shorter file");
    let missing = folder.path().join("missing.obj");
    let reports = manifold_report(&[obj, missing]);
    assert_eq!(reports[0].status, "NotManifold");
    assert_eq!(reports[1].status, "Unreadable");
}

#[test]
fn lib3mf_and_plyfile_find_what_we_wrote() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, source) in MODELS {
        let Converted {
            brep,
            solid,
            properties,
            shells,
            ..
        } = &convert(source, 0.02);
        let [path_3mf, path_ply] =
            ["3mf", "ply"].map(|end| folder.path().join(format!("{name}.{end}")));
        let create = |path: &PathBuf| BufWriter::new(File::create(path).expect("a new file"));
        let options = threemf::Options { unit: Unit::Inch };
        threemf::write(brep, &solid.materials, &options, &mut create(&path_3mf))
            .expect("a 3MF file");
        let options = ply::Options::default();
        ply::write(brep, &solid.materials, &options, &mut create(&path_ply)).expect("a PLY file");
        let reports = file_reports(&[path_3mf, path_ply]);

        let colours = match name {
            "empty" => 0,
            "coloured" => 2,
            _ => 1,
        };
        // lib3mf stores positions as 32-bit numbers, below 6 here: 2⁻²⁴ of their size.
        for (report, rounding) in reports.iter().zip([4e-7, 1e-12]) {
            assert_eq!(report.vertices, brep.vertex_count(), "{name}: {report:?}");
            assert_eq!(report.triangles, brep.facet_count(), "{name}: {report:?}");
            assert_eq!(report.materials, colours, "{name}: {report:?}");
            let allowed = rounding * properties.area.max(1.0);
            let difference = report.volume - properties.volume;
            assert!(difference.abs() <= allowed, "{name}: {report:?}");
        }
        assert_eq!(reports[0].warnings, Some(0), "{name}");
        assert_eq!(reports[0].manifold, Some(true), "{name}");
        let solids = shells.solids.len();
        let names = (1..=solids).map(|number| format!("solid_{number}"));
        assert_eq!(reports[0].objects, names.collect::<Vec<_>>(), "{name}");
        assert_eq!(reports[0].built, Some(solids.min(1)), "{name}");
        // eModelUnit::Inch of lib3mf.
        assert_eq!(reports[0].unit, Some(3), "{name}");
    }
}
