//! Cells and memory used so far by all threads, against what the user allows.

use crate::error::Error;
use crate::settings::{Observer, Settings};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

/// Peak bytes a leaf costs, all stages together: some two triangles with their share of
/// vertices, names and half-edges (measured: `docs/performance.md`).
const BYTES_PER_CELL: u64 = 400;

/// Shared by all threads of a run.
pub(crate) struct Budget<'a> {
    max_cells: u64,
    max_memory_bytes: u64,
    cells: AtomicU64,
    exhausted: AtomicBool,
    observer: &'a dyn Observer,
}

impl<'a> Budget<'a> {
    /// Nothing used yet.
    pub(crate) fn new(settings: &Settings, observer: &'a dyn Observer) -> Self {
        Self {
            max_cells: settings.max_cells,
            max_memory_bytes: settings.max_memory_bytes,
            cells: AtomicU64::new(0),
            exhausted: AtomicBool::new(false),
            observer,
        }
    }

    /// Starts counting anew.
    pub(crate) fn restart(&self) {
        self.cells.store(0, Relaxed);
    }

    /// Counts more leaves.
    pub(crate) fn add_cells(&self, more: u64) {
        let cells = self.cells.fetch_add(more, Relaxed) + more;
        if cells > self.max_cells.min(self.max_memory_bytes / BYTES_PER_CELL)
            || self.observer.cancelled()
        {
            self.exhausted.store(true, Relaxed);
        }
    }

    /// Whether to give up.
    pub(crate) fn stopped(&self) -> bool {
        self.exhausted.load(Relaxed)
    }

    /// The reason to give up, if any.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if !self.stopped() {
            return Ok(());
        }
        let cells = self.cells.load(Relaxed);
        Err(if self.observer.cancelled() {
            Error::Cancelled
        } else if cells > self.max_cells {
            Error::TooManyCells {
                limit: self.max_cells,
            }
        } else {
            Error::TooMuchMemory {
                limit: self.max_memory_bytes,
            }
        })
    }
}
