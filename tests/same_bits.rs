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
use std::path::{Path, PathBuf};
use std::process::Command;

/// Small runs, by name, scene and releases: every scheme for rocks alone, trees, roughness, maps, figures; and worlds of
/// rocks, bonded and in the paper's fixed step with its system of all of them.
fn runs(dir: &Path) -> [(&'static str, PathBuf, &'static str); 5] {
    let containers = std::fs::read_to_string("examples/paper/3_containers.toml").unwrap();
    let home = format!("mesh = \"{}", env!("CARGO_MANIFEST_DIR"));
    let containers =
        containers.replace("mesh = \"../..", &home).replace("longest_s = 20.0", "longest_s = 0.6");
    assert!(containers.contains("longest_s = 0.6") && containers.contains(&home));
    let world = dir.join("containers.toml");
    std::fs::write(&world, containers).unwrap();
    [
        ("quick", "examples/quick.toml".into(), "60"),
        ("tschamut", "examples/tschamut.toml".into(), "40"),
        ("edge", "examples/paper/1a_asymmetric_edge.toml".into(), "1"),
        ("breakup", "examples/breakup.toml".into(), "27"),
        ("containers", world, "48"),
    ]
}

fn arguments<'a>(scene: &'a Path, releases: &'a str, out: &'a Path) -> [&'a str; 9] {
    let [scene, out] = [scene, out].map(|path| path.to_str().unwrap());
    ["run", scene, "--quiet", "--overwrite", "--yes", "--releases", releases, "--out", out]
}

fn run(scene: &Path, releases: &str, out: &Path, tunables: &str) -> BTreeMap<String, Vec<u8>> {
    let mut program = command(&arguments(scene, releases, out));
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
    for (run_name, scene, releases) in runs(dir.path()) {
        let [with, without] = ["", off].map(|t| run(&scene, releases, &dir.path().join("out"), t));
        for (name, bytes) in &with {
            assert!(without[name] == *bytes, "{run_name}: {name} differs");
            compared += bytes.len();
        }
    }
    println!("{compared} bytes compared");
}

/// The whole program on a processor without AVX and FMA, where an emulator is at hand (`qemu-x86_64` of the package
/// qemu-user in the path, or what `ROCKFALL_QEMU` names): libraries ask the processor itself what it can do.
#[test]
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
fn an_old_processor_gives_the_same_bytes() {
    let emulator = std::env::var("ROCKFALL_QEMU").unwrap_or_else(|_| "qemu-x86_64".to_owned());
    if Command::new(&emulator).arg("--version").output().is_err() {
        println!("not checked: there is no {emulator}");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let [native, old] = ["native", "old"].map(|name| dir.path().join(name));
    let mut compared = 0;
    for (run_name, scene, releases) in runs(dir.path()) {
        let releases = if run_name == "quick" || run_name == "tschamut" { "8" } else { releases };
        let wanted = run(&scene, releases, &native, "");
        let done = Command::new(&emulator)
            .args(["-cpu", "Nehalem", env!("CARGO_BIN_EXE_rockfall")])
            .args(arguments(&scene, releases, &old))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        let found = results(&old);
        for (name, bytes) in &wanted {
            assert!(found[name] == *bytes, "{run_name}: {name} differs");
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
    for (name, scene, releases) in runs(dir.path()) {
        let files = run(&scene, releases, &dir.path().join(name), "");
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
