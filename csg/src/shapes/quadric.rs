//! General quadratic half-spaces.

use crate::Polynomial;
use crate::error::Error;

/// All points where a quadratic form is not positive.
#[derive(Clone, PartialEq, Debug)]
pub struct Quadric {
    polynomial: Polynomial,
}

impl Quadric {
    /// `[x y z 1] M [x y z 1]ᵀ ≤ 0`; only the symmetric part of M counts.
    ///
    /// # Errors
    /// [`Error::NonFinite`].
    pub fn new(matrix: &[[f64; 4]; 4]) -> Result<Self, Error> {
        let polynomial = Polynomial::quadric(matrix)?;
        Ok(Self { polynomial })
    }

    /// The quadratic form, or one of lower degree if it hides one.
    #[must_use]
    pub fn polynomial(&self) -> &Polynomial {
        &self.polynomial
    }
}
