//! Why a run ends without success, and the exit code of each reason.

use crate::progress::INTERRUPTED;
use io::read::Diagnostics;
use std::fmt;
use std::path::PathBuf;
use std::process::ExitCode;

/// Why a run ended.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The model's text is wrong.
    Diagnostics {
        /// What is wrong.
        diagnostics: Diagnostics,
        /// The text, for excerpts.
        source: String,
    },
    /// The input is no model, or a model without a finite solid.
    BadInput(String),
    /// A file could not be read or written.
    File {
        /// "read" or "write".
        action: &'static str,
        /// Its name.
        path: PathBuf,
        /// What the operating system says.
        cause: std::io::Error,
    },
    /// The command line asks for what cannot be.
    Usage(String),
    /// A limit was reached.
    Limit(String),
    /// Not certified to the tolerance, with --strict.
    NotCertified(String),
    /// A mesh that was to be checked has defects.
    Defective(String),
    /// Ctrl-C.
    Cancelled,
    /// The reader of standard output went away, which is fine.
    BrokenPipe,
    /// This program is at fault.
    Bug(String),
}

impl Failure {
    /// The exit code, as listed in --help.
    pub(crate) fn code(&self) -> u8 {
        match self {
            Self::BrokenPipe => 0,
            Self::Diagnostics { .. } | Self::BadInput(_) | Self::File { .. } | Self::Bug(_) => 1,
            Self::Usage(_) => 2,
            Self::NotCertified(_) | Self::Defective(_) => 3,
            Self::Limit(_) => 4,
            Self::Cancelled => INTERRUPTED,
        }
    }

    /// The exit code for the operating system.
    pub(crate) fn exit_code(&self) -> ExitCode {
        ExitCode::from(self.code())
    }

    /// Says which model it is about.
    pub(crate) fn of_input(self, name: &str) -> Self {
        match self {
            Self::BadInput(text) => Self::BadInput(format!("{name}: {text}")),
            Self::Limit(text) => Self::Limit(format!("{name}: {text}")),
            other => other,
        }
    }

    /// A failure to write; a broken pipe is told apart.
    pub(crate) fn writing(path: impl Into<PathBuf>, cause: std::io::Error) -> Self {
        if cause.kind() == std::io::ErrorKind::BrokenPipe {
            return Self::BrokenPipe;
        }
        Self::File {
            action: "write",
            path: path.into(),
            cause,
        }
    }

    /// A writer's failure; `name` stands for its output.
    pub(crate) fn from_writer(name: &str, error: io::write::Error) -> Self {
        use io::write::Error;
        match error {
            Error::Io(cause) => Self::writing(name, cause),
            Error::File { path, source } => Self::writing(path, source),
            Error::Json(cause) if cause.is_io() => Self::writing(name, cause.into()),
            error => {
                // Causes matter: the outer message often says only what was attempted.
                let mut text = format!("{name}: {error}");
                let mut cause = std::error::Error::source(&error);
                while let Some(inner) = cause {
                    text = format!("{text}: {inner}");
                    cause = inner.source();
                }
                Self::Limit(text)
            }
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Diagnostics { diagnostics, .. } => diagnostics.fmt(f),
            Self::BadInput(text)
            | Self::Usage(text)
            | Self::Limit(text)
            | Self::NotCertified(text)
            | Self::Defective(text) => f.write_str(text),
            Self::File {
                action,
                path,
                cause,
            } => write!(f, "cannot {action} {}: {cause}", path.display()),
            Self::Cancelled => f.write_str("interrupted"),
            Self::BrokenPipe => f.write_str("the reader of standard output went away"),
            Self::Bug(text) => write!(
                f,
                "internal error: {text} (please report it together with the model)"
            ),
        }
    }
}

impl std::error::Error for Failure {}

impl From<csg::Error> for Failure {
    fn from(error: csg::Error) -> Self {
        match error {
            csg::Error::TooManyLiterals { .. } => Self::Limit(error.to_string()),
            csg::Error::BadClipBox => Self::Usage(format!("--box: {error}")),
            csg::Error::MisplacedNode { .. } | csg::Error::UnknownMaterial { .. } => {
                Self::Bug(error.to_string())
            }
            _ => Self::BadInput(error.to_string()),
        }
    }
}

impl From<subdiv::Error> for Failure {
    fn from(error: subdiv::Error) -> Self {
        match error {
            subdiv::Error::Cancelled => Self::Cancelled,
            subdiv::Error::Tolerance(_) | subdiv::Error::Level { .. } => {
                Self::Usage(error.to_string())
            }
            _ => Self::Limit(error.to_string()),
        }
    }
}
