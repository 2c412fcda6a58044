//! `csg2brep thesis …`: byte files that a Python script assembles from the thesis' text, pipelines
//! of its programs through standard input and output, and solids whose measures are known.

#![expect(
    clippy::unwrap_used,
    reason = "functions that tests share fail as tests do"
)]

mod support;

use std::f64::consts::PI;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the program in a folder, with bytes on standard input.
fn run(folder: &Path, args: &[&str], stdin: &[u8]) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("csg2brep")
        .current_dir(folder)
        .env("HOME", folder)
        .args(args)
        .write_stdin(stdin)
        .output()
        .unwrap()
}

/// The same, for what must succeed: standard output.
fn out(folder: &Path, args: &[&str], stdin: &[u8]) -> Vec<u8> {
    let output = run(folder, args, stdin);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{args:?}: {said}");
    output.stdout
}

/// Runs programs one after the other, each reading what the last one wrote.
fn pipeline(folder: &Path, first: &[u8], programs: &[&[&str]]) -> Vec<u8> {
    programs.iter().fold(first.to_vec(), |bytes, args| {
        let args: Vec<&str> = ["thesis"].iter().chain(*args).copied().collect();
        out(folder, &args, &bytes)
    })
}

/// The number behind `area: ` or `volume: `.
fn measure(printed: &[u8], what: &str) -> f64 {
    let text = std::str::from_utf8(printed).unwrap();
    let number = text.strip_prefix(what).and_then(|t| t.strip_prefix(": "));
    number
        .unwrap_or_else(|| panic!("{text}"))
        .trim()
        .parse()
        .unwrap()
}

/// Volume of a subdivision, and the bounds that full and front simplices give.
fn volume(folder: &Path, tree: &[u8]) -> [f64; 3] {
    let output = run(folder, &["thesis", "propsimpl", "-V", "-v"], tree);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let numbers = said.lines().find_map(|line| line.strip_prefix("between "));
    let (low, high) = numbers.and_then(|n| n.split_once(" and ")).expect("bounds");
    [
        low.parse().unwrap(),
        measure(&output.stdout, "volume"),
        high.parse().unwrap(),
    ]
}

#[test]
fn files_assembled_by_hand_mean_what_the_thesis_says() {
    let folder = support::thesis_files();
    let folder = folder.path();
    for order in ["", "_little"] {
        let read = |name: &str, end: &str| {
            std::fs::read(folder.join(format!("{name}{order}.{end}"))).unwrap()
        };
        let area = out(
            folder,
            &["thesis", "propsimpl", "-A"],
            &read("tetrahedron", "apl"),
        );
        assert!((measure(&area, "area") - (1.5 + 0.75_f64.sqrt())).abs() < 1e-15);
        let half = volume(folder, &read("halves", "sub"));
        assert!((half[1] - 0.125).abs() < 1e-15, "{half:?}");
        let mesh = out(folder, &["thesis", "vis2lcg"], &read("tetrahedron", "apl"));
        assert_eq!(mesh, std::fs::read(folder.join("tetrahedron.wfr")).unwrap());
        // x ≤ ½ cuts a triangle of legs ½ off, and an eighth of the simplex' volume.
        let sector = read("sector", "cspg");
        let cut = pipeline(
            folder,
            &sector,
            &[&["subsimpl", "-N", "6"], &["propsimpl", "-A"]],
        );
        assert!((measure(&cut, "area") - 0.125).abs() < 1e-12);
        let tree = pipeline(
            folder,
            &sector,
            &[&["subsimpl", "-O", "SUBDIVISAO", "-N", "6"]],
        );
        assert!((volume(folder, &tree)[1] - 1.0 / 48.0).abs() < 1e-12);
    }
    let stl = |input: &str| {
        let clip = ["--box", "-6", "-6", "-3", "70", "6", "9"];
        let args = [
            &[input, "-o", "-", "--to", "stl", "--level", "18"][..],
            &clip,
        ]
        .concat();
        out(folder, &args, b"")
    };
    assert_eq!(stl("everything.CSG"), stl("everything_little.CSG"));
}

