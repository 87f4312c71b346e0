//! Wrong scenes: each file in `tests/bad` carries in its first line the message that it must produce.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn rockfall(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_rockfall"))
        .args(args)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("RUST_BACKTRACE", "1")
        .output()
        .unwrap()
}

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
    assert!(scenes.len() > 70, "only {} bad scenes found", scenes.len());
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

/// Requests that do not fit together end like wrong scenes: status 2, words, no panic.
#[test]
fn wrong_requests_are_refused() {
    let scene = "tests/bad/friction_above_90.toml";
    let requests: [&[&str]; 9] = [
        &[],
        &["fly"],
        &["run"],
        &["run", "no_such_scene.toml"],
        &["run", "tests/bad"],
        &["run", scene, "--releases", "0"],
        &["run", scene, "--threads", "none"],
        &["run", scene, "--seed", "-1"],
        &["run", scene, "--resume", "--overwrite"],
    ];
    for request in requests {
        let said = rockfall(request);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{request:?}: {stderr}");
        assert!(!stderr.is_empty() && !stderr.contains("panicked"), "{request:?}: {stderr}");
    }
}
