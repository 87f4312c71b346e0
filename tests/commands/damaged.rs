//! Results of which a byte has changed, as long as they were: no command draws, compares, joins or goes on with them.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::made::{fall, info};
use crate::program::{message, rockfall, same_results};
use rockfall::output::{self, Mode, Output};
use std::fs;
use std::path::{Path, PathBuf};

fn run(out: &Path, more: &[&str]) {
    let scene = ["run", "examples/quick.toml", "--quiet", "--releases", "24", "--out"];
    let done = rockfall(&[&scene[..], &[text(out)], more].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// What a command says that must refuse what it is given.
fn refused(arguments: &[&str]) -> String {
    let done = rockfall(arguments);
    let said = String::from_utf8_lossy(&done.stderr).into_owned();
    assert_eq!(done.status.code(), Some(2), "{arguments:?}: {said}");
    said
}

/// A copy of a file with another digit in its middle, or another byte where it has none.
fn with_another_digit(path: &Path) -> Vec<u8> {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    let at = (middle..bytes.len()).find(|&at| bytes[at].is_ascii_digit()).unwrap_or(middle);
    bytes[at] ^= 1;
    bytes
}

/// Does something while a file has another digit.
fn damaged(path: &Path, then: impl FnOnce() -> String) -> String {
    let whole = fs::read(path).unwrap();
    fs::write(path, with_another_digit(path)).unwrap();
    let said = then();
    fs::write(path, whole).unwrap();
    said
}

/// The files that have checksums: all tables and rasters, and the ground under the figures; the summary ends with its own.
fn summed(dir: &Path) -> Vec<PathBuf> {
    let sums = fs::read_to_string(dir.join("results.sfv")).unwrap();
    let lines = sums.lines().filter(|line| !line.starts_with(';'));
    let names = lines.map(|line| line.split_once(' ').unwrap().0.to_owned());
    names.chain(["summary.json".to_owned()]).map(|name| dir.join(name)).collect()
}

#[test]
fn a_changed_digit_is_refused_in_every_file_by_every_command() {
    let dir = tempfile::tempdir().unwrap();
    let [out, other, compared] = ["out", "other", "compared"].map(|name| dir.path().join(name));
    run(&out, &[]);
    run(&other, &["--seed", "3"]);
    let files = summed(&out);
    for name in ["releases.csv", "paths.csv", "impacts.csv", "crossings.csv", "maps/ground.asc"] {
        assert!(files.contains(&out.join(name)), "{name}");
    }
    assert!(files.contains(&out.join("maps/passages.tif")));
    let [a, b, c] = [&out, &other, &compared].map(|path| text(path));
    for file in files {
        let by_draw = damaged(&file, || refused(&["draw", a]));
        let by_compare = damaged(&file, || refused(&["compare", a, b, "--out", c]));
        let again = ["run", "examples/quick.toml", "--quiet", "--releases", "24", "--out", a];
        let by_resume = damaged(&file, || refused(&[&again[..], &["--resume"]].concat()));
        for said in [by_draw, by_compare, by_resume] {
            assert!(said.contains(text(&file)), "{said}");
            // a digit that is no place any more may be told before
            let of_rows = said.contains("it must agree with") || said.contains("restore the row");
            assert!(of_rows || said.contains("checksum: found"), "{said}");
            assert!(said.contains("restore"), "{said}");
        }
    }
    assert!(rockfall(&["draw", a]).status.success());
}

#[test]
fn shards_of_which_a_digit_has_changed_are_not_merged() {
    let dir = tempfile::tempdir().unwrap();
    let [whole, one, two, out] = ["whole", "one", "two", "out"].map(|name| dir.path().join(name));
    run(&whole, &[]);
    run(&one, &["--shard", "1/2", "--threads", "2"]);
    run(&two, &["--shard", "2/2", "--threads", "1"]);
    let merge = ["merge", text(&one), text(&two), "--out", text(&out)];
    let state = fs::read_dir(two.join("maps")).unwrap().map(|entry| entry.unwrap().path());
    let state = state.filter(|path| path.extension().is_some_and(|ending| ending == "state"));
    for file in summed(&two).into_iter().chain([two.join("progress.json")]).chain(state) {
        let said = damaged(&file, || refused(&merge));
        assert!(said.contains(text(&file)) && said.contains("restore"), "{said}");
        let _ = fs::remove_dir_all(&out);
    }
    assert!(rockfall(&merge).status.success());
    // and the checksums of what is put together are those of the run at once
    same_results(&whole, &out);
}

/// An interrupted run knows of every row that it has written, and of its maps, what they were.
#[test]
fn an_interrupted_run_does_not_go_on_behind_a_changed_digit() {
    let dir = tempfile::tempdir().unwrap();
    let mut output = Output::create(info(60), dir.path(), Mode::Fresh).unwrap();
    output.write(&(0..9).map(fall).collect::<Vec<_>>()).unwrap();
    drop(output);
    let files = ["releases.csv", "paths.csv", "impacts.csv", "crossings.csv", "progress.json"];
    for name in files.into_iter().chain(["maps/9.state"]) {
        let said = damaged(&dir.path().join(name), || {
            message(Output::create(info(60), dir.path(), Mode::Resume))
        });
        assert!(said.contains(name) && said.contains("restore"), "{said}");
    }
    assert_eq!(Output::create(info(60), dir.path(), Mode::Resume).unwrap().remaining(), 9..60);
}

/// Results of before had no checksums: they are read, and of their paths it is still seen what cannot be.
#[test]
fn results_without_checksums_are_read_but_not_paths_that_cannot_be() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), &[]);
    fs::remove_file(dir.path().join("results.sfv")).unwrap();
    let summary = dir.path().join("summary.json");
    let sealed = fs::read_to_string(&summary).unwrap();
    let (before, _) = sealed.rsplit_once(",\n  \"crc32\"").unwrap();
    fs::write(&summary, format!("{before}\n}}\n")).unwrap();
    assert!(rockfall(&["draw", text(dir.path())]).status.success());

    let path = dir.path().join("paths.csv");
    let rows = fs::read_to_string(&path).unwrap();
    // each as long as what it replaces: results of before know how long their tables were
    let with = |line: usize, column: usize, begin: &str| {
        let mut lines: Vec<String> = rows.lines().map(str::to_owned).collect();
        let mut cells: Vec<String> = lines[line - 1].split(',').map(str::to_owned).collect();
        let width = cells[column].len();
        cells[column] = format!("{begin:0<width$}");
        lines[line - 1] = cells.join(",");
        fs::write(&path, lines.join("\n") + "\n").unwrap();
        refused(&["draw", text(dir.path())])
    };
    let said = with(5, 1, "0.0");
    assert!(said.contains("paths.csv: line 5, time_s: found 0 behind 0.1"), "{said}");
    let said = with(4, 2, "2e999");
    assert!(
        said.contains("paths.csv: line 4, x_m: found inf, which is no finite number"),
        "{said}"
    );
    let said = with(4, 11, "-1e9999");
    assert!(said.contains("paths.csv: line 4, clearance_m: found -inf"), "{said}");
    let last = rows.lines().count();
    let said = with(last, 0, "1");
    assert!(said.contains(&format!("paths.csv: line {last}, index: found 1")), "{said}");
}

#[test]
fn checksums_tell_of_lines_that_are_none() {
    let dir = tempfile::tempdir().unwrap();
    run(dir.path(), &[]);
    fs::write(dir.path().join("results.sfv"), "; a line\nreleases.csv\n").unwrap();
    let said = output::read(dir.path()).unwrap_err().to_string();
    assert!(said.contains("results.sfv: line 2: `releases.csv`"), "{said}");
}
