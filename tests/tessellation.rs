//! Facets from the true surfaces: the topology of the subdivision, on the surfaces, and none
//! through another. Judges are manifold3d, CGAL (self-intersections), volumes with formulas, and
//! the mesh of the metric rule.
//!
//! `CSG2BREP_TREES=2000 CSG2BREP_SEED=1 cargo test --release --test tessellation` runs more than
//! the 100 random trees of a normal test run; `docs/reliability.md` lists what has been run.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

mod stages;
mod support;
mod trees;

use brep::simplify::remove_degenerate;
use brep::{
    Brep, Demand, Fit, Groups, IfTroubled, Proof, Properties, Shells, Tessellated, Valid,
    tessellate,
};
use csg::{Model, Solid};
use rayon::prelude::*;
use std::f64::consts::PI;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use subdiv::{Rule, Settings};
use trees::{Setting, number, trees};

/// Proves the topology and tessellates; `None` where it cannot be done.
fn tessellated(solid: &Solid, tolerance: f64) -> Option<(Valid<Brep>, Tessellated, bool)> {
    fitted(solid, tolerance, Fit::Inscribed)
}

fn fitted(solid: &Solid, tolerance: f64, fit: Fit) -> Option<(Valid<Brep>, Tessellated, bool)> {
    let (coarse, report) = subdivided(solid, Rule::Topology { finest: tolerance });
    let proved = report.proved_topology == Some(true);
    let demand = Demand {
        tolerance,
        fit,
        if_troubled: IfTroubled::Refine,
        proof: if proved && report.split_vertices == 0 {
            Proof::BothWays {
                components: coarse.component_count(),
            }
        } else {
            Proof::OneWay
        },
    };
    let (brep, counts) = like(&coarse, solid, demand)?;
    Some((brep, counts, proved))
}

fn subdivided(solid: &Solid, rule: Rule) -> (Valid<Brep>, subdiv::Report) {
    let settings = Settings {
        threads: Some(1),
        ..Settings::new(rule)
    };
    let outcome = subdiv::convert(solid, &settings, &()).unwrap();
    let stitched = brep::stitch(&outcome.fragments).unwrap();
    let (brep, _) = remove_degenerate(stitched.validate().unwrap()).unwrap();
    (brep, outcome.report)
}

/// Tessellates, and sees to it that faces, edges and vertices are those of the subdivision.
fn like(coarse: &Valid<Brep>, solid: &Solid, demand: Demand) -> Option<(Valid<Brep>, Tessellated)> {
    let (brep, counts) = tessellate(coarse, solid, demand)?;
    let before = (signature(coarse), Groups::of(coarse));
    let after = (signature(&brep), Groups::of(&brep));
    assert_eq!(before.0, after.0);
    assert_eq!(before.1.faces.len(), after.1.faces.len());
    assert_eq!(before.1.edges.len(), after.1.edges.len());
    assert_eq!(before.1.vertices.len(), after.1.vertices.len());
    Some((brep, counts))
}

/// Genus of each shell, sorted.
fn signature(brep: &Valid<Brep>) -> Vec<u64> {
    let shells = Shells::of(brep);
    let mut genus: Vec<u64> = shells.shells.iter().map(|s| s.genus).collect();
    genus.sort_unstable();
    genus
}

fn write(brep: &Valid<Brep>, path: &Path) {
    let mut file = File::create(path).unwrap();
    io::write::obj::write(brep, &io::write::obj::Options::default(), &mut file).unwrap();
}

/// manifold3d and CGAL find nothing wrong.
fn judge(paths: &[PathBuf]) {
    for report in support::manifold_report(paths) {
        assert_eq!(report.status, "NoError", "{report:?}");
    }
    for report in support::intersection_report(paths) {
        assert_eq!(report.crossings, 0, "{report:?}");
    }
}

fn solid(name: &str) -> Solid {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fixtures")
        .join(name);
    let source = fs::read_to_string(path).unwrap();
    Solid::build(&stages::read(&source), None).unwrap()
}

fn side(solid: &Solid) -> f64 {
    (solid.extent.max - solid.extent.min).max_element()
}

