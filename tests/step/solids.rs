//! Solids with formulas, and solids that OpenCASCADE builds itself.

use crate::opencascade::{Part, StepFile, python};
use crate::stages::{Converted, convert, convert_solid, read};
use csg::Solid;
use io::write::step::{self, Outcome};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use subdiv::{Rule, Settings};
use tempfile::TempDir;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// Relative error that volumes and areas may have.
const EXACT: f64 = 1e-6;

/// A model on its way into a STEP file.
pub(crate) struct Written {
    source: String,
    solid: Solid,
    topology: Converted,
    pub(crate) outcome: Outcome,
    bytes: Vec<u8>,
}

/// What counts as small, relative to the diagonal.
pub(crate) const TOLERANCE: f64 = 0.005;

fn options(solid: &Solid, finest: f64) -> step::Options {
    step::Options {
        millimetres_per_unit: 1.0,
        tolerance: 1e-7 * solid.extent.diagonal().max(1e-3),
        crumb_size: finest,
        name: "part".to_owned(),
    }
}

/// As the program does it: topology from the proved subdivision, facets from the metric one.
fn write(source: &str, tolerance: f64) -> Written {
    let solid = Solid::build(&read(source), None).unwrap();
    let diagonal = solid.extent.diagonal().max(1e-3);
    let finest = tolerance * diagonal;
    let rule = Rule::Topology { finest };
    let topology = convert_solid(solid.clone(), &Settings::new(rule));
    let options = options(&solid, finest);
    let plan = step::Plan::of(&solid, &topology.brep, options).unwrap();
    let facets = plan.needs_facets().then(|| convert(source, finest).brep);
    let mut bytes = Vec::new();
    let outcome = plan
        .write(facets.as_ref().unwrap_or(&topology.brep), &mut bytes)
        .unwrap();
    Written {
        source: source.to_owned(),
        solid,
        topology,
        outcome,
        bytes,
    }
}

/// Writes models, and lets OpenCASCADE read them.
pub(crate) fn reread(sources: &[(String, String)], tolerance: f64) -> Vec<(Written, StepFile)> {
    let folder = TempDir::new().unwrap();
    let (written, paths): (Vec<Written>, Vec<PathBuf>) = sources
        .par_iter()
        .map(|(name, source)| {
            let written = write(source, tolerance);
            let path = folder.path().join(name).with_extension("step");
            fs::write(&path, &written.bytes).unwrap();
            (written, path)
        })
        .unzip();
    let names: Vec<&str> = paths.iter().map(|path| path.to_str().unwrap()).collect();
    let reports = python::<StepFile>(&names);
    assert_eq!(reports.len(), sources.len());
    written.into_iter().zip(reports).collect()
}

pub(crate) fn near(found: f64, expected: f64) -> bool {
    (found - expected).abs() <= EXACT * expected.abs()
}

/// What must hold of every file: one valid solid for each of ours, and a volume between the
/// bounds that a subdivision proves.
pub(crate) fn check(name: &str, written: &Written, file: &StepFile, tolerance: f64) {
    let Written {
        source,
        solid,
        topology,
        outcome,
        ..
    } = written;
    assert_eq!(file.error, None, "{name}");
    assert_eq!(file.loose, 0, "{name}: {file:?}");
    let is_true = |part: &&brep::Solid| {
        let bounds = topology.shells.shells[part.outer.0 as usize].bounds;
        (bounds.max - bounds.min).length() > tolerance * solid.extent.diagonal()
    };
    let count = topology.shells.solids.iter().filter(is_true).count();
    assert_eq!(file.solids.len(), count, "{name}: {file:?}");
    let is_valid = file.solids.iter().all(|part| part.valid);
    assert!(is_valid, "{name}: {outcome:?} {file:?}");
    if count == 0 {
        return;
    }
    let finest = tolerance * solid.extent.diagonal();
    let metric = convert(source, TOLERANCE * solid.extent.diagonal());
    let [low, high] = metric.report.volume_interval.unwrap();
    let slack = if outcome.faceted.is_empty() {
        EXACT * high
    } else {
        finest * metric.properties.area
    };
    let volume: f64 = file.solids.iter().map(|part| part.volume).sum();
    assert!(
        volume >= low - slack && volume <= high + slack,
        "{name}: {low} to {high} {file:?}"
    );
}

const TURNED: &str = "multmatrix([[1,0,0,0],[0,0.62160996827066440,0.78332690962748330,0],\
                      [0,-0.78332690962748330,0.62160996827066440,0],[0,0,0,1]])";

