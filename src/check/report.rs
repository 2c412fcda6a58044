//! What a check finds, as data; `check --json` prints it.

use brep::{DefectKind, Inspection, Tally};
use io::read::mesh::Mesh;
use schemars::JsonSchema;
use serde::Serialize;

/// Raised when a name changes its meaning or disappears, not when one is added.
const SCHEMA_VERSION: u32 = 1;

/// Whether a mesh file is a closed, oriented manifold, and where it is not.
///
/// Lengths are in the file's own unit. Names are stable within a `schema_version`; what could not
/// be measured is null.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct CheckReport {
    /// Raised when a name changes its meaning or disappears, not when one is added.
    schema_version: u32,
    /// Path as given; `-` is standard input.
    pub(crate) name: String,
    /// Format it was read as.
    pub(crate) format: &'static str,
    /// What says which corners are one vertex.
    pub(crate) joined_by: JoinedBy,
    /// Whether there is no defect.
    pub(crate) is_closed_oriented_manifold: bool,
    /// Numbers of things.
    pub(crate) counts: CheckCounts,
    /// Handles of all components together; null with defects.
    pub(crate) genus: Option<u64>,
    /// Signed volume, negative if triangles face inward; null if they do not close.
    pub(crate) volume: Option<f64>,
    /// Area of all triangles.
    pub(crate) area: f64,
    /// Smallest, then largest coordinates; null without triangles.
    #[serde(rename = "box")]
    pub(crate) bounds: Option<[[f64; 3]; 2]>,
    /// Unit of length that the file states.
    pub(crate) unit: Option<String>,
    /// What is wrong, each fault under one kind only; kinds that do not occur are left out.
    pub(crate) defects: Vec<Defects>,
    /// What is no defect and good to know.
    pub(crate) remarks: Vec<String>,
}

/// What says which corners are one vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum JoinedBy {
    /// The file's vertex numbers.
    Indices,
    /// The glTF extension EXT_mesh_manifold.
    ExtMeshManifold,
    /// Exactly equal positions.
    Positions,
}

/// Numbers of things.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct CheckCounts {
    /// Triangles, broken ones included.
    pub(crate) triangles: u64,
    /// Vertices that triangles name, after joining.
    pub(crate) vertices: u64,
    /// Sets of triangles that hang together across edges; cavities count too.
    pub(crate) components: u64,
    /// Triangles of three different vertices on one line.
    pub(crate) zero_area_triangles: u64,
    /// Vertices that no triangle names.
    pub(crate) unused_vertices: u64,
}

/// Faults of one kind.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Defects {
    /// What is wrong.
    pub(crate) kind: Kind,
    /// How often.
    pub(crate) count: u64,
    /// The first places, in the order of the file's triangles.
    pub(crate) first: Vec<Place>,
    /// What to do about it.
    pub(crate) remedy: &'static str,
}

/// What may be wrong.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Kind {
    /// A vertex whose position is infinite or not a number.
    VertexNotFinite,
    /// A triangle that names a vertex which does not exist.
    VertexOutOfRange,
    /// A triangle in which two corners are one vertex.
    DegenerateTriangle,
    /// A triangle over the same three vertices as an earlier one.
    DuplicateTriangle,
    /// An edge of one triangle only.
    OpenEdge,
    /// An edge of three or more triangles.
    EdgeOfThreeOrMoreTriangles,
    /// An edge that its two triangles run through in the same direction.
    EdgeTwiceInOneDirection,
    /// A vertex around which the triangles are not one cycle.
    VertexOfSeveralFans,
}

/// A place where something is wrong.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub(crate) struct Place {
    /// What the file calls the triangles concerned; lines count from 1, all else from 0.
    pub(crate) at: Vec<String>,
    /// Numbers of these triangles among all of the file, from 0.
    pub(crate) triangles: Vec<u32>,
    /// Where that is; null if it is nowhere.
    pub(crate) position: Option<[f64; 3]>,
}

