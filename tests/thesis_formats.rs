//! The thesis' files: every fixture saved and read again, both byte orders, and every way to cut
//! or spoil a file that a Python script assembled from the thesis' text.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;
mod support;

use csg::Solid;
use glam::DVec3;
use io::thesis::solid::{self, MatrixForm};
use io::thesis::tree::Operators;
use io::thesis::{ByteOrder, Decoded, Error, Problem};
use io::thesis::{approximation, sectors, subdivision, wireframe};
use std::fs;
use std::path::{Path, PathBuf};

/// Deterministic numbers from 0 to 1 (SplitMix64).
struct Numbers(u64);

impl Iterator for Numbers {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Some(((x ^ (x >> 31)) >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// All models of the fixtures, those that OpenSCAD's own tests consist of included.
fn fixtures() -> Vec<PathBuf> {
    let more = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/third_party/openscad_more");
    let files = fs::read_dir(more).unwrap().map(|file| file.unwrap().path());
    let models = files.filter(|path| path.extension().is_some_and(|end| end == "csg"));
    let mut all = stages::models();
    all.extend(models);
    all.sort();
    all
}

/// Whether `float` coefficients and a `float` matrix, each rounded by 2⁻²⁴, may move a surface
/// across a point: a value moves by the sum of the coefficients times that, and by the slope, at
/// most degree times that sum, where the point itself moves.
fn is_undecided(solid: &Solid, point: DVec3) -> bool {
    let at = solid.domain.to_centered(point);
    let reach = 1.0 + solid.domain.center().abs().max_element() / solid.domain.half_size();
    solid.primitives.iter().any(|primitive| {
        let polynomial = &primitive.polynomial;
        let sum: f64 = polynomial.coefficients().iter().map(|c| c.abs()).sum();
        let moved = 1.0 + polynomial.degree() as f64 * 3.0 * reach;
        polynomial.evaluate(at).abs() <= 2.0_f64.powi(-23) * sum * moved
    })
}

/// Any solid can be saved as `.CSG`: in both forms of matrices and both byte orders 2,000 random
/// points in and around it are in or out as before.
#[test]
fn every_fixture_is_the_same_solid_after_saving() {
    const POINTS: usize = 2000;
    let (mut inside, mut outside) = (0, 0);
    for (number, path) in fixtures().iter().enumerate() {
        let name = path.file_name().unwrap().to_string_lossy();
        let model = stages::read(&fs::read_to_string(path).unwrap());
        let before = Solid::build(&model, None).unwrap();
        let form = [MatrixForm::Rows, MatrixForm::Columns][number % 2];
        let order = [ByteOrder::Big, ByteOrder::Little][number / 2 % 2];
        let mut bytes = Vec::new();
        let tree = solid::from_solid(&before, form);
        solid::write(&tree, Operators::default(), order, &mut bytes).unwrap();
        let read = solid::read(&bytes, Operators::default(), form).unwrap();
        assert_eq!((read.order, &read.value), (order, &tree), "{name}");
        let model = solid::to_model(&read.value, form).unwrap();
        let after = Solid::build(&model, None).unwrap_or_else(|e| panic!("{name}: {e}"));
        if before.extent.is_empty() {
            assert!(after.extent.is_empty(), "{name}");
            continue;
        }
        let size = before.extent.max - before.extent.min;
        let mut numbers = Numbers(number as u64);
        let mut undecided = 0;
        for _ in 0..POINTS {
            let [x, y, z] = std::array::from_fn(|_| numbers.next().unwrap() * 1.1 - 0.05);
            let point = before.extent.min + size * DVec3::new(x, y, z);
            if is_undecided(&before, point) {
                undecided += 1;
                continue;
            }
            let holds = before.contains(point);
            assert_eq!(after.contains(point), holds, "{name}: {point}");
            *if holds { &mut inside } else { &mut outside } += 1;
        }
        assert!(undecided < POINTS / 20, "{name}: {undecided}");
    }
    assert!(inside > 10_000 && outside > 10_000, "{inside} {outside}");
}

type Outcome = Result<(ByteOrder, String), Error>;

/// Reads a file of the thesis by its extension; what it means as text.
fn read(end: &str, bytes: &[u8]) -> Outcome {
    fn told<T: std::fmt::Debug>(read: Result<Decoded<T>, Error>) -> Outcome {
        read.map(|decoded| (decoded.order, format!("{:?}", decoded.value)))
    }
    let operators = Operators::default();
    match end {
        "CSG" => told(solid::read(bytes, operators, MatrixForm::Rows)),
        "cspg" => told(sectors::read(bytes, operators)),
        "apl" => told(approximation::read(bytes)),
        "sub" => told(subdivision::read(bytes, operators)),
        "wfr" => told(wireframe::read(bytes)),
        _ => panic!("{end}"),
    }
}

const FILES: [(&str, &str); 7] = [
    ("block", "CSG"),
    ("bored", "CSG"),
    ("everything", "CSG"),
    ("sector", "cspg"),
    ("tetrahedron", "apl"),
    ("halves", "sub"),
    ("tetrahedron", "wfr"),
];

/// In both byte orders, each with its name's end and its content.
fn assembled(mut with: impl FnMut(&str, &str, ByteOrder, Vec<u8>)) {
    let folder = support::thesis_files();
    for (name, end) in FILES {
        for (tail, order) in [("", ByteOrder::Big), ("_little", ByteOrder::Little)] {
            let file = format!("{name}{tail}.{end}");
            let bytes = fs::read(folder.path().join(&file)).unwrap();
            with(&file, end, order, bytes);
        }
    }
}

#[test]
fn byte_orders_are_told_apart_and_mean_the_same() {
    let mut last = String::new();
    assembled(|file, end, order, bytes| {
        let (found, meaning) = read(end, &bytes).unwrap();
        assert_eq!(found, order, "{file}");
        if order == ByteOrder::Little {
            assert_eq!(meaning, last, "{file}");
        }
        last = meaning;
    });
}

/// A file may end at any byte; only a list of triangles without a count is complete when it ends
/// between two of them.
#[test]
fn every_cut_is_refused_with_the_place() {
    assembled(|file, end, order, bytes| {
        for length in 0..bytes.len() {
            let outcome = read(end, &bytes[..length]);
            if end == "apl" && length % 76 == 1 {
                assert!(outcome.is_ok(), "{file}: {length}");
                continue;
            }
            let error = outcome.expect_err(file);
            assert!(error.offset <= length, "{file}: {length}: {error}");
            let missing = matches!(
                error.problem,
                Problem::Truncated { .. } | Problem::Count { .. }
            );
            assert!(missing, "{file}: {length}: {error}");
            // Where the first number is complete, the message says how numbers were read.
            if length > 24 {
                let little = order == ByteOrder::Little;
                assert_eq!(error.little_endian, little, "{file}: {length}: {error}");
            }
        }
    });
}

/// The largest count, NaN, −1 and zeros at every byte: whatever comes out comes at once, and a
/// complaint names a place in the file.
#[test]
fn no_number_is_trusted() {
    let spoilers: [&[u8]; 4] = [
        &[0x7f, 0xff, 0xff, 0xff],
        &[0x7f, 0xf8, 0, 0, 0, 0, 0, 1],
        &[0xff; 4],
        &[0; 8],
    ];
    let mut refused = 0;
    assembled(|file, end, _, bytes| {
        for at in 0..bytes.len() {
            for spoiler in spoilers {
                let mut spoiled = bytes.clone();
                let length = spoiler.len().min(bytes.len() - at);
                spoiled[at..at + length].copy_from_slice(&spoiler[..length]);
                if let Err(error) = read(end, &spoiled) {
                    assert!(error.offset <= bytes.len(), "{file}: {at}: {error}");
                    refused += 1;
                }
            }
        }
    });
    assert!(refused > 5000, "{refused}");
}

/// Runs the program in a folder; its standard output.
fn out(folder: &Path, args: &[&str]) -> Vec<u8> {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("csg2brep");
    let output = command.current_dir(folder).args(args).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {said}");
    output.stdout
}

/// What a report says of the solid: its volume, area, shells and solids.
fn measured(report: &[u8]) -> [f64; 4] {
    let report: serde_json::Value = serde_json::from_slice(report).unwrap();
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{report}"));
    [
        number(&report["volume"]),
        number(&report["area"]),
        number(&report["counts"]["shells"]),
        number(&report["counts"]["solids"]),
    ]
}

/// Triangles lose nothing but their surfaces: welded, they are the same boundary.
#[test]
fn a_linear_approximation_is_a_boundary_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for fixture in [
        "models/tee",
        "solids/S2_demo",
        "solids/S6_plate64",
        "thesis/manchete",
        "thesis/chupeta",
        "thesis/spheres_008",
    ] {
        let model = format!("{}/fixtures/{fixture}.csg", env!("CARGO_MANIFEST_DIR"));
        let args = [&model, "-o", "a.apl", "--tolerance", "1%", "--report", "-"];
        let before = measured(&out(folder, &args));
        let after = measured(&out(folder, &["a.apl", "-o", "b.apl", "--report", "-"]));
        for (one, other) in before.iter().zip(after) {
            assert!(
                (one / other - 1.0).abs() < 1e-12,
                "{fixture}: {before:?} {after:?}"
            );
        }
        // The same triangles; welding may begin them at another corner and sort them anew.
        let [a, b] = ["a.apl", "b.apl"].map(|name| {
            let faces = approximation::read(&fs::read(folder.join(name)).unwrap()).unwrap();
            let mut corners: Vec<_> = faces
                .value
                .iter()
                .map(|face| {
                    let mut corners = face.corners.map(|corner| corner.map(f64::to_bits));
                    corners.sort_unstable();
                    corners
                })
                .collect();
            corners.sort_unstable();
            corners
        });
        assert!(a == b, "{fixture}");
    }
}

/// A file whose matrices multiply columns is read so by every program that reads `.CSG`.
#[test]
fn matrices_may_multiply_columns() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let model = format!(
        "{}/fixtures/thesis/manchete.csg",
        env!("CARGO_MANIFEST_DIR")
    );
    out(folder, &[&model, "--level", "3", "-o", "rows.CSG"]);
    out(
        folder,
        &[&model, "--level", "3", "--columns", "-o", "columns.CSG"],
    );
    let ways: [&[&str]; 3] = [
        &["--level", "9", "--report", "-"],
        &["info", "--json"],
        &["thesis", "csg2cspg", "-B", "-4", "-4", "-4", "4", "4", "4"],
    ];
    for way in ways {
        let rows = out(folder, &[way, &["rows.CSG"]].concat());
        let columns = out(folder, &[way, &["columns.CSG", "--columns"]].concat());
        if way[0] == "--level" {
            let bits = |report: &[u8]| measured(report).map(f64::to_bits);
            assert_eq!(bits(&rows), bits(&columns));
        } else {
            let [rows, columns] = [rows, columns]
                .map(|b| String::from_utf8_lossy(&b).replace("columns.CSG", "rows.CSG"));
            assert!(rows == columns, "{way:?}");
        }
    }
}

/// Bézier forms are polynomials again: of a ball without a block, by way of every program that
/// writes them, the volume is bracketed, and the faces are those of the solid.
#[test]
fn bezier_forms_are_a_solid_again() {
    let folder = support::thesis_files();
    let folder = folder.path();
    let boxed = [
        "thesis",
        "csg2cspg",
        "-B",
        "-2",
        "-3",
        "-3",
        "4",
        "3",
        "3",
        "bored.CSG",
    ];
    fs::write(folder.join("a.cspg"), out(folder, &boxed)).unwrap();
    let free = [&boxed[..], &["-L"]].concat();
    fs::write(folder.join("b.cspg"), out(folder, &free)).unwrap();
    out(folder, &["bored.CSG", "--level", "3", "-o", "c.cspg"]);
    out(folder, &["c.cspg", "--level", "3", "-o", "d.cspg"]);
    let exact = 32.0 / 3.0 * std::f64::consts::PI - 1.0;
    for name in ["a.cspg", "b.cspg", "c.cspg", "d.cspg"] {
        let report = out(folder, &[name, "--tolerance", "0.3%", "--report", "-"]);
        let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
        let [low, high] = [0, 1].map(|end| report["volume_interval"][end].as_f64().unwrap());
        assert!(low < exact && exact < high, "{name}: {low} {exact} {high}");
        assert_eq!(report["counts"]["shells"], 2, "{name}");
        assert_eq!(report["counts"]["brep_faces"], 7, "{name}");
    }

    // Another value at a corner of the last sector makes it another polynomial.
    let mut bytes = fs::read(folder.join("a.cspg")).unwrap();
    let last = bytes.len() - 8;
    bytes[last..].copy_from_slice(&1.25_f64.to_be_bytes());
    fs::write(folder.join("pieces.cspg"), bytes).unwrap();
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("csg2brep");
    let output = command
        .current_dir(folder)
        .args(["info", "pieces.cspg"])
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("is another polynomial in sector 6"), "{said}");
}

/// LCGRENDERER's mesh, whose numbers are `float`, is a boundary again.
#[test]
fn a_wireframe_is_a_boundary_again() {
    let folder = support::thesis_files();
    let folder = folder.path();
    let tetrahedron = measured(&out(folder, &["tetrahedron.wfr", "--report", "-"]));
    let [volume, area, shells, solids] = tetrahedron;
    assert!((volume - 1.0 / 6.0).abs() < 1e-15 && (area - 1.5 - 0.75_f64.sqrt()).abs() < 1e-15);
    assert!(shells.to_bits() == 1.0_f64.to_bits() && solids.to_bits() == shells.to_bits());
    let args = [
        "bored.CSG",
        "--tolerance",
        "1%",
        "-o",
        "a.wfr",
        "--report",
        "-",
    ];
    let before = measured(&out(folder, &args));
    let after = measured(&out(folder, &["a.wfr", "--report", "-"]));
    for (one, other) in before.iter().zip(after) {
        assert!((one / other - 1.0).abs() < 1e-6, "{before:?} {after:?}");
    }
}
