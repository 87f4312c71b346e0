//! Rocks weigh what they stand for wherever a run is read: beside another run, beside measured ends.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use crate::program;

use program::rockfall;
use rockfall::frequency::{Frequency, FrequencyLaw, RockSource, Weights};
use rockfall::hazard::{Difference, Reading, Values, WeightedCount};
use rockfall::random::{Purpose, stream, unit};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The road below three sources, some of it changed, run in a folder of its own.
fn run(dir: &Path, name: &str, change: impl Fn(String) -> String) -> PathBuf {
    let terrain = format!("{}/terrain/", env!("CARGO_MANIFEST_DIR"));
    let scene = fs::read_to_string("examples/road.toml").unwrap();
    let file = dir.join(format!("{name}.toml"));
    fs::write(&file, change(scene.replace("../terrain/", &terrain))).unwrap();
    let out = dir.join(name);
    let (file, to) = (file.to_str().unwrap(), out.to_str().unwrap());
    let done = rockfall(&["run", file, "--quiet", "--releases", "400", "--out", to]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    out
}

fn summary(out: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}

/// A row of `differences.csv`: the values of both runs, lower and upper end of the interval.
fn row(table: &str, group: &str, statistic: &str) -> Option<[f64; 4]> {
    let start = format!("{group},\"{statistic}\",");
    let row = table.lines().find(|line| line.starts_with(&start))?;
    // behind them: paired, and whether each is a bound
    let mut ends = row.rsplit(',').skip(2).map(|cell| cell.parse().unwrap_or(f64::NAN));
    let (_, high, low, _) = (ends.next()?, ends.next()?, ends.next()?, ends.next()?);
    let (b, a) = (ends.next()?, ends.next()?);
    Some([a, b, low, high])
}

/// Every share, mean, percentile and rate that is compared is the one of its own run's summary, to rounding.
#[test]
fn what_is_compared_is_what_each_run_says() {
    let dir = tempfile::tempdir().unwrap();
    let a = run(dir.path(), "a", |scene| scene);
    let b = run(dir.path(), "b", |scene| {
        let scene = scene.replace("rolling_friction = 0.25", "rolling_friction = 0.30");
        scene.replace("per_year_at_1m3 = 0.005", "per_year_at_1m3 = 0.05")
    });
    let out = dir.path().join("ab");
    let [one, other] = [&a, &b].map(|path| path.to_str().unwrap());
    let said = rockfall(&["compare", one, other, "--out", out.to_str().unwrap()]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let table = fs::read_to_string(out.join("differences.csv")).unwrap();
    let both = [summary(&a), summary(&b)];
    let check = |group: &str, statistic: &str, of: &dyn Fn(&Value) -> f64| {
        let [a, b, low, high] = row(&table, group, statistic).unwrap();
        for (found, own) in [a, b].into_iter().zip(both.each_ref().map(of)) {
            assert!((found / own - 1.0).abs() < 1e-9, "{group} {statistic}: {found} {own}");
        }
        assert!(low <= b - a && b - a <= high, "{group} {statistic}: {low} {high}");
    };
    let all = "\"All releases\"";
    check(all, "Come to rest", &|of| {
        100.0 * of["stop_shares"]["at_rest"]["share"].as_f64().unwrap()
    });
    let statistic = |name: &'static str| move |of: &Value| of["statistics"][name].clone();
    let runout = statistic("runout_m");
    check(all, "Runout, mean", &|of| runout(of)["mean"]["value"].as_f64().unwrap());
    let energy = statistic("max_total_j");
    for (percentile, key) in [("P50", "p50"), ("P95", "p95")] {
        check(all, &format!("Largest total energy, {percentile}"), &|of| {
            energy(of)["percentiles"][key]["value"].as_f64().unwrap() / 1e3
        });
    }
    let named = |list: &Value, name: &str| -> Value {
        list.as_array().unwrap().iter().find(|one| one["name"] == name).unwrap().clone()
    };
    let group = "\"Object “road”, barriers left aside\"";
    let line = |of: &Value| named(&of["lines"], "road");
    let place = |of: &Value| named(&of["annual"]["places"], "road");
    let reach = |of: &Value| 100.0 * line(of)["reach"]["share"].as_f64().unwrap();
    check(group, "Hit it", &reach);
    check(group, "Total energy, P50", &|of| {
        line(of)["statistics"]["total_j"]["percentiles"]["p50"]["value"].as_f64().unwrap() / 1e3
    });
    let rate = |of: &Value, which: &str| place(of)[which]["passages"]["per_year"].as_f64().unwrap();
    check(group, "Passages", &|of| rate(of, "without_barriers"));
    check("\"“road”, behind the barriers of each run\"", "Passages", &|of| {
        rate(of, "with_barriers")
    });
    let page = fs::read_to_string(out.join("compare.html")).unwrap();
    for words in ["Rocks weigh what they stand for:", "Rocks computed", "pair by pair"] {
        assert!(page.contains(words), "{words}");
    }
}

/// Another number of classes: the same number is another rock. The page says so, and nothing pairs.
#[test]
fn other_classes_do_not_pair() {
    let dir = tempfile::tempdir().unwrap();
    let a = run(dir.path(), "a", |scene| scene);
    let b = run(dir.path(), "b", |scene| {
        scene.replace("volume_m3 = [0.02, 20.0]", "volume_m3 = [0.02, 2.0]")
    });
    let out = dir.path().join("ab");
    let [one, other] = [&a, &b].map(|path| path.to_str().unwrap());
    let said = rockfall(&["compare", one, other, "--out", out.to_str().unwrap()]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    let page = fs::read_to_string(out.join("compare.html")).unwrap();
    assert!(page.contains("One seed, but other sources or other classes of size: nothing pairs."));
    let table = fs::read_to_string(out.join("differences.csv")).unwrap();
    assert!(table.lines().skip(1).all(|line| line.contains(",false,")), "{table}");
}

/// Releases of each made run.
const ROCKS: usize = 600;
/// Made pairs of runs: the coverage found has a standard deviation of 0.7 %.
const PAIRS: u64 = 1000;
/// Chance that a rock of the first, and of the second run comes to the line.
const REACH: [f64; 2] = [0.3, 0.4];

/// Releases that come, and a value of each that grows with its volume, of a run.
fn made(frequency: &Frequency, seed: u64, run: usize, paired: bool) -> (Vec<usize>, Values) {
    let of_run = if paired { 0 } else { 100_000 * run as u64 };
    let mut values = Values::new();
    for release in 0..ROCKS {
        let mut random = stream(seed + of_run, Purpose::Size, release);
        let volume_m3 = frequency.stratum(release).quantile_m3(unit(&mut random)).unwrap();
        if unit(&mut random) < REACH[run] {
            let grown = if run == 0 { 1.0 } else { 1.2 };
            values.push((release, grown * volume_m3.powf(0.25) * (0.5 + unit(&mut random))));
        }
    }
    (values.iter().map(|(release, _)| *release).collect(), values)
}

/// The 95 % intervals of differences of weighted runs hold the truth in 93 to 99 of 100 made pairs: rocks are taken as independent
/// in means and percentiles, that sizes are spread evenly makes these a little too wide. Weights differ between the runs.
#[test]
fn intervals_of_weighted_differences_hold_the_truth() {
    let law = |per_year_at_1m3: f64| FrequencyLaw::PowerLaw {
        per_year_at_1m3,
        exponent: 0.5,
        volume_m3: [0.1, 100.0],
    };
    let source = |law: FrequencyLaw| RockSource { name: "wall".to_owned(), law };
    let frequencies =
        [0.1, 0.2].map(|rate| Frequency::new(vec![source(law(rate))], vec![], vec![]));
    let weights: [Weights; 2] = frequencies.each_ref().map(|one| one.weights(ROCKS));
    let (b, c) = (0.5, 0.25);
    let moment = |p: f64| 100_f64.powf(p) - 0.1_f64.powf(p);
    let mean = b / (c - b) * moment(c - b) / -moment(-b);
    let median = median(&frequencies[0]);
    let totals = weights.each_ref().map(Weights::total_per_year);
    let truths = [
        ("share", REACH[1] - REACH[0]),
        ("rate", totals[1] * REACH[1] - totals[0] * REACH[0]),
        ("mean", 0.2 * mean),
        ("median", 0.2 * median),
    ];
    let all: Vec<usize> = (0..ROCKS).collect();
    for paired in [true, false] {
        let mut inside = [0_u32; 4];
        for seed in 0..PAIRS {
            let runs = [0, 1].map(|run| made(&frequencies[run], seed, run, paired));
            let counts = [0, 1].map(|run| WeightedCount {
                releases: &runs[run].0,
                among: &all,
                weights: &weights[run],
            });
            let read = |of: &dyn Fn(&Values, &Weights) -> Option<Reading>| {
                let [a, b] = [0, 1].map(|run| of(&runs[run].1, &weights[run]).unwrap());
                Difference::between(&a, &b, paired)
            };
            let found = [
                Difference::of_weighted_shares(&counts[0], &counts[1], paired),
                Difference::of_rates(&counts[0], &counts[1], paired),
                read(&|values, weights| Reading::weighted_mean(values, weights)),
                read(&|values, weights| Reading::weighted_percentile(values, weights, 0.5)),
            ];
            for ((inside, found), (_, truth)) in inside.iter_mut().zip(found).zip(truths) {
                let (low, high) = found.interval.unwrap();
                *inside += u32::from((low..=high).contains(&truth));
            }
        }
        println!("paired {paired}: {inside:?} of {PAIRS}");
        for (count, (name, _)) in inside.into_iter().zip(truths) {
            assert!((930..=990).contains(&count), "{name}, paired {paired}: {count}");
        }
    }
}

/// Median of `V^¼ (0.5 + u)` over the law, from a fine grid of both.
fn median(frequency: &Frequency) -> f64 {
    let all = frequency.per_year();
    let mut values = Vec::new();
    for stratum in frequency.strata() {
        for k in 0..100 {
            let volume_m3 = stratum.quantile_m3((f64::from(k) + 0.5) / 100.0).unwrap();
            let value = |m: i32| volume_m3.powf(0.25) * (0.5 + (f64::from(m) + 0.5) / 100.0);
            values.extend((0..100).map(|m| (value(m), stratum.per_year / all / 1e4)));
        }
    }
    values.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut below = 0.0;
    let half = values.iter().find(|(_, weight)| {
        below += weight;
        below >= 0.5
    });
    half.unwrap().0
}

/// None of either: what was not seen may be of the heaviest class, so the interval goes as far as nearly three of its rocks.
#[test]
fn nothing_seen_of_weighted_rocks_is_not_nothing_known() {
    let class = |volume_m3: f64, per_year: f64| rockfall::frequency::Class {
        volume_m3: [volume_m3; 2],
        per_year,
    };
    let law = FrequencyLaw::Classes(vec![class(0.1, 0.9), class(10.0, 0.1)]);
    let sources = vec![RockSource { name: "wall".to_owned(), law }];
    let weights = Frequency::new(sources, vec![], vec![]).weights(200);
    let all: Vec<usize> = (0..200).collect();
    let none = WeightedCount { releases: &[], among: &all, weights: &weights };
    let found = Difference::of_weighted_shares(&none, &none, true);
    let (low, high) = found.interval.unwrap();
    // the heaviest stands for 0.9/100 of all events; 1.96 √2 of it
    assert!((high - 0.009 * 1.959_964 * 2_f64.sqrt()).abs() < 1e-6 && (low + high).abs() < 1e-15);
}

/// The table of agreement says the mean runout of the other tables, and a fit of such rocks is refused.
#[test]
fn computed_ends_weigh_beside_measured_ones() {
    let dir = tempfile::tempdir().unwrap();
    let end = |k: usize| format!("{}.0,4.0,{}.5,{}.0\n", 6 + k % 6, 7 + k % 6, 40 + 2 * k);
    let ends = "release_x_m,release_y_m,x_m,y_m\n".to_owned();
    let ends = (0..12).map(end).fold(ends, |all, end| all + &end);
    fs::write(dir.path().join("ends.csv"), ends).unwrap();
    let with_ends = |scene: String| {
        let vary = "[[calibrate.vary]]\nground = \"rock\"\nkey = \"rolling_friction\"\nfrom = 0.1\nto = 0.4\nbefore = 0.25\n";
        format!("{scene}\n[calibrate]\ndeposits = \"ends.csv\"\n{vary}")
    };
    let out = run(dir.path(), "measured", with_ends);
    let mean = summary(&out)["statistics"]["runout_m"]["mean"]["value"].as_f64().unwrap();
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    // with as many digits as its interval leaves
    let said = page.split(" m measured, ").nth(1).and_then(|rest| rest.split(" (").next());
    // some rocks have left the terrain: the mean is a lower bound, and marked so
    let number = said.map(|said| said.trim_start_matches(|c: char| !c.is_ascii_digit()));
    let found: f64 = number.and_then(|said| said.parse().ok()).unwrap();
    assert!((found - mean).abs() <= 0.5 + 1e-9, "{found} for {mean}");
    assert!(page.contains("Computed rocks weigh what they stand for"));
    let scene = dir.path().join("measured.toml");
    let fit = dir.path().join("fit");
    let said = rockfall(&["calibrate", scene.to_str().unwrap(), "--out", fit.to_str().unwrap()]);
    let message = String::from_utf8_lossy(&said.stderr);
    assert_eq!(said.status.code(), Some(2), "{message}");
    assert!(message.contains("a fit weighs every rock the same"), "{message}");
}

/// A share by frequency never stands beside counts as if these gave it: on the page, in its figures, in the view and on the terminal.
#[test]
fn no_count_gives_a_share_by_frequency() {
    let dir = tempfile::tempdir().unwrap();
    let out = run(dir.path(), "road", |scene| scene);
    let of = summary(&out);
    let left = &of["stop_shares"]["left_terrain"];
    let (share, count) = (left["share"].as_f64().unwrap(), left["count"].as_u64().unwrap());
    // else the test would not tell one from the other
    assert!((share - count as f64 / 400.0).abs() > 0.02, "{left}");
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let censored = format!("of the rocks by frequency ({count} of 400 computed)");
    for words in [
        &censored,
        "by frequency; of 400 computed rocks",
        "arriving (computed)",
        &format!("; {count} computed"),
        "Shares are by frequency; numbers of rocks are of computed ones.",
        "Curves, lines and bars are by frequency;",
        "by frequency (",
        "half of all computed ones lie",
        "median rock by frequency",
    ] {
        assert!(page.contains(words), "{words}");
    }
    for words in [" of 400 rocks (", " of 400 releases, reach", &format!("{count} (")] {
        assert!(!page.contains(words), "{words}");
    }
    let view = fs::read_to_string(out.join("view.html")).unwrap();
    assert!(
        view.contains("of the rocks by frequency cross") && !view.contains(" of 400 rocks cross")
    );
    assert!(view.contains("of those that arrive, by frequency"));
    let stops = fs::read_to_string(out.join("figures/stops.svg")).unwrap();
    let faults = crate::boxes::faults(&stops, "stops.svg");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    half_of_the_bars_lie_before_the_median(&out);
}

/// Bars and percentiles of a figure are of the same rocks, weighed alike: half of all that the bars show lies before the median.
fn half_of_the_bars_lie_before_the_median(out: &Path) {
    let drawing = fs::read_to_string(out.join("figures/runout.svg")).unwrap();
    let number = |text: &str| text.parse::<f64>().unwrap();
    let of = |tag: &str, key: &str| {
        let value = tag.split_once(&format!(" {key}=\"")).unwrap().1;
        number(value.split_once('"').unwrap().0)
    };
    let is_bar = |tag: &&str| tag.starts_with("<rect") && tag.contains("#56b4e9");
    let bars: Vec<[f64; 3]> = drawing
        .split_inclusive('>')
        .map(str::trim_start)
        .filter(is_bar)
        .map(|tag| ["x", "width", "height"].map(|key| of(tag, key)))
        .collect();
    // percentiles go up from the foot of the bars, the median first
    let foot = "3600l0-1100\"";
    let line = drawing.split("<path d=\"M").filter(|path| path.contains(foot));
    let median = line.map(|path| number(path.split_once(' ').unwrap().0)).reduce(f64::min).unwrap();
    let all: f64 = bars.iter().map(|[.., height]| height).sum();
    let before = |is_before: &dyn Fn(&[f64; 3]) -> bool| -> f64 {
        bars.iter().filter(|bar| is_before(bar)).map(|[.., height]| height).sum::<f64>() / all
    };
    let least = before(&|[x, width, _]| x + width < median);
    let most = before(&|[x, ..]| *x <= median);
    // a bar is drawn to a tenth of a pixel
    assert!(least <= 0.505 && most >= 0.495, "{least} {most}: {bars:?}, median {median}");
}

/// A part of a run, or one rock of it, says what its own rocks do: no share is of classes and sources that it has none of. Parts put together
/// are the run.
#[test]
fn a_part_has_shares_of_its_own_rocks() {
    let dir = tempfile::tempdir().unwrap();
    let whole = run(dir.path(), "whole", |scene| scene);
    let scene = dir.path().join("whole.toml");
    let part = |name: &str, which: &[&str]| -> PathBuf {
        let out = dir.path().join(name);
        let (file, to) = (scene.to_str().unwrap(), out.to_str().unwrap());
        let words = ["run", file, "--quiet", "--releases", "400", "--out", to];
        let done = rockfall(&[&words, which].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        out
    };
    for (name, which) in [("one", ["--only", "7"]), ("few", ["--shard", "2/100"])] {
        let of = summary(&part(name, &which));
        let shares = of["stop_shares"].as_object().unwrap().values();
        let all: f64 = shares.map(|share| share["share"].as_f64().unwrap()).sum();
        assert!((all - 1.0).abs() < 1e-12, "{name}: {all}");
        for line in of["lines"].as_array().unwrap() {
            let reach = &line["reach"];
            let number = |key: &str| reach[key].as_f64().unwrap();
            let is_all = reach["count"] == of["releases"];
            assert!(!is_all || (number("share") - 1.0).abs() < 1e-12, "{name}: {line}");
            assert!(number("low_95") <= number("share") && number("share") <= number("high_95"));
        }
    }
    let parts = ["1/3", "2/3", "3/3"].map(|which| {
        part(&which.replace('/', "_"), &["--shard", which]).to_str().unwrap().to_owned()
    });
    let merged = dir.path().join("merged");
    let words = ["merge", "--out", merged.to_str().unwrap()];
    let parts: Vec<&str> = parts.iter().map(String::as_str).collect();
    let done = rockfall(&[&words, &parts[..]].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    program::same_results(&whole, &merged);
}
