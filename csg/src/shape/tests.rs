use crate::{Error, Polynomial, Shape};
use glam::DVec3;
use proptest::prelude::*;

fn contains(shape: &Shape, p: DVec3) -> bool {
    let clauses = shape.half_spaces().unwrap();
    clauses
        .iter()
        .any(|clause| clause.iter().all(|q| q.evaluate(p) <= 0.0))
}

fn tetrahedron(flips: u8) -> Result<Shape, Error> {
    let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let mut faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]].map(|f| f.to_vec());
    for (at, face) in faces.iter_mut().enumerate() {
        if flips >> at & 1 == 1 {
            face.reverse();
        }
    }
    Shape::convex_polyhedron(&vertices, &faces)
}

#[test]
fn the_torus_passes_through_its_outermost_circle() {
    // The thesis' misprint does not: put (1 + r, 0, 0) into it.
    for tube in [0.25, 1.0, 1.5] {
        let torus = Shape::torus(1.0, tube).unwrap();
        let quartic = &torus.half_spaces().unwrap()[0][0];
        for p in [DVec3::X * (1.0 + tube), -DVec3::Y * (1.0 + tube)] {
            assert!(quartic.evaluate(p).abs() < 1e-13);
            assert!(contains(&torus, p * (1.0 - 1e-9)));
            assert!(!contains(&torus, p * (1.0 + 1e-9)));
        }
        assert!(contains(&torus, DVec3::new(0.0, 1.0, tube * (1.0 - 1e-9))));
        assert_eq!(contains(&torus, DVec3::ZERO), tube >= 1.0);
    }
}

#[test]
fn the_helicoid_turns_half_from_bottom_to_top() {
    let shape = Shape::helicoid();
    let surface = &shape.half_spaces().unwrap()[0][0];
    // At the ends the surface is the plane y = 0 (but for 7e-10 in the printed coefficient, off
    // π/2 by 0.15), in the middle the plane x = 0, seen from its other sides.
    for (z, direction, inside) in [
        (0.0, DVec3::Y, false),
        (0.5, DVec3::X, true),
        (1.0, DVec3::Y, true),
    ] {
        let at = DVec3::Z * z;
        assert!(surface.evaluate(at).abs() < 1e-15);
        assert_eq!(surface.evaluate(at + direction * 0.5) < 0.0, inside);
        assert_eq!(surface.evaluate(at - direction * 0.5) < 0.0, !inside);
    }
    // Term by term as printed in thesis A.2.3.
    for p in [DVec3::new(0.3, -0.6, 0.2), DVec3::new(-0.5, 0.1, 0.9)] {
        let u = p.z - 0.5;
        let pi = std::f64::consts::PI;
        let printed = p.x * (4.0 * u * u - 1.0) + p.y * u * (2.265_481_6 * u * u - pi);
        assert!((surface.evaluate(p) - printed).abs() < 1e-14);
    }
}

#[test]
fn a_cone_has_one_nappe() {
    let cone = Shape::frustum(0.0, 1.0, 0.0, 2.0).unwrap();
    assert!(contains(&cone, DVec3::new(0.4, 0.0, 1.0)));
    assert!(!contains(&cone, DVec3::new(0.0, 0.0, -0.5)));
    assert!(!contains(&cone, DVec3::new(0.6, 0.0, 1.0)));
    let frustum = Shape::frustum(2.0, 1.0, -1.0, 1.0).unwrap();
    assert!(contains(&frustum, DVec3::new(1.49, 0.0, 0.0)));
    assert!(!contains(&frustum, DVec3::new(1.51, 0.0, 0.0)));
    assert!(matches!(
        Shape::frustum(1.0, 1.0, 0.0, 1.0),
        Ok(Shape::Cylinder(_))
    ));
}

#[test]
fn a_prism_has_its_first_vertex_on_the_x_axis() {
    for sides in 3..20 {
        let prism = Shape::prism(sides, 2.0, 0.0, 0.0, 1.0).unwrap();
        for k in 0..sides {
            let angle = std::f64::consts::TAU * f64::from(k) / f64::from(sides);
            let vertex = DVec3::new(2.0 * angle.cos(), 2.0 * angle.sin(), 1e-9);
            assert!(contains(&prism, vertex * (1.0 - 1e-8)));
            assert!(!contains(&prism, vertex * (1.0 + 1e-8)));
        }
        assert!(contains(&prism, DVec3::new(0.0, 0.0, 1.0 - 1e-9)));
        assert_eq!(prism.half_space_count(), sides as usize + 2);
    }
    // Sides parallel to an axis are exactly so.
    let square = Shape::prism(8, 1.0, 1.0, 0.0, 1.0).unwrap();
    let planes = &square.half_spaces().unwrap()[0];
    assert!(planes[1].coefficients()[0] > 0.0);
    let square = Shape::prism(6, 1.0, 1.0, 0.0, 1.0).unwrap();
    let across = square.half_spaces().unwrap()[0][1].coefficients()[0];
    assert!(across == 0.0, "exactly");
}

