//! Interval arithmetic, rounded outward.

use csg::Ternary;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::ops::{Add, Mul, Neg, Sub};

/// All numbers from `low` to `high`.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Interval {
    pub low: f64,
    pub high: f64,
}

impl Interval {
    pub(super) fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// One number.
    pub(super) fn of(value: f64) -> Self {
        Self::new(value, value)
    }

    /// `Out` when all numbers are positive, `In` when all are negative; what is not a number is
    /// neither.
    pub(super) fn sign(self) -> Ternary {
        if self.low > 0.0 {
            Ternary::Out
        } else if self.high < 0.0 {
            Ternary::In
        } else {
            Ternary::Unknown
        }
    }

    pub(super) fn hull(self, other: Self) -> Self {
        Self::new(self.low.min(other.low), self.high.max(other.high))
    }

    /// Both hold the same range, so they overlap.
    pub(super) fn intersection(self, other: Self) -> Self {
        Self::new(self.low.max(other.low), self.high.min(other.high))
    }

    /// Widened by a few roundings: those of the functions of the system's library are below two.
    fn outward(self) -> Self {
        const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
        let widen = |x: f64| x.abs() * ROUNDINGS + f64::MIN_POSITIVE;
        Self::new(self.low - widen(self.low), self.high + widen(self.high))
    }

    pub(super) fn exp(self) -> Self {
        let Self { low, high } = Self::new(self.low.exp(), self.high.exp()).outward();
        Self::new(low.max(0.0), high)
    }

    /// Of what is not negative in it; 0 for the rest.
    pub(super) fn sqrt(self) -> Self {
        let roots = Self::new(self.low.max(0.0).sqrt(), self.high.max(0.0).sqrt());
        let Self { low, high } = roots.outward();
        Self::new(low.max(0.0), high)
    }

    pub(super) fn square(self) -> Self {
        let (a, b) = (self.low * self.low, self.high * self.high);
        let low = if self.low <= 0.0 && self.high >= 0.0 {
            0.0
        } else {
            a.min(b)
        };
        let Self { low, high } = Self::new(low, a.max(b)).outward();
        Self::new(low.max(0.0), high)
    }

    pub(super) fn cos(self) -> Self {
        (self + Self::of(FRAC_PI_2)).sin()
    }

    pub(super) fn sin(self) -> Self {
        let all = Self::new(-1.0, 1.0);
        // Beyond this a rounding of the argument is too large.
        if !(self.high - self.low < TAU && self.low.abs().max(self.high.abs()) < 1e6) {
            return all;
        }
        let (a, b) = (self.low.sin(), self.high.sin());
        let ends = Self::new(a.min(b) - 1e-9, a.max(b) + 1e-9);
        // Whether the interval holds a point `peak` + 2πk, up to the slack of the ends.
        let holds = |peak: f64| {
            let turns = ((self.low - 1e-9 - peak) / TAU).ceil();
            peak + turns * TAU <= self.high + 1e-9
        };
        let high = if holds(FRAC_PI_2) { 1.0 } else { ends.high };
        let low = if holds(FRAC_PI_2 + PI) {
            -1.0
        } else {
            ends.low
        };
        Self::new(low, high).intersection(all)
    }

    /// 1/x; everything where x may vanish.
    pub(super) fn reciprocal(self) -> Self {
        if self.low > 0.0 || self.high < 0.0 {
            Self::new(1.0 / self.high, 1.0 / self.low).outward()
        } else {
            Self::new(f64::NEG_INFINITY, f64::INFINITY)
        }
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self::new(-self.high, -self.low)
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.low + other.low, self.high + other.high).outward()
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let mut product = Self::new(f64::INFINITY, f64::NEG_INFINITY);
        for a in [self.low, self.high] {
            for b in [other.low, other.high] {
                // Zero times anything is zero, also times what has no bound.
                let value = if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
                product = product.hull(Self::of(value));
            }
        }
        product.outward()
    }
}
