//! Which inputs of two runs differ.

use crate::output::Summary;

/// Lines of the plan that say nothing that the other rows do not, or follow from what differs.
const REPEATED: [&str; 6] = ["scene", "file", "version", "releases", "flat edges", "corners"];

/// Stands before the parts of the plan.
pub(super) const PLAN: &str = "Plan: ";

/// What went in and differs: name, first, second; empty when nothing does.
pub(super) fn differing(a: &Summary, b: &Summary) -> Vec<(String, [String; 2])> {
    let [mine, others] = [a, b].map(said);
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in mine.iter().chain(&others) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.into_iter().flat_map(|name| differing_of(name, &mine, &others)).collect()
}

/// A row for each value of a name that one run has and the other has not: a plan says the same of every ground.
fn differing_of(
    name: &str,
    mine: &[SaidOfGround],
    others: &[SaidOfGround],
) -> Vec<(String, [String; 2])> {
    let of = |all: &[SaidOfGround]| -> Vec<String> {
        all.iter().filter(|(known, _)| known == name).map(|(_, value)| value.clone()).collect()
    };
    let (mut own, mut other) = (of(mine), Vec::new());
    for value in of(others) {
        match own.iter().position(|known| *known == value) {
            Some(at) => drop(own.remove(at)),
            None => other.push(value),
        }
    }
    let value = |of: &[String], k: usize| of.get(k).cloned().unwrap_or_else(|| "–".to_owned());
    let rows = 0..own.len().max(other.len());
    rows.map(|k| (name.to_owned(), [value(&own, k), value(&other, k)])).collect()
}

/// Name and value.
type SaidOfGround = (String, String);

/// All that a run says of what went in, as name and value.
fn said(run: &Summary) -> Vec<SaidOfGround> {
    let row = |name: &str, value: String| (name.to_owned(), value);
    let id = &run.identity;
    let mut rows = vec![
        row("Title", run.title.clone()),
        row("Hash of scene and meshes", id.scene_hash.chars().take(16).collect()),
        row("Version", id.version.clone()),
        row("Seed", id.seed.to_string()),
        row("Releases", id.releases.to_string()),
    ];
    rows.extend(run.inputs.iter().cloned());
    let entries = run.plan_entries.iter().filter(|entry| !REPEATED.contains(&entry.name.as_str()));
    rows.extend(entries.map(|entry| row(&format!("{PLAN}{}", entry.name), entry.said.clone())));
    rows
}
