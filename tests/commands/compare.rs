//! Two runs compared: intervals keep what they promise, a run beside itself differs by nothing, pages hold what is in the table.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use crate::{boxes, program, svg};

use program::rockfall;
use rockfall::hazard::{Difference, Reading, Values};
use rockfall::math::{self, exp};
use rockfall::random::{Purpose, stream, unit};
use rockfall::report::compare::Comparison;
use std::path::{Path, PathBuf};

/// Releases of each made run.
const ROCKS: usize = 400;
/// Made pairs of runs: the coverage found has a standard deviation of 0.4 %.
const PAIRS: usize = 3000;
/// Largest coverage …
const MOST: f64 = 0.97;
/// … and that of paired percentiles: ranks are whole, and the widest place that a percentile may lie at counts.
const MOST_OF_PAIRS: f64 = 0.985;

/// Pairs of standard normal numbers with a correlation of 0.8, and a third one beside them.
fn draws(seed: usize) -> Vec<[f64; 3]> {
    let mut random = stream(seed as u64, Purpose::Redraw, 0);
    // Box and Muller (1958)
    let mut draw = || {
        let (far, turn) = (unit(&mut random), unit(&mut random));
        (-2.0 * math::ln(far)).sqrt() * math::cos(std::f64::consts::TAU * turn)
    };
    (0..ROCKS)
        .map(|_| {
            let (one, other, third) = (draw(), draw(), draw());
            [one, 0.8 * one + 0.6 * other, third]
        })
        .collect()
}

/// Share of the made pairs in which `of` gives an interval that holds `truth`.
fn coverage(truth: f64, of: impl Fn(&[[f64; 3]]) -> Difference) -> f64 {
    let holds = |seed: &usize| {
        let (low, high) = of(&draws(*seed)).interval.expect("enough rocks");
        (low..=high).contains(&truth)
    };
    (0..PAIRS).filter(holds).count() as f64 / PAIRS as f64
}

fn values(draws: &[[f64; 3]], of: impl Fn(&[f64; 3]) -> f64) -> Values {
    draws.iter().enumerate().map(|(k, draw)| (k, of(draw))).collect()
}

/// Name, true difference, and how the statistic is read.
type Case<'a> = (&'a str, f64, &'a dyn Fn(&Values) -> Reading);

/// Skewed, like energies: exp(z) against 1.3 exp(0.9 z').
fn energies(draws: &[[f64; 3]]) -> [Values; 2] {
    [values(draws, |z| exp(0.6 * z[0])), values(draws, |z| 1.3 * exp(0.54 * z[1]))]
}

/// The 95 % intervals hold the true difference in 93 to 97 of 100 made pairs, paired or not; of paired percentiles in up to 98.5.
#[test]
fn intervals_hold_the_truth_as_often_as_they_promise() {
    let quantile = |z: f64| 1.3 * exp(0.54 * z) - exp(0.6 * z);
    let z95 = 1.644_853_626_951_472_7;
    let mean = 1.3 * exp(0.54 * 0.54 / 2.0) - exp(0.6 * 0.6 / 2.0);
    for paired in [true, false] {
        // without pairing the second run comes from the draws of another seed, as it would
        let both = |draws_a: &[[f64; 3]]| {
            let [a, b] = energies(draws_a);
            if paired { [a, b] } else { [a, values(draws_a, |z| 1.3 * exp(0.54 * z[2]))] }
        };
        let percentile = |p: f64| move |values: &Values| Reading::percentile(values, p).unwrap();
        let cases: [Case<'_>; 3] = [
            ("mean", mean, &|values| Reading::mean(values).unwrap()),
            ("median", quantile(0.0), &percentile(0.5)),
            ("P95", quantile(z95), &percentile(0.95)),
        ];
        for (name, truth, read) in cases {
            let found = coverage(truth, |draws| {
                let [a, b] = both(draws);
                Difference::between(&read(&a), &read(&b), paired)
            });
            println!("{name}, paired {paired}: {found}");
            let most = if paired && name != "mean" { MOST_OF_PAIRS } else { MOST };
            assert!((0.93..=most).contains(&found), "{name}, paired {paired}: {found}");
        }
    }
}

