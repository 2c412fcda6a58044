//! Files that a model names: readers ask for them, whoever opened the model decides.

/// Why a file that a model names is not read: lowercase, without a trailing period.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FileRefusal {
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub remedy: String,
}

/// A font.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FontFile {
    /// A TrueType or OpenType file.
    pub bytes: Vec<u8>,
    /// Which of the file's fonts it is.
    pub index: u32,
    /// Its own name, for messages.
    pub name: String,
    /// Whether it is another one than was asked for.
    pub is_substitute: bool,
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

    /// A font by OpenSCAD's name for it, such as `DejaVu Sans:style=Bold`; of no name: any.
    ///
    /// # Errors
    /// That there are no fonts.
    fn font(&self, name: &str) -> Result<FontFile, FileRefusal> {
        let _ = name;
        Err(FileRefusal {
            message: "no fonts are read here".to_owned(),
            remedy: "convert the model with the program csg2brep".to_owned(),
        })
    }
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
