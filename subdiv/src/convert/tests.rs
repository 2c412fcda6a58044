//! The whole stage on hand-made and random formulas: the result is always a closed, oriented
//! 2-manifold, whatever degeneracies the formula has.

use super::*;
use crate::blossom::centered;
use csg::{
    Aabb, Domain, Formula, FormulaNode, Literal, MaterialId, Polynomial, Primitive, PrimitiveId,
    Sense,
};
use glam::DVec3;
use proptest::prelude::*;
use rustc_hash::FxHashMap;

/// A solid from polynomials given in unit coordinates.
fn solid(polynomials: Vec<Polynomial>, nodes: Vec<FormulaNode>) -> Solid {
    let extent = Aabb {
        min: DVec3::ZERO,
        max: DVec3::ONE,
    };
    Solid {
        domain: Domain::around(&extent),
        extent,
        primitives: polynomials
            .into_iter()
            .map(|polynomial| Primitive {
                polynomial: centered(&polynomial),
                coefficient_error: 0.0,
            })
            .collect(),
        formula: Formula::new(nodes).unwrap(),
        materials: vec![],
        clipped: false,
        nearly_equal: vec![],
        imprecise: vec![],
        known_boundary: None,
    }
}

fn literal(primitive: u32, inside: bool) -> FormulaNode {
    FormulaNode::Literal(Literal {
        primitive: PrimitiveId(primitive),
        sense: if inside {
            Sense::Inside
        } else {
            Sense::Outside
        },
        material: MaterialId(0),
    })
}

fn sphere(center: DVec3, radius: f64) -> Polynomial {
    let c = center;
    let constant = c.length_squared() - radius * radius;
    let k = [
        1.0,
        0.0,
        0.0,
        -2.0 * c.x,
        1.0,
        0.0,
        -2.0 * c.y,
        1.0,
        -2.0 * c.z,
        constant,
    ];
    Polynomial::new(2, k.to_vec()).unwrap()
}

fn plane(normal: DVec3, offset: f64) -> Polynomial {
    Polynomial::new(1, vec![normal.x, normal.y, normal.z, -offset]).unwrap()
}

fn run_at(solid: &Solid, rule: Rule, threads: usize) -> Outcome {
    let settings = Settings {
        threads: Some(threads),
        ..Settings::new(rule)
    };
    convert(solid, &settings, &()).unwrap()
}

/// Every directed edge once, with its twin; every vertex link one cycle.
fn manifold_defect(f: &Fragments) -> Option<String> {
    let mut edges: FxHashMap<[u32; 2], u32> = FxHashMap::default();
    for (t, triangle) in f.triangles.iter().enumerate() {
        let [a, b, c] = triangle.vertices;
        if a == b || b == c || c == a {
            return Some(format!("triangle {t} repeats a vertex"));
        }
        for (from, to, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            if edges.insert([from, to], opposite).is_some() {
                return Some(format!(
                    "edge {:?} {:?} twice, kinds {:?} {:?}",
                    f.positions[from as usize],
                    f.positions[to as usize],
                    f.kinds[from as usize],
                    f.kinds[to as usize]
                ));
            }
        }
    }
    for [from, to] in edges.keys() {
        if !edges.contains_key(&[*to, *from]) {
            return Some(format!(
                "edge {:?} {:?} open, kinds {:?} {:?}",
                f.positions[*from as usize],
                f.positions[*to as usize],
                f.kinds[*from as usize],
                f.kinds[*to as usize]
            ));
        }
    }
    let mut degree = vec![0u32; f.positions.len()];
    let mut start = vec![u32::MAX; f.positions.len()];
    for [from, to] in edges.keys() {
        degree[*from as usize] += 1;
        start[*from as usize] = *to;
    }
    for vertex in 0..f.positions.len() as u32 {
        let first = start[vertex as usize];
        if first == u32::MAX {
            return Some(format!("vertex {vertex} unused"));
        }
        let mut spoke = first;
        let mut count = 0;
        loop {
            count += 1;
            spoke = edges[&[vertex, spoke]];
            if spoke == first {
                break;
            }
        }
        if count != degree[vertex as usize] {
            return Some(format!("link of vertex {vertex} is not one cycle"));
        }
    }
    None
}

