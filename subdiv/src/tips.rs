//! Tips: a cone ends in its apex.
//!
//! The leaf mesh is near enough to an apex (`crate::nappe`), but what interpolants make of the place
//! where two nappes meet may be blunt, or have a handle. A nappe is made of rays from the apex, so
//! what is within a loop around the axis is replaced by the fan of the loop's edges and the apex: at
//! the part s of the way from the apex it is off by s times what the loop is.

use crate::fragments::{Fragments, Triangle, VertexKind};
use crate::nappe::DoubleCone;
use csg::Domain;
use glam::{DVec2, DVec3};
use rustc_hash::{FxHashMap, FxHashSet};

/// Radii of the loops that are tried, in units of what the apex' cells reach: each is so much
/// smaller than the one before.
const FIRST: f64 = 1.5;
const NEXT: f64 = 0.85;
const TRIES: i32 = 14;

/// How far around its apex a cone's leaf mesh is not to be trusted, in the domain's own units;
/// infinite where the cone is not alone there.
#[derive(Debug, Default)]
pub(crate) struct Tips(FxHashMap<u32, f64>);

impl Tips {
    /// Notes a cell that reaches so far from the apex of a primitive.
    pub(crate) fn push(&mut self, primitive: u32, reach: f64) {
        let known = self.0.entry(primitive).or_default();
        *known = known.max(reach);
    }

    pub(crate) fn append(&mut self, other: Self) {
        for (primitive, reach) in other.0 {
            self.push(primitive, reach);
        }
    }
}

/// Replaces the mesh around each apex where that is possible.
///
/// Cost: linear in triangles and tips, if these are apart.
pub(crate) fn sharpen(
    fragments: &mut Fragments,
    tips: &Tips,
    cones: &[Option<DoubleCone>],
    domain: &Domain,
) {
    let cone = |primitive: u32| cones.get(primitive as usize)?.as_ref();
    let mut tips: Vec<Tip<'_>> = (tips.0.iter())
        .filter(|(_, reach)| reach.is_finite())
        .filter_map(|(&primitive, &reach)| {
            let cone = cone(primitive)?;
            Some(Tip {
                cone,
                primitive,
                apex: domain.from_unit(cone.apex()),
                reach: FIRST * reach * domain.size(),
                near: Vec::new(),
            })
        })
        .collect();
    tips.sort_unstable_by_key(|tip| tip.primitive);
    find_near(&mut tips, fragments);
    let mut removed = vec![false; fragments.triangles.len()];
    for tip in tips {
        let radius = |at: i32| tip.reach * NEXT.powi(at);
        let Some(fan) = (0..TRIES).find_map(|at| tip.fan(fragments, radius(at))) else {
            continue;
        };
        if fan.gone.iter().any(|&at| removed[at]) {
            continue;
        }
        for &at in &fan.gone {
            removed[at] = true;
        }
        let center = fragments.positions.len() as u32;
        fragments.positions.push(tip.apex);
        fragments.kinds.push(VertexKind::Interior);
        let of = |[a, b]: [u32; 2]| Triangle {
            vertices: [a, b, center],
            ..fan.label
        };
        fragments.triangles.extend(fan.edges.into_iter().map(of));
    }
    let mut removed = removed.into_iter();
    (fragments.triangles).retain(|_| !removed.next().unwrap_or(false));
    fragments.drop_lonely_vertices();
}

/// Fills the tips' lists of triangles.
fn find_near(tips: &mut [Tip<'_>], fragments: &Fragments) {
    let size = tips.iter().map(|tip| tip.reach).fold(0.0, f64::max);
    let cube = |p: DVec3| (p / size).to_array().map(|x| x.floor() as i64);
    let mut around: FxHashMap<[i64; 3], Vec<usize>> = FxHashMap::default();
    for (at, tip) in tips.iter().enumerate() {
        let [x, y, z] = cube(tip.apex);
        for k in 0..27 {
            let key = [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1];
            around.entry(key).or_default().push(at);
        }
    }
    for (at, triangle) in fragments.triangles.iter().enumerate() {
        for v in triangle.vertices {
            let position = fragments.positions[v as usize];
            for &tip in around.get(&cube(position)).into_iter().flatten() {
                let tip = &mut tips[tip];
                if tip.near.last() != Some(&at) && position.distance(tip.apex) <= tip.reach {
                    tip.near.push(at);
                }
            }
        }
    }
}

struct Tip<'a> {
    cone: &'a DoubleCone,
    primitive: u32,
    /// In model units.
    apex: DVec3,
    /// The largest radius.
    reach: f64,
    /// The triangles with a corner within it.
    near: Vec<usize>,
}

