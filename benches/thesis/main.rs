//! The tables of the thesis' chapter 6 with its figures beside today's, as Markdown.
//!
//! ```text
//! cargo bench --bench thesis
//! cargo bench --bench thesis -- spheres
//! ```
//!
//! The tables' names: conversion (6.1), refinement (6.2, 6.3), spheres (6.4), boxes (6.5, 6.6),
//! criteria (6.7, 6.8), rays (6.4), reduction (6.3.2), functions (6.3.5),
//! paths (6.3.4).
//!
//! One thread. `docs/thesis.md` says what the figures mean.

mod functions;
mod paths;
mod rays;
mod reduction;
mod solids;

use csg::{Polynomial, Primitive, Solid};
use solids::{THREE, load, load_in, spheres};
use std::hint::black_box;
use std::time::Instant;
use subdiv::Criterion;
use subdiv::methods::{Adaptive, Halt, adaptive, bernstein_coefficients};

/// Level of the box that fits; that of the box eight times as large is three more.
const LEVEL: u8 = 15;

fn main() {
    if std::env::args().any(|a| a == "--list" || a == "--test") {
        return;
    }
    for (name, table) in [
        ("conversion", conversion as fn()),
        ("refinement", refinement),
        ("spheres", spheres_table),
        ("boxes", boxes),
        ("criteria", criteria),
        ("rays", rays::table),
        ("reduction", reduction::table),
        ("functions", functions::table),
        ("paths", paths::table),
    ] {
        if std::env::args().any(|a| a == name) {
            table();
            return;
        }
    }
    conversion();
    refinement();
    spheres_table();
    boxes();
    criteria();
    rays::table();
    reduction::table();
    functions::table();
    paths::table();
}

/// The shortest of up to five runs, in seconds; none begins after two seconds.
fn seconds<T>(mut run: impl FnMut() -> T) -> f64 {
    let first = Instant::now();
    let mut shortest = f64::INFINITY;
    for _ in 0..5 {
        let start = Instant::now();
        black_box(run());
        shortest = shortest.min(start.elapsed().as_secs_f64());
        if first.elapsed().as_secs_f64() > 2.0 {
            break;
        }
    }
    shortest
}

/// Table 6.1.
fn conversion() {
    const THEN: [&str; 6] = ["0.016", "0.033", "0.266", "3.433", "52.4", "858"];
    println!("\n**Table 6.1** conversion to Bernstein form, all six roots\n");
    println!("| degree | coefficients | 1992, s | now, µs |\n| --: | --: | --: | --: |");
    for degree in [1, 2, 3, 4, 5, 6, 8, 12, 16, 20, 32, 64] {
        let count = Polynomial::coefficient_count(degree);
        let coefficients = (0..count).map(|i| (i as f64 * 0.7).sin()).collect();
        let polynomial = Polynomial::new(degree, coefficients).expect("finite");
        let primitive = Primitive {
            polynomial,
            coefficient_error: 0.0,
        };
        let now = seconds(|| bernstein_coefficients(&primitive)) * 1e6;
        let then = THEN.get(degree - 1).unwrap_or(&"–");
        println!("| {degree} | {count} | {then} | {now:.1} |");
    }
}

/// What the thesis counted for CHUPETA by Rivlin's criterion at levels 0 to 21: simplices,
/// minimal simplices, evaluations, primitives in the minimal simplices.
const THEN: [[u64; 4]; 22] = [
    [6, 6, 78, 72],
    [18, 12, 222, 114],
    [42, 24, 450, 177],
    [90, 48, 804, 270],
    [186, 70, 1_344, 372],
    [326, 108, 2_088, 522],
    [542, 168, 3_132, 702],
    [878, 266, 4_536, 976],
    [1_410, 388, 6_488, 1_334],
    [2_186, 622, 9_156, 1_898],
    [3_430, 1_014, 12_952, 2_836],
    [5_458, 1_570, 18_624, 4_146],
    [8_598, 2_390, 26_916, 5_844],
    [13_378, 4_140, 38_604, 9_280],
    [21_326, 6_876, 56_832, 14_150],
    [34_298, 11_220, 84_352, 20_410],
    [55_022, 16_910, 123_456, 31_116],
    [88_594, 26_438, 185_440, 47_912],
    [141_134, 40_658, 280_928, 71_682],
    [222_026, 67_318, 423_868, 116_628],
    [356_042, 108_974, 656_504, 183_902],
    [573_226, 173_884, 1_023_544, 279_222],
];

fn ratio(part: u64, whole: u64) -> String {
    if whole == 0 {
        return "–".to_owned();
    }
    format!("{:.2}", part as f64 / whole as f64)
}

