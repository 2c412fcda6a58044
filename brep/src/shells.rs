//! Connected components of the boundary, which of them are cavities, and of what solid.

mod nesting;

use crate::euler::EulerCharacteristic;
use crate::sum::Sum;
use crate::topology::{Brep, FacetKey};
use crate::validate::Valid;
use csg::Aabb;
use slotmap::SecondaryMap;

/// Index of a shell in [`Shells::shells`].
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct ShellId(pub u32);

/// What a shell bounds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ShellRole {
    /// A solid from outside.
    Outer,
    /// A cavity: its facets look inward, its signed volume is negative.
    Void,
}

/// A connected component of the boundary.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Shell {
    /// Its first facet.
    pub facet: FacetKey,
    /// How many vertices, edges and facets it has.
    pub counts: EulerCharacteristic,
    /// Number of handles.
    pub genus: u64,
    /// Signed volume, negative for voids, in cubic model units.
    pub volume: f64,
    /// Its bounding box.
    pub bounds: Aabb,
    /// What it bounds.
    pub role: ShellRole,
}

/// A connected piece of matter: an outer shell and the cavities inside it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Solid {
    /// The shell that bounds it from outside.
    pub outer: ShellId,
    /// Its cavities, in shell order.
    pub voids: Vec<ShellId>,
}

/// The shells of a boundary and the solids they make.
#[derive(Clone, Debug)]
pub struct Shells {
    /// All shells, in the order of their first facets.
    pub shells: Vec<Shell>,
    /// All solids, in the order of their outer shells.
    pub solids: Vec<Solid>,
    /// Voids that lie in no outer shell; a boundary that encloses matter has none. Shells of
    /// (almost) no volume can get here by rounding.
    pub stray_voids: Vec<ShellId>,
    /// The shell of each facet.
    pub shell_of: SecondaryMap<FacetKey, ShellId>,
}

impl Shells {
    /// Finds shells, their roles by signed volume, and the solid of each void by containment.
    ///
    /// Cost: linear, plus for each void one pass over the outer shells whose boxes hold it, if
    /// there are several.
    pub fn of(brep: &Valid<Brep>) -> Self {
        let components = Components::of(brep);
        let mut bounds = vec![Aabb::EMPTY; components.first.len()];
        for (key, &component) in &components.component_of {
            let bounds = &mut bounds[component as usize];
            for position in brep.facet(key).positions() {
                bounds.min = bounds.min.min(position);
                bounds.max = bounds.max.max(position);
            }
        }
        let volumes = signed_volumes(brep, &components, &bounds);
        let shells: Vec<Shell> = (0..components.first.len())
            .map(|at| Shell {
                facet: components.first[at],
                counts: components.counts[at],
                genus: components.counts[at].genus().unwrap_or(0),
                volume: volumes[at],
                bounds: bounds[at],
                role: if volumes[at] < 0.0 {
                    ShellRole::Void
                } else {
                    ShellRole::Outer
                },
            })
            .collect();
        let mut shell_of = SecondaryMap::with_capacity(components.component_of.capacity());
        for (key, &component) in &components.component_of {
            shell_of.insert(key, ShellId(component));
        }
        let (solids, stray_voids) = nesting::solids(brep, &shells, &shell_of);
        Self {
            shells,
            solids,
            stray_voids,
            shell_of,
        }
    }

    /// Handles of all shells together.
    pub fn genus(&self) -> u64 {
        self.shells.iter().map(|shell| shell.genus).sum()
    }
}

/// Volumes by the divergence theorem, each relative to its shell's box centre; zero where the
/// rounding of positions alone could have made it, so that a speck is no void by chance.
fn signed_volumes(brep: &Brep, components: &Components, bounds: &[Aabb]) -> Vec<f64> {
    let mut sums = vec![Sum::default(); bounds.len()];
    for (key, &component) in &components.component_of {
        let Aabb { min, max } = bounds[component as usize];
        let centre = min + (max - min) * 0.5;
        let [a, b, c] = brep
            .facet(key)
            .positions()
            .map(|position| position - centre);
        sums[component as usize].add(a.dot(b.cross(c)));
    }
    let volumes = sums
        .into_iter()
        .zip(bounds)
        .map(|(sum, Aabb { min, max })| {
            let volume = sum.value() / 6.0;
            let [x, y, z] = (*max - *min).to_array();
            let farthest = min.abs().max(max.abs()).max_element();
            // Each face of the box moved by a few units in the last place.
            let rounding = 8.0 * f64::EPSILON * farthest * 2.0 * (x * y + y * z + z * x);
            if volume.abs() > rounding { volume } else { 0.0 }
        });
    volumes.collect()
}

/// The connected components alone, without any coordinates.
pub(crate) struct Components {
    /// The first facet of each.
    pub(crate) first: Vec<FacetKey>,
    /// Element counts of each.
    pub(crate) counts: Vec<EulerCharacteristic>,
    /// Component of each facet.
    pub(crate) component_of: SecondaryMap<FacetKey, u32>,
}

