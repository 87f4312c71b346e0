//! What the plan says of memory and disk, beside what a run takes.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::rockfall;
use std::fs;
use std::path::Path;

fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The example with other entries, its meshes where they are.
fn quick(dir: &Path, entries: &[(&str, &str)]) -> std::path::PathBuf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("examples/quick.toml")).unwrap();
    let meshes = format!("{}/", root.join("terrain").display());
    let text = entries.iter().fold(text.replace("../terrain/", &meshes), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let file = dir.join("quick.toml");
    fs::write(&file, text).unwrap();
    file
}

fn plan(scene: &Path) -> String {
    String::from_utf8(rockfall(&["plan", word(scene)]).stdout).unwrap()
}

/// The number between two texts, in MB.
fn megabytes(said: &str, before: &str, behind: &str) -> f64 {
    let (_, rest) = said.split_once(before).unwrap();
    let (size, _) = rest.split_once(behind).unwrap();
    let (number, kind) = size.split_once(' ').unwrap();
    number.parse::<f64>().unwrap() * if kind == "GB" { 1e3 } else { 1.0 }
}

fn bytes_in(dir: &Path) -> u64 {
    let of = |entry: fs::DirEntry| match entry.metadata().unwrap() {
        one if one.is_dir() => bytes_in(&entry.path()),
        one => one.len(),
    };
    fs::read_dir(dir).unwrap().map(|entry| of(entry.unwrap())).sum()
}

/// Impacts are most of what such a run writes: they are counted, and named. What is said is no bound, as no one knows how often rocks strike
/// the ground: half as much again is borne.
#[test]
fn what_is_written_is_about_what_the_plan_says() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    for (impacts, largest) in [("impacts = true", "impacts.csv"), ("impacts = false", "paths.csv")]
    {
        let scene = quick(dir.path(), &[("impacts = true", impacts)]);
        let said = plan(&scene);
        let about = 1e6 * megabytes(&said, "of memory, and about ", " of disk");
        let run = rockfall(&["run", word(&scene), "--quiet", "--overwrite", "--out", word(&out)]);
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        let written = bytes_in(&out) as f64;
        assert!((written / 1.5..1.5 * written).contains(&about), "{about} {written}\n{said}");
        assert!(said.contains(&format!("of disk ({largest} ")), "{said}");
    }
}

/// A million rocks with their impacts write more than 10 GB: they are asked for first.
#[test]
fn a_million_rocks_with_impacts_are_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let scene = quick(dir.path(), &[("count = 1000\n", "count = 1000000\n")]);
    let said = plan(&scene);
    assert!(said.contains("runs with --yes only"), "{said}");
    let out = dir.path().join("out");
    let run = rockfall(&["run", word(&scene), "--out", word(&out)]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2), "{said}");
    assert!(said.contains("impacts.csv 11.6 GB") && !out.exists(), "{said}");
}
