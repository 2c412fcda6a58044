//! Section 6.3.4: paths to the smallest simplices instead of their geometry.

use crate::seconds;
use crate::solids::load;
use std::hint::black_box;
use subdiv::Criterion;
use subdiv::methods::{Geometry, Halt, Paths, adaptive};

/// Prints what the geometry costs in either way.
pub(crate) fn table() {
    println!(
        "\n**Section 6.3.4** CHUPETA by Bézier's criterion, {} bytes a path\n",
        Paths::bytes_per_path()
    );
    println!(
        "| level | simplices that stay open | whole descent, ms | geometry carried, ms | geometry from paths, ms |"
    );
    println!("| --: | --: | --: | --: | --: |");
    let solid = load("chupeta");
    for level in [12, 15, 18, 21] {
        let paths = Paths::new(&solid, Criterion::Bezier, level);
        let whole = seconds(|| adaptive(&solid, Criterion::Bezier, level, Halt::Never));
        let [carried, followed] = [Geometry::Carried, Geometry::FromPaths].map(|geometry| {
            seconds(|| {
                paths.for_each(geometry, |cell| {
                    black_box(cell);
                });
            })
        });
        println!(
            "| {level} | {} | {:.2} | {:.2} | {:.2} |",
            paths.len(),
            1e3 * whole,
            1e3 * carried,
            1e3 * followed,
        );
    }
}
