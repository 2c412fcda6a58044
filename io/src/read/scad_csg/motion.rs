//! Matrices of the nodes that move their children.

use super::arguments::{Arguments, Given};
use super::complaints::{Complaints, Reported};
use super::nodes::Motion;
use csg::{Error, Transform};
use glam::{DMat3, DVec3};

/// What becomes of the children.
pub(super) enum Moved {
    /// They stay where they are.
    Not,
    /// They are moved so.
    By(Transform),
    /// They vanish, as in OpenSCAD; a warning was given.
    Dropped,
}

/// The transform of a node.
pub(super) fn read(
    motion: Motion,
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Moved, Reported> {
    let matrix = match motion {
        Motion::Matrix => match affine(arguments, complaints)? {
            Some(matrix) => matrix,
            None => return Ok(Moved::Not),
        },
        Motion::Translate => moved_by(vector(arguments, 0.0, complaints)?.unwrap_or_default()),
        Motion::Scale => {
            let factors = if arguments.is_number("v") {
                arguments.number("v", complaints)?.map(|v| [v.value; 3])
            } else {
                vector(arguments, 1.0, complaints)?
            };
            linear(DMat3::from_diagonal(factors.unwrap_or([1.0; 3]).into()))
        }
        Motion::Mirror => {
            let normal = DVec3::from(vector(arguments, 0.0, complaints)?.unwrap_or_default());
            linear(reflection(normal))
        }
        Motion::Rotate => linear(rotation(arguments, complaints)?),
    };
    if matrix == moved_by([0.0; 3]) {
        return Ok(Moved::Not);
    }
    let why = match Transform::from_columns(&matrix) {
        Ok(transform) => return Ok(Moved::By(transform)),
        Err(Error::NonFinite { .. }) => "holds a number that is not finite",
        Err(_) => "is singular: it flattens everything",
    };
    complaints.warn(
        arguments.name,
        format!("the matrix {why}; the children are left out, as in OpenSCAD"),
        None,
    );
    Ok(Moved::Dropped)
}

/// The matrix of `multmatrix`, `None` if missing.
fn affine(
    arguments: &Arguments<'_>,
    complaints: &mut Complaints<'_>,
) -> Result<Option<[[f64; 4]; 4]>, Reported> {
    let Some(Given { value: matrix, at }) = arguments.matrix("m", complaints)? else {
        return Ok(None);
    };
    #[expect(
        clippy::float_cmp,
        reason = "the last row of an affine matrix is exact"
    )]
    let is_affine = matrix[3] == [0.0, 0.0, 0.0, 1.0];
    if is_affine || matrix.iter().flatten().any(|m| !m.is_finite()) {
        return Ok(Some(matrix));
    }
    let [a, b, c, d] = matrix[3];
    Err(complaints.error(
        at,
        format!("the last row of a matrix must be [0, 0, 0, 1], found [{a}, {b}, {c}, {d}]"),
        "projective maps have no place in an OpenSCAD model".to_owned(),
    ))
}

/// Two or three numbers; `third` stands for a missing third one.
fn vector(
    arguments: &Arguments<'_>,
    third: f64,
    complaints: &mut Complaints<'_>,
) -> Result<Option<[f64; 3]>, Reported> {
    let row = arguments.numbers("v", 2, 3, complaints)?;
    Ok(row.and_then(|row| match row.value[..] {
        [x, y] => Some([x, y, third]),
        [x, y, z] => Some([x, y, z]),
        _ => None,
    }))
}

