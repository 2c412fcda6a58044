//! The nodes that may stand in a file, and what becomes of each.

use super::figure::FigureLeaf;

/// What a node means to this reader.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    /// The union of its children, under whatever name.
    Union,
    /// What all its children have in common.
    Intersection,
    /// The first child without the others.
    Difference,
    /// Its children, moved.
    Motion(Motion),
    /// Its children, painted.
    Color,
    /// A shape without children.
    Leaf(Leaf),
    /// A plane figure without children: part of no solid unless something extrudes it.
    Figure(FigureLeaf),
    /// Letters, a plane figure without children.
    Text,
    /// The solid that its children, plane figures, make when they move along z.
    LinearExtrude,
    /// The solid that its children, plane figures, make when they turn about z.
    RotateExtrude,
    /// The convex hull of its children.
    Hull,
    /// The Minkowski sum of its children.
    Minkowski,
    /// Its children, plane figures, with their outline moved.
    Offset,
    /// Its children, plane figures, without their holes.
    Fill,
    /// Its children, scaled to a given size.
    Resize,
    /// The section or shadow of its children, a plane figure.
    Projection,
    /// A node of OpenSCAD's that this reader refuses, and what to do instead.
    Refused(&'static str),
}

/// How children are moved.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Motion {
    /// `multmatrix(m)`.
    Matrix,
    /// `translate(v)`.
    Translate,
    /// `rotate(a, v)`.
    Rotate,
    /// `scale(v)`.
    Scale,
    /// `mirror(v)`.
    Mirror,
}

/// The shapes.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Leaf {
    /// `cube(size, center)`.
    Cube,
    /// `sphere(r)`.
    Sphere,
    /// `cylinder(h, r1, r2, center)`.
    Cylinder,
    /// `polyhedron(points, faces)`.
    Polyhedron,
    /// `import(file)`: a mesh beside the model.
    Import,
    /// `surface(file, center, invert)`: heights beside the model.
    Surface,
    /// `torus(r1, r2)`: ring radius, tube radius; about the z axis.
    Torus,
    /// `halfspace(n, d)`: n · (x, y, z) ≤ d.
    HalfSpace,
    /// `quadric(m)`: \[x y z 1\] M \[x y z 1\]ᵀ ≤ 0.
    Quadric,
    /// `polynomial(p)`: p ≤ 0.
    Polynomial,
    /// `helicoid()`, the bounded one of the thesis.
    Helicoid,
}

/// A node's name, meaning and parameters, these in the order of positional arguments.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    pub(super) name: &'static str,
    pub(super) kind: Kind,
    pub(super) parameters: &'static [&'static str],
}

