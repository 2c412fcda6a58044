//! Binary STL.
//!
//! The format has no indices and 32-bit numbers: readers find out which corners are one vertex by
//! comparing positions. [`Outcome::welding`] says whether they get the same mesh back.

use super::{Error, GENERATOR};
use brep::{Brep, Valid};
use glam::{DVec3, Vec3};
use std::io::Write;

/// What became of the mesh.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Outcome {
    /// Triangles written.
    pub triangles: u32,
    /// What readers see who weld corners by position.
    pub welding: Welding,
}

/// The mesh after joining all corners with equal 32-bit positions.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Welding {
    /// Vertices stay apart: the same mesh.
    Exact,
    /// Some vertices and triangles vanish, but the surface stays a closed 2-manifold.
    Smaller {
        /// Vertices that fall onto others.
        merged: usize,
    },
    /// Readers will find the surface not to be a closed 2-manifold.
    Broken {
        /// Vertices that fall onto others.
        merged: usize,
        /// The first thing that is wrong with the welded mesh.
        reason: brep::Error,
    },
}

/// Writes the boundary; facet normals are those of the unrounded facets.
///
/// # Errors
/// [`Error::Io`], [`Error::BeyondSinglePrecision`], [`Error::TooLarge`].
pub fn write(brep: &Valid<Brep>, out: &mut impl Write) -> Result<Outcome, Error> {
    let size = brep.facet_count();
    let Ok(triangles) = u32::try_from(size) else {
        return Err(Error::TooLarge {
            size,
            unit: "triangles",
        });
    };
    let positions = brep
        .vertices()
        .map(|vertex| single_precision(vertex.position()));
    let positions = positions.collect::<Result<Vec<Vec3>, Error>>()?;
    let numbers = brep.number_vertices();
    let indices: Vec<[u32; 3]> = brep
        .facets()
        .map(|facet| facet.vertices().map(|vertex| numbers[vertex.key()]))
        .collect();

    // Must not begin with "solid": that would announce the text form.
    let mut header = [b' '; 80];
    let title = format!("binary STL, {GENERATOR}");
    for (byte, letter) in header.iter_mut().zip(title.bytes()) {
        *byte = letter;
    }
    out.write_all(&header)?;
    out.write_all(&triangles.to_le_bytes())?;
    for (facet, corners) in brep.facets().zip(&indices) {
        let normal = facet.area_vector().normalize_or_zero().as_vec3();
        let mut record = [0; 50];
        let numbers = corners.map(|corner| positions[corner as usize]);
        let numbers = std::iter::once(normal)
            .chain(numbers)
            .flat_map(|v| v.to_array());
        for (field, number) in record.chunks_exact_mut(4).zip(numbers) {
            field.copy_from_slice(&number.to_le_bytes());
        }
        out.write_all(&record)?;
    }
    let welding = weld(&positions, &indices);
    Ok(Outcome { triangles, welding })
}

/// The nearest position in 32-bit numbers.
pub(super) fn single_precision(position: DVec3) -> Result<Vec3, Error> {
    // Adding zero turns −0 into 0, so that equal positions have equal bytes.
    let rounded = position.as_vec3() + Vec3::ZERO;
    if rounded.is_finite() {
        Ok(rounded)
    } else {
        Err(Error::BeyondSinglePrecision { position })
    }
}

