use super::*;
use crate::samples::{cube, sphere, together, torus};
use subdiv::Fragments;

fn of(fragments: &Fragments) -> Inspection {
    let triangles: Vec<[u32; 3]> = fragments.triangles.iter().map(|t| t.vertices).collect();
    Inspection::of(&fragments.positions, &triangles).expect("few triangles")
}

/// The counts that are not zero.
fn counts(inspection: &Inspection) -> Vec<(DefectKind, usize)> {
    let counts = inspection
        .defects()
        .map(|(kind, tally)| (kind, tally.count));
    counts.filter(|(_, count)| *count > 0).collect()
}

#[test]
fn sound_meshes_have_their_numbers() {
    let ring = of(&torus(2.0, 0.5, 32, 16));
    assert!(ring.is_sound());
    assert_eq!((ring.components, ring.genus), (1, Some(1)));
    let both = of(&together(&[cube([0.0; 3], 1.0), sphere(2)]));
    assert_eq!((both.components, both.genus), (2, Some(0)));
    let block = of(&cube([1.0, 0.0, 0.0], 1.0));
    assert_eq!((block.volume, block.area), (Some(8.0), 24.0));
    assert_eq!(
        (block.bounds.min, block.bounds.max),
        (DVec3::new(0.0, -1.0, -1.0), DVec3::new(2.0, 1.0, 1.0))
    );
    let nothing = of(&Fragments::default());
    assert!(nothing.is_sound() && nothing.bounds.is_empty());
    assert_eq!(nothing.genus, Some(0));
}

#[test]
fn a_missing_triangle_opens_three_edges() {
    let mut open = cube([0.0; 3], 1.0);
    let hole = open.triangles.remove(7);
    let found = of(&open);
    assert_eq!(counts(&found), [(DefectKind::OpenEdge, 3)]);
    assert_eq!((found.volume, found.genus), (None, None));
    let example = &found.tally_of(DefectKind::OpenEdge).first[0];
    assert!(example.vertices.iter().all(|v| hole.vertices.contains(v)));
    let ends = [0, 1].map(|k| open.positions[example.vertices[k] as usize]);
    assert_eq!(example.position, Some(ends[0].midpoint(ends[1])));
}

#[test]
fn a_turned_triangle_has_three_edges_of_one_direction() {
    let mut turned = cube([0.0; 3], 1.0);
    turned.triangles[4].vertices.swap(0, 1);
    let found = of(&turned);
    assert_eq!(counts(&found), [(DefectKind::OneWayEdge, 3)]);
    assert!(
        found
            .tally_of(DefectKind::OneWayEdge)
            .first
            .iter()
            .all(|e| e.triangles.contains(&4))
    );
}

#[test]
fn a_repeated_triangle_crowds_its_edges() {
    let mut twice = cube([0.0; 3], 1.0);
    twice.triangles.push(twice.triangles[3]);
    let found = of(&twice);
    let expected = [
        (DefectKind::DuplicateTriangle, 1),
        (DefectKind::CrowdedEdge, 3),
    ];
    assert_eq!(counts(&found), expected);
    assert_eq!(
        found.tally_of(DefectKind::DuplicateTriangle).first[0].triangles,
        [12, 3]
    );
}

#[test]
fn cubes_that_share_a_vertex_or_an_edge_are_pinched_or_crowded() {
    // Vertices of equal position made one, as a reader of STL does.
    let joined = |offset| {
        let mut mesh = together(&[cube([0.0; 3], 1.0), cube(offset, 1.0)]);
        let first = crate::join_equal(&mesh.positions, &[]);
        for triangle in &mut mesh.triangles {
            triangle.vertices = triangle.vertices.map(|v| first[v as usize]);
        }
        of(&mesh)
    };
    let corner = joined([2.0, 2.0, 2.0]);
    assert_eq!(counts(&corner), [(DefectKind::PinchedVertex, 1)]);
    let at = corner.tally_of(DefectKind::PinchedVertex).first[0].position;
    assert_eq!(at, Some(DVec3::ONE));
    assert_eq!((corner.components, corner.volume), (2, Some(16.0)));
    let edge = joined([2.0, 2.0, 0.0]);
    assert_eq!(counts(&edge), [(DefectKind::CrowdedEdge, 1)]);
    assert_eq!(edge.volume, Some(16.0));
}

#[test]
fn what_cannot_be_looked_at_is_counted_and_left_out() {
    let mut mesh = cube([0.0; 3], 1.0);
    let label = mesh.triangles[0];
    for vertices in [[0, 0, 1], [0, 1, 99], [8, 1, 2]] {
        mesh.triangles.push(subdiv::Triangle { vertices, ..label });
    }
    mesh.positions.push(DVec3::new(0.0, f64::NAN, 0.0));
    mesh.positions.push(DVec3::ZERO);
    let found = of(&mesh);
    let expected = [
        (DefectKind::NotFinite, 1),
        (DefectKind::VertexOutOfRange, 1),
        (DefectKind::DegenerateTriangle, 1),
        // The triangle in the air touches the cube in vertices 1 and 2, which no edge joins.
        (DefectKind::OpenEdge, 3),
        (DefectKind::PinchedVertex, 2),
    ];
    assert_eq!(counts(&found), expected);
    assert_eq!(found.unused_vertices, 1);
    assert_eq!(
        found.tally_of(DefectKind::NotFinite).first[0].triangles,
        [14]
    );
    assert_eq!(found.area.to_bits(), 24.0_f64.to_bits());
}

#[test]
fn triangles_on_a_line_are_told_and_harmless() {
    let mut mesh = cube([0.0; 3], 1.0);
    mesh.positions.fill(DVec3::X);
    let found = of(&mesh);
    assert!(found.is_sound());
    assert_eq!(found.zero_area.count, 12);
    assert_eq!(found.zero_area.first.len(), Tally::EXAMPLES);
}
