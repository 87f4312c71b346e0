//! Wrong scenes: each file in `tests/bad` carries in its first line the message that it must produce.
#![allow(
    clippy::case_sensitive_file_extension_comparisons,
    reason = "the folder names its files itself"
)]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::program;

use program::{command, rockfall};
use proptest::prelude::*;
use rockfall::scene::Scene;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn bad_scenes() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad");
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> =
        files.filter(|file| file.extension().is_some_and(|kind| kind == "toml")).collect();
    scenes.sort();
    scenes
}

/// Exit status 2, nothing on stdout, one message on stderr that names the file and says what the first
/// line promises, no panic and no backtrace: the contract for wrong input.
#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let scenes = bad_scenes();
    assert!(scenes.len() > 140, "only {} bad scenes found", scenes.len());
    for scene in scenes {
        let text = std::fs::read_to_string(&scene).unwrap();
        let promised = text.lines().next().and_then(|line| line.strip_prefix("# ")).unwrap();
        let name = format!("tests/bad/{}", scene.file_name().unwrap().to_str().unwrap());
        for command in ["plan", "run"] {
            let said = rockfall(&[command, &name]);
            let stderr = String::from_utf8(said.stderr).unwrap();
            assert_eq!(said.status.code(), Some(2), "{name}: {stderr}");
            assert!(said.stdout.is_empty(), "{name}");
            let start = format!("error: {name}: {promised}");
            assert!(stderr.starts_with(&start), "{name} must say\n  {start}\nbut says\n  {stderr}");
            assert_eq!(stderr.lines().count(), 1, "{name}: {stderr}");
        }
    }
}

/// A message is of use only if it says what to write instead.
#[test]
fn every_message_has_a_remedy() {
    for scene in bad_scenes() {
        let text = std::fs::read_to_string(&scene).unwrap();
        let (_, remedy) = text.lines().next().unwrap().split_once("; ").unwrap();
        let words = ["write", "remove", "give", "did you mean", "known here"];
        assert!(words.iter().any(|word| remedy.contains(word)), "{}: {remedy}", scene.display());
    }
}

/// Where most rocks leave the terrain, no number of releases narrows the far end of the runout: the aim is refused, with
/// the number of rocks and what to do.
#[test]
fn an_aim_that_rocks_beyond_the_terrain_decide_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let scene = "examples/paper_slope.toml";
    let aim = "runout.p95 < 1.0 m";
    let said =
        rockfall(&["run", scene, "--quiet", "--releases", "200", "--until", aim, "--out", out]);
    let stderr = String::from_utf8(said.stderr).unwrap();
    assert_eq!(said.status.code(), Some(2), "{stderr}");
    assert!(
        stderr.contains("of 200 rocks left the terrain") && stderr.contains("give terrain"),
        "{stderr}"
    );
    // a largest speed is that on the terrain given: no rock has to come to rest for it
    let aim = "speed.p50 < 5 m/s";
    let said = rockfall(&[
        "run",
        scene,
        "--quiet",
        "--overwrite",
        "--releases",
        "200",
        "--until",
        aim,
        "--out",
        out,
    ]);
    assert_eq!(said.status.code(), Some(0), "{}", String::from_utf8_lossy(&said.stderr));
}

/// The answer to wrong input: exit status 2, nothing on stdout, one line on stderr.
fn refusal(said: Output) -> String {
    let stderr = String::from_utf8(said.stderr).unwrap();
    assert_eq!(said.status.code(), Some(2), "{stderr}");
    assert!(said.stdout.is_empty(), "{}", String::from_utf8_lossy(&said.stdout));
    assert_eq!(stderr.lines().count(), 1, "{stderr}");
    stderr.strip_prefix("error: ").unwrap().trim_end().to_owned()
}

/// A scene with one mesh.
fn scene_over(mesh: &Path) -> String {
    let scene = fs::read_to_string("tests/bad/capture_negative.toml").unwrap();
    let mesh = format!("mesh = {:?}", mesh.to_str().unwrap());
    scene.replace("mesh = \"square.stl\"", &mesh).replace("capture_speed_m_s = -0.05", "")
}