const fn entry(name: &'static str, kind: Kind, parameters: &'static [&'static str]) -> Entry {
    Entry {
        name,
        kind,
        parameters,
    }
}

const fn leaf(name: &'static str, leaf: Leaf, parameters: &'static [&'static str]) -> Entry {
    entry(name, Kind::Leaf(leaf), parameters)
}

const fn motion(name: &'static str, motion: Motion, parameters: &'static [&'static str]) -> Entry {
    entry(name, Kind::Motion(motion), parameters)
}

const fn figure(
    name: &'static str,
    figure: FigureLeaf,
    parameters: &'static [&'static str],
) -> Entry {
    entry(name, Kind::Figure(figure), parameters)
}

const fn refused(name: &'static str, remedy: &'static str) -> Entry {
    entry(name, Kind::Refused(remedy), &[])
}

const MESH: &str = "let OpenSCAD make a mesh of this part, as in openscad -o part.off part.scad, \
                    and write import(\"part.off\") in its place";

/// What OpenSCAD writes for imported files; only the name of the file matters for meshes.
const IMPORT: [&str; 10] = [
    "file", "filename", "layer", "scale", "center", "dpi", "id", "width", "height", "parts",
];

/// All nodes: OpenSCAD's, then this project's additions.
const ENTRIES: [Entry; 42] = [
    entry("union", Kind::Union, &[]),
    entry("group", Kind::Union, &[]),
    entry("render", Kind::Union, &[]),
    entry("intersection", Kind::Intersection, &[]),
    entry("difference", Kind::Difference, &[]),
    entry("color", Kind::Color, &["c", "alpha"]),
    motion("multmatrix", Motion::Matrix, &["m"]),
    motion("translate", Motion::Translate, &["v"]),
    motion("rotate", Motion::Rotate, &["a", "v"]),
    motion("scale", Motion::Scale, &["v"]),
    motion("mirror", Motion::Mirror, &["v"]),
    leaf("cube", Leaf::Cube, &["size", "center"]),
    leaf("sphere", Leaf::Sphere, &["r", "d"]),
    leaf(
        "cylinder",
        Leaf::Cylinder,
        &["h", "r1", "r2", "center", "r", "d", "d1", "d2"],
    ),
    figure("square", FigureLeaf::Square, &["size", "center"]),
    figure("circle", FigureLeaf::Circle, &["r", "d"]),
    figure("polygon", FigureLeaf::Polygon, &["points", "paths"]),
    entry(
        "linear_extrude",
        Kind::LinearExtrude,
        &[
            "height", "v", "center", "scale", "twist", "slices", "file", "layer",
        ],
    ),
    entry(
        "rotate_extrude",
        Kind::RotateExtrude,
        &["angle", "start", "file", "layer"],
    ),
    entry("hull", Kind::Hull, &[]),
    leaf(
        "polyhedron",
        Leaf::Polyhedron,
        &["points", "faces", "triangles"],
    ),
    entry(
        "text",
        Kind::Text,
        &[
            "text",
            "size",
            "font",
            "halign",
            "valign",
            "spacing",
            "direction",
            "language",
            "script",
        ],
    ),
    entry("offset", Kind::Offset, &["r", "delta", "chamfer"]),
    entry("projection", Kind::Projection, &["cut"]),
    entry("fill", Kind::Fill, &[]),
    entry("minkowski", Kind::Minkowski, &[]),
    entry("resize", Kind::Resize, &["newsize", "auto"]),
    leaf("import", Leaf::Import, &IMPORT),
    leaf("import_stl", Leaf::Import, &IMPORT),
    leaf("import_off", Leaf::Import, &IMPORT),
    refused("import_dxf", MESH),
    leaf("surface", Leaf::Surface, &["file", "center", "invert"]),
    refused("roof", MESH),
    refused("glide", MESH),
    refused("subdiv", MESH),
    refused("dxf_linear_extrude", MESH),
    refused("dxf_rotate_extrude", MESH),
    leaf("torus", Leaf::Torus, &["r1", "r2"]),
    leaf("halfspace", Leaf::HalfSpace, &["n", "d"]),
    leaf("quadric", Leaf::Quadric, &["m"]),
    leaf("polynomial", Leaf::Polynomial, &["p"]),
    leaf("helicoid", Leaf::Helicoid, &[]),
];

/// The node of this name.
pub(super) fn find(name: &str) -> Option<&'static Entry> {
    ENTRIES.iter().find(|entry| entry.name == name)
}

/// What was probably meant by a name that does not exist.
pub(super) fn nearest_node(name: &str) -> Option<&'static str> {
    nearest(name, ENTRIES.iter().map(|entry| entry.name))
}

/// The candidate that a few typing errors make of `name`: one in three characters.
pub(super) fn nearest(
    name: &str,
    candidates: impl IntoIterator<Item = &'static str>,
) -> Option<&'static str> {
    // Long names cost quadratic time and resemble nothing.
    if name.len() > 64 {
        return None;
    }
    let lower = name.to_ascii_lowercase();
    candidates
        .into_iter()
        .map(|candidate| (strsim::osa_distance(&lower, candidate), candidate))
        .filter(|(distance, candidate)| 3 * distance <= candidate.len().max(3))
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first column of the table in the documentation, split at its commas.
    fn documented() -> Vec<&'static str> {
        let text = include_str!("../../../../docs/openscad.md");
        let rows = text.lines().filter(|line| line.starts_with("| `"));
        let cells = rows.filter_map(|row| row.split('|').nth(1));
        let names = cells.flat_map(|cell| cell.split('`').skip(1).step_by(2));
        names.collect()
    }

    #[test]
    fn the_documentation_lists_every_node_once_and_no_other() {
        let mut documented = documented();
        documented.sort_unstable();
        let mut known: Vec<&str> = ENTRIES.iter().map(|entry| entry.name).collect();
        known.sort_unstable();
        assert_eq!(documented, known);
    }

    #[test]
    fn names_are_unique() {
        for entry in &ENTRIES {
            let same = ENTRIES.iter().filter(|other| other.name == entry.name);
            assert_eq!(same.count(), 1, "{}", entry.name);
        }
    }

    #[test]
    fn typing_errors_are_recognised_and_foreign_words_are_not() {
        assert_eq!(nearest_node("cyllinder"), Some("cylinder"));
        assert_eq!(nearest_node("Sphere"), Some("sphere"));
        assert_eq!(nearest_node("diffrence"), Some("difference"));
        assert_eq!(nearest_node("wheel_hub"), None);
        assert_eq!(nearest("R", ["r", "d"]), Some("r"));
    }
}
