//! Expressions in x, y and z, as lists of operations: no recursion, however long they are.

use super::interval::Interval;
use glam::DVec3;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// A function of a point, in model units.
#[derive(Clone, PartialEq, Debug)]
pub struct Expression {
    /// In reverse Polish order.
    operations: Vec<Operation>,
}

#[derive(Clone, Copy, PartialEq, Debug)]
enum Operation {
    Number(f64),
    Variable(usize),
    Add,
    Multiply,
    Negate,
    Reciprocal,
    Square,
    SquareRoot,
    Sine,
    Cosine,
    Exponential,
}

/// Work space.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    numbers: Vec<f64>,
    ranges: Vec<Interval>,
    slopes: Vec<(Interval, [Interval; 3])>,
}

impl From<f64> for Expression {
    fn from(number: f64) -> Self {
        Self {
            operations: vec![Operation::Number(number)],
        }
    }
}

impl Expression {
    /// x, y and z.
    #[must_use]
    pub fn variables() -> [Self; 3] {
        [0, 1, 2].map(|axis| Self {
            operations: vec![Operation::Variable(axis)],
        })
    }

    /// How many operations it takes, numbers and variables included.
    #[must_use]
    pub fn operation_count(&self) -> usize {
        self.operations.len()
    }

    fn then(mut self, operation: Operation) -> Self {
        self.operations.push(operation);
        self
    }

    fn with(mut self, other: Self, operation: Operation) -> Self {
        self.operations.extend(other.operations);
        self.then(operation)
    }

    /// Its square.
    #[must_use]
    pub fn square(self) -> Self {
        self.then(Operation::Square)
    }

    /// Its square root; 0 where it is negative.
    #[must_use]
    pub fn sqrt(self) -> Self {
        self.then(Operation::SquareRoot)
    }

    /// Its sine.
    #[must_use]
    pub fn sin(self) -> Self {
        self.then(Operation::Sine)
    }

    /// Its cosine.
    #[must_use]
    pub fn cos(self) -> Self {
        self.then(Operation::Cosine)
    }

    /// e to its power.
    #[must_use]
    pub fn exp(self) -> Self {
        self.then(Operation::Exponential)
    }

    /// Value at a point.
    pub(super) fn value(&self, at: DVec3, scratch: &mut Scratch) -> f64 {
        let stack = &mut scratch.numbers;
        stack.clear();
        for operation in &self.operations {
            let last = match operation {
                Operation::Number(number) => *number,
                Operation::Variable(axis) => at[*axis],
                Operation::Add => pop(stack, 0.0) + pop(stack, 0.0),
                Operation::Multiply => pop(stack, 0.0) * pop(stack, 0.0),
                Operation::Negate => -pop(stack, 0.0),
                Operation::Reciprocal => 1.0 / pop(stack, 0.0),
                Operation::Square => pop(stack, 0.0).powi(2),
                Operation::SquareRoot => pop(stack, 0.0).max(0.0).sqrt(),
                Operation::Sine => pop(stack, 0.0).sin(),
                Operation::Cosine => pop(stack, 0.0).cos(),
                Operation::Exponential => pop(stack, 0.0).exp(),
            };
            stack.push(last);
        }
        pop(stack, 0.0)
    }

    /// All values in a box, and perhaps more.
    pub(super) fn range(&self, cell: [Interval; 3], scratch: &mut Scratch) -> Interval {
        let zero = Interval::of(0.0);
        let stack = &mut scratch.ranges;
        stack.clear();
        for operation in &self.operations {
            let last = match operation {
                Operation::Number(number) => Interval::of(*number),
                Operation::Variable(axis) => cell[*axis],
                Operation::Add => pop(stack, zero) + pop(stack, zero),
                Operation::Multiply => pop(stack, zero) * pop(stack, zero),
                _ => unary(*operation, pop(stack, zero)),
            };
            stack.push(last);
        }
        pop(stack, zero)
    }