impl CheckReport {
    pub(crate) fn new(name: String, mesh: &Mesh, joined_by: JoinedBy, found: &Inspection) -> Self {
        let box_of = |bounds: csg::Aabb| [bounds.min.to_array(), bounds.max.to_array()];
        let defects = found.defects().filter(|(_, tally)| tally.count > 0);
        Self {
            schema_version: SCHEMA_VERSION,
            name,
            format: mesh.format.name(),
            joined_by,
            is_closed_oriented_manifold: found.is_sound(),
            counts: CheckCounts {
                triangles: mesh.triangles.len() as u64,
                vertices: 0,
                components: found.components as u64,
                zero_area_triangles: found.zero_area.count as u64,
                unused_vertices: 0,
            },
            genus: found.genus.map(|genus| genus as u64),
            volume: found.volume,
            area: found.area,
            bounds: (!found.bounds.is_empty()).then(|| box_of(found.bounds)),
            unit: mesh.unit.clone(),
            defects: defects
                .map(|(kind, tally)| Defects {
                    kind: kind.into(),
                    count: tally.count as u64,
                    first: places(mesh, tally),
                    remedy: Kind::from(kind).remedy(),
                })
                .collect(),
            remarks: Vec::new(),
        }
    }
}

/// The first places of a tally, in the file's words.
pub(super) fn places(mesh: &Mesh, tally: &Tally) -> Vec<Place> {
    let place = |example: &brep::Example| {
        let names = example.triangles.iter();
        Place {
            at: names.map(|&t| mesh.place(t as usize)).collect(),
            triangles: example.triangles.clone(),
            position: example.position.map(|position| position.to_array()),
        }
    };
    tally.first.iter().map(place).collect()
}

impl From<DefectKind> for Kind {
    fn from(kind: DefectKind) -> Self {
        match kind {
            DefectKind::NotFinite => Self::VertexNotFinite,
            DefectKind::VertexOutOfRange => Self::VertexOutOfRange,
            DefectKind::DegenerateTriangle => Self::DegenerateTriangle,
            DefectKind::DuplicateTriangle => Self::DuplicateTriangle,
            DefectKind::OpenEdge => Self::OpenEdge,
            DefectKind::CrowdedEdge => Self::EdgeOfThreeOrMoreTriangles,
            DefectKind::OneWayEdge => Self::EdgeTwiceInOneDirection,
            DefectKind::PinchedVertex => Self::VertexOfSeveralFans,
        }
    }
}

impl Kind {
    /// One and several of it.
    pub(crate) fn words(self) -> [&'static str; 2] {
        match self {
            Self::VertexNotFinite => [
                "vertex whose position is infinite or not a number",
                "vertices whose positions are infinite or not numbers",
            ],
            Self::VertexOutOfRange => [
                "triangle that names a vertex which does not exist",
                "triangles that name a vertex which does not exist",
            ],
            Self::DegenerateTriangle => [
                "triangle in which two corners are one vertex",
                "triangles in which two corners are one vertex",
            ],
            Self::DuplicateTriangle => [
                "triangle over the same vertices as an earlier one",
                "triangles over the same vertices as an earlier one",
            ],
            Self::OpenEdge => [
                "open edge, of one triangle only",
                "open edges, of one triangle only",
            ],
            Self::EdgeOfThreeOrMoreTriangles => [
                "edge of three or more triangles",
                "edges of three or more triangles",
            ],
            Self::EdgeTwiceInOneDirection => [
                "edge that two triangles run through in the same direction",
                "edges that two triangles run through in the same direction",
            ],
            Self::VertexOfSeveralFans => [
                "vertex in which parts of the surface touch without an edge",
                "vertices in which parts of the surface touch without an edge",
            ],
        }
    }

    /// One sentence.
    pub(crate) fn remedy(self) -> &'static str {
        match self {
            Self::VertexNotFinite => {
                "correct the position in the program that made the file, often a division by zero"
            }
            Self::VertexOutOfRange => {
                "the file is damaged, or its writer counts vertices from the wrong number"
            }
            Self::DegenerateTriangle => {
                "remove these triangles: the sides that remain lie on each other"
            }
            Self::DuplicateTriangle => "remove the repeated triangles",
            Self::OpenEdge => "fill the hole, or join vertices there that should be one",
            Self::EdgeOfThreeOrMoreTriangles => {
                "remove inner walls, unite solids that share a face, or give solids that touch vertices of their own"
            }
            Self::EdgeTwiceInOneDirection => "turn over the triangles on one side of these edges",
            Self::VertexOfSeveralFans => "give each part of the surface its own copy of the vertex",
        }
    }
}
