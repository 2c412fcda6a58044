//! Surfaces that STEP can say.

use super::cut::Cut;
use super::quadric::{self, Found, Quadric};
use super::region::Region;
use super::revolution;
use super::seam;
use brep::{Brep, Curve, ExactBrep, ExactFace, FacetView, Valid};
use csg::{Sense, Solid, Surface};
use glam::DVec3;
use step_io::build::{FaceBoundInput, Frame, SurfaceInput};
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
    /// Where its only loop is joined to a pole.
    pub(super) cut: Option<Cut>,
}

/// Radii in model units, angles in radians.
#[derive(Clone)]
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
        _ => {
            let found = match surface {
                Surface::Torus {
                    center,
                    axis,
                    ring,
                    tube,
                } => {
                    let across = seam::direction(exact, face, center, axis);
                    revolution::spindle([center, axis, across], [ring, tube], inside)
                }
                Surface::Quadric(form) => {
                    let at = farthest(facet, form.center);
                    let region = Region::of(brep, exact, face);
                    quadric::of(&form, exact, face, &region, at)
                }
                _ => None,
            };
            let degree = primitive.polynomial.degree();
            let found = found
                .ok_or_else(|| format!("surface {id}, of degree {degree}, has no form in STEP"))?;
            let gradient = |at| primitive.polynomial.gradient(solid.domain.to_centered(at));
            return Ok(Described::of_quadric(found, face, gradient));
        }
    };
    let gradient = primitive.polynomial.gradient(solid.domain.to_centered(at));
    let orientation = orientation(face, outward, gradient);
    let across = seam::direction(exact, face, origin, axis);
    Ok(Described {
        form,
        origin,
        axis,
        across,
        orientation,
        cut: None,
    })
}

/// Whether STEP's normal looks out of the solid: the polynomial grows out of it if that is inside.
fn orientation(face: &ExactFace, outward: DVec3, gradient: DVec3) -> Orientation {
    let along = outward.dot(gradient) > 0.0;
    if along == (face.sense == Sense::Inside) {
        Orientation::Forward
    } else {
        Orientation::Reversed
    }
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
    fn of_quadric(found: Found, face: &ExactFace, gradient: impl Fn(DVec3) -> DVec3) -> Self {
        Self {
            orientation: orientation(face, found.outward, gradient(found.at)),
            form: Form::Quadric(found.quadric),
            origin: found.origin,
            axis: found.axis,
            across: found.across,
            cut: found.cut,
        }
    }

    pub(super) fn is_plane(&self) -> bool {
        matches!(self.form, Form::Plane)
    }

    /// Whether the surface can be a face without edges.
    pub(super) fn is_closed(&self) -> bool {
        matches!(
            self.form,
            Form::Sphere { .. }
                | Form::Torus { .. }
                | Form::Quadric(Quadric::Ellipsoid(_) | Quadric::Revolution(_))
        )
    }

    /// Whether readers find a conic's image on the surface's parameters only by interpolating it: a
    /// circle about the axis is a line there.
    pub(super) fn bends(&self, curve: &Curve) -> bool {
        let (Curve::Circle { across, .. } | Curve::Ellipse { across, .. }) = curve else {
            return false;
        };
        match &self.form {
            Form::Sphere { .. } | Form::Quadric(Quadric::Revolution(_)) => {
                let normal = across[0].cross(across[1]).normalize_or_zero();
                self.axis.cross(normal).length() > 1e-9
            }
            Form::Quadric(Quadric::Ellipsoid(_) | Quadric::Patch(_) | Quadric::Closed(_)) => true,
            _ => false,
        }
    }

    /// What the surface is in the file, if not an elementary surface.
    pub(super) fn entity(&self) -> Option<&'static str> {
        match &self.form {
            Form::Quadric(quadric) => Some(quadric.entity()),
            _ => None,
        }
    }

    /// The surface for a face with loops, in millimetres.
    pub(super) fn input(&self, scale: f64) -> Result<SurfaceInput, AuthorError> {
        let frame = Frame {
            origin: (self.origin * scale + DVec3::ZERO).to_array(),
            axis: (self.axis + DVec3::ZERO).to_array(),
            ref_dir: (self.across + DVec3::ZERO).to_array(),
        };
        Ok(match &self.form {
            Form::Quadric(quadric) => {
                let input = quadric.input(self.origin, self.axis, scale);
                input.ok_or(AuthorError::InvalidInput {
                    reason: "a spline reaches to infinity",
                })?
            }
            Form::Plane => SurfaceInput::Plane(frame),
            Form::Cylinder { radius } => SurfaceInput::Cylinder(frame, radius * scale),
            Form::Cone {
                radius,
                half_angle_rad,
            } => SurfaceInput::Cone(frame, radius * scale, *half_angle_rad),
            Form::Sphere { radius } => SurfaceInput::Sphere(frame, radius * scale),
            Form::Torus { ring, tube } => SurfaceInput::Torus(frame, ring * scale, tube * scale),
        })
    }

    /// All of a surface with two poles: its loop runs from one to the other and back.
    fn between_poles(
        &self,
        quadric: &Quadric,
        builder: &mut StepBuilder,
        scale: f64,
    ) -> Result<m::AdvancedFaceId, AuthorError> {
        let (curve, ends) =
            quadric
                .closing(self.origin, scale)
                .ok_or(AuthorError::InvalidInput {
                    reason: "a closed face on a surface that is not closed",
                })?;
        let [from, to] = [builder.vertex(ends[0])?, builder.vertex(ends[1])?];
        let meridian = builder.edge(from, to, curve)?;
        let ring = vec![
            (meridian, Orientation::Forward),
            (meridian, Orientation::Reversed),
        ];
        let bounds = vec![FaceBoundInput::outer(ring)];
        builder.face(self.input(scale)?, self.orientation, bounds)
    }

    /// A face without edges: all of a sphere or torus, whose loop is a single vertex.
    pub(super) fn whole(
        &self,
        builder: &mut StepBuilder,
        scale: f64,
    ) -> Result<m::AdvancedFaceId, AuthorError> {
        if let Form::Quadric(quadric) = &self.form {
            return self.between_poles(quadric, builder, scale);
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