/// Each mesh in `tests/bad_meshes` has its message in `messages.txt`, whether it is checked or falls rocks.
#[test]
fn every_bad_mesh_is_refused_with_its_message() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_meshes");
    let promised = fs::read_to_string(folder.join("messages.txt")).unwrap();
    let mut names: Vec<String> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name.ends_with(".stl"))
        .collect();
    names.sort();
    let listed: Vec<&str> = promised.lines().map(|line| line.split_once(": ").unwrap().0).collect();
    assert_eq!(listed, names);
    let dir = tempfile::tempdir().unwrap();
    let (scene, out) = (dir.path().join("scene.toml"), dir.path().join("out"));
    for (name, message) in names.iter().zip(promised.lines()) {
        let mesh = folder.join(name);
        let promised = format!("{}/{message}", folder.display());
        assert_eq!(refusal(rockfall(&["mesh", "check", mesh.to_str().unwrap()])), promised);
        fs::write(&scene, scene_over(&mesh)).unwrap();
        let said =
            rockfall(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--quiet"]);
        let said = refusal(said);
        // that a mesh cannot be read at all is found before the meshes are looked at, and names the scene's key
        let read = said == promised || said.starts_with(scene.to_str().unwrap());
        assert!(read && said.contains(name), "{name}: {said}");
        assert!(!out.exists(), "{name}: a folder of results was made");
    }
}

/// What a scene reads as terrain can be examined too, and where an STL file is asked for, its name says where it belongs.
#[test]
fn other_terrain_files_are_examined_or_shown_their_place() {
    let examined = rockfall(&["mesh", "check", "terrain/tyrol_dem.tif"]);
    let said = String::from_utf8_lossy(&examined.stdout).into_owned();
    assert!(
        examined.status.success() && said.contains("GeoTIFF") && said.contains("welded"),
        "{said}"
    );
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("scene.toml");
    let scene = fs::read_to_string("examples/tyrol.toml").unwrap();
    let tyrol = format!("{}/terrain/tyrol_dem.tif", env!("CARGO_MANIFEST_DIR"));
    let line = scene.lines().find(|line| line.starts_with("mesh = ")).unwrap();
    fs::write(&file, scene.replacen(line, &format!("mesh = \"{tyrol}\""), 1)).unwrap();
    let said = refusal(rockfall(&["plan", file.to_str().unwrap()]));
    assert!(said.contains("found a GeoTIFF, no STL; a scene reads it under `file`"), "{said}");
}

/// Files that the system does not let be read, and grids that are none.
#[test]
#[cfg(target_os = "linux")]
fn unreadable_files_are_refused() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().unwrap();
    let missing = dir.path().join("missing.stl");
    let said = refusal(rockfall(&["mesh", "check", missing.to_str().unwrap()]));
    assert!(said.contains("missing.stl: cannot read: No such file"), "{said}");
    assert!(said.ends_with("; write a path that is there"), "{said}");
    // reading at the start of its own memory is an input error for any user
    let said = refusal(rockfall(&["mesh", "check", "/proc/self/mem"]));
    assert!(said.starts_with("/proc/self/mem: cannot read: Input/output error"), "{said}");
    let locked = dir.path().join("locked.stl");
    fs::copy("tests/bad/square.stl", &locked).unwrap();
    fs::set_permissions(&locked, fs::Permissions::from_mode(0o000)).unwrap();
    // root may read everything
    if fs::read(&locked).is_err() {
        let said = refusal(rockfall(&["mesh", "check", locked.to_str().unwrap()]));
        assert!(said.contains("locked.stl: cannot read: Permission denied"), "{said}");
        assert!(said.ends_with("take the right to use this one"), "{said}");
    }
}

/// Numbers of a table that are none, or no place on a map, are refused with their line; a size that no block has with
/// what it would be.
#[test]
fn numbers_of_tables_that_are_none_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let (scene, table) = (dir.path().join("scene.toml"), dir.path().join("table.csv"));
    let text = fs::read_to_string("tests/bad/scheme_unknown.toml").unwrap();
    let mesh = fs::canonicalize("tests/bad/square.stl").unwrap();
    let good = text.replace("square.stl", mesh.to_str().unwrap()).replace("adaptve", "rigid");
    let measured = format!("{good}\n[calibrate]\ndeposits = \"table.csv\"\n");
    let released = good.replace("points_m = [[5.0, 5.0]]", "table = \"table.csv\"");
    let ends = "release_x_m,release_y_m,x_m,y_m\n5,5,5,9";
    for (scene_text, rows, said) in [
        (&measured, format!("{ends}\n5,5,nan,8\n"), "line 3: found NaN; write numbers"),
        (&measured, format!("{ends}\n5,inf,5,8\n"), "line 3: found inf; write numbers"),
        (&measured, format!("{ends}\n5,5,5,1e300\n"), "line 3: found 1e300; write numbers"),
        (&measured, format!("{ends}\n5,5,5,wide\n"), "line 3: CSV deserialize error"),
        (
            &released,
            "x_m,y_m,radius_m\n5,5,1e-4\n".to_owned(),
            "radius_m or mass_kg: found blocks with a radius of 0.0001 to 0.0001 m; write a value in 0.001..1000.0",
        ),
    ] {
        fs::write(&scene, scene_text).unwrap();
        fs::write(&table, rows).unwrap();
        let out = dir.path().join("out");
        let answer =
            rockfall(&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap(), "--quiet"]);
        let heard = refusal(answer);
        assert!(heard.starts_with(&format!("{}: {said}", table.display())), "{heard}");
    }
}

