//! A run in parts, put together, is the run at once, byte for byte.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::made;
use crate::program;

use made::{fall, info};
use program::{message, rockfall, same_results};
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use rockfall::Hazard;
use rockfall::output::{self, Mode, Output, RunInfo};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

const RELEASES: usize = 60;

/// A part of the made-up run.
fn part(releases: std::ops::Range<usize>) -> RunInfo {
    let mut part = info(RELEASES);
    part.identity.first_release = releases.start;
    part.identity.releases = releases.len();
    part
}

fn write(info: RunInfo, dir: &Path) {
    let mut output = Output::create(info, dir, Mode::Fresh).unwrap();
    let falls: Vec<_> = output.remaining().map(fall).collect();
    output.write(&falls).unwrap();
    output.finish().unwrap();
}

/// Writes parts that end at these releases and gives their folders.
fn write_parts(ends: &[usize], dir: &Path) -> Vec<PathBuf> {
    let starts = std::iter::once(0).chain(ends.iter().copied());
    let one = |(start, end): (usize, &usize)| {
        let folder = dir.join(format!("from_{start}"));
        write(part(start..*end), &folder);
        folder
    };
    starts.zip(ends).map(one).collect()
}

/// Cuts of a run: whatever their places and the order of the folders, the parts are the whole; sums of energy included, which
/// plain addition would spoil.
fn merge_cuts(whole: &Path, hazard: &Hazard, cases: u32) {
    let cuts = prop::collection::btree_set(1..RELEASES, 0..8);
    let config = ProptestConfig {
        source_file: Some(file!()),
        test_name: Some(concat!(module_path!(), "::merged_parts_are_the_whole_run")),
        ..ProptestConfig::with_cases(cases)
    };
    let is_whole = |(cuts, turn): (BTreeSet<usize>, usize)| {
        let dir = tempfile::tempdir().unwrap();
        let ends: Vec<usize> = cuts.into_iter().chain([RELEASES]).collect();
        prop_assume!(ends.len() > 1);
        let mut parts = write_parts(&ends, dir.path());
        let middle = turn % parts.len();
        parts.rotate_left(middle);
        let merged = dir.path().join("merged");
        let results = output::merge(&parts, &merged, Mode::Fresh).unwrap();
        same_results(whole, &merged);
        prop_assert_eq!(&results.hazard, hazard);
        Ok(())
    };
    TestRunner::new(config).run(&(cuts, 0_usize..8), is_whole).unwrap();
}

/// The cases wait for the disk most of the time: four of them do so at once.
#[test]
fn merged_parts_are_the_whole_run() {
    let dir = tempfile::tempdir().unwrap();
    let whole = dir.path().join("whole");
    write(info(RELEASES), &whole);
    let hazard = output::read(&whole).unwrap().hazard;
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| merge_cuts(&whole, &hazard, 6));
        }
    });
}

/// What cannot be a whole run is refused, with the folder or the releases that are wrong.
#[test]
fn parts_that_do_not_fit_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let parts = write_parts(&[20, 40, RELEASES], dir.path());
    let out = dir.path().join("out");
    let merge = |parts: &[PathBuf]| message(output::merge(parts, &out, Mode::Fresh));
    let [a, b, c] = [0, 1, 2].map(|at| parts[at].clone());

    let said = merge(&[a.clone(), c.clone()]);
    assert!(said.contains("releases 20..40 are in none of the folders"), "{said}");
    let said = merge(&[a.clone(), b.clone()]);
    assert!(said.contains("releases 40..60 are in none"), "{said}");
    let said = merge(&[a.clone(), b.clone(), b.clone(), c.clone()]);
    assert!(said.contains("from_20: holds releases 20..40 again; name each shard once"), "{said}");
    let said = message(output::merge(&[a.clone(), b.clone(), c.clone()], &b, Mode::Overwrite));
    assert!(said.contains("is the folder of a shard"), "{said}");
    let said = merge(&[a.clone(), dir.path().to_owned()]);
    assert!(said.contains("holds no results; name folders"), "{said}");

    let mut other = part(20..40);
    other.identity.seed = 1;
    let (other_dir, begun_dir) = (dir.path().join("other"), dir.path().join("begun"));
    write(other, &other_dir);
    let said = merge(&[a.clone(), other_dir, c.clone()]);
    assert!(said.contains("other: seed 1, not 18446744073709551615, as in"), "{said}");
    let mut begun = Output::create(part(20..40), &begun_dir, Mode::Fresh).unwrap();
    begun.write(&[fall(20)]).unwrap();
    drop(begun);
    let said = merge(&[a.clone(), begun_dir, c.clone()]);
    assert!(said.contains("begun: 1 of 20 releases of this shard are written"), "{said}");
    let whole_dir = dir.path().join("whole");
    write(info(RELEASES), &whole_dir);
    let said = merge(&[whole_dir]);
    assert!(said.contains("holds a whole run"), "{said}");
    assert!(!out.exists());
    fs::write(b.join("impacts.csv"), "index\n").unwrap();
    let said = merge(&[a, b, c]);
    assert!(said.contains("impacts.csv: length: found 6 bytes where"), "{said}");
}

/// The same through the program, with real rocks: five shards, one of them by another number of threads, figures
/// and maps included.
#[test]
fn the_program_merges_its_shards() {
    let dir = tempfile::tempdir().unwrap();
    let folder = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let run = |more: &[&str]| {
        let scene = ["run", "examples/quick.toml", "--quiet", "--releases", "64"];
        let done = rockfall(&[&scene, more].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    };
    run(&["--out", &folder("whole")]);
    let mut merge = vec!["merge".to_owned(), "--out".to_owned(), folder("merged")];
    for shard in ["4/5", "1/5", "3/5", "2/5", "5/5"] {
        let out = folder(&shard.replace('/', "_"));
        let threads = if shard == "3/5" { "3" } else { "1" };
        run(&["--shard", shard, "--out", &out, "--threads", threads]);
        merge.push(out);
    }
    let merge: Vec<&str> = merge.iter().map(String::as_str).collect();
    let done = rockfall(&merge);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    same_results(&dir.path().join("whole"), &dir.path().join("merged"));
    // a folder of results is not merged into
    let again = rockfall(&[&["merge", "--out", &folder("1_5")], &merge[3..]].concat());
    assert_eq!(again.status.code(), Some(2));
}

#[test]
fn shards_that_cannot_be_are_refused() {
    for (shard, says) in [
        ("0/4", "K from 1 to N"),
        ("5/4", "K from 1 to N"),
        ("1", "K from 1 to N"),
        ("1/0", "K from 1 to N"),
        ("-1/4", "K from 1 to N"),
        ("3/2000", "found 1000 releases; write at most as many parts"),
    ] {
        let shard = format!("--shard={shard}");
        let said = rockfall(&["run", "examples/quick.toml", &shard, "--out", "/nowhere"]);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(says), "{stderr}");
    }
}