/// A ball of radius 2 without a unit block: 32π/3 − 1, and 16π + 6 (thesis programs throughout).
#[test]
fn a_pipeline_brackets_volume_and_area() {
    let folder = support::thesis_files();
    let folder = folder.path();
    let solid = std::fs::read(folder.join("bored.CSG")).unwrap();
    let boxed = ["csg2cspg", "-B", "-2", "-3", "-3", "4", "3", "3"];
    let cspg = pipeline(folder, &solid, &[&boxed]);
    let exact = 32.0 / 3.0 * PI - 1.0;
    let tree = pipeline(folder, &cspg, &[&["subsimpl", "-o", "s", "-n", "15"]]);
    let [low, estimate, high] = volume(folder, &tree);
    assert!(low < exact && exact < high, "{low} {exact} {high}");
    // Interpolants of |p|² are too large by at most a quarter of the longest edge squared, so the
    // ball's radius is too small by 0.015; the block's planes are exact.
    assert!(
        estimate < exact && exact - estimate < 16.0 * PI * 0.02,
        "{estimate}"
    );
    let apl = pipeline(folder, &cspg, &[&["subsimpl", "-n", "15"]]);
    let area = measure(
        &pipeline(folder, &apl, &[&["propsimpl", "-V", "-V", "-A"]]),
        "area",
    );
    let exact = 16.0 * PI + 6.0;
    assert!((area / exact - 1.0).abs() < 0.02, "{area} {exact}");

    // The triangles close again, with the cavity.
    std::fs::write(folder.join("again.apl"), &apl).unwrap();
    let report = out(folder, &["again.apl", "--report", "-"], b"");
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!(report["counts"]["shells"], 2);
    assert_eq!(report["counts"]["solids"], 1);
}

/// With -B from −1 to 1 the unbounded plane z ≥ 0 is half of the box; with -L it has no walls.
#[test]
fn the_box_limits_the_solid_unless_l_is_given() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut plane = vec![1, 0, 0, 0, 1, 0, 0, 0, 3];
    for at in 0..16 {
        plane.extend(if at % 5 == 0 { 1.0_f32 } else { 0.0 }.to_be_bytes());
    }
    let bounds = ["-B", "-1", "-1", "-1", "1", "1", "1"];
    let area = |limits: &[&str]| {
        let convert = [&["csg2cspg"][..], limits, bounds.as_slice()].concat();
        let programs: [&[&str]; 3] = [&convert, &["subsimpl", "-N", "9"], &["propsimpl", "-A"]];
        measure(&pipeline(folder, &plane, &programs), "area")
    };
    // Two squares of side 2 and four walls of 2 by 1; the square alone.
    assert!((area(&[]) - 16.0).abs() < 1e-9, "{}", area(&[]));
    assert!((area(&["-L"]) - 4.0).abs() < 1e-9, "{}", area(&["-L"]));
}

#[test]
fn options_mean_what_the_thesis_says() {
    let folder = support::thesis_files();
    let folder = folder.path();
    let sector = std::fs::read(folder.join("bored.CSG")).unwrap();
    let boxed = ["csg2cspg", "-B", "-2", "-3", "-3", "4", "3", "3"];
    let cspg = pipeline(folder, &sector, &[&boxed]);
    let apl = |options: &[&str]| {
        let args = [&["subsimpl"][..], options].concat();
        pipeline(folder, &cspg, &[&args])
    };
    // The longest edge is 6√3: ⌈log₂(6√3 / 1)⌉ = 4 halvings are 12 levels, whatever -N says.
    assert_eq!(apl(&["-T", "1", "-N", "3"]), apl(&["-n", "12"]));
    assert_eq!(
        apl(&["-D"]),
        apl(&["-o", "a", "-p", "0", "-n", "15", "-m", "0"])
    );
    assert_eq!(
        apl(&["-o", "APLIN", "-n", "6"]),
        apl(&["-O", "A", "-N", "6"])
    );
    // Simple regions stay as coarse as level 9, where primitives meet cells are those of level 12.
    let faces = |bytes: &[u8]| bytes.len() / 76;
    let [coarse, mixed, fine] =
        [&["-n", "9"][..], &["-n", "12", "-m", "3"], &["-n", "12"]].map(|o| faces(&apl(o)));
    assert!(coarse < mixed && mixed < fine, "{coarse} {mixed} {fine}");
    let refused = run(folder, &["thesis", "subsimpl", "-E", "-T", "1"], &cspg);
    assert_eq!(refused.status.code(), Some(2));

    let table = |options: &[&str]| String::from_utf8(apl(options)).unwrap();
    let english = table(&["-E", "-N", "3"]);
    assert!(english.starts_with("EXECUTION STATISTICS\n\nSubdivision level:          3.\n"));
    assert!(
        english.contains("Simplices visited:          6 (100.0%).\n"),
        "{english}"
    );
    let portuguese = table(&["-e", "-n", "3", "--portuguese"]);
    assert!(
        portuguese.contains("TOTAIS GERAIS:\nTotal de Simplexos visitados:"),
        "{portuguese}"
    );
}

