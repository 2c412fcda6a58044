//! Hostile and huge inputs: an answer within seconds, never a crash.

use super::csg2brep;
use std::time::{Duration, Instant};

/// Converts a model from standard input to nowhere; the exit code and what was said.
fn convert(model: &str, more: &[&str]) -> (i32, String) {
    let start = Instant::now();
    let output = csg2brep()
        .args(["-", "-o", "-", "--to", "stl"])
        .args(more)
        .write_stdin(model)
        .output()
        .expect("the program starts");
    // Built for tests and beside other tests, so generous; each takes a second at most alone.
    assert!(start.elapsed() < Duration::from_secs(30));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let code = output.status.code();
    (code.expect("no signal ended it"), said)
}

#[test]
fn a_hundred_thousand_levels_are_converted() {
    let n = 100_000;
    for open in [
        "union() {",
        "difference() {",
        "color([1, 0, 0, 1]) {",
        "multmatrix([[1, 0, 0, 1e-3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {",
    ] {
        let model = format!("{}cube(1);{}", open.repeat(n), "}".repeat(n));
        let (code, said) = convert(&model, &[]);
        assert_eq!(code, 0, "{said}");
        // Sums up to 100 of numbers that are no binary fractions are rounded each time.
        let proved = if open.starts_with("multmatrix") {
            "deviation <= "
        } else {
            "exact"
        };
        let expected = format!("1 solid, genus 0, volume 1, watertight, {proved}");
        assert!(said.contains(&expected), "{said}");
    }
}

#[test]
fn a_hundred_thousand_parentheses_are_converted() {
    let n = 100_000;
    let ball = format!(
        "polynomial(\"{}x^2+y^2+z^2-1{}\");",
        "(".repeat(n),
        ")".repeat(n)
    );
    let (code, said) = convert(&ball, &["--tolerance", "0.1"]);
    assert_eq!(code, 0, "{said}");
}

#[test]
fn errors_in_deep_or_long_lines_are_shown_in_part() {
    let n = 100_000;
    let model = format!("{}cubee(1);{}", "union() {".repeat(n), "}".repeat(n));
    let (code, said) = convert(&model, &[]);
    assert_eq!(code, 1);
    assert!(
        said.starts_with("error: <stdin>:1:900001: unknown node `cubee`\n"),
        "{said}"
    );
    assert!(said.len() < 1000);
}

#[test]
fn unclosed_braces_and_brackets_are_counted_not_followed() {
    let n = 100_000;
    let (code, said) = convert(&"union() {".repeat(n), &[]);
    assert_eq!(code, 1);
    assert!(said.contains("100000 closing `}` are missing"), "{said}");
    let (code, _) = convert(&format!("cube({}", "[".repeat(n)), &[]);
    assert_eq!(code, 1);
}

#[test]
fn high_degrees_are_refused_before_they_cost_anything() {
    for expression in [
        "x^1000000",
        "(x+y+z+1)^65",
        "((x+1)^64)*(y+1)",
        "(((x^9)^9)^9)^9",
    ] {
        let (code, said) = convert(&format!("polynomial(\"{expression}\");"), &[]);
        assert_eq!(code, 1);
        assert!(said.contains("is above the limit of 64"), "{said}");
    }
    let (code, said) = convert("polynomial(\"x^3\");", &["--max-degree", "2"]);
    assert_eq!(code, 1);
    assert!(said.contains("degree 3 is above the limit of 2"), "{said}");
}

#[test]
fn limits_end_a_run_with_code_4_and_leave_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let old = folder.path().join("old.obj");
    let report = folder.path().join("report.json");
    std::fs::write(&old, "old").unwrap();
    for limit in [["--max-cells", "1000"], ["--memory", "100K"]] {
        let run = csg2brep()
            .args(["-", "--tolerance", "1e-4", "-o"])
            .arg(&old)
            .arg("--report")
            .arg(&report)
            .args(limit)
            .write_stdin("sphere(r = 1);")
            .assert()
            .code(4);
        let said = String::from_utf8_lossy(&run.get_output().stderr).into_owned();
        assert!(said.starts_with("error: <stdin>: more than "), "{said}");
        assert_eq!(std::fs::read_to_string(&old).unwrap(), "old");
        let text = std::fs::read_to_string(&report).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert_eq!(report["settings"]["tolerance"], 1e-4);
        assert!(
            report["error"]
                .as_str()
                .unwrap()
                .contains("would be needed")
        );
        assert!(report["volume"].is_null());
    }
    let left = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(left, 2, "no temporary files");
}

#[test]
fn strict_turns_missing_proofs_and_warnings_into_failures() {
    // The apex of a cone is a singular point.
    let cone = "cylinder(h = 1, r1 = 1, r2 = 0);";
    let (code, said) = convert(cone, &["--strict", "--tolerance", "0.1"]);
    assert_eq!(code, 3, "{said}");
    assert!(
        said.contains("not certified to the tolerance (--strict)"),
        "{said}"
    );
    let (code, _) = convert(cone, &["--tolerance", "0.1"]);
    assert_eq!(code, 0);
    let (code, said) = convert("cube(1); cube(0);", &["--strict"]);
    assert_eq!(code, 1);
    assert!(said.contains("nothing was written"), "{said}");
}

/// Cells have at least 2⁻¹⁹ of the domain's size: beside a distance of 10⁶ a unit ball may get lost,
/// and nobody is told that the result is exact.
#[test]
fn what_the_lattice_may_lose_is_said() {
    let far = "multmatrix([[1,0,0,1000000],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { sphere(r=1); }";
    let model = format!("union() {{ sphere(r=1); {far} }}");
    let (code, said) = convert(&model, &["--tolerance", "0.1"]);
    assert_eq!(code, 0, "{said}");
    assert!(said.contains("may be missing"), "{said}");
    assert!(
        said.contains("cells not certified") && !said.contains("exact"),
        "{said}"
    );
    let (code, said) = convert(&model, &["--tolerance", "0.1", "--strict"]);
    assert_eq!(code, 1, "{said}");
}

#[test]
fn nearly_equal_surfaces_are_named() {
    let model = "union() { cube(1); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1e-8],[0,0,0,1]]) { cube(1); } }";
    let (code, said) = convert(model, &[]);
    assert_eq!(code, 0, "{said}");
    assert!(
        said.contains("nearly but not quite equal: 4 and 6 (by "),
        "{said}"
    );
}

/// Where radii of curvature are below some three tolerances the true boundary is not proved to be
/// near the mesh.
#[test]
fn strict_counts_cells_certified_one_way() {
    let (code, said) = convert("sphere(r=1);", &["--tolerance", "0.3", "--strict"]);
    assert_eq!(code, 3, "{said}");
    assert!(said.contains("cells are certified one way only"), "{said}");
}
