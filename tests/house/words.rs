//! One thing has one name and one home: schemes are told apart in few places, no name means two types.

use super::sources;
use std::collections::BTreeMap;
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

/// Name of the type that a line defines; types that an `impl` owes its trait (`type Error = …`, indented) are none.
fn defined(line: &str) -> Option<&str> {
    let own = line.trim_start();
    let open = own.strip_prefix("pub").map_or(own, |rest| match rest.strip_prefix('(') {
        Some(restricted) => restricted.split_once(')').map_or(rest, |(_, rest)| rest),
        None => rest,
    });
    let (word, rest) = open.trim_start().split_once(' ')?;
    let is_definition = matches!(word, "struct" | "enum" | "trait" | "union")
        || word == "type" && !line.starts_with(' ');
    let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    is_definition.then_some(&rest[..end])
}

/// A reader who meets a name must not ask which of two types it is; nor may a private one be named like a public one.
#[test]
fn no_name_means_two_types() {
    assert_eq!(defined("    pub(in crate::a) struct B<'a> {"), Some("B"));
    assert_eq!(defined("    type Error = Flaw;"), None);
    let mut homes: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in sources(Path::new("src")) {
        let text = fs::read_to_string(&file).unwrap();
        for name in text.lines().filter_map(defined) {
            homes.entry(name.to_owned()).or_default().push(file.clone());
        }
    }
    assert!(homes.len() > 500, "only {} types were found", homes.len());
    homes.retain(|_, files| files.len() > 1);
    assert!(homes.is_empty(), "{homes:#?}");
}
