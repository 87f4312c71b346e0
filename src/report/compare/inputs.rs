//! Which inputs of two runs differ.

use crate::output::Summary;

/// Lines of the plan that say nothing that the other rows do not, or follow from what differs.
const REPEATED: [&str; 6] = ["scene", "file", "version", "releases", "flat edges", "corners"];

/// Stands before the parts of the plan.
pub(super) const PLAN: &str = "Plan: ";

/// What went in and differs: name, first, second; empty when nothing does.
pub(super) fn differing(a: &Summary, b: &Summary) -> Vec<(String, [String; 2])> {
    let [mut mine, mut others] = [a, b].map(said);
    one_name(&mut mine, &others);
    one_name(&mut others, &mine);
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in mine.iter().chain(&others) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names.into_iter().flat_map(|name| differing_of(name, &mine, &others)).collect()
}

/// A ground has trees in one run and none in the other: what is said of it stands in one row, as of a ground.
fn one_name(rows: &mut [SaidOfGround], others: &[SaidOfGround]) {
    for (name, _) in rows {
        let Some(ground) = name.strip_prefix("Trees ") else { continue };
        let plain = format!("Ground {ground}");
        if others.iter().any(|(other, _)| *other == plain) {
            *name = plain;
        }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Without its trees a forest was told twice: as trees that one run lacks, and as a ground that the other lacks.
    #[test]
    fn a_ground_with_trees_and_without_is_one_row() {
        let row = |name: &str| vec![(name.to_owned(), "friction angle 35°".to_owned())];
        let (mut with, without) = (row("Trees “forest”"), row("Ground “forest”"));
        one_name(&mut with, &without);
        assert_eq!(with[0].0, "Ground “forest”");
        let mut alone = row("Trees “wood”");
        one_name(&mut alone, &without);
        assert_eq!(alone[0].0, "Trees “wood”");
    }
}