#[test]
fn fixtures_keep_their_topology_and_do_not_cross_themselves() {
    // Name, exact volume where there is a formula, most triangles at 1 % and 0.1 % of the side:
    // 1.5 times those of manifold3d over tessellated primitives at the same measured error,
    // where it reaches that error.
    let cube_less_holes = 10.0 * 10.0 - 64.0 * PI * 0.4 * 0.4;
    let cases = [
        ("solids/S1_sphere.csg", Some(4.0 * PI / 3.0), [600, 5250]),
        ("solids/S2_demo.csg", None, [1350, 4800]),
        ("solids/S3_torus_sphere.csg", None, [2700, 18000]),
        ("solids/S4_64_spheres.csg", None, [6900, 76500]),
        ("solids/S5_ring128.csg", None, [10800, 49500]),
        ("solids/S6_plate64.csg", Some(cube_less_holes), [3450, 6600]),
    ];
    let folder = tempfile::tempdir().unwrap();
    let mut paths: Vec<PathBuf> = Vec::new();
    for (name, volume, most) in cases {
        let solid = solid(name);
        for (part, most) in [0.01, 0.001].into_iter().zip(most) {
            let tolerance = part * side(&solid);
            let (brep, counts, proved) = tessellated(&solid, tolerance).expect(name);
            assert!(proved, "{name}");
            assert!(
                counts.largest_deviation <= tolerance * 1.000_001,
                "{name}: {counts:?}"
            );
            assert!(counts.facets_after <= most, "{name}: {counts:?}");
            if let Some(volume) = volume {
                let found = Properties::of(&brep);
                // A layer between mesh and surface, no thicker than the tolerance.
                let layer = tolerance * found.area * 1.1;
                assert!((found.volume - volume).abs() <= layer, "{name}: {found:?}");
            }
            let path = folder.path().join(format!("{}.obj", paths.len()));
            write(&brep, &path);
            paths.push(path);
        }
    }
    judge(&paths);
}

/// Real models, whose parts touch, are tangent or nearly so: where faces cannot be tessellated they
/// keep the facets of the metric rule. Where both rules are proved, they agree.
#[test]
fn every_fixture_comes_from_its_surfaces() {
    let folder = tempfile::tempdir().unwrap();
    let models = stages::models();
    let results: Vec<(PathBuf, Tessellated, bool)> = (models.par_iter())
        .filter_map(|path| {
            let name = path.file_stem().unwrap().to_str().unwrap();
            let solid =
                Solid::build(&stages::read(&fs::read_to_string(path).unwrap()), None).unwrap();
            if solid.primitives.is_empty() {
                return None;
            }
            let tolerance = 0.01 * solid.extent.diagonal();
            let fit = Fit::Inscribed;
            let (metric, certified) = subdivided(&solid, Rule::Tolerance(tolerance));
            let first = fitted(&solid, tolerance, fit);
            let is_certified = certified.uncertified_leaves == 0;
            let both = is_certified && first.as_ref().is_some_and(|(.., proved)| *proved);
            if both {
                let proved = &first.as_ref().unwrap().0;
                assert_eq!(signature(proved), signature(&metric), "{name}");
            }
            let (brep, counts) = match first {
                Some((brep, counts, _)) => (brep, counts),
                None => kept_where_needed(&metric, &solid, tolerance),
            };
            assert!(
                counts.largest_deviation <= tolerance * 1.000_001,
                "{name}: {counts:?}"
            );
            let path = folder.path().join(format!("{name}.obj"));
            write(&brep, &path);
            Some((path, counts, both))
        })
        .collect();
    let paths: Vec<PathBuf> = results.iter().map(|(path, ..)| path.clone()).collect();
    judge(&paths);
    let sum = |of: fn(&Tessellated) -> usize| results.iter().map(|(_, c, _)| of(c)).sum::<usize>();
    let (from_surfaces, kept) = (sum(|counts| counts.faces), sum(|counts| counts.kept_faces));
    assert!(kept * 20 < from_surfaces, "{kept} beside {from_surfaces}");
    let compared = results.iter().filter(|(.., both)| *both).count();
    assert!(compared >= 20, "{compared}");
    let enclosed = results
        .iter()
        .filter_map(|(_, counts, _)| counts.enclosure.as_ref());
    let near = enclosed.clone().count();
    let proved = enclosed.filter(|of| of.is_both_ways).count();
    println!(
        "{} fixtures: {near} proved to be near the boundary, {proved} both ways",
        results.len()
    );
    assert!(
        near * 10 >= results.len() * 7 && proved * 10 >= results.len() * 6,
        "{near}, {proved}"
    );
}

