//! Bytes that come back, text that comes back, and what the drawing shows.

use super::approximation::Face;
use super::colors::{self, Colors};
use super::display::{Display, Mode};
use super::projection::{self, Projection};
use super::solid::{self, MatrixForm};
use super::tree::{Operation, Operators, Tree, TreeNode};
use super::*;
use csg::{Literal, MaterialId, PrimitiveId, Sense};
use glam::DVec3;

/// Sphere ∪ torus, by hand: 1 00 is a leaf, 0 00 a union; 0x3f800000 is the float 1.
fn sphere_and_torus() -> Vec<u8> {
    let mut bytes = vec![0, 0];
    for (kind, extra) in [(1, None), (5, Some([0x3e, 0x80, 0, 0]))] {
        bytes.extend([1, 0, 0, 0, 3, 0, 0, 0, kind]);
        bytes.extend(extra.into_iter().flatten());
        for at in 0..16 {
            bytes.extend(if at % 5 == 0 {
                [0x3f, 0x80, 0, 0]
            } else {
                [0; 4]
            });
        }
    }
    bytes
}

#[test]
fn a_solid_comes_back_byte_for_byte() {
    let bytes = sphere_and_torus();
    let read = solid::read(&bytes, Operators::default(), MatrixForm::Rows).unwrap();
    assert_eq!(read.order, ByteOrder::Big);
    let mut again = Vec::new();
    solid::write(&read.value, Operators::default(), read.order, &mut again).unwrap();
    assert_eq!(again, bytes);
    let mut little = Vec::new();
    solid::write(
        &read.value,
        Operators::default(),
        ByteOrder::Little,
        &mut little,
    )
    .unwrap();
    let read_little = solid::read(&little, Operators::default(), MatrixForm::Rows).unwrap();
    assert_eq!(read_little.order, ByteOrder::Little);
    assert_eq!(read_little.value, read.value);
}

#[test]
fn every_cut_and_every_longer_file_is_refused() {
    let bytes = sphere_and_torus();
    let read = |bytes: &[u8]| solid::read(bytes, Operators::default(), MatrixForm::Rows);
    for length in 0..bytes.len() {
        let error = read(&bytes[..length]).unwrap_err();
        assert!(error.offset <= length, "{error}");
    }
    let longer = [bytes.as_slice(), &[0]].concat();
    let error = read(&longer).unwrap_err();
    assert_eq!(
        (error.offset, error.problem),
        (bytes.len(), Problem::Trailing { count: 1 })
    );
}

#[test]
fn operators_can_be_given_other_codes() {
    let mut bytes = sphere_and_torus();
    bytes[1] = 7;
    let read = |operators| solid::read(&bytes, operators, MatrixForm::Rows);
    let error = read(Operators::default()).unwrap_err();
    assert_eq!(error.offset, 1);
    let tree = read(Operators::new([3, 7, 9]).unwrap()).unwrap().value;
    assert_eq!(tree.nodes()[0], TreeNode::Operator(Operation::Intersection));
    assert_eq!(Operators::new([1, 2, 1]), None);
    assert_eq!(
        Operators::default().meaning(b'-'),
        Some(Operation::Difference)
    );
}

/// A \ (B \ C) = A ∩ (¬B ∪ C), for all eight combinations; and back through an n-ary formula.
#[test]
fn trees_and_formulas_mean_the_same() {
    let nodes = vec![
        TreeNode::Operator(Operation::Difference),
        TreeNode::Leaf(0),
        TreeNode::Operator(Operation::Difference),
        TreeNode::Leaf(1),
        TreeNode::Leaf(2),
    ];
    let tree = Tree::new(nodes).unwrap();
    let literal = |at: &u32| Literal {
        primitive: PrimitiveId(*at),
        sense: Sense::Inside,
        material: MaterialId(0),
    };
    let formula = tree.to_formula(literal);
    let value = |formula: &[csg::FormulaNode], inside: u32| {
        let of = |p: PrimitiveId| match inside >> p.0 & 1 {
            1 => csg::Ternary::In,
            _ => csg::Ternary::Out,
        };
        let scratch = &mut csg::LocalizeScratch::default();
        csg::localize(formula, of, &mut Vec::new(), scratch) == csg::Ternary::In
    };
    let binary = Tree::from_formula(
        &formula,
        |l| (l.primitive.0, l.sense),
        |_| (9, Sense::Inside),
    );
    let again = binary.to_formula(|(at, sense)| Literal {
        sense: *sense,
        ..literal(at)
    });
    for inside in 0..8 {
        let [a, b, c] = [0, 1, 2].map(|at| inside >> at & 1 == 1);
        assert_eq!(value(&formula, inside), a && (!b || c));
        assert_eq!(value(&again, inside), a && (!b || c));
    }
    assert!(Tree::new(vec![TreeNode::Leaf(0), TreeNode::Leaf(1)]).is_none());
    assert!(Tree::<u32>::new(vec![TreeNode::Operator(Operation::Union)]).is_none());
}

