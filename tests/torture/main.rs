//! The torture set: solids on which programs for set operations break, each with its exact
//! topology and volume, judged by our validation, by formulas and by manifold3d.
//!
//! A file holds the cases of one kind. Where parts touch, more than one topology is right, and
//! the case names them all.

#![expect(
    clippy::too_many_lines,
    reason = "tables of cases are as long as they are"
)]

#[path = "../stages/mod.rs"]
mod stages;
#[path = "../support/mod.rs"]
mod support;

mod case;
mod flat;
mod high_degree;
mod many;
mod moved;
mod nested;
mod round;
mod singular;
mod touching;
mod tree;

use case::{Case, check};

/// One test for each kind of cases.
macro_rules! kinds {
    ($($test:ident: $cases:path;)*) => {
        $(
            #[test]
            fn $test() {
                check(&$cases());
            }
        )*

        fn all() -> Vec<Case> {
            let mut all = Vec::new();
            $(all.extend($cases());)*
            all
        }
    };
}

kinds! {
    coplanar_faces: flat::cases;
    contacts_of_edges_and_vertices: touching::cases;
    tangent_surfaces: round::cases;
    singular_points: singular::cases;
    cavities_links_and_thin_walls: nested::cases;
    turned_mirrored_sheared: moved::cases;
    surfaces_of_high_degree: high_degree::cases;
    a_thousand_parts: many::cases;
}

#[test]
fn there_are_at_least_a_hundred() {
    assert!(all().len() >= 170, "{} cases", all().len());
}