#[test]
fn vertices_lie_on_the_surfaces_of_all_facets_around_them() {
    let solid = solid("solids/S2_demo.csg");
    let (brep, ..) = tessellated(&solid, 0.002).unwrap();
    for facet in brep.facets() {
        let polynomial = &solid.primitives[facet.primitive().0 as usize].polynomial;
        for vertex in facet.vertices() {
            let at = solid.domain.to_centered(vertex.position());
            let distance = polynomial.evaluate(at) / polynomial.gradient(at).length();
            assert!(
                distance.abs() < 1e-14,
                "{distance:e} at {}",
                vertex.position()
            );
        }
    }
}

#[test]
fn bytes_do_not_depend_on_threads() {
    for name in ["solids/S2_demo.csg", "solids/S5_ring128.csg"] {
        let solid = solid(name);
        let tolerance = 0.01 * side(&solid);
        let bytes = [1, 2, 7].map(|threads| {
            let settings = Settings {
                threads: Some(threads),
                ..Settings::new(Rule::Topology { finest: tolerance })
            };
            let coarse = stages::convert_solid(solid.clone(), &settings).brep;
            let demand = Demand {
                tolerance,
                fit: Fit::Mean,
                if_troubled: IfTroubled::Refine,
                proof: Proof::OneWay,
            };
            let (brep, _) = tessellate(&coarse, &solid, demand).unwrap();
            let mut bytes = Vec::new();
            io::write::obj::write(&brep, &io::write::obj::Options::default(), &mut bytes).unwrap();
            bytes
        });
        assert!(bytes[0] == bytes[1] && bytes[0] == bytes[2], "{name}");
    }
}

/// Half a sphere is a plane that must stay one, a crease and a curved face.
#[test]
fn a_mean_fit_keeps_volumes_planes_and_the_tolerance_with_fewer_triangles() {
    let half_ball = "intersection() { sphere(r=1); translate([-2, -2, 0]) cube(4); }";
    let tube = "difference() { cylinder(h=2, r=1); translate([0, 0, -1]) cylinder(h=4, r=0.5); }";
    let torus = "rotate_extrude() translate([2, 0]) circle(r=0.5);";
    let cases = [
        ("sphere(r=1);", 4.0 * PI / 3.0),
        (half_ball, 2.0 * PI / 3.0),
        (tube, 1.5 * PI),
        ("cylinder(h=2, r1=1, r2=0.5);", 7.0 * PI / 6.0),
        (torus, 2.0 * PI * 2.0 * PI * 0.25),
    ];
    let folder = tempfile::tempdir().unwrap();
    let mut paths = Vec::new();
    for (source, volume) in cases {
        let solid = Solid::build(&stages::read(source), None).unwrap();
        for part in [0.01, 0.002] {
            let tolerance = part * side(&solid);
            let (coarse, _) = subdivided(&solid, Rule::Topology { finest: tolerance });
            let [(plain, few), (mean, fewer)] = [Fit::Inscribed, Fit::Mean].map(|fit| {
                let demand = Demand {
                    tolerance,
                    fit,
                    if_troubled: IfTroubled::Refine,
                    // What the facets themselves do: a proof may ask for more of some.
                    proof: Proof::Nothing,
                };
                like(&coarse, &solid, demand).expect(source)
            });
            assert!(
                fewer.facets_after <= few.facets_after,
                "{source}: {fewer:?}"
            );
            assert!(
                fewer.largest_deviation <= tolerance * 1.000_001,
                "{source}: {fewer:?}"
            );
            let [biased, fair] =
                [&plain, &mean].map(|brep| (Properties::of(brep).volume - volume).abs());
            assert!(fair < 0.1 * biased, "{source}: {fair:e}, {biased:e} before");
            // Measured here, from the polynomials: corners may leave curved surfaces only.
            for facet in mean.facets() {
                let polynomial = &solid.primitives[facet.primitive().0 as usize].polynomial;
                let corners = facet.vertices().map(brep::VertexView::position);
                let center = (corners[0] + corners[1] + corners[2]) / 3.0;
                for at in corners.into_iter().chain([center]) {
                    let at = solid.domain.to_centered(at);
                    let slope = polynomial.gradient(at).length();
                    let distance = polynomial.evaluate(at) / slope * solid.domain.half_size();
                    let most = match polynomial.degree() {
                        1 => 1e-12,
                        // To the first order.
                        _ => tolerance * 1.05,
                    };
                    assert!(distance.abs() <= most, "{source}: {distance:e}");
                }
            }
            let path = folder.path().join(format!("{}.obj", paths.len()));
            write(&mean, &path);
            paths.push(path);
        }
    }
    judge(&paths);
}

