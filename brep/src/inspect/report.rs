//! What an inspection finds.

use csg::Aabb;
use glam::DVec3;

/// What may be wrong with a mesh. Each fault is counted under one kind only.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum DefectKind {
    /// A vertex whose position is not a number or infinite.
    NotFinite,
    /// A triangle that names a vertex which does not exist.
    VertexOutOfRange,
    /// A triangle that names one vertex twice.
    DegenerateTriangle,
    /// A triangle over the same three vertices as an earlier one, whatever its direction.
    DuplicateTriangle,
    /// An edge of one triangle only: the border of a hole.
    OpenEdge,
    /// An edge of three or more triangles.
    CrowdedEdge,
    /// An edge that its two triangles run through in the same direction: one is turned over.
    OneWayEdge,
    /// A vertex whose triangles, joined across edges, fall into several fans.
    PinchedVertex,
}

impl DefectKind {
    /// All kinds, in the order in which they are best repaired.
    pub const ALL: [Self; 8] = [
        Self::NotFinite,
        Self::VertexOutOfRange,
        Self::DegenerateTriangle,
        Self::DuplicateTriangle,
        Self::OpenEdge,
        Self::CrowdedEdge,
        Self::OneWayEdge,
        Self::PinchedVertex,
    ];
}

/// A place where something is wrong.
#[derive(Clone, PartialEq, Debug)]
pub struct Example {
    /// Triangles concerned, at most four, of which the first one counts.
    pub triangles: Vec<u32>,
    /// Vertices concerned: the edge's ends, the triangle's corners, or the one vertex.
    pub vertices: Vec<u32>,
    /// Where that is: the edge's midpoint, the triangle's middle; `None` if that is nowhere.
    pub position: Option<DVec3>,
}

impl Example {
    pub(super) fn new(triangle: u32, vertices: &[u32], position: Option<DVec3>) -> Self {
        Self::of_several(&[triangle], vertices, position)
    }

    pub(super) fn of_several(triangles: &[u32], vertices: &[u32], at: Option<DVec3>) -> Self {
        Self {
            triangles: triangles.iter().take(4).copied().collect(),
            vertices: vertices.to_vec(),
            position: at.filter(|position| position.is_finite()),
        }
    }
}

/// How often something was found, and the first places.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tally {
    /// How often.
    pub count: usize,
    /// The first places in the order of triangles, at most [`Tally::EXAMPLES`].
    pub first: Vec<Example>,
}

impl Tally {
    /// The most places that are kept.
    pub const EXAMPLES: usize = 5;

    pub(super) fn add(&mut self, example: Example) {
        self.count += 1;
        let key = |example: &Example| (example.triangles.clone(), example.vertices.clone());
        let at = self
            .first
            .partition_point(|kept| key(kept) <= key(&example));
        if at < Self::EXAMPLES {
            self.first.truncate(Self::EXAMPLES - 1);
            self.first.insert(at, example);
        }
    }
}

/// What is to be said about a mesh of plain triangles.
#[derive(Clone, PartialEq, Debug)]
pub struct Inspection {
    /// In the order of [`DefectKind::ALL`].
    defects: [Tally; DefectKind::ALL.len()],
    /// Triangles whose three different vertices are exactly on one line: no defect, as the
    /// surface closes, but programs that compute normals stumble over them.
    pub zero_area: Tally,
    /// Vertices that no triangle names.
    pub unused_vertices: usize,
    /// Sets of triangles that hang together across edges; cavities count too.
    pub components: usize,
    /// Handles of all components together; `None` unless the mesh is sound.
    pub genus: Option<usize>,
    /// Whether each edge is used equally often in both directions, so that there is a volume.
    pub(super) is_cycle: bool,
    /// Signed volume: negative if triangles face inward; `None` if the triangles do not close.
    pub volume: Option<f64>,
    /// Area of all triangles.
    pub area: f64,
    /// Box of all triangles; [`Aabb::EMPTY`] without any.
    pub bounds: Aabb,
}

impl Default for Inspection {
    fn default() -> Self {
        Self {
            defects: Default::default(),
            zero_area: Tally::default(),
            unused_vertices: 0,
            components: 0,
            genus: None,
            is_cycle: true,
            volume: None,
            area: 0.0,
            bounds: Aabb::EMPTY,
        }
    }
}

impl Inspection {
    /// Whether there is no defect: the triangles are a closed, oriented 2-manifold.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        self.defects.iter().all(|tally| tally.count == 0)
    }

    /// All kinds, with what was found of each.
    pub fn defects(&self) -> impl Iterator<Item = (DefectKind, &Tally)> {
        DefectKind::ALL.into_iter().zip(&self.defects)
    }

    /// What was found of a kind.
    #[must_use]
    pub fn tally_of(&self, kind: DefectKind) -> &Tally {
        &self.defects[kind as usize]
    }

    pub(super) fn tally(&mut self, kind: DefectKind) -> &mut Tally {
        &mut self.defects[kind as usize]
    }
}
