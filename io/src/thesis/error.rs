//! What can be wrong in a file of the thesis, and where.

/// A file that cannot be read.
///
/// Displays as `byte 12: unknown type 42 of primitive (known: 0 to 7)`. Where numbers make more
/// sense little-endian, it says that they were read so.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[error("byte {offset}: {problem}{}", if *.little_endian { " (numbers read little-endian, which makes more sense of them)" } else { "" })]
pub struct Error {
    /// Where in the file, from 0.
    pub offset: usize,
    /// What is wrong there.
    pub problem: Problem,
    /// Whether numbers were read little-endian.
    pub little_endian: bool,
}

/// What is wrong at a place in a file.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// The file ends too early.
    #[error("the file ends, but {what} takes {needed} more bytes (is it complete?)")]
    Truncated {
        /// What was to be read.
        what: &'static str,
        /// Bytes that are missing at least.
        needed: usize,
    },
    /// Bytes are left after the end.
    #[error("{count} bytes are left after the end of the data (wrong format, or byte order?)")]
    Trailing {
        /// How many.
        count: usize,
    },
    /// A count that cannot be.
    #[error("{count} {what} cannot be: the {left} bytes that are left hold {most} at most")]
    Count {
        /// What was counted.
        what: &'static str,
        /// The number in the file.
        count: i32,
        /// Bytes that are left.
        left: usize,
        /// How many fit into them.
        most: usize,
    },
    /// A number that is infinite or no number.
    #[error("{what} is {value}, it must be finite")]
    NotFinite {
        /// What the number stands for.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// A code that the format does not know.
    #[error("unknown type {code} of {what} (known: {known})")]
    Code {
        /// What the code stands for.
        what: &'static str,
        /// The code in the file.
        code: i32,
        /// What is known.
        known: &'static str,
    },
    /// A Boolean operator that the dialect does not know.
    #[error(
        "unknown operator code {code} (known: {known}; other codes: --operators UNION,INTERSECTION,DIFFERENCE)"
    )]
    Operator {
        /// The code in the file.
        code: u8,
        /// The codes of union, intersection and difference.
        known: String,
    },
    /// A degree that is negative or too high.
    #[error("degree {degree} is not between 0 and {highest}")]
    Degree {
        /// The number in the file.
        degree: i32,
        /// The highest degree.
        highest: usize,
    },
    /// A file of another kind.
    #[error("expected the letter {expected:?} of {what}, found byte {found:#04x}")]
    Mark {
        /// The letter.
        expected: char,
        /// What begins with it.
        what: &'static str,
        /// What stands there.
        found: u8,
    },
    /// A tree names a primitive that a sector does not list, or a sector lists one twice.
    #[error("primitive {name} of the tree must be listed once in each sector, found {times} times")]
    Name {
        /// The primitive's name.
        name: i32,
        /// How often the sector lists it.
        times: usize,
    },
    /// A sector or a vertex index that makes no sense.
    #[error("vertex {index} does not exist, there are {count}")]
    Vertex {
        /// The index in the file.
        index: i32,
        /// Number of vertices.
        count: usize,
    },
    /// A primitive that is one polynomial here and another one there.
    #[error(
        "primitive {name} is another polynomial in sector {sector} than in the first one: subdivide it with csg2brep thesis subsimpl"
    )]
    Pieces {
        /// The primitive's name.
        name: i32,
        /// The sector's number, from 1.
        sector: usize,
    },
    /// A simplex without volume.
    #[error("the simplex has no volume")]
    FlatSimplex,
    /// A shape that cannot be.
    #[error("{0}")]
    Shape(#[from] csg::Error),
    /// A text file that has something else than a number.
    #[error("line {line}: expected {expected}, found {found:?}")]
    Text {
        /// The line, from 1.
        line: usize,
        /// What should be there.
        expected: &'static str,
        /// What is there.
        found: String,
    },
}
