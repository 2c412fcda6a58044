use super::*;
use crate::samples::{cube, mesh, tetrahedron, torus, triangle};
use proptest::prelude::*;

#[test]
fn twins_are_the_same_edge_backwards() -> Result<(), Error> {
    let brep = stitch(&torus(2.0, 1.0, 7, 5))?;
    assert_eq!(
        (brep.vertex_count(), brep.edge_count(), brep.facet_count()),
        (35, 105, 70)
    );
    for half_edge in brep.half_edges() {
        assert_eq!(half_edge.twin().twin().key(), half_edge.key());
        assert_eq!(half_edge.twin().origin().key(), half_edge.target().key());
        assert_eq!(half_edge.prev().next().key(), half_edge.key());
        assert_eq!(half_edge.next().prev().key(), half_edge.key());
    }
    Ok(())
}

#[test]
fn vertices_and_facets_keep_their_order() -> Result<(), Error> {
    let fragments = cube([0.0; 3], 1.0);
    let brep = stitch(&fragments)?;
    let positions: Vec<DVec3> = brep.vertices().map(crate::VertexView::position).collect();
    assert_eq!(positions, fragments.positions);
    for (facet, triangle) in brep.facets().zip(&fragments.triangles) {
        let corners = triangle
            .vertices
            .map(|vertex| fragments.positions[vertex as usize]);
        assert_eq!(facet.positions(), corners);
        assert_eq!(facet.primitive(), triangle.primitive);
    }
    Ok(())
}

#[test]
fn unused_vertices_are_left_out() -> Result<(), Error> {
    let mut fragments = tetrahedron();
    fragments.positions.push(DVec3::ONE);
    assert_eq!(stitch(&fragments)?.vertex_count(), 4);
    Ok(())
}

#[test]
fn nothing_stitches_to_nothing() -> Result<(), Error> {
    assert!(stitch(&Fragments::default())?.is_empty());
    Ok(())
}

#[test]
fn a_hole_is_an_open_edge() {
    let mut fragments = tetrahedron();
    fragments.triangles.pop();
    // Its three edges; the first triangle to have one is 0, with 2 -> 1.
    let error = Error::OpenEdge {
        triangle: 0,
        from: DVec3::Y,
        to: DVec3::X,
        total: 3,
    };
    assert_eq!(stitch(&fragments).err(), Some(error));
}

#[test]
fn a_flipped_triangle_overuses_its_edges() {
    let mut fragments = tetrahedron();
    fragments.triangles[3].vertices.swap(1, 2);
    let error = stitch(&fragments).err();
    assert!(
        matches!(
            error,
            Some(Error::OverusedEdge {
                triangle: 3,
                total: 3,
                ..
            })
        ),
        "{error:?}"
    );
}

#[test]
fn an_edge_of_four_triangles_is_overused() {
    // Two tetrahedra with a common edge 0–1.
    let positions = [
        [0.; 3],
        [0., 0., 1.],
        [1., 0., 0.],
        [1., 1., 0.],
        [-1., 0., 0.],
        [-1., -1., 0.],
    ];
    let wedge = |a, b| [[0, b, a], [0, a, 1], [0, 1, b], [1, a, b]];
    let triangles = [wedge(2, 3), wedge(4, 5)].concat();
    assert!(stitch(&mesh(&positions, &triangles[..4])).is_ok());
    let error = stitch(&mesh(&positions, &triangles)).err();
    assert!(
        matches!(
            error,
            Some(Error::OverusedEdge {
                triangle: 5,
                total: 1,
                ..
            })
        ),
        "{error:?}"
    );
}

#[test]
fn malformed_triangles_are_refused() {
    let mut fragments = tetrahedron();
    fragments.triangles[1] = triangle([0, 1, 1], 0);
    assert_eq!(
        stitch(&fragments).err(),
        Some(Error::RepeatedVertex { triangle: 1 })
    );
    fragments.triangles[1] = triangle([0, 1, 4], 0);
    assert_eq!(
        stitch(&fragments).err(),
        Some(Error::VertexOutOfRange { triangle: 1 })
    );
}

#[test]
fn two_cones_on_one_tip_are_pinched() {
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let second =
        tetrahedron.map(|corners: [u32; 3]| corners.map(|c| if c == 0 { 0 } else { c + 3 }));
    let triangles = [tetrahedron, second].concat();
    assert_eq!(
        check_manifold(7, &triangles),
        Err(Error::PinchedVertex { vertex: 0 })
    );
    assert_eq!(check_manifold(7, &triangles[4..]), Ok(()));
}

proptest! {
    /// The names of vertices and the order of triangles do not matter.
    #[test]
    fn stitching_ignores_names(order in Just((0..12_usize).collect::<Vec<_>>()).prop_shuffle(),
                               names in Just((0..8_u32).collect::<Vec<_>>()).prop_shuffle()) {
        let sample = cube([0.0; 3], 1.0);
        let mut shuffled = sample.clone();
        for (from, &to) in names.iter().enumerate() {
            shuffled.positions[to as usize] = sample.positions[from];
        }
        shuffled.triangles = order
            .iter()
            .map(|&at| triangle(sample.triangles[at].vertices.map(|v| names[v as usize]), 0))
            .collect();
        let brep = stitch(&shuffled)?.validate();
        prop_assert!(brep.is_ok());
    }

    /// Any change of one corner of a closed mesh is noticed.
    #[test]
    fn one_wrong_corner_is_noticed(at in 0..12_usize, corner in 0..3_usize, vertex in 0..8_u32) {
        let mut fragments = cube([0.0; 3], 1.0);
        let old = std::mem::replace(&mut fragments.triangles[at].vertices[corner], vertex);
        prop_assert_eq!(stitch(&fragments).is_ok(), vertex == old);
    }
}