/// A.2.5, A.3.2, A.6.2: all the letters.
#[test]
fn helps_name_the_options_of_the_thesis() {
    let folder = tempfile::tempdir().unwrap();
    let letters: [(&str, &[&str]); 3] = [
        ("csg2cspg", &["-D", "-L", "-B"]),
        ("subsimpl", &["-D", "-E", "-O", "-P", "-N", "-M", "-T"]),
        ("propsimpl", &["-A", "-V"]),
    ];
    for (program, letters) in letters {
        let help = out(folder.path(), &["thesis", program, "--help"], b"");
        let help = String::from_utf8(help).unwrap();
        for letter in letters {
            let named = |line: &str| {
                line.trim_start()
                    .split([' ', ','])
                    .any(|word| word == *letter)
            };
            assert!(help.lines().any(named), "{program}: {letter}");
        }
    }
}

/// A torus by roots, a ball by powers of e, and a box whose one wall is a sine's: volumes by their
/// formulas, of boundaries that close.
#[test]
fn functions_are_approximated_as_solids() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let half = ["-B", "-3.141592653589793", "-1", "-1", "1", "1", "1"];
    let cube = ["-B", "-1.5", "-1.5", "-1.5", "1.5", "1.5", "1.5"];
    let cases: [(&[&str], &[&str], f64, f64); 4] = [
        (
            &["sqrt((sqrt(x^2+y^2)-1)^2+z^2) - 0.4"],
            &cube,
            2.0 * PI * PI * 0.16,
            0.01,
        ),
        (
            &["exp(x^2 + y^2 + z^2) - exp(1)"],
            &cube,
            4.0 / 3.0 * PI,
            0.01,
        ),
        (&["sin(x)"], &half, 4.0 * PI, 1e-3),
        // Two functions: a quarter of a ball, with the planes' walls.
        (&["x^2+y^2+z^2 - 1", "x/2", "(-y)"], &cube, PI / 3.0, 0.01),
    ];
    for (functions, bounds, volume, relative) in cases {
        let args = [&["thesis", "implicit"], functions, bounds, &["-N", "18"]].concat();
        std::fs::write(folder.join("a.apl"), out(folder, &args, b"")).unwrap();
        let report = out(folder, &["a.apl", "--report", "-"], b"");
        let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
        let got = report["volume"].as_f64().unwrap();
        assert!(
            (got / volume - 1.0).abs() < relative,
            "{functions:?}: {got} {volume}"
        );
        assert_eq!(report["counts"]["shells"], 1, "{functions:?}");
    }
    // Without the box's walls the plane is all there is.
    let open = ["thesis", "implicit", "sin(x)", "-L", "-N", "12"];
    let bytes = out(
        folder,
        &[&open[..], &["-B", "-1", "-1", "-1", "1", "1", "1"]].concat(),
        b"",
    );
    let area = measure(&pipeline(folder, &bytes, &[&["propsimpl", "-A"]]), "area");
    assert!(area >= 4.0, "{area}");
    let refused = run(folder, &["thesis", "implicit", "x + tan(y)"], b"");
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("column 5: unknown name `tan`"), "{said}");
}

