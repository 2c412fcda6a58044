//! What OpenCASCADE reads in our files.

use crate::support;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

/// `tests/python/step.py` explains the fields.
#[derive(Clone, PartialEq, Debug, Deserialize)]
pub(crate) struct Part {
    pub(crate) valid: bool,
    pub(crate) volume: f64,
    pub(crate) area: f64,
    pub(crate) surfaces: BTreeMap<String, usize>,
    pub(crate) edges: BTreeMap<String, usize>,
}

#[derive(Clone, PartialEq, Debug, Deserialize)]
pub(crate) struct StepFile {
    pub(crate) file: PathBuf,
    pub(crate) solids: Vec<Part>,
    pub(crate) loose: usize,
    pub(crate) error: Option<String>,
}

/// Runs the script with these arguments.
pub(crate) fn python<T: for<'a> Deserialize<'a>>(arguments: &[&str]) -> Vec<T> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/python/step.py");
    let mut command = Command::new(support::validators());
    let output = command.arg(script).args(arguments).output().unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    serde_json::from_slice(&output.stdout).unwrap()
}
