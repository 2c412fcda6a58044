//! The shapes: arguments to [`csg::Shape`], with OpenSCAD's defaults and rules of dropping.

use super::arguments::Arguments;
use super::complaints::{Complaints, Reported};
use super::nodes::Leaf;
use super::token::Span;
use super::{import, polyhedron, surface};
use crate::read::{Files, expression};
use csg::{Polynomial, Shape};
use glam::DVec3;
use std::f64::consts::PI;

/// What a shape node stands for.
pub(super) enum Volume {
    /// A shape.
    Shape(Shape),
    /// A polyhedron that need not be convex.
    Polyhedron(polyhedron::Polyhedron),
    /// No point at all; a warning was given.
    Nothing,
    /// All of space; a warning was given.
    Everything,
}

/// Coefficients of all polynomials of a file together, at most: 400 MB.
const MAX_COEFFICIENTS: usize = 50_000_000;

/// Larger numbers make squares and fourth powers overflow further on.
pub(super) const MAX_SIZE: f64 = 1e50;

/// Reads shapes within the limits that hold for a whole file.
pub(super) struct ShapeReader<'f> {
    files: &'f dyn Files,
    facet_limit: u32,
    max_degree: u8,
    work_left: u64,
    coefficients_left: usize,
}

type Outcome = Result<Volume, Reported>;

impl<'f> ShapeReader<'f> {
    pub(super) fn new(facet_limit: u32, max_degree: u8, files: &'f dyn Files) -> Self {
        Self {
            files,
            facet_limit,
            max_degree,
            work_left: expression::WORK,
            coefficients_left: MAX_COEFFICIENTS,
        }
    }

    /// Where files and fonts come from.
    pub(super) fn files(&self) -> &'f dyn Files {
        self.files
    }

    pub(super) fn read(
        &mut self,
        leaf: Leaf,
        arguments: &Arguments<'_>,
        complaints: &mut Complaints<'_>,
    ) -> Outcome {
        match leaf {
            Leaf::Cube => cube(arguments, complaints),
            Leaf::Sphere => self.sphere(arguments, complaints),
            Leaf::Cylinder => self.cylinder(arguments, complaints),
            Leaf::Polyhedron => polyhedron::read(arguments, complaints),
            Leaf::Import => import::read(arguments, self.files, complaints),
            Leaf::Surface => surface::read(arguments, self.files, complaints),
            Leaf::Torus => torus(arguments, complaints),
            Leaf::HalfSpace => half_space(arguments, complaints),
            Leaf::Quadric => quadric(arguments, complaints),
            Leaf::Polynomial => self.polynomial(arguments, complaints),
            Leaf::Helicoid => Ok(Volume::Shape(Shape::helicoid())),
        }
    }

    /// Number of sides that the author asked for, unless that many only mean "round".
    pub(super) fn sides(&self, arguments: &Arguments<'_>) -> Option<u32> {
        let fragments = arguments.fragments();
        if !(fragments > 0.0 && fragments <= f64::from(self.facet_limit)) {
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "positive and at most a u32"
        )]
        Some((fragments.floor() as u32).max(3))
    }

    fn sphere(&self, arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
        let radius = radius(arguments, "r", "d", complaints)?.unwrap_or(1.0);
        if !(radius > 0.0 && radius.is_finite()) {
            return Ok(dropped(arguments, &format!("radius {radius}"), complaints));
        }
        let Some(sides) = self.sides(arguments) else {
            return finish(Shape::sphere(radius), radius, arguments.name, complaints);
        };
        complaints.warn_once(
            "faceted sphere",
            arguments.name,
            format!(
                "a sphere with $fn = {} is taken as the polyhedron that OpenSCAD makes of it",
                arguments.fragments()
            ),
            Some(format!(
                "true spheres have $fn = 0 or above the facet limit of {}",
                self.facet_limit
            )),
        );
        let (vertices, faces) = faceted_sphere(sides, radius);
        let shape = Shape::convex_polyhedron(&vertices, &faces);
        finish(shape, radius, arguments.name, complaints)
    }

    fn cylinder(&self, arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
        let height = arguments.number("h", complaints)?.map_or(1.0, |h| h.value);
        let both = radius(arguments, "r", "d", complaints)?.unwrap_or(1.0);
        let r1 = radius(arguments, "r1", "d1", complaints)?.unwrap_or(both);
        let r2 = radius(arguments, "r2", "d2", complaints)?.unwrap_or(both);
        let center = arguments.flag("center", complaints)?;
        let is_finite = height.is_finite() && r1.is_finite() && r2.is_finite();
        if !(is_finite && height > 0.0 && r1 >= 0.0 && r2 >= 0.0 && r1.max(r2) > 0.0) {
            let sizes = format!("height {height} and radii {r1}, {r2}");
            return Ok(dropped(arguments, &sizes, complaints));
        }
        let (z0, z1) = if center {
            (-0.5 * height, 0.5 * height)
        } else {
            (0.0, height)
        };
        let shape = match self.sides(arguments) {
            Some(sides) => Shape::prism(sides, r1, r2, z0, z1),
            None => Shape::frustum(r1, r2, z0, z1),
        };
        finish(shape, height.max(r1).max(r2), arguments.name, complaints)
    }

    fn polynomial(
        &mut self,
        arguments: &Arguments<'_>,
        complaints: &mut Complaints<'_>,
    ) -> Outcome {
        let Some(given) = arguments.string("p", complaints)? else {
            return Err(arguments.missing("p", "\"x^2 + y^2 - 1\"", complaints));
        };
        let terms = match expression::parse(given.value, self.max_degree, &mut self.work_left) {
            Ok(terms) => terms,
            Err(error) => {
                let (start, begin) = (given.at.range().start, error.span.start);
                let at = Span::new(start + begin, start + error.span.end);
                return Err(complaints.error(at, error.message, error.remedy));
            }
        };
        let degree = usize::from(terms.degree());
        if let Some(value) = terms.as_constant() {
            return constant(value, given.at, complaints);
        }
        let needed = Polynomial::coefficient_count(degree);
        let Some(left) = self.coefficients_left.checked_sub(needed) else {
            return Err(complaints.error(
                given.at,
                "the polynomials of this file have too many coefficients",
                format!("all together may have {MAX_COEFFICIENTS}"),
            ));
        };
        self.coefficients_left = left;
        let terms: Vec<_> = terms.iter().map(|(e, c)| (e.map(usize::from), c)).collect();
        let polynomial = Polynomial::from_terms(degree, &terms).map(Shape::Polynomial);
        finish(polynomial, 0.0, given.at, complaints)
    }
}

