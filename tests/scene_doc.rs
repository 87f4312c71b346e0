//! `docs/scene.md` says what the reader knows: every key, no other, and an example that can be read.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rockfall::scene::Scene;
use std::path::Path;

const DOC: &str = include_str!("../docs/scene.md");

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
        ("mesh", "[mesh]\n", "[mesh]\n"),
        ("grounds", "[grounds.talus]\n", ""),
        ("rocks", "[rocks]\n", ""),
        ("rocks.contact", contact, contact),
        ("release", "[release]\n", ""),
        ("solver", "[solver]\n", "[solver]\n"),
        ("record", "[record]\n", ""),
        ("lines", "[[lines]]\n", ""),
        ("barriers", "[[barriers]]\n", ""),
        ("barriers.design", "[barriers.design]\n", ""),
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
        let mut known = known(&scene.replacen(begins, &format!("{begins}zzz = 1\n"), 1));
        let mut documented = documented(section);
        known.sort();
        documented.sort();
        assert_eq!(known, documented, "{section}");
    }
}
