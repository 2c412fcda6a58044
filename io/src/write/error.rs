//! Why a boundary could not be written.

use glam::DVec3;
use std::path::PathBuf;

/// A file that could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The stream refused the bytes.
    #[error("cannot write the output")]
    Io(#[from] std::io::Error),
    /// The file could not be made, or not be put in its place.
    #[error("cannot write {}", path.display())]
    File {
        /// The file that was asked for.
        path: PathBuf,
        /// What the system says.
        #[source]
        source: std::io::Error,
    },
    /// A coordinate too large for a format that stores 32-bit floats.
    #[error("the position {position} is beyond the range of the format's 32-bit numbers")]
    BeyondSinglePrecision {
        /// The first such position.
        position: DVec3,
    },
    /// More bytes or triangles than the format can count.
    #[error("{size} {unit} are more than the format can hold")]
    TooLarge {
        /// How many there are.
        size: usize,
        /// What was counted.
        unit: &'static str,
    },
    /// The description of a glTF file could not be made.
    #[error("cannot describe the model in JSON")]
    Json(#[from] serde_json::Error),
    /// A GLB file could not be put together.
    #[error("cannot write the output")]
    Glb(#[source] gltf::Error),
    /// A STEP file could not be put together.
    #[error("cannot describe the solid in STEP: {reason}")]
    Step {
        /// What is wrong with which entity.
        reason: String,
    },
    /// A cavity that no solid encloses.
    #[error("a cavity lies in no solid, which STEP cannot say; a smaller tolerance may help")]
    StrayVoid,
    /// Facets that readers of STEP would take for lines.
    #[error(
        "{count} facets are thinner than {size:e}, which STEP readers would not see; another \
         tolerance may help"
    )]
    ThinFacets {
        /// How many.
        count: usize,
        /// Smallest size, in model units.
        size: f64,
    },
    /// A picture could not be encoded.
    #[error("cannot encode the picture")]
    Png(#[from] png::EncodingError),
    /// Rays could not be followed through the solid.
    #[error("cannot trace rays")]
    Rays(#[from] subdiv::Error),
    /// A picture without pixels, or with more than can be rendered.
    #[error("a picture of {width} × {height} pixels cannot be rendered")]
    PictureSize {
        /// Pixels a row.
        width: u32,
        /// Rows.
        height: u32,
    },
}
