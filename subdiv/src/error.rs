//! What can go wrong in a subdivision.

/// Why no boundary came out.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The tolerance is zero, negative or not a number.
    #[error("the tolerance must be a positive number, found {0}")]
    Tolerance(f64),
    /// A level is deeper than the lattice allows.
    #[error("level {asked} is too deep, the deepest is {deepest}")]
    Level {
        /// What was asked.
        asked: u8,
        /// What is possible.
        deepest: u8,
    },
    /// More leaves than allowed.
    #[error("more than {limit} cells would be needed (raise the limit, or the tolerance)")]
    TooManyCells {
        /// The limit.
        limit: u64,
    },
    /// More memory than allowed.
    #[error("more than {limit} bytes would be needed (raise the limit, or the tolerance)")]
    TooMuchMemory {
        /// The limit.
        limit: u64,
    },
    /// More surfaces in one leaf than can be arranged.
    #[error("{count} surfaces meet in one cell near ({x}, {y}, {z}), at most 128 can be arranged")]
    TooManySurfaces {
        /// How many.
        count: usize,
        /// Where, in model units.
        x: f64,
        /// Where, in model units.
        y: f64,
        /// Where, in model units.
        z: f64,
    },
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// No threads could be started.
    #[error("cannot start {0} threads")]
    Threads(usize),
}