#[test]
fn volumes_and_areas_are_those_of_the_formulas() {
    let eccentricity = 3.0_f64.sqrt() / 2.0;
    let spheroid = 2.0 * PI * (1.0 + 2.0 / eccentricity * eccentricity.asin());
    let cap = PI * 4.0 * (3.0 * 2.0 - 2.0) / 3.0;
    let models = [
        ("cube", "cube(size=[1,2,3]);".to_owned(), 6.0, 22.0, "plane 6"),
        ("sphere", "sphere(r=2);".to_owned(), PI * 32.0 / 3.0, PI * 16.0, "sphere 1"),
        ("torus", "torus(r1=3, r2=1);".to_owned(), PI * PI * 6.0, PI * PI * 12.0, "torus 1"),
        ("cylinder", format!("{TURNED} cylinder(h=3, r=2);"), PI * 12.0, PI * 20.0, "cylinder 1 plane 2"),
        ("cone", "cylinder(h=4, r1=3, r2=0);".to_owned(), PI * 12.0, PI * 24.0, "cone 1 plane 1"),
        ("frustum", "cylinder(h=4, r1=4, r2=1);".to_owned(), PI * 28.0, PI * 42.0, "cone 1 plane 2"),
        (
            "cap",
            "intersection() { sphere(r=2); multmatrix([[1,0,0,-5],[0,1,0,-5],[0,0,1,0],[0,0,0,1]]) \
             cube(size=[10,10,10]); }"
                .to_owned(),
            cap,
            PI * 12.0,
            "plane 1 sphere 1",
        ),
        (
            "spheroid",
            "multmatrix([[2,0,0,5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) sphere(r=1);".to_owned(),
            PI * 8.0 / 3.0,
            spheroid,
            "bsplinesurface 1",
        ),
        (
            "cavity",
            "difference() { cube(size=[4,4,4], center=true); sphere(r=1); }".to_owned(),
            64.0 - PI * 4.0 / 3.0,
            96.0 + PI * 4.0,
            "plane 6 sphere 1",
        ),
        (
            "slot",
            "union() { multmatrix([[1,0,0,0],[0,1,0,-1],[0,0,1,0],[0,0,0,1]]) cube(size=[3,2,1]); \
             cylinder(h=1, r=1); }"
                .to_owned(),
            6.0 + PI / 2.0,
            (6.0 + PI / 2.0) * 2.0 + 8.0 + PI,
            "cylinder 1 plane 5",
        ),
    ];
    let sources: Vec<(String, String)> = models
        .iter()
        .map(|(name, source, ..)| ((*name).to_owned(), source.clone()))
        .collect();
    let files = reread(&sources, TOLERANCE);
    for ((name, _, volume, area, surfaces), (written, file)) in models.iter().zip(files) {
        check(name, &written, &file, TOLERANCE);
        assert!(
            written.outcome.faceted.is_empty(),
            "{name}: {:?}",
            written.outcome
        );
        let part = &file.solids[0];
        let kinds: Vec<String> = part
            .surfaces
            .iter()
            .map(|(k, n)| format!("{k} {n}"))
            .collect();
        assert_eq!(kinds.join(" "), *surfaces, "{name}");
        assert!(
            near(part.volume, *volume) && near(part.area, *area),
            "{name}: {part:?}"
        );
    }
}