    /// The same with the derivatives by x, y and z.
    pub(super) fn range_and_gradient(
        &self,
        cell: [Interval; 3],
        scratch: &mut Scratch,
    ) -> (Interval, [Interval; 3]) {
        let zero = (Interval::of(0.0), [Interval::of(0.0); 3]);
        let stack = &mut scratch.slopes;
        stack.clear();
        for operation in &self.operations {
            let last = match operation {
                Operation::Number(number) => (Interval::of(*number), zero.1),
                Operation::Variable(axis) => {
                    let mut gradient = zero.1;
                    gradient[*axis] = Interval::of(1.0);
                    (cell[*axis], gradient)
                }
                Operation::Add => {
                    let ((a, da), (b, db)) = (pop(stack, zero), pop(stack, zero));
                    (a + b, [0, 1, 2].map(|axis| da[axis] + db[axis]))
                }
                Operation::Multiply => {
                    let ((a, da), (b, db)) = (pop(stack, zero), pop(stack, zero));
                    (a * b, [0, 1, 2].map(|axis| da[axis] * b + a * db[axis]))
                }
                _ => {
                    let (inner, gradient) = pop(stack, zero);
                    let slope = derivative(*operation, inner);
                    (unary(*operation, inner), gradient.map(|g| slope * g))
                }
            };
            stack.push(last);
        }
        pop(stack, zero)
    }
}

/// The last element; operators always find theirs.
fn pop<T>(stack: &mut Vec<T>, missing: T) -> T {
    stack.pop().unwrap_or(missing)
}

fn unary(operation: Operation, inner: Interval) -> Interval {
    match operation {
        Operation::Negate => -inner,
        Operation::Reciprocal => inner.reciprocal(),
        Operation::Square => inner.square(),
        Operation::SquareRoot => inner.sqrt(),
        Operation::Sine => inner.sin(),
        Operation::Cosine => inner.cos(),
        Operation::Exponential => inner.exp(),
        Operation::Number(_) | Operation::Variable(_) | Operation::Add | Operation::Multiply => {
            inner
        }
    }
}

/// Of an operation by its operand.
fn derivative(operation: Operation, inner: Interval) -> Interval {
    match operation {
        Operation::Negate => Interval::of(-1.0),
        Operation::Reciprocal => -inner.square().reciprocal(),
        Operation::Square => Interval::of(2.0) * inner,
        // Where the operand may be negative, the slope has no bound.
        Operation::SquareRoot => (Interval::of(2.0) * inner.sqrt()).reciprocal(),
        Operation::Sine => inner.cos(),
        Operation::Cosine => -inner.sin(),
        Operation::Exponential => inner.exp(),
        Operation::Number(_) | Operation::Variable(_) | Operation::Add | Operation::Multiply => {
            Interval::of(1.0)
        }
    }
}

impl Add for Expression {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        self.with(other, Operation::Add)
    }
}

impl Sub for Expression {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Expression {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.with(other, Operation::Multiply)
    }
}

impl Div for Expression {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        self.with(other.then(Operation::Reciprocal), Operation::Multiply)
    }
}

impl Neg for Expression {
    type Output = Self;
    fn neg(self) -> Self {
        self.then(Operation::Negate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Each operation at least once.
    fn wild() -> Expression {
        let [x, y, z] = Expression::variables();
        let wave = (Expression::from(3.0) * x.clone()).sin() * y.clone().cos();
        let blob = (-(x.square() + z.clone().square())).exp();
        let distance = (y.square() + z.clone()).sqrt();
        wave / (Expression::from(1.5) + z.square()) - blob * distance
    }

    proptest! {
        /// Values at points, and differences of values, lie in the ranges.
        #[test]
        fn ranges_hold_all_values(
            corner in proptest::array::uniform3(-3.0..3.0f64),
            size in proptest::array::uniform3(0.0..2.0f64),
            parts in proptest::collection::vec(proptest::array::uniform3(0.0..=1.0f64), 12),
        ) {
            let scratch = &mut Scratch::default();
            let cell = [0, 1, 2].map(|a| Interval::new(corner[a], corner[a] + size[a]));
            let (range, gradient) = wild().range_and_gradient(cell, scratch);
            let simple = wild().range(cell, scratch);
            prop_assert_eq!(range, simple);
            let mut last: Option<(DVec3, f64)> = None;
            for part in parts {
                let at = DVec3::from_array([0, 1, 2].map(|a| corner[a] + part[a] * size[a]));
                let value = wild().value(at, scratch);
                prop_assert!(range.low <= value && value <= range.high);
                if let Some((before, its)) = last {
                    let step = at - before;
                    let change = [0, 1, 2].map(|a| gradient[a] * Interval::of(step[a]));
                    let change = change[0] + change[1] + change[2];
                    let slack = 1e-12;
                    prop_assert!(change.low - slack <= value - its);
                    prop_assert!(value - its <= change.high + slack);
                }
                last = Some((at, value));
            }
        }
    }
}
