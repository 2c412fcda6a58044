//! Files that a model names: readers ask for them, whoever opened the model decides.

/// Why a file that a model names is not read: lowercase, without a trailing period.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FileRefusal {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub remedy: String,
}

/// Gives readers the content of files beside the model.
///
/// Paths come from the model and must not be trusted: implementations refuse whatever is not
/// below the model's own folder.
pub trait Files {
    /// The whole content of the file that a model calls `path`.
    ///
    /// # Errors
    /// Why the file is not opened, or cannot be.
    fn read(&self, path: &str) -> Result<Vec<u8>, FileRefusal>;
}

/// No files at all.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct NoFiles;

impl Files for NoFiles {
    fn read(&self, _: &str) -> Result<Vec<u8>, FileRefusal> {
        Err(FileRefusal {
            message: "no other files are read here".to_owned(),
            remedy: "give the model as a file, beside the files that it names".to_owned(),
        })
    }
}