#[test]
fn opencascade_builds_the_same_solids() {
    let models = [
        (
            "two_balls",
            "union() { sphere(r=10); multmatrix([[1,0,0,9],[0,1,0,3],[0,0,1,2],[0,0,0,1]]) sphere(r=8); }",
        ),
        (
            "cross_drilled",
            "difference() { cylinder(h=20, r=6, center=true); multmatrix([[0,0,1,0],[0,1,0,0],[-1,0,0,0],[0,0,0,1]]) cylinder(h=20, r=3, center=true); }",
        ),
        (
            "ball_in_box",
            "intersection() { sphere(r=10); multmatrix([[1,0,0,-7],[0,1,0,-8],[0,0,1,-6],[0,0,0,1]]) cube(size=[15,16,11]); }",
        ),
        (
            "drilled_ball",
            "difference() { sphere(r=10); multmatrix([[1,0,0,3],[0,1,0,2],[0,0,1,0],[0,0,0,1]]) cylinder(h=40, r=4, center=true); }",
        ),
        (
            "torus_and_ball",
            "union() { torus(r1=10, r2=3); multmatrix([[1,0,0,9],[0,1,0,2],[0,0,1,1],[0,0,0,1]]) sphere(r=4); }",
        ),
        (
            "cut_torus",
            "difference() { torus(r1=10, r2=3); multmatrix([[1,0,0,-20],[0,1,0,-20],[0,0,1,1],[0,0,0,1]]) cube(size=[40,40,10]); }",
        ),
        (
            "torus_and_pipe",
            "difference() { torus(r1=10, r2=4); multmatrix([[1,0,0,9],[0,1,0,1],[0,0,1,0],[0,0,0,1]]) cylinder(h=40, r=2, center=true); }",
        ),
        (
            "cone_in_box",
            "difference() { cylinder(h=16, r1=9, r2=3, center=true); multmatrix([[1,0,0,2],[0,1,0,-20],[0,0,1,-3],[0,0,0,1]]) cube(size=[30,40,6]); }",
        ),
        (
            "cone_and_pipe",
            "union() { cylinder(h=16, r1=9, r2=3, center=true); multmatrix([[0,0,1,0],[0,1,0,1],[-1,0,0,-1],[0,0,0,1]]) cylinder(h=40, r=3, center=true); }",
        ),
        (
            "pocket",
            "difference() { cube(size=[20,20,10], center=true); multmatrix([[1,0,0,2],[0,1,0,1],[0,0,1,5],[0,0,0,1]]) sphere(r=6); }",
        ),
        (
            "steps",
            "union() { cube(size=[20,20,10], center=true); multmatrix([[1,0,0,-5],[0,1,0,-4],[0,0,1,0],[0,0,0,1]]) cube(size=[30,6,9]); }",
        ),
    ];
    let sources: Vec<(String, String)> = models
        .iter()
        .map(|&(name, source)| (name.to_owned(), source.to_owned()))
        .collect();
    let mut arguments = vec!["--reference"];
    arguments.extend(models.iter().map(|&(name, _)| name));
    let expected = python::<Part>(&arguments);
    for ((written, file), (expected, (name, _))) in reread(&sources, TOLERANCE)
        .iter()
        .zip(expected.iter().zip(&models))
    {
        check(name, written, file, TOLERANCE);
        assert!(
            written.outcome.faceted.is_empty(),
            "{name}: {:?}",
            written.outcome
        );
        let part = &file.solids[0];
        assert!(
            near(part.volume, expected.volume) && near(part.area, expected.area),
            "{name}: {part:?} {expected:?}"
        );
    }
}

#[test]
fn the_classic_demo_has_six_planes_six_cylinder_faces_and_one_sphere() {
    let source = fs::read_to_string(Path::new(ROOT).join("fixtures/solids/S2_demo.csg")).unwrap();
    let files = reread(&[("demo".to_owned(), source)], TOLERANCE);
    let (written, file) = &files[0];
    check("demo", written, file, TOLERANCE);
    assert!(written.outcome.faceted.is_empty(), "{:?}", written.outcome);
    let expected = [("cylinder", 6), ("plane", 6), ("sphere", 1)];
    let expected = expected.map(|(kind, count)| (kind.to_owned(), count));
    assert_eq!(file.solids[0].surfaces, BTreeMap::from(expected));
}

#[test]
fn the_same_solid_gives_the_same_bytes_without_a_date() {
    let source = "color([1,0,0,0.5]) sphere(r=1);";
    let first = write(source, TOLERANCE).bytes;
    assert_eq!(first, write(source, TOLERANCE).bytes);
    let text = String::from_utf8(first).unwrap();
    assert!(text.contains("SPHERICAL_SURFACE") && text.contains("COLOUR_RGB"));
    assert!(text.contains("csg2brep"));
}

#[test]
fn elliptic_cylinders_are_swept_ellipses() {
    let source = "difference() { multmatrix([[2,0,0,1],[0,1,0,2],[0,0,1,0],[0,0,0,1]]) \
                  cylinder(h=6, r=1); multmatrix([[1,0,0,0.5],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) \
                  cube(size=[3,4,3]); }";
    let files = reread(&[("elliptic".to_owned(), source.to_owned())], TOLERANCE);
    let (written, file) = &files[0];
    check("elliptic", written, file, TOLERANCE);
    assert!(written.outcome.faceted.is_empty(), "{:?}", written.outcome);
    // A segment of the unit circle from x = -1/4 on, stretched by 2, is missing from half of it.
    let segment = PI / 2.0 + 0.25 * (1.0 - 0.0625_f64).sqrt() + 0.25_f64.asin();
    let part = &file.solids[0];
    assert!(near(part.volume, 12.0 * PI - 6.0 * segment), "{part:?}");
    assert_eq!(part.surfaces["surfaceofextrusion"], 1);
}

#[test]
fn surfaces_without_a_true_form_are_named_and_written_as_facets() {
    let source = "polynomial(\"x^4 + y^4 + z^4 - 1\");";
    let files = reread(&[("quartic".to_owned(), source.to_owned())], TOLERANCE);
    let (written, file) = &files[0];
    check("quartic", written, file, TOLERANCE);
    let outcome = &written.outcome;
    assert_eq!(outcome.faceted.len(), 1);
    assert!(
        outcome.faceted[0].reason.contains("of degree 4"),
        "{outcome:?}"
    );
    assert!(file.solids[0].surfaces["plane"] > 100);
}
