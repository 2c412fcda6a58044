#![allow(
    dead_code,
    missing_docs,
    unreachable_pub,
    clippy::all,
    clippy::pedantic
)]
#[path = "../../brep/src/samples.rs"]
mod samples;
use csg::Material;
use io::write::{gltf, obj, picture, stl};
use samples::*;
use std::time::Instant;
fn main() {
    let big = std::env::args().nth(2).is_some();
    let n = if big {2} else {1};
    let a = moved(painted(torus(1.0, 0.35, 200*n, 80*n), 10, 1), |p| p + glam::DVec3::new(0., 0., 0.35));
    let b = moved(painted(torus(1.0, 0.35, 250*n, 80*n), 20, 2), |p| glam::DVec3::new(p.x + 1.0, -p.z, p.y + 1.35));
    let c = painted(cube([-1.2, -1.2, 0.5], 0.5), 30, 0);
    let d = moved(painted(sphere(if big {8} else {5}), 40, 3), |p| p * 0.4 + glam::DVec3::new(-1.3, 0.9, 1.1));
    let f = if big { together(&[a.clone(), b, c, d, moved(a, |p| p + glam::DVec3::new(0.,0.,-1.))]) } else { together(&[a, b, c, d]) };
    let m = vec![
        Material { color: None },
        Material {
            color: Some([0.85, 0.3, 0.2, 1.0]),
        },
        Material {
            color: Some([0.2, 0.45, 0.75, 1.0]),
        },
        Material {
            color: Some([0.95, 0.75, 0.2, 1.0]),
        },
    ];
    let t = Instant::now();
    let brep = brep::stitch(&f).unwrap();
    println!("stitch {} triangles {:?}", brep.facet_count(), t.elapsed());
    let t = Instant::now();
    let brep = brep.validate().unwrap();
    println!("validate {:?}", t.elapsed());
    macro_rules! time { ($n:expr, $e:expr) => { let t = Instant::now(); let r = $e; println!("{} {:?}", $n, t.elapsed()); r } }
    time!("properties", brep::Properties::of(&brep));
    let g = { let t = Instant::now(); let g = brep::Groups::of(&brep); println!("groups {:?}", t.elapsed()); g };
    time!("corners", brep::Corners::of(&brep, &g));
    time!("shells", brep::Shells::of(&brep));
    time!("simplify", brep::simplify::remove_degenerate(brep.clone()).unwrap().1);
    time!("obj mem", obj::write(&brep, &Default::default(), &mut Vec::new()).unwrap());
    time!("glb mem", gltf::write(&brep, &m, &Default::default(), &mut Vec::new()).unwrap());
    time!("stl mem", stl::write(&brep, &mut Vec::new()).unwrap());
    let t = Instant::now();
    let mut out = std::fs::File::create("/tmp/pic.png").unwrap();
    let view = match std::env::args().nth(1).as_deref() {
        Some("front") => picture::View::Front,
        Some("top") => picture::View::Top,
        Some("dir") => picture::View::Direction {
            azimuth_deg: -60.,
            elevation_deg: 28.,
        },
        _ => picture::View::Isometric,
    };
    picture::write(
        &brep,
        &m,
        &picture::Options {
            view,
            ..Default::default()
        },
        &mut out,
    )
    .unwrap();
    println!("picture {:?}", t.elapsed());
    gltf::write(
        &brep,
        &m,
        &Default::default(),
        &mut std::fs::File::create("/tmp/pic.glb").unwrap(),
    )
    .unwrap();
    obj::write(
        &brep,
        &Default::default(),
        &mut std::io::BufWriter::new(std::fs::File::create("/tmp/pic.obj").unwrap()),
    )
    .unwrap();
    println!(
        "{:?}",
        stl::write(
            &brep,
            &mut std::io::BufWriter::new(std::fs::File::create("/tmp/pic.stl").unwrap())
        )
    );
}
