//! Files that a model names, such as imported meshes: only those below the model's own folder.

use crate::fonts;
use io::read::{FileRefusal, Files, FontFile};
use std::path::{Component, Path, PathBuf};

/// Larger files are not read.
const MOST_BYTES: u64 = 1 << 30;

/// The folder of a model.
pub(crate) struct Folder(Option<PathBuf>);

impl Folder {
    /// The folder in which a file is.
    pub(crate) fn of(file: &Path) -> Self {
        let folder = file.parent().filter(|f| !f.as_os_str().is_empty());
        Self(Some(folder.unwrap_or(Path::new(".")).to_owned()))
    }

    /// No folder, of a model from standard input.
    pub(crate) fn none() -> Self {
        Self(None)
    }
}

fn refusal(message: impl Into<String>, remedy: impl Into<String>) -> FileRefusal {
    FileRefusal {
        message: message.into(),
        remedy: remedy.into(),
    }
}

impl Files for Folder {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileRefusal> {
        let Some(folder) = &self.0 else {
            let message = "a model from standard input has no folder";
            return Err(refusal(
                message,
                "save the model beside the files that it names",
            ));
        };
        let below = "put the file below the model's folder and name it from there";
        let is_plain =
            |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
        if !Path::new(path).components().all(is_plain) || path.contains(['\\', ':', '\0']) {
            return Err(refusal("it is not below the model's folder", below));
        }
        let whole = folder.join(path);
        let missing = |cause: std::io::Error| {
            let remedy = format!("put it at {}", whole.display());
            refusal(cause.to_string(), remedy)
        };
        // Symbolic links may lead anywhere.
        let real = whole.canonicalize().map_err(missing)?;
        let home = folder.canonicalize().map_err(missing)?;
        if !real.starts_with(&home) {
            let message = format!(
                "it is a link to {}, outside the model's folder",
                real.display()
            );
            return Err(refusal(message, below));
        }
        let about = real.metadata().map_err(missing)?;
        if !about.is_file() {
            return Err(refusal("it is no file", "name a file"));
        }
        if about.len() > MOST_BYTES {
            let message = format!(
                "it has {} bytes, at most {MOST_BYTES} are read",
                about.len()
            );
            return Err(refusal(
                message,
                "start from the model that this file was made of",
            ));
        }
        std::fs::read(&real).map_err(missing)
    }

    fn font(&self, name: &str) -> Result<FontFile, FileRefusal> {
        fonts::find(name)
    }
}
