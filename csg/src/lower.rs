//! From a model to half-spaces: every shape's polynomials are brought to one common frame.
//!
//! The matrices from the frame to the shape are multiplied first and the polynomial is
//! substituted once, so a model far from the origin loses no digits to large intermediate
//! coefficients.

use crate::matrix::Bounded;
use crate::survey::Survey;
use crate::walk::{Leaf, Visitor, walk};
use crate::{Error, MaterialId, Model, Polynomial, Sense, Shape, Transform};

/// A part of a formula in prefix order, operators closed explicitly.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Token {
    /// An operator begins.
    Open { union: bool },
    /// The innermost operator ends.
    Close,
    /// One side of a half-space's boundary.
    Half {
        half: usize,
        sense: Sense,
        material: MaterialId,
    },
    /// All of space, or nothing.
    Constant { all: bool },
}

/// A polynomial in the frame's coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Half {
    pub(crate) polynomial: Polynomial,
    /// Bound on the sum of the coefficients' absolute errors.
    pub(crate) error: f64,
}

/// Where points with w ≤ 0 before the map to a shape's coordinates may lie.
///
/// A projective map takes them to finite points whose homogeneous coordinates have the wrong
/// sign, which polynomials of odd degree notice.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Region {
    /// The frame is used for the cube [−1, 1]³ only.
    Cube,
    /// The frame is used for all of space.
    Everywhere,
}

/// Half-spaces, and a formula over them that is not simplified.
#[derive(Debug)]
pub(crate) struct Lowered {
    pub(crate) tokens: Vec<Token>,
    pub(crate) halves: Vec<Half>,
    region: Region,
}

impl Lowered {
    pub(crate) fn new(region: Region) -> Self {
        Self {
            tokens: Vec::new(),
            halves: Vec::new(),
            region,
        }
    }

    /// Lowers a whole model, whose root must not be constant.
    ///
    /// `frame`: from the frame's coordinates to the model's, for row vectors.
    pub(crate) fn of(
        model: &Model,
        survey: &Survey,
        frame: &Bounded,
        region: Region,
    ) -> Result<Self, Error> {
        let mut lowered = Self::new(region);
        walk(model, survey, *frame, &mut lowered)?;
        Ok(lowered)
    }

    /// Appends a shape or its complement; `to_shape`: from the frame to the shape.
    pub(crate) fn add_shape(
        &mut self,
        shape: &Shape,
        complemented: bool,
        to_shape: &Bounded,
        material: MaterialId,
    ) -> Result<(), Error> {
        let union = !complemented;
        self.tokens.push(Token::Open { union });
        for clause in shape.half_spaces()? {
            self.tokens.push(Token::Open { union: !union });
            for polynomial in clause {
                let sense = if complemented {
                    Sense::Outside
                } else {
                    Sense::Inside
                };
                self.add_half_space(&polynomial, sense, to_shape, material)?;
            }
            self.tokens.push(Token::Close);
        }
        self.tokens.push(Token::Close);
        Ok(())
    }

    /// Appends one half-space, given in the shape's coordinates.
    fn add_half_space(
        &mut self,
        polynomial: &Polynomial,
        sense: Sense,
        to_shape: &Bounded,
        material: MaterialId,
    ) -> Result<(), Error> {
        let half = Half {
            error: polynomial.substitution_error(&to_shape.rows, &to_shape.error),
            polynomial: polynomial.substituted(&to_shape.rows)?,
        };
        let odd = polynomial.degree() % 2 == 1;
        let w = to_shape.rows.map(|row| row[3]);
        match self.signs_of_w(w) {
            (true, true) if odd => {
                // (p ∩ w > 0) ∪ (¬p ∩ w < 0), and its complement likewise.
                let positive = Half {
                    polynomial: Polynomial::new(1, w.map(|c| -c).to_vec())?.without_w_factors(),
                    error: (0..4).fold(0.0, |sum, i| {
                        sum + to_shape.error[i][3] + f64::EPSILON * w[i].abs()
                    }),
                };
                self.tokens.push(Token::Open { union: true });
                for (sense, side) in [(sense, Sense::Inside), (sense.complement(), Sense::Outside)]
                {
                    self.tokens.push(Token::Open { union: false });
                    self.push(half.clone(), sense, material);
                    self.push(positive.clone(), side, material);
                    self.tokens.push(Token::Close);
                }
                self.tokens.push(Token::Close);
            }
            (false, true) if odd => self.push(half, sense.complement(), material),
            _ => self.push(half, sense, material),
        }
        Ok(())
    }

    /// Appends a literal, or a constant if its polynomial is one.
    pub(crate) fn push(&mut self, half: Half, sense: Sense, material: MaterialId) {
        let polynomial = half.polynomial.without_w_factors();
        if polynomial.degree() == 0 {
            let inside = polynomial.coefficients()[0] <= 0.0;
            let all = inside == (sense == Sense::Inside);
            self.tokens.push(Token::Constant { all });
            return;
        }
        self.tokens.push(Token::Half {
            half: self.halves.len(),
            sense,
            material,
        });
        self.halves.push(Half { polynomial, ..half });
    }

    /// Whether w may be positive and negative in the region.
    fn signs_of_w(&self, [x, y, z, one]: [f64; 4]) -> (bool, bool) {
        match self.region {
            Region::Cube => {
                let turn = x.abs() + y.abs() + z.abs();
                (one + turn > 0.0, one - turn < 0.0)
            }
            Region::Everywhere => {
                let varies = x != 0.0 || y != 0.0 || z != 0.0;
                (varies || one > 0.0, varies || one < 0.0)
            }
        }
    }
}

impl<'a> Visitor<'a> for Lowered {
    type Placement = Bounded;

    fn place(&mut self, at: &Bounded, transform: &Transform) -> Result<Bounded, Error> {
        let inner = at.then(transform.bounded_inverse());
        inner.finite()
    }

    fn open(&mut self, union: bool) {
        self.tokens.push(Token::Open { union });
    }

    fn close(&mut self) -> Result<(), Error> {
        self.tokens.push(Token::Close);
        Ok(())
    }

    fn shape(&mut self, leaf: &Leaf<'a, '_, Bounded>) -> Result<(), Error> {
        self.add_shape(leaf.shape, leaf.complemented, leaf.at, leaf.material)
    }
}
