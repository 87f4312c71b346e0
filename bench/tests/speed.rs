//! The study of speed on a small slope: every number is there, and what only records changes no rock.

use rockfall_bench::speed::{SpeedOptions, study, write};
use std::fs;
use std::path::PathBuf;
use std::process::Command;

/// Parts that record and change nothing.
const RECORDS: [&str; 5] =
    ["paths, every 0.05 s", "impacts", "three lines", "a barrier", "maps, cells of 2 m"];
/// Parts that change the way of every rock.
const CHANGES: [&str; 2] = ["rolling friction", "roughness of 10°"];

/// The product's program, built as this test was: that a test is asked for as well (the smallest) gives it the features of
/// dependencies that tests have, for which all of it is there already.
fn product() -> PathBuf {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let built = Command::new(env!("CARGO"))
        .args([
            "build",
            "--locked",
            "--package",
            "rockfall",
            "--bin",
            "rockfall",
            "--test",
            "house",
        ])
        .current_dir(root)
        .status();
    assert!(built.expect("cargo can be started").success(), "the product is not built");
    // …/target/debug/deps/speed-0123: two folders up
    let own = std::env::current_exe().expect("a test knows where it is");
    let folder = own.parent().and_then(|deps| deps.parent()).expect("cargo's folder");
    folder.join(format!("rockfall{}", std::env::consts::EXE_SUFFIX))
}

#[test]
fn the_study_measures_every_scheme_and_every_part() {
    let dir = tempfile::tempdir().expect("a folder to work in");
    let order = SpeedOptions {
        rocks: 6,
        triangles: vec![2000, 4000],
        written: 300,
        program: product(),
        source: None,
    };
    let found = study(&order, &dir.path().join("work"), |_| ()).expect("the study runs");
    assert_eq!((found.rates.len(), found.slopes.len(), found.runs.len()), (8, 2, 4));
    for rate in &found.rates {
        let name = rate.scheme.name();
        assert!(rate.effort.steps > 0 && rate.effort.leaps > 0 && rate.failed == 0, "{name}");
        let s = rate.shares;
        let sum = s.leap + s.geometry + s.algebra + s.notes + s.output;
        assert!((sum - 1.0).abs() < 1e-9, "{name}: {sum}");
    }
    for part in &found.parts {
        let [without, with] = part.effort;
        let same = part.same_rocks && without == with;
        assert!(same || !RECORDS.contains(&part.name), "{}", part.name);
        assert!(!same || !CHANGES.contains(&part.name), "{}", part.name);
    }
    // a triangle with its share of edges and corners, and no more
    let bytes = found.slopes.iter().map(|slope| slope.bytes / slope.triangles);
    assert!(
        bytes.clone().all(|each| (100..400).contains(&each)),
        "{:?}",
        bytes.collect::<Vec<_>>()
    );
    write(&found, dir.path()).expect("the page is written");
    let read = |name: &str| fs::read_to_string(dir.path().join(name)).expect(name);
    assert_eq!(read("speed.csv").lines().count(), 1 + found.rates.len());
    assert_eq!(read("parts.csv").lines().count(), 1 + found.parts.len());
    let page = read("README.md");
    assert!(page.contains("rustc 1.") && page.contains("(speed.svg)"), "{page}");
    assert!(read("speed.svg").contains("reference"));
    assert!(!dir.path().join("work").exists(), "the folder to work in is left");
}
