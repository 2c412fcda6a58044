//! Surfaces that STEP can say.

use super::quadric::{self, Quadric};
use super::seam;
use brep::{Brep, Curve, ExactBrep, ExactFace, FacetView, Valid};
use csg::{Sense, Solid, Surface};
use glam::DVec3;
use step_io::build::{CurveInput, FaceBoundInput, Frame, SurfaceInput};
use step_io::model as m;
use step_io::{AuthorError, Orientation, StepBuilder};

/// A surface in STEP's terms, in model units.
pub(super) struct Described {
    form: Form,
    /// Where its local system stands.
    origin: DVec3,
    /// The local system's z.
    axis: DVec3,
    /// The local system's x: on periodic surfaces the side of the seam.
    across: DVec3,
    /// Whether the face's normal is the surface's.
    pub(super) orientation: Orientation,
}

/// Radii in model units, angles in radians.
#[derive(Clone, Copy)]
enum Form {
    Plane,
    Cylinder { radius: f64 },
    Cone { radius: f64, half_angle_rad: f64 },
    Sphere { radius: f64 },
    Torus { ring: f64, tube: f64 },
    Quadric(Quadric),
}

/// The surface of a face, or why there is none.
pub(super) fn describe(
    brep: &Valid<Brep>,
    solid: &Solid,
    exact: &ExactBrep,
    face: &ExactFace,
) -> Result<Described, String> {
    let id = face.primitive.0;
    let primitive = solid.primitives.get(id as usize);
    let primitive = primitive.ok_or_else(|| format!("surface {id} is unknown"))?;
    let facet = brep.facet(face.facet);
    let inside = farthest(facet, DVec3::ZERO);
    let surface = primitive.surface(&solid.domain);
    // Its form, where it stands, and the direction in which STEP's normal looks at a point.
    let (form, origin, axis, outward, at) = match surface {
        Surface::Plane { normal, offset } => (Form::Plane, normal * offset, normal, normal, inside),
        Surface::Sphere { center, radius } => (
            Form::Sphere { radius },
            center,
            pole(exact, face),
            inside - center,
            inside,
        ),
        Surface::Cylinder {
            point,
            axis,
            radius,
        } => {
            let outward = (inside - point).reject_from_normalized(axis);
            (Form::Cylinder { radius }, point, axis, outward, inside)
        }
        Surface::Cone {
            apex,
            axis,
            half_angle_rad,
        } => {
            let at = farthest(facet, apex);
            let height = (at - apex).dot(axis);
            let axis = axis * height.signum();
            let height = height.abs();
            let outward = (at - apex).reject_from_normalized(axis);
            let form = Form::Cone {
                radius: height * half_angle_rad.tan(),
                half_angle_rad,
            };
            (form, apex + axis * height, axis, outward, at)
        }
        Surface::Torus {
            center,
            axis,
            ring,
            tube,
        } if ring > tube => {
            let on_ring = (inside - center).reject_from_normalized(axis);
            let outward = inside - center - on_ring.normalize_or_zero() * ring;
            (Form::Torus { ring, tube }, center, axis, outward, inside)
        }
        Surface::Torus { .. } => {
            return Err(format!("surface {id} is a torus that crosses itself"));
        }
        Surface::Quadric(form)
            if let Some((quadric, outward)) =
                quadric::of(&form, exact, face, farthest(facet, form.center)) =>
        {
            let at = farthest(facet, form.center);
            (
                Form::Quadric(quadric),
                form.center,
                form.axes[2],
                outward,
                at,
            )
        }
        _ => {
            let degree = primitive.polynomial.degree();
            return Err(format!(
                "surface {id}, of degree {degree}, has no form in STEP"
            ));
        }
    };
    let gradient = primitive.polynomial.gradient(solid.domain.to_centered(at));
    let along = outward.dot(gradient) > 0.0;
    let is_forward = along == (face.sense == Sense::Inside);
    let orientation = if is_forward {
        Orientation::Forward
    } else {
        Orientation::Reversed
    };
    let across = seam::direction(exact, face, origin, axis);
    Ok(Described {
        form,
        origin,
        axis,
        across,
        orientation,
    })
}

/// The axis of a sphere whose edges on this face are circles of latitude, if they are: other
/// programs cut spheres along a meridian, and circles that cross it lose digits.
fn pole(exact: &ExactBrep, face: &ExactFace) -> DVec3 {
    let mut axis: Option<DVec3> = None;
    for half_edge in face.loops.iter().flatten() {
        let Curve::Circle { across: [x, y], .. } = exact.edges[half_edge / 2].piece.curve else {
            return DVec3::Z;
        };
        let normal = x.cross(y).normalize_or(DVec3::Z);
        match axis {
            Some(axis) if axis.cross(normal).length() > 1e-9 => return DVec3::Z,
            _ => axis = Some(normal),
        }
    }
    axis.unwrap_or(DVec3::Z)
}