/// `rotate(a)` about z, `rotate([x, y, z])` about x, then y, then z, or `rotate(a, v)` about v.
fn rotation(arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Result<DMat3, Reported> {
    if !arguments.is_number("a") {
        let angles = arguments.vector("a", complaints)?;
        let [x, y, z] = angles.map_or([0.0; 3], |angles| angles.value);
        return Ok(turn(DVec3::Z, z) * turn(DVec3::Y, y) * turn(DVec3::X, x));
    }
    let angle = arguments.number("a", complaints)?.map_or(0.0, |a| a.value);
    let axis = arguments.vector("v", complaints)?;
    let axis = axis.map_or(DVec3::Z, |axis| DVec3::from(axis.value));
    Ok(turn(axis.try_normalize().unwrap_or(DVec3::Z), angle))
}

/// The rotation about a unit vector (Rodrigues).
fn turn(axis: DVec3, degrees: f64) -> DMat3 {
    let (sine, cosine) = sin_cos_degrees(degrees);
    let image = |unit: DVec3| {
        let along = axis * axis.dot(unit);
        along + (unit - along) * cosine + axis.cross(unit) * sine
    };
    DMat3::from_cols(image(DVec3::X), image(DVec3::Y), image(DVec3::Z))
}

/// Sine and cosine, exact at multiples of 90°.
pub(super) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    let quarter = (turn / 90.0).round();
    let (sine, cosine) = (turn - 90.0 * quarter).to_radians().sin_cos();
    if (0.5..1.5).contains(&quarter) {
        (cosine, -sine)
    } else if (1.5..2.5).contains(&quarter) {
        (-sine, -cosine)
    } else if (2.5..3.5).contains(&quarter) {
        (-cosine, sine)
    } else {
        (sine, cosine)
    }
}

/// The mirror image in the plane through the origin with this normal; of a zero normal none.
fn reflection(normal: DVec3) -> DMat3 {
    let n = normal.normalize_or_zero();
    DMat3::from_cols(
        DVec3::X - 2.0 * n.x * n,
        DVec3::Y - 2.0 * n.y * n,
        DVec3::Z - 2.0 * n.z * n,
    )
}

fn moved_by([x, y, z]: [f64; 3]) -> [[f64; 4]; 4] {
    [
        [1.0, 0.0, 0.0, x],
        [0.0, 1.0, 0.0, y],
        [0.0, 0.0, 1.0, z],
        [0.0, 0.0, 0.0, 1.0],
    ]
}

fn linear(m: DMat3) -> [[f64; 4]; 4] {
    let [x, y, z] = [m.row(0), m.row(1), m.row(2)];
    [
        x.extend(0.0).to_array(),
        y.extend(0.0).to_array(),
        z.extend(0.0).to_array(),
        [0.0, 0.0, 0.0, 1.0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact() {
        for (degrees, expected) in [
            (0.0, (0.0, 1.0)),
            (90.0, (1.0, 0.0)),
            (180.0, (0.0, -1.0)),
            (270.0, (-1.0, 0.0)),
            (-90.0, (-1.0, 0.0)),
            (360.0, (0.0, 1.0)),
            (3690.0, (1.0, 0.0)),
        ] {
            assert_eq!(sin_cos_degrees(degrees), expected, "{degrees}");
        }
        for degrees in [
            -700.0, -45.0, 10.0, 44.9, 45.1, 134.0, 226.0, 314.0, 359.0_f64,
        ] {
            let (sine, cosine) = sin_cos_degrees(degrees);
            let expected = degrees.to_radians().sin_cos();
            assert!(
                (sine - expected.0).hypot(cosine - expected.1) < 1e-14,
                "{degrees}"
            );
        }
    }

    #[test]
    fn rotations_turn_counter_clockwise_and_mirrors_mirror() {
        assert_eq!(turn(DVec3::Z, 90.0) * DVec3::X, DVec3::Y);
        assert_eq!(turn(DVec3::X, 90.0) * DVec3::Y, DVec3::Z);
        assert_eq!(
            reflection(DVec3::new(0.0, 3.0, 0.0)) * DVec3::ONE,
            DVec3::new(1.0, -1.0, 1.0)
        );
        assert_eq!(reflection(DVec3::ZERO), DMat3::IDENTITY);
    }
}