/// The bytes of a linear approximation: a square across the y axis.
fn square(material: i32, y: f64, half: f64) -> Vec<u8> {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    let mut bytes = b"A".to_vec();
    for triangle in [[0, 1, 2], [0, 2, 3]] {
        bytes.extend(material.to_be_bytes());
        for [x, z] in triangle.map(|at: usize| corners[at]) {
            bytes.extend([x, y, z].iter().flat_map(|c| c.to_be_bytes()));
        }
    }
    bytes
}

/// A picture's width and pixels, row by row.
fn decoded(png: &[u8]) -> (usize, Vec<[u8; 3]>) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png))
        .read_info()
        .unwrap();
    let mut buffer = vec![0; reader.output_buffer_size().unwrap()];
    let width = reader.next_frame(&mut buffer).unwrap().width as usize;
    (width, buffer.as_chunks().0.to_vec())
}

/// A square of side 2 half a unit in front of the origin, material 1, and one of side 8 three units
/// behind it, material 2, from so far that both appear as large as they are: a pixel is 0.1 wide.
#[test]
fn several_files_share_a_depth_buffer_and_a_table_of_colours() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let system = "0 0 0\n0 1 0\n1e6\n-5 -5 5 5\n";
    std::fs::write(folder.join("sisproj.dat"), system).unwrap();
    std::fs::write(folder.join("front.apl"), square(1, -0.5, 1.0)).unwrap();
    std::fs::write(folder.join("back.apl"), square(2, 3.0, 4.0)).unwrap();
    let picture = |options: &[&str]| {
        let args = [&["thesis", "visual", "--size", "100x100"], options].concat();
        let (width, pixels) = decoded(&out(folder, &args, b""));
        assert_eq!((width, pixels.len()), (100, 10_000));
        pixels
    };
    // The z axis in model units from the middle of the picture, which lies between two pixels.
    let at = |pixels: &[[u8; 3]], x: i64, z: i64| {
        pixels[usize::try_from((49 - z) * 100 + 50 + x).unwrap()]
    };
    let files = ["front.apl", "back.apl"];
    let swapped = ["back.apl", "front.apl"];
    let filled = picture(&[&files[..], &["--solid"]].concat());
    assert_eq!(filled, picture(&[&swapped[..], &["--solid"]].concat()));
    let (front, back) = (at(&filled, 3, 5), at(&filled, 20, 5));
    assert_eq!((front, at(&filled, 45, 5)), ([255; 3], [0; 3]));
    assert!(back != front && back != [0; 3], "{back:?}");

    // The axes begin between the squares, and all of them is in front of the larger one.
    let red = [230, 60, 60];
    let solid_axes = picture(&[&files[..], &["--solid", "--axes"]].concat());
    assert_eq!(at(&solid_axes, 5, -1), front);
    assert_eq!(at(&solid_axes, 20, -1), red);
    let wires = picture(&[&files[..], &["--axes"]].concat());
    assert_eq!(at(&wires, 5, -1), red);
    assert_eq!(at(&wires, 20, -1), red);
    // Edges of the square behind are seen through the one in front; faces are not filled.
    assert_eq!((at(&wires, 3, 5), at(&wires, 6, 6)), ([0; 3], back));

    std::fs::write(
        folder.join("tabcor.dat"),
        "0 10 20 30\n1 200 0 0\n2 0 99 0\n",
    )
    .unwrap();
    for options in [&["--solid"][..], &["--solid", "--flat"]] {
        let colored = picture(&[&files[..], options].concat());
        assert_eq!(at(&colored, 3, 5), [200, 0, 0]);
        assert_eq!(at(&colored, 20, 5), [0, 99, 0]);
        assert_eq!(at(&colored, 45, 5), [10, 20, 30]);
    }
}

