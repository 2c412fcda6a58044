//! Quadrics with one and the same quadratic part up to a factor, such as all spheres, or parallel
//! cylinders of one radius or of several.
//!
//! Of two such the difference is affine, and surfaces p = q = 0 cross where p = 0 crosses that
//! plane. The angle there is wide even where the spheres themselves meet at a small one, and the
//! plane's gradient does not vary, so p and p − q pass the test in much larger leaves than p and q.
//! The test must be made with the same functions in all leaves around a point; that is why kinship
//! is a property of the whole solid.

use csg::{Polynomial, Primitive};
use rustc_hash::FxHashMap;

/// What a quadric has in common with its kin.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Kin {
    /// Number of the family.
    family: u32,
    /// Times this the quadratic part is the family's.
    pub(crate) factor: f64,
}

impl Kin {
    /// Whether two primitives are kin.
    #[must_use]
    pub(crate) fn joins(a: Option<Self>, b: Option<Self>) -> bool {
        matches!((a, b), (Some(a), Some(b)) if a.family == b.family)
    }
}

/// The kin of each primitive; `None` for other degrees than 2.
///
/// Quadratic parts that differ by rounding count as one. Nothing relies on it: the difference is
/// taken as the quadric that it then is.
#[must_use]
pub(crate) fn families(primitives: &[Primitive]) -> Vec<Option<Kin>> {
    let mut known: FxHashMap<[i64; 6], u32> = FxHashMap::default();
    let of = |primitive: &Primitive| {
        let polynomial = &primitive.polynomial;
        if polynomial.degree() != 2 {
            return None;
        }
        let exponents = [
            [2, 0, 0],
            [1, 1, 0],
            [1, 0, 1],
            [0, 2, 0],
            [0, 1, 1],
            [0, 0, 2],
        ];
        let part =
            exponents.map(|[a, b, c]| polynomial.coefficients()[Polynomial::index(2, a, b, c)]);
        let largest = part
            .into_iter()
            .max_by(|a, b| a.abs().total_cmp(&b.abs()))
            .filter(|largest| *largest != 0.0)?;
        let factor = 1.0 / largest;
        let key = part.map(|c| (c * factor * 1e7).round() as i64);
        let next = known.len() as u32;
        let family = *known.entry(key).or_insert(next);
        Some(Kin { family, factor })
    };
    primitives.iter().map(of).collect()
}
