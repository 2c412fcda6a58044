//! What a run did and measured, as data; `--report` writes it as JSON.
//!
//! Lengths are in model units, times in seconds. Names are stable within a `schema_version`;
//! what could not be measured or proved is null.

use crate::summary::{counted, rounded_up};
use brep::{Brep, Groups, Properties, Quality, Retriangulated, Shells, Tessellated};
use io::write::step;
use schemars::JsonSchema;
use serde::Serialize;
use std::time::Instant;

/// Raised when a name changes its meaning or disappears, not when one is added.
const SCHEMA_VERSION: u32 = 1;

/// What csg2brep did with a model and what it measured.
///
/// Lengths are in model units, times in seconds. Names are stable within a `schema_version`; what
/// could not be measured or proved is null.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Report {
    /// Raised when a name changes its meaning or disappears, not when one is added.
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
    /// Surface area of the mesh.
    pub(crate) area: Option<f64>,
    /// Volume that the mesh encloses.
    pub(crate) volume: Option<f64>,
    /// Proved bounds of the true solid's volume.
    pub(crate) volume_interval: Option<[f64; 2]>,
    /// Centre of mass of what the mesh encloses; null if it is empty.
    pub(crate) centroid: Option<[f64; 3]>,
    /// Largest proved distance between mesh and true boundary over all certified cells.
    pub(crate) proved_distance: Option<f64>,
    /// Facets from surfaces: a proved bound on the distance of every point of the mesh from the true
    /// boundary. The other way it is `proved_distance`.
    pub(crate) proved_from_mesh: Option<f64>,
    /// Largest distance of a facet from its surface, measured, where facets were taken from the
    /// surfaces.
    pub(crate) largest_deviation: Option<f64>,
    /// Number of certified cells in whose neighbourhood only the distance from the mesh to the
    /// true boundary is proved.
    pub(crate) one_way_cells: u64,
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
    /// Surfaces whose coefficients have lost digits to cancellation.
    pub(crate) imprecise_primitives: Vec<Imprecise>,
    /// Vertices doubled where the boundary touches itself.
    pub(crate) split_vertices: u64,
    /// Closed pieces that were dropped: no larger than 2.5 cells, and among cells that are not certified.
    pub(crate) specks: u64,
    /// Faces like that which became part of a neighbour.
    pub(crate) crumbs: u64,
    /// Faces narrower than the tolerance that the true boundary does not have, where surfaces
    /// touch; each became part of a neighbour.
    pub(crate) ghost_faces: u64,
    /// Nodes of the model without a closed form, for which flat shapes were taken; the warnings say
    /// how near they are. Everything else here is about the model with those shapes.
    pub(crate) approximated_nodes: u64,
    /// Cells in which facets of different surfaces cross by rounding of their positions; elsewhere
    /// none cross.
    pub(crate) crossing_cells: u64,
    /// Shapes of the facets; null if there are none.
    pub(crate) quality: Option<QualityReport>,
    /// What became of the solids in the STEP file; null if none was written.
    pub(crate) step: Option<StepReport>,
    /// What was said about the model.
    pub(crate) warnings: Vec<String>,
    /// Why the run ended early, if it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) error: Option<String>,
}

/// The model's origin.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct InputReport {
    /// Path as given; `-` is standard input.
    pub(crate) name: String,
    /// Format it was read as; null if that was not found out.
    pub(crate) format: Option<&'static str>,
}

