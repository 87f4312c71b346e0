//! Wrong scenes: each file in `tests/bad` carries in its first line the message that it must produce.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use proptest::prelude::*;
use rockfall::scene::Scene;
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
