//! What a surface is called and which parameters it has, for text and JSON alike.

use crate::summary::{number, triple};
use csg::{QuadricForm, QuadricKind, Surface};
use glam::DVec3;
use serde_json::{Map, Value, json};

/// A surface's kind and parameters.
pub(crate) struct Description {
    kind: &'static str,
    parameters: Vec<Parameter>,
}

/// A parameter with its name in JSON; in text the name has spaces.
struct Parameter {
    name: &'static str,
    value: Quantity,
}

/// What a parameter measures.
enum Quantity {
    /// Lengths in model units.
    Lengths(Vec<f64>),
    /// A point in model units.
    Point(DVec3),
    /// Directions of length 1.
    Directions(Vec<DVec3>),
    /// Angles, in radians; text shows degrees.
    Angles(Vec<f64>),
    /// A plain number.
    Number(f64),
    /// A count.
    Count(usize),
}

impl Description {
    pub(crate) fn of(surface: Surface) -> Self {
        use Quantity::{Angles, Count, Directions, Lengths, Point};
        let (kind, parameters) = match surface {
            Surface::Plane { normal, offset } => (
                "plane",
                vec![
                    ("normal", Directions(vec![normal])),
                    ("offset", Lengths(vec![offset])),
                ],
            ),
            Surface::Sphere { center, radius } => (
                "sphere",
                vec![("center", Point(center)), ("radius", Lengths(vec![radius]))],
            ),
            Surface::Cylinder {
                point,
                axis,
                radius,
            } => (
                "cylinder",
                vec![
                    ("point", Point(point)),
                    ("axis", Directions(vec![axis])),
                    ("radius", Lengths(vec![radius])),
                ],
            ),
            Surface::Cone {
                apex,
                axis,
                half_angle_rad,
            } => (
                "cone",
                vec![
                    ("apex", Point(apex)),
                    ("axis", Directions(vec![axis])),
                    ("half_angle_rad", Angles(vec![half_angle_rad])),
                ],
            ),
            Surface::Torus {
                center,
                axis,
                ring,
                tube,
            } => (
                "torus",
                vec![
                    ("center", Point(center)),
                    ("axis", Directions(vec![axis])),
                    ("ring", Lengths(vec![ring])),
                    ("tube", Lengths(vec![tube])),
                ],
            ),
            Surface::Quadric(form) => quadric(&form),
            Surface::Algebraic { degree } => {
                ("algebraic surface", vec![("of_degree", Count(degree))])
            }
            _ => ("constant", Vec::new()),
        };
        let parameters = parameters.into_iter();
        let parameters = parameters.map(|(name, value)| Parameter { name, value });
        Self {
            kind,
            parameters: parameters.collect(),
        }
    }

    /// `sphere, center (5, 0, 1), radius 1`, of a model of this size.
    pub(crate) fn to_text(&self, size: f64) -> String {
        let mut text = self.kind.to_owned();
        for Parameter { name, value } in &self.parameters {
            let name = name.trim_end_matches("_rad").replace('_', " ");
            text = format!("{text}, {name} {}", value.to_text(size));
        }
        text
    }

    pub(crate) fn to_json(&self) -> Value {
        let mut object = Map::new();
        object.insert("kind".to_owned(), json!(self.kind));
        for Parameter { name, value } in &self.parameters {
            object.insert((*name).to_owned(), value.to_json());
        }
        Value::Object(object)
    }
}

impl Quantity {
    fn to_text(&self, size: f64) -> String {
        let list = |texts: Vec<String>| texts.join(", ");
        match self {
            Self::Lengths(lengths) => list(lengths.iter().map(|l| number(*l, size)).collect()),
            Self::Point(point) => triple(*point, size),
            Self::Directions(directions) => {
                list(directions.iter().map(|d| triple(*d, 1.0)).collect())
            }
            Self::Angles(angles) => {
                let degrees = angles.iter().map(|a| number(a.to_degrees(), 1.0) + "°");
                list(degrees.collect())
            }
            Self::Number(value) => number(*value, 1.0),
            Self::Count(count) => count.to_string(),
        }
    }

