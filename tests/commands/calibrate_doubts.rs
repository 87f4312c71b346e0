//! What a fit does not know it does not say: values beyond the range tried, the luck of its rocks, ends that it was not given, trials
//! without an end.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use super::calibrate::{thrown, word};
use super::calibrate_selection::{rough, ways};
use crate::program;

use program::rockfall;
use rockfall::calibrate::Calibration;
use rockfall::hazard::ObservedPath;
use rockfall::output::read_calibration;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

const HEAD: &str = "release_x_m,release_y_m,x_m,y_m";

fn put_ends(dir: &Path, ends: &[ObservedPath]) {
    let mut table = format!("{HEAD}\n");
    for ObservedPath { start_m: [from_x, from_y], end_m: [x, y], .. } in ends {
        writeln!(table, "{from_x},{from_y},{x},{y}").unwrap();
    }
    fs::write(dir.join("ends.csv"), table).unwrap();
}

/// `[calibrate]` that varies the rolling friction of the meadow, whose true value is 0.45.
fn varied([from, to, before]: [f64; 3], more: &str) -> String {
    let vary = format!(
        "{{ ground = \"meadow\", key = \"rolling_friction\", from = {from}, to = {to}, before = {before} }}"
    );
    format!("[calibrate]\ndeposits = \"ends.csv\"\n{more}\nvary = [{vary}]")
}

fn calibrated(scene: &Path, releases: &str) -> (PathBuf, Output) {
    let out = scene.with_file_name("fit");
    let done = rockfall(&["calibrate", word(scene), "--releases", releases, "--out", word(&out)]);
    (out, done)
}

fn found(scene: &Path, releases: &str) -> (Calibration, String) {
    let (out, done) = calibrated(scene, releases);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    (read_calibration(&out).unwrap().unwrap(), String::from_utf8(done.stdout).unwrap())
}