/// What a reader gets who joins equal positions and drops triangles that vanish.
fn weld(positions: &[Vec3], triangles: &[[u32; 3]]) -> Welding {
    let positions: Vec<DVec3> = positions.iter().map(|p| p.as_dvec3()).collect();
    let first = brep::join_equal(&positions, &[]);
    let merged = (0_u32..)
        .zip(&first)
        .filter(|(v, first)| v != *first)
        .count();
    if merged == 0 {
        return Welding::Exact;
    }
    let welded: Vec<[u32; 3]> = triangles
        .iter()
        .map(|corners| corners.map(|corner| first[corner as usize]))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .collect();
    match brep::check_manifold(positions.len(), &welded) {
        Ok(()) => Welding::Smaller { merged },
        Err(reason) => Welding::Broken { merged, reason },
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{cube, moved, sphere, tetrahedron, together, torus};
    use super::*;
    use subdiv::Fragments;

    fn written(fragments: &Fragments) -> Result<(Vec<u8>, Outcome), Error> {
        let brep = brep::stitch(fragments)
            .expect("closed")
            .validate()
            .expect("valid");
        let mut bytes = Vec::new();
        let outcome = write(&brep, &mut bytes)?;
        Ok((bytes, outcome))
    }

    /// The four vectors of each record.
    fn records(bytes: &[u8]) -> Vec<[DVec3; 4]> {
        let number = |bytes: &[u8]| f32::from_le_bytes(bytes.try_into().expect("four bytes"));
        let vector = |bytes: &[u8]| {
            DVec3::new(
                number(&bytes[..4]).into(),
                number(&bytes[4..8]).into(),
                number(&bytes[8..12]).into(),
            )
        };
        let record = |bytes: &[u8]| std::array::from_fn(|at| vector(&bytes[12 * at..]));
        bytes[84..].chunks_exact(50).map(record).collect()
    }

    #[test]
    fn bytes_follow_the_format() -> Result<(), Error> {
        let fragments = torus(2.0, 1.0, 12, 8);
        let (bytes, outcome) = written(&fragments)?;
        assert_eq!(bytes.len(), 84 + 50 * 192);
        assert!(!bytes.starts_with(b"solid"));
        assert_eq!(bytes[80..84], 192_u32.to_le_bytes());
        assert_eq!(
            outcome,
            Outcome {
                triangles: 192,
                welding: Welding::Exact
            }
        );
        for (record, triangle) in records(&bytes).into_iter().zip(&fragments.triangles) {
            let corners = triangle
                .vertices
                .map(|vertex| fragments.positions[vertex as usize]);
            for (read, corner) in record[1..].iter().zip(corners) {
                // Half an ulp of numbers up to 3.
                assert!((*read - corner).abs().max_element() <= 1.2e-7);
            }
            let normal = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize();
            assert!((record[0] - normal).length() < 1e-6);
        }
        Ok(())
    }

    #[test]
    fn the_empty_solid_has_no_triangles() -> Result<(), Error> {
        let (bytes, outcome) = written(&Fragments::default())?;
        assert_eq!((bytes.len(), outcome.triangles), (84, 0));
        Ok(())
    }

    #[test]
    fn welding_that_loses_detail_only_is_told_apart() -> Result<(), Error> {
        // A vertex pair closer than 32-bit numbers can tell.
        let mut fragments = torus(2.0, 1.0, 12, 8);
        fragments.positions[9] = fragments.positions[1] * (1.0 + 1e-12);
        let (_, outcome) = written(&fragments)?;
        assert_eq!(outcome.welding, Welding::Smaller { merged: 1 });
        // Solids that touch in a corner have two vertices there: readers weld them.
        let touching = together(&[cube([0.0; 3], 1.0), cube([2.0; 3], 1.0)]);
        let (_, outcome) = written(&touching)?;
        let broken = matches!(
            outcome.welding,
            Welding::Broken {
                merged: 1,
                reason: brep::Error::PinchedVertex { .. }
            }
        );
        assert!(broken, "{outcome:?}");
        // A thin plate far away: its two sides become one.
        let far = moved(sphere(2), |p| p * DVec3::new(1e-9, 1.0, 1.0) + 1e3);
        let (_, outcome) = written(&far)?;
        assert!(
            matches!(outcome.welding, Welding::Broken { .. }),
            "{outcome:?}"
        );
        Ok(())
    }

    #[test]
    fn numbers_beyond_the_format_are_an_error() {
        let huge = moved(tetrahedron(), |p| p * 1e39);
        let error = written(&huge).expect_err("too large");
        assert!(matches!(error, Error::BeyondSinglePrecision { .. }));
    }
}