fn volume(f: &Fragments) -> f64 {
    let at = |v: u32| f.positions[v as usize];
    f.triangles
        .iter()
        .map(|t| at(t.vertices[0]).dot(at(t.vertices[1]).cross(at(t.vertices[2]))))
        .sum::<f64>()
        / 6.0
}

fn euler(f: &Fragments) -> i64 {
    f.positions.len().cast_signed() as i64 - (f.triangles.len() / 2).cast_signed() as i64
}

/// Volume 4πr³/3; the mesh deviates by at most the tolerance.
#[test]
fn sphere_is_closed_and_has_its_volume() {
    let s = solid(
        vec![sphere(DVec3::new(0.5, 0.48, 0.53), 0.31)],
        vec![literal(0, true)],
    );
    let scale = s.domain.size();
    let tolerance = 0.001;
    let outcome = run_at(&s, Rule::Tolerance(tolerance), 2);
    assert_eq!(manifold_defect(&outcome.fragments), None);
    assert_eq!(euler(&outcome.fragments), 2);
    let radius = 0.31 * scale;
    let exact = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let area = 4.0 * std::f64::consts::PI * radius.powi(2);
    assert!((volume(&outcome.fragments) - exact).abs() <= 1.01 * area * tolerance);
    assert_eq!(outcome.report.uncertified_leaves, 0);
}

/// A tree of the kinds that break naive extraction: few primitives, repeated with both senses.
#[derive(Clone, Debug)]
enum Tree {
    Leaf(usize, bool),
    Op(bool, Vec<Tree>),
    Xor(Box<Tree>, Box<Tree>),
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = (0usize..9, any::<bool>()).prop_map(|(p, s)| Tree::Leaf(p, s));
    leaf.prop_recursive(4, 16, 3, |inner| {
        let several = proptest::collection::vec(inner.clone(), 2..4);
        let pair = (inner.clone(), inner);
        prop_oneof![
            3 => (any::<bool>(), several).prop_map(|(u, c)| Tree::Op(u, c)),
            2 => pair.prop_map(|(a, b)| Tree::Xor(Box::new(a), Box::new(b))),
        ]
    })
}

fn operator(is_union: bool, children: &[Vec<FormulaNode>]) -> Vec<FormulaNode> {
    let len = children.iter().map(Vec::len).sum::<usize>() as u32;
    let mut nodes = vec![if is_union {
        FormulaNode::Union { len }
    } else {
        FormulaNode::Intersection { len }
    }];
    nodes.extend(children.concat());
    nodes
}

fn formula(tree: &Tree, complement: bool) -> Vec<FormulaNode> {
    match tree {
        Tree::Leaf(p, inside) => vec![literal(*p as u32, *inside != complement)],
        Tree::Op(is_union, children) => {
            let children: Vec<_> = children.iter().map(|c| formula(c, complement)).collect();
            operator(*is_union != complement, &children)
        }
        Tree::Xor(a, b) => operator(
            true,
            &[
                operator(false, &[formula(a, false), formula(b, !complement)]),
                operator(false, &[formula(a, true), formula(b, complement)]),
            ],
        ),
    }
}

/// Coordinates on a coarse dyadic grid make vertex values vanish exactly.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        2 => (2u32..7).prop_map(|n| f64::from(n) / 8.0),
        1 => (5u32..28).prop_map(|n| f64::from(n) / 32.0),
        2 => 0.2..0.8f64,
    ]
}

fn polynomial() -> impl Strategy<Value = Polynomial> {
    let point = || proptest::array::uniform3(coordinate()).prop_map(DVec3::from);
    let axis = (0usize..3, coordinate()).prop_map(|(a, at)| plane(DVec3::AXES[a], at));
    let diagonal = (proptest::array::uniform3(-1i8..=1), coordinate()).prop_map(|(n, at)| {
        let n = DVec3::from(n.map(f64::from));
        let n = if n == DVec3::ZERO { DVec3::ONE } else { n };
        plane(n, at * n.element_sum())
    });
    let any_plane = (proptest::array::uniform3(-1.0..1.0f64), point())
        .prop_map(|(n, p)| plane(DVec3::from(n), DVec3::from(n).dot(p)));
    let ball = (point(), prop_oneof![Just(0.125), Just(0.25), 0.05..0.3f64])
        .prop_map(|(c, r)| sphere(c, r));
    prop_oneof![2 => axis, 2 => diagonal, 1 => any_plane, 3 => ball]
}

