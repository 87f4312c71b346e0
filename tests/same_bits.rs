//! The same bytes on every machine: with the system's functions for unlike processors, and against digests that are kept.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]

mod program;

use program::{command, results};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Small runs: every scheme for rocks alone, trees, roughness, maps, figures; and one world of rocks.
const RUNS: [(&str, &str, &str); 3] = [
    ("quick", "examples/quick.toml", "60"),
    ("tschamut", "examples/tschamut.toml", "40"),
    ("edge", "examples/paper/1a_asymmetric_edge.toml", "1"),
];

fn run(scene: &str, releases: &str, out: &Path, tunables: &str) -> BTreeMap<String, Vec<u8>> {
    let args = ["run", scene, "--quiet", "--overwrite", "--releases", releases, "--out"];
    let mut program = command(&[&args[..], &[out.to_str().unwrap()]].concat());
    if !tunables.is_empty() {
        program.env("GLIBC_TUNABLES", tunables);
    }
    let done = program.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    results(out)
}

/// The C library of Linux has variants of its functions for processors with and without FMA; the old and the new names
/// of the switches.
#[test]
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
fn processors_without_fma_give_the_same_bytes() {
    let dir = tempfile::tempdir().unwrap();
    let off = "glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX2_Usable,-FMA_Usable,-FMA4_Usable";
    let mut compared = 0;
    for (_, scene, releases) in RUNS {
        let [with, without] = ["", off].map(|t| run(scene, releases, &dir.path().join("out"), t));
        for (name, bytes) in &with {
            assert!(without[name] == *bytes, "{scene}: {name} differs");
            compared += bytes.len();
        }
    }
    println!("{compared} bytes compared");
}

/// Digests of the tables, kept in `tests/digests.txt`: they hold on every machine, and change only with the physics.
/// Renew them by `ROCKFALL_RENEW=1 cargo test --test same_bits`.
#[test]
fn digests_hold_on_every_machine() {
    let dir = tempfile::tempdir().unwrap();
    let mut found = String::new();
    for (name, scene, releases) in RUNS {
        let files = run(scene, releases, &dir.path().join(name), "");
        for table in ["releases.csv", "paths.csv", "crossings.csv"] {
            if let Some(bytes) = files.get(table) {
                let digest = Sha256::digest(bytes);
                writeln!(found, "{digest:x}  {name}/{table}").unwrap();
            }
        }
    }
    let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/digests.txt");
    if std::env::var_os("ROCKFALL_RENEW").is_some() {
        std::fs::write(&kept, &found).unwrap();
    }
    assert_eq!(std::fs::read_to_string(&kept).unwrap_or_default(), found);
}
