//! Closed surfaces cut open along a meridian.

use super::describe::point;
use super::exact::{EdgeChains, Part};
use super::rational::Rational;
use super::{Error, File, refused};
use glam::DVec3;
use step_io::Orientation;
use step_io::build::CurveInput;

/// A meridian from one loop of a face to another one, or to a pole: all of them become one loop.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    /// Where it meets the face's loops, of which there are one or two.
    pub(super) starts: Vec<Start>,
    /// Where it ends if there is one loop.
    pub(super) pole: Option<DVec3>,
    /// From lower to higher parameters.
    pub(super) curve: Box<Rational>,
    /// Whether the curve runs to the first loop, instead of away from it.
    pub(super) is_reversed: bool,
}

/// A point of a loop.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Start {
    /// Which loop.
    pub(super) ring: usize,
    /// The half-edge in it.
    pub(super) place: usize,
    /// The parameter on the half-edge's edge; `None` where the half-edge begins.
    pub(super) parameter: Option<f64>,
}

impl File<'_> {
    /// The only bound of a face that is cut open.
    pub(super) fn cut_bound(
        &mut self,
        cut: &Cut,
        loops: &[Vec<usize>],
        edges: &EdgeChains,
    ) -> Result<Vec<(step_io::model::EdgeCurveId, Orientation)>, Error> {
        let mut chains = Vec::with_capacity(2);
        for start in &cut.starts {
            let ring = &loops[start.ring];
            let mut chain: Vec<Part> = Vec::new();
            for at in 0..ring.len() {
                let half_edge = ring[(start.place + at) % ring.len()];
                let parts = edges[&(half_edge / 2)].along(half_edge);
                chain.extend(parts);
            }
            if let Some(parameter) = start.parameter {
                let half_edge = ring[start.place];
                let skipped = edges[&(half_edge / 2)].before(half_edge, parameter);
                chain.rotate_left(skipped);
            }
            chains.push(chain);
        }
        let mut ends = Vec::with_capacity(2);
        for chain in &chains {
            ends.extend(chain.first().map(|part| part.start));
        }
        if let Some(pole) = cut.pole {
            let pole = self.builder.vertex(point(pole, self.scale));
            ends.push(pole.map_err(refused)?);
        }
        let impossible = |reason: &str| Error::Step {
            reason: reason.to_owned(),
        };
        let [first, second] = ends[..] else {
            return Err(impossible("a meridian has no ends"));
        };
        let curve = cut.curve.curve(self.scale);
        let curve = curve.ok_or_else(|| impossible("a meridian reaches to infinity"))?;
        let (there, back) = (Orientation::Forward, Orientation::Reversed);
        let ([from, to], [go, come]) = if cut.is_reversed {
            ([second, first], [back, there])
        } else {
            ([first, second], [there, back])
        };
        let seam = self.builder.edge(from, to, CurveInput::Nurbs(curve));
        let seam = seam.map_err(refused)?;
        let mut bound = Vec::new();
        for (chain, orientation) in chains.iter().zip([go, come]) {
            bound.extend(chain.iter().map(|part| (part.id, part.orientation)));
            bound.push((seam, orientation));
        }
        if chains.len() == 1 {
            bound.push((seam, come));
        }
        Ok(bound)
    }
}
