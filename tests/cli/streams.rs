//! Standard input and output, pipes, and bytes that are no UTF-8.

use super::csg2brep;
use std::io::{Read as _, Write as _};
use std::process::{Command, Stdio};

fn program() -> Command {
    Command::new(assert_cmd::cargo::cargo_bin!("csg2brep"))
}

#[test]
fn data_goes_to_standard_output_and_words_to_standard_error() {
    let run = csg2brep()
        .args(["-", "-o", "-", "--to", "obj"])
        .write_stdin("cube(1);")
        .assert()
        .success();
    let output = run.get_output();
    assert!(output.stdout.starts_with(b"# csg2brep"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(said.starts_with("<stdin> -> <stdout>: "), "{said}");
}

#[test]
fn quiet_says_nothing() {
    csg2brep()
        .args(["-", "-o", "-", "--to", "stl", "-q"])
        .write_stdin("cube(1); cube(0);")
        .assert()
        .success()
        .stderr("");
}

#[test]
fn a_reader_that_goes_away_is_success() {
    let mut child = program()
        .args(["-", "-o", "-", "--to", "obj", "--tolerance", "0.05%"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(b"sphere(r = 1);")
        .unwrap();
    let mut first = [0; 10];
    // More than a pipe holds is left unread.
    child.stdout.take().unwrap().read_exact(&mut first).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("error"), "{said}");
}

#[test]
fn an_interrupt_ends_the_run_with_code_130_and_without_leftovers() {
    let folder = tempfile::tempdir().unwrap();
    let mut child = program()
        .args(["-", "-q", "--level", "54", "-o"])
        .arg(folder.path().join("out.stl"))
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(b"sphere(r = 1);")
        .unwrap();
    std::thread::sleep(std::time::Duration::from_millis(500));
    let id = child.id().to_string();
    assert!(
        Command::new("kill")
            .args(["-INT", &id])
            .status()
            .unwrap()
            .success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn wide_text_damaged_text_and_foreign_files_are_told_apart() {
    let utf16: Vec<u8> = "\u{feff}cube(1);"
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    for (bytes, expected) in [
        (
            &utf16[..],
            "error: <stdin>:1:1: the file is UTF-16 text, expected UTF-8\n  help: convert it: iconv -f UTF-16 -t UTF-8 model.csg > utf8.csg\n",
        ),
        (
            &utf16[2..],
            "error: <stdin>:1:1: the file is UTF-16LE text, expected UTF-8\n  help: convert it: iconv -f UTF-16LE -t UTF-8 model.csg > utf8.csg\n",
        ),
        (
            b"cube(1);\n\xE9",
            "error: <stdin>:2:1: byte 0xE9 at offset 9 is not UTF-8\n  help: save the file as UTF-8\n",
        ),
        (
            b"glTF\x02\0\0\0",
            "error: <stdin>: this is a binary glTF mesh, not a CSG model (a mesh has lost its set operations: start from the CSG model it was made of)\n",
        ),
        (
            b"hello",
            "error: <stdin>: unknown file format (known: csg, the flat dump of OpenSCAD; thesis-csg and apl, binary files of the thesis; choose one with --from csg)\n",
        ),
        (
            b"cube(1);\n\0\0",
            "error: <stdin>:2:1: expected a node such as `union() {`, found a NUL byte\n   ╭─[<stdin>:2:1]\n 2 │ \u{fffd}\u{fffd}\n   · ─\n   ╰────\n  help: the file is damaged or not text: write or copy it again\n",
        ),
    ] {
        let run = csg2brep()
            .args(["-", "-o", "-", "--to", "obj"])
            .write_stdin(bytes)
            .assert()
            .code(1);
        let said = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(said.starts_with(expected), "{said}");
    }
}

#[test]
fn byte_order_marks_and_carriage_returns_are_fine() {
    csg2brep()
        .args(["-", "-o", "-", "--to", "obj"])
        .write_stdin("\u{feff}union() {\r\n\tcube(1);\r\n}\r\n")
        .assert()
        .success();
}

#[test]
fn the_same_input_gives_the_same_bytes_for_any_number_of_threads() {
    let bytes = |threads: &str, format: &str| {
        csg2brep()
            .args(["-", "-o", "-", "--to", format, "--threads", threads])
            .write_stdin("difference() { sphere(r = 2); cylinder(h = 9, r = 1, center = true); }")
            .output()
            .unwrap()
            .stdout
    };
    for format in ["obj", "glb", "stl"] {
        let one = bytes("1", format);
        assert!(one.len() > 1000);
        assert!(one == bytes("3", format), "{format}");
    }
}

#[test]
fn completions_and_manual_are_printed() {
    for arguments in [
        &["completions", "bash"][..],
        &["completions", "fish"],
        &["man"],
    ] {
        let run = csg2brep().args(arguments).assert().success();
        let text = String::from_utf8_lossy(&run.get_output().stdout).into_owned();
        assert!(
            text.contains("csg2brep") && text.contains("tolerance"),
            "{text}"
        );
    }
}