/// Searched above the true value, and below it: the best value is the end of the range, and nothing is known of what lies beyond. A range
/// that begins where there is nothing beyond has an end there.
#[test]
fn an_interval_at_the_end_of_the_range_is_open() {
    let dir = tempfile::tempdir().unwrap();
    let plain = thrown(dir.path(), "edge", [3.0, 5.0], "");
    let text = fs::read_to_string(&plain).unwrap();
    fs::write(&plain, text.replace("rolling_friction = 0.45", "rolling_friction = 0.2")).unwrap();
    let ends = ways(&plain, 21, 60);
    put_ends(dir.path(), &ends);
    let fit = |range: [f64; 3]| {
        let more = varied(range, "held_out = 0.0");
        let scene = thrown(dir.path(), "edge", [3.0, 5.0], &more);
        let (fit, said) = found(&scene, "40");
        (fit, said, scene)
    };
    let (above, said, scene) = fit([0.4, 0.65, 0.5]);
    let told = &above.told[0];
    assert!(told.low_95.is_none() && told.high_95.is_some_and(|high| high < 0.5), "{told:?}");
    assert!(said.contains(" or less)"), "{said}");
    let warned = ["reach the lower end of the range tried, 0.4, and better", "do not explain the"];
    for warning in warned {
        assert!(said.contains(warning), "{said}");
        assert!(above.warnings.iter().any(|one| one.contains(warning)), "{:?}", above.warnings);
    }
    let out = scene.with_file_name("fit");
    let run = rockfall(&["run", word(&scene), "--quiet", "--overwrite", "--out", word(&out)]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(warned.iter().all(|warning| page.contains(warning)), "the page warns of it too");
    let (below, said, _) = fit([0.05, 0.12, 0.1]);
    assert!(below.told[0].low_95.is_some() && below.told[0].high_95.is_none(), "{said}");
    assert!(said.contains("reach the upper end of the range tried, 0.12, and better"), "{said}");
    let (inside, said, _) = fit([0.1, 0.6, 0.5]);
    assert!(inside.warnings.is_empty() && !said.contains("warning"), "{said}");
    // no rolling friction is less than none
    let far = |way: &ObservedPath| ObservedPath { end_m: [way.end_m[0] + 30.0, 0.0], ..*way };
    put_ends(dir.path(), &ends.iter().map(far).collect::<Vec<_>>());
    let (none, said, _) = fit([0.0, 0.6, 0.3]);
    assert_eq!(none.told[0].low_95, Some(0.0), "{said}");
}

/// Beside 600 ends the chance of 40 computed rocks is nearly all there is: the mean of as many has a standard error of `s/√40`, of which an interval
/// of 95 % holds 1.96 to either side. Of the ends alone it had a fifth of that.
#[test]
fn the_luck_of_computed_rocks_is_in_the_intervals() {
    let dir = tempfile::tempdir().unwrap();
    let measured = ways(&rough(dir.path(), 7, ""), 7, 600);
    put_ends(dir.path(), &measured);
    let scene = rough(dir.path(), 1, &varied([0.2, 0.8, 0.45], "held_out = 0.0"));
    let (fit, said) = found(&scene, "10");
    let along = fit.measures.iter().find(|one| one.what.starts_with("standard deviation along"));
    let mean = fit.measures.iter().find(|one| one.what.starts_with("mean runout")).unwrap();
    let (along, computed) = (along.unwrap(), fit.whole.all.computed as f64);
    let width = |low: Option<f64>, high: Option<f64>| high.unwrap() - low.unwrap();
    let exact = 2.0 * 1.96 * along.computed / computed.sqrt();
    // a deviation of forty is known to a ninth, an end of an interval from 200 drawings to as much
    let over = width(mean.low_95, mean.high_95) / exact;
    assert!((0.7..1.5).contains(&over), "{over} of {exact}: {said}");
    // of a standard deviation of normal ends the standard error is s/√(2n)
    let over = width(along.low_95, along.high_95) / (exact / 2.0_f64.sqrt());
    assert!((0.5..2.0).contains(&over), "{over}: {said}");
    let told = &fit.told[0];
    let told_width = told.high_95.unwrap_or(0.8) - told.low_95.unwrap_or(0.2);
    assert!(told_width > 0.1, "{said}");
}

/// What is held out of a fit decides nothing of it: where its ends lie elsewhere, all trials and scores of the other part stay.
#[test]
fn a_fit_does_not_know_the_ends_that_are_held_out() {
    let dir = tempfile::tempdir().unwrap();
    let scene = thrown(dir.path(), "apart", [3.0, 5.0], "");
    let ends = ways(&scene, 5, 24);
    let fitted = |shift_m: f64| {
        let blocks = ends.iter().enumerate().map(|(row, way)| {
            let block = row % 4;
            let x = way.end_m[0] + if block % 2 == 1 { shift_m } else { 0.0 };
            format!("{},{},{x},{},b{block}\n", way.start_m[0], way.start_m[1], way.end_m[1])
        });
        let table = format!("{HEAD},block\n{}", blocks.collect::<String>());
        fs::write(dir.path().join("ends.csv"), table).unwrap();
        let scene = thrown(dir.path(), "apart", [3.0, 5.0], &varied([0.2, 3.0, 0.7], ""));
        let (fit, _) = found(&scene, "20");
        let rows = fs::read_to_string(scene.with_file_name("fit").join("calibration.csv")).unwrap();
        let fitted = |row: &&str| row.starts_with("2,");
        // held out, the value, and the scores on the fitted ends
        let known = |row: &str| row.split(',').take(5).collect::<Vec<_>>().join(",");
        let rows: Vec<String> = rows.lines().filter(fitted).map(known).collect();
        (fit.held_out[1].kept_apart.measured_mean_m, rows)
    };
    let plain = fitted(0.0);
    for shift_m in [0.2, 4.0, 20.0] {
        let moved = fitted(shift_m);
        assert!((moved.0 - plain.0).abs() > 0.1, "the part held out has moved");
        assert_eq!(moved.1, plain.1, "by {shift_m} m");
    }
}

/// Of the values tried some let no rock run so far as those that were measured: bad trials, as the values before the fit may be one.
/// Where none of them does, the key is to blame and no rock that failed.
#[test]
fn trials_without_an_end_are_bad_ones() {
    let dir = tempfile::tempdir().unwrap();
    let plain = thrown(dir.path(), "short", [3.0, 5.0], "");
    let mut ends = ways(&plain, 9, 60);
    ends.retain(|way| way.ran(Some(2.0)));
    assert!(ends.len() > 10, "{}", ends.len());
    put_ends(dir.path(), &ends);
    let scene = |range: [f64; 3], score: &str| {
        let more = varied(range, &format!("least_runout_m = 2.0\nscore = \"{score}\""));
        thrown(dir.path(), "short", [3.0, 5.0], &more)
    };
    for score in ["runout", "ends"] {
        let (fit, said) = found(&scene([0.2, 9.0, 9.0], score), "40");
        assert!((fit.whole.values[0] - 0.45).abs() < 0.3, "{said}");
        assert!((fit.before.all.computed, fit.before.all.stayed) == (0, 160), "{said}");
        assert!(said.contains("no computed end, 160 not compared"), "{said}");
        assert!(fit.told[0].high_95.is_some_and(|high| high < 2.0), "{said}");
    }
    let (_, done) = calibrated(&scene([8.0, 9.0, 8.5], "runout"), "40");
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    let blamed =
        "[calibrate] least_runout_m: found 2, and in no trial a rock that runs so far; write";
    assert!(said.contains(blamed), "{said}");
}

/// Blanks after commas, as people write them, are no part of names and numbers, nor of blocks.
#[test]
fn blanks_in_a_table_of_ends_are_none_of_it() {
    let dir = tempfile::tempdir().unwrap();
    let rows = " 1 , 2.5, 3 ,\t4, a \n1,2, 5, 6 ,b\n1,2,7,8, a\n";
    let table = format!("{}, block\n{rows}", HEAD.replace(',', ", "));
    fs::write(dir.path().join("ends.csv"), table).unwrap();
    let file = dir.path().join("ends.csv");
    let ends = rockfall::scene::MeasuredEnds { file: file.clone(), least_runout_m: None };
    let found = ObservedPath::read(&ends).unwrap();
    assert_eq!(found[0], ObservedPath { start_m: [1.0, 2.5], end_m: [3.0, 4.0], open: None });
    assert_eq!(found.len(), 3);
    assert_eq!(ObservedPath::read_blocks(&file).unwrap(), ["a", "b", "a"]);
}
