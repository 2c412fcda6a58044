//! The methods against each other: whatever way they go, they must find the same simplices.

use super::continuation::Path;
use super::*;
use crate::Criterion;
use crate::lattice::LATTICE_BITS;
use csg::{ModelBuilder, Node, NodeId, Shape, Solid, Transform};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

const CRITERIA: [Criterion; 3] = [Criterion::Bezier, Criterion::Rivlin, Criterion::Lipschitz];

fn ball(model: &mut ModelBuilder, center: DVec3, radius: f64) -> NodeId {
    let child = model.add(Node::Shape(Shape::sphere(radius).unwrap()));
    let transform = Transform::translation(center).unwrap();
    model.add(Node::Instance(transform, child))
}

/// Two balls apart, one of them with a bore and a bite of a torus.
fn two_parts() -> Solid {
    let mut model = ModelBuilder::new();
    let big = ball(&mut model, DVec3::new(0.1, 0.05, 0.0), 1.03);
    let far = ball(&mut model, DVec3::new(2.31, 0.17, 0.29), 0.61);
    let bore = model.add(Node::Shape(Shape::cylinder(0.37, -2.0, 2.0).unwrap()));
    let ring = model.add(Node::Shape(Shape::torus(0.9, 0.29).unwrap()));
    let bitten = model.add(Node::Difference(vec![big, bore, ring]));
    let root = model.add(Node::Union(vec![bitten, far]));
    Solid::build(&model.finish(root), None).unwrap()
}

#[test]
fn all_methods_find_the_same_simplices() {
    let solid = two_parts();
    for halvings in 0..=4 {
        let level = 3 * halvings;
        let whole = complete(&solid, halvings, Pattern::Reflected);
        assert_eq!(whole.simplices, 6 << level);
        for criterion in CRITERIA {
            let ours = adaptive(&solid, criterion, level, Halt::Never);
            assert_eq!(ours.found, whole.found, "{criterion:?} at level {level}");
            assert!(ours.evaluations <= ours.classifications);
            assert!(ours.doubtful <= ours.classifications);
        }
        let marched = continuation(&solid, halvings, Pattern::Reflected, &whole.found.cells);
        assert_eq!(marched.found, whole.found);
        assert_eq!(marched.simplices, whole.found.cells.len() as u64);
    }
}

/// What the thesis says of its weakness: one seed finds one component.
/// Paths lead where the subdivision was, in both ways to follow them.
#[test]
fn paths_lead_to_the_simplices_that_stay_open() {
    let solid = two_parts();
    for level in [0, 1, 11, 12] {
        let paths = Paths::new(&solid, Criterion::Bezier, level);
        let run = adaptive(&solid, Criterion::Bezier, level, Halt::Never);
        assert_eq!(paths.len() as u64, run.front);
        let found = |geometry| {
            let mut cells = Vec::new();
            paths.for_each(geometry, |cell| cells.push(cell));
            cells.sort_unstable();
            cells
        };
        let cells = found(Geometry::FromPaths);
        assert_eq!(found(Geometry::Carried), cells);
        // Those that the boundary crosses, by the signs at their vertices, are among them.
        assert!(
            run.found
                .cells
                .iter()
                .all(|cell| cells.binary_search(cell).is_ok())
        );
        assert!(cells.windows(2).all(|pair| pair[0] != pair[1]));
    }
}

#[test]
fn continuation_needs_a_seed_for_each_component() {
    let solid = two_parts();
    let whole = complete(&solid, 4, Pattern::Reflected).found;
    let all = continuation(&solid, 4, Pattern::Reflected, &whole.cells);
    assert_eq!(all.components, 2);
    let one = continuation(&solid, 4, Pattern::Reflected, &whole.cells[..1]);
    let other = continuation(
        &solid,
        4,
        Pattern::Reflected,
        &whole.cells[whole.cells.len() - 1..],
    );
    assert_eq!((one.components, other.components), (1, 1));
    let together = one.found.cells.len() + other.found.cells.len();
    assert_eq!(together, whole.cells.len());
    // The CFK triangulation is another one; its rules reach all of it as well.
    let translated = complete(&solid, 4, Pattern::Translated).found;
    let marched = continuation(&solid, 4, Pattern::Translated, &translated.cells);
    assert_eq!(marched.found, translated);
}

