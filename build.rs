//! Takes the fingerprint of the sources, so that results say which build they come from: of all packages, as seen from `src/engine`,
//! whose plan says it.

use std::fs;
use std::path::{Path, PathBuf};

fn main() {
    let mut files = vec![PathBuf::from("../../Cargo.lock")];
    collect(Path::new(".."), &mut files);
    files.sort();
    let hash = files.iter().filter_map(|file| fs::read(file).ok()).fold(OFFSET, |hash, bytes| {
        // line ends are not the same in every checkout
        bytes.iter().filter(|byte| **byte != b'\r').fold(hash, |hash, byte| mixed(hash, *byte))
    });
    println!("cargo:rustc-env=ROCKFALL_BUILD={hash:016x}");
    for watched in ["..", "../../Cargo.lock", "../../build.rs"] {
        println!("cargo:rerun-if-changed={watched}");
    }
}

/// Start of the Fowler–Noll–Vo hash FNV-1a, 64 bits.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// One step of it.
fn mixed(hash: u64, byte: u8) -> u64 {
    (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}
