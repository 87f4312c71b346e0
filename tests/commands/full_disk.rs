//! A disk that is full or may only be read: one message, and with room again the run ends with the same bytes.
//! Disks in memory stand for real ones; they can be mounted by root alone, and without that nothing is checked.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]
#![cfg(target_os = "linux")]

use crate::program;

use program::{rockfall, same_results};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A disk of a few kilobytes, gone with the test.
struct Disk {
    folder: PathBuf,
}

impl Disk {
    /// None where this user may not mount.
    fn mount(folder: PathBuf, size: &str) -> Option<Self> {
        std::fs::create_dir_all(&folder).unwrap();
        let options = format!("size={size}");
        let mounted = mount(&["-t", "tmpfs", "-o", &options, "rockfall"], &folder);
        if !mounted {
            println!("not checked: only root may mount a disk, and not everywhere");
        }
        mounted.then_some(Self { folder })
    }

    fn turn(&self, options: &str) {
        assert!(mount(&["-o", &format!("remount,{options}")], &self.folder));
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.folder).status();
    }
}

fn mount(options: &[&str], folder: &Path) -> bool {
    let done = Command::new("mount").args(options).arg(folder).output();
    done.is_ok_and(|done| done.status.success())
}

fn run(out: &Path, more: &[&str]) -> Output {
    let scene = ["run", "examples/quick.toml", "--quiet", "--releases", "100", "--out"];
    rockfall(&[&scene[..], &[out.to_str().unwrap()], more].concat())
}

/// The one line on stderr of a run that was refused.
fn refusal(said: &Output) -> String {
    let stderr = String::from_utf8_lossy(&said.stderr).into_owned();
    assert_eq!((said.status.code(), stderr.lines().count()), (Some(2), 1), "{stderr}");
    stderr
}

/// Full at the first file, among the tables, among the maps and among the figures.
#[test]
fn a_run_on_a_full_disk_is_resumed_to_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("reference");
    assert!(run(&reference, &[]).status.success());
    let mut refused = 0;
    for size in ["4k", "32k", "128k", "512k", "1m", "2m"] {
        let Some(disk) = Disk::mount(dir.path().join(size), size) else { return };
        let said = run(&disk.folder, &["--resume"]);
        if !said.status.success() {
            refused += 1;
            let said = refusal(&said);
            let folder = disk.folder.to_str().unwrap();
            assert!(said.starts_with(&format!("error: {folder}/")), "{said}");
            assert!(said.contains(": No space left on device"), "{said}");
            assert!(said.contains("make room and go on with --resume"), "{said}");
        }
        disk.turn("size=64m");
        assert!(run(&disk.folder, &["--resume"]).status.success());
        same_results(&reference, &disk.folder);
    }
    println!("{refused} full disks");
    assert!(refused > 3, "the disks were not full");
}

/// What was merged so far cannot be gone on with: merge says what it can do.
#[test]
fn a_merge_on_a_full_disk_begins_again() {
    let dir = tempfile::tempdir().unwrap();
    let [whole, one, two] = ["whole", "one", "two"].map(|name| dir.path().join(name));
    assert!(run(&whole, &[]).status.success());
    assert!(run(&one, &["--shard", "1/2"]).status.success());
    assert!(run(&two, &["--shard", "2/2"]).status.success());
    let merge = |out: &Path, more: &[&str]| {
        let parts = ["merge", two.to_str().unwrap(), one.to_str().unwrap()];
        rockfall(&[&parts[..], &["--out", out.to_str().unwrap()], more].concat())
    };
    for size in ["4k", "128k", "1m"] {
        let Some(disk) = Disk::mount(dir.path().join(size), size) else { return };
        let said = refusal(&merge(&disk.folder, &[]));
        assert!(said.contains(": No space left on device"), "{said}");
        assert!(said.contains("make room and merge again with --overwrite, or write"), "{said}");
        assert!(!said.contains("--resume"), "{said}");
        disk.turn("size=64m");
        assert!(merge(&disk.folder, &["--overwrite"]).status.success());
        same_results(&whole, &disk.folder);
    }
}

#[test]
fn a_disk_that_may_only_be_read_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let Some(disk) = Disk::mount(dir.path().join("disk"), "1m") else { return };
    disk.turn("ro");
    let said = refusal(&run(&disk.folder, &[]));
    assert!(said.contains("Read-only file system"), "{said}");
    assert!(said.contains("write a path that you may use"), "{said}");
}
