//! manifold3d, in a Python process of its own that stays for the whole run.

use crate::measure::Mesh;
use glam::DVec3;
use std::cell::RefCell;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The process.
pub struct Manifold {
    pipes: RefCell<(ChildStdin, BufReader<ChildStdout>)>,
    child: Child,
    mesh: PathBuf,
}

impl Manifold {
    /// Starts Python from the virtual environment that the tests set up, or `python3`.
    pub fn start() -> Self {
        let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
        let own = PathBuf::from(root).join("target/validators/bin/python");
        let python = if own.exists() { own } else { "python3".into() };
        let mut child = Command::new(&python)
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/src/manifold.py"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("{}: {error}", python.display()));
        let input = child.stdin.take().expect("a pipe");
        let output = BufReader::new(child.stdout.take().expect("a pipe"));
        Self {
            pipes: RefCell::new((input, output)),
            child,
            mesh: std::env::temp_dir().join(format!("csg2brep-peers-{}.bin", std::process::id())),
        }
    }

    fn ask(&self, solid: &str, segments: u32, path: &str) -> Option<[f64; 3]> {
        let (input, output) = &mut *self.pipes.borrow_mut();
        writeln!(input, "{solid} {segments} {path}").expect("a Python that reads");
        let mut line = String::new();
        output.read_line(&mut line).expect("a Python that answers");
        if line.trim() == "none" {
            return None;
        }
        let numbers: Vec<f64> = (line.split_whitespace())
            .map(|word| word.parse().expect("three numbers"))
            .collect();
        let hint = "Python needs manifold3d and numpy: run `cargo test --test external` first, \
                    which sets up target/validators";
        Some(numbers.try_into().expect(hint))
    }

    /// Milliseconds for a solid with this many segments a circle.
    pub fn time(&self, solid: &str, segments: u32) -> f64 {
        self.ask(solid, segments, "-")
            .map_or(f64::NAN, |[ms, ..]| ms)
    }

    /// Its mesh; `None` if there are no primitives for it.
    pub fn mesh(&self, solid: &str, segments: u32) -> Option<Mesh> {
        let path = self.mesh.to_str().expect("a plain name");
        let [_, vertices, triangles] = self.ask(solid, segments, path)?;
        let bytes = std::fs::read(&self.mesh).expect("the mesh");
        let (positions, corners) = bytes.split_at(24 * vertices as usize);
        assert_eq!(corners.len(), 12 * triangles as usize);
        let positions = positions.chunks_exact(24).map(|p| {
            let at = |k: usize| f64::from_le_bytes(p[8 * k..8 * k + 8].try_into().expect("8"));
            DVec3::new(at(0), at(1), at(2))
        });
        let corners = corners.chunks_exact(12).map(|t| {
            [0, 1, 2].map(|k| u32::from_le_bytes(t[4 * k..4 * k + 4].try_into().expect("4")))
        });
        Some(Mesh::new(positions.collect(), corners.collect()))
    }
}

impl Drop for Manifold {
    fn drop(&mut self) {
        // Nothing is lost if it is gone already.
        let _ = self.child.kill();
        let _ = self.child.wait();
        let _ = std::fs::remove_file(&self.mesh);
    }
}
