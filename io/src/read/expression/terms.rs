//! Sums of monomials in x, y, z, and arithmetic on them within limits.

use csg::Axis;
use std::collections::BTreeMap;

/// Exponents of x, y and z.
pub(crate) type Exponents = [u8; 3];

/// A polynomial as a sparse sum of monomials, without zero coefficients.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct Terms(BTreeMap<Exponents, f64>);

/// Why an operation is refused.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) enum Refusal {
    /// The result would have this degree.
    Degree(u64),
    NotFinite,
    DivisorNotConstant,
    DivisionByZero,
    Exponent,
    Work,
}

/// What an expression may cost.
pub(super) struct Limits<'a> {
    pub(super) max_degree: u8,
    work_left: &'a mut u64,
}

impl<'a> Limits<'a> {
    pub(super) fn new(max_degree: u8, work_left: &'a mut u64) -> Self {
        Self {
            max_degree,
            work_left,
        }
    }

    fn spend(&mut self, operations: usize) -> Result<(), Refusal> {
        let left = self.work_left.checked_sub(operations as u64);
        *self.work_left = left.unwrap_or(0);
        left.map(|_| ()).ok_or(Refusal::Work)
    }

    fn check_degree(&self, degree: u64) -> Result<u8, Refusal> {
        u8::try_from(degree)
            .ok()
            .filter(|d| *d <= self.max_degree)
            .ok_or(Refusal::Degree(degree))
    }
}

impl Terms {
    pub(crate) fn constant(value: f64) -> Self {
        Self::monomial([0; 3], value)
    }

    /// x, y or z.
    pub(crate) fn variable(axis: Axis) -> Self {
        let exponents = match axis {
            Axis::X => [1, 0, 0],
            Axis::Y => [0, 1, 0],
            Axis::Z => [0, 0, 1],
        };
        Self::monomial(exponents, 1.0)
    }

    fn monomial(exponents: Exponents, value: f64) -> Self {
        Self(BTreeMap::from_iter(
            (value != 0.0).then_some((exponents, value)),
        ))
    }

