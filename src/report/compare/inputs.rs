//! Which inputs of two runs differ.

use crate::hazard::LineInfo;
use crate::output::Results;
use crate::report::format;

/// Lines of the plan that say nothing that the other rows do not, or follow from what differs.
const REPEATED: [&str; 8] =
    ["scene", "file", "version", "releases", "flat edges", "corners", "lifted", "at most"];

/// Stands before the parts of the plan.
pub(super) const PLAN: &str = "Plan: ";

/// What went in and differs: name, first, second; empty when nothing does.
pub(super) fn differing(runs: &[Results; 2]) -> Vec<(String, [String; 2])> {
    let [mut mine, mut others] = runs.each_ref().map(said);
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
fn said(run: &Results) -> Vec<SaidOfGround> {
    let places = places(run);
    let run = &run.summary;
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
    rows.extend(places);
    let entries = run.plan_entries.iter().filter(|entry| !REPEATED.contains(&entry.name.as_str()));
    rows.extend(entries.map(|entry| row(&format!("{PLAN}{}", entry.name), entry.said.clone())));
    rows
}

/// What is known of the lines and objects of the scene, its barriers among them.
fn lines(run: &Results) -> impl Iterator<Item = &LineInfo> {
    run.lines_of_scene().map(|line| &line.info)
}

/// Where rocks are released, and where lines, objects and barriers stand.
fn places(run: &Results) -> Vec<SaidOfGround> {
    let zone = |(name, corners_m): (Option<&str>, &[[f64; 2]])| {
        let whose = name.map_or(String::new(), |name| format!(" “{name}”"));
        (format!("Place of releases{whose}"), place(corners_m))
    };
    let zones = run.summary.site.named_zones().map(|(name, zone)| (name, zone.corners_m()));
    let line = |line: &LineInfo| (format!("Place of “{}”", line.name), place(&line.corners_m));
    zones.map(zone).chain(lines(run).map(line)).collect()
}

/// Corners or points on the map: the first, the last and the mean tell whether any has moved.
fn place(corners_m: &[[f64; 2]]) -> String {
    let at = |[x, y]: [f64; 2]| format!("({}, {})", format::decimal(x, 1), format::decimal(y, 1));
    match corners_m {
        [] => format::NO_NUMBER.to_owned(),
        [only] => at(*only),
        [first, .., last] => {
            let count = corners_m.len();
            let mean =
                |k: usize| corners_m.iter().map(|corner| corner[k]).sum::<f64>() / count as f64;
            let centre = at([mean(0), mean(1)]);
            format!("{count} corners: first {}, last {}, mean {centre}", at(*first), at(*last))
        }
    }
}

/// How a note on what has moved begins.
const MOVED: &str = "Not at the same place in both runs: ";

/// Whether a note is such a one.
pub(super) fn is_of_moved(note: &str) -> bool {
    note.starts_with(MOVED)
}

/// A note on what has one name in both runs and stands at two places; nothing where there is none.
pub(super) fn moved(runs: &[Results; 2]) -> Option<String> {
    let [a, b] = runs;
    let has_moved = |one: &&LineInfo| {
        lines(b).any(|other| other.name == one.name && other.corners_m != one.corners_m)
    };
    let names: Vec<String> = lines(a).filter(has_moved).map(|line| line.name.clone()).collect();
    (!names.is_empty()).then(|| {
        let names = names.join(", ");
        format!("{MOVED}{names}. What differs there may come from the place alone.")
    })
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

    /// A line that is turned about its middle keeps length and middle; one corner of many that moves keeps both ends.
    #[test]
    fn a_place_tells_whether_it_has_moved() {
        let line = place(&[[0.0, 0.0], [10.0, 5.0], [20.0, 0.0]]);
        assert_eq!(line, "3 corners: first (0.0, 0.0), last (20.0, 0.0), mean (10.0, 1.7)");
        assert_ne!(place(&[[0.0, 0.0], [10.0, 6.0], [20.0, 0.0]]), line);
        assert_ne!(place(&[[10.0, -10.0], [10.0, 5.0], [10.0, 10.0]]), line);
    }
}
