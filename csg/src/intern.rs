//! Interning: half-spaces whose polynomials are equal up to a factor become one primitive.
//!
//! Flush faces, shared faces and A \ A then cancel by Boolean evaluation instead of by luck.

use crate::lower::Half;
use crate::{Error, NearlyEqual, Polynomial, Primitive, PrimitiveId, Sense};

/// Polynomials this close, relative to their largest coefficient over the cube [−1, 1]³, are
/// equal; so are those that their error bounds cannot tell apart, but no farther than `MOST`.
const LEAST: f64 = 1e-12;

/// See [`LEAST`].
const MOST: f64 = 1e-9;

/// Different polynomials this close are reported.
const SUSPICIOUS: f64 = 1e-7;

/// How many near neighbours are looked at for the report, and how many pairs it holds.
const NEIGHBOURS: usize = 16;

/// See [`NEIGHBOURS`].
const MAX_REPORTED: usize = 1000;

/// Interned half-spaces.
pub(crate) struct Interned {
    /// By first occurrence.
    pub(crate) primitives: Vec<Primitive>,
    /// For each half-space its primitive, and the sense in which `p ≤ 0` there means it.
    pub(crate) of_half: Vec<(PrimitiveId, Sense)>,
    pub(crate) nearly_equal: Vec<NearlyEqual>,
}

/// A half-space's polynomial, largest coefficient 1.
struct Key {
    half: usize,
    degree: usize,
    coefficients: Vec<f64>,
    /// |projection| of the coefficients on a fixed vector, the same for p and −p.
    projection: f64,
    /// Their uncertainty.
    error: f64,
}

/// Half-spaces that are equal.
struct Class {
    /// Index of the key that stands for it while it is collected.
    key: usize,
    /// Its members' half-spaces with the sense relative to that key.
    members: Vec<(usize, Sense)>,
}

/// Interns half-spaces given in the coordinates of the cube [−1, 1]³. Cost: O(n log n).
pub(crate) fn intern(halves: &[Half]) -> Result<Interned, Error> {
    let mut keys = halves
        .iter()
        .enumerate()
        .map(|(half, h)| Key::of(half, h))
        .collect::<Result<Vec<_>, _>>()?;
    keys.sort_by(|a, b| {
        let by_degree = a.degree.cmp(&b.degree);
        let by_projection = a.projection.total_cmp(&b.projection);
        by_degree.then(by_projection).then(a.half.cmp(&b.half))
    });
    let mut near = Vec::new();
    let mut classes = collect(&keys, &mut near);

    for class in &mut classes {
        class.members.sort_unstable_by_key(|member| member.0);
    }
    let mut order: Vec<usize> = (0..classes.len()).collect();
    order.sort_unstable_by_key(|&class| classes[class].members[0].0);
    let mut ids = vec![PrimitiveId(0); classes.len()];
    let mut of_half = vec![(PrimitiveId(0), Sense::Inside); halves.len()];
    let mut primitives = Vec::with_capacity(classes.len());
    for class in order {
        let id = PrimitiveId(u32::try_from(primitives.len()).unwrap_or(u32::MAX));
        ids[class] = id;
        let members = &classes[class].members;
        // The first member's polynomial stands for all.
        let turned = members[0].1;
        for &(half, sense) in members {
            let relative = if sense == turned {
                Sense::Inside
            } else {
                Sense::Outside
            };
            of_half[half] = (id, relative);
        }
        primitives.push(primitive(halves, members)?);
    }
    let mut nearly_equal: Vec<NearlyEqual> = near
        .into_iter()
        .map(|(a, b, difference)| {
            let (a, b): (PrimitiveId, PrimitiveId) = (ids[a], ids[b]);
            NearlyEqual {
                first: a.min(b),
                second: a.max(b),
                difference,
            }
        })
        .collect();
    nearly_equal.sort_by_key(|pair| (pair.first, pair.second));
    Ok(Interned {
        primitives,
        of_half,
        nearly_equal,
    })
}

