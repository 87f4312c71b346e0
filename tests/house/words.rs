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

/// Constants that may stand twice: a figure's layout in pixels, which is its own affair, and where the parts of a state begin
/// in the arrays of two integrators.
fn is_layout(name: &str) -> bool {
    name.ends_with("_PX") || matches!(name, "DISPLACEMENT" | "SPRINGS")
}

/// Name and value of the constants of a text, unit tests left out.
fn constants(text: &str) -> Vec<(String, String)> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    let mut found = Vec::new();
    for (at, word) in code.match_indices("const ") {
        let begins = code[..at].rsplit('\n').next().unwrap().trim();
        let Some((head, rest)) = code[at + word.len()..].split_once('=') else { continue };
        let Some((name, _)) = head.split_once(": ") else { continue };
        let is_one = name.chars().all(|c| c.is_uppercase() || c.is_numeric() || c == '_');
        // a parameter `const N: usize>` of a generic item is none
        let is_parameter = head.matches('<').count() != head.matches('>').count();
        if is_one && !is_parameter && (begins.is_empty() || begins.starts_with("pub")) {
            let value = rest.split(';').next().unwrap();
            found.push((name.to_owned(), value.split_whitespace().collect()));
        }
    }
    found
}

/// A constant has one home: changed there, it is changed.
#[test]
fn no_constant_stands_twice() {
    let two = "/// A.\npub(super) const A: f64 = 1e-9;\nfn f<const N: usize>() {}\n    const B: [u8; 2] = [1, 2];\n";
    assert_eq!(constants(two).len(), 2);
    let mut homes: BTreeMap<(String, String), Vec<PathBuf>> = BTreeMap::new();
    let files = sources(Path::new("src"));
    for file in
        files.iter().filter(|file| !file.iter().any(|part| part == "tests" || part == "tests.rs"))
    {
        for constant in constants(&fs::read_to_string(file).unwrap()) {
            homes.entry(constant).or_default().push(file.clone());
        }
    }
    assert!(homes.len() > 500, "only {} constants were found", homes.len());
    homes.retain(|(name, _), files| files.len() > 1 && !is_layout(name));
    assert!(homes.is_empty(), "{homes:#?}");
}