/// The settings in force.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct SettingsReport {
    /// In model units; none with a fixed level.
    pub(crate) tolerance: Option<f64>,
    /// Bisection level of all cells, if it was fixed.
    pub(crate) level: Option<u8>,
    /// Whether subdivision ends as soon as the topology is proved; the tolerance is then the
    /// size of the finest cells.
    pub(crate) topology_only: bool,
    /// Deepest bisection level allowed; null: the one at which cells are as small as the tolerance.
    pub(crate) max_level: Option<u8>,
    /// How polynomials are bounded.
    pub(crate) criterion: &'static str,
    /// Whether planar faces are filled from their edges or left in pieces.
    pub(crate) mesh: &'static str,
    /// Whether corners lie on the true surfaces or on the average around them.
    pub(crate) fit: &'static str,
    /// The clip box: smallest, then largest coordinates.
    #[serde(rename = "box")]
    pub(crate) clip: Option<[f64; 6]>,
    /// Largest `$fn` that means a polyhedron.
    pub(crate) facet_limit: u32,
    /// Largest degree of a polynomial in the model.
    pub(crate) max_degree: u8,
    /// Most cells that may meet the boundary.
    pub(crate) max_cells: u64,
    /// Most memory that the subdivision may take.
    pub(crate) max_memory_bytes: u64,
    /// Threads asked for; null: one for each core. Never changes the result.
    pub(crate) threads: Option<usize>,
}

/// A stage and its duration.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Stage {
    /// What was done.
    pub(crate) name: &'static str,
    /// How long it took.
    pub(crate) seconds: f64,
}

/// Numbers of things.
#[derive(Clone, Copy, Debug, Default, Serialize, JsonSchema)]
pub(crate) struct Counts {
    /// Cells of the subdivision that meet the boundary.
    pub(crate) leaves: u64,
    /// Bisections made for them.
    pub(crate) bisections: u64,
    /// Facets before planar faces were merged.
    pub(crate) leaf_facets: u64,
    /// Planar faces triangulated from their edges.
    pub(crate) merged_faces: u64,
    /// Planar faces that were to be merged and could not.
    pub(crate) unmerged_faces: u64,
    /// Faces whose facets were taken from their surfaces.
    pub(crate) tessellated_faces: u64,
    /// Faces that were to get such facets and kept the subdivision's, since others would pass through each other.
    pub(crate) kept_faces: u64,
    /// B-Rep edges that could not be followed, so that they kept the subdivision's vertices.
    pub(crate) kept_edges: u64,
    /// Triangles written.
    pub(crate) facets: u64,
    /// Vertices written.
    pub(crate) vertices: u64,
    /// Connected parts of one surface.
    pub(crate) brep_faces: u64,
    /// Curves between two of them.
    pub(crate) brep_edges: u64,
    /// Points where curves end.
    pub(crate) brep_vertices: u64,
    /// Connected parts of the boundary, cavities included.
    pub(crate) shells: u64,
    /// Connected pieces of matter.
    pub(crate) solids: u64,
}

/// A place where nothing is proved.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Uncertified {
    /// Middle of the cell.
    pub(crate) position: [f64; 3],
    /// Its longest edge.
    pub(crate) size: f64,
    /// The surfaces involved, as `csg2brep info` numbers them.
    pub(crate) primitives: Vec<u32>,
    /// What went wrong.
    pub(crate) reason: &'static str,
}

/// Two surfaces that are suspiciously close to each other.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(crate) struct NearlyEqual {
    /// The two, as `csg2brep info` numbers them.
    pub(crate) primitives: [u32; 2],
    /// Largest difference of their coefficients, scaled to 1 over the model's domain.
    pub(crate) difference: f64,
}

/// A surface whose coefficients have lost digits.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(crate) struct Imprecise {
    /// As `csg2brep info` numbers it.
    pub(crate) primitive: u32,
    /// Bound on the error of the polynomial's values, relative to their usual size.
    pub(crate) uncertainty: f64,
}

/// Shapes of the facets.
#[derive(Clone, Copy, Debug, Serialize, JsonSchema)]
pub(crate) struct QualityReport {
    /// Smallest angle of all facets, in degrees.
    pub(crate) smallest_angle_deg: f64,
    /// Mean of each facet's smallest angle, in degrees.
    pub(crate) mean_angle_deg: f64,
    /// Facets with an angle below one degree.
    pub(crate) slivers: u64,
    /// Largest ratio of a facet's longest edge to its height over it; null with a facet without
    /// area.
    pub(crate) largest_aspect: Option<f64>,
    /// Length of the shortest edge.
    pub(crate) shortest_edge: f64,
}

