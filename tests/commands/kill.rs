//! Killed at any moment, a run can be resumed, and ends with the bytes of one that was left alone.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]
#![cfg(unix)]

use crate::program;

use chacha20::ChaCha8Rng;
use program::{command, rockfall, same_results};
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Kills in the test. More by `ROCKFALL_KILLS=500 cargo test --test commands kill::`.
const KILLS: usize = 24;
/// Kills of one run before it is left to end.
const KILLS_OF_ONE_RUN: usize = 6;

/// Runs after which the clock is taken again.
const RUNS_OF_ONE_CLOCK: usize = 8;

/// The scene of all runs here: large enough that most kills meet it computing, and a slope, trees, paths and impacts.
fn run(out: &Path, more: &[&str]) -> Command {
    let scene = ["run", "examples/quick.toml", "--quiet", "--releases", "150", "--out"];
    command(&[&scene[..], &[out.to_str().unwrap()], more].concat())
}

pub(crate) fn succeed(mut command: Command) {
    let done = command.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
}

/// Time that the run takes.
pub(crate) fn timed(command: Command) -> Duration {
    let begun = Instant::now();
    succeed(command);
    begun.elapsed()
}

/// When a run that takes `whole` is killed by chance `p` of 0..1: at any moment. One that goes on has less before it, about half of it its
/// figures, which are drawn from the first one: later it has mostly ended, and nothing is killed.
pub(crate) fn moment(whole: Duration, turn: usize, p: f64) -> Duration {
    whole.mul_f64(if turn == 0 { p } else { 0.5 * p })
}

/// Starts the run, kills it after so long; whether it was still running.
pub(crate) fn kill_after(mut command: Command, delay: Duration) -> bool {
    let mut child = command.stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let begun = Instant::now();
    // what was resumed near its end has ended before: nothing is left to be waited for
    while begun.elapsed() < delay && child.try_wait().unwrap().is_none() {
        sleep(Duration::from_millis(2).min(delay.saturating_sub(begun.elapsed())));
    }
    child.kill().unwrap(); // SIGKILL: nothing can be done about it
    let ended = child.wait_with_output().unwrap();
    let stderr = String::from_utf8_lossy(&ended.stderr);
    assert!(ended.status.success() || ended.status.code().is_none(), "{stderr}");
    ended.status.code().is_none()
}

/// SIGKILL at random moments, from the first instant to the last figure, several times in one run.
#[test]
fn a_killed_run_is_resumed_to_the_same_bytes() {
    let wanted = std::env::var("ROCKFALL_KILLS").map_or(KILLS, |kills| kills.parse().unwrap());
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("reference");
    let mut whole = timed(run(&reference, &[]));
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let (mut kills, mut runs) = (0, 0);
    while kills < wanted {
        if runs % RUNS_OF_ONE_CLOCK == RUNS_OF_ONE_CLOCK - 1 {
            // what a whole run takes changes with what else the machine does
            whole = timed(run(&reference, &["--overwrite"]));
        }
        let out = dir.path().join(format!("killed_{runs}"));
        for turn in 0..KILLS_OF_ONE_RUN {
            let delay = moment(whole, turn, random.random());
            // `--resume` into nothing begins; a run begun anew over old results is killed too
            let mode = if turn == 0 && runs % 3 == 2 { "--overwrite" } else { "--resume" };
            kills += usize::from(kill_after(run(&out, &[mode]), delay));
        }
        succeed(run(&out, &["--resume"]));
        same_results(&reference, &out);
        if runs % 3 == 1 {
            // the next run overwrites this one
            std::fs::rename(&out, dir.path().join(format!("killed_{}", runs + 1))).unwrap();
        }
        runs += 1;
    }
    println!("{kills} kills in {runs} runs of {whole:?}");
}

/// SIGTERM, as batch systems send it, ends like Ctrl-C: the chunk in hand is written, and the way on is said.
#[test]
fn a_terminated_run_says_how_to_go_on() {
    let dir = tempfile::tempdir().unwrap();
    let (reference, out) = (dir.path().join("reference"), dir.path().join("out"));
    succeed(run(&reference, &["--threads", "1"]));
    for signal in ["-TERM", "-INT"] {
        let child =
            run(&out, &["--threads", "1", "--overwrite"]).stderr(Stdio::piped()).spawn().unwrap();
        let first_chunk = || std::fs::read_to_string(out.join("progress.json")).unwrap_or_default();
        let deadline = Instant::now() + Duration::from_secs(60);
        while !first_chunk().contains("\"done\": 8,") && Instant::now() < deadline {
            sleep(Duration::from_millis(1));
        }
        let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        let ended = child.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(130), "{said}");
        assert!(said.contains("of 150 releases are written"), "{said}");
        assert!(said.contains("go on with: rockfall run") && said.contains("--resume"), "{said}");
        succeed(run(&out, &["--resume"]));
        same_results(&reference, &out);
    }
}

/// Two processes never write into one folder.
#[test]
fn a_folder_in_use_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let lock = rockfall::output::FolderLock::on(dir.path()).unwrap();
    let out = dir.path().to_str().unwrap();
    for mode in ["--resume", "--overwrite"] {
        let said = rockfall(&["run", "examples/quick.toml", "--quiet", "--out", out, mode]);
        let stderr = String::from_utf8(said.stderr).unwrap();
        assert_eq!(said.status.code(), Some(2), "{stderr}");
        let start = format!("error: {out}: another process is writing into this folder; wait");
        assert!(stderr.starts_with(&start), "{stderr}");
    }
    drop(lock);
    succeed(run(dir.path(), &["--resume"]));
}
