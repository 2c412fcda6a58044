//! What a run did and measured, as data; `--report` writes it as JSON.
//!
//! Lengths are in model units, times in seconds. Names are stable within a `schema_version`;
//! what could not be measured or proved is null.

use brep::{Brep, Groups, Properties, Retriangulated, Shells, Tessellated};
use serde::Serialize;
use std::time::Instant;

/// Raised when a name changes its meaning or disappears, not when one is added.
const SCHEMA_VERSION: u32 = 1;

/// The whole report.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Report {
    schema_version: u32,
    /// The model.
    pub(crate) input: InputReport,
    /// How it was converted.
    pub(crate) settings: SettingsReport,
    /// What took how long, in order.
    pub(crate) stages: Vec<Stage>,
    /// From the first byte read to the last one written.
    pub(crate) total_seconds: f64,
    /// The most memory the process held.
    pub(crate) peak_memory_bytes: Option<u64>,
    /// Numbers of things.
    pub(crate) counts: Counts,
    /// Sum of the shells' genera.
    pub(crate) genus: Option<u64>,
    /// Of the mesh.
    pub(crate) area: Option<f64>,
    /// Of the mesh.
    pub(crate) volume: Option<f64>,
    /// Proved bounds of the true solid's volume.
    pub(crate) volume_interval: Option<[f64; 2]>,
    /// Of the mesh; none if it is empty.
    pub(crate) centroid: Option<[f64; 3]>,
    /// Largest proved distance between mesh and true boundary over all certified cells.
    pub(crate) proved_distance: Option<f64>,
    /// Largest distance of a facet from its surface, measured, where facets were taken from the
    /// surfaces.
    pub(crate) largest_deviation: Option<f64>,
    /// Whether mesh and true boundary were proved to be connected in the same way.
    pub(crate) proved_topology: bool,
    /// Where nothing is proved; the first of these places.
    pub(crate) uncertified: Vec<Uncertified>,
    /// Number of all such places.
    pub(crate) uncertified_count: u64,
    /// Whether a clip box bounds the solid.
    pub(crate) clipped: bool,
    /// Surfaces that differ by so little that they were probably meant to be one.
    pub(crate) nearly_equal_primitives: Vec<NearlyEqual>,
    /// Vertices doubled where the boundary touches itself.
    pub(crate) split_vertices: u64,
    /// What was said about the model.
    pub(crate) warnings: Vec<String>,
    /// Why the run ended early, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<String>,
}

/// The model's origin.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct InputReport {
    pub(crate) name: String,
    pub(crate) format: Option<&'static str>,
}

/// The settings in force.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct SettingsReport {
    /// In model units; none with a fixed level.
    pub(crate) tolerance: Option<f64>,
    pub(crate) level: Option<u8>,
    /// Whether subdivision ends as soon as the topology is proved; the tolerance is then the
    /// size of the finest cells.
    pub(crate) topology_only: bool,
    pub(crate) max_level: Option<u8>,
    pub(crate) criterion: &'static str,
    pub(crate) mesh: &'static str,
    /// Smallest, then largest coordinates.
    #[serde(rename = "box")]
    pub(crate) clip: Option<[f64; 6]>,
    pub(crate) facet_limit: u32,
    pub(crate) max_degree: u8,
    pub(crate) max_cells: u64,
    pub(crate) max_memory_bytes: u64,
    pub(crate) threads: Option<usize>,
}

/// A stage and its duration.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Stage {
    pub(crate) name: &'static str,
    pub(crate) seconds: f64,
}

/// Numbers of things.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub(crate) struct Counts {
    pub(crate) leaves: u64,
    pub(crate) bisections: u64,
    /// Facets before planar faces were merged.
    pub(crate) leaf_facets: u64,
    /// Planar faces triangulated from their edges.
    pub(crate) merged_faces: u64,
    /// Planar faces that were to be merged and could not.
    pub(crate) unmerged_faces: u64,
    /// Faces whose facets were taken from their surfaces.
    pub(crate) tessellated_faces: u64,
    /// B-Rep edges that could not be followed, so that they kept the subdivision's vertices.
    pub(crate) kept_edges: u64,
    pub(crate) facets: u64,
    pub(crate) vertices: u64,
    pub(crate) brep_faces: u64,
    pub(crate) brep_edges: u64,
    pub(crate) brep_vertices: u64,
    pub(crate) shells: u64,
    pub(crate) solids: u64,
}

/// A place where nothing is proved.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Uncertified {
    pub(crate) position: [f64; 3],
    pub(crate) size: f64,
    pub(crate) primitives: Vec<u32>,
    pub(crate) reason: &'static str,
}

