//! The program from outside, and its result folders compared.

#![allow(missing_docs, dead_code, unreachable_pub)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// The program, in the folder of the repository.
pub fn command(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rockfall"));
    command.args(args).current_dir(env!("CARGO_MANIFEST_DIR")).env("RUST_BACKTRACE", "1");
    command
}

pub fn rockfall(args: &[&str]) -> Output {
    command(args).output().expect("the program starts")
}

/// Runs a scene file into a folder, without a word and over what is there.
pub fn run_into(scene: &Path, out: &Path) {
    let [scene, out] = [scene, out].map(|path| path.to_str().expect("a name in UTF-8"));
    let done = rockfall(&["run", scene, "--quiet", "--overwrite", "--out", out]);
    assert!(done.status.success(), "{scene}: {}", String::from_utf8_lossy(&done.stderr));
}

pub fn message<T>(result: rockfall::error::Result<T>) -> String {
    result.err().expect("an error").to_string()
}

/// Everything in a result folder that must be the same in every repetition, by name: all but the clock.
pub fn results(dir: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for folder in [dir.to_owned(), dir.join("figures"), dir.join("maps")] {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.expect("an entry").path();
            let name = path.strip_prefix(dir).expect("inside").to_str().expect("a name").to_owned();
            // the page shows the rate, the lock is no result
            if path.is_file() && name != "report.html" && name != ".lock" {
                files.insert(name, fs::read(path).expect("readable"));
            }
        }
    }
    let summary =
        String::from_utf8(files.remove("summary.json").expect("a summary")).expect("text");
    let (same, _clock) = summary.split_once("\"run\":").expect("the run comes last");
    files.insert("summary.json".to_owned(), same.as_bytes().to_vec());
    files
}

/// Two folders hold the same files with the same bytes.
pub fn same_results(one: &Path, other: &Path) {
    let (mine, others) = (results(one), results(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&mine), names(&others), "{} and {}", one.display(), other.display());
    for (name, bytes) in &mine {
        assert!(
            others[name] == *bytes,
            "{name} differs in {} and {}",
            one.display(),
            other.display()
        );
    }
}
