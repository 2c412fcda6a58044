//! Foreign programs that judge our files, for tests.
//!
//! They live in a Python virtual environment under `target/validators`, which the first test that
//! needs it creates. A machine without Python fails the test and says so: nothing is skipped.

#![allow(dead_code, reason = "each test uses its own part")]

use serde::Deserialize;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// What the Manifold library says about a file; `tests/python/validate.py` explains the fields.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub(crate) struct ManifoldReport {
    pub(crate) file: PathBuf,
    /// `NoError` for a closed, oriented 2-manifold.
    pub(crate) status: String,
    pub(crate) triangles: Option<usize>,
    /// Shells, cavities included.
    pub(crate) components: Option<usize>,
    /// Handles of all shells together.
    pub(crate) genus: Option<i64>,
    pub(crate) volume: Option<f64>,
    pub(crate) area: Option<f64>,
    pub(crate) error: Option<String>,
}

/// What CGAL says about a file; `tests/python/self_intersections.py` explains the fields.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub(crate) struct IntersectionReport {
    pub(crate) file: PathBuf,
    /// Pairs of triangles that touch or cross.
    pub(crate) contacts: usize,
    /// Those that cross by more than rounding of positions.
    pub(crate) crossings: usize,
    pub(crate) depth: f64,
    pub(crate) allowed: f64,
    /// `None` without contacts.
    #[serde(rename = "where")]
    pub(crate) place: Option<[f64; 3]>,
}

/// Lets CGAL look for crossing triangles in OBJ files; reports are in the order of the paths.
pub(crate) fn intersection_report<P: AsRef<Path>>(paths: &[P]) -> Vec<IntersectionReport> {
    let script = Path::new(ROOT).join("tests/python/self_intersections.py");
    let mut command = Command::new(validators());
    command.arg(script).args(paths.iter().map(AsRef::as_ref));
    let output = run(&mut command, "the validators cannot be run");
    serde_json::from_slice(&output.stdout).expect("the validators print JSON")
}

/// Lets the Manifold library check OBJ and GLB files; reports are in the order of the paths.
pub(crate) fn manifold_report<P: AsRef<Path>>(paths: &[P]) -> Vec<ManifoldReport> {
    let script = Path::new(ROOT).join("tests/python/validate.py");
    let mut command = Command::new(validators());
    command.arg(script).args(paths.iter().map(AsRef::as_ref));
    let output = run(&mut command, "the validators cannot be run");
    serde_json::from_slice(&output.stdout).expect("the validators print JSON")
}

/// What lib3mf or plyfile finds in a file; `tests/python/mesh_files.py` explains the fields.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub(crate) struct FileReport {
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
    /// Only of 3MF files, as the next two.
    pub(crate) warnings: Option<usize>,
    pub(crate) manifold: Option<bool>,
    pub(crate) unit: Option<u32>,
    pub(crate) materials: usize,
    /// Names of the solids' objects, and the number of things built; only of 3MF files.
    #[serde(default)]
    pub(crate) objects: Vec<String>,
    pub(crate) built: Option<usize>,
    pub(crate) volume: f64,
}

/// Lets lib3mf (strict) read 3MF files and plyfile PLY files; reports are in the order of the paths.
pub(crate) fn file_reports<P: AsRef<Path>>(paths: &[P]) -> Vec<FileReport> {
    let script = Path::new(ROOT).join("tests/python/mesh_files.py");
    let mut command = Command::new(validators());
    command.arg(script).args(paths.iter().map(AsRef::as_ref));
    let output = run(&mut command, "the validators cannot be run");
    serde_json::from_slice(&output.stdout).expect("the validators print JSON")
}

/// A folder with the thesis' files as `tests/python/thesis_files.py` assembles them, sound and
/// broken ones.
pub(crate) fn thesis_files() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let script = Path::new(ROOT).join("tests/python/thesis_files.py");
    let mut command = Command::new(validators());
    run(
        command.arg(script).arg(folder.path()),
        "the thesis' files cannot be written",
    );
    folder
}

/// Path of a Python interpreter that has the packages of `tests/python/requirements.txt`.
///
/// Makes the environment when it is missing or was made for other requirements; of several test
/// processes the first one does so while the others wait.
pub(crate) fn validators() -> PathBuf {
    let requirements = Path::new(ROOT).join("tests/python/requirements.txt");
    let wanted = fs::read_to_string(&requirements).expect("tests/python/requirements.txt");
    let target = Path::new(ROOT).join("target");
    fs::create_dir_all(&target).expect("a folder for build products");
    let environment = target.join("validators");
    let stamp = environment.join("requirements.installed");
    let python = environment.join(if cfg!(windows) {
        "Scripts/python.exe"
    } else {
        "bin/python"
    });

    let lock = File::create(target.join("validators.lock")).expect("a lock file");
    // Released when the file is closed, also by a crash.
    lock.lock().expect("a lock");
    if fs::read_to_string(&stamp).is_ok_and(|installed| installed == wanted) {
        return python;
    }
    let mut create = Command::new(if cfg!(windows) { "python" } else { "python3" });
    create.args(["-m", "venv", "--clear"]).arg(&environment);
    run(
        &mut create,
        "these tests need Python 3.11 or later with its venv module \
         (Debian: apt-get install python3-venv)",
    );
    let mut install = Command::new(&python);
    install.args([
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ]);
    install.arg("--requirement").arg(&requirements);
    run(
        &mut install,
        "the packages of tests/python/requirements.txt cannot be installed",
    );
    fs::write(&stamp, wanted).expect("a stamp file");
    python
}

fn run(command: &mut Command, remedy: &str) -> Output {
    let output = match command.output() {
        Ok(output) => output,
        Err(error) => panic!("{remedy}: {command:?}: {error}"),
    };
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{remedy}: {command:?}:\n{errors}");
    output
}