/// The stream has no count: its numbers tell the order.
#[test]
fn triangles_come_back_in_both_orders() {
    let face = Face {
        material: 255,
        corners: [[0.0, 1.0, 0.1], [-2.0, 3.5, 1e-9], [7.0, 0.0, 1e9]],
    };
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let mut bytes = Vec::new();
        approximation::write([face, face], order, &mut bytes).unwrap();
        assert_eq!(bytes.len(), 1 + 2 * 76);
        let read = approximation::read(&bytes).unwrap();
        assert_eq!((read.order, read.value), (order, vec![face, face]));
    }
}

#[test]
fn text_files_come_back_and_complain_with_a_line() {
    let text = "1 2 3\n0 1 0\n10\n-1 -2 3 4\n";
    let system = projection::read(text).unwrap();
    assert_eq!(projection::write(&system), text);
    let error = projection::read("1 2 3\n0 0 0\n10\n-1 -2 3 4").unwrap_err();
    assert!(error.to_string().starts_with("byte 6: line 2: "), "{error}");
    assert!(projection::read("1 2 3").is_err());
    assert!(projection::read("1 2 3\n0 1 0\n-1\n-1 -2 3 4").is_err());

    let table = colors::read("0 9 9 9\n3 1 2 3\n999 4 5 6\n").unwrap();
    assert_eq!(table.background(), [9; 3]);
    assert_eq!(
        [table.of(3), table.of(4), table.of(255)],
        [[1, 2, 3], [255; 3], [4, 5, 6]]
    );
    assert_eq!(colors::read(&colors::write(&table)), Ok(table));
    let error = colors::read("0 0 0 0\n1 2 300 4").unwrap_err();
    assert!(
        error.to_string().starts_with("byte 12: line 2: "),
        "{error}"
    );
    // Without a table materials are told apart, and seen on the background.
    let usual = Colors::default();
    assert_eq!((usual.background(), usual.of(1)), ([0; 3], [255; 3]));
    for material in 2..256 {
        let color = usual.of(material);
        assert!(color.iter().any(|c| *c > 150), "{material}: {color:?}");
        assert!((1..material).all(|other| usual.of(other) != color));
    }
}

/// Two squares across the line of sight, the smaller one in front; the eye is 10 away from the
/// plane y = 0 and the window 8 wide, so a pixel of an 80 × 80 picture is 0.1 wide there.
#[test]
fn the_nearest_surface_is_seen_where_projection_puts_it() {
    let square = |y: f64, half: f64, material| {
        let corner = |x: f64, z: f64| [x * half, y, z * half];
        let [a, b, c, d] = [
            corner(-1., -1.),
            corner(1., -1.),
            corner(1., 1.),
            corner(-1., 1.),
        ];
        [[a, b, c], [a, c, d]].map(|corners| Face { material, corners })
    };
    let system = Projection {
        reference: DVec3::ZERO,
        direction: DVec3::Y,
        distance: 10.0,
        window: [-4.0, -4.0, 4.0, 4.0],
    };
    let table = colors::read("0 0 0 0\n1 10 0 0\n2 20 0 0").unwrap();
    let mut display = Display::new(80, 80, &system, &table).unwrap();
    // At y = −5 the half side 1 looks like 2; behind, at y = 10, 6 looks like 3.
    display.draw(&square(-5.0, 1.0, 1), Mode::Flat, &table);
    display.draw(&square(10.0, 6.0, 2), Mode::Flat, &table);
    let row: Vec<u8> = (0..80).map(|x| display.pixel(x, 40).unwrap()[0]).collect();
    let expected: Vec<u8> = (0..80_i32)
        .map(|x| match (2 * x - 79).abs() {
            0..40 => 10,
            40..60 => 20,
            _ => 0,
        })
        .collect();
    assert_eq!(row, expected);
    // The axes begin behind the first square, whose middle hides them; beside it they are seen.
    let mut axes = display.clone();
    axes.draw_axes(3.9);
    assert_eq!(axes.pixel(45, 40), display.pixel(45, 40));
    assert_ne!(axes.pixel(65, 40), display.pixel(65, 40));
    // A triangle through the eye's plane is cut, not turned around.
    let behind = [[-1.0, -30.0, 0.0], [1.0, -30.0, 0.0], [0.0, -20.0, 1.0]];
    let before = display.clone();
    let face = Face {
        material: 2,
        corners: behind,
    };
    display.draw(&[face], Mode::Wireframe, &table);
    display.draw(&[face], Mode::Flat, &table);
    let same = (0..80).all(|x| display.pixel(x, 30) == before.pixel(x, 30));
    assert!(same);
}