#[test]
fn stopping_at_planes_saves_work_only() {
    let mut model = ModelBuilder::new();
    let block = model.add(Node::Shape(
        Shape::block(DVec3::splat(-1.0), DVec3::ONE).unwrap(),
    ));
    let ball = ball(&mut model, DVec3::ONE, 0.7);
    let root = model.add(Node::Difference(vec![block, ball]));
    let solid = Solid::build(&model.finish(root), None).unwrap();
    let full = adaptive(&solid, Criterion::Rivlin, 15, Halt::Never);
    let early = adaptive(&solid, Criterion::Rivlin, 15, Halt::AtPlanes);
    assert!(
        3 * early.simplices < full.simplices,
        "{} {}",
        early.simplices,
        full.simplices
    );
}

/// Rivlin's bound is sharper than Bézier's by its proof; Lipschitz' is known to be loose.
#[test]
fn criteria_are_ordered_by_what_they_bisect_in_vain() {
    let solid = two_parts();
    let wrong = CRITERIA.map(|c| adaptive(&solid, c, 15, Halt::Never).wrongly_bisected);
    assert!(wrong[1] < wrong[0] && wrong[0] < wrong[2], "{wrong:?}");
}

/// Both cuts of a cube fill it, and cubes side by side share their facets: each is in one
/// tetrahedron on the wall of the grid and in two elsewhere.
#[test]
fn patterns_are_triangulations() {
    for (pattern, count) in [
        (Pattern::Translated, 6),
        (Pattern::Reflected, 6),
        (Pattern::Five, 5),
    ] {
        let side = 3;
        let mut facets: BTreeMap<Vec<[u32; 3]>, u32> = BTreeMap::new();
        let mut six_volumes = 0;
        for at in 0..side * side * side {
            let cube = [at % side, at / side % side, at / side / side];
            assert_eq!(pattern.tetrahedra(cube).count(), count);
            for t in pattern.tetrahedra(cube) {
                let e = |i: usize| [0, 1, 2].map(|a| i64::from(t[i][a]) - i64::from(t[0][a]));
                let (a, b, c) = (e(1), e(2), e(3));
                let det = a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
                    + a[2] * (b[0] * c[1] - b[1] * c[0]);
                assert_ne!(det, 0);
                six_volumes += det.abs();
                for without in 0..4 {
                    let mut facet = t.to_vec();
                    facet.remove(without);
                    facet.sort_unstable();
                    *facets.entry(facet).or_default() += 1;
                }
            }
        }
        assert_eq!(six_volumes, 6 * i64::from(side).pow(3));
        for (facet, times) in facets {
            let on_wall = (0..3).any(|a| {
                let first = facet[0][a];
                (first == 0 || first == side) && facet.iter().all(|v| v[a] == first)
            });
            assert_eq!(times, if on_wall { 1 } else { 2 }, "{pattern:?} {facet:?}");
        }
    }
}

/// Pivoting exchanges one vertex, and back.
#[test]
fn pivots_exchange_one_vertex() {
    for pattern in [Pattern::Translated, Pattern::Reflected] {
        for tetrahedron in pattern.tetrahedra([2, 1, 3]) {
            let shift = LATTICE_BITS - 3;
            let mut cell = tetrahedron.map(|v| v.map(|c| c << shift));
            cell.sort_unstable();
            let simplex = Path::of(&cell, 3, pattern).unwrap();
            let own: BTreeSet<_> = simplex.vertices().into();
            for without in 0..4 {
                let neighbour = simplex.pivot(without);
                let shared = neighbour
                    .vertices()
                    .into_iter()
                    .filter(|v| own.contains(v))
                    .count();
                assert_eq!(shared, 3);
                assert!(!neighbour.vertices().contains(&simplex.vertices()[without]));
                let back: Vec<_> = (0..4).map(|w| neighbour.pivot(w)).collect();
                assert!(back.contains(&simplex));
            }
        }
    }
}

/// Thesis 6.3.3: at the points of the control net the coefficients of x² err by 1/(n−1) of what
/// the affine interpolant errs there, on the other side.
#[test]
fn control_net_errs_by_a_fraction_of_the_interpolant() {
    for n in 2usize..9 {
        let mut power = vec![0.0; csg::Polynomial::coefficient_count(n)];
        power[csg::Polynomial::index(n, 2, 0, 0)] = 1.0;
        let primitive = csg::Primitive {
            polynomial: crate::blossom::centered(&csg::Polynomial::new(n, power).unwrap()),
            coefficient_error: 0.0,
        };
        let root = &bernstein_coefficients(&primitive)[0];
        for l in 1..n {
            let x = l as f64 / n as f64;
            let net = root[crate::bernstein::index(0, 0, l)] - x * x;
            let interpolant = x - x * x;
            assert!((net + interpolant / (n as f64 - 1.0)).abs() < 1e-14);
        }
    }
}