/// A STEP file.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct StepReport {
    /// Solids in it.
    pub(crate) solids: u64,
    /// Solids left out: they were smaller than the tolerance, and points in truth.
    pub(crate) specks: u64,
    /// Those of them that are plane facets for want of a true form.
    pub(crate) faceted: Vec<FacetedSolid>,
    /// Faces on true surfaces.
    pub(crate) faces: u64,
    /// Surfaces that STEP has no entity of their own for, said exactly by more general ones.
    pub(crate) substitutes: Vec<SubstituteReport>,
    /// Edges that are splines, for want of a closed form.
    pub(crate) spline_edges: u64,
    /// Largest distance of such a spline from its surfaces.
    pub(crate) accuracy: f64,
    /// Edges merged away since their ends are one point in truth.
    pub(crate) crumb_edges: u64,
    /// Faces merged away with them.
    pub(crate) crumb_faces: u64,
    /// Faces, or ends of faces, merged away since they have no width in truth.
    pub(crate) slivers: u64,
    /// Whether no mesh was written beside it.
    #[serde(skip)]
    pub(crate) is_alone: bool,
}

/// A surface that STEP has no entity of its own for.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct SubstituteReport {
    /// The surface's number, as `info` lists them.
    pub(crate) surface: u32,
    /// What says it in the file.
    pub(crate) entity: &'static str,
    /// Faces on it.
    pub(crate) faces: u64,
}

/// A solid that was written as plane facets.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct FacetedSolid {
    /// Its name in the file.
    pub(crate) name: String,
    /// Why it has no true form there.
    pub(crate) reason: String,
}

