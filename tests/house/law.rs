//! One law in one place: what stiffness, damping and friction do is asked of `ground/law`, which alone reads them.
//!
//! The coefficients are private there, so the compiler holds most of this; the test also holds names that somebody could give to
//! copies of them, the values of a ground they are made from, and the masses that follow from a body's inertia.

use super::{PHYSICS, files_of, sources, without_tests};
use std::fs;
use std::path::{Path, PathBuf};

/// Coefficients of a law, and the keys of a ground behind them.
const COEFFICIENTS: [&str; 13] = [
    "p_n",
    "p_s",
    "c_n",
    "c_n_captured",
    "c_s",
    "k_r",
    "c_r",
    "rolling_m",
    "tan_phi",
    "normal_stiffness_n_m",
    "shear_stiffness_n_m",
    "friction_angle_rad",
    "rolling_friction",
];
/// Ratios that follow from the inertia of a solid sphere.
const RATIOS: [&str; 5] = ["2.0 / 7.0", "5.0 / 7.0", "7.0 / 2.0", "3.5 *", "1.4 *"];

/// Code of a file, comments and unit tests left out.
fn code(file: &Path) -> String {
    let text = fs::read_to_string(file).unwrap();
    let own = without_tests(&text).lines();
    own.filter(|line| !line.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n")
}

fn physics() -> Vec<PathBuf> {
    PHYSICS.into_iter().flat_map(files_of).collect()
}

/// Coefficients that a text names as whole words.
fn named(code: &str) -> Vec<&str> {
    code.split(|c: char| !c.is_alphanumeric() && c != '_')
        .filter(|word| COEFFICIENTS.contains(word))
        .collect()
}

#[test]
fn the_law_alone_reads_stiffness_damping_and_friction() {
    assert_eq!(named("let f = law.p_n * x - stiff.c_n(0) + p_normal;"), ["p_n", "c_n"]);
    let files = physics();
    assert!(files.len() > 80, "{}", files.len());
    let law: Vec<PathBuf> = sources(Path::new("src/engine/ground/law"));
    assert!(law.iter().any(|file| !named(&code(file)).is_empty()), "the law is elsewhere");
    for file in files {
        let code = code(&file);
        assert!(named(&code).is_empty(), "{}: {:?}", file.display(), named(&code));
    }
}

#[test]
fn what_follows_from_inertia_is_not_written() {
    for file in physics().into_iter().chain(sources(Path::new("src/engine/ground"))) {
        let code = code(&file);
        let found: Vec<&&str> = RATIOS.iter().filter(|ratio| code.contains(**ratio)).collect();
        assert!(found.is_empty(), "{}: {found:?}", file.display());
    }
}
