//! Section 6.3.5: criteria for functions that are not polynomials.

use crate::seconds;
use csg::{Aabb, Domain, Formula, FormulaNode, Literal, MaterialId, PrimitiveId, Sense};
use csg::{ModelBuilder, Node, Shape, Solid};
use glam::DVec3;
use subdiv::Criterion;
use subdiv::functions::{Bound, Expression, subdivide};
use subdiv::methods::{Halt, adaptive};

const LEVEL: u8 = 15;

/// Prints how many simplices each criterion looks at.
pub(crate) fn table() {
    println!("\n**Section 6.3.5** level {LEVEL}\n");
    println!("| solid | criterion | simplices | undecided leaves | ms |");
    println!("| :-- | :-- | --: | --: | --: |");
    let [x, y, z] = Expression::variables();
    let ring = (x.clone().square() + y.clone().square()).sqrt() - Expression::from(1.0);
    let torus = (ring.square() + z.clone().square()).sqrt() - Expression::from(0.4);
    row("torus, √", &torus, DVec3::new(1.4, 1.4, 0.4));
    quartic_torus();
    let bump = |shift: f64| {
        let along = (x.clone() + Expression::from(shift)).square();
        (-(along + y.clone().square() + z.clone().square())).exp()
    };
    let blob = Expression::from(0.5) - bump(0.7) - bump(-0.7);
    row("blob, exp", &blob, DVec3::new(1.7, 1.1, 1.1));
    let gyroid = x.clone().sin() * y.clone().cos() + y.sin() * z.clone().cos() + z.sin() * x.cos();
    row("gyroid, sin", &gyroid, DVec3::splat(std::f64::consts::PI));
}

fn row(name: &str, function: &Expression, half: DVec3) {
    let domain = Domain::around(&Aabb {
        min: -half,
        max: half,
    });
    let literal = FormulaNode::Literal(Literal {
        primitive: PrimitiveId(0),
        sense: Sense::Inside,
        material: MaterialId(0),
    });
    let formula = Formula::new(vec![literal]).expect("one literal");
    for bound in [Bound::Interval, Bound::Slope] {
        let function = std::slice::from_ref(function);
        let run = || subdivide(function, &formula, &domain, LEVEL, bound).expect("a level");
        let (simplices, leaves) = (run().simplices, run().leaves);
        let ms = 1e3 * seconds(run);
        println!("| {name} | {bound:?} | {simplices} | {leaves} | {ms:.1} |");
    }
}

/// The same torus as a polynomial.
fn quartic_torus() {
    let mut model = ModelBuilder::new();
    let torus = model.add(Node::Shape(Shape::torus(1.0, 0.4).expect("a torus")));
    let solid = Solid::build(&model.finish(torus), None).expect("bounded");
    for criterion in [Criterion::Bezier, Criterion::Rivlin, Criterion::Lipschitz] {
        let run = || adaptive(&solid, criterion, LEVEL, Halt::Never);
        let done = run();
        let ms = 1e3 * seconds(run);
        println!(
            "| torus, quartic | {criterion:?} | {} | {} | {ms:.1} |",
            done.simplices,
            done.found.cells.len()
        );
    }
}
