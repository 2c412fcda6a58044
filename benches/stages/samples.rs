//! The solids that the benchmarks convert.

use brep::{Brep, Valid};
use csg::{Model, ModelBuilder, Node, Polynomial, Shape, Solid};
use std::fmt::{self, Display};
use subdiv::{Fragments, Outcome, Rule, Settings};

/// A solid from the fixtures.
#[derive(Debug)]
pub(crate) struct Sample {
    name: &'static str,
    /// The text of its file.
    pub(crate) source: &'static str,
}

/// A sphere, a torus with a sphere, a block with everything; many parts; degree 6.
pub(crate) const SAMPLES: &[Sample] = &[
    Sample {
        name: "sphere",
        source: include_str!("../../fixtures/solids/S1_sphere.csg"),
    },
    Sample {
        name: "torus",
        source: include_str!("../../fixtures/solids/S3_torus_sphere.csg"),
    },
    Sample {
        name: "demo",
        source: include_str!("../../fixtures/solids/S2_demo.csg"),
    },
    Sample {
        name: "ring",
        source: include_str!("../../fixtures/solids/S5_ring128.csg"),
    },
    Sample {
        name: "heart",
        source: include_str!("../../fixtures/solids/S7_heart.csg"),
    },
];

/// The seven solids that are compared with other programs, too.
pub(crate) const SEVEN: &[Sample] = &[
    Sample {
        name: "S1 sphere",
        source: include_str!("../../fixtures/solids/S1_sphere.csg"),
    },
    Sample {
        name: "S2 demo",
        source: include_str!("../../fixtures/solids/S2_demo.csg"),
    },
    Sample {
        name: "S3 torus ∪ sphere",
        source: include_str!("../../fixtures/solids/S3_torus_sphere.csg"),
    },
    Sample {
        name: "S4 64 spheres",
        source: include_str!("../../fixtures/solids/S4_64_spheres.csg"),
    },
    Sample {
        name: "S5 ring of 128",
        source: include_str!("../../fixtures/solids/S5_ring128.csg"),
    },
    Sample {
        name: "S6 plate",
        source: include_str!("../../fixtures/solids/S6_plate64.csg"),
    },
    Sample {
        name: "S7 heart",
        source: include_str!("../../fixtures/solids/S7_heart.csg"),
    },
];

/// The fixed level: cells of 1/32 of the domain.
pub(crate) const LEVEL: u8 = 15;

/// The tolerance, in longest sides of the solid.
pub(crate) const TOLERANCE: f64 = 4e-3;

impl Sample {
    /// Reads it.
    pub(crate) fn model(&self) -> Model {
        let options = io::read::ReadOptions::default();
        let reading = io::read::scad_csg::read(self.source, self.name, &options);
        reading.expect("a readable fixture").model
    }

    /// Reads and builds it.
    pub(crate) fn solid(&self) -> Solid {
        Solid::build(&self.model(), None).expect("a bounded fixture")
    }

    /// Its boundary at the fixed level.
    pub(crate) fn fragments(&self) -> Fragments {
        converted(&self.solid(), Rule::Level(LEVEL)).fragments
    }

    /// The same, stitched and validated.
    pub(crate) fn brep(&self) -> Valid<Brep> {
        let stitched = brep::stitch(&self.fragments()).expect("paired half-edges");
        stitched.validate().expect("a manifold")
    }
}

impl Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// One thread.
pub(crate) fn settings(rule: Rule) -> Settings {
    Settings {
        threads: Some(1),
        ..Settings::new(rule)
    }
}

/// Converts with one thread.
pub(crate) fn converted(solid: &Solid, rule: Rule) -> Outcome {
    subdiv::convert(solid, &settings(rule), &()).expect("no limit is near")
}

/// `xⁿ + yⁿ + zⁿ ≤ 1`, n even.
pub(crate) fn power_ball(n: usize) -> Solid {
    let terms = [
        ([n, 0, 0], 1.0),
        ([0, n, 0], 1.0),
        ([0, 0, n], 1.0),
        ([0, 0, 0], -1.0),
    ];
    let polynomial = Polynomial::from_terms(n, &terms).expect("a degree in range");
    single(Shape::Polynomial(polynomial))
}

/// A solid of one shape.
pub(crate) fn single(shape: Shape) -> Solid {
    let mut builder = ModelBuilder::new();
    let root = builder.add(Node::Shape(shape));
    Solid::build(&builder.finish(root), None).expect("a bounded shape")
}
