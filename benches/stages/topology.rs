//! The topological rule beside the metric one on the seven solids.

use crate::samples::{SEVEN, Sample, converted};
use std::time::Instant;
use subdiv::{Outcome, Rule};

/// Runs of a conversion, of which the quickest counts.
const RUNS: usize = 7;

/// Tolerance and finest cell, in longest sides of the solid.
const FRACTION: f64 = 1e-3;

/// Prints the table as Markdown.
pub(crate) fn print() {
    println!("Topology only beside the metric rule at {FRACTION} of the longest side\n");
    println!(
        "| solid | leaves, metric | leaves, topology | of these uncertified | repeated extractions \
         | ms, metric | ms, topology | proving | balancing | extraction |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for sample in SEVEN {
        let solid = sample.solid();
        let length = FRACTION * (solid.extent.max - solid.extent.min).max_element();
        let (metric, metric_s) = quickest(sample, Rule::Tolerance(length));
        let (coarse, coarse_s) = quickest(sample, Rule::Topology { finest: length });
        let [proving, balancing, extraction] = coarse.report.seconds.map(|s| s * 1e3);
        println!(
            "| {sample} | {} | {} | {} | {} | {:.1} | {:.1} | {proving:.1} | {balancing:.1} | {extraction:.1} |",
            metric.report.leaves,
            coarse.report.leaves,
            coarse.report.uncertified_leaves,
            coarse.report.rounds,
            metric_s * 1e3,
            coarse_s * 1e3,
        );
    }
    println!();
}

fn quickest(sample: &Sample, rule: Rule) -> (Outcome, f64) {
    let solid = sample.solid();
    let runs = (0..RUNS).map(|_| {
        let start = Instant::now();
        let outcome = converted(&solid, rule);
        (outcome, start.elapsed().as_secs_f64())
    });
    let quickest = runs.min_by(|a, b| a.1.total_cmp(&b.1));
    quickest.expect("at least one run")
}
