//! Modules of one floor, too, stand in an order: of two neighbours in one folder, with all that is inside them, no circle of
//! uses leads from one back to itself. What a module shares with its own submodules is its own affair.

use super::{in_package, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

type Module = Vec<String>;

fn module_of(file: &Path) -> Module {
    let inside = in_package(file).with_extension("");
    inside.iter().map(|part| part.to_str().unwrap().to_owned()).collect()
}

/// Text without comments and without its unit tests.
fn code_of(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text);
    code.lines().filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

/// Ends of a path that may have braces, the common part written out: `a::{b, c::{d}}` is `a::b` and `a::c::d`.
fn paths(text: &str, begun: &[String], found: &mut Vec<Module>) {
    let mut own = begun.to_vec();
    let mut word = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if c.is_alphanumeric() || c == '_' {
            word.push(c);
            rest = &rest[c.len_utf8()..];
        } else if let Some(inner) = rest.strip_prefix("::{") {
            own.push(std::mem::take(&mut word));
            let end = closing(inner);
            for part in parts(&inner[..end]) {
                paths(part.trim(), &own, found);
            }
            return;
        } else if let Some(after) = rest.strip_prefix("::") {
            own.push(std::mem::take(&mut word));
            rest = after;
        } else {
            break;
        }
    }
    own.push(word);
    found.push(own);
}

/// Where the brace that is already open is closed.
fn closing(text: &str) -> usize {
    let mut depth = 1;
    let end = text.char_indices().find(|(_, c)| {
        depth += i32::from(*c == '{') - i32::from(*c == '}');
        depth == 0
    });
    end.map_or(text.len(), |(at, _)| at)
}

/// Parts between the commas that are in no inner brace.
fn parts(text: &str) -> Vec<&str> {
    let (mut depth, mut from, mut found) = (0, 0, Vec::new());
    for (at, c) in text.char_indices() {
        depth += i32::from(c == '{') - i32::from(c == '}');
        if c == ',' && depth == 0 {
            found.push(&text[from..at]);
            from = at + 1;
        }
    }
    found.push(&text[from..]);
    found
}

/// Modules that a module names by `crate::` or `super::`.
fn uses(module: &Module, code: &str, known: &BTreeSet<Module>) -> BTreeSet<Module> {
    let mut found = Vec::new();
    for start in ["crate::", "super::"] {
        for (at, _) in code.match_indices(start) {
            let before = code[..at].chars().next_back();
            if before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':') {
                paths(&code[at..], &[], &mut found);
            }
        }
    }
    let absolute = |path: Module| -> Module {
        let up = path.iter().take_while(|part| *part == "super").count();
        if up == 0 {
            return path[1..].to_vec();
        }
        let kept = module.len().saturating_sub(up);
        [&module[..kept], &path[up..]].concat()
    };
    let longest = |path: Module| {
        (1..=path.len()).rev().map(|n| path[..n].to_vec()).find(|part| known.contains(part))
    };
    found.into_iter().map(absolute).filter_map(longest).filter(|used| used != module).collect()
}

type Neighbours = BTreeMap<String, BTreeSet<String>>;

/// Who uses whom among the modules right inside `folder`.
fn among(folder: &[String], all: &BTreeMap<Module, BTreeSet<Module>>) -> Neighbours {
    let n = folder.len();
    let inside = |module: &Module| module.len() > n && module.starts_with(folder);
    let mut graph = Neighbours::new();
    for (module, used) in all.iter().filter(|(module, _)| inside(module)) {
        let others = used.iter().filter(|used| inside(used)).map(|used| used[n].clone());
        graph.entry(module[n].clone()).or_default().extend(others.filter(|o| *o != module[n]));
    }
    graph
}

/// All that is used from `start`, directly or through others.
fn reached(graph: &Neighbours, start: &str) -> BTreeSet<String> {
    let mut reached = BTreeSet::new();
    let mut open = vec![start.to_owned()];
    while let Some(one) = open.pop() {
        for next in graph.get(&one).into_iter().flatten() {
            if reached.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    reached
}

#[test]
fn no_circle_leads_through_neighbours() {
    let files: Vec<_> = sources(Path::new("src"))
        .into_iter()
        .filter(|file| !file.ends_with("main.rs") && !file.ends_with("lib.rs"))
        .collect();
    let known: BTreeSet<Module> = files.iter().map(|file| module_of(file)).collect();
    let all: BTreeMap<Module, BTreeSet<Module>> = files
        .iter()
        .map(|file| (module_of(file), code_of(&fs::read_to_string(file).unwrap())))
        .filter(|(module, _)| !module.iter().any(|part| part == "tests"))
        .map(|(module, code)| (module.clone(), uses(&module, &code, &known)))
        .collect();
    let folders: BTreeSet<Module> =
        known.iter().map(|module| module[..module.len() - 1].to_vec()).collect();
    let mut circles = Vec::new();
    for folder in &folders {
        let graph = among(folder, &all);
        let in_circle: Vec<_> =
            graph.keys().filter(|one| reached(&graph, one).contains(*one)).cloned().collect();
        if !in_circle.is_empty() {
            circles.push(format!("{}: {}", folder.join("/"), in_circle.join(", ")));
        }
    }
    assert!(circles.is_empty(), "circles among neighbours in\n{}", circles.join("\n"));
}
