//! Ragged outlines, extruded: one body of exactly the area times the height.

mod stages;

use stages::{Converted, convert};
use std::f64::consts::TAU;
use std::fmt::Write as _;

const HEIGHT: f64 = 10.0;

/// splitmix64, as numbers in 0 ‥ 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Twice the area by the shoelace formula, counter-clockwise positive.
fn doubled_area(points: &[[f64; 2]]) -> f64 {
    let next = points.iter().cycle().skip(1);
    let pairs = points.iter().zip(next);
    pairs.map(|(p, q)| p[0] * q[1] - p[1] * q[0]).sum()
}

/// Extrudes an outline at a tolerance of 0.1 % of the diagonal: one body without holes, with one
/// face for each edge, of the right volume and certified everywhere.
fn check(name: &str, points: &[[f64; 2]]) -> Converted {
    let mut text = "linear_extrude(height = 10) polygon(points = [".to_owned();
    for [x, y] in points {
        let _ = write!(text, "[{x}, {y}], ");
    }
    text.push_str("]);");
    let size = |axis: usize| {
        let all = || points.iter().map(|p| p[axis]);
        all().fold(f64::MIN, f64::max) - all().fold(f64::MAX, f64::min)
    };
    let found = convert(&text, 1e-3 * size(0).hypot(size(1)).hypot(HEIGHT));
    assert_eq!(found.shells.solids.len(), 1, "{name}");
    assert_eq!(found.shells.shells.len(), 1, "{name}");
    assert_eq!(found.shells.genus(), 0, "{name}");
    assert_eq!(found.report.uncertified_leaves, 0, "{name}");
    assert_eq!(found.groups.faces.len(), points.len() + 2, "{name}");
    let volume = 0.5 * doubled_area(points).abs() * HEIGHT;
    let off = (found.properties.volume - volume).abs();
    assert!(off <= 1e-9 * volume, "{name}: {off} of {volume}");
    found
}

/// Radii at random at even angles: spikes down to a hundredth of their length, whose lines all
/// pass the middle.
#[test]
fn stars_are_one_body() {
    let largest = std::env::var("CSG2BREP_STAR").map_or(1000, |n| n.parse().unwrap());
    for count in [100, 300, largest] {
        let mut random = Random(count);
        let points: Vec<[f64; 2]> = (0..count)
            .map(|at| {
                let (sine, cosine) = (TAU * at as f64 / count as f64).sin_cos();
                let radius = 100.0 * (0.3 + 0.7 * random.next());
                [radius * cosine, radius * sine]
            })
            .collect();
        check(&format!("star {count}"), &points);
    }
}

/// Random points, joined in the order that uncrossing all crossing edges leaves.
#[test]
fn random_simple_polygons_are_one_body() {
    for seed in 0..3 {
        let mut random = Random(seed);
        let mut points: Vec<[f64; 2]> = (0..150)
            .map(|_| [100.0 * random.next(), 100.0 * random.next()])
            .collect();
        let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) > 0.0
        };
        let n = points.len();
        // Each reversal shortens the tour.
        while let Some((i, j)) = (0..n - 1)
            .flat_map(|i| (i + 2..n).map(move |j| (i, j)))
            .find(|&(i, j)| {
                let (a, b) = (points[i], points[i + 1]);
                let (c, d) = (points[j], points[(j + 1) % n]);
                (i > 0 || j + 1 < n)
                    && turn(a, b, c) != turn(a, b, d)
                    && turn(c, d, a) != turn(c, d, b)
            })
        {
            points[i + 1..=j].reverse();
        }
        check(&format!("random {seed}"), &points);
    }
}

/// A band that winds inward.
#[test]
fn a_spiral_is_one_body() {
    let along = |offset: f64| {
        (0..200).map(move |at| {
            let angle = 0.1 * f64::from(at);
            let radius = 100.0 - 4.0 * angle + offset;
            [radius * angle.cos(), radius * angle.sin()]
        })
    };
    let points: Vec<[f64; 2]> = along(8.0)
        .chain(along(0.0).collect::<Vec<_>>().into_iter().rev())
        .collect();
    check("spiral", &points);
}

/// Teeth whose tips lie in one line, and their gaps in another: one face each.
#[test]
fn a_comb_has_its_tips_in_one_plane() {
    let mut points = vec![[200.0, 0.0], [200.0, 60.0], [0.0, 60.0], [0.0, 0.0]];
    for tooth in 0..99 {
        let x = f64::from(tooth) * 2.0 + 1.0;
        points.extend([[x, 0.0], [x, 50.0], [x + 1.0, 50.0], [x + 1.0, 0.0]]);
    }
    let found = check("comb", &points);
    let area = 200.0 * 60.0 - 99.0 * 50.0;
    assert!((found.properties.volume - area * HEIGHT).abs() < 1e-6);
}
