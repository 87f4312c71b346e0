//! Physics is read by engineers who did not write it: its files say why, by which equation, in which units and within which limits.

use super::{PHYSICS, files_of, without_tests};
use std::fs;

/// Lines of comment over lines of code (%): less leaves equations unsaid, more buries the code under its reasons.
const SHARE: std::ops::RangeInclusive<f64> = 25.0..=40.0;

/// Lines of comment of every kind and lines of code of a text, empty ones and unit tests left out: a test says what it shows by its
/// name and its asserts, and would otherwise count for the file beside it.
fn lines(text: &str) -> (usize, usize) {
    let full = without_tests(text).lines().map(str::trim).filter(|line| !line.is_empty());
    let comments = full.clone().filter(|line| line.starts_with("//")).count();
    (comments, full.count() - comments)
}

fn share(comments: usize, code: usize) -> f64 {
    100.0 * comments as f64 / code as f64
}

#[test]
fn physics_says_why() {
    let example = "//! A.\n//!\n\n/// B.\nfn b() {\n    // c\n    c(); // d\n}\n#[cfg(test)]\nmod tests {\n    // e\n}\n";
    assert_eq!(lines(example), (4, 3));
    let (mut all, mut floors) = ((0, 0), Vec::new());
    for floor in PHYSICS {
        let files = files_of(floor).into_iter();
        let counts = files.map(|file| lines(&fs::read_to_string(file).unwrap()));
        let (comments, code) = counts.fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        all = (all.0 + comments, all.1 + code);
        floors.push(format!(
            "{floor}: {comments} lines of comment by {code} of code, {:.1} %",
            share(comments, code)
        ));
    }
    assert!(all.1 > 10_000, "only {} lines of code were found", all.1);
    let share = share(all.0, all.1);
    assert!(SHARE.contains(&share), "{share:.1} %, to be within {SHARE:?}\n{}", floors.join("\n"));
}
