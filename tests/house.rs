//! The house stays a house: floors use only floors below them, and rooms stay small.
#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources has failed")]

use std::fs;
use std::path::{Path, PathBuf};

/// Longest file (lines).
const ROOM: usize = 400;

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
    let crowded: Vec<String> = ["src", "tests", "bench"]
        .iter()
        .flat_map(|dir| sources(Path::new(dir)))
        .filter_map(|file| {
            let lines = fs::read_to_string(&file).unwrap().lines().count();
            (lines > ROOM).then(|| format!("{}: {lines} lines", file.display()))
        })
        .collect();
    assert!(crowded.is_empty(), "{}", crowded.join("\n"));
}