/// Results that cannot be written: a file in the way, a folder that is not the user's, no room left.
#[test]
#[cfg(target_os = "linux")]
fn results_that_cannot_be_written_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let run = |out: &str| {
        refusal(rockfall(&[
            "run",
            "examples/quick.toml",
            "--quiet",
            "--releases",
            "300",
            "--out",
            out,
        ]))
    };
    let said = run("Cargo.toml");
    assert!(said.starts_with("Cargo.toml: cannot create: "), "{said}");
    assert!(said.contains("a file stands where a folder should be"), "{said}");
    let said = run("/proc/results");
    assert!(said.starts_with("/proc/results: cannot create: "), "{said}");
    // A limit on the length of files stands for a full disk: the same calls fail, and no special rights are needed.
    let out = dir.path().join("out");
    let (out, program) = (out.to_str().unwrap(), env!("CARGO_BIN_EXE_rockfall"));
    let script = format!(
        "trap '' XFSZ; ulimit -f 64; exec {program} run examples/quick.toml --quiet --releases 300 --out {out}"
    );
    let said = refusal(Command::new("sh").args(["-c", &script]).output().unwrap());
    assert!(said.contains(": File too large"), "{said}");
    assert!(
        said.ends_with("make room and go on with --resume, or write a path on another disk"),
        "{said}"
    );
    // and with room again the run goes on
    let went_on = command(&[
        "run",
        "examples/quick.toml",
        "--quiet",
        "--releases",
        "300",
        "--resume",
        "--out",
        out,
    ]);
    assert!({ went_on }.status().unwrap().success());
}

/// Studies and fits ask for their folder before they compute, not after hours.
#[test]
fn a_folder_that_cannot_be_made_is_refused_before_the_work() {
    for words in [
        &["study", "error"][..],
        &["study", "error", "examples/quick.toml"],
        &["study", "stability"],
        &["study", "stability", "examples/quick.toml"],
        &["calibrate", "examples/tschamut.toml"],
    ] {
        let answer = rockfall(&[words, &["--out", "Cargo.toml"]].concat());
        assert!(answer.stdout.is_empty(), "{words:?} has begun");
        let said = refusal(answer);
        assert!(said.starts_with("Cargo.toml: cannot create: "), "{words:?}: {said}");
    }
}

/// Requests that do not fit together end like wrong scenes: status 2, words, no panic.
#[test]
fn wrong_requests_are_refused() {
    let scene = "tests/bad/friction_above_90.toml";
    let requests: [&[&str]; 13] = [
        &[],
        &["fly"],
        &["run"],
        &["run", "no_such_scene.toml"],
        &["run", "tests/bad"],
        &["run", scene, "--releases", "0"],
        &["run", scene, "--threads", "none"],
        &["run", scene, "--threads", "100000"],
        &["run", scene, "--seed", "-1"],
        &["run", scene, "--shard", "1/2", "--only", "3"],
        &["run", "examples/quick.toml", "--only", "1000"],
        &["merge", "tests/bad", "--out", "/proc/merged"],
        &["run", scene, "--resume", "--overwrite"],
    ];
    for request in requests {
        let said = rockfall(request);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{request:?}: {stderr}");
        assert!(!stderr.is_empty() && !stderr.contains("panicked"), "{request:?}: {stderr}");
    }
}

proptest! {
    /// Whatever is typed into a scene, the answer is a scene or a message that names the file.
    #[test]
    fn no_text_makes_the_reader_panic(
        which in 0_usize..80,
        cut in 0.0_f64..1.0,
        length in 0_usize..40,
        typed in "[\\[\\]{}=\",.#'0-9a-zé\n -]{0,12}",
    ) {
        let scenes = bad_scenes();
        let text = std::fs::read_to_string(&scenes[which % scenes.len()]).unwrap();
        let letters: Vec<char> = text.chars().collect();
        let start = (cut * letters.len() as f64) as usize;
        let end = (start + length).min(letters.len());
        let edited: String = letters[..start].iter().copied()
            .chain(typed.chars())
            .chain(letters[end..].iter().copied())
            .collect();
        if let Err(error) = Scene::parse(&edited, Path::new("edited.toml")) {
            let said = error.to_string();
            prop_assert!(said.starts_with("edited.toml: "), "{}", said);
            prop_assert!(said.contains("; "), "{}", said);
        }
    }
}
