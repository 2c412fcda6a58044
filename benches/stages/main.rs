//! What each stage costs: first a table of nanoseconds a bisection and a triangle, then divan's.
//!
//! ```text
//! cargo bench --bench stages
//! ```
//!
//! One thread throughout. `docs/performance.md` says what the figures mean.

mod costs;
mod samples;
mod topology;

use divan::Bencher;
use divan::counter::ItemsCount;
use samples::{LEVEL, SAMPLES, Sample, TOLERANCE, power_ball};
use subdiv::{Fragments, Rule, convert};

fn main() {
    let only_named = std::env::args().any(|a| a == "--list" || a == "--test");
    if !only_named {
        costs::print();
        topology::print();
    }
    // Options on the command line come last and win.
    divan::Divan::default()
        .sample_count(20)
        .config_with_args()
        .main();
}

/// Root conversion with its six leaves: everything that is not bisection.
#[divan::bench(args = [2, 4, 6, 8, 10, 12, 14, 16, 18, 20])]
fn root_conversion(bencher: Bencher<'_, '_>, degree: usize) {
    let solid = power_ball(degree);
    bencher.bench(|| convert(&solid, &samples::settings(Rule::Level(0)), &()));
}

/// Bisections with what hangs on them, at a fixed level; items are bisections.
#[divan::bench(args = [2, 4, 6, 8, 12, 20])]
fn halving(bencher: Bencher<'_, '_>, degree: usize) {
    let solid = power_ball(degree);
    let settings = samples::settings(Rule::Level(15));
    let report = convert(&solid, &settings, &()).expect("no limit").report;
    bencher
        .counter(ItemsCount::new(report.bisections))
        .bench(|| convert(&solid, &settings, &()));
}

#[divan::bench(args = SAMPLES)]
fn building(bencher: Bencher<'_, '_>, sample: &Sample) {
    let model = sample.model();
    bencher.bench(|| csg::Solid::build(&model, None));
}

/// Items are triangles, here and below.
#[divan::bench(args = SAMPLES)]
fn fixed_level(bencher: Bencher<'_, '_>, sample: &Sample) {
    conversion(bencher, sample, Rule::Level(LEVEL));
}

#[divan::bench(args = SAMPLES)]
fn tolerance(bencher: Bencher<'_, '_>, sample: &Sample) {
    let solid = sample.solid();
    let size = (solid.extent.max - solid.extent.min).max_element();
    conversion(bencher, sample, Rule::Tolerance(TOLERANCE * size));
}

fn conversion(bencher: Bencher<'_, '_>, sample: &Sample, rule: Rule) {
    let solid = sample.solid();
    let settings = samples::settings(rule);
    let outcome = convert(&solid, &settings, &()).expect("no limit");
    bencher
        .counter(ItemsCount::new(outcome.fragments.triangles.len()))
        .bench(|| convert(&solid, &settings, &()));
}

#[divan::bench(args = SAMPLES)]
fn stitching(bencher: Bencher<'_, '_>, sample: &Sample) {
    let fragments = sample.fragments();
    counted(bencher, &fragments).bench(|| brep::stitch(&fragments));
}

#[divan::bench(args = SAMPLES)]
fn validation(bencher: Bencher<'_, '_>, sample: &Sample) {
    let fragments = sample.fragments();
    let stitched = brep::stitch(&fragments).expect("paired half-edges");
    counted(bencher, &fragments)
        .with_inputs(|| stitched.clone())
        .bench_values(brep::Brep::validate);
}

#[divan::bench(args = SAMPLES)]
fn grouping(bencher: Bencher<'_, '_>, sample: &Sample) {
    let brep = sample.brep();
    bencher.bench(|| brep::Groups::of(&brep));
}

#[divan::bench(args = SAMPLES)]
fn reading(bencher: Bencher<'_, '_>, sample: &Sample) {
    bencher
        .counter(divan::counter::BytesCount::of_str(sample.source))
        .bench(|| sample.model());
}

#[divan::bench(args = SAMPLES)]
fn writing_obj(bencher: Bencher<'_, '_>, sample: &Sample) {
    let (fragments, brep) = (sample.fragments(), sample.brep());
    let options = io::write::obj::Options::default();
    counted(bencher, &fragments).bench(|| {
        let mut bytes = Vec::new();
        io::write::obj::write(&brep, &options, &mut bytes).map(|()| bytes)
    });
}

#[divan::bench(args = SAMPLES)]
fn writing_gltf(bencher: Bencher<'_, '_>, sample: &Sample) {
    let (fragments, brep, solid) = (sample.fragments(), sample.brep(), sample.solid());
    let options = io::write::gltf::Options::default();
    counted(bencher, &fragments).bench(|| {
        let mut bytes = Vec::new();
        io::write::gltf::write(&brep, &solid.materials, &options, &mut bytes).map(|()| bytes)
    });
}

#[divan::bench(args = SAMPLES)]
fn writing_stl(bencher: Bencher<'_, '_>, sample: &Sample) {
    let (fragments, brep) = (sample.fragments(), sample.brep());
    counted(bencher, &fragments).bench(|| {
        let mut bytes = Vec::new();
        io::write::stl::write(&brep, &mut bytes).map(|_| bytes)
    });
}

fn counted<'a, 'b>(bencher: Bencher<'a, 'b>, fragments: &Fragments) -> Bencher<'a, 'b> {
    bencher.counter(ItemsCount::new(fragments.triangles.len()))
}
