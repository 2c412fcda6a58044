//! Compares csg2brep with manifold3d and fidget on seven solids at equal measured error, in one
//! run.
//!
//! ```text
//! cargo run --release --manifest-path benches/peers/Cargo.toml [-- [SOLID …]]
//! ```
//!
//! For each solid and each target error, manifold3d's segments, fidget's grid, our tolerance, our
//! tolerance for facets from the true surfaces and our fixed level are chosen as coarse as the
//! measured error allows; then all run in turn, one thread each, and their least times are
//! compared. Prints Markdown.

mod manifold;
mod measure;
mod memory;
mod search;
mod solids;
mod surfaces;
mod tools;
mod truth;

use glam::DVec3;
use manifold::Manifold;
use measure::Spread;
use search::{Attempt, Setting};
use solids::Solid;
use std::time::Instant;
use subdiv::Rule;
use tools::{Form, Grid};
use truth::Truth;

/// Errors asked for, as parts of the longest side.
const TARGETS: [f64; 2] = [1e-3, 1e-2];

/// Picks the distance that counts.
type Which = fn(Spread) -> f64;

/// Which distances count, in words.
const MEASURES: [(&str, Which); 2] = [
    ("every sample", |spread| spread.worst),
    ("all but one sample in a thousand", |spread| spread.usual),
];

/// The ways that are compared, in this order.
const WAYS: [&str; 7] = [
    "surfaces",
    "surfaces, proved",
    "surfaces, mean fit",
    "tolerance",
    "level",
    "manifold3d",
    "fidget",
];

/// Timed runs of each program.
const RUNS: usize = 9;

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let manifold = Manifold::start();
    let mut tables = [const { [const { Table::new() }; 2] }; 2];
    for solid in solids::all() {
        if wanted.is_empty() || wanted.iter().any(|name| name == solid.name) {
            compare(&solid, &manifold, &mut tables);
        }
    }
    for (target, tables) in TARGETS.into_iter().zip(&tables) {
        for ((measure, _), table) in MEASURES.iter().zip(tables) {
            println!("## {measure} within {target:e} of the longest side\n");
            println!(
                "| solid | program | setting | triangles | ms, median (least) | mesh to true | \
                 true to mesh | peak bytes a triangle |"
            );
            println!("|---|---|---|---:|---:|---:|---:|---:|\n{}", table.rows);
            println!(
                "| | surfaces / manifold3d | triangles | proved / manifold3d | triangles | mean fit / manifold3d | triangles | \
                 surfaces / fidget | tolerance / fidget | level / fidget |"
            );
            println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n{}", table.ratios);
        }
    }
}

/// Markdown as it grows.
struct Table {
    rows: String,
    ratios: String,
}

impl Table {
    const fn new() -> Self {
        Self {
            rows: String::new(),
            ratios: String::new(),
        }
    }
}

/// A solid under test.
struct Subject<'a> {
    solid: &'a Solid,
    manifold: &'a Manifold,
    model: csg::Model,
    truth: Truth<'a>,
}

/// Adds a solid to all tables.
fn compare(solid: &Solid, manifold: &Manifold, tables: &mut [[Table; 2]; 2]) {
    eprintln!("{} {}", solid.name, solid.what);
    let truth = Truth::new(solid, 200.0);
    let model = tools::model(solid);
    check_same_solid(solid, &model, &truth);
    let side = truth.longest_side;
    let finest = TARGETS[0] * side;
    // A program's ways to the same end; the quickest that is close enough counts.
    let surfaces = |fit, is_proved| {
        vec![search::our_surfaces(&model, &truth, &TARGETS, fit, is_proved)]
    };
    let ways = [
        surfaces(brep::Fit::Inscribed, false),
        surfaces(brep::Fit::Inscribed, true),
        surfaces(brep::Fit::Mean, false),
        vec![search::our_tolerances(&model, &truth, finest)],
        vec![search::our_levels(&model, &truth, finest)],
        vec![search::manifold_segments(manifold, solid, &truth, finest)],
        [Form::Distance, Form::Polynomial]
            .map(|form| search::fidget_grids(solid, form, &truth, finest))
            .to_vec(),
    ];
    let subject = Subject {
        solid,
        manifold,
        model,
        truth,
    };
    for (target, tables) in TARGETS.into_iter().zip(tables) {
        for ((_, which), table) in MEASURES.iter().zip(tables) {
            let coarsest = |attempts: &Vec<Attempt>| {
                let fit = attempts.iter().filter(|a| a.error(*which) <= target * side);
                fit.copied().min_by_key(|a| a.triangles)
            };
            let chosen = ways.each_ref().map(|ways| {
                let fit = ways.iter().filter_map(coarsest);
                fit.min_by(|a, b| subject.quick_look(a).total_cmp(&subject.quick_look(b)))
            });
            subject.race(chosen, *which, table);
        }
    }
}

