//! Whether what is written would be read: a file named twice, also behind `<` and `>`, or a pipe
//! led back to where it comes from.

use crate::input::Input;
use crate::run::Target;

/// What an input and a target are when they are one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Loop {
    /// One file.
    File,
    /// The two ends of one pipe.
    Pipe,
}

/// Whether a target is what the input is read from. Terminals and devices may be both.
///
/// Nothing is opened for this: a pipe's writer would take note of it.
#[cfg(unix)]
pub(crate) fn find_loop(input: &Input, target: &Target) -> Option<Loop> {
    use std::fs::metadata;
    use std::os::fd::AsFd;
    use std::os::unix::fs::{FileTypeExt, MetadataExt};

    if let (Input::File(from), Target::File(to)) = (input, target)
        && from == to
    {
        // Also where neither exists yet.
        return Some(Loop::File);
    }
    let of_stream = |stream: &dyn AsFd| {
        let copy = stream.as_fd().try_clone_to_owned();
        copy.and_then(|copy| std::fs::File::from(copy).metadata())
    };
    let from = match input {
        Input::Stdin => of_stream(&std::io::stdin()),
        Input::File(path) => metadata(path),
        Input::Read { .. } => return None,
    };
    let to = match target {
        Target::Stdout => of_stream(&std::io::stdout()),
        Target::File(path) => metadata(path),
    };
    let (from, to) = (from.ok()?, to.ok()?);
    if (from.dev(), from.ino()) != (to.dev(), to.ino()) {
        return None;
    }
    let kind = from.file_type();
    if kind.is_file() {
        Some(Loop::File)
    } else {
        kind.is_fifo().then_some(Loop::Pipe)
    }
}

/// Whether a target is what the input is read from; only files that are named are recognized.
#[cfg(not(unix))]
pub(crate) fn find_loop(input: &Input, target: &Target) -> Option<Loop> {
    let (Target::File(target), Input::File(input)) = (target, input) else {
        return None;
    };
    let (from, to) = (input.canonicalize().ok()?, target.canonicalize().ok()?);
    (from == to).then_some(Loop::File)
}
