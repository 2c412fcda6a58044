//! `csg2brep check IN`: is a mesh file a closed, oriented manifold, and where is it not?

mod report;

use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::input::Input;
use crate::mesh_file;
use crate::run::Target;
use crate::summary::{counted, grouped, number, triple};
use crate::{memory, output};
use brep::Inspection;
use glam::DVec3;
use io::read::mesh::{Joining, Mesh};
pub(crate) use report::CheckReport;
use report::{Defects, JoinedBy, Place};

/// Reads, inspects, and prints on standard output; defects end in a failure.
pub(crate) fn run(args: CheckArgs) -> Result<(), Failure> {
    let input = Input::new(args.input);
    let mesh = mesh_file::read(&input, args.from, memory::allowed_bytes(args.memory))?;
    let report = check(input.name(), &mesh, args.weld)?;
    let text = if args.json {
        let json = serde_json::to_string_pretty(&report);
        json.map_err(|error| Failure::Bug(error.to_string()))? + "\n"
    } else {
        to_text(&report, &mesh)
    };
    output::write_bytes(&Target::Stdout, text.as_bytes())?;
    if report.is_closed_oriented_manifold {
        return Ok(());
    }
    let text = format!("{}: not a closed, oriented manifold", report.name);
    Err(Failure::Defective(text))
}

fn check(name: String, mesh: &Mesh, weld: bool) -> Result<CheckReport, Failure> {
    let too_many = |error: brep::Error| Failure::Limit(error.to_string());
    let inspect =
        |triangles: &[[u32; 3]]| Inspection::of(&mesh.positions, triangles).map_err(too_many);
    let (welded, merged) = mesh_file::welded(mesh);
    let (joined_by, found) = match mesh.joining {
        _ if weld => (JoinedBy::Positions, inspect(&welded)?),
        Joining::Positions => (JoinedBy::Positions, inspect(&welded)?),
        Joining::Extension => (JoinedBy::ExtMeshManifold, inspect(&mesh.triangles)?),
        Joining::Indices => (JoinedBy::Indices, inspect(&mesh.triangles)?),
    };
    let mut report = CheckReport::new(name, mesh, joined_by, &found);
    let is_joined = joined_by == JoinedBy::Positions;
    let alive = mesh.positions.len() - if is_joined { merged } else { 0 };
    // Joined vertices are named no more, so they seem unused.
    let unused = found.unused_vertices - if is_joined { merged } else { 0 };
    report.counts.unused_vertices = unused as u64;
    report.counts.vertices = (alive - unused) as u64;
    report.remarks.clone_from(&mesh.notes);
    remark(&mut report, mesh, &found);
    if !is_joined && merged > 0 {
        let after = inspect(&welded)?;
        report.remarks.extend(after_joining(&found, &after, merged));
    }
    Ok(report)
}

/// What is no defect and may still surprise.
fn remark(report: &mut CheckReport, mesh: &Mesh, found: &Inspection) {
    if found.volume.is_some_and(|volume| volume < 0.0) {
        let text = "the volume is negative: all triangles face inward, turn them over";
        report.remarks.push(text.to_owned());
    }
    if found.zero_area.count > 0 {
        let count = counted(found.zero_area.count as u64, "triangle");
        let first = report::places(mesh, &found.zero_area);
        let first = first.first().map_or_else(String::new, said);
        let text = format!("{count} without area, corners on one line; the first is {first}");
        report.remarks.push(text);
    }
    if report.counts.unused_vertices > 0 {
        let (count, verb) = match report.counts.unused_vertices {
            1 => ("1 vertex".to_owned(), "belongs"),
            more => (format!("{} vertices", grouped(more)), "belong"),
        };
        report
            .remarks
            .push(format!("{count} {verb} to no triangle"));
    }
}

/// What programs see that join vertices of equal position.
fn after_joining(found: &Inspection, after: &Inspection, merged: usize) -> Option<String> {
    let vertices = match merged {
        1 => "1 vertex has the position of another one".to_owned(),
        more => format!(
            "{} vertices have the position of another one",
            grouped(more as u64)
        ),
    };
    match (found.is_sound(), after.is_sound()) {
        (false, true) => Some(format!(
            "{vertices}: with these joined (--weld) the mesh is closed and oriented"
        )),
        (true, false) => Some(format!(
            "{vertices}: programs that join these will not find the mesh a closed manifold"
        )),
        _ => None,
    }
}

fn to_text(report: &CheckReport, mesh: &Mesh) -> String {
    let verdict = if report.is_closed_oriented_manifold {
        "a closed, oriented manifold"
    } else {
        "not a closed, oriented manifold"
    };
    let joined = match report.joined_by {
        JoinedBy::Indices => "by its vertex numbers",
        JoinedBy::ExtMeshManifold => "by EXT_mesh_manifold",
        JoinedBy::Positions => "with vertices of equal position joined",
    };
    let counts = &report.counts;
    let mut facts = vec![counted(counts.triangles, "triangle")];
    facts.push(match counts.vertices {
        1 => "1 vertex".to_owned(),
        more => format!("{} vertices", grouped(more)),
    });
    facts.push(counted(counts.components, "component"));
    facts.extend(
        report
            .genus
            .map(|genus| format!("genus {}", grouped(genus))),
    );
    let mut lines = vec![
        format!("{}: {verdict} ({joined})", report.name),
        format!("  {}", facts.join(", ")),
    ];
    let volume = report.volume.map(|volume| number(volume, 0.0));
    let volume = volume.unwrap_or_else(|| "none: the triangles do not enclose one".to_owned());
    let unit = mesh
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" ({unit})"));
    lines.push(format!("  area      {}", number(report.area, 0.0)));
    lines.push(format!("  volume    {volume}"));
    if let Some(corners) = report.bounds {
        let [min, max] = corners.map(DVec3::from);
        let size = min.abs().max(max.abs()).max_element();
        let [min, max] = [min, max].map(|corner| triple(corner, size));
        lines.push(format!("  box       {min} to {max}{unit}"));
    }
    for defects in &report.defects {
        lines.extend(described(defects));
    }
    let remarks = report.remarks.iter();
    lines.extend(remarks.map(|remark| format!("note: {remark}")));
    lines.join("\n") + "\n"
}

fn described(defects: &Defects) -> Vec<String> {
    let [one, several] = defects.kind.words();
    let words = if defects.count == 1 { one } else { several };
    let mut lines = vec![format!("{} {words}", grouped(defects.count))];
    lines.extend(
        defects
            .first
            .iter()
            .map(|place| format!("  {}", said(place))),
    );
    let more = defects.count - defects.first.len() as u64;
    if more > 0 {
        lines.push(format!("  and {} more", grouped(more)));
    }
    lines.push(format!("  remedy: {}", defects.remedy));
    lines
}

/// `line 3 and line 7, at (0, 0.5, 1)`.
fn said(place: &Place) -> String {
    let names = place.at.join(" and ");
    match place.position {
        Some(position) => {
            let position = DVec3::from(position);
            format!(
                "{names}, at {}",
                triple(position, position.abs().max_element())
            )
        }
        None => names,
    }
}
