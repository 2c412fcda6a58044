//! Files that a model names: what is below its folder is read, nothing else is opened.

use super::csg2brep;
use std::fs;
use std::path::Path;

const TETRAHEDRON: &str =
    "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

/// What is said about a model in a folder.
fn said(folder: &Path, model: &str) -> (bool, String) {
    fs::write(folder.join("model.csg"), model).expect("a folder to write to");
    let mut command = csg2brep();
    command.args(["model.csg", "-o", "-", "--to", "stl"]);
    let output = command.current_dir(folder).output().expect("the program");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.success(), said)
}

#[test]
fn meshes_below_the_model_are_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("parts")).unwrap();
    fs::write(folder.path().join("parts/t.off"), TETRAHEDRON).unwrap();
    for path in ["parts/t.off", "./parts/t.off"] {
        let (read, told) = said(folder.path(), &format!("import(file = \"{path}\");"));
        assert!(
            read && told.contains("volume 0.166667, watertight"),
            "{told}"
        );
    }
    // A model in another folder than the current one has its own.
    fs::write(folder.path().join("parts/m.csg"), "import(\"t.off\");").unwrap();
    let path = folder.path().join("parts/m.csg");
    csg2brep()
        .arg(path)
        .args(["-o", "-", "--to", "stl"])
        .assert()
        .success();
}

#[test]
fn no_other_files_are_opened() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir_all(inner.join("sub.off")).unwrap();
    fs::write(folder.path().join("t.off"), TETRAHEDRON).unwrap();
    let outside = folder.path().join("t.off");
    let absolute = outside.display().to_string();
    for (path, expected) in [
        ("../t.off", "it is not below the model's folder"),
        ("sub.off/../../t.off", "it is not below the model's folder"),
        ("..\\\\t.off", "it is not below the model's folder"),
        (&absolute, "it is not below the model's folder"),
        ("nix.off", "help: put it at ./nix.off"),
        ("sub.off", "it is no file"),
    ] {
        let (read, told) = said(&inner, &format!("import(file = \"{path}\");"));
        assert!(!read && told.contains(expected), "{path}: {told}");
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&outside, inner.join("link.off")).unwrap();
        let (read, told) = said(&inner, "import(file = \"link.off\");");
        assert!(
            !read && told.contains("outside the model's folder"),
            "{told}"
        );
    }
    let mut command = csg2brep();
    command
        .args(["-", "-o", "-", "--to", "stl"])
        .current_dir(folder.path());
    let run = command
        .write_stdin("import(file = \"t.off\");")
        .assert()
        .code(1);
    let told = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
    assert!(
        told.contains("a model from standard input has no folder"),
        "{told}"
    );
}