impl Components {
    pub(crate) fn of(brep: &Brep) -> Self {
        let mut this = Self {
            first: Vec::new(),
            counts: Vec::new(),
            component_of: SecondaryMap::with_capacity(brep.facets.capacity()),
        };
        let mut stack = Vec::new();
        for seed in brep.facets.keys() {
            if this.component_of.contains_key(seed) {
                continue;
            }
            // Facets, hence shells, are fewer than 2^32: slotmap keys have 32-bit indices.
            let component = u32::try_from(this.first.len()).unwrap_or(u32::MAX);
            this.first.push(seed);
            this.component_of.insert(seed, component);
            stack.push(seed);
            let mut facets = 0;
            while let Some(key) = stack.pop() {
                facets += 1;
                for neighbour in brep.facet(key).neighbours() {
                    if this
                        .component_of
                        .insert(neighbour.key(), component)
                        .is_none()
                    {
                        stack.push(neighbour.key());
                    }
                }
            }
            this.counts.push(EulerCharacteristic {
                vertices: 0,
                edges: facets * 3 / 2,
                facets,
            });
        }
        for vertex in brep.vertices() {
            let facet = vertex.outgoing().facet().key();
            if let Some(&component) = this.component_of.get(facet) {
                this.counts[component as usize].vertices += 1;
            }
        }
        this
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{cube, inside_out, moved, sphere, together, torus};
    use crate::stitch;
    use glam::DVec3;
    use subdiv::Fragments;

    fn shells(parts: &[Fragments]) -> Shells {
        let brep = stitch(&together(parts))
            .expect("closed")
            .validate()
            .expect("valid");
        Shells::of(&brep)
    }

    fn void(fragments: Fragments) -> Fragments {
        inside_out(fragments)
    }

    #[test]
    fn genus_counts_handles() {
        assert_eq!(shells(&[cube([0.0; 3], 1.0)]).genus(), 0);
        assert_eq!(shells(&[torus(2.0, 0.5, 9, 6)]).genus(), 1);
    }

    #[test]
    fn linked_tori_are_two_solids() {
        let second = moved(torus(2.0, 0.5, 12, 8), |p| DVec3::new(p.x + 2.0, -p.z, p.y));
        let shells = shells(&[torus(2.0, 0.5, 12, 8), second]);
        assert_eq!(
            (shells.shells.len(), shells.solids.len(), shells.genus()),
            (2, 2, 2)
        );
        assert!(shells.solids.iter().all(|solid| solid.voids.is_empty()));
    }

    #[test]
    fn a_cavity_is_a_void_of_its_solid() {
        let shells = shells(&[cube([0.0; 3], 2.0), void(cube([0.5; 3], 1.0))]);
        assert_eq!(shells.shells[1].role, ShellRole::Void);
        assert!((shells.shells[1].volume + 8.0).abs() < 1e-14);
        assert_eq!(
            shells.solids,
            [Solid {
                outer: ShellId(0),
                voids: vec![ShellId(1)]
            }]
        );
    }

    #[test]
    fn solids_in_cavities_nest() {
        // Russian dolls, and a cavity in a neighbour whose box holds nothing else.
        let shells = shells(&[
            cube([0.0; 3], 5.0),
            void(cube([0.0; 3], 4.0)),
            cube([0.0; 3], 3.0),
            void(cube([0.0; 3], 2.0)),
            cube([20.0; 3], 5.0),
            void(sphere(2)),
            void(cube([21.0; 3], 1.0)),
        ]);
        let solid = |outer, voids: &[u32]| Solid {
            outer: ShellId(outer),
            voids: voids.iter().copied().map(ShellId).collect(),
        };
        assert_eq!(
            shells.solids,
            [solid(0, &[1]), solid(2, &[3, 5]), solid(4, &[6])]
        );
        assert!(shells.stray_voids.is_empty());
    }

    #[test]
    fn boxes_do_not_decide_alone() {
        // The hole of the first torus holds a ball with a cavity: both boxes hold the cavity.
        let ball = |radius: f64| moved(sphere(2), move |p| p * radius);
        let shells = shells(&[torus(2.0, 0.9, 24, 16), ball(0.8), void(ball(0.4))]);
        assert_eq!(shells.solids[0].voids, []);
        assert_eq!(shells.solids[1].voids, [ShellId(2)]);
    }

    /// Positions a few units in the last place apart enclose nothing, whichever way round: a
    /// cube of that size far from the origin, and one of 1e-9 that does count.
    #[test]
    fn a_speck_of_rounding_is_no_void() {
        let speck = |half: f64| moved(cube([0.0; 3], half), |p| p + DVec3::new(3.0, 2.0, 1.0));
        let half = 4.0 * f64::EPSILON;
        for fragments in [speck(half), void(speck(half))] {
            assert_eq!(shells(&[fragments]).shells[0].role, ShellRole::Outer);
        }
        let shells = shells(&[void(speck(1e-9))]);
        assert!((shells.shells[0].volume / -8e-27 - 1.0).abs() < 1e-5);
        assert_eq!(shells.shells[0].role, ShellRole::Void);
    }

    #[test]
    fn a_void_in_nothing_is_stray() {
        let shells = shells(&[void(cube([0.0; 3], 1.0))]);
        assert_eq!(
            (shells.solids.len(), &shells.stray_voids[..]),
            (0, &[ShellId(0)][..])
        );
    }
}
