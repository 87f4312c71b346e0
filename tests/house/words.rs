//! One thing has one name and one home: schemes are told apart in few places, no name means two types.

use super::sources;
use std::fs;
use std::path::{Path, PathBuf};

/// Files that may name single schemes. All others ask them (`has_springs()`) or hold a table by scheme (`Scheme::of`).
const FILES_NAMING_SCHEMES: usize = 8;

/// Whether a line of code, not a comment, names a scheme.
fn names_a_scheme(line: &str) -> bool {
    !line.trim_start().starts_with("//") && line.contains("Scheme::")
}

#[test]
fn few_files_name_single_schemes() {
    let names = |file: &PathBuf| fs::read_to_string(file).unwrap().lines().any(names_a_scheme);
    let found: Vec<PathBuf> = sources(Path::new("src")).into_iter().filter(names).collect();
    assert!(!found.is_empty() && found.len() <= FILES_NAMING_SCHEMES, "{found:#?}");
}
