//! What the thesis' programs have in common: they read standard input, write standard output, and
//! agree on codes that the thesis leaves open.

use crate::failure::Failure;
use crate::input::Input;
use crate::run::{Target, check_targets};
use clap::Args;
use io::thesis::solid::MatrixForm;
use io::thesis::tree::Operators;
use io::thesis::{ByteOrder, Decoded, Error};
use std::path::PathBuf;

/// One file in, one file out.
#[derive(Args, Debug)]
pub(super) struct Pipe {
    /// The file to read; `-` is standard input
    #[arg(value_name = "IN", default_value = "-")]
    pub(super) input: PathBuf,
    /// The file to write; `-` is standard output
    #[arg(long, value_name = "FILE", default_value = "-")]
    pub(super) output: PathBuf,
}

impl Pipe {
    /// Where to write, unless that is what is read.
    pub(super) fn target(&self) -> Result<Target, Failure> {
        let target = Target::new(self.output.clone());
        check_targets(&Input::new(self.input.clone()), &[&target])?;
        Ok(target)
    }
}

/// Codes of operators in binary files.
#[derive(Args, Debug)]
pub(super) struct Codes {
    /// The bytes that stand for union, intersection and difference, as in 0,1,2
    #[arg(long, value_name = "U,I,D", value_parser = operators)]
    operators: Option<Operators>,
}

impl Codes {
    pub(super) fn operators(&self) -> Operators {
        self.operators.unwrap_or_default()
    }
}

/// What a `.CSG` file leaves open.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct DialectArgs {
    /// The bytes that stand for union, intersection and difference in the thesis' files, as in
    /// 0,1,2
    #[arg(long, value_name = "U,I,D", hide_short_help = true, help_heading = "Model", value_parser = operators)]
    operators: Option<Operators>,
    /// The matrices in the thesis' .CSG files multiply column vectors
    #[arg(long, hide_short_help = true, help_heading = "Model")]
    columns: bool,
}

impl DialectArgs {
    pub(crate) fn operators(self) -> Operators {
        self.operators.unwrap_or_default()
    }

    pub(crate) fn form(self) -> MatrixForm {
        if self.columns {
            MatrixForm::Columns
        } else {
            MatrixForm::Rows
        }
    }
}

/// Order of bytes in binary files.
#[derive(Args, Debug)]
pub(super) struct Order {
    /// Write little-endian numbers; reading recognizes them
    #[arg(long)]
    little_endian: bool,
}

impl Order {
    pub(super) fn bytes(&self) -> ByteOrder {
        if self.little_endian {
            ByteOrder::Little
        } else {
            ByteOrder::Big
        }
    }
}

/// Three different bytes, separated by commas.
fn operators(text: &str) -> Result<Operators, String> {
    let numbers: Result<Vec<u8>, _> = text.split(',').map(str::parse).collect();
    let codes: Option<[u8; 3]> = numbers.ok().and_then(|list| list.try_into().ok());
    let wrong = "expected three different numbers from 0 to 255, as in 0,1,2";
    codes
        .and_then(Operators::new)
        .ok_or_else(|| wrong.to_owned())
}

/// Reads a whole file in one of the thesis' formats; also its name for messages.
pub(super) fn read_input<T>(
    path: &std::path::Path,
    read: impl FnOnce(&[u8]) -> Result<Decoded<T>, Error>,
) -> Result<(String, Decoded<T>), Failure> {
    let input = Input::new(path.to_owned());
    let name = input.name();
    let bytes = input.bytes()?;
    match read(&bytes) {
        Ok(decoded) => Ok((name, decoded)),
        Err(error) => Err(Failure::BadInput(format!("{name}: {error}"))),
    }
}