    /// One value, or a list of several.
    fn to_json(&self) -> Value {
        match self {
            Self::Lengths(list) | Self::Angles(list) => match list.as_slice() {
                [one] => json!(one),
                several => json!(several),
            },
            Self::Directions(list) => match list.as_slice() {
                [one] => json!(one.to_array()),
                several => several.iter().map(|d| json!(d.to_array())).collect(),
            },
            Self::Point(point) => json!(point.to_array()),
            Self::Number(value) => json!(value),
            Self::Count(count) => json!(count),
        }
    }
}

fn quadric(form: &QuadricForm) -> (&'static str, Vec<(&'static str, Quantity)>) {
    use Quantity::{Angles, Directions, Lengths, Number, Point};
    let [a, b, c] = form.sizes;
    let [x, y, z] = form.axes;
    let center = ("center", Point(form.center));
    let on_axis = ("point", Point(form.center));
    let vertex = ("vertex", Point(form.center));
    let axes = ("axes", Directions(form.axes.to_vec()));
    let axis = ("axis", Directions(vec![z]));
    let across = ("axes", Directions(vec![x, y]));
    let three = ("semi_axes", Lengths(vec![a, b, c]));
    let two = ("semi_axes", Lengths(vec![a, b]));
    let radii = ("vertex_radii", Lengths(vec![a, b]));
    match form.kind {
        QuadricKind::Ellipsoid => ("ellipsoid", vec![center, axes, three]),
        QuadricKind::ImaginaryEllipsoid => ("imaginary ellipsoid", vec![center, axes, three]),
        QuadricKind::HyperboloidOfOneSheet => {
            ("hyperboloid of one sheet", vec![center, axes, three])
        }
        QuadricKind::HyperboloidOfTwoSheets => {
            ("hyperboloid of two sheets", vec![center, axes, three])
        }
        QuadricKind::EllipticCone => {
            let angles = ("half_angles_rad", Angles(vec![a.atan(), b.atan()]));
            let apex = ("apex", Point(form.center));
            ("elliptic cone", vec![apex, axes, angles])
        }
        QuadricKind::Point => ("point", vec![center]),
        QuadricKind::EllipticParaboloid => ("elliptic paraboloid", vec![vertex, axes, radii]),
        QuadricKind::HyperbolicParaboloid => ("hyperbolic paraboloid", vec![vertex, axes, radii]),
        QuadricKind::EllipticCylinder => ("elliptic cylinder", vec![on_axis, axis, across, two]),
        QuadricKind::ImaginaryCylinder => ("imaginary cylinder", vec![on_axis, axis, across, two]),
        QuadricKind::HyperbolicCylinder => {
            ("hyperbolic cylinder", vec![on_axis, axis, across, two])
        }
        QuadricKind::ParabolicCylinder => {
            let radius = ("vertex_radius", Lengths(vec![a]));
            let opens = ("opens_along", Directions(vec![z]));
            let rulings = ("axis", Directions(vec![y]));
            ("parabolic cylinder", vec![vertex, rulings, opens, radius])
        }
        QuadricKind::Line => {
            let ratio = ("flatness", Number(a));
            ("line", vec![on_axis, axis, ratio])
        }
        QuadricKind::ImaginaryPlanes => {
            let distance = ("half_distance", Lengths(vec![a]));
            let normal = ("normal", Directions(vec![x]));
            ("imaginary planes", vec![on_axis, normal, distance])
        }
        QuadricKind::CrossingPlanes => {
            let angle = ("half_angle_rad", Angles(vec![a]));
            let (normals, offsets) = planes(form);
            (
                "crossing planes",
                vec![on_axis, axis, normals, offsets, angle],
            )
        }
        QuadricKind::ParallelPlanes => {
            let (normals, offsets) = planes(form);
            ("parallel planes", vec![normals, offsets])
        }
        QuadricKind::DoublePlane => {
            let (normals, offsets) = planes(form);
            ("double plane", vec![normals, offsets])
        }
    }
}

/// The normals and offsets of a pair of planes.
fn planes(form: &QuadricForm) -> ((&'static str, Quantity), (&'static str, Quantity)) {
    let planes = form.planes().into_iter().flatten();
    let (normals, offsets) = planes.unzip();
    (
        ("normals", Quantity::Directions(normals)),
        ("offsets", Quantity::Lengths(offsets)),
    )
}
