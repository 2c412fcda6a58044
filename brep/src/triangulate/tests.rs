use super::*;
use crate::simplify::remove_degenerate;
use crate::{Properties, Shells};
use csg::{Model, ModelBuilder, Node, NodeId, Shape, Solid, Transform};
use glam::DVec3;
use proptest::prelude::*;
use subdiv::{Rule, Settings};

/// The subdivision's own mesh of a model, and which of its primitives are planes.
fn leaves(model: &Model, level: u8) -> (Valid<Brep>, Vec<bool>) {
    let solid = Solid::build(model, None).expect("bounded");
    let settings = Settings {
        threads: Some(1),
        ..Settings::new(Rule::Level(level))
    };
    let fragments = if solid.primitives.is_empty() {
        Fragments::default()
    } else {
        subdiv::convert(&solid, &settings, &())
            .expect("small")
            .fragments
    };
    let valid = stitch(&fragments)
        .expect("closed")
        .validate()
        .expect("valid");
    let planes = solid.primitives.iter().map(|p| p.polynomial.degree() == 1);
    (remove_degenerate(valid).expect("valid").0, planes.collect())
}

/// Merges, and checks what must hold of any mesh.
fn merge(leaves: &Valid<Brep>, planes: &[bool]) -> (Valid<Brep>, Retriangulated) {
    let is_plane = |p: PrimitiveId| planes[p.0 as usize];
    let (merged, counts) = retriangulate(leaves.clone(), is_plane);
    assert_eq!(
        (counts.facets_before, counts.facets_after),
        (leaves.facet_count(), merged.facet_count())
    );

    let [before, after] = [leaves, &merged].map(Shells::of);
    assert_eq!(before.shells.len(), after.shells.len());
    assert_eq!(before.solids.len(), after.solids.len());
    assert_eq!(before.genus(), after.genus());
    let [before, after] = [leaves, &merged].map(|brep| {
        let groups = Groups::of(brep);
        (
            groups.faces.len(),
            groups.edges.len(),
            groups.vertices.len(),
        )
    });
    assert_eq!(before, after);
    let [before, after] = [leaves, &merged].map(Properties::of);
    let off = (before.volume - after.volume).abs();
    assert!(
        off <= 1e-12 * before.volume.abs().max(1.0),
        "volume off by {off}"
    );
    // Facets that fold over each other in touching leaves have too much area.
    let grown = after.area - before.area;
    assert!(
        grown <= 1e-12 * before.area.max(1.0),
        "area grown by {grown}"
    );

    let groups = Groups::of(&merged);
    if counts.kept == 0 {
        let mut inside = merged.vertices().filter(|vertex| {
            planes[vertex.outgoing().facet().primitive().0 as usize]
                && !vertex.ring().any(|h| groups.is_crease(h))
        });
        assert!(inside.next().is_none(), "a vertex inside a planar face");
    }
    (merged, counts)
}

fn model(shape: impl Fn(&mut ModelBuilder) -> NodeId) -> Model {
    let mut builder = ModelBuilder::new();
    let root = shape(&mut builder);
    builder.finish(root)
}

fn block(builder: &mut ModelBuilder, min: [f64; 3], max: [f64; 3]) -> NodeId {
    let shape = Shape::block(min.into(), max.into()).expect("a block");
    builder.add(Node::Shape(shape))
}

fn counts_of(brep: &Brep) -> (usize, usize) {
    (brep.facet_count(), brep.vertex_count())
}

#[test]
fn a_cube_has_twelve_triangles() {
    let cube = model(|builder| block(builder, [-1.0; 3], [2.0; 3]));
    let (leaves, planes) = leaves(&cube, 12);
    assert!(leaves.facet_count() > 100);
    let (merged, counts) = merge(&leaves, &planes);
    assert_eq!((counts.faces, counts.kept), (6, 0));
    assert_eq!(counts_of(&merged), (12, 8));
}