#[test]
fn polyhedra_need_no_orientation() {
    for flips in 0..16 {
        let shape = tetrahedron(flips).unwrap();
        assert_eq!(shape.half_space_count(), 4);
        assert!(contains(&shape, DVec3::splat(0.3)));
        assert!(!contains(&shape, DVec3::splat(0.34)));
        assert!(!contains(&shape, DVec3::splat(-0.01)));
    }
}

#[test]
fn triangulated_faces_are_one_half_space() {
    let corner = |at: usize| DVec3::new((at & 1) as f64, (at >> 1 & 1) as f64, (at >> 2) as f64);
    let vertices: Vec<DVec3> = (0..8).map(corner).collect();
    let squares = [
        [0, 1, 3, 2],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 3, 7, 6],
        [0, 2, 6, 4],
        [1, 3, 7, 5],
    ];
    let halves = squares.map(|[a, b, c, d]| [vec![a, b, c], vec![a, c, d]]);
    let triangles: Vec<Vec<usize>> = halves.into_iter().flatten().collect();
    let cube = Shape::convex_polyhedron(&vertices, &triangles).unwrap();
    assert_eq!(cube.half_space_count(), 6);
    let mut dented = vertices.clone();
    dented[7] = DVec3::splat(0.6);
    assert!(matches!(
        Shape::convex_polyhedron(&dented, &triangles),
        Err(Error::NotConvex { .. })
    ));
    assert_eq!(
        Shape::convex_polyhedron(&vertices, &triangles[1..]),
        Err(Error::OpenPolyhedron)
    );
    let flat: Vec<DVec3> = vertices.iter().map(|v| v.with_z(0.0)).collect();
    assert!(Shape::convex_polyhedron(&flat, &triangles).is_err());
}

#[test]
fn bad_polyhedra_are_refused() {
    let vertices = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let with = |face: Vec<usize>| {
        let mut faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3]]
            .map(|f| f.to_vec())
            .to_vec();
        faces.push(face);
        Shape::convex_polyhedron(&vertices, &faces).unwrap_err()
    };
    let missing = Error::MissingVertex {
        face: 3,
        vertex: 4,
        vertices: 4,
    };
    assert_eq!(with(vec![0, 2, 4]), missing);
    assert_eq!(with(vec![0, 2]), Error::FlatFace { face: 3 });
    assert_eq!(with(vec![0, 1, 3]), Error::OpenPolyhedron);
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
    let faces = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]].map(|f| f.to_vec());
    assert!(matches!(
        Shape::convex_polyhedron(&line, &faces),
        Err(Error::FlatFace { .. })
    ));
}

#[test]
fn bad_sizes_are_refused() {
    assert!(matches!(Shape::sphere(0.0), Err(Error::NotPositive { .. })));
    assert!(matches!(
        Shape::sphere(f64::NAN),
        Err(Error::NonFinite { .. })
    ));
    assert!(matches!(
        Shape::frustum(-1.0, 1.0, 0.0, 1.0),
        Err(Error::Negative { .. })
    ));
    assert!(matches!(
        Shape::cylinder(1.0, 1.0, 1.0),
        Err(Error::EmptyInterval { .. })
    ));
    assert!(matches!(
        Shape::block(DVec3::ZERO, DVec3::new(1.0, -1.0, 1.0)),
        Err(Error::EmptyInterval { .. })
    ));
    assert!(matches!(
        Shape::half_space(DVec3::ZERO, 1.0),
        Err(Error::ZeroVector { .. })
    ));
    let sides = 2;
    assert_eq!(
        Shape::prism(sides, 1.0, 1.0, 0.0, 1.0),
        Err(Error::TooFewSides { sides })
    );
}

#[test]
fn messages_name_the_number() {
    let message = Shape::sphere(-3.0).unwrap_err().to_string();
    assert_eq!(message, "radius must be positive, found -3");
}

#[test]
fn overflow_is_noticed_when_half_spaces_are_made() {
    let huge = Shape::sphere(1e200).unwrap();
    assert!(matches!(huge.half_spaces(), Err(Error::NonFinite { .. })));
}

proptest! {
    /// The torus' quartic as the product of its two branches, from coordinate polynomials.
    #[test]
    fn the_torus_is_the_product_of_its_branches(ring in 0.1..2.0, tube in 0.1..2.0, at in proptest::array::uniform3(-3.0..3.0)) {
        let at = DVec3::from(at);
        let quartic = &Shape::torus(ring, tube).unwrap().half_spaces().unwrap()[0][0];
        let rho = at.truncate().length();
        let branch = |r: f64| (rho - r) * (rho - r) + at.z * at.z - tube * tube;
        let product = branch(ring) * branch(-ring);
        prop_assert!((quartic.evaluate(at) - product).abs() < 1e-10);
    }

    #[test]
    fn quadrics_are_their_matrices(m in proptest::array::uniform4(proptest::array::uniform4(-1.0..1.0)), at in proptest::array::uniform3(-3.0..3.0)) {
        let x = [at[0], at[1], at[2], 1.0];
        let mut form = 0.0;
        for (i, row) in m.iter().enumerate() {
            for (j, entry) in row.iter().enumerate() {
                form += x[i] * entry * x[j];
            }
        }
        let p = Polynomial::quadric(&m).unwrap();
        prop_assert!((p.evaluate(at.into()) - form).abs() < 1e-12);
    }
}
