//! Section 6.4: rays through the bintree.

use crate::reduction::chmutov;
use crate::solids::read_fixture;
use csg::Solid;
use glam::DVec3;
use std::time::Instant;
use subdiv::rays::Tracer;

/// Rays on each axis of a picture, and of the bundles that travel together.
const SIDE: u32 = 512;
const TILE: u32 = 64;

/// Prints what a ray costs.
pub(crate) fn table() {
    println!("\n**Section 6.4** {SIDE} × {SIDE} parallel rays at each solid\n");
    println!("| solid | surfaces | highest degree | rays that hit | µs a ray |");
    println!("| :-- | --: | --: | --: | --: |");
    for name in [
        "solids/S1_sphere",
        "solids/S3_torus_sphere",
        "solids/S7_heart",
        "solids/S5_ring128",
        "solids/S6_plate64",
        "models/tee",
        "thesis/atomo",
        "thesis/chupeta",
    ] {
        let solid = Solid::build(&read_fixture(name), None).expect("a bounded fixture");
        row(name, &solid);
    }
    for degree in [10, 12, 14, 16, 20] {
        row("Chmutov", &chmutov(degree));
    }
}

fn row(name: &str, solid: &Solid) {
    let degrees = solid.primitives.iter().map(|p| p.polynomial.degree());
    let (hits, microseconds) = trace(solid);
    println!(
        "| {name} | {} | {} | {hits} | {microseconds:.2} |",
        solid.primitives.len(),
        degrees.max().unwrap_or(0),
    );
}

fn trace(solid: &Solid) -> (usize, f64) {
    let direction = DVec3::new(-1.0, 1.0, -1.0).normalize();
    let right = DVec3::new(1.0, 1.0, 0.0).normalize();
    let up = right.cross(direction);
    let middle = (solid.extent.min + solid.extent.max) * 0.5;
    let half = solid.extent.diagonal() * 0.5;
    let along = |at: u32| half * ((f64::from(at) + 0.5) / f64::from(SIDE) * 2.0 - 1.0);
    let start = Instant::now();
    let tracer = Tracer::new(solid);
    let mut hits = 0;
    for tile in 0..(SIDE / TILE).pow(2) {
        let corner = [tile % (SIDE / TILE) * TILE, tile / (SIDE / TILE) * TILE];
        let origins: Vec<DVec3> = (0..TILE * TILE)
            .map(|at| [corner[0] + at % TILE, corner[1] + at / TILE].map(along))
            .map(|[x, y]| middle + right * x + up * y)
            .collect();
        let found = tracer.first_hits(direction, &origins);
        hits += found.expect("few surfaces").iter().flatten().count();
    }
    let rays = f64::from(SIDE * SIDE);
    (hits, start.elapsed().as_secs_f64() * 1e6 / rays)
}