/// Two surfaces that are suspiciously close to each other.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct NearlyEqual {
    pub(crate) primitives: [u32; 2],
    pub(crate) difference: f64,
}

impl Report {
    /// Nothing done yet.
    pub(crate) fn new(input: InputReport, settings: SettingsReport) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            input,
            settings,
            stages: Vec::new(),
            total_seconds: 0.0,
            peak_memory_bytes: None,
            counts: Counts::default(),
            genus: None,
            area: None,
            volume: None,
            volume_interval: None,
            centroid: None,
            proved_distance: None,
            largest_deviation: None,
            proved_topology: false,
            uncertified: Vec::new(),
            uncertified_count: 0,
            clipped: false,
            nearly_equal_primitives: Vec::new(),
            split_vertices: 0,
            warnings: Vec::new(),
            error: None,
        }
    }

    /// Runs a stage and notes its duration.
    pub(crate) fn timed<T>(&mut self, name: &'static str, stage: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = stage();
        let seconds = start.elapsed().as_secs_f64();
        self.stages.push(Stage { name, seconds });
        result
    }

    /// As JSON, indented, with a final line feed.
    pub(crate) fn to_json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// What a subdivision proved and counted.
    pub(crate) fn add_subdivision(&mut self, of: &subdiv::Report) {
        self.counts.leaves = of.leaves;
        self.counts.bisections = of.bisections;
        self.proved_distance = of.largest_deviation;
        self.proved_topology = of.proved_topology == Some(true);
        self.split_vertices = of.split_vertices;
        self.uncertified_count = of.uncertified_leaves;
        self.uncertified = of.uncertified.iter().map(Uncertified::from).collect();
        let names = ["subdivision", "balance", "extraction"];
        let stages = names.into_iter().zip(of.seconds);
        self.stages
            .extend(stages.map(|(name, seconds)| Stage { name, seconds }));
    }

    /// What became of planar faces.
    pub(crate) fn add_merging(&mut self, of: &Retriangulated) {
        self.counts.leaf_facets = of.facets_before as u64;
        self.counts.merged_faces = of.faces as u64;
        self.counts.unmerged_faces = of.kept as u64;
    }

    /// What became of faces that were tessellated from their surfaces.
    pub(crate) fn add_tessellation(&mut self, of: &Tessellated) {
        self.counts.leaf_facets = of.facets_before as u64;
        self.counts.tessellated_faces = of.faces as u64;
        self.counts.kept_edges = of.kept_edges as u64;
        self.largest_deviation = Some(of.largest_deviation);
    }

    /// What is known about the solid before it is subdivided.
    pub(crate) fn add_solid(&mut self, solid: &csg::Solid) {
        self.clipped = solid.clipped;
        let pairs = solid.nearly_equal.iter().map(|pair| NearlyEqual {
            primitives: [pair.first.0, pair.second.0],
            difference: pair.difference,
        });
        self.nearly_equal_primitives = pairs.collect();
    }

    /// What the boundary is made of, and its measures.
    pub(crate) fn add_boundary(
        &mut self,
        brep: &Brep,
        groups: &Groups,
        shells: &Shells,
        properties: &Properties,
    ) {
        self.counts.facets = brep.facet_count() as u64;
        self.counts.vertices = brep.vertex_count() as u64;
        self.counts.brep_faces = groups.faces.len() as u64;
        self.counts.brep_edges = groups.edges.len() as u64;
        self.counts.brep_vertices = groups.vertices.len() as u64;
        self.counts.shells = shells.shells.len() as u64;
        self.counts.solids = shells.solids.len() as u64;
        self.genus = Some(shells.genus());
        self.area = finite(properties.area);
        self.volume = finite(properties.volume);
        let has_center = brep.facet_count() > 0 && properties.centroid.is_finite();
        self.centroid = has_center.then(|| properties.centroid.to_array());
    }
}

/// JSON has no other numbers.
fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl From<&subdiv::Spot> for Uncertified {
    fn from(spot: &subdiv::Spot) -> Self {
        Self {
            position: spot.position.to_array(),
            size: spot.size,
            primitives: spot.primitives.iter().map(|p| p.0).collect(),
            reason: match spot.reason {
                subdiv::Reason::Singular => "singular",
                subdiv::Reason::Tangent => "tangent",
                subdiv::Reason::Crowded => "crowded",
                subdiv::Reason::Concurrent => "concurrent",
                subdiv::Reason::Wall => "wall",
            },
        }
    }
}