/// What takes the place of the triangles around an apex.
struct Fan {
    /// The triangles that go.
    gone: Vec<usize>,
    /// The loop's edges as those triangles have them.
    edges: Vec<[u32; 2]>,
    label: Triangle,
}

impl Tip<'_> {
    /// Around the axis, and along it.
    fn place(&self, position: DVec3) -> (DVec2, f64) {
        self.cone.across_and_along(position - self.apex)
    }

    /// In place of the triangles with a corner within the radius, if one loop that goes once
    /// around the axis ends them, and all are the cone's.
    fn fan(&self, fragments: &Fragments, radius: f64) -> Option<Fan> {
        let is_near = |v: &u32| fragments.positions[*v as usize].distance(self.apex) <= radius;
        let triangle = |at: &usize| fragments.triangles[*at];
        let gone = self.near.iter().copied();
        let gone: Vec<usize> = gone
            .filter(|at| triangle(at).vertices.iter().any(is_near))
            .collect();
        let label = gone
            .iter()
            .map(triangle)
            .find(|t| t.primitive.0 == self.primitive)?;
        // The plane through the apex bounds nothing there.
        let plane = self.cone.apex_plane();
        let is_cone = |t: Triangle| {
            (t.primitive, t.sense, t.material) == (label.primitive, label.sense, label.material)
                || Some(t.primitive) == plane
        };
        if !gone.iter().map(triangle).all(is_cone) {
            return None;
        }
        let mut edges: FxHashSet<[u32; 2]> = FxHashSet::default();
        for at in &gone {
            let [a, b, c] = triangle(at).vertices;
            for [from, to] in [[a, b], [b, c], [c, a]] {
                if !edges.remove(&[to, from]) {
                    edges.insert([from, to]);
                }
            }
        }
        let next: FxHashMap<u32, u32> = edges.iter().map(|&[from, to]| (from, to)).collect();
        let start = next.keys().copied().min()?;
        let mut ring = vec![start];
        while ring.len() <= next.len() {
            let to = *next.get(ring.last()?)?;
            if to == start {
                break;
            }
            ring.push(to);
        }
        if ring.len() != edges.len() || !self.goes_around(fragments, &ring) {
            return None;
        }
        let following = ring.iter().cycle().skip(1);
        let edges = ring.iter().zip(following).map(|(&a, &b)| [a, b]).collect();
        Some(Fan { gone, edges, label })
    }

    /// Whether a ring goes around the axis once, without turning back, on one side of the apex.
    fn goes_around(&self, fragments: &Fragments, ring: &[u32]) -> bool {
        let places = ring
            .iter()
            .map(|v| self.place(fragments.positions[*v as usize]));
        let places: Vec<(DVec2, f64)> = places.collect();
        let side = places[0].1.signum();
        let turns: Vec<f64> = (places.iter().zip(places.iter().cycle().skip(1)))
            .map(|((a, _), (b, _))| a.perp_dot(*b).atan2(a.dot(*b)))
            .collect();
        let sum: f64 = turns.iter().sum();
        // Half a turn at once would pass the axis.
        let onward = turns
            .iter()
            .all(|turn| turn * sum > 0.0 && turn.abs() < 3.0);
        let once = (sum.abs() - std::f64::consts::TAU).abs() < 1e-6;
        let same_side = places.iter().all(|(_, along)| along * side > 0.0);
        onward && once && same_side
    }
}
