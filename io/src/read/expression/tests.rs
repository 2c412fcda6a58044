use super::*;
use proptest::prelude::*;
use std::fmt::Write as _;

fn terms(text: &str) -> Vec<([u8; 3], f64)> {
    parse(text, 64, &mut WORK.clone()).unwrap().iter().collect()
}

fn refused(text: &str) -> String {
    let error = parse(text, 64, &mut WORK.clone()).unwrap_err();
    format!("{}: {}", error.span.start, error.message)
}

#[test]
fn precedence_is_that_of_mathematics() {
    assert_eq!(terms("1 - 2 - 3"), vec![([0; 3], -4.0)]);
    assert_eq!(terms("-2^2"), vec![([0; 3], -4.0)]);
    assert_eq!(terms("2^3^2"), vec![([0; 3], 512.0)]);
    assert_eq!(terms("2*-3"), vec![([0; 3], -6.0)]);
    assert_eq!(terms("2^-1 + 1"), vec![([0; 3], 1.5)]);
    assert_eq!(terms("8/2/2"), vec![([0; 3], 2.0)]);
    assert_eq!(terms("- -3"), vec![([0; 3], 3.0)]);
    assert_eq!(terms("-x^2"), vec![([2, 0, 0], -1.0)]);
    assert_eq!(
        terms("2 - (x - 3)*4"),
        vec![([0; 3], 14.0), ([1, 0, 0], -4.0)]
    );
    assert_eq!(terms("x**2"), vec![([2, 0, 0], 1.0)]);
}

#[test]
fn sums_are_multiplied_out() {
    let square = vec![([0, 0, 2], 1.0), ([0, 1, 1], 2.0), ([0, 2, 0], 1.0)];
    assert_eq!(terms("(y + z)^2"), square);
    assert_eq!(terms("x - x"), vec![]);
    assert_eq!(terms("x^0"), vec![([0; 3], 1.0)]);
    assert_eq!(terms("(x+y+z+1)^64").len(), 65 * 66 * 67 / 6);
}

#[test]
fn the_degree_is_limited_before_anything_is_multiplied() {
    assert_eq!(refused("x^65"), "1: degree 65 is above the limit of 64");
    assert_eq!(
        refused("x^40 * (y + 1)^25"),
        "5: degree 65 is above the limit of 64"
    );
    assert_eq!(
        refused("(x + y)^1e15"),
        "7: degree 1000000000000000 is above the limit of 64"
    );
    assert_eq!(
        refused("((x^9)^9)^9"),
        "6: degree 81 is above the limit of 64"
    );
}

#[test]
fn what_is_no_polynomial_is_refused_with_its_place() {
    assert_eq!(
        refused(""),
        "0: the expression ends where a number or x, y, z was expected"
    );
    assert_eq!(
        refused("x +"),
        "3: the expression ends where a number or x, y, z was expected"
    );
    assert_eq!(refused("2x"), "1: expected an operator, found `x`");
    assert_eq!(refused("x y"), "2: expected an operator, found `y`");
    assert_eq!(refused("sin(x)"), "0: unknown name `sin`");
    assert_eq!(refused("(x"), "0: this `(` is never closed");
    assert_eq!(refused("x)"), "1: this `)` closes nothing");
    assert_eq!(
        refused("()"),
        "1: expected a number, x, y, z or `(`, found `)`"
    );
    assert_eq!(refused("1/x"), "1: only constants can divide a polynomial");
    assert_eq!(refused("x/(1-1)"), "1: division by zero");
    assert_eq!(
        refused("x^y"),
        "1: an exponent must be a whole number, zero or more"
    );
    assert_eq!(
        refused("x^0.5"),
        "1: an exponent must be a whole number, zero or more"
    );
    assert_eq!(
        refused("x^-1"),
        "1: an exponent must be a whole number, zero or more"
    );
    assert_eq!(
        refused("1e999*x"),
        "0: the coefficients become too large for a number"
    );
    assert_eq!(
        refused("1e300*x*1e300"),
        "7: the coefficients become too large for a number"
    );
    assert_eq!(
        refused("(-1)^0.5"),
        "4: an exponent must be a whole number, zero or more"
    );
    assert_eq!(refused("x = 1"), "2: expected an operator, found `=`");
}

