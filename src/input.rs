//! From a file or standard input to a model.

use crate::args::{ClipArgs, InputFormat};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::run::clip_box;
use crate::talk::Talk;
use crate::thesis::pipe::DialectArgs;
use csg::Solid;
use io::read::format::{Format, sniff};
use io::read::{Diagnostic, ReadOptions, decode, scad_csg};
use io::thesis::{power_form, sectors, solid};
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// Where the model comes from.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Input {
    /// Standard input.
    Stdin,
    /// A file.
    File(PathBuf),
    /// Content that was read before, and the name it is known by.
    Read { name: String, bytes: Vec<u8> },
}

/// A model and what there is to say about its text.
pub(crate) struct Loaded {
    pub(crate) model: csg::Model,
    pub(crate) format: Format,
    /// The text, for excerpts in warnings.
    pub(crate) source: String,
    pub(crate) warnings: Vec<Diagnostic>,
    /// Nodes for which something flat was taken.
    pub(crate) approximated_nodes: u64,
}

impl Input {
    /// `-` is standard input.
    pub(crate) fn new(path: PathBuf) -> Self {
        if path == Path::new("-") {
            Self::Stdin
        } else {
            Self::File(path)
        }
    }

    /// The name for messages.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::Stdin => "<stdin>".to_owned(),
            Self::File(path) => path.display().to_string(),
            Self::Read { name, .. } => name.clone(),
        }
    }

    /// Reads the file and tells its format.
    pub(crate) fn open(&self, format: Option<InputFormat>) -> Result<(Vec<u8>, Format), Failure> {
        let name = self.name();
        let bytes = self.bytes()?;
        // Wide text would pass for a binary file of unknown format; reading it tells better.
        let format = match format {
            Some(InputFormat::Csg) => Format::ScadCsg,
            Some(InputFormat::ThesisCsg) => Format::ThesisCsg,
            Some(InputFormat::Cspg) => Format::ThesisCspg,
            Some(InputFormat::Apl) => Format::ThesisApl,
            Some(InputFormat::Wfr) => Format::ThesisWfr,
            None => match sniff(&bytes, &name) {
                Ok(format) => format,
                Err(unreadable) => {
                    decode::decode(bytes, &name).map_err(from_decoding)?;
                    return Err(Failure::BadInput(format!("{name}: {unreadable}")));
                }
            },
        };
        Ok((bytes, format))
    }

    /// Reads the model.
    pub(crate) fn load(
        &self,
        format: Option<InputFormat>,
        options: ReadOptions,
        dialect: DialectArgs,
    ) -> Result<Loaded, Failure> {
        let (bytes, format) = self.open(format)?;
        self.parse(bytes, format, options, dialect)
    }

    /// The solid of the model, and what it was read from; warnings are said.
    pub(crate) fn solid(
        &self,
        clip: &ClipArgs,
        dialect: DialectArgs,
        talk: Talk,
    ) -> Result<(Solid, Loaded), Failure> {
        let clip = clip.corners.as_deref().map(clip_box).transpose()?;
        let loaded = self.load(None, ReadOptions::default(), dialect)?;
        for warning in &loaded.warnings {
            talk.warn_about(warning, &loaded.source);
        }
        let solid = Solid::build(&loaded.model, clip);
        let solid = solid.map_err(|error| Failure::from(error).of_input(&self.name()))?;
        Ok((solid, loaded))
    }

    /// The model in a file's content.
    pub(crate) fn parse(
        &self,
        bytes: Vec<u8>,
        format: Format,
        options: ReadOptions,
        dialect: DialectArgs,
    ) -> Result<Loaded, Failure> {
        let name = self.name();
        match format {
            Format::ScadCsg => {}
            Format::ThesisCsg => {
                let form = dialect.form();
                let wrong = |error| Failure::BadInput(format!("{name}: {error}"));
                let tree = solid::read(&bytes, dialect.operators(), form).map_err(wrong)?;
                return Ok(Loaded {
                    model: solid::to_model(&tree.value, form)?,
                    format,
                    source: String::new(),
                    warnings: Vec::new(),
                    approximated_nodes: 0,
                });
            }
            Format::ThesisCspg => {
                let wrong = |error: String| Failure::BadInput(format!("{name}: {error}"));
                let read = sectors::read(&bytes, dialect.operators());
                let read = read.map_err(|error| wrong(error.to_string()))?;
                let model = power_form::to_model(&read.value);
                return Ok(Loaded {
                    model: model.map_err(|problem| wrong(problem.to_string()))?,
                    format,
                    source: String::new(),
                    warnings: Vec::new(),
                    approximated_nodes: 0,
                });
            }
            Format::ThesisApl | Format::ThesisWfr => {
                let text = "a linear approximation is a boundary already, not a CSG model (convert \
                            it, as in csg2brep IN -o part.glb)";
                return Err(Failure::BadInput(format!("{name}: {text}")));
            }
            _ => return Err(Failure::Bug(format!("no reader for {}", format.name()))),
        }
        let source = decode::decode(bytes, &name).map_err(from_decoding)?;
        match scad_csg::read_with(&source, &name, &options, &self.folder()) {
            Ok(reading) => Ok(Loaded {
                model: reading.model,
                format,
                source,
                warnings: reading.warnings,
                approximated_nodes: reading.approximated_nodes,
            }),
            Err(diagnostics) => Err(Failure::Diagnostics {
                diagnostics,
                source,
            }),
        }
    }

    /// Where files are that the model names.
    fn folder(&self) -> Folder {
        match self {
            Self::Stdin => Folder::none(),
            Self::File(path) => Folder::of(path),
            Self::Read { name, .. } if name.starts_with('<') => Folder::none(),
            Self::Read { name, .. } => Folder::of(Path::new(name)),
        }
    }

    /// The whole content.
    pub(crate) fn bytes(&self) -> Result<Vec<u8>, Failure> {
        let failed = |cause| Failure::File {
            action: "read",
            path: self.name().into(),
            cause,
        };
        match self {
            Self::Stdin => {
                let mut bytes = Vec::new();
                let read = std::io::stdin().lock().read_to_end(&mut bytes);
                read.map(|_| bytes).map_err(failed)
            }
            Self::File(path) => std::fs::read(path).map_err(failed),
            Self::Read { bytes, .. } => Ok(bytes.clone()),
        }
    }
}

fn from_decoding(wrong: Diagnostic) -> Failure {
    Failure::Diagnostics {
        diagnostics: wrong.into(),
        source: String::new(),
    }
}
