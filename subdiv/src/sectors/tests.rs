use super::*;
use crate::blossom::centered;
use csg::{Literal, Sense};

fn sphere(radius: f64) -> (Vec<FormulaNode>, Vec<SectorRoot>) {
    let square = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|e| (e, 1.0));
    let line = [[1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|e| (e, -1.0));
    // |p − (½, ½, ½)|² − r².
    let constant = [([0, 0, 0], 0.75 - radius * radius)];
    let terms: Vec<_> = square.into_iter().chain(line).chain(constant).collect();
    let polynomial = centered(&Polynomial::from_terms(2, &terms).unwrap());
    let literal = Literal {
        primitive: PrimitiveId(0),
        sense: Sense::Inside,
        material: MaterialId(0),
    };
    let roots =
        bernstein_on_cube(&polynomial)
            .into_iter()
            .enumerate()
            .map(|(root, coefficients)| SectorRoot {
                root,
                primitives: vec![(2, coefficients)],
            });
    (vec![FormulaNode::Literal(literal)], roots.collect())
}

fn rule(levels: u8) -> SectorRule {
    SectorRule {
        levels,
        linear_levels: 0,
        max_primitives: 0,
        criterion: Criterion::Bezier,
        max_cells: 1_000_000,
    }
}

/// Every edge twice, and the volume by the divergence theorem below the ball's by no more than the
/// interpolation error h²/8 · |Hessian| / |gradient| times the area.
#[test]
fn a_ball_is_closed_and_its_volume_approaches_the_formula() {
    let radius = 0.4;
    let (formula, roots) = sphere(radius);
    for levels in [9, 12] {
        let outcome = subdivide(&formula, &roots, &rule(levels), Collect::Faces).unwrap();
        let mesh = &outcome.faces;
        let mut edges: Vec<[u32; 2]> = Vec::new();
        let mut volume = 0.0;
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.vertices;
            edges.extend([[a, b], [b, c], [c, a]]);
            let [a, b, c] = triangle.vertices.map(|v| mesh.positions[v as usize]);
            volume += a.dot(b.cross(c)) / 6.0;
        }
        edges.sort_unstable();
        for &[a, b] in &edges {
            assert!(edges.binary_search(&[b, a]).is_ok());
        }
        let exact = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
        let edge = 3.0_f64.sqrt() / f64::from(1_u32 << (levels / 3));
        // The interpolant of |p|² is too large by at most edge²/4.
        let least = radius * radius - edge * edge / 4.0;
        let least = 4.0 / 3.0 * std::f64::consts::PI * least.max(0.0).powf(1.5);
        assert!(
            least <= volume && volume < exact,
            "{least} {volume} {exact}"
        );
    }
}

/// Counts of a complete binary tree: what is cut is bisected, and every child is visited.
#[test]
fn counts_of_levels_fit_together() {
    let (formula, roots) = sphere(0.4);
    let outcome = subdivide(&formula, &roots, &rule(9), Collect::Tree).unwrap();
    assert_eq!(outcome.levels[9].simplices, 6);
    for level in (1..=9).rev() {
        let (above, below) = (outcome.levels[level], outcome.levels[level - 1]);
        assert_eq!(above.mixed, above.cut);
        assert_eq!(below.simplices, 2 * above.mixed);
        assert!(above.wasted <= above.mixed);
    }
    let nodes: usize = outcome.trees.iter().map(Vec::len).sum();
    let visited: u64 = outcome.levels.iter().map(|l| l.simplices).sum();
    assert_eq!(nodes as u64, visited);
}

#[test]
fn limits_are_kept() {
    let (formula, roots) = sphere(0.4);
    let few = SectorRule {
        max_cells: 10,
        ..rule(9)
    };
    let error = subdivide(&formula, &roots, &few, Collect::Nothing).unwrap_err();
    assert!(matches!(error, Error::TooManyCells { limit: 10 }));
    let deep = subdivide(&formula, &roots, &rule(58), Collect::Nothing);
    assert!(matches!(deep, Err(Error::Level { .. })));
    // With -P 1 the sphere is never bisected, being one primitive.
    let early = SectorRule {
        max_primitives: 1,
        ..rule(9)
    };
    let outcome = subdivide(&formula, &roots, &early, Collect::Tree).unwrap();
    assert!(outcome.trees.iter().all(|nodes| nodes.len() == 1));
}
