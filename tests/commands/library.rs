//! The library does what the command does.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program;
use program::{results, rockfall, same_results};
use rockfall::{
    Distribution, Layer, LineQuantity, Mode, Plan, Quantity, RunOptions, Scene, Selection,
};
use std::path::Path;

fn plan(releases: usize, change: impl Fn(&mut Scene)) -> Plan {
    let mut scene = Scene::read(Path::new("examples/quick.toml")).unwrap();
    scene.release.count = releases;
    change(&mut scene);
    Plan::of_scene(&scene).unwrap()
}

/// The same bytes in every file, and the results in the hand are those on the disk.
#[test]
fn a_run_from_the_library_writes_the_bytes_of_the_command() {
    let dir = tempfile::tempdir().unwrap();
    let [called, commanded] = ["called", "commanded"].map(|name| dir.path().join(name));
    let got = rockfall::run(&plan(60, |_| ()), &RunOptions::into_folder(&called)).unwrap();
    let out = commanded.to_str().unwrap();
    let run = rockfall(&["run", "examples/quick.toml", "--releases", "60", "--out", out]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    same_results(&called, &commanded);
    let read = rockfall::Results::read(&commanded).unwrap();
    assert_eq!(got.statistic(Quantity::MaxTotal), read.statistic(Quantity::MaxTotal));
    let p95 = |of: &rockfall::Results| {
        of.line("meadow").unwrap().statistic(LineQuantity::Total).percentiles["p95"].clone()
    };
    assert_eq!(p95(&got), p95(&read));
    assert!(got.line("nowhere").is_none() && got.barriers().is_empty());
    let path = got.path(3).unwrap();
    assert!(path.len() > 10 && path.iter().all(|at| at.index == 3), "{}", path.len());
    assert!(path.windows(2).all(|two| two[0].time_s <= two[1].time_s));
    // the share of the rocks that pass a cell is their number over all of them
    let [passages, reach] =
        [Layer::Passages, Layer::Reach].map(|layer| got.map(layer).unwrap().unwrap().values);
    let passed = passages.iter().zip(&reach).filter_map(|(n, share)| Some(((*n)?, (*share)?)));
    let passed: Vec<(f64, f64)> = passed.filter(|(n, _)| *n > 0.0).collect();
    assert!(passed.len() > 100 && passed.iter().all(|(n, share)| (n / 60.0 - share).abs() < 1e-6));
}

/// What is there is not written over unasked; a part is; what was begun is gone on with to the same bytes.
#[test]
fn options_do_what_the_words_of_the_command_do() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let plan_of_40 = plan(40, |_| ());
    let fresh = RunOptions::into_folder(&out);
    let whole = rockfall::run(&plan_of_40, &fresh).unwrap();
    drop(whole);
    let before = results(&out);
    assert!(rockfall::run(&plan_of_40, &fresh).unwrap_err().to_string().contains("--overwrite"));
    let resumed = RunOptions { existing: Mode::Resume, ..fresh.clone() };
    drop(rockfall::run(&plan_of_40, &resumed).unwrap());
    assert_eq!(results(&out), before);
    let one = RunOptions {
        selection: Selection::Only(7),
        threads: Some(1),
        ..RunOptions::into_folder(dir.path().join("one"))
    };
    let only = rockfall::run(&plan_of_40, &one).unwrap();
    assert_eq!((only.hazard.rocks(), only.path(7).unwrap().is_empty()), (1, false));
    let beyond = RunOptions { selection: Selection::Only(40), ..one };
    assert!(rockfall::run(&plan_of_40, &beyond).unwrap_err().to_string().contains("0 to 39"));
}

/// A value that a program changes makes another scene: its results are not gone on with, and its hash says so.
#[test]
fn a_changed_value_is_another_scene() {
    let dir = tempfile::tempdir().unwrap();
    let options = RunOptions::into_folder(dir.path().join("out"));
    let (as_read, other_count) = (plan(20, |_| ()), plan(30, |_| ()));
    assert_eq!(as_read.scene_hash, other_count.scene_hash);
    let larger = plan(20, |scene| {
        scene.rocks.radius_m = Some(Distribution::fixed(0.5).unwrap());
    });
    assert_ne!(as_read.scene_hash, larger.scene_hash);
    drop(rockfall::run(&as_read, &options).unwrap());
    let resumed = RunOptions { existing: Mode::Resume, ..options };
    assert!(rockfall::run(&larger, &resumed).is_err());
}
