//! Two runs of which only the barriers differ.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::compare::run;
use crate::program::rockfall;

/// A barrier changes no way: what is no farther from itself than chance lets it be is the same, shares and rocks a year too. What comes behind it is of
/// fewer rocks, and it is said that their percentiles are theirs.
#[test]
fn where_only_a_barrier_differs_every_way_is_the_same() {
    let dir = tempfile::tempdir().unwrap();
    let net = "\n[[barriers]]\nname = \"net\"\npoints_m = [[0.0, 40.0], [40.0, 40.0]]\nheight_m = 1.0\ncapacity_j = 2e4\n";
    let plain = run(dir.path(), "plain", "200", |scene| scene);
    let with = run(dir.path(), "with", "200", |scene| scene + net);
    let out = dir.path().join("out");
    let words = [&plain, &with, &out].map(|path| path.to_str().unwrap());
    let said = rockfall(&["compare", words[0], words[1], "--out", words[2]]);
    let said = String::from_utf8(said.stdout).unwrap();
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
    let table = read("differences.csv");
    let of_ways = |row: &&str| !row.contains("behind the barriers") && !row.contains("NaN");
    let mut rows = 0;
    for row in table.lines().skip(1).filter(of_ways) {
        let ends: Vec<&str> = row.rsplit(',').skip(3).take(3).collect();
        assert_eq!(ends, ["0", "0", "0"], "{row}");
        rows += 1;
    }
    assert!(rows > 20 && table.contains("Cross it"), "{table}");
    let behind = said.split("“meadow”, behind the barriers of each run").nth(1).unwrap();
    let energy = behind.lines().find(|line| line.contains("Total energy, P95")).unwrap();
    assert!(energy.contains(", of ") && energy.contains(" rocks for "), "{said}");
    assert!(read("compare.html").contains("barriers let the strongest through"));
}