fn random_solid() -> impl Strategy<Value = Solid> {
    (proptest::collection::vec(polynomial(), 9), tree()).prop_map(|(mut polynomials, tree)| {
        // The clip box: strictly inside the domain, three more primitives on each side.
        let clip: Vec<_> = (0..6u32)
            .map(|face| literal(9 + face, face % 2 == 0))
            .collect();
        for axis in DVec3::AXES {
            polynomials.push(plane(axis, 0.9));
            polynomials.push(plane(axis, 0.1));
        }
        let mut children: Vec<_> = clip.into_iter().map(|l| vec![l]).collect();
        children.push(formula(&tree, false));
        solid(polynomials, operator(false, &children))
    })
}

proptest! {
    #![proptest_config(ProptestConfig { max_shrink_iters: 400, ..ProptestConfig::default() })]

    #[test]
    fn fixed_level_is_manifold(s in random_solid(), level in 3u8..13) {
        let outcome = run_at(&s, Rule::Level(level), 1);
        prop_assert_eq!(manifold_defect(&outcome.fragments), None);
    }

    #[test]
    fn tolerance_is_manifold(s in random_solid()) {
        let settings = Settings { max_level: Some(15), ..Settings::new(Rule::Tolerance(0.02)) };
        let outcome = convert(&s, &settings, &()).unwrap();
        prop_assert_eq!(manifold_defect(&outcome.fragments), None);
    }
}

/// Twelve planes through one lattice point, three spheres that touch each other in lattice
/// points: nothing here is in general position.
#[test]
fn everything_through_one_lattice_point() {
    let middle = DVec3::splat(0.5);
    let mut polynomials = Vec::new();
    for x in -1..=1 {
        for y in -1..=1 {
            let normal = DVec3::new(f64::from(x), f64::from(y), 1.0);
            polynomials.push(plane(normal, normal.dot(middle)));
        }
    }
    for axis in DVec3::AXES {
        polynomials.push(sphere(middle + 0.25 * axis, 0.25));
    }
    let all: Vec<_> = (0..12).map(|p| vec![literal(p, p % 2 == 0)]).collect();
    let xor = all[1..].iter().fold(all[0].clone(), |sum, next| {
        let flipped = |nodes: &[FormulaNode]| complement(nodes);
        operator(
            true,
            &[
                operator(false, &[sum.clone(), flipped(next)]),
                operator(false, &[flipped(&sum), next.clone()]),
            ],
        )
    });
    for axis in DVec3::AXES {
        polynomials.push(plane(axis, 0.9));
        polynomials.push(plane(axis, 0.1));
    }
    let mut children: Vec<_> = (12..18).map(|p| vec![literal(p, p % 2 == 0)]).collect();
    children.push(xor);
    let s = solid(polynomials, operator(false, &children));
    for level in [0, 5, 9, 12] {
        let outcome = run_at(&s, Rule::Level(level), 2);
        assert_eq!(manifold_defect(&outcome.fragments), None, "level {level}");
        assert!(outcome.report.split_vertices > 0);
    }
}

fn complement(nodes: &[FormulaNode]) -> Vec<FormulaNode> {
    let turned = nodes.iter().map(|node| match *node {
        FormulaNode::Union { len } => FormulaNode::Intersection { len },
        FormulaNode::Intersection { len } => FormulaNode::Union { len },
        FormulaNode::Literal(l) => FormulaNode::Literal(Literal {
            sense: l.sense.complement(),
            ..l
        }),
    });
    turned.collect()
}

