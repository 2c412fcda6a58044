//! Nanoseconds a bisection and a triangle, from the subdivision's own report.

use crate::samples::{LEVEL, SAMPLES, TOLERANCE, converted, power_ball, single};
use csg::{Shape, Solid};
use glam::DVec3;
use std::time::Instant;
use subdiv::{Outcome, Rule};

/// Runs of a conversion, of which the quickest counts.
const RUNS: usize = 7;

/// Runs of what takes microseconds.
const SHORT_RUNS: usize = 300;

/// Prints both tables as Markdown.
pub(crate) fn print() {
    by_degree();
    by_solid();
}

/// Roots and bisections of one polynomial. Level 0 is what a conversion costs without bisections:
/// it starts a thread, converts the roots and extracts six leaves.
fn by_degree() {
    println!("One surface, by degree (`xⁿ + yⁿ + zⁿ = 1`; 1: a block)\n");
    println!("| degree | level 0, µs | bisections at level {LEVEL} | ns a bisection |");
    println!("|---:|---:|---:|---:|");
    let block = Shape::block(-DVec3::ONE, DVec3::ONE).expect("corners in order");
    for degree in std::iter::once(1).chain((2..=20).step_by(2)) {
        let solid = match degree {
            1 => single(block.clone()),
            _ => power_ball(degree),
        };
        let (_, roots_s) = least(&solid, Rule::Level(0), SHORT_RUNS);
        let (outcome, total_s) = least(&solid, Rule::Level(LEVEL), RUNS);
        let bisections = outcome.report.bisections;
        let each_ns = (total_s - roots_s) * 1e9 / bisections as f64;
        println!(
            "| {degree} | {:.0} | {bisections} | {each_ns:.0} |",
            roots_s * 1e6
        );
    }
    println!();
}

/// Whole conversions, both rules.
fn by_solid() {
    println!("Whole conversions: fixed level {LEVEL}, and tolerance {TOLERANCE} of the size\n");
    println!(
        "| solid | rule | bisections | triangles | ms | ns a bisection | ns a triangle | \
         proving, ns a simplex visited | proving % | balancing % | extraction % |"
    );
    println!("|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for sample in SAMPLES {
        let solid = sample.solid();
        let size = (solid.extent.max - solid.extent.min).max_element();
        for rule in [Rule::Level(LEVEL), Rule::Tolerance(TOLERANCE * size)] {
            let (outcome, total_s) = least(&solid, rule, RUNS);
            println!("| {sample} | {} |", row(rule, &outcome, total_s));
        }
    }
    println!();
}

fn row(rule: Rule, outcome: &Outcome, total_s: f64) -> String {
    let report = &outcome.report;
    let triangles = outcome.fragments.triangles.len();
    let [proving, balancing, extraction] = report.seconds;
    let proved = report.visited - report.bisections - report.leaves;
    let name = match rule {
        Rule::Level(_) => "level",
        Rule::Tolerance(_) => "tolerance",
        Rule::Topology { .. } => "topology",
    };
    let proving_each = if matches!(rule, Rule::Tolerance(_)) {
        format!("{:.0}", proving * 1e9 / proved as f64)
    } else {
        "–".to_owned()
    };
    let percent = |part: f64| 100.0 * part / (proving + balancing + extraction);
    format!(
        "{name} | {} | {triangles} | {:.1} | {:.0} | {:.0} | {proving_each} | {:.0} | {:.0} | {:.0}",
        report.bisections,
        total_s * 1e3,
        total_s * 1e9 / report.bisections as f64,
        total_s * 1e9 / triangles as f64,
        percent(proving),
        percent(balancing),
        percent(extraction),
    )
}

/// The quickest of several runs, and its seconds.
fn least(solid: &Solid, rule: Rule, count: usize) -> (Outcome, f64) {
    let runs = (0..count).map(|_| {
        let start = Instant::now();
        let outcome = converted(solid, rule);
        (outcome, start.elapsed().as_secs_f64())
    });
    let quickest = runs.min_by(|a, b| a.1.total_cmp(&b.1));
    quickest.expect("at least one run")
}
