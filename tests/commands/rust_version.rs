//! The stated minimum Rust version: no dependency asks for a newer one. That our own code uses no newer part of the
//! standard library, clippy checks (`incompatible_msrv`, on by default, an error in `.ci/run`).
#![allow(clippy::unwrap_used, reason = "a test that cannot ask cargo has failed")]
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use serde_json::Value;
use std::process::Command;

/// "1.89" as (1, 89).
fn version(text: &str) -> (u32, u32) {
    let mut numbers = text.split('.').map(|number| number.parse().unwrap());
    (numbers.next().unwrap(), numbers.next().unwrap())
}

/// What cargo knows of all packages. Those that only the bench has are not on a machine that has built the program alone: then
/// cargo loads them as it has loaded the others.
fn metadata() -> Value {
    let asked = ["metadata", "--locked", "--format-version", "1"];
    let linux = ["--filter-platform", "x86_64-unknown-linux-gnu"];
    let answer = |more: &[&str]| {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(asked).args(linux).args(more).current_dir(env!("CARGO_MANIFEST_DIR"));
        cargo.output().unwrap()
    };
    let mut answered = answer(&["--offline"]);
    if !answered.status.success() {
        answered = answer(&[]);
    }
    assert!(answered.status.success(), "{}", String::from_utf8_lossy(&answered.stderr));
    serde_json::from_slice(&answered.stdout).unwrap()
}

#[test]
fn no_dependency_asks_for_a_newer_rust() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    let ours = version(env!("CARGO_PKG_RUST_VERSION"));
    assert!(packages.len() > 50, "{} packages", packages.len());
    let stated = packages.iter().filter_map(|package| {
        let asks = package["rust_version"].as_str()?;
        Some((version(asks), package["name"].as_str()?))
    });
    let newest = stated.max().unwrap();
    println!("the newest asked for is {newest:?}");
    assert!(newest.0 <= ours, "{newest:?} needs more than {ours:?}");
}