#[test]
fn holes_need_no_vertices_beside_their_rims() {
    let plate = model(|builder| {
        let mut parts = vec![block(builder, [0.0; 3], [8.0, 8.0, 1.0])];
        for at in 0..16 {
            let cylinder = Shape::cylinder(0.5, -1.0, 2.0).expect("a cylinder");
            let cylinder = builder.add(Node::Shape(cylinder));
            let (x, y) = (f64::from(at % 4), f64::from(at / 4));
            let to = Transform::translation(DVec3::new(1.0 + 2.0 * x, 1.0 + 2.0 * y, 0.0));
            parts.push(builder.add(Node::Instance(to.expect("finite"), cylinder)));
        }
        builder.add(Node::Difference(parts))
    });
    let (leaves, planes) = leaves(&plate, 18);
    let (merged, counts) = merge(&leaves, &planes);
    assert_eq!((counts.faces, counts.kept), (6, 0));
    assert_eq!(Shells::of(&merged).genus(), 16);
    // Each of two faces: n rim vertices and 4 corners in 17 loops make n + 4 + 2·17 − 4 triangles.
    let groups = Groups::of(&merged);
    let rims: usize = (groups.edges.iter())
        .filter(|edge| edge.ends.is_none())
        .map(|edge| edge.chain.len())
        .sum();
    let flat = (groups.faces.iter())
        .filter(|face| planes[face.primitive.0 as usize])
        .map(|face| face.facet_count)
        .sum::<usize>();
    assert_eq!(flat, rims + 2 * (4 + 2 * 17 - 4) + 4 * 2);
}

#[test]
fn cubes_touching_along_an_edge_stay_two() {
    let cubes = model(|builder| {
        let a = block(builder, [-1.0, -1.0, -1.0], [0.0, 0.0, 1.0]);
        let b = block(builder, [0.0, 0.0, -1.0], [1.0, 1.0, 1.0]);
        builder.add(Node::Union(vec![a, b]))
    });
    let (leaves, planes) = leaves(&cubes, 9);
    let (merged, counts) = merge(&leaves, &planes);
    assert_eq!(counts.kept, 0);
    assert_eq!(counts_of(&merged), (24, 16));
}

#[test]
fn cubes_touching_in_a_vertex_stay_two() {
    let cubes = model(|builder| {
        let a = block(builder, [-1.0; 3], [0.0; 3]);
        let b = block(builder, [0.0; 3], [1.0; 3]);
        builder.add(Node::Union(vec![a, b]))
    });
    let (leaves, planes) = leaves(&cubes, 9);
    let (merged, counts) = merge(&leaves, &planes);
    assert_eq!(counts.kept, 0);
    assert_eq!(counts_of(&merged), (24, 16));
}

#[test]
fn what_only_one_of_two_cubes_holds() {
    let exclusive = model(|builder| {
        let a = block(builder, [-1.0; 3], [0.5; 3]);
        let b = block(builder, [-0.25; 3], [1.0; 3]);
        let left = builder.add(Node::Difference(vec![a, b]));
        let right = builder.add(Node::Difference(vec![b, a]));
        builder.add(Node::Union(vec![left, right]))
    });
    let (leaves, planes) = leaves(&exclusive, 12);
    let (merged, counts) = merge(&leaves, &planes);
    assert_eq!(counts.kept, 0);
    let volume = Properties::of(&merged).volume;
    let expected = 1.5_f64.powi(3) + 1.25_f64.powi(3) - 2.0 * 0.75_f64.powi(3);
    assert!((volume - expected).abs() < 1e-13);
}

#[test]
fn a_hole_may_touch_the_outer_loop() {
    // A square hole standing on its corner, which touches the side x = −1 along an edge.
    let touching = model(|builder| {
        let outer = block(builder, [-1.0, -2.0, -1.0], [3.0, 2.0, 1.0]);
        let hole = Shape::prism(4, 1.0, 1.0, -2.0, 2.0).expect("a prism");
        let hole = builder.add(Node::Shape(hole));
        builder.add(Node::Difference(vec![outer, hole]))
    });
    let (leaves, planes) = leaves(&touching, 12);
    let (merged, counts) = merge(&leaves, &planes);
    assert!(counts.faces >= 9);
    assert!(merged.facet_count() < 80, "{counts:?}");
    assert!((Properties::of(&merged).volume - 28.0).abs() < 1e-13);
}

