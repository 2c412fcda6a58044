//! A reader that stops what grows without end.

use std::io::{self, BufRead, Read};

/// The largest single element, text or comment.
const LARGEST_EVENT: u64 = 1 << 20;

/// Hands on what another reader reads, as long as the whole and each event stay below a limit.
///
/// An archive of a few kilobytes can unfold to gigabytes, and the XML reader keeps a whole event
/// in memory.
pub(super) struct Metered<R> {
    inner: R,
    whole: u64,
    event: u64,
}

impl<R: BufRead> Metered<R> {
    /// At most `most` bytes.
    pub(super) fn new(inner: R, most: u64) -> Self {
        Self {
            inner,
            whole: most,
            event: LARGEST_EVENT,
        }
    }

    /// A new event begins.
    pub(super) fn begin_event(&mut self) {
        self.event = LARGEST_EVENT;
    }
}

impl<R: BufRead> BufRead for Metered<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.whole == 0 || self.event == 0 {
            let what = if self.whole == 0 {
                "its text unfolds to more than memory allows"
            } else {
                "one element is longer than a megabyte"
            };
            return Err(io::Error::new(io::ErrorKind::FileTooLarge, what));
        }
        let most = usize::try_from(self.whole.min(self.event)).unwrap_or(usize::MAX);
        let found = self.inner.fill_buf()?;
        Ok(found.get(..found.len().min(most)).unwrap_or(found))
    }

    fn consume(&mut self, amount: usize) {
        self.whole = self.whole.saturating_sub(amount as u64);
        self.event = self.event.saturating_sub(amount as u64);
        self.inner.consume(amount);
    }
}

impl<R: BufRead> Read for Metered<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let found = self.fill_buf()?;
        let length = found.len().min(into.len());
        if let (Some(to), Some(from)) = (into.get_mut(..length), found.get(..length)) {
            to.copy_from_slice(from);
        }
        self.consume(length);
        Ok(length)
    }
}
