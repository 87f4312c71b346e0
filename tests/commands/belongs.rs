//! A run belongs to its user: nothing of theirs is written over, and nothing is left that came to nothing.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]
#![cfg(unix)]

use crate::made;
use crate::program;

use made::{fall, info};
use program::{command, message, results, rockfall, same_results};
use rockfall::output::{self, Mode, Output};
use rockfall::simulation::CellPassage;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const RELEASES: usize = 40;

fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn write_all(dir: &Path, mode: Mode) -> rockfall::error::Result<()> {
    let mut output = Output::create(info(RELEASES), dir, mode)?;
    let falls: Vec<_> = output.remaining().map(fall).collect();
    output.write(&falls)?;
    output.finish().map(|_| ())
}

/// Names of all files and folders below a folder.
fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(dir)
        .into_iter()
        .flatten()
        .flat_map(|entry| {
            let path = entry.unwrap().path();
            let below = if path.is_dir() { names(&path) } else { Vec::new() };
            below.into_iter().chain([word(&path).to_owned()]).collect::<Vec<_>>()
        })
        .collect();
    names.sort();
    names
}

/// A run that ends before its first row, and a folder that is not its own.
#[test]
fn what_comes_to_nothing_leaves_nothing_behind() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("a/b/out");
    drop(Output::create(info(RELEASES), &out, Mode::Fresh).unwrap());
    assert_eq!(names(dir.path()), [""; 0]);
    // beside what the user has there
    fs::create_dir_all(&out).unwrap();
    fs::write(out.join("notes.txt"), "mine").unwrap();
    let before = names(dir.path());
    drop(Output::create(info(RELEASES), &out, Mode::Resume).unwrap());
    assert_eq!(names(dir.path()), before);
    // a folder of another's results is not touched at all
    fs::write(out.join("releases.csv"), "mine").unwrap();
    let before = names(dir.path());
    for mode in [Mode::Fresh, Mode::Resume] {
        assert!(message(Output::create(info(RELEASES), &out, mode)).contains("holds releases.csv"));
        assert_eq!(names(dir.path()), before);
    }
}

/// Two rocks that overlap are found when all are made: the folder made for them goes again.
#[test]
fn a_refused_world_leaves_no_folder() {
    let dir = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string("examples/paper/3_containers_adaptive.toml").unwrap();
    let scene = scene
        .replace("radius_m = ", "radius_m = 3.0 # ")
        .replace("../..", env!("CARGO_MANIFEST_DIR"));
    let file = dir.path().join("scene.toml");
    fs::write(&file, scene).unwrap();
    let out = dir.path().join("out");
    let said = rockfall(&["run", word(&file), "--quiet", "--out", word(&out)]);
    assert_eq!(said.status.code(), Some(2), "{}", String::from_utf8_lossy(&said.stderr));
    assert!(!out.exists(), "{:?}", names(&out));
}

/// Rows that go missing in a finished folder are noticed, nothing is written, and the restored file is left alone.
#[test]
fn a_finished_folder_is_never_cut() {
    for table in ["releases.csv", "paths.csv", "impacts.csv", "crossings.csv"] {
        let dir = tempfile::tempdir().unwrap();
        write_all(dir.path(), Mode::Fresh).unwrap();
        let before = results(dir.path());
        let path = dir.path().join(table);
        let whole = fs::read_to_string(&path).unwrap();
        for spoilt in [
            whole[..=whole.trim_end().rfind('\n').unwrap()].to_owned(),
            whole.clone() + &whole[whole.find('\n').unwrap() + 1..],
        ] {
            fs::write(&path, &spoilt).unwrap();
            let said = message(write_all(dir.path(), Mode::Resume));
            assert!(said.contains(table) && said.contains("restore"), "{said}");
            assert!(message(output::read(dir.path())).contains(table));
            assert_eq!(fs::read_to_string(&path).unwrap(), spoilt, "{table} was changed");
        }
        fs::write(&path, &whole).unwrap();
        write_all(dir.path(), Mode::Resume).unwrap();
        assert_eq!(results(dir.path()), before);
    }
}

/// Rasters are made of all rocks, and cannot be drawn anew from tables: one that is missing or cut in a finished folder is told, and the rest is left
/// as it is.
#[test]
fn a_map_that_is_missing_is_told() {
    let dir = tempfile::tempdir().unwrap();
    write_all(dir.path(), Mode::Fresh).unwrap();
    let before = results(dir.path());
    let all = names(&dir.path().join("maps"));
    let rasters: Vec<&String> = all
        .iter()
        .filter(|name| Path::new(name).extension().is_some_and(|x| x == "asc" || x == "tif"))
        .collect();
    assert!(rasters.len() > 8, "{all:?}");
    for path in rasters {
        let whole = fs::read(path).unwrap();
        fs::remove_file(path).unwrap();
        let said = message(write_all(dir.path(), Mode::Resume));
        assert!(said.contains(path.as_str()) && said.contains("restore the file"), "{said}");
        fs::write(path, &whole[..whole.len() - 1]).unwrap();
        let said = message(write_all(dir.path(), Mode::Resume));
        assert!(said.contains(path.as_str()) && said.contains("bytes where"), "{said}");
        fs::write(path, &whole).unwrap();
    }
    write_all(dir.path(), Mode::Resume).unwrap();
    assert_eq!(results(dir.path()), before);
}