impl Subject<'_> {
    /// Milliseconds that a program takes, mesh only.
    fn time(&self, setting: Setting) -> f64 {
        match setting {
            Setting::Ours(rule) => milliseconds(|| tools::ours(&self.model, rule)),
            Setting::Surfaces(tolerance, fit, is_proved) => {
                milliseconds(|| tools::ours_from_surfaces(&self.model, tolerance, fit, is_proved))
            }
            Setting::Manifold(segments) => self.manifold.time(self.solid.name, segments),
            Setting::Fidget(form, grid) => {
                let expression = tools::expression(self.solid, form);
                milliseconds(|| tools::fidget(&expression, grid))
            }
        }
    }

    fn quick_look(&self, attempt: &Attempt) -> f64 {
        (0..3)
            .map(|_| self.time(attempt.setting))
            .fold(f64::MAX, f64::min)
    }

    /// Of programs in this process.
    fn peak_bytes(&self, setting: Setting) -> Option<usize> {
        Some(match setting {
            Setting::Ours(rule) => memory::peak_of(|| tools::ours(&self.model, rule)).1,
            Setting::Surfaces(tolerance, fit, is_proved) => {
                let ours = || tools::ours_from_surfaces(&self.model, tolerance, fit, is_proved);
                memory::peak_of(ours).1
            }
            Setting::Manifold(_) => return None,
            Setting::Fidget(form, grid) => {
                let expression = tools::expression(self.solid, form);
                memory::peak_of(|| tools::fidget(&expression, grid)).1
            }
        })
    }

    /// Runs all in turn, so that what else the machine does hits all alike.
    fn race(&self, chosen: [Option<Attempt>; WAYS.len()], which: Which, table: &mut Table) {
        let mut times = [const { Vec::new() }; WAYS.len()];
        for _ in 0..RUNS {
            for (attempt, times) in chosen.iter().zip(&mut times) {
                times.extend(attempt.map(|attempt| self.time(attempt.setting)));
            }
        }
        for times in &mut times {
            times.sort_by(f64::total_cmp);
        }
        for (attempt, times) in chosen.iter().zip(&times) {
            if let Some(attempt) = attempt {
                table.rows += &self.row(attempt, times, which);
            }
        }
        let at = |way: &str| WAYS.iter().position(|w| *w == way).expect("a way");
        // The least time is what the machine's other work disturbs least.
        let time = |one: &str, other: &str| match (times[at(one)].first(), times[at(other)].first())
        {
            (Some(ours), Some(theirs)) => format!("{:.2}", ours / theirs),
            _ => "–".to_owned(),
        };
        let triangles = |one: &str, other: &str| match (chosen[at(one)], chosen[at(other)]) {
            (Some(ours), Some(theirs)) => {
                format!("{:.2}", ours.triangles as f64 / theirs.triangles as f64)
            }
            _ => "–".to_owned(),
        };
        table.ratios += &format!(
            "| {} {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n",
            self.solid.name,
            self.solid.what,
            time("surfaces", "manifold3d"),
            triangles("surfaces", "manifold3d"),
            time("surfaces, proved", "manifold3d"),
            triangles("surfaces, proved", "manifold3d"),
            time("surfaces, mean fit", "manifold3d"),
            triangles("surfaces, mean fit", "manifold3d"),
            time("surfaces", "fidget"),
            time("tolerance", "fidget"),
            time("level", "fidget"),
        );
    }

    fn row(&self, attempt: &Attempt, times: &[f64], which: Which) -> String {
        let side = self.truth.longest_side;
        let (program, mut setting) = match attempt.setting {
            Setting::Ours(Rule::Tolerance(t)) => ("ours", format!("tolerance {:.1e}", t / side)),
            Setting::Ours(Rule::Level(level)) => ("ours", format!("level {level}")),
            Setting::Ours(Rule::Topology { finest }) => ("ours", format!("cells {finest:.1e}")),
            Setting::Surfaces(t, brep::Fit::Inscribed, is_proved) => {
                let proved = if is_proved { ", proved" } else { "" };
                ("ours", format!("surfaces{proved}, tolerance {:.2e}", t / side))
            }
            Setting::Surfaces(t, brep::Fit::Mean, _) => (
                "ours",
                format!("surfaces, mean fit, tolerance {:.2e}", t / side),
            ),
            Setting::Manifold(segments) => ("manifold3d", format!("{segments} segments")),
            Setting::Fidget(form, Grid { depth, half, .. }) => {
                let cube = 2.0 * half / side;
                ("fidget", format!("{form:?}, depth {depth}, cube {cube:.2}"))
            }
        };
        if attempt.not_numbers > 0 {
            setting += &format!(", {} vertices NaN", attempt.not_numbers);
        }
        format!(
            "| {} | {program} | {setting} | {} | {:.1} ({:.1}) | {:.1e} | {:.1e} | {} |\n",
            self.solid.name,
            attempt.triangles,
            times[times.len() / 2],
            times[0],
            which(attempt.distances.to_boundary) / side,
            which(attempt.distances.to_mesh) / side,
            self.peak_bytes(attempt.setting)
                .map_or("–".to_owned(), |peak| {
                    format!("{:.0}", peak as f64 / attempt.triangles as f64)
                }),
        )
    }
}

fn milliseconds<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    let result = work();
    let elapsed = start.elapsed();
    drop(std::hint::black_box(result));
    elapsed.as_secs_f64() * 1e3
}

/// The tree written by hand and the file must mean the same points.
fn check_same_solid(solid: &Solid, model: &csg::Model, truth: &Truth<'_>) {
    let built = csg::Solid::build(model, None).expect("a bounded solid");
    let mut state = 1u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    for _ in 0..20_000 {
        let p = DVec3::new(random(), random(), random()) * solid.reach;
        let value = truth.value(p);
        let agree = value.abs() < 1e-9 || built.contains(p) == (value < 0.0);
        assert!(agree, "{}: file and tree differ at {p}", solid.name);
    }
}