/// Tables 6.2 and 6.3.
fn refinement() {
    let solid = load("chupeta");
    let primitives = solid.primitives.len() as u64;
    println!("\n**Tables 6.2 and 6.3** CHUPETA by Rivlin's criterion; 1992 / now\n");
    println!(
        "| level | simplices | minimal | classified (SSA) | MAO | SSA/MAO | values/MAO | doubtful/MAO | MAI/MAO | SSA/MAI | ms |"
    );
    println!("| --: | --: | --: | --: | --: | --: | --: | --: | --: | --: | --: |");
    for (level, then) in (0u8..22).zip(THEN).rev() {
        let (run, ms) = timed(&solid, Criterion::Rivlin, level);
        let [simplices, minimal, evaluations, optimum] = then;
        let cells = run.front;
        let best = run.front_primitives;
        println!(
            "| {level} | {simplices} / {} | {minimal} / {cells} | {evaluations} / {} | {optimum} / {best} \
             | {} / {} | {} | {} | {} / {} | {} / {} | {ms:.2} |",
            run.simplices,
            run.classifications,
            ratio(evaluations, optimum),
            ratio(run.classifications, best),
            ratio(run.evaluations, best),
            ratio(run.doubtful, best),
            ratio(13 * minimal, optimum),
            ratio(primitives * cells, best),
            ratio(evaluations, 13 * minimal),
            ratio(run.classifications, primitives * cells),
        );
    }
}

/// Table 6.4.
fn spheres_table() {
    const THEN: [(usize, f64); 8] = [
        (1, 4.70),
        (2, 4.44),
        (4, 4.25),
        (8, 4.14),
        (16, 4.07),
        (32, 4.02),
        (64, 3.98),
        (128, 4.96),
    ];
    println!("\n**Table 6.4** spheres at level 18 by Rivlin's criterion, in one box\n");
    println!(
        "| spheres | MAC | MAI | MAO | SSA | SSA/MAO 1992 | SSA/MAO | primitives a simplex | values/MAO |"
    );
    println!("| --: | --: | --: | --: | --: | --: | --: | --: | --: |");
    for (count, then) in THEN {
        let run = adaptive(&spheres(count), Criterion::Rivlin, 18, Halt::Never);
        let best = run.front_primitives;
        println!(
            "| {count} | {} | {} | {best} | {} | {then:.2} | {} | {} | {} |",
            (6 << 18) * count,
            run.front * count as u64,
            run.classifications,
            ratio(run.classifications, best),
            ratio(best, run.front),
            ratio(run.evaluations, best),
        );
    }
}

fn timed(solid: &Solid, criterion: Criterion, level: u8) -> (Adaptive, f64) {
    let run = || adaptive(solid, criterion, level, Halt::AtPlanes);
    (run(), 1e3 * seconds(run))
}

/// Tables 6.5 and 6.6.
fn boxes() {
    const THEN: [[[u64; 4]; 3]; 2] = [
        [
            [16_320, 1_424, 4_104, 724],
            [67_728, 19_872, 61_620, 18_864],
            [82_200, 20_256, 34_612, 11_062],
        ],
        [
            [19_302, 1_424, 4_392, 724],
            [68_880, 19_872, 61_908, 18_864],
            [84_170, 20_452, 36_232, 11_636],
        ],
    ];
    println!(
        "\n**Tables 6.5 and 6.6** a box of volume V and one of 8V by Bézier's criterion; 1992 / now\n"
    );
    println!("| solid | box | classified | MAO | simplices | minimal | ms |");
    println!("| :-- | --: | --: | --: | --: | --: | --: |");
    for (at, name) in THREE.into_iter().enumerate() {
        for (then, volume, width, level) in [(THEN[0], 1, 1.0, LEVEL), (THEN[1], 8, 2.0, LEVEL + 3)]
        {
            let solid = load_in(name, width);
            let (run, ms) = timed(&solid, Criterion::Bezier, level);
            let [classified, optimum, simplices, minimal] = then[at];
            println!(
                "| {name} | {volume}V | {classified} / {} | {optimum} / {} | {simplices} / {} | {minimal} / {} | {ms:.2} |",
                run.classifications, run.front_primitives, run.simplices, run.front,
            );
        }
    }
}

/// Tables 6.7 and 6.8, and the criterion that the thesis did not measure.
fn criteria() {
    const THEN: [[[u64; 3]; 3]; 2] = [
        [
            [19_302, 4_392, 514],
            [68_880, 61_908, 576],
            [84_170, 36_232, 4_572],
        ],
        [
            [18_064, 4_016, 326],
            [68_304, 61_620, 432],
            [83_814, 36_036, 4_474],
        ],
    ];
    println!("\n**Tables 6.7 and 6.8** criteria in the box of 8V; 1992 / now\n");
    println!("| solid | criterion | classified | simplices | bisected in vain | ms |");
    println!("| :-- | :-- | --: | --: | --: | --: |");
    let criteria = [Criterion::Bezier, Criterion::Rivlin, Criterion::Lipschitz];
    for (at, name) in THREE.into_iter().enumerate() {
        let solid = load_in(name, 2.0);
        for (number, criterion) in criteria.into_iter().enumerate() {
            let (run, ms) = timed(&solid, criterion, LEVEL + 3);
            let then = THEN.get(number).map(|t| t[at].map(|n| n.to_string()));
            let [a, b, c] = then
                .unwrap_or_default()
                .map(|n| if n.is_empty() { "–".into() } else { n });
            println!(
                "| {name} | {criterion:?} | {a} / {} | {b} / {} | {c} / {} | {ms:.2} |",
                run.classifications, run.simplices, run.wrongly_bisected,
            );
        }
    }
}