/// The corner of a facet that is farthest from a point.
fn farthest(facet: FacetView<'_>, from: DVec3) -> DVec3 {
    let [a, b, c] = facet.positions();
    [b, c].into_iter().fold(a, |best, corner| {
        if corner.distance(from) > best.distance(from) {
            corner
        } else {
            best
        }
    })
}

impl Described {
    pub(super) fn is_plane(&self) -> bool {
        matches!(self.form, Form::Plane)
    }

    /// Whether the surface can be a face without edges.
    pub(super) fn is_closed(&self) -> bool {
        matches!(
            self.form,
            Form::Sphere { .. } | Form::Torus { .. } | Form::Quadric(Quadric::Ellipsoid(_))
        )
    }

    /// The surface for a face with loops, in millimetres.
    pub(super) fn input(&self, scale: f64) -> SurfaceInput {
        let frame = Frame {
            origin: (self.origin * scale + DVec3::ZERO).to_array(),
            axis: (self.axis + DVec3::ZERO).to_array(),
            ref_dir: (self.across + DVec3::ZERO).to_array(),
        };
        match self.form {
            Form::Quadric(quadric) => quadric.input(self.origin, scale),
            Form::Plane => SurfaceInput::Plane(frame),
            Form::Cylinder { radius } => SurfaceInput::Cylinder(frame, radius * scale),
            Form::Cone {
                radius,
                half_angle_rad,
            } => SurfaceInput::Cone(frame, radius * scale, half_angle_rad),
            Form::Sphere { radius } => SurfaceInput::Sphere(frame, radius * scale),
            Form::Torus { ring, tube } => SurfaceInput::Torus(frame, ring * scale, tube * scale),
        }
    }

    /// All of an ellipsoid: its loop runs from pole to pole and back.
    fn whole_ellipsoid(
        &self,
        [x, _, pole]: [DVec3; 3],
        builder: &mut StepBuilder,
        scale: f64,
    ) -> Result<m::AdvancedFaceId, AuthorError> {
        let end = |side: f64| ((self.origin + pole * side) * scale).to_array();
        let [from, to] = [builder.vertex(end(-1.0))?, builder.vertex(end(1.0))?];
        let frame = Frame {
            origin: (self.origin * scale).to_array(),
            axis: x.cross(pole).normalize().to_array(),
            ref_dir: x.normalize().to_array(),
        };
        let (a, c) = (x.length() * scale, pole.length() * scale);
        let meridian = builder.edge(from, to, CurveInput::Ellipse(frame, a, c))?;
        let ring = vec![
            (meridian, Orientation::Forward),
            (meridian, Orientation::Reversed),
        ];
        let bounds = vec![FaceBoundInput::outer(ring)];
        builder.face(self.input(scale), self.orientation, bounds)
    }

    /// A face without edges: all of a sphere or torus, whose loop is a single vertex.
    pub(super) fn whole(
        &self,
        builder: &mut StepBuilder,
        scale: f64,
    ) -> Result<m::AdvancedFaceId, AuthorError> {
        if let Form::Quadric(Quadric::Ellipsoid(axes)) = self.form {
            return self.whole_ellipsoid(axes, builder, scale);
        }
        let x = self.across;
        let origin = self.origin * scale;
        let author = builder.author();
        let location = author.add_cartesian_point("", origin.to_array().into())?;
        let z = author.add_direction("", self.axis.to_array().into())?;
        let reference = author.add_direction("", x.to_array().into())?;
        let placement = author.add_axis2_placement3d(
            "",
            m::CartesianPointRef::CartesianPoint(location),
            Some(m::DirectionRef::Direction(z)),
            Some(m::DirectionRef::Direction(reference)),
        )?;
        let position = m::Axis2Placement3dRef::Axis2Placement3d(placement);
        let (surface, vertex) = match self.form {
            Form::Sphere { radius } => {
                let radius = radius * scale;
                let surface = author.add_spherical_surface("", position, radius)?;
                let pole = origin - self.axis * radius;
                (m::SurfaceRef::SphericalSurface(surface), pole)
            }
            Form::Torus { ring, tube } => {
                let (ring, tube) = (ring * scale, tube * scale);
                let surface = author.add_toroidal_surface("", position, ring, tube)?;
                let outermost = origin + x * (ring + tube);
                (m::SurfaceRef::ToroidalSurface(surface), outermost)
            }
            _ => {
                return Err(AuthorError::InvalidInput {
                    reason: "a closed face on a surface that is not closed",
                });
            }
        };
        let point = author.add_cartesian_point("", vertex.to_array().into())?;
        let vertex = author.add_vertex_point("", m::PointRef::CartesianPoint(point))?;
        let ring = author.add_vertex_loop("", m::VertexRef::VertexPoint(vertex))?;
        let bound = author.add_face_bound("", m::LoopRef::VertexLoop(ring), true)?;
        let forward = matches!(self.orientation, Orientation::Forward);
        author.add_advanced_face(
            "",
            vec![m::FaceBoundRef::FaceBound(bound)],
            surface,
            forward,
        )
    }
}