/// Random trees, also such whose parts coincide, touch and are tangent: all come from their
/// surfaces, but for a few faces, and have nearly the volume of the metric rule's mesh.
#[test]
fn random_trees_come_from_their_surfaces() {
    let (count, seed) = (number("CSG2BREP_TREES", 100), number("CSG2BREP_SEED", 0));
    let folder = tempfile::tempdir().unwrap();
    let settings = [("general", Setting::General), ("grid", Setting::Grid)];
    for (name, setting) in settings {
        let models: Vec<Model> = (trees(count, seed, setting).into_iter())
            .map(|(_, model)| model)
            .collect();
        let results: Vec<(PathBuf, Tessellated, bool)> = (models.par_iter().enumerate())
            .filter_map(|(at, model)| {
                let solid = Solid::build(model, None).unwrap();
                if solid.primitives.is_empty() {
                    return None;
                }
                let tolerance = 0.005 * side(&solid);
                let (metric, _) = subdivided(&solid, Rule::Tolerance(tolerance));
                let first = fitted(&solid, tolerance, Fit::Inscribed);
                let kept = first.is_none();
                let (brep, counts) = first.map_or_else(
                    || kept_where_needed(&metric, &solid, tolerance),
                    |(brep, counts, _)| (brep, counts),
                );
                let [found, before] = [&brep, &metric].map(Properties::of);
                let layer = 2.2 * tolerance * before.area;
                let difference = (found.volume - before.volume).abs();
                assert!(
                    difference <= layer,
                    "{name} tree {at}: {difference} above {layer}"
                );
                if brep.is_empty() {
                    return None;
                }
                let path = folder.path().join(format!("{name}-{at}.obj"));
                write(&brep, &path);
                Some((path, counts, kept))
            })
            .collect();
        let second = results.iter().filter(|(.., kept)| *kept).count();
        let faces: usize = results.iter().map(|(_, counts, _)| counts.faces).sum();
        let kept: usize = results.iter().map(|(_, counts, _)| counts.kept_faces).sum();
        println!(
            "{count} {name} trees, seed {seed}: {} not empty, {second} by the second way; {kept} \
             faces of {} keep the subdivision's facets",
            results.len(),
            faces + kept
        );
        let paths: Vec<PathBuf> = results.into_iter().map(|(path, ..)| path).collect();
        judge(&paths);
        let (most, of) = match setting {
            Setting::General => (1, 40),
            Setting::Grid => (1, 4),
        };
        assert!(
            kept * of <= (faces + kept) * most,
            "{name}: {kept} of {faces}"
        );
    }
}

fn kept_where_needed(
    metric: &Valid<Brep>,
    solid: &Solid,
    tolerance: f64,
) -> (Valid<Brep>, Tessellated) {
    let demand = Demand {
        tolerance,
        fit: Fit::Inscribed,
        if_troubled: IfTroubled::Keep,
        proof: Proof::OneWay,
    };
    like(metric, solid, demand).expect("an end")
}

/// The symmetric difference of two balls: along their circle four sheets meet, so that two B-Rep
/// edges lie in one place and must get the same points.
#[test]
fn edges_in_one_place_get_the_same_points() {
    let [one, other] = ["sphere(r=1);", "translate([0.7, 0.3, 0.2]) sphere(r=0.9);"];
    let source =
        format!("union() {{ difference() {{ {one} {other} }} difference() {{ {other} {one} }} }}");
    let solid = Solid::build(&stages::read(&source), None).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut paths = Vec::new();
    for part in [0.02, 0.005, 0.001] {
        let (brep, counts, proved) = tessellated(&solid, part * side(&solid)).expect("two balls");
        assert!(proved);
        assert_eq!(counts.faces, 4);
        let path = folder.path().join(format!("{part}.obj"));
        write(&brep, &path);
        paths.push(path);
    }
    judge(&paths);
}
