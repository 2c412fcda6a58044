//! What `docs/thesis.md` and `docs/thesis-programs.md` name is there.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

use std::fs;
use std::path::Path;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

/// What stands between back quotes, outside of blocks of commands.
fn quoted(text: &str) -> impl Iterator<Item = &str> {
    text.split('`').skip(1).step_by(2)
}

fn is_source(word: &str) -> bool {
    word.contains('/') && Path::new(word).extension().is_some_and(|end| end == "rs")
}

/// Rows of the table of algorithms: the files and the names.
#[test]
fn algorithms_are_where_the_table_says() {
    let text = fs::read_to_string(Path::new(ROOT).join("docs/thesis.md")).unwrap();
    let table = text.split("## Algorithms").nth(1).unwrap();
    let rows: Vec<Vec<&str>> = table
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'))
        .skip(2)
        .map(|row| row.trim_matches('|').split('|').collect())
        .collect();
    for row in &rows {
        let [section, files, names] = row[..] else {
            panic!("three columns: {row:?}");
        };
        let sources: Vec<String> = quoted(files)
            .map(|file| {
                let read = fs::read_to_string(Path::new(ROOT).join(file));
                read.unwrap_or_else(|error| panic!("{section}: {file}: {error}"))
            })
            .collect();
        assert!(!sources.is_empty(), "{section}");
        let mut named = 0;
        for name in quoted(names) {
            let defined = |source: &String| {
                ["fn", "struct", "enum", "trait"].iter().any(|kind| {
                    let definition = format!("{kind} {name}");
                    source.match_indices(&definition).any(|(at, found)| {
                        let next = source[at + found.len()..].chars().next();
                        next.is_some_and(|c| !c.is_alphanumeric() && c != '_')
                    })
                })
            };
            assert!(sources.iter().any(defined), "{section}: {name}");
            named += 1;
        }
        assert!(named > 0, "{section}");
    }
    // One row at least for every algorithm of the thesis.
    for algorithm in ["2.1", "2.2", "2.3", "3.1", "4.1", "4.2", "4.3", "4.4"] {
        let named = rows.iter().any(|row| row[0].contains(algorithm));
        assert!(named, "Algorithm {algorithm}");
    }
}

#[test]
fn files_that_are_named_exist() {
    for document in [
        "docs/thesis.md",
        "docs/thesis-programs.md",
        "fixtures/thesis/README.md",
    ] {
        let text = fs::read_to_string(Path::new(ROOT).join(document)).unwrap();
        for path in quoted(&text).filter(|word| is_source(word)) {
            assert!(Path::new(ROOT).join(path).is_file(), "{document}: {path}");
        }
    }
}
