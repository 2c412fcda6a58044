//! Why a mesh file cannot be read.

use std::fmt;

/// What is wrong in a mesh file, where, and what to do about it.
///
/// Displays as `line 12: "x" is no number (a vertex needs three)`.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct MeshError {
    /// Such as `line 12` or `byte 84`; empty if it is about the whole file.
    pub place: String,
    /// What was expected and what was found, lowercase, without a trailing period.
    pub message: String,
    /// What the user can do, in the same form.
    pub remedy: &'static str,
    /// Whether the file may be right and only too large.
    pub is_limit: bool,
}

/// What helps when a file has lost its end or was changed on its way.
pub(super) const DAMAGED: &str = "the file is damaged or cut off: write or copy it again";

impl MeshError {
    pub(super) fn new(
        place: impl Into<String>,
        message: impl Into<String>,
        remedy: &'static str,
    ) -> Self {
        Self {
            place: place.into(),
            message: message.into(),
            remedy,
            is_limit: false,
        }
    }

    pub(super) fn at_line(line: usize, message: impl Into<String>, remedy: &'static str) -> Self {
        Self::new(format!("line {line}"), message, remedy)
    }

    pub(super) fn damaged(place: impl Into<String>, message: impl Into<String>) -> Self {
        Self::new(place, message, DAMAGED)
    }

    pub(super) fn too_large() -> Self {
        Self {
            place: String::new(),
            message: "the mesh has more vertices and triangles than memory allows".to_owned(),
            remedy: "allow more with --memory",
            is_limit: true,
        }
    }
}

impl fmt::Display for MeshError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.place.is_empty() {
            write!(f, "{}: ", self.place)?;
        }
        write!(f, "{} ({})", self.message, self.remedy)
    }
}

impl std::error::Error for MeshError {}