/// The radius, or half the diameter if that is given instead.
pub(super) fn radius(
    arguments: &Arguments<'_>,
    radius: &str,
    diameter: &str,
    complaints: &mut Complaints<'_>,
) -> Result<Option<f64>, Reported> {
    if let Some(diameter) = arguments.number(diameter, complaints)? {
        return Ok(Some(0.5 * diameter.value));
    }
    Ok(arguments.number(radius, complaints)?.map(|r| r.value))
}

fn cube(arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
    let size = if arguments.is_number("size") {
        arguments
            .number("size", complaints)?
            .map(|size| [size.value; 3])
    } else {
        arguments.vector("size", complaints)?.map(|size| size.value)
    };
    let size = DVec3::from(size.unwrap_or([1.0; 3]));
    if !(size.is_finite() && size.min_element() > 0.0) {
        let DVec3 { x, y, z } = size;
        return Ok(dropped(
            arguments,
            &format!("size [{x}, {y}, {z}]"),
            complaints,
        ));
    }
    let min = if arguments.flag("center", complaints)? {
        -0.5 * size
    } else {
        DVec3::ZERO
    };
    let shape = Shape::block(min, min + size);
    finish(shape, size.max_element(), arguments.name, complaints)
}

fn torus(arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
    let mut radii = [0.0; 2];
    let parameters = [("r1", "ring radius r1"), ("r2", "tube radius r2")];
    for (radius, (parameter, name)) in radii.iter_mut().zip(parameters) {
        let Some(given) = arguments.number(parameter, complaints)? else {
            return Err(arguments.missing(parameter, "r1 = 3, r2 = 1", complaints));
        };
        *radius = given.value;
        if !given.value.is_finite() {
            let message = format!("the {name} must be finite, found {}", given.value);
            return Err(complaints.error(given.at, message, None));
        }
        if given.value <= 0.0 {
            let remedy = match given.value {
                0.0 => "remove the torus".to_owned(),
                value => format!("write {parameter} = {}, or remove the torus", -value),
            };
            let message = format!("the {name} must be positive, found {}", given.value);
            return Err(complaints.error(given.at, message, remedy));
        }
    }
    let [ring, tube] = radii;
    finish(
        Shape::torus(ring, tube),
        ring.max(tube),
        arguments.name,
        complaints,
    )
}

