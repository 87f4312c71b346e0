//! Which inputs of two runs differ.

use crate::output::Summary;

/// Lines of the plan that say nothing that the other rows do not, or follow from what differs.
const REPEATED: [&str; 6] = ["scene", "file", "version", "releases", "flat edges", "corners"];

/// Stands before the parts of the plan.
pub(super) const PLAN: &str = "Plan: ";

/// What went in and differs: name, first, second; empty when nothing does.
pub(super) fn differing(a: &Summary, b: &Summary) -> Vec<(String, [String; 2])> {
    let [mine, others] = [a, b].map(said);
    let mut rows = Vec::new();
    for (name, value) in &mine {
        let other = others.iter().find(|(known, _)| known == name);
        let other = other.map_or("–", |(_, value)| value.as_str());
        if other != value {
            rows.push((name.clone(), [value.clone(), other.to_owned()]));
        }
    }
    for (name, value) in others {
        if mine.iter().all(|(known, _)| *known != name) {
            rows.push((name, ["–".to_owned(), value]));
        }
    }
    rows
}

/// All that a run says of what went in, as name and value.
fn said(run: &Summary) -> Vec<(String, String)> {
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
