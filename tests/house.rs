//! The house stays a house: floors use only floors below them, and rooms stay small.
#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources has failed")]

use std::fs;
use std::path::{Path, PathBuf};

/// Longest file (lines).
const ROOM: usize = 400;
/// Most names that a user of the library meets at its root.
const MOST_NAMES: usize = 60;

fn sources(dir: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(dir).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}

/// Modules in the order in which `lib.rs` lists them, bottom floor first.
fn floors() -> Vec<String> {
    let lib = fs::read_to_string("src/lib.rs").unwrap();
    let name = |line: &str| {
        line.strip_prefix("pub mod ").map(|rest| rest.trim_end_matches(';').to_owned())
    };
    lib.lines().filter_map(name).collect()
}

fn floor_of(file: &Path) -> Option<String> {
    let inside = file.strip_prefix("src").ok()?;
    let first = inside.components().next()?.as_os_str().to_str()?;
    Some(first.trim_end_matches(".rs").to_owned())
}

/// Names that follow `crate::` in a text, comments left out; `use crate::{a, b::c}` names several.
fn used(text: &str) -> Vec<String> {
    let code = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    let word = |from: &str| -> String {
        from.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut names = Vec::new();
    for place in code.split("crate::").skip(1) {
        match place.strip_prefix('{').and_then(|list| list.split_once("};")) {
            Some((list, _)) => names.extend(list.split(',').map(|part| word(part.trim()))),
            None => names.push(word(place)),
        }
    }
    names
}

#[test]
fn a_module_uses_only_modules_below_it() {
    let floors = floors();
    let height = |name: &str| floors.iter().position(|floor| floor == name);
    assert!(floors.len() > 10, "the order of the floors was not found in lib.rs");
    let mut wrong = Vec::new();
    for file in sources(Path::new("src")) {
        let Some(own) = floor_of(&file).and_then(|floor| height(&floor)) else { continue };
        for name in used(&fs::read_to_string(&file).unwrap()) {
            if height(&name).is_some_and(|other| other > own) {
                wrong.push(format!("{} uses {name}, which is above it", file.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rooms_are_small() {
    let crowded: Vec<String> = ["src", "tests", "bench/src", "bench/benches", "bench/tests"]
        .iter()
        .flat_map(|dir| sources(Path::new(dir)))
        .filter_map(|file| {
            let lines = fs::read_to_string(&file).unwrap().lines().count();
            (lines > ROOM).then(|| format!("{}: {lines} lines", file.display()))
        })
        .collect();
    assert!(crowded.is_empty(), "{}", crowded.join("\n"));
}

/// Names that a text re-exports: `pub use a::{B, c::D};` gives B and D.
fn exported(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    for place in text.split("\npub use ").skip(1) {
        let (path, _) = place.split_once(';').unwrap();
        let list = path.split_once('{').map_or(path, |(_, list)| list.trim_end_matches('}'));
        let last = |part: &str| part.trim().rsplit("::").next().unwrap().to_owned();
        names.extend(list.split(',').map(last).filter(|name| !name.is_empty()));
    }
    names
}

/// The public face is small, and everything behind it is hidden from the documentation.
#[test]
fn the_public_face_is_small() {
    let lib = fs::read_to_string("src/lib.rs").unwrap();
    let names = exported(&lib);
    assert!(names.contains(&"Scene".to_owned()) && names.contains(&"run".to_owned()), "{names:?}");
    assert!(names.len() <= MOST_NAMES, "{} names: {names:?}", names.len());
    let lines: Vec<&str> = lib.lines().collect();
    let open = lines.windows(2).filter(|two| two[1].starts_with("pub mod "));
    let open: Vec<&str> = open.filter(|two| two[0] != "#[doc(hidden)]").map(|two| two[1]).collect();
    assert!(open.is_empty(), "neither hidden nor re-exported by name: {open:?}");
}

/// A module is a file with a folder beside it, everywhere.
#[test]
fn modules_have_one_style() {
    let old: Vec<PathBuf> =
        sources(Path::new("src")).into_iter().filter(|file| file.ends_with("mod.rs")).collect();
    assert!(old.is_empty(), "write x.rs beside x/ instead of x/mod.rs: {old:?}");
}

/// Commands of the developers' bench are none of the product's.
#[test]
fn the_bench_is_no_part_of_the_product() {
    let measures = |file: &PathBuf| {
        let text = fs::read_to_string(file).unwrap();
        text.contains("/proc/cpuinfo") || text.contains("Command::new(")
    };
    let found: Vec<PathBuf> = sources(Path::new("src")).into_iter().filter(measures).collect();
    assert!(found.is_empty(), "belongs into bench/: {found:?}");
}

/// What a reader meets first is read in one go.
#[test]
fn the_readme_is_short() {
    let words = fs::read_to_string("README.md").unwrap().split_whitespace().count();
    assert!(words <= 1200, "{words} words");
}