/// Each file has one thing wrong; the message names the byte.
#[test]
fn bad_files_are_refused_with_the_byte() {
    let folder = support::thesis_files();
    let folder = folder.path();
    let cases = [
        ("type.CSG", "byte 5: unknown type 42 of primitive"),
        ("operator.CSG", "byte 1: unknown operator code 9"),
        ("truncated.CSG", "byte 100: the file ends"),
        ("trailing.CSG", "byte 73: 3 bytes are left"),
        ("nan.CSG", "byte 9: an entry of a matrix is NaN"),
        ("degree.CSG", "byte 9: degree 2147483647"),
        ("singular.CSG", "byte 9: the transform is singular"),
        ("tube.CSG", "byte 5: tube radius must be positive"),
        ("primitives.cspg", "byte 0: 2147483647 primitives cannot be"),
        ("sectors.cspg", "byte 9: 1073741824 sectors cannot be"),
        ("name.cspg", "byte 13: primitive 6 of the tree"),
        ("nan.cspg", "byte 145: a Bézier coefficient is NaN"),
        ("infinite.apl", "byte 297: a face's corner is inf"),
        ("short.apl", "byte 297: the file ends"),
        ("open.apl", "the triangles do not close"),
        ("node.sub", "byte 101: unknown type 7 of simplex"),
        ("letter.sub", "byte 0: expected the letter 'S'"),
    ];
    for (name, expected) in cases {
        let file = format!("wrong_{name}");
        let args: &[&str] = match name.rsplit_once('.').unwrap().1 {
            "cspg" => &["thesis", "subsimpl", &file, "--output", "never"],
            "sub" => &["thesis", "propsimpl", "-V", &file],
            _ => &[&file, "-o", "never.glb"],
        };
        let output = run(folder, args, b"");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{name}: {said}");
        assert!(
            said.contains(&format!("{file}: {expected}")),
            "{name}: {said}"
        );
    }
    assert!(!folder.join("never").exists() && !folder.join("never.glb").exists());
}

/// What is written must not be what is read, however the shell was told so.
#[cfg(unix)]
#[test]
fn programs_that_read_what_they_write_are_refused() {
    use std::fs::{File, OpenOptions, read};
    use std::process::Stdio;
    let folder = support::thesis_files();
    let folder = folder.path();
    let start = |args: &[&str], stdin: Stdio, stdout: Stdio| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("csg2brep"));
        let command = command.current_dir(folder).args(args);
        let child = command.stdin(stdin).stdout(stdout).stderr(Stdio::piped());
        let output = child.spawn().unwrap().wait_with_output().unwrap();
        (
            output.status.code(),
            String::from_utf8(output.stderr).unwrap(),
        )
    };
    let tree = folder.join("cube.CSG");
    std::fs::copy(folder.join("bored.CSG"), &tree).unwrap();
    let before = read(&tree).unwrap();
    let append = || OpenOptions::new().append(true).open(&tree).unwrap().into();
    let loops: [(&[&str], Stdio, Stdio); 4] = [
        (
            &["thesis", "csg2cspg"],
            File::open(&tree).unwrap().into(),
            append(),
        ),
        (&["thesis", "csg2cspg", "cube.CSG"], Stdio::null(), append()),
        (
            &["thesis", "csg2cspg", "--output", "cube.CSG"],
            File::open(&tree).unwrap().into(),
            Stdio::null(),
        ),
        (
            &["-", "-o", "cube.CSG"],
            File::open(&tree).unwrap().into(),
            Stdio::null(),
        ),
    ];
    for (args, stdin, stdout) in loops {
        let (code, said) = start(args, stdin, stdout);
        assert_eq!(code, Some(2), "{args:?}: {said}");
        assert!(said.contains("are one file: a shell empties it"), "{said}");
    }
    assert_eq!(read(&tree).unwrap(), before);

    // One pipe at both ends: without the check the program would wait for ever.
    let (reader, writer) = std::io::pipe().unwrap();
    for program in ["csg2cspg", "subsimpl", "vis2lcg"] {
        let stdin = reader.try_clone().unwrap().into();
        let (code, said) = start(
            &["thesis", program],
            stdin,
            writer.try_clone().unwrap().into(),
        );
        assert_eq!(code, Some(2), "{program}: {said}");
        assert!(said.contains("are the ends of one pipe"), "{said}");
    }
}
