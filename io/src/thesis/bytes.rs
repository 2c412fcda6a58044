//! Numbers in binary files, in either byte order.

use super::{Error, Problem};
use std::io::Write;

/// Which byte of a number comes first.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum ByteOrder {
    /// The most significant one, as on the thesis' workstations.
    #[default]
    Big,
    /// The least significant one.
    Little,
}

/// What was read, and in which order its bytes were.
#[derive(Clone, PartialEq, Debug)]
pub struct Decoded<T> {
    /// What was read.
    pub value: T,
    /// The order of the bytes.
    pub order: ByteOrder,
}

/// A place in a binary file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
    order: ByteOrder,
}

/// Reads a whole file in the order in which it makes sense.
///
/// Of two failures the one is told that came later: the wrong order fails early.
pub(super) fn in_either_order<T>(
    bytes: &[u8],
    read: impl Fn(&mut Cursor<'_>) -> Result<T, Error>,
) -> Result<Decoded<T>, Error> {
    let attempt = |order| {
        let mut cursor = Cursor {
            bytes,
            at: 0,
            order,
        };
        let value = read(&mut cursor)?;
        match cursor.left() {
            0 => Ok(Decoded { value, order }),
            count => Err(cursor.error(Problem::Trailing { count })),
        }
    };
    attempt(ByteOrder::Big)
        .or_else(|big| attempt(ByteOrder::Little).map_err(|little| further(big, little)))
}

/// Of two failures to read one file the one that came later; of counts in one place the smaller
/// one, else the first.
pub(super) fn further(first: Error, second: Error) -> Error {
    let is_smaller = match (&first.problem, &second.problem) {
        (Problem::Count { count: one, .. }, Problem::Count { count: other, .. }) => {
            first.offset == second.offset && other.cast_unsigned() < one.cast_unsigned()
        }
        _ => false,
    };
    if second.offset > first.offset || is_smaller {
        second
    } else {
        first
    }
}

impl Cursor<'_> {
    /// Bytes that are left.
    pub(super) fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// A complaint about the place where it stands.
    pub(super) fn error(&self, problem: Problem) -> Error {
        Error {
            offset: self.at,
            problem,
            little_endian: self.order == ByteOrder::Little,
        }
    }

    fn take<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Error> {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let Some(chunk) = rest.first_chunk::<N>() else {
            let needed = N - rest.len();
            return Err(self.error(Problem::Truncated { what, needed }));
        };
        self.at += N;
        Ok(*chunk)
    }

    pub(super) fn byte(&mut self, what: &'static str) -> Result<u8, Error> {
        self.take::<1>(what).map(|[byte]| byte)
    }

    pub(super) fn int(&mut self, what: &'static str) -> Result<i32, Error> {
        let bytes = self.take(what)?;
        Ok(match self.order {
            ByteOrder::Big => i32::from_be_bytes(bytes),
            ByteOrder::Little => i32::from_le_bytes(bytes),
        })
    }

    /// A finite `float`.
    pub(super) fn float(&mut self, what: &'static str) -> Result<f32, Error> {
        let start = *self;
        let bytes = self.take(what)?;
        let value = match self.order {
            ByteOrder::Big => f32::from_be_bytes(bytes),
            ByteOrder::Little => f32::from_le_bytes(bytes),
        };
        start.finite(what, value.into()).map(|_| value)
    }

    /// A finite `double`.
    pub(super) fn double(&mut self, what: &'static str) -> Result<f64, Error> {
        let start = *self;
        let bytes = self.take(what)?;
        let value = match self.order {
            ByteOrder::Big => f64::from_be_bytes(bytes),
            ByteOrder::Little => f64::from_le_bytes(bytes),
        };
        start.finite(what, value)
    }

    fn finite(&self, what: &'static str, value: f64) -> Result<f64, Error> {
        if value.is_finite() {
            return Ok(value);
        }
        Err(self.error(Problem::NotFinite { what, value }))
    }

    /// Points, three doubles each.
    pub(super) fn points<const N: usize>(
        &mut self,
        what: &'static str,
    ) -> Result<[[f64; 3]; N], Error> {
        let mut points = [[0.0; 3]; N];
        for number in points.iter_mut().flatten() {
            *number = self.double(what)?;
        }
        Ok(points)
    }

    /// A count of things that take at least `size` bytes each.
    pub(super) fn count(&mut self, what: &'static str, size: usize) -> Result<usize, Error> {
        let start = *self;
        let count = self.int(what)?;
        let most = self.left() / size;
        match usize::try_from(count) {
            Ok(fitting) if fitting <= most => Ok(fitting),
            _ => Err(start.error(Problem::Count {
                what,
                count,
                left: self.left(),
                most,
            })),
        }
    }

    /// A degree, and the number of coefficients of `size` bytes each, which are all there.
    pub(super) fn degree(&mut self, size: usize) -> Result<(usize, usize), Error> {
        let start = *self;
        let degree = self.int("a degree")?;
        let highest = csg::MAX_DEGREE;
        let Some(valid) = usize::try_from(degree).ok().filter(|d| *d <= highest) else {
            return Err(start.error(Problem::Degree { degree, highest }));
        };
        let count = csg::Polynomial::coefficient_count(valid);
        let needed = (count * size).saturating_sub(self.left());
        if needed > 0 {
            let what = "the list of coefficients";
            return Err(self.error(Problem::Truncated { what, needed }));
        }
        Ok((valid, count))
    }

    /// As many doubles, which must be known to be there.
    pub(super) fn doubles(&mut self, what: &'static str, count: usize) -> Result<Vec<f64>, Error> {
        (0..count).map(|_| self.double(what)).collect()
    }

    /// The letter with which files of some kinds begin.
    pub(super) fn mark(&mut self, expected: char, what: &'static str) -> Result<(), Error> {
        let start = *self;
        let found = self.byte(what)?;
        if char::from(found) == expected {
            return Ok(());
        }
        Err(start.error(Problem::Mark {
            expected,
            what,
            found,
        }))
    }
}

