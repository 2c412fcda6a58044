//! Readers and writers: bytes of a file to a [`csg::Model`], and a boundary to bytes of a file.

pub mod read;
pub mod thesis;
pub mod write;
