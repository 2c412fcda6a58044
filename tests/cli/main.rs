//! The command line as users see it: transcripts, and what does not fit into one.

mod files;
mod limits;
mod properties;
mod streams;

/// Each `*.trycmd` is a transcript; the folder of the same name with `.in` holds its files.
/// After an intended change: `TRYCMD=overwrite cargo test --test cli`, then review the diff.
#[test]
fn transcripts() {
    trycmd::TestCases::new().case("tests/cli/*.trycmd");
}

/// The program under test.
fn csg2brep() -> assert_cmd::Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("csg2brep");
    command
        .env_remove("NO_COLOR")
        .timeout(std::time::Duration::from_mins(1));
    command
}