/// A face that keeps its facets must still fit its neighbours.
#[test]
fn bent_faces_are_kept_and_their_neighbours_conform() {
    let cube = model(|builder| block(builder, [-1.0; 3], [2.0; 3]));
    let (leaves, planes) = leaves(&cube, 9);
    let mut bent = leaves.into_inner();
    let high = bent.vertices.values_mut();
    // In the middle of the edge between the faces x = 2 and y = 2.
    let on_edge = high.filter(|v| v.position.x > 1.99 && v.position.y > 1.99);
    let middle = on_edge.min_by(|a, b| a.position.z.abs().total_cmp(&b.position.z.abs()));
    middle.expect("vertices along the edge").position += DVec3::new(0.1, 0.1, 0.0);
    let bent = bent.validate().expect("the same topology");
    let (merged, counts) = retriangulate(bent.clone(), |p: PrimitiveId| planes[p.0 as usize]);
    assert_eq!((counts.faces, counts.kept), (4, 2));
    assert!(merged.facet_count() < bent.facet_count());
    let off = Properties::of(&merged).volume - Properties::of(&bent).volume;
    assert!(off.abs() < 1e-13);
}

#[test]
fn nothing_is_merged_without_planes() {
    let cube = model(|builder| block(builder, [0.0; 3], [1.0; 3]));
    let (leaves, _) = leaves(&cube, 6);
    let (same, counts) = retriangulate(leaves.clone(), |_| false);
    assert_eq!((counts.faces, counts.kept), (0, 0));
    assert_eq!(counts_of(&same), counts_of(&leaves));
}

#[derive(Clone, Copy, Debug)]
struct Part {
    kind: u8,
    operation: u8,
    axis: usize,
    offset: [i8; 3],
    jitter: f64,
}

fn part() -> impl Strategy<Value = Part> {
    let jitter = prop_oneof![3 => Just(0.0), 1 => -0.3..0.3, 1 => -1e-9..1e-9];
    let offset = proptest::array::uniform3(-2_i8..=2);
    (0_u8..6, 0_u8..4, 0_usize..3, offset, jitter).prop_map(
        |(kind, operation, axis, offset, jitter)| Part {
            kind,
            operation,
            axis,
            offset,
            jitter,
        },
    )
}

/// Blocks, prisms and cylinders on a coarse grid, so that faces coincide and edges touch.
fn add(builder: &mut ModelBuilder, part: Part) -> NodeId {
    let shape = match part.kind {
        0..=2 => Shape::block(DVec3::splat(-1.0), DVec3::splat(1.0)),
        3 => Shape::prism(4, 1.0, 1.0, -1.0, 1.0),
        4 => Shape::prism(6, 1.0, 0.5, -1.0, 1.0),
        _ => Shape::cylinder(0.5, -1.0, 1.0),
    };
    let node = builder.add(Node::Shape(shape.expect("a shape")));
    let at = DVec3::from(part.offset.map(|o| f64::from(o) * 0.5)) + part.jitter;
    let mut columns = [DVec3::X, DVec3::Y, DVec3::Z];
    columns.rotate_left(part.axis);
    let [x, y, z] = columns;
    let matrix = [
        [x.x, y.x, z.x, at.x],
        [x.y, y.y, z.y, at.y],
        [x.z, y.z, z.z, at.z],
        [0.0, 0.0, 0.0, 1.0],
    ];
    let transform = Transform::from_columns(&matrix).expect("a motion");
    builder.add(Node::Instance(transform, node))
}

fn combine(builder: &mut ModelBuilder, parts: &[Part]) -> NodeId {
    let mut all = add(builder, parts[0]);
    for &part in &parts[1..] {
        let next = add(builder, part);
        let node = match part.operation {
            0 => Node::Union(vec![all, next]),
            1 => Node::Difference(vec![all, next]),
            2 => Node::Difference(vec![next, all]),
            _ => {
                let left = builder.add(Node::Difference(vec![all, next]));
                let right = builder.add(Node::Difference(vec![next, all]));
                Node::Union(vec![left, right])
            }
        };
        all = builder.add(node);
    }
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_solid_stays_what_it_is(parts in proptest::collection::vec(part(), 1..5)) {
        let model = model(|builder| combine(builder, &parts));
        let (leaves, planes) = leaves(&model, 9);
        merge(&leaves, &planes);
    }
}