/// The same for shares, common and rare, and for rocks of which only some come to a line.
#[test]
fn shares_and_rocks_at_a_line_keep_their_promise_too() {
    let above = |values: &Values, limit: f64| -> Vec<usize> {
        values.iter().filter(|(_, x)| *x > limit).map(|(k, _)| *k).collect()
    };
    // P(z > 0.5) against P(z' > 0.3), and 2.3 % against 4.5 %
    let upper = |limit: f64| 0.5 * math::erfc(limit / std::f64::consts::SQRT_2);
    for (limit_a, limit_b) in [(0.5, 0.3), (2.0, 1.7)] {
        let truth = upper(limit_b) - upper(limit_a);
        for (paired, other) in [(true, 1), (false, 2)] {
            let found = coverage(truth, |draws| {
                let (a, b) = (values(draws, |z| z[0]), values(draws, |z| z[other]));
                let (a, b) = (above(&a, limit_a), above(&b, limit_b));
                Difference::of_shares((&a, ROCKS), (&b, ROCKS), paired)
            });
            println!("share {limit_a}, paired {paired}: {found}");
            assert!((0.93..=MOST).contains(&found), "share {limit_a}, paired {paired}: {found}");
        }
    }
    // a rock crosses where its third number is large; then its energy is exp of the first
    let median = 1.3_f64 - 1.0;
    let found = coverage(median, |draws| {
        let [mut a, mut b] = energies(draws);
        a.retain(|(k, _)| draws[*k][2] > -0.2);
        b.retain(|(k, _)| draws[*k][2] > 0.3);
        let read = |values: &Values| Reading::percentile(values, 0.5).unwrap();
        Difference::between(&read(&a), &read(&b), true)
    });
    println!("median at a line: {found}");
    assert!((0.93..=MOST_OF_PAIRS).contains(&found), "median at a line: {found}");
}

/// Pairing pays: with a correlation of 0.8 the interval of the mean is less than two thirds as wide.
#[test]
fn common_chance_narrows_the_interval() {
    let [a, b] = energies(&draws(7));
    let width = |paired: bool| {
        let read = |values: &Values| Reading::mean(values).unwrap();
        let (low, high) = Difference::between(&read(&a), &read(&b), paired).interval.unwrap();
        high - low
    };
    assert!(width(true) < 0.67 * width(false), "{} {}", width(true), width(false));
}

/// The quick example, some of it changed, run in a folder of its own.
pub(super) fn run(dir: &Path, name: &str, count: &str, edit: impl Fn(String) -> String) -> PathBuf {
    let folder = std::fs::canonicalize("terrain").unwrap();
    let scene = std::fs::read_to_string("examples/quick.toml").unwrap();
    let scene = edit(scene.replace("../terrain", folder.to_str().unwrap()));
    let path = dir.join(format!("{name}.toml"));
    std::fs::write(&path, scene).unwrap();
    let out = dir.join(name);
    let words = [
        "run",
        path.to_str().unwrap(),
        "--quiet",
        "--releases",
        count,
        "--out",
        out.to_str().unwrap(),
    ];
    let said = rockfall(&words);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    out
}

/// With a net of 3 m and 200 kJ on the meadow's line, and behind it.
const NET: &str = "\n[[barriers]]\nname = \"net\"\npoints_m = [[0.0, 18.0], [24.0, 18.0]]\nheight_m = 3.0\ncapacity_j = 2e5\n";

