//! What `properties --json` prints; its schema is published in `docs/properties.schema.json`.

use super::Measured;
use brep::Properties;
use schemars::JsonSchema;
use serde::Serialize;

/// Raised when a name changes its meaning or disappears, not when one is added.
const SCHEMA_VERSION: u32 = 1;

/// Area, volume, centroid and inertia of a model or mesh, together and of each solid.
///
/// Lengths are in the model's or file's own unit, the density is 1. What could not be measured or
/// proved is null.
#[derive(Serialize, JsonSchema, Debug)]
#[schemars(title = "Properties")]
pub(crate) struct PropertiesReport {
    /// Raised when a name changes its meaning or disappears, not when one is added.
    schema_version: u32,
    /// Path as given; `-` is standard input.
    name: String,
    /// Format it was read as.
    format: Option<&'static str>,
    /// Unit of length, if the file is a mesh that names one.
    unit: Option<String>,
    /// Triangles that were measured.
    triangles: u64,
    /// Largest proved distance between mesh and true boundary over all certified cells, of a model.
    proved_distance: Option<f64>,
    /// Largest distance of a facet from its surface, measured, where facets were taken from the
    /// surfaces of a model.
    largest_deviation: Option<f64>,
    /// Number of cells where nothing is proved, of a model.
    uncertified_count: Option<u64>,
    /// What was said about the input.
    warnings: Vec<String>,
    /// All solids together.
    total: Total,
    /// Connected pieces of matter.
    solids: Vec<SolidMeasures>,
}

/// Measures of one or several solids.
#[derive(Serialize, JsonSchema, Debug)]
struct Measures {
    /// Surface area, cavities included.
    area: f64,
    /// Volume without cavities.
    volume: f64,
    /// Centre of mass; null if there is none.
    centroid: Option<[f64; 3]>,
    /// Inertia tensor about the centroid, row by row.
    inertia: [[f64; 3]; 3],
    /// Smallest and largest coordinates; null if it is empty.
    #[serde(rename = "box")]
    bounds: Option<[[f64; 3]; 2]>,
}

/// Measures of all solids.
#[derive(Serialize, JsonSchema, Debug)]
struct Total {
    #[serde(flatten)]
    measures: Measures,
    /// Proved bounds of the true volume, of a model.
    volume_interval: Option<[f64; 2]>,
}

/// Measures of one solid.
#[derive(Serialize, JsonSchema, Debug)]
struct SolidMeasures {
    #[serde(flatten)]
    measures: Measures,
    /// Its outer shell and its cavities.
    shells: u64,
    /// Sum of its shells' genera.
    genus: u64,
}

impl Measures {
    fn of(properties: &Properties) -> Self {
        let bounds = properties.bounds;
        let is_empty = bounds.is_empty();
        Self {
            area: properties.area,
            volume: properties.volume,
            centroid: (!is_empty).then(|| properties.centroid.to_array()),
            inertia: [0, 1, 2].map(|row| properties.inertia.row(row).to_array()),
            bounds: (!is_empty).then(|| [bounds.min.to_array(), bounds.max.to_array()]),
        }
    }
}

impl PropertiesReport {
    pub(super) fn of(measured: &Measured) -> Self {
        let report = measured.source.report.as_ref();
        let solids = measured.solids.iter().enumerate();
        Self {
            schema_version: SCHEMA_VERSION,
            name: measured.source.name.clone(),
            format: measured.source.format,
            unit: measured.source.unit.clone(),
            triangles: measured.triangles,
            proved_distance: report.and_then(|report| report.proved_distance),
            largest_deviation: report.and_then(|report| report.largest_deviation),
            uncertified_count: report.map(|report| report.uncertified_count),
            warnings: measured.source.warnings.clone(),
            total: Total {
                measures: Measures::of(&measured.total),
                volume_interval: report.and_then(|report| report.volume_interval),
            },
            solids: solids
                .map(|(at, properties)| SolidMeasures {
                    measures: Measures::of(properties),
                    shells: measured.shells_of(at).count() as u64,
                    genus: measured.genus(at),
                })
                .collect(),
        }
    }
}
