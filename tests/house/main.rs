//! The house stays a house: floors use only floors below them, and rooms stay small.
#![allow(clippy::unwrap_used, reason = "a test that cannot read the sources has failed")]

mod circles;
mod comments;
mod law;
mod words;

use std::fs;
use std::path::{Path, PathBuf};

/// Longest file (lines).
const ROOM: usize = 400;
/// Most arguments of a function, `self` left out.
const MOST_ARGUMENTS: usize = 5;
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

/// Roots of the packages of which the product is made, the lowest first. The folders of the lower ones stand in that of the
/// uppermost, as do their sources.
const ROOTS: [&str; 3] = ["src/base", ENGINE, "src"];
const ENGINE: &str = "src/engine";

/// A source's path inside its package, as the compiler sees it.
fn in_package(file: &Path) -> &Path {
    ROOTS.iter().find_map(|root| file.strip_prefix(root).ok()).unwrap_or(file)
}

/// Floors of the physics.
const PHYSICS: [&str; 4] = ["contact", "flight", "solver", "simulation"];

/// The files of a floor, its own first, without those of unit tests.
fn files_of(floor: &str) -> Vec<PathBuf> {
    let is_test = |file: &PathBuf| file.iter().any(|part| part == "tests" || part == "tests.rs");
    let inside = sources(Path::new(&format!("{ENGINE}/{floor}"))).into_iter();
    let own = std::iter::once(format!("{ENGINE}/{floor}.rs").into());
    own.chain(inside.filter(|file| !is_test(file))).collect()
}

/// What of a text is not its unit tests.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text)
}

/// Modules in the order in which the `lib.rs` of all list them, bottom floor first.
fn floors() -> Vec<String> {
    let libs = ROOTS.map(|root| fs::read_to_string(format!("{root}/lib.rs")).unwrap());
    let name = |line: &str| {
        line.strip_prefix("pub mod ").map(|rest| rest.trim_end_matches(';').to_owned())
    };
    libs.iter().flat_map(|lib| lib.lines().filter_map(name)).collect()
}

fn floor_of(file: &Path) -> Option<String> {
    let first = in_package(file).components().next()?.as_os_str().to_str()?;
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

/// Names that a text re-exports and does not hide: `pub use a::{B, c::D};` gives B and D.
fn exported(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let places: Vec<&str> = text.split("\npub use ").collect();
    for two in places.windows(2).filter(|two| !two[0].ends_with("#[doc(hidden)]")) {
        let (path, _) = two[1].split_once(';').unwrap();
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

/// Parts of a list that commas separate outside all brackets.
fn parts(list: &str) -> Vec<&str> {
    let (mut depth, mut from, mut before, mut found) = (0, 0, ' ', Vec::new());
    for (at, c) in list.char_indices() {
        match c {
            '(' | '[' | '{' | '<' => depth += 1,
            ')' | ']' | '}' => depth -= 1,
            // the arrow of a closure's type closes nothing
            '>' if before != '-' => depth -= 1,
            ',' if depth == 0 => found.push(&list[std::mem::replace(&mut from, at + 1)..at]),
            _ => {}
        }
        before = c;
    }
    found.push(&list[from..]);
    found.into_iter().map(str::trim).filter(|part| !part.is_empty()).collect()
}

/// Functions of a text with the number of their arguments; random cases of a property (`x in range`) are none.
fn functions(text: &str) -> Vec<(String, usize)> {
    let code: Vec<&str> =
        text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let code = code.join("\n");
    let after_fn = code
        .match_indices("fn ")
        .filter(|(at, _)| *at == 0 || code[..*at].ends_with([' ', '\n', '(']));
    let mut found = Vec::new();
    for (at, word) in after_fn {
        let rest = &code[at + word.len()..];
        let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        let Some(open) = rest.find('(').filter(|_| !name.is_empty()) else { continue };
        let mut depth = 0;
        let close = rest[open..].char_indices().find(|(_, c)| {
            depth += i32::from(*c == '(') - i32::from(*c == ')');
            depth == 0
        });
        let Some((length, _)) = close else { continue };
        let is_argument = |part: &&str| {
            let own = part.trim_start_matches("mut ");
            !own.ends_with("self") && !own.contains("self:") && !part.contains(" in ")
        };
        let list = &rest[open + 1..open + length];
        found.push((name, parts(list).iter().filter(|part| is_argument(part)).count()));
    }
    found
}

#[test]
fn functions_have_few_arguments() {
    let five = "fn a<T: Into<[f64; 2]>>(&mut self, a: (u8, u8), b: impl Fn(u8, u8) -> Vec<u8>, c: &[u8], d: u8, e: u8,) {";
    assert_eq!(functions(five), [("a".to_owned(), 5)]);
    let mut long = Vec::new();
    let mut seen = 0;
    for file in sources(Path::new("src")) {
        for (name, count) in functions(&fs::read_to_string(&file).unwrap()) {
            seen += 1;
            if count > MOST_ARGUMENTS {
                long.push(format!("{}: {name} has {count} arguments", file.display()));
            }
        }
    }
    assert!(seen > 1000, "{seen} functions");
    assert!(long.is_empty(), "{}", long.join("\n"));
}
