//! Collects triangles over vertices that are found again by their combinatorial names.

use crate::fragments::{Fragments, Triangle, VertexKind};
use crate::lattice::Point;
use crate::leaf_formula::Label;
use crate::simplex::Simplex;
use crate::untangle::Tangles;
use crate::volume::VolumeGap;
use csg::{PrimitiveId, Sense};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::collections::hash_map::Entry;

/// Name of a vertex that several simplices of a conforming subdivision may share.
///
/// An edge is named by its midpoint, a facet by the sum of its vertices: in a conforming
/// subdivision their interiors are disjoint, so the names differ.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Name {
    /// Where one primitive crosses an edge.
    Edge {
        /// The edge's midpoint.
        midpoint: Point,
        /// Global index of the primitive.
        primitive: u32,
    },
    /// Where the curves of two primitives cross in a facet.
    Facet {
        /// Sum of the facet's three vertices, by axis.
        sum: [u32; 3],
        /// Global indices of the primitives, ascending.
        primitives: [u32; 2],
        /// Which copy: 0, or the inside quadrant when the boundary is a checkerboard there.
        copy: u8,
    },
}

/// The mesh of one subtree.
#[derive(Debug)]
pub(crate) struct MeshBuilder {
    /// The subtree's root: vertices on its surface are shared with other subtrees.
    walls: [Wall; 4],
    /// Positions in the domain's own coordinates.
    pub positions: Vec<DVec3>,
    /// Parallel to `positions`.
    pub kinds: Vec<VertexKind>,
    /// The triangles so far.
    pub triangles: Vec<Triangle>,
    /// Leaves with several surfaces, and where their vertices may have to return to; positions
    /// in the domain's own coordinates.
    pub tangles: Tangles,
    /// Whether `tangles` knows a vertex, parallel to `positions`.
    has_home: Vec<bool>,
    /// Vertices that only exist since the boundary touches itself.
    pub split_vertices: u64,
    edges: FxHashMap<(Point, u32), u32>,
    facets: FxHashMap<Name, u32>,
    border: Vec<(Name, u32)>,
}

/// The plane of one facet of a simplex: points with normal · p = offset.
#[derive(Clone, Copy, Debug)]
struct Wall {
    normal: [i64; 3],
    offset: i128,
}

impl Wall {
    /// Facet of `simplex` opposite to vertex `apex`.
    fn opposite(simplex: &Simplex, apex: usize) -> Self {
        let mut corners = (0..4)
            .filter(|v| *v != apex)
            .map(|v| simplex.vertices[v].coordinates().map(i64::from));
        let mut next = || corners.next().unwrap_or_default();
        let (o, a, b) = (next(), next(), next());
        let d = |p: [i64; 3]| [p[0] - o[0], p[1] - o[1], p[2] - o[2]];
        let (a, b) = (d(a), d(b));
        let normal = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        // Facets of Kuhn simplices have normals along few directions: shorten to small numbers.
        let unit = normal.iter().map(|x| x.abs()).max().unwrap_or(1).max(1);
        let normal = if normal.iter().all(|x| x % unit == 0) {
            normal.map(|x| x / unit)
        } else {
            normal
        };
        let dot: i128 = (0..3)
            .map(|x| i128::from(normal[x]) * i128::from(o[x]))
            .sum();
        Self {
            normal,
            offset: dot,
        }
    }

    /// Whether the point `sum / count` lies in the plane.
    fn contains(&self, sum: [u32; 3], count: i128) -> bool {
        let dot: i128 = (0..3)
            .map(|x| i128::from(self.normal[x]) * i128::from(sum[x]))
            .sum();
        dot == self.offset * count
    }
}

impl MeshBuilder {
    /// An empty mesh for the subtree below `root`.
    #[must_use]
    pub(crate) fn new(root: &Simplex) -> Self {
        Self {
            walls: [0, 1, 2, 3].map(|apex| Wall::opposite(root, apex)),
            positions: Vec::new(),
            kinds: Vec::new(),
            triangles: Vec::new(),
            tangles: Tangles::default(),
            has_home: Vec::new(),
            split_vertices: 0,
            edges: FxHashMap::default(),
            facets: FxHashMap::default(),
            border: Vec::new(),
        }
    }

    /// A vertex that no other simplex can share.
    pub(crate) fn interior_vertex(&mut self, position: DVec3) -> u32 {
        self.push(position, VertexKind::Interior)
    }

    /// The vertex where a primitive crosses the edge with this midpoint, at `position` when it is
    /// new.
    pub(crate) fn edge_vertex(
        &mut self,
        midpoint: Point,
        primitive: u32,
        position: impl FnOnce() -> DVec3,
    ) -> u32 {
        let entry = match self.edges.entry((midpoint, primitive)) {
            Entry::Occupied(found) => return *found.get(),
            Entry::Vacant(entry) => entry,
        };
        let vertex = self.positions.len() as u32;
        entry.insert(vertex);
        self.positions.push(position());
        self.kinds.push(VertexKind::Edge);
        if self.on_border(midpoint.coordinates(), 1) {
            let name = Name::Edge {
                midpoint,
                primitive,
            };
            self.border.push((name, vertex));
        }
        vertex
    }