    /// The monomials with their coefficients, none of them zero, by ascending exponents.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Exponents, f64)> {
        self.0.iter().map(|(e, c)| (*e, *c))
    }

    /// The largest sum of exponents; 0 for a constant, zero included.
    pub(crate) fn degree(&self) -> u8 {
        self.0.keys().map(|[i, j, k]| i + j + k).max().unwrap_or(0)
    }

    /// The value, if there are no variables.
    pub(crate) fn as_constant(&self) -> Option<f64> {
        match self.0.len() {
            0 => Some(0.0),
            1 => self.0.get(&[0; 3]).copied(),
            _ => None,
        }
    }

    /// `self + sign·other`; costs no more than the shorter of the two.
    pub(super) fn plus(
        self,
        other: Self,
        sign: f64,
        limits: &mut Limits<'_>,
    ) -> Result<Self, Refusal> {
        let (mut long, long_sign, short, short_sign) = if self.0.len() >= other.0.len() {
            (self, 1.0, other, sign)
        } else {
            (other, sign, self, 1.0)
        };
        if long_sign < 0.0 {
            long = long.scaled(-1.0, limits)?;
        }
        limits.spend(16 * short.0.len())?;
        for (exponents, value) in short.0 {
            let sum = long.0.entry(exponents).or_insert(0.0);
            *sum += short_sign * value;
            if *sum == 0.0 {
                long.0.remove(&exponents);
            } else if !sum.is_finite() {
                return Err(Refusal::NotFinite);
            }
        }
        Ok(long)
    }

    pub(super) fn scaled(mut self, factor: f64, limits: &mut Limits<'_>) -> Result<Self, Refusal> {
        limits.spend(self.0.len())?;
        for value in self.0.values_mut() {
            *value *= factor;
        }
        self.cleaned()
    }

    pub(super) fn over(mut self, divisor: &Self, limits: &mut Limits<'_>) -> Result<Self, Refusal> {
        let divisor = divisor.as_constant().ok_or(Refusal::DivisorNotConstant)?;
        if divisor == 0.0 {
            return Err(Refusal::DivisionByZero);
        }
        limits.spend(self.0.len())?;
        for value in self.0.values_mut() {
            *value /= divisor;
        }
        self.cleaned()
    }

    pub(super) fn times(&self, other: &Self, limits: &mut Limits<'_>) -> Result<Self, Refusal> {
        let degree = limits.check_degree(u64::from(self.degree()) + u64::from(other.degree()))?;
        let (long, short) = if self.0.len() >= other.0.len() {
            (self, other)
        } else {
            (other, self)
        };
        if short.0.len() <= 1 {
            limits.spend(16 * long.0.len())?;
            let products = short.0.iter().flat_map(|(a, p)| {
                long.0
                    .iter()
                    .map(move |(b, q)| ([a[0] + b[0], a[1] + b[1], a[2] + b[2]], p * q))
            });
            return Self(products.collect()).cleaned();
        }
        // Dense sums: a map would make products of long factors 20 times slower.
        let dense = Dense {
            side: usize::from(degree) + 1,
        };
        limits.spend(short.0.len() * long.0.len() + dense.len())?;
        let mut sums = vec![0.0; dense.len()];
        for (a, p) in &short.0 {
            let (_, shifted) = sums.split_at_mut(dense.at(*a));
            for (b, q) in &long.0 {
                if let Some(sum) = shifted.get_mut(dense.at(*b)) {
                    *sum += p * q;
                }
            }
        }
        let terms = sums.into_iter().enumerate();
        Self(
            terms
                .filter(|(_, c)| *c != 0.0)
                .map(|(at, c)| (dense.exponents(at), c))
                .collect(),
        )
        .cleaned()
    }

    pub(super) fn to_the(&self, exponent: &Self, limits: &mut Limits<'_>) -> Result<Self, Refusal> {
        let exponent = exponent.as_constant().ok_or(Refusal::Exponent)?;
        if let Some(base) = self.as_constant() {
            let power = base.powf(exponent);
            return if power.is_nan() {
                Err(Refusal::Exponent)
            } else {
                Self::constant(power).cleaned()
            };
        }
        if !(exponent >= 0.0 && exponent.fract() == 0.0) {
            return Err(Refusal::Exponent);
        }
        let degree = f64::from(self.degree()) * exponent;
        // Saturates; whatever is that large is refused.
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative; saturation is wanted"
        )]
        let (degree, mut left) = (degree as u64, exponent as u64);
        limits.check_degree(degree)?;
        let (mut result, mut square) = (Self::constant(1.0), self.clone());
        while left > 0 {
            if left % 2 == 1 {
                result = result.times(&square, limits)?;
            }
            left /= 2;
            if left > 0 {
                square = square.times(&square, limits)?;
            }
        }
        Ok(result)
    }

    /// Without zeros; an error if a coefficient is not finite.
    fn cleaned(mut self) -> Result<Self, Refusal> {
        if self.0.values().any(|value| !value.is_finite()) {
            return Err(Refusal::NotFinite);
        }
        self.0.retain(|_, value| *value != 0.0);
        Ok(self)
    }
}

/// Positions of monomials in a cube of exponents.
#[derive(Clone, Copy)]
struct Dense {
    side: usize,
}

impl Dense {
    fn len(self) -> usize {
        self.side.pow(3)
    }

    /// Additive: the position of a product is the sum of its factors' positions.
    fn at(self, [i, j, k]: Exponents) -> usize {
        (usize::from(i) * self.side + usize::from(j)) * self.side + usize::from(k)
    }

    fn exponents(self, at: usize) -> Exponents {
        [
            at / self.side / self.side,
            at / self.side % self.side,
            at % self.side,
        ]
        .map(|e| u8::try_from(e).unwrap_or(u8::MAX))
    }
}
