//! What is known about a solid, and the comparison with what came out.

use crate::stages::{Converted, convert_solid};
use crate::support::{intersection_report, manifold_report};
use crate::tree::Tree;
use csg::Solid;
use glam::DVec3;
use rayon::prelude::*;
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use subdiv::{Rule, Settings};

/// How a solid hangs together.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Topology {
    /// Connected pieces.
    pub(crate) solids: usize,
    /// Boundary shells inside them.
    pub(crate) cavities: usize,
    /// Handles of all shells together.
    pub(crate) genus: u64,
}

/// One piece without holes.
pub(crate) const BALL: Topology = pieces(1);

/// Pieces without holes.
pub(crate) const fn pieces(solids: usize) -> Topology {
    Topology {
        solids,
        cavities: 0,
        genus: 0,
    }
}

impl Topology {
    /// With so many handles.
    pub(crate) const fn genus(self, genus: u64) -> Self {
        Self { genus, ..self }
    }

    /// With so many cavities.
    pub(crate) const fn cavities(self, cavities: usize) -> Self {
        Self { cavities, ..self }
    }
}

/// A solid with its exact topology and volume.
pub(crate) struct Case {
    name: &'static str,
    tree: Tree,
    volume: f64,
    /// The right one; several where parts touch, so that each reading of the contact is
    /// right; none where surfaces touch along a curve, which may break it up anyhow.
    topologies: Vec<Topology>,
    /// As a fraction of the extent's diagonal.
    tolerance: f64,
}

/// A case at the usual tolerance.
pub(crate) fn case(
    name: &'static str,
    tree: Tree,
    volume: f64,
    topologies: impl Into<Vec<Topology>>,
) -> Case {
    Case {
        name,
        tree,
        volume,
        topologies: topologies.into(),
        tolerance: 0.01,
    }
}

impl Case {
    /// With another tolerance, as a fraction of the extent's diagonal.
    pub(crate) fn within(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    fn convert(&self) -> (Converted, f64) {
        let solid = Solid::build(&self.tree.model(), None).expect(self.name);
        let size = solid.extent.diagonal();
        let tolerance = if size.is_finite() {
            self.tolerance * size
        } else {
            1.0
        };
        let settings = Settings {
            threads: Some(1),
            ..Settings::new(Rule::Tolerance(tolerance))
        };
        (convert_solid(solid, &settings), tolerance)
    }

    /// What is wrong with the result, if anything is.
    fn complaint(&self, converted: &Converted, tolerance: f64) -> Option<String> {
        let found = without_specks(converted);
        if !self.topologies.is_empty() && !self.topologies.contains(&found) {
            let uncertified = converted.report.uncertified_leaves;
            return Some(format!(
                "{}: {found:?} instead of {:?} ({uncertified} leaves not certified)",
                self.name, self.topologies
            ));
        }
        // Between surfaces at most d apart lies at most area · d + O(d²). Planes are exact, so
        // that only curved faces count.
        let deviation = match converted.report.largest_deviation {
            Some(proved) if converted.report.uncertified_leaves == 0 => proved,
            _ => tolerance,
        };
        let curved = |primitive: csg::PrimitiveId| {
            let primitive = &converted.solid.primitives[primitive.0 as usize];
            primitive.polynomial.degree() > 1
        };
        let area: f64 = converted
            .brep
            .facets()
            .filter(|facet| curved(facet.primitive()))
            .map(|facet| 0.5 * facet.area_vector().length())
            .sum();
        // Positions are rounded a few times.
        let rounding = 16.0 * f64::EPSILON * converted.solid.domain.size();
        let allowed = 1.05 * area * deviation + converted.properties.area * rounding;
        let difference = converted.properties.volume - self.volume;
        (difference.abs() > allowed).then(|| {
            format!(
                "{}: volume {} is off by {difference:e}, more than {allowed:e}",
                self.name, converted.properties.volume
            )
        })
    }
}

/// What came out but for shells that lie within one uncertified cell and its neighbours: at an
/// apex or a cusp the tip may break into them, whatever the size of the cells.
fn without_specks(converted: &Converted) -> Topology {
    let is_speck = |shell: &&brep::Shell| {
        converted.report.uncertified.iter().any(|spot| {
            let reach = 2.0 * spot.size;
            let near = |corner: DVec3| corner.distance(spot.position) <= reach;
            near(shell.bounds.min) && near(shell.bounds.max)
        })
    };
    let shells = converted.shells.shells.iter();
    let mut found = pieces(0);
    for shell in shells.filter(|shell| !is_speck(shell)) {
        match shell.role {
            brep::ShellRole::Outer => found.solids += 1,
            brep::ShellRole::Void => found.cavities += 1,
        }
        found.genus += shell.genus;
    }
    found
}

/// Converts all cases and compares them, in our own measures, manifold3d's and CGAL's.
pub(crate) fn check(cases: &[Case]) {
    let folder = tempfile::tempdir().expect("a folder");
    let results: Vec<(Option<PathBuf>, Topology, Option<String>)> = cases
        .par_iter()
        .enumerate()
        .map(|(at, case)| {
            let (converted, tolerance) = case.convert();
            let name = case.name.replace(|c: char| !c.is_alphanumeric(), "_");
            let path = folder.path().join(format!("{at}_{name}.obj"));
            let path = (!converted.brep.is_empty()).then(|| write(&converted, path));
            let shells = &converted.shells;
            let found = Topology {
                solids: shells.shells.len(),
                cavities: 0,
                genus: shells.genus(),
            };
            (path, found, case.complaint(&converted, tolerance))
        })
        .collect();
    let mut complaints: Vec<String> = results.iter().filter_map(|r| r.2.clone()).collect();
    let paths: Vec<&Path> = results.iter().filter_map(|r| r.0.as_deref()).collect();
    let pairs = results.iter().zip(cases);
    let written: Vec<_> = pairs.filter(|(r, _)| r.0.is_some()).collect();
    for (report, ((_, found, _), case)) in manifold_report(&paths).iter().zip(&written) {
        let same = report.components == Some(found.solids)
            && report.genus == i64::try_from(found.genus).ok();
        if report.status != "NoError" || !same {
            complaints.push(format!("{}: {report:?} for {found:?}", case.name));
        }
    }
    // Exact arithmetic takes its time: a million triangles say nothing that thousands do not.
    let small = |path: &&Path| path.metadata().is_ok_and(|file| file.len() < 4_000_000);
    let paths: Vec<&Path> = paths.into_iter().filter(small).collect();
    for report in intersection_report(&paths) {
        if report.crossings > 0 {
            complaints.push(format!("{report:?}"));
        }
    }
    assert!(complaints.is_empty(), "\n{}", complaints.join("\n"));
}

fn write(converted: &Converted, path: PathBuf) -> PathBuf {
    let mut file = BufWriter::new(File::create(&path).expect("a new file"));
    io::write::obj::write(
        &converted.brep,
        &io::write::obj::Options::default(),
        &mut file,
    )
    .expect("an OBJ file");
    path
}