impl StepReport {
    pub(crate) fn new(of: step::Outcome, accuracy: f64, is_alone: bool) -> Self {
        let faceted = of.faceted.into_iter().map(|solid| FacetedSolid {
            name: solid.name,
            reason: solid.reason,
        });
        let substitutes = of.substitutes.into_iter().map(|of| SubstituteReport {
            surface: of.surface.0,
            entity: of.entity,
            faces: of.faces as u64,
        });
        Self {
            solids: of.solids as u64,
            specks: of.specks as u64,
            faceted: faceted.collect(),
            faces: of.faces as u64,
            substitutes: substitutes.collect(),
            spline_edges: of.spline_edges as u64,
            accuracy,
            crumb_edges: of.crumbs.edges as u64,
            crumb_faces: of.crumbs.faces as u64,
            slivers: of.crumbs.slivers as u64,
            is_alone,
        }
    }
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
            proved_from_mesh: None,
            largest_deviation: None,
            one_way_cells: 0,
            proved_topology: false,
            uncertified: Vec::new(),
            uncertified_count: 0,
            clipped: false,
            nearly_equal_primitives: Vec::new(),
            imprecise_primitives: Vec::new(),
            split_vertices: 0,
            specks: 0,
            crumbs: 0,
            ghost_faces: 0,
            approximated_nodes: 0,
            crossing_cells: 0,
            quality: None,
            step: None,
            warnings: Vec::new(),
            error: None,
        }
    }

    /// Size of the largest cell in which nothing is proved.
    pub(crate) fn largest_uncertified(&self) -> Option<f64> {
        let sizes = self.uncertified.iter().map(|place| place.size);
        sizes.max_by(f64::total_cmp)
    }

    /// The deviation in words, and whether it is proved: `exact`, where nothing but the rounding
    /// of numbers is left and nothing is unproved.
    pub(crate) fn deviation(&self) -> Option<String> {
        let rounding = 1e-9 * self.settings.tolerance.unwrap_or(0.0);
        if let Some(measured) = self.largest_deviation {
            let is_exact = measured <= rounding && self.proved_topology;
            return Some(match (self.proved_distance, self.proved_from_mesh) {
                _ if is_exact => self.exact(),
                (Some(proved), _) => format!("deviation <= {}", rounded_up(proved)),
                (None, Some(proved)) if proved > rounding => {
                    format!("deviation <= {} (of the mesh)", rounded_up(proved))
                }
                _ => format!("deviation {} (measured)", rounded_up(measured)),
            });
        }
        let distance = self.proved_distance?;
        let is_whole = self.uncertified_count == 0 && self.one_way_cells == 0;
        let bound = match (distance <= rounding, is_whole) {
            (true, true) => return Some(self.exact()),
            (true, false) => return None,
            (false, _) => rounded_up(distance),
        };
        Some(format!("deviation <= {bound}"))
    }

    fn exact(&self) -> String {
        match self.approximated_nodes {
            0 => "exact".to_owned(),
            count => format!("exact but for {}", counted(count, "approximated node")),
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

    /// Counts what was done to the mesh after its deviation was proved.
    pub(crate) fn add_deviation(&mut self, moved: f64) {
        self.proved_distance = self.proved_distance.map(|proved| proved + moved);
    }

    /// What a subdivision proved and counted.
    pub(crate) fn add_subdivision(&mut self, of: &subdiv::Report) {
        self.counts.leaves = of.leaves;
        self.counts.bisections = of.bisections;
        self.proved_distance = of.largest_deviation;
        self.proved_topology = of.proved_topology == Some(true);
        self.one_way_cells = of.one_way_leaves;
        self.volume_interval = of.volume_interval;
        self.split_vertices = of.split_vertices;
        self.specks = of.specks;
        self.crumbs = of.crumbs;
        self.crossing_cells = of.crossing_leaves;
        self.uncertified_count = of.uncertified_leaves;
        self.uncertified = of.uncertified.iter().map(Uncertified::from).collect();
        let names = ["subdivision", "balance", "extraction"];
        let stages = names.into_iter().zip(of.seconds);
        self.stages
            .extend(stages.map(|(name, seconds)| Stage { name, seconds }));
    }

    /// What is known of a finer boundary that takes the place of this one.
    pub(crate) fn replace_boundary(&mut self, finer: Self) {
        self.counts = finer.counts;
        self.proved_topology = finer.proved_topology;
        self.split_vertices = finer.split_vertices;
        self.specks = finer.specks;
        self.crumbs = finer.crumbs;
        self.crossing_cells = finer.crossing_cells;
        self.uncertified_count = finer.uncertified_count;
        self.uncertified = finer.uncertified;
        self.genus = finer.genus;
        self.area = finer.area;
        self.volume = finer.volume;
        self.centroid = finer.centroid;
        self.quality = finer.quality;
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
        self.counts.kept_faces = of.kept_faces as u64;
        self.counts.kept_edges = of.kept_edges as u64;
        self.largest_deviation = Some(of.largest_deviation);
        // What was proved of the subdivision's facets says nothing about these.
        let proved = of.enclosure.as_ref();
        self.proved_from_mesh = proved.map(|of| of.distance);
        self.proved_distance = proved.filter(|of| of.is_both_ways).map(|of| of.distance);
    }

    /// Whether the true boundary is proved to be a manifold, connected like the mesh.
    pub(crate) fn has_proved_manifold(&self) -> bool {
        self.proved_topology && self.split_vertices == 0
    }

    /// What is known about the solid before it is subdivided.
    pub(crate) fn add_solid(&mut self, solid: &csg::Solid) {
        self.clipped = solid.clipped;
        let pairs = solid.nearly_equal.iter().map(|pair| NearlyEqual {
            primitives: [pair.first.0, pair.second.0],
            difference: pair.difference,
        });
        self.nearly_equal_primitives = pairs.collect();
        let imprecise = solid.imprecise.iter().map(|of| Imprecise {
            primitive: of.primitive.0,
            uncertainty: of.uncertainty,
        });
        self.imprecise_primitives = imprecise.collect();
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

    /// How well the facets are shaped.
    pub(crate) fn add_quality(&mut self, quality: Option<&Quality>) {
        self.quality = quality.map(QualityReport::from);
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

impl From<&Quality> for QualityReport {
    fn from(of: &Quality) -> Self {
        Self {
            smallest_angle_deg: of.smallest_angle_deg,
            mean_angle_deg: of.mean_angle_deg,
            slivers: of.slivers,
            largest_aspect: finite(of.largest_aspect),
            shortest_edge: of.shortest_edge,
        }
    }
}
