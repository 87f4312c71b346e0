//! `docs/scene.md` says what the reader knows: every key, no other, and an example that can be read.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rockfall::scene::Scene;
use std::path::Path;

const DOC: &str = include_str!("../../docs/scene.md");

fn example() -> &'static str {
    let (_, rest) = DOC.split_once("```toml\n").unwrap();
    rest.split_once("```").unwrap().0
}

/// Keys in the first column of a section's table.
fn documented(section: &str) -> Vec<String> {
    let (_, rest) = DOC.split_once(&format!("\n## {section}\n")).unwrap();
    let body = rest.split("\n## ").next().unwrap();
    let key = |line: &str| Some(line.strip_prefix("| `")?.split_once('`')?.0.to_owned());
    body.lines().filter_map(key).collect()
}

/// Keys that the reader knows in a table: its own message about an unknown one lists them.
fn known(scene: &str) -> Vec<String> {
    let said = Scene::parse(scene, Path::new("scene.toml")).unwrap_err().to_string();
    let (_, list) = said.split_once("known here: ").unwrap_or_else(|| panic!("{said}"));
    list.split(", ").map(str::to_owned).collect()
}

#[test]
fn the_example_can_be_read() {
    let scene = Scene::parse(example(), Path::new("docs/scene.toml")).unwrap();
    assert_eq!(scene.barriers[0].elsewhere().count(), 2);
    assert!(scene.grounds["spruce"].breaks_above_j.is_some());
}

/// Both ways round: nothing that is known is missing, nothing is promised that the reader refuses.
#[test]
fn every_known_key_stands_in_the_documentation() {
    let calibrate = "[calibrate]\ndeposits = \"ends.csv\"\n";
    let vary = "[[calibrate.vary]]\nground = \"talus\"\n";
    let contact = "[rocks.contact]\n";
    // where in a scene each table begins
    let places = [
        ("top", "seed = 2017\n", ""),
        ("terrain", "[[terrain]]\n", ""),
        ("terrain", "[[trees]]\n", ""),
        (
            "terrain.crop",
            "[terrain.crop]\n",
            "[[terrain]]\nground = \"talus\"\nfile = \"a.tif\"\n[terrain.crop]\n",
        ),
        ("ground_zones", "[[ground_zones]]\n", "[[ground_zones]]\nfile = \"a.geojson\"\n"),
        ("mesh", "[mesh]\n", "[mesh]\n"),
        ("grounds", "[grounds.talus]\n", ""),
        ("rocks", "[rocks]\n", ""),
        ("rocks.contact", contact, contact),
        (
            "rocks.shapes",
            "[[rocks.shapes]]\n",
            "[[rocks.shapes]]\nkind = \"eota111\"\ncorner_radius = 0.1\n",
        ),
        ("release", "[release]\n", ""),
        ("solver", "[solver]\n", "[solver]\n"),
        ("record", "[record]\n", ""),
        ("lines", "[[lines]]\n", ""),
        ("barriers", "[[barriers]]\n", ""),
        ("barriers.design", "[barriers.design]\n", ""),
        ("objects", "[[objects]]\n", ""),
        ("objects.vehicles", "vehicles = {", ""),
        ("frequency", "[frequency]\n", ""),
        ("frequency.sources", "[[frequency.sources]]\n", "[[frequency.sources]]\n"),
        ("frequency.classes", "[[frequency.classes]]\n", "[[frequency.classes]]\n"),
        ("frequency.matrix", "[frequency.matrix]\n", "[frequency.matrix]\n"),
        ("maps", "[maps]\n", ""),
        ("report", "[report]\n", ""),
        ("calibrate", calibrate, calibrate),
        (
            "calibrate.vary",
            vary,
            "[calibrate]\ndeposits = \"ends.csv\"\n[[calibrate.vary]]\nground = \"talus\"\n",
        ),
    ];
    for (section, begins, added) in places {
        let scene = format!("{}\n{added}", example());
        assert!(scene.contains(begins), "{section}");
        let end = if begins.ends_with('{') { ", " } else { "\n" };
        let mut known = known(&scene.replacen(begins, &format!("{begins}zzz = 1{end}"), 1));
        let mut documented = documented(section);
        known.sort();
        documented.sort();
        assert_eq!(known, documented, "{section}");
    }
}

/// The rules as `docs/scene.md` has them: UNI 11211-4 with 1.02 for a good survey, 1.10 for values from literature, P95
/// and the elongation free behind the barrier; ONR 24810 with the larger of 1.2 times the elongation and 1 m more.
#[test]
fn the_rules_of_the_standards_are_those_that_were_read() {
    let design = |scene: &str| {
        let scene = Scene::parse(scene, Path::new("scene.toml")).unwrap();
        scene.barriers[0].design.clone().unwrap()
    };
    let near = |found: f64, read: f64| assert!((found - read).abs() < 1e-12, "{found} {read}");
    let uni = design(example());
    assert_eq!(uni.standard(), Some("UNI 11211-4"));
    near(uni.percentile(), 95.0);
    for factors in [uni.speed_factors(), uni.height_factors()] {
        assert_eq!(factors.len(), 2);
        near(factors["topography"], 1.02);
        near(factors["simulation"], 1.10);
    }
    near(uni.free_distance_m().unwrap(), 3.5);
    let poor =
        example().replace("\"good\"", "\"poor\"").replace("\"literature\"", "\"back-analysed\"");
    near(design(&poor).speed_factors()["topography"], 1.10);
    near(design(&poor).speed_factors()["simulation"], 1.02);
    let onr = example()
        .replace("uni-11211-4\"", "onr-24810\"\npercentile = 99.0")
        .replace("topography = \"good\"\nsimulation = \"literature\"\n", "");
    let at = |elongation: &str| {
        let scene = onr.replace("elongation_m = 3.5", &format!("elongation_m = {elongation}"));
        design(&scene).free_distance_m().unwrap()
    };
    near(design(&onr).percentile(), 99.0);
    assert!(design(&onr).speed_factors().is_empty());
    near(at("3.5"), 4.5);
    near(at("10.0"), 12.0);
}

/// A barrier with a corner, moved: every piece keeps its distance, on the left for positive offsets. By hand: beside
/// (0, 0), (10, 0), (10, 10) lie (0, 2), (8, 2), (8, 10).
#[test]
fn a_moved_barrier_keeps_its_distance() {
    let scene = example().replace(
        "points_m = [[2600000.0, 1200050.0], [2600060.0, 1200050.0]]",
        "points_m = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0]]",
    );
    let scene = scene.replace("offsets_m = [-10.0, 10.0]", "offsets_m = [2.0, -2.0]");
    let scene = Scene::parse(&scene, Path::new("scene.toml")).unwrap();
    let moved: Vec<_> = scene.barriers[0].elsewhere().collect();
    assert_eq!((moved[0].1.as_str(), moved[1].1.as_str()), ("net +2 m", "net -2 m"));
    let expected =
        [[[0.0, 2.0], [8.0, 2.0], [8.0, 10.0]], [[0.0, -2.0], [12.0, -2.0], [12.0, 10.0]]];
    for ((_, _, line), expected) in moved.iter().zip(expected) {
        for (found, corner) in line.corners_m().iter().zip(expected) {
            assert!(
                (found[0] - corner[0]).abs() + (found[1] - corner[1]).abs() < 1e-12,
                "{line:?}"
            );
        }
    }
}
