//! Half-edge boundary representation.