    /// The vertex named `name` (a [`Name::Facet`]), at `position` when it is new.
    pub(crate) fn facet_vertex(&mut self, name: Name, position: impl FnOnce() -> DVec3) -> u32 {
        if let Some(&found) = self.facets.get(&name) {
            return found;
        }
        let vertex = self.push(position(), VertexKind::Facet);
        self.facets.insert(name, vertex);
        if let Name::Facet { sum, copy, .. } = name {
            if self.on_border(sum, 3) {
                self.border.push((name, vertex));
            }
            self.split_vertices += u64::from(copy != 0);
        }
        vertex
    }

    /// Notes where the interpolants put a vertex of a leaf with several surfaces.
    pub(crate) fn note_home(&mut self, vertex: u32, position: DVec3) {
        let at = vertex as usize;
        if self.has_home.len() <= at {
            self.has_home.resize(self.positions.len(), false);
        }
        if !std::mem::replace(&mut self.has_home[at], true) {
            self.tangles.interpolated.push((vertex, position));
        }
    }

    /// Appends a triangle given counter-clockwise as seen from where its primitive is positive.
    pub(crate) fn push_oriented(&mut self, [a, b, c]: [u32; 3], primitive: u32, label: Label) {
        self.triangles.push(Triangle {
            vertices: match label.sense {
                Sense::Inside => [a, b, c],
                Sense::Outside => [a, c, b],
            },
            primitive: PrimitiveId(primitive),
            sense: label.sense,
            material: label.material,
        });
    }

    fn push(&mut self, position: DVec3, kind: VertexKind) -> u32 {
        self.positions.push(position);
        self.kinds.push(kind);
        (self.positions.len() - 1) as u32
    }

    fn on_border(&self, sum: [u32; 3], count: i128) -> bool {
        self.walls.iter().any(|wall| wall.contains(sum, count))
    }

    /// Bounds of this part's share of the solid's volume by the divergence theorem, in the
    /// domain's own units.
    pub(crate) fn volume(&self) -> VolumeGap {
        let (mut sum, mut error) = (0.0, 0.0);
        for triangle in &self.triangles {
            let [a, b, c] = triangle.vertices.map(|v| self.positions[v as usize] - 0.5);
            let (b, c) = (b - a, c - a);
            sum += a.dot(b.cross(c));
            // Some fifteen roundings, of positions also.
            error += (1.0 + a.length()) * (b.length() * c.length() + b.length() + c.length());
        }
        let error = 16.0 * f64::EPSILON * error;
        VolumeGap {
            low: (sum - error) / 6.0,
            high: (sum + error) / 6.0,
        }
    }

    /// Drops what is only needed while the subtree is walked.
    pub(crate) fn finish(&mut self) {
        self.edges = FxHashMap::default();
        self.facets = FxHashMap::default();
        self.has_home = Vec::new();
    }
}

/// Joins the meshes of all subtrees, in their order; a shared vertex is the first one's. Lengths
/// come out in model units.
#[must_use]
pub(crate) fn join(
    parts: Vec<MeshBuilder>,
    to_model: impl Fn(DVec3) -> DVec3,
) -> (Fragments, Tangles) {
    let mut whole = Fragments {
        positions: Vec::with_capacity(parts.iter().map(|p| p.positions.len()).sum()),
        kinds: Vec::with_capacity(parts.iter().map(|p| p.positions.len()).sum()),
        triangles: Vec::with_capacity(parts.iter().map(|p| p.triangles.len()).sum()),
    };
    let mut tangles = Tangles::default();
    let mut shared: FxHashMap<Name, u32> = FxHashMap::default();
    let mut renumbered: Vec<u32> = Vec::new();
    for part in parts {
        renumbered.clear();
        renumbered.resize(part.positions.len(), u32::MAX);
        let mut new_border = Vec::new();
        for (name, vertex) in part.border {
            match shared.get(&name) {
                Some(&known) => renumbered[vertex as usize] = known,
                None => new_border.push((name, vertex)),
            }
        }
        for (at, target) in renumbered.iter_mut().enumerate() {
            if *target == u32::MAX {
                *target = whole.positions.len() as u32;
                whole.positions.push(to_model(part.positions[at]));
                whole.kinds.push(part.kinds[at]);
            }
        }
        for (name, vertex) in new_border {
            shared.insert(name, renumbered[vertex as usize]);
        }
        let new = |vertex: &u32| renumbered[*vertex as usize];
        let homes = part.tangles.interpolated.iter();
        tangles
            .interpolated
            .extend(homes.map(|(vertex, at)| (new(vertex), to_model(*at))));
        tangles
            .objections
            .extend(part.tangles.objections.iter().map(new));
        let before = whole.triangles.len() as u32;
        let leaves = part.tangles.leaves.iter();
        tangles
            .leaves
            .extend(leaves.map(|leaf| leaf.map(|at| before + at)));
        whole
            .triangles
            .extend(part.triangles.iter().map(|t| Triangle {
                vertices: t.vertices.map(|v| renumbered[v as usize]),
                ..*t
            }));
    }
    (whole, tangles)
}