fn half_space(arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
    let example = "n = [0, 0, 1], d = 2";
    let Some(normal) = arguments.vector("n", complaints)? else {
        return Err(arguments.missing("n", example, complaints));
    };
    let Some(offset) = arguments.number("d", complaints)? else {
        return Err(arguments.missing("d", example, complaints));
    };
    let n = DVec3::from(normal.value);
    if n == DVec3::ZERO {
        return Err(complaints.error(
            normal.at,
            "the normal of a half-space must not be zero",
            "write the direction that points out of it, such as n = [0, 0, 1]".to_owned(),
        ));
    }
    for (is_finite, at, what) in [
        (n.is_finite(), normal.at, "normal"),
        (offset.value.is_finite(), offset.at, "offset"),
    ] {
        if !is_finite {
            let message = format!("the {what} of a half-space must be finite");
            return Err(complaints.error(at, message, None));
        }
    }
    let size = n.abs().max_element().max(offset.value.abs());
    finish(
        Shape::half_space(n, offset.value),
        size,
        arguments.name,
        complaints,
    )
}

fn quadric(arguments: &Arguments<'_>, complaints: &mut Complaints<'_>) -> Outcome {
    let Some(given) = arguments.matrix("m", complaints)? else {
        let example = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,-1]]";
        return Err(arguments.missing("m", example, complaints));
    };
    let matrix = given.value;
    if matrix.iter().flatten().any(|m| !m.is_finite()) {
        let message = "the matrix of a quadric must be finite";
        return Err(complaints.error(given.at, message, None));
    }
    let form = Polynomial::quadric(&matrix);
    if let Ok([value]) = form.as_ref().map(Polynomial::coefficients) {
        return constant(*value, given.at, complaints);
    }
    let size = matrix
        .iter()
        .flatten()
        .fold(0.0_f64, |size, m| size.max(m.abs()));
    finish(Shape::quadric(&matrix), size, given.at, complaints)
}

/// `value ≤ 0`, everywhere or nowhere.
fn constant(value: f64, at: Span, complaints: &mut Complaints<'_>) -> Outcome {
    if value > 0.0 {
        let message = format!("this is {value} > 0 everywhere: the shape is empty");
        complaints.warn(at, message, None);
        Ok(Volume::Nothing)
    } else if value < 0.0 {
        let message = format!("this is {value} < 0 everywhere: the shape is all of space");
        complaints.warn(at, message, None);
        Ok(Volume::Everything)
    } else {
        Err(complaints.error(
            at,
            "this is 0 everywhere and bounds nothing",
            "remove the shape".to_owned(),
        ))
    }
}

/// Leaves a shape out as OpenSCAD does.
fn dropped(arguments: &Arguments<'_>, sizes: &str, complaints: &mut Complaints<'_>) -> Volume {
    let node = arguments.node();
    let message = format!("a {node} of {sizes} has no volume; it is left out, as in OpenSCAD");
    complaints.warn(arguments.name, message, None);
    Volume::Nothing
}

/// `size`: the largest number that went into the shape.
pub(super) fn finish(
    shape: Result<Shape, csg::Error>,
    size: f64,
    at: Span,
    complaints: &mut Complaints<'_>,
) -> Outcome {
    if size > MAX_SIZE {
        return Err(complaints.error(
            at,
            format!("{size:e} is too large a size to compute with"),
            format!("scale the model; sizes up to {MAX_SIZE} are possible"),
        ));
    }
    match shape {
        Ok(shape) => Ok(Volume::Shape(shape)),
        Err(error) => Err(complaints.error(at, error.to_string(), None)),
    }
}

/// OpenSCAD's sphere: rings of `sides` vertices at polar angles 180°·(i+½)/rings, so the poles
/// are cut off flat. The first vertex of each ring is in the half-plane of +x.
fn faceted_sphere(sides: u32, radius: f64) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let rings = sides.div_ceil(2);
    let (n, m) = (sides as usize, rings as usize);
    let mut vertices = Vec::with_capacity(n * m);
    for ring in 0..rings {
        let polar = PI * (f64::from(ring) + 0.5) / f64::from(rings);
        for side in 0..sides {
            let azimuth = 2.0 * PI * f64::from(side) / f64::from(sides);
            let across = radius * polar.sin();
            let (x, y) = (across * azimuth.cos(), across * azimuth.sin());
            vertices.push(DVec3::new(x, y, radius * polar.cos()));
        }
    }
    let mut faces: Vec<Vec<usize>> = vec![(0..n).collect(), (n * (m - 1)..n * m).collect()];
    for ring in 0..m - 1 {
        let (upper, lower) = (ring * n, (ring + 1) * n);
        faces.extend((0..n).map(|side| {
            let next = (side + 1) % n;
            vec![upper + side, lower + side, lower + next, upper + next]
        }));
    }
    (vertices, faces)
}