/// Whether a number looks like one that somebody wrote: read in the wrong order, few do.
pub(super) fn is_ordinary(value: f64) -> bool {
    value == 0.0 || (1e-30..1e30).contains(&value.abs())
}

/// Writes numbers in one byte order.
#[derive(Debug)]
pub(super) struct Encoder<'a, W> {
    pub(super) out: &'a mut W,
    pub(super) order: ByteOrder,
}

impl<W: Write> Encoder<'_, W> {
    pub(super) fn byte(&mut self, value: u8) -> std::io::Result<()> {
        self.out.write_all(&[value])
    }

    pub(super) fn int(&mut self, value: i32) -> std::io::Result<()> {
        self.out.write_all(&match self.order {
            ByteOrder::Big => value.to_be_bytes(),
            ByteOrder::Little => value.to_le_bytes(),
        })
    }

    /// A count, which the format cannot say if it is above 2³¹ − 1.
    pub(super) fn count(&mut self, value: usize) -> std::io::Result<()> {
        let too_many = |_| std::io::Error::other("more items than the format's 32 bits can count");
        self.int(i32::try_from(value).map_err(too_many)?)
    }

    pub(super) fn float(&mut self, value: f32) -> std::io::Result<()> {
        self.out.write_all(&match self.order {
            ByteOrder::Big => value.to_be_bytes(),
            ByteOrder::Little => value.to_le_bytes(),
        })
    }

    pub(super) fn doubles(&mut self, values: &[f64]) -> std::io::Result<()> {
        for value in values {
            self.out.write_all(&match self.order {
                ByteOrder::Big => value.to_be_bytes(),
                ByteOrder::Little => value.to_le_bytes(),
            })?;
        }
        Ok(())
    }
}