/// Sorts keys into classes; `near` receives pairs of classes that differ suspiciously little.
fn collect(keys: &[Key], near: &mut Vec<(usize, usize, f64)>) -> Vec<Class> {
    let mut classes: Vec<Class> = Vec::new();
    for (at, key) in keys.iter().enumerate() {
        // |c − c'| ≤ tolerance in each coefficient bounds the distance of the projections.
        let width = key.coefficients.len() as f64;
        let mut home = None;
        let mut close = Vec::new();
        for (back, class) in classes.iter().enumerate().rev() {
            let other = &keys[class.key];
            let apart = (key.projection - other.projection).abs();
            let searched = classes.len() - back;
            let still_near = searched <= NEIGHBOURS && apart <= width * SUSPICIOUS;
            if other.degree != key.degree || !(still_near || apart <= width * MOST) {
                break;
            }
            let (difference, sense) = distance(key, other);
            if difference <= (4.0 * (key.error + other.error)).clamp(LEAST, MOST) {
                home = Some((back, sense));
                break;
            }
            if difference <= SUSPICIOUS {
                close.push((back, difference));
            }
        }
        if let Some((class, sense)) = home {
            classes[class].members.push((key.half, sense));
        } else {
            let pairs = close
                .into_iter()
                .map(|(class, d)| (class, classes.len(), d));
            near.extend(pairs.take(MAX_REPORTED.saturating_sub(near.len())));
            classes.push(Class {
                key: at,
                members: vec![(key.half, Sense::Inside)],
            });
        }
    }
    classes
}

/// Largest difference of the coefficients of p and ±q, and the sign that makes it smaller.
fn distance(p: &Key, q: &Key) -> (f64, Sense) {
    let pairs = || p.coefficients.iter().zip(&q.coefficients);
    let minus = pairs().fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    let plus = pairs().fold(0.0, |m: f64, (a, b)| m.max((a + b).abs()));
    if minus <= plus {
        (minus, Sense::Inside)
    } else {
        (plus, Sense::Outside)
    }
}

/// The primitive for members that are equal, represented by the first of them.
fn primitive(halves: &[Half], members: &[(usize, Sense)]) -> Result<Primitive, Error> {
    let scaled = |half: usize| {
        let Half { polynomial, error } = &halves[half];
        let largest = polynomial.max_abs();
        let scaled = polynomial.clone().scaled(1.0 / largest)?;
        let sum: f64 = scaled.coefficients().iter().map(|c| c.abs()).sum();
        Ok((scaled, error / largest + f64::EPSILON * sum))
    };
    let (polynomial, mut coefficient_error): (Polynomial, f64) = scaled(members[0].0)?;
    for &(half, sense) in &members[1..] {
        if halves[half].polynomial == halves[members[0].0].polynomial {
            continue;
        }
        let (other, error) = scaled(half)?;
        let sign = if sense == members[0].1 { 1.0 } else { -1.0 };
        let pairs = polynomial.coefficients().iter().zip(other.coefficients());
        let apart: f64 = pairs.map(|(a, b)| (a - sign * b).abs()).sum();
        coefficient_error = coefficient_error.max(error + apart);
    }
    Ok(Primitive {
        polynomial,
        coefficient_error,
    })
}

impl Key {
    fn of(half: usize, Half { polynomial, error }: &Half) -> Result<Self, Error> {
        let largest = polynomial.max_abs();
        let scaled = polynomial.clone().scaled(1.0 / largest)?;
        let coefficients = scaled.coefficients().to_vec();
        let projected = coefficients.iter().zip(directions()).map(|(c, d)| c * d);
        Ok(Self {
            half,
            degree: scaled.degree(),
            projection: projected.sum::<f64>().abs(),
            coefficients,
            error: error / largest,
        })
    }
}

/// A fixed pseudo-random sequence in [−1, 1] (splitmix64).
fn directions() -> impl Iterator<Item = f64> {
    (1_u64..).map(|n| {
        let mut z = n.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    })
}