#[test]
fn same_result_for_any_number_of_threads() {
    let balls: Vec<_> = (0..7)
        .map(|n| {
            sphere(
                DVec3::new(0.2 + 0.1 * f64::from(n), 0.5, 0.4 + 0.03 * f64::from(n)),
                0.11,
            )
        })
        .collect();
    let nodes: Vec<_> = (0..7).map(|p| vec![literal(p, true)]).collect();
    let s = solid(balls, operator(true, &nodes));
    for rule in [Rule::Tolerance(0.001), Rule::Level(17)] {
        let one = run_at(&s, rule, 1);
        assert!(one.fragments.triangles.len() > 1000);
        for threads in [2, 7] {
            assert_eq!(run_at(&s, rule, threads).fragments, one.fragments);
        }
    }
}

/// Cancels at once.
struct Impatient;

impl Observer for Impatient {
    fn stage(&self, _: &str, _: Option<u64>) {}
    fn advance(&self, _: u64) {}
    fn cancelled(&self) -> bool {
        true
    }
}

#[test]
fn limits_and_settings_are_checked() {
    let s = solid(vec![sphere(DVec3::splat(0.5), 0.3)], vec![literal(0, true)]);
    let base = Settings::new(Rule::Tolerance(0.001));
    let run = |settings: &Settings| convert(&s, settings, &()).unwrap_err();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = run(&Settings::new(Rule::Tolerance(bad)));
        assert!(matches!(error, Error::Tolerance(_)));
    }
    assert_eq!(
        run(&Settings::new(Rule::Level(58))),
        Error::Level {
            asked: 58,
            deepest: MAX_LEVEL
        }
    );
    let few = Settings {
        max_cells: 2000,
        ..base.clone()
    };
    assert_eq!(run(&few), Error::TooManyCells { limit: 2000 });
    let small = Settings {
        max_memory_bytes: 1 << 20,
        ..base.clone()
    };
    assert_eq!(run(&small), Error::TooMuchMemory { limit: 1 << 20 });
    assert_eq!(
        convert(&s, &base, &Impatient).unwrap_err(),
        Error::Cancelled
    );
}

/// 129 planes through the middle of the domain cross one leaf at any level.
#[test]
fn a_crowd_of_surfaces_is_an_error() {
    let planes: Vec<_> = (0..129)
        .map(|n| {
            let angle = 0.01 * f64::from(n);
            let normal = DVec3::new(angle.cos(), angle.sin(), 0.1);
            plane(normal, normal.dot(DVec3::new(0.503, 0.507, 0.511)))
        })
        .collect();
    let nodes: Vec<_> = (0..129).map(|p| vec![literal(p, p % 2 == 0)]).collect();
    let s = solid(planes, operator(false, &nodes));
    let error = convert(&s, &Settings::new(Rule::Level(6)), &()).unwrap_err();
    assert!(matches!(error, Error::TooManySurfaces { count: 129, .. }));
}

/// A torus-like quartic whose gradient vanishes at the middle: that spot is listed.
#[test]
fn singular_points_are_listed() {
    // Cone x² + y² − z² around the middle, cut off by a ball.
    let c = DVec3::new(0.5031, 0.4987, 0.5013);
    let k = [
        1.0,
        0.0,
        0.0,
        -2.0 * c.x,
        1.0,
        0.0,
        -2.0 * c.y,
        -1.0,
        2.0 * c.z,
    ];
    let constant = c.x * c.x + c.y * c.y - c.z * c.z;
    let cone = Polynomial::new(2, k.into_iter().chain([constant]).collect()).unwrap();
    let s = solid(
        vec![cone, sphere(c, 0.3)],
        operator(false, &[vec![literal(0, true)], vec![literal(1, true)]]),
    );
    let tolerance = 0.005;
    let outcome = run_at(&s, Rule::Tolerance(tolerance), 2);
    assert_eq!(manifold_defect(&outcome.fragments), None);
    assert!(outcome.report.uncertified_leaves > 0);
    let apex = s.domain.from_unit(c);
    for spot in &outcome.report.uncertified {
        assert!(spot.position.distance(apex) < 10.0 * tolerance, "{spot:?}");
        assert!(spot.size <= tolerance);
    }
}
