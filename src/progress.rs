//! Progress bars, and Ctrl-C.

use indicatif::{ProgressBar, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::Duration;

/// Exit code after Ctrl-C, as shells have it: 128 + SIGINT.
pub(crate) const INTERRUPTED: u8 = 130;

/// Whether Ctrl-C was pressed. A signal reaches the whole process, so this is the process's.
static CANCELLED: AtomicBool = AtomicBool::new(false);

/// From now on Ctrl-C asks for an orderly end, and a second one ends the program at once.
pub(crate) fn watch_interrupts() {
    // Without a handler Ctrl-C still ends the program; only temporary files may stay.
    let _ = ctrlc::set_handler(|| {
        if CANCELLED.swap(true, Relaxed) {
            std::process::exit(i32::from(INTERRUPTED));
        }
    });
}

/// Whether Ctrl-C was pressed.
pub(crate) fn cancelled() -> bool {
    CANCELLED.load(Relaxed)
}

/// A bar on standard error, invisible unless that is a terminal.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// `quiet`: invisible even on a terminal.
    pub(crate) fn new(quiet: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::no_length()
        };
        bar.enable_steady_tick(Duration::from_millis(100));
        Self { bar }
    }

    /// A stage of unknown length begins.
    pub(crate) fn begin(&self, name: &str) {
        subdiv::Observer::stage(self, name, None);
    }

    /// Lets others write to standard error.
    pub(crate) fn hidden_while<T>(&self, speak: impl FnOnce() -> T) -> T {
        self.bar.suspend(speak)
    }

    /// The bar disappears.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl subdiv::Observer for Progress {
    fn stage(&self, name: &str, total: Option<u64>) {
        let template = match total {
            Some(_) => "{msg:>12} [{wide_bar}] {percent:>3}% {elapsed}",
            None => "{msg:>12} {spinner} {elapsed}",
        };
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar.set_style(style.progress_chars("=> "));
        }
        self.bar.set_position(0);
        match total {
            Some(total) => self.bar.set_length(total),
            None => self.bar.unset_length(),
        }
        self.bar.set_message(name.to_owned());
    }

    fn advance(&self, steps: u64) {
        self.bar.inc(steps);
    }

    fn cancelled(&self) -> bool {
        cancelled()
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}