/// Killed in the first instant of `--overwrite`, or while any file is written: nothing half-written outlives the next run.
#[test]
fn no_half_written_file_stays() {
    let dir = tempfile::tempdir().unwrap();
    write_all(dir.path(), Mode::Fresh).unwrap();
    let before = names(dir.path());
    for mode in [Mode::Resume, Mode::Overwrite] {
        for file in ["progress.json", "summary.json", "report.html", "view.glb"] {
            fs::write(dir.path().join(format!("{file}.part")), "{ \"title\": ").unwrap();
        }
        write_all(dir.path(), mode).unwrap();
        assert_eq!(names(dir.path()), before);
    }
}

/// A part that is the whole is put together like any other.
#[test]
fn one_part_of_one_is_merged() {
    let dir = tempfile::tempdir().unwrap();
    let [whole, part, merged] = ["whole", "part", "merged"].map(|name| dir.path().join(name));
    let run = ["run", "examples/quick.toml", "--quiet", "--releases", "30", "--out"];
    assert!(rockfall(&[&run[..], &[word(&whole)]].concat()).status.success());
    assert!(rockfall(&[&run[..], &[word(&part), "--shard", "1/1"]].concat()).status.success());
    let done = rockfall(&["merge", word(&part), "--out", word(&merged)]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    same_results(&whole, &merged);
    // what merge says, merge can do
    let begun = dir.path().join("begun");
    let mut half = Output::create(info(RELEASES), &begun, Mode::Fresh).unwrap();
    half.write(&[fall(0)]).unwrap();
    drop(half);
    let said = message(Output::create(info(RELEASES), &begun, Mode::Merge));
    assert!(said.contains("--overwrite") && !said.contains("--resume"), "{said}");
}

/// Whoever runs the program under `nohup` wants it to outlive the terminal; whoever does not gets the way to go on.
#[test]
#[cfg(target_os = "linux")]
fn a_hang_up_is_ignored_under_nohup_alone() {
    let dir = tempfile::tempdir().unwrap();
    // a shell cannot undo what it was started with: under nohup there is only the first case
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    let is_nohup = ignored.is_some_and(|mask| mask & 1 != 0);
    let cases = [("trap '' HUP; ", 0), ("", 130)];
    for (trap, status) in cases.into_iter().take(if is_nohup { 1 } else { 2 }) {
        let out = dir.path().join(format!("out_{status}"));
        let script = format!(
            "{trap}exec {} run examples/quick.toml --quiet --releases 1500 --threads 1 --out {}",
            env!("CARGO_BIN_EXE_rockfall"),
            word(&out)
        );
        let child = Command::new("sh")
            .args(["-c", &script])
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        while !out.join("progress.json").exists() && begun.elapsed() < Duration::from_secs(60) {
            sleep(Duration::from_millis(2));
        }
        let pid = child.id().to_string();
        assert!(Command::new("kill").args(["-HUP", &pid]).status().unwrap().success());
        let ended = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(status), "{said}");
    }
}

/// What is read is never written over.
#[test]
fn a_mesh_is_not_written_over_what_it_is_made_of() {
    let dir = tempfile::tempdir().unwrap();
    let grid = dir.path().join("grid.asc");
    let text = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    fs::write(&grid, text).unwrap();
    let link = dir.path().join("link.stl");
    std::os::unix::fs::symlink(&grid, &link).unwrap();
    for out in [&grid, &link] {
        let said = rockfall(&["mesh", "from-grid", word(&grid), word(out)]);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains("is the file that is read"), "{stderr}");
    }
    assert_eq!(fs::read_to_string(&grid).unwrap(), text);
    let (list, slope) = (dir.path().join("trees.csv"), dir.path().join("slope.stl"));
    fs::write(&list, "x,y,dbh_m,height_m\n20,20,0.4,10\n").unwrap();
    fs::copy("terrain/quick_slope.stl", &slope).unwrap();
    for out in [&list, &slope] {
        let said = rockfall(&["mesh", "stems", word(&list), word(&slope), word(out)]);
        assert_eq!(said.status.code(), Some(2));
    }
    assert_eq!(fs::read(&slope).unwrap(), fs::read("terrain/quick_slope.stl").unwrap());
}