#[test]
fn work_is_limited() {
    let dense = "(x+y+z+1)^32*(x+y+z+2)^32+".repeat(1000) + "1";
    assert!(refused(&dense).contains("takes too long"));
}

#[test]
fn a_hundred_thousand_parentheses_are_no_problem() {
    let n = 100_000;
    let nested = format!("{}x{}", "(".repeat(n), ")".repeat(n));
    assert_eq!(terms(&nested), vec![([1, 0, 0], 1.0)]);
    let signs = format!("{}x", "-".repeat(n));
    assert_eq!(terms(&signs), vec![([1, 0, 0], 1.0)]);
    let sums = format!("{}x{}", "(1+".repeat(n), ")".repeat(n));
    assert_eq!(terms(&sums), vec![([0; 3], 1e5), ([1, 0, 0], 1.0)]);
}

/// An expression tree and its value, computed by plain recursion.
#[derive(Clone, Debug)]
enum Tree {
    Number(i8),
    Variable(usize),
    Binary(char, Box<Tree>, Box<Tree>),
    Negative(Box<Tree>),
    Power(Box<Tree>, u8),
}

impl Tree {
    fn value(&self, at: [f64; 3]) -> f64 {
        match self {
            Self::Number(n) => f64::from(*n),
            Self::Variable(axis) => at[*axis],
            Self::Binary('+', a, b) => a.value(at) + b.value(at),
            Self::Binary('-', a, b) => a.value(at) - b.value(at),
            Self::Binary(_, a, b) => a.value(at) * b.value(at),
            Self::Negative(a) => -a.value(at),
            Self::Power(a, n) => a.value(at).powi(i32::from(*n)),
        }
    }

    fn write(&self, out: &mut String) {
        match self {
            Self::Number(n) => write!(out, "({n})").unwrap(),
            Self::Variable(axis) => out.push(['x', 'y', 'z'][*axis]),
            Self::Binary(mark, a, b) => {
                out.push('(');
                a.write(out);
                out.push(*mark);
                b.write(out);
                out.push(')');
            }
            Self::Negative(a) => {
                out.push_str("(-");
                a.write(out);
                out.push(')');
            }
            Self::Power(a, n) => {
                a.write(out);
                write!(out, "^{n}").unwrap();
            }
        }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![
        (-3i8..4).prop_map(Tree::Number),
        (0usize..3).prop_map(Tree::Variable)
    ];
    leaf.prop_recursive(4, 12, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            (prop::sample::select(vec!['+', '-', '*']), pair)
                .prop_map(|(mark, (a, b))| Tree::Binary(mark, a.into(), b.into())),
            inner.clone().prop_map(|a| Tree::Negative(a.into())),
            // A power of a power needs parentheses of its own.
            (inner, 0u8..3).prop_map(|(a, n)| Tree::Power(Tree::Negative(a.into()).into(), n)),
        ]
    })
}

proptest! {
    /// Values at small integers are integers below 2^53 nearly always, so equality is exact there.
    #[test]
    fn terms_have_the_value_of_the_expression(tree in tree(), at in prop::array::uniform3(-2i8..3)) {
        let mut text = String::new();
        tree.write(&mut text);
        let at = at.map(f64::from);
        let expected = tree.value(at);
        prop_assume!(expected.abs() < 1e12);
        let terms = parse(&text, 255, &mut WORK.clone()).unwrap();
        let value: f64 = terms.iter().map(|(e, c)| {
            c * (0..3).map(|axis| at[axis].powi(i32::from(e[axis]))).product::<f64>()
        }).sum();
        prop_assert!((value - expected).abs() <= 1e-9 * expected.abs().max(1.0), "{} is {} not {}", text, value, expected);
    }

    #[test]
    fn no_text_makes_it_panic(text in "[xyz0-9.e+*/^() a-]{0,30}") {
        let _ = parse(&text, 64, &mut WORK.clone());
    }
}