#[test]
fn a_run_beside_itself_differs_by_nothing() {
    let dir = tempfile::tempdir().unwrap();
    let one = run(dir.path(), "one", "80", |scene| scene + NET);
    let comparison = Comparison::of(&one, &one).unwrap();
    assert_eq!(comparison.largest(), (0.0, 0.0));
    let out = dir.path().join("out");
    let folders = [one.to_str().unwrap(), one.to_str().unwrap()];
    let said = rockfall(&["compare", folders[0], folders[1], "--out", out.to_str().unwrap()]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    // an earlier comparison is replaced
    assert!(
        rockfall(&["compare", folders[0], folders[1], "--out", out.to_str().unwrap()])
            .status
            .success()
    );
    let table = std::fs::read_to_string(out.join("differences.csv")).unwrap();
    assert!(table.lines().count() > 30, "{table}");
    for row in table.lines().skip(1) {
        let ends: Vec<&str> = row.rsplit(',').skip(2).take(7).collect();
        let is_zero = |text: &str| matches!(text, "0" | "-0" | "NaN");
        // few rocks have no P95, and 299 or more a P99
        let is_few = row.contains(", P") && ends[6].parse::<usize>().unwrap() < 299;
        let value = if is_few && ends[4] == "NaN" { "NaN" } else { "0" };
        assert!(
            ends[0] == "true" && is_zero(ends[1]) && is_zero(ends[2]) && ends[3] == value,
            "{row}"
        );
    }
    let page = std::fs::read_to_string(out.join("compare.html")).unwrap();
    svg::check_nesting(&page, "compare.html");
    assert!(
        page.contains("one and the same run") && !page.contains("<script") && !page.contains("NaN")
    );
}

/// With and without the trees, and with a line that bends elsewhere: the hash, the mesh and the impacts differ, and the pages say what.
#[test]
fn what_differs_is_named_and_what_changes_is_shown() {
    let dir = tempfile::tempdir().unwrap();
    let with = run(dir.path(), "with", "150", |scene| scene);
    let without = run(dir.path(), "without", "200", |scene| {
        let (before, rest) = scene.split_once("[[trees]]").unwrap();
        let (_, after) = rest.split_once("[grounds.rock]").unwrap();
        let (after, tail) = after.split_once("[grounds.trunk]").unwrap();
        let (_, tail) = tail.split_once("[rocks]").unwrap();
        let tail = tail.replace("[20.0, 50.0]", "[20.0, 49.0]");
        format!("{before}[grounds.rock]{after}[rocks]{tail}{NET}")
    });
    let comparison = Comparison::of(&with, &without).unwrap();
    let (largest, width) = comparison.largest();
    assert!(largest > 0.0 && width > 0.0);
    // a terminal says too what makes a difference no difference
    assert!(comparison.headline().join("\n").contains("in both runs: meadow."));
    let out = dir.path().join("out");
    comparison.write(&out).unwrap();
    let page = std::fs::read_to_string(out.join("compare.html")).unwrap();
    svg::check_nesting(&page, "compare.html");
    for words in [
        "Hash of scene and meshes",
        "Plan: trees",
        "Only in B: net.",
        "Not at the same place in both runs: meadow.",
        "Place of “meadow”",
        "Only the releases 0 to 149",
        "pair by pair",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // what only the trees' ground says stands beside nothing, not beside what another ground says
    let of_trunk: Vec<&str> =
        page.split("<tr>").filter(|row| row.contains("<td>trunk: ")).collect();
    assert!(!of_trunk.is_empty() && of_trunk.iter().all(|row| row.contains("<td>–</td>")));
    let drawn: Vec<PathBuf> = std::fs::read_dir(out.join("figures"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    assert!(drawn.len() >= 3);
    for path in drawn {
        let drawing = std::fs::read_to_string(&path).unwrap();
        let place = path.display().to_string();
        svg::check(&drawing, &place);
        let faults = boxes::faults(&drawing, &place);
        assert!(faults.is_empty(), "{}", faults.join("\n"));
        assert!(page.contains(&drawing));
    }
    let table = std::fs::read_to_string(out.join("differences.csv")).unwrap();
    let trees = table.lines().find(|row| row.contains("Impacts on trees")).unwrap();
    // without trees none is hit: the value of B is 0, and the change is clear
    let numbers: Vec<&str> = trees.split(',').collect();
    let at = |back: usize| numbers[numbers.len() - 2 - back].parse::<f64>().unwrap();
    assert!(at(5).abs() < 1e-300 && at(6) > 0.0 && at(2) < 0.0, "{trees}");
}

/// Two seeds do not pair; a folder with results is never written over.
#[test]
fn other_seeds_do_not_pair_and_results_stay_as_they_are() {
    let dir = tempfile::tempdir().unwrap();
    let one = run(dir.path(), "one", "30", |scene| scene);
    let other = run(dir.path(), "other", "30", |scene| scene.replace("seed = 1", "seed = 2"));
    let comparison = Comparison::of(&one, &other).unwrap();
    let out = dir.path().join("out");
    comparison.write(&out).unwrap();
    let page = std::fs::read_to_string(out.join("compare.html")).unwrap();
    assert!(page.contains("Two seeds: nothing pairs") && page.contains("<td>1</td><td>2</td>"));
    let message = program::message(comparison.write(&one));
    assert!(message.contains("holds the results of a run"), "{message}");
    let message = program::message(Comparison::of(&one, &out));
    assert!(message.contains("holds no results"), "{message}");
}

/// Walls over the release line between which only small rocks find room, as trees of the quick example.
fn walls(dir: &Path) -> String {
    let quad = |k: i32| {
        let x = 0.55 * f64::from(k);
        let corner = |y: f64, z: f64| format!("vertex {x} {y} {z}\n");
        let [a, b, c, d] =
            [(2.0, -10.0), (6.0, -10.0), (6.0, 40.0), (2.0, 40.0)].map(|(y, z)| corner(y, z));
        let facet = |p: &str, q: &str, r: &str| {
            format!("facet normal 0 0 0\nouter loop\n{p}{q}{r}endloop\nendfacet\n")
        };
        facet(&a, &b, &c) + &facet(&a, &c, &d)
    };
    let facets: String = (5..68).map(quad).collect();
    let path = dir.join("walls.stl");
    std::fs::write(&path, format!("solid walls\n{facets}endsolid walls\n")).unwrap();
    format!("\n[[trees]]\nmesh = \"{}\"\nground = \"trunk\"\n", path.display())
}

/// Rocks that found no place count in no share at a line, as in the report of their run; of pairs neither rock counts.
#[test]
fn rocks_that_were_not_released_count_in_no_share() {
    let dir = tempfile::tempdir().unwrap();
    let walls = walls(dir.path());
    let free = run(dir.path(), "free", "150", |scene| scene);
    let tight = run(dir.path(), "tight", "150", |scene| scene + &walls);
    let other =
        run(dir.path(), "other", "150", |scene| scene.replace("seed = 1", "seed = 2") + &walls);
    let reach = |out: &Path| -> f64 {
        let summary = std::fs::read_to_string(out.join("summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&summary).unwrap();
        let lost = summary["stops"]["not_released"].as_u64().unwrap_or(0);
        assert_eq!(lost > 20 && lost < 130, out != free, "{lost}");
        100.0 * summary["lines"][1]["reach"]["share"].as_f64().unwrap()
    };
    let compared = |one: &Path, other: &Path| -> ([f64; 2], String) {
        let out = dir.path().join("out");
        Comparison::of(one, other).unwrap().write(&out).unwrap();
        let table = std::fs::read_to_string(out.join("differences.csv")).unwrap();
        let row =
            table.lines().find(|row| row.contains("meadow") && row.contains("Cross it")).unwrap();
        let cells: Vec<&str> = row.rsplit(',').collect();
        let page = std::fs::read_to_string(out.join("compare.html")).unwrap();
        ([cells[7], cells[6]].map(|cell| cell.parse().unwrap()), page)
    };
    let close = |found: f64, own: f64| (found - own).abs() < 1e-9;
    // nothing pairs: each run's own share
    let ([a, b], page) = compared(&tight, &other);
    assert!(close(a, reach(&tight)) && close(b, reach(&other)), "{a} {b}");
    assert!(page.contains("were not released"));
    // pairs: of the small rocks alone, which the walls have let be released
    let ([a, b], page) = compared(&free, &tight);
    assert!(close(b, reach(&tight)) && !close(a, reach(&free)) && a > 0.0, "{a} {b}");
    let lost = page.split("rocks of A and ").next().unwrap().rsplit(['>', ' ']).nth(1).unwrap();
    assert!((21..130).contains(&lost.parse().unwrap()), "{lost}");
}

/// Rocks whose time is up would have gone on: what they decide is a bound on terminal, page and table, and no difference is clear that they
/// may undo. Both runs of the same rocks: their ways are known as far as the shorter one goes.
#[test]
fn what_open_rocks_decide_is_a_bound() {
    let dir = tempfile::tempdir().unwrap();
    let after = |time_s: &'static str| {
        move |scene: String| format!("{scene}\n[solver]\nlongest_s = {time_s}\n")
    };
    let (whole, cut) = (
        run(dir.path(), "whole", "200", after("120.0")),
        run(dir.path(), "cut", "200", after("1.5")),
    );
    let compared = |one: &Path, other: &Path| -> (String, String, String) {
        let out = dir.path().join("out");
        let words = [one, other, &out].map(|path| path.to_str().unwrap());
        let said = rockfall(&["compare", words[0], words[1], "--out", words[2]]);
        assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
        let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap();
        (String::from_utf8(said.stdout).unwrap(), read("differences.csv"), read("compare.html"))
    };
    let row = |table: &str, name: &str| -> Vec<String> {
        let row = table.lines().find(|row| row.contains(name)).unwrap();
        row.rsplit(',').map(str::to_owned).collect()
    };
    let (said, table, page) = compared(&whole, &cut);
    // paired, low and high stand before the two bounds
    let runout = row(&table, "Runout, P50");
    assert_eq!(runout[..4], [">=", ">=", "true", "inf"], "{runout:?}");
    // few leave the terrain of the whole ways: these bound the median of A from above too
    let low: f64 = runout[4].parse().unwrap();
    assert!(low.is_finite() && low < 0.0, "{runout:?}");
    let mean = row(&table, "Runout, mean");
    assert_eq!(mean[..5], [">=", ">=", "true", "inf", "-inf"], "{mean:?}");
    // some of the longer ones leave the terrain: of two bounds nothing is known
    let line = said.lines().find(|line| line.contains("Runout, P95")).unwrap();
    assert!(line.contains("≥\u{2009}") && line.contains("left open"), "{line}");
    assert!(!line.contains("clear"), "{line}");
    // the fastest so far may become faster
    let speed = row(&table, "Largest speed, P95");
    assert_eq!((speed[0].as_str(), speed[3].as_str()), (">=", "inf"), "{speed:?}");
    // the angle lies below what was seen
    assert_eq!(row(&table, "Reach angle, P50")[..2], ["<=", "<="]);
    let meadow = table.lines().find(|row| row.contains("meadow") && row.contains("Cross it"));
    let ends: Vec<&str> = meadow.unwrap().rsplit(',').collect();
    // none has come so far in that time, and all still may
    assert!(ends[0] == ">=" && ends[3].parse::<f64>().unwrap() > 0.0, "{meadow:?}");
    assert!(page.contains("left open"));
    let (said, table, _) = compared(&cut, &whole);
    let runout = row(&table, "Runout, P50");
    assert!(runout[..2] == [">=", ">="] && runout[4] == "-inf", "{runout:?}\n{said}");
}

/// A percentile that the run's report does not give for want of rocks is not compared: P95 takes 59, P99 299. What is missing is said.
#[test]
fn a_percentile_that_no_report_gives_is_not_compared() {
    let dir = tempfile::tempdir().unwrap();
    let [few, more] = ["40", "70"].map(|count| run(dir.path(), count, count, |scene| scene + " "));
    let out = dir.path().join("out");
    let [few, more, out] = [&few, &more, &out].map(|path| path.to_str().unwrap());
    let said = rockfall(&["compare", few, more, "--out", out]);
    let said = String::from_utf8(said.stdout).unwrap();
    let line = said.lines().find(|line| line.contains("Runout, P95")).unwrap();
    // one seed: of both runs the 40 releases that they share
    assert_eq!(line.matches("– (19 more rocks needed)").count(), 2, "{line}");
    let read = |name: &str| std::fs::read_to_string(Path::new(out).join(name)).unwrap();
    let row =
        |table: &str, name: &str| table.lines().find(|row| row.contains(name)).unwrap().to_owned();
    let table = read("differences.csv");
    assert!(row(&table, "Runout, P99").ends_with(",40,40,NaN,NaN,NaN,NaN,NaN,true,,"), "{table}");
    assert!(!row(&table, "Runout, P50").contains("NaN"), "{table}");
    assert!(read("compare.html").contains("259 more rocks needed"));
}