/// A mesh that does not fit on the disk leaves the one before as it was, and no part of itself; one that is written goes
/// where a link leads.
#[test]
#[cfg(target_os = "linux")]
fn a_mesh_is_written_whole_or_not_at_all() {
    let dir = tempfile::tempdir().unwrap();
    let (out, link) = (dir.path().join("slope.stl"), dir.path().join("link.stl"));
    fs::write(&out, "the mesh before").unwrap();
    std::os::unix::fs::symlink(&out, &link).unwrap();
    let before = names(dir.path());
    let program = env!("CARGO_BIN_EXE_rockfall");
    let script = format!("ulimit -f 4; exec {program} mesh make valley_slope {}", word(&link));
    let done = Command::new("sh").args(["-c", &script]).output().unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{said}");
    assert!(said.contains("File too large"), "{said}");
    assert_eq!(fs::read(&out).unwrap(), b"the mesh before");
    assert_eq!(names(dir.path()), before);
    assert!(rockfall(&["mesh", "make", "paper_roof", word(&link)]).status.success());
    assert!(link.is_symlink());
    assert_eq!(fs::read(&out).unwrap(), fs::read("terrain/paper_roof.stl").unwrap());
    assert_eq!(names(dir.path()), before);
    let piped = rockfall(&["mesh", "make", "paper_roof", "/dev/stdout"]);
    assert_eq!(piped.stdout[..84], fs::read(&out).unwrap()[..84]);
}

/// The state of fine maps is as long as they are: it is not written after every chunk, but when the run ends.
#[test]
fn the_state_of_fine_maps_is_written_now_and_then() {
    let dir = tempfile::tempdir().unwrap();
    let mut info = info(RELEASES);
    let frame = info.maps.as_mut().unwrap();
    (frame.columns, frame.rows, frame.cell_m) = (400, 300, 0.2);
    let mut output = Output::create(info, dir.path(), Mode::Fresh).unwrap();
    let done = || {
        let said = fs::read_to_string(dir.path().join("progress.json")).unwrap();
        let said: serde_json::Value = serde_json::from_str(&said).unwrap();
        said["done"].as_u64().unwrap()
    };
    let mut marks = Vec::new();
    for index in 0..RELEASES {
        let mut fall = fall(index);
        if index == 0 {
            let known = fall.passages[0];
            fall.passages = (0..60_000).map(|cell| CellPassage { cell, ..known }).collect();
        }
        output.write(&[fall]).unwrap();
        marks.push(done());
    }
    let written: BTreeSet<u64> = marks.iter().copied().collect();
    assert!(written.len() < RELEASES / 2, "{marks:?}");
    output.keep().unwrap();
    assert_eq!(done(), RELEASES as u64);
    let states = names(&dir.path().join("maps"));
    assert_eq!(states.len(), 1, "one state at a time: {states:?}");
}

/// Another file of measured ends is another scene, and results name the build they come from.
#[test]
fn results_know_their_measured_ends_and_their_build() {
    let dir = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string("examples/tschamut.toml").unwrap();
    let home = format!("{}/terrain", env!("CARGO_MANIFEST_DIR"));
    let ends = dir.path().join("ends.csv");
    let file = dir.path().join("scene.toml");
    let own = format!("deposits = {:?}", word(&ends));
    let scene = scene
        .replace("deposits = \"../terrain/tschamut/observed_deposition.csv\"", &own)
        .replace("../terrain", &home);
    fs::write(&file, scene).unwrap();
    let measured = fs::read_to_string("terrain/tschamut/observed_deposition.csv").unwrap();
    let hash = |text: &str| {
        fs::write(&ends, text).unwrap();
        rockfall::scene::Scene::read(&file).unwrap().hash
    };
    assert_ne!(hash(&measured), hash(&measured[..=measured.trim_end().rfind('\n').unwrap()]));
    fs::remove_file(&ends).unwrap();
    let said = rockfall(&["plan", word(&file)]);
    let stderr = String::from_utf8(said.stderr).unwrap();
    assert!(stderr.contains("[calibrate] deposits") && stderr.contains("ends.csv"), "{stderr}");
    let plan = command(&["plan", "examples/quick.toml"]).output().unwrap();
    let plan = String::from_utf8(plan.stdout).unwrap();
    let version = plan.lines().find_map(|line| line.strip_prefix("version            ")).unwrap();
    let (_, build) = version.split_once('+').unwrap();
    assert!(build.len() == 16 && build.chars().all(|c| c.is_ascii_hexdigit()), "{version}");
}

/// Where results may not go is said before the terrain is read, which may take minutes: here it cannot be read at all.
#[test]
fn a_folder_that_may_not_be_written_is_refused_before_the_terrain_is_read() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = dir.path().join("slope.stl");
    fs::write(&mesh, "no mesh").unwrap();
    let scene = fs::read_to_string("examples/quick.toml").unwrap();
    let home = format!("{}/terrain", env!("CARGO_MANIFEST_DIR"));
    let scene =
        scene.replace("../terrain/quick_slope.stl", word(&mesh)).replace("../terrain", &home);
    let file = dir.path().join("scene.toml");
    fs::write(&file, scene).unwrap();
    let taken = dir.path().join("taken");
    write_all(&taken, Mode::Fresh).unwrap();
    let in_file = mesh.join("out");
    let fresh = dir.path().join("fresh");
    for (out, part) in [
        (&taken, "taken: holds other results: another scene"),
        (&in_file, "slope.stl/out"),
        (&fresh, "slope.stl: start: 7 bytes"),
    ] {
        let said = rockfall(&["run", word(&file), "--quiet", "--out", word(out)]);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{stderr}");
        assert!(stderr.contains(part), "{part}: {stderr}");
    }
    assert!(!fresh.exists());
}
