//! What can be wrong with a shape, a transform, a polynomial or a model.

/// Why something could not be built.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number is infinite or not a number, or became so by overflow.
    #[error("{what} must be finite")]
    NonFinite {
        /// What the number stands for.
        what: &'static str,
    },
    /// A size is zero or negative.
    #[error("{what} must be positive, found {value}")]
    NotPositive {
        /// What the number stands for.
        what: &'static str,
        /// The number given.
        value: f64,
    },
    /// A size is negative.
    #[error("{what} must not be negative, found {value}")]
    Negative {
        /// What the number stands for.
        what: &'static str,
        /// The number given.
        value: f64,
    },
    /// An interval's lower end is not below its upper end.
    #[error("{what} must begin below its end, found {low} to {high}")]
    EmptyInterval {
        /// What the interval stands for.
        what: &'static str,
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// A vector that gives a direction is zero.
    #[error("{what} must not be the zero vector")]
    ZeroVector {
        /// What the vector stands for.
        what: &'static str,
    },
    /// A polynomial's degree is above [`MAX_DEGREE`](crate::MAX_DEGREE).
    #[error("degree {degree} is above the limit of {}", crate::MAX_DEGREE)]
    DegreeTooHigh {
        /// The degree asked for.
        degree: usize,
    },
    /// A polynomial has the wrong number of coefficients.
    #[error("a polynomial of degree {degree} has {expected} coefficients, found {found}")]
    CoefficientCount {
        /// Its degree.
        degree: usize,
        /// Number of coefficients that this degree needs.
        expected: usize,
        /// Number of coefficients given.
        found: usize,
    },
    /// A matrix has no inverse, or none that floating point can tell from infinity.
    #[error("the transform is singular")]
    SingularTransform,
    /// A prism has fewer than three sides.
    #[error("a prism needs at least 3 sides, found {sides}")]
    TooFewSides {
        /// The number given.
        sides: u32,
    },
    /// A face of a polyhedron names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {vertices} vertices")]
    MissingVertex {
        /// Index of the face.
        face: usize,
        /// The vertex that it names.
        vertex: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A face of a polyhedron has no area, so no plane.
    #[error("face {face} has no area")]
    FlatFace {
        /// Index of the face.
        face: usize,
    },
    /// A polyhedron has a vertex beyond the plane of a face.
    #[error("the polyhedron is not convex: vertex {vertex} lies beyond face {face}")]
    NotConvex {
        /// Index of the face.
        face: usize,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A polyhedron's faces do not enclose a volume.
    #[error("the faces of the polyhedron are not closed")]
    OpenPolyhedron,
    /// A node refers to itself, to a later node or to a node of another model.
    #[error("node {node} refers to node {child}, which does not stand before it")]
    MisplacedNode {
        /// Index of the node; the number of nodes when the root itself is meant.
        node: usize,
        /// Index that it refers to.
        child: usize,
    },
    /// A node has a material that the model does not list.
    #[error("node {node} has material {material}, which the model does not list")]
    UnknownMaterial {
        /// Index of the node.
        node: usize,
        /// The material's index.
        material: u32,
    },
    /// The expanded model is too large.
    #[error("the model expands to {found} {what}, more than the limit of {limit}")]
    TooManyLiterals {
        /// What was counted: half-spaces, or nodes on the way to them.
        what: &'static str,
        /// How many there are (`u64::MAX`: that many or more).
        found: u64,
        /// The most that is allowed.
        limit: u64,
    },
    /// The clip box is empty, flat or infinite.
    #[error("the clip box must be finite and have a volume")]
    BadClipBox,
    /// The solid is unbounded, or could not be proved bounded, and no clip box was given.
    #[error("the solid could not be proved bounded (clip it with --box)")]
    Unbounded,
    /// A polynomial's coefficients are so much larger than its values that nothing is left of them.
    #[error(
        "a polynomial of degree {degree} has lost all digits: its coefficients are rounded by {uncertainty:.0e} of its values (write it about the part's middle, as products, or with a lower degree)"
    )]
    NoDigitsLeft {
        /// Its degree.
        degree: usize,
        /// Bound on the error of its values relative to their usual size.
        uncertainty: f64,
    },
    /// The solid is so small or so far away that its numbers cannot tell its points apart.
    #[error("the solid's extent is too large or too small for floating point")]
    ExtentOutOfRange,
}

/// `value` if it is finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64, Error> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(Error::NonFinite { what })
    }
}

/// `value` if it is finite and above zero.
pub(crate) fn positive(what: &'static str, value: f64) -> Result<f64, Error> {
    if finite(what, value)? > 0.0 {
        Ok(value)
    } else {
        Err(Error::NotPositive { what, value })
    }
}

/// `value` if it is finite and not below zero.
pub(crate) fn not_negative(what: &'static str, value: f64) -> Result<f64, Error> {
    if finite(what, value)? >= 0.0 {
        Ok(value)
    } else {
        Err(Error::Negative { what, value })
    }
}

/// The interval if its ends are finite and it has a length.
pub(crate) fn interval(what: &'static str, low: f64, high: f64) -> Result<(f64, f64), Error> {
    finite(what, low)?;
    finite(what, high)?;
    if low < high && (high - low).is_finite() {
        Ok((low, high))
    } else {
        Err(Error::EmptyInterval { what, low, high })
    }
}
