//! The same bytes on every machine: with the system's functions for unlike processors, and against digests that are kept.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]

mod asked;
mod program;

use asked::{Asked, USUAL, p, plate, quad, scene};
use program::{command, results};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
use std::process::Command;

/// Small runs, by name, scene and releases: every scheme for rocks alone, trees, roughness, maps, figures; and a world, a
/// pyramid that gives way, in the paper's fixed step with its system of all rocks; and blocks on springs over uneven ground.
fn runs(dir: &Path) -> [(&'static str, PathBuf, &'static str); 5] {
    let layer = |k: u32| {
        let places = (0..4 - k).flat_map(move |i| (0..4 - k).map(move |j| (i, j)));
        let at = move |n: u32| 0.4 * f64::from(n) + 0.2 * f64::from(k);
        let z = 0.2 + 0.4 * std::f64::consts::FRAC_1_SQRT_2 * f64::from(k);
        places.map(move |(i, j)| [at(i), at(j), z])
    };
    let points: Vec<[f64; 3]> = (0..4).flat_map(layer).collect();
    let place = format!("count = 30\ntogether = true\npoints_m = {points:?}");
    let more = "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 2.5e7\nfriction_angle_deg = 20.0\nrestitution = 0.3\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0\n[solver]\nscheme = \"dda\"\nstep_s = 1e-4\nlongest_s = 0.004";
    let asked = Asked { place: &place, velocity: [0.3, 0.0, 0.0], more, ..USUAL };
    let pyramid = scene(dir, &plate(5.0, 0.0), &asked);
    [
        ("quick", "examples/quick.toml".into(), "60"),
        ("tschamut", "examples/tschamut.toml".into(), "40"),
        ("edge", "examples/paper/1a_asymmetric_edge.toml".into(), "1"),
        ("pyramid", pyramid, "30"),
        ("blocks", blocks(dir), "6"),
    ]
}

/// Blocks with `adaptive` on ground that is uneven by heights that are exact on every machine.
fn blocks(dir: &Path) -> PathBuf {
    let at = |i: i32, j: i32| {
        let rise = f64::from((7 * i * i + 5 * j) % 8) / 32.0;
        p(0.5 * f64::from(i), 0.5 * f64::from(j), rise - 0.25 * f64::from(j))
    };
    let cell = |i: i32, j: i32| quad([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    let mesh: Vec<_> = (-4..4).flat_map(|i| (-4..12).flat_map(move |j| cell(i, j))).collect();
    let place = "count = 6\nheight_m = 0.5\npoints_m = [[0.0, 0.0], [0.7, 0.3], [-0.4, -0.6]]";
    let more = "[[rocks.shapes]]\nkind = \"eota221\"\ncorner_radius = 0.15\n[[rocks.shapes]]\nkind = \"box\"\naxes = [1.0, 0.7, 0.4]\ncorner_radius = 0.2\n[solver]\nscheme = \"adaptive\"\nlongest_s = 2.0\n[record]\npaths = 6\nimpacts = true";
    let own = dir.join("uneven");
    std::fs::create_dir_all(&own).unwrap();
    scene(&own, &mesh, &Asked { place, velocity: [0.3, 1.0, 0.0], more, ..USUAL })
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
        let releases = if releases == "30" { releases } else { "1" };
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
