//! A run that goes on until an interval is narrow is the run of as many releases, whenever it was killed.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]
#![cfg(unix)]

use crate::kill::{kill_after, moment, succeed, timed};
use crate::program::{command, same_results};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use std::path::Path;
use std::process::Command;

/// Kills in the test that always runs, and in the one that is asked for.
const KILLS: [usize; 2] = [12, 100];
/// Kills of one run before it is left to end.
const KILLS_OF_ONE_RUN: usize = 4;
/// Releases of the first round. A round asks for no more than four times as many as there are.
const FIRST: usize = 60;
/// Three rounds, with maps, lines, paths and impacts.
const AIM: &str = "speed.p50 < 0.25 m/s";

fn run(out: &Path, more: &[&str]) -> Command {
    let scene = ["run", "examples/quick.toml", "--quiet", "--out", out.to_str().unwrap()];
    command(&[&scene[..], more].concat())
}

fn until(out: &Path, more: &[&str]) -> Command {
    run(out, &[&["--releases", &FIRST.to_string(), "--until", AIM], more].concat())
}

fn releases(out: &Path) -> usize {
    std::fs::read_to_string(out.join("releases.csv")).unwrap().lines().count() - 1
}

/// Maps, summary, tables and figures; a finished run that is asked for more goes on to the same.
#[test]
fn an_aim_ends_with_the_run_of_as_many_releases() {
    let dir = tempfile::tempdir().unwrap();
    let [aimed, plain, extended] = ["aimed", "plain", "extended"].map(|name| dir.path().join(name));
    succeed(until(&aimed, &[]));
    let count = releases(&aimed).to_string();
    assert!(releases(&aimed) > 4 * FIRST, "{count} releases were enough for a round or two");
    succeed(run(&plain, &["--releases", &count]));
    same_results(&plain, &aimed);
    succeed(run(&extended, &["--releases", &FIRST.to_string()]));
    succeed(until(&extended, &["--resume"]));
    same_results(&plain, &extended);
}

#[test]
fn a_killed_aim_is_resumed_to_the_same_bytes() {
    kill_and_resume(KILLS[0]);
}

#[test]
#[ignore = "takes minutes: cargo test --test commands until:: -- --ignored --nocapture"]
fn a_hundred_kills_are_resumed_to_the_same_bytes() {
    kill_and_resume(KILLS[1]);
}

/// SIGKILL at random moments of all rounds; maps and all else are in the end those of an aim that was left alone, which are those of a run of
/// as many releases.
fn kill_and_resume(wanted: usize) {
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("reference");
    let whole = timed(until(&reference, &[]));
    assert!(reference.join("maps").is_dir());
    let mut random = ChaCha8Rng::seed_from_u64(18);
    let (mut kills, mut runs) = (0, 0);
    while kills < wanted {
        let out = dir.path().join(format!("killed_{runs}"));
        for turn in 0..KILLS_OF_ONE_RUN {
            let delay = moment(whole, turn, random.random());
            kills += usize::from(kill_after(until(&out, &["--resume"]), delay));
        }
        succeed(until(&out, &["--resume"]));
        same_results(&reference, &out);
        std::fs::remove_dir_all(&out).unwrap();
        runs += 1;
    }
    println!("{kills} kills in {runs} runs of {whole:?}");
}
