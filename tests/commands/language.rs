//! `[report] language`: what a run writes for people is in the language of its scene, whole.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use crate::program::rockfall;
use crate::{boxes, site, svg};
use std::fs;
use std::path::{Path, PathBuf};

/// English words that page and figures have in other words elsewhere. Names that the examples give, and what the program
/// records in English, stand apart.
const ENGLISH: [&str; 30] = [
    "What arrives",
    "Conditional on release",
    "conditional on release",
    "Statistics over",
    "reach probability",
    "at rest",
    "left the terrain",
    "Bounce height",
    "Total energy",
    "total energy",
    "Read this first",
    "Share of",
    "Barriers",
    "design height",
    "How often a year",
    "Passages over",
    "Agreement with",
    // what the program records
    "left out",
    "seed ",
    "kept for",
    "smallest",
    "at rest after",
    "slower impacts",
    "no ground has",
    "friction angle",
    "in nine of ten",
    "of memory, and about",
    "are sampled by importance",
    // the page of a comparison
    "within chance",
    "Cross it",
];

/// Runs an example in a language and returns the folder of its results.
fn run(dir: &Path, example: &str, language: &str) -> PathBuf {
    let scene = fs::read_to_string(format!("examples/{example}.toml")).unwrap();
    let terrain = fs::canonicalize("terrain").unwrap();
    let table = format!("[report]\nlanguage = \"{language}\"\n");
    let scene = if scene.contains("[report]\n") {
        scene.replace("[report]\n", &table)
    } else {
        format!("{scene}\n{table}")
    };
    let path = dir.join(format!("{example}_{language}.toml"));
    fs::write(&path, scene.replace("../terrain", terrain.to_str().unwrap())).unwrap();
    let out = dir.join(format!("{example}_{language}"));
    let (path, folder) = (path.to_str().unwrap(), out.to_str().unwrap());
    let said = rockfall(&["run", path, "--releases", "80", "--out", folder, "--quiet"]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    out
}

/// What the page says, without its style and without the health of the meshes, which is recorded in English.
fn spoken(page: &str) -> String {
    let (head, rest) = page.split_once("<style>").unwrap();
    let (_, body) = rest.split_once("</style>").unwrap();
    let mut words = svg::strip_tags(head);
    for (k, part) in body.split("lang=\"en\"").enumerate() {
        let rest =
            if k == 0 { part } else { part.split_once("</pre>").map_or("", |(_, behind)| behind) };
        words += &svg::strip_tags(rest);
    }
    words
}

fn check(out: &Path, language: &str) {
    check_page(out, "report.html", language);
    let view = fs::read_to_string(out.join("view.html")).unwrap();
    assert!(view.contains(&format!("<html lang=\"{language}\">")));
    let (_, body) = view.split_once("</style>").unwrap();
    let (seen, _) = body.split_once("<script type=").unwrap();
    for odd in ["What is shown", "Mouse, touch", "drag", "click", "release", "{", "}"] {
        assert!(!svg::strip_tags(seen).contains(odd), "{language}: {odd}");
    }
}

/// A page and the figures beside it are in a language, whole.
fn check_page(out: &Path, name: &str, language: &str) {
    let page = fs::read_to_string(out.join(name)).unwrap();
    assert!(page.contains(&format!("<html lang=\"{language}\">")));
    let words = spoken(&page);
    for odd in ENGLISH.into_iter().chain(["{", "}", "NaN"]) {
        let at = words.find(odd).map(|at| words[at..].chars().take(60).collect::<String>());
        assert_eq!(at, None, "{language}: {odd}");
    }
    for figure in fs::read_dir(out.join("figures")).unwrap() {
        let path = figure.unwrap().path();
        if path.extension().is_some_and(|kind| kind == "svg") {
            let place = path.display().to_string();
            let drawing = fs::read_to_string(&path).unwrap();
            svg::check(&drawing, &place);
            let faults = boxes::faults(&drawing, &place);
            assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }
}

/// Lines, a net with a design, four grounds and stems; three sources with what a year brings; measured ends.
#[test]
fn a_run_speaks_the_language_of_its_scene() {
    let dir = tempfile::tempdir().unwrap();
    for (example, languages) in [
        ("valley", ["de", "fr", "it"]),
        ("road", ["it", "de", "fr"]),
        ("tschamut", ["fr", "it", "de"]),
    ] {
        for language in languages {
            check(&run(dir.path(), example, language), language);
        }
    }
    // two runs of one language are compared in it
    let folder = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (a, b, out) = (folder("valley_de"), folder("valley_de_b"), folder("compared"));
    let scene = folder("valley_de.toml");
    let said =
        rockfall(&["run", &scene, "--releases", "120", "--seed", "3", "--out", &b, "--quiet"]);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    assert!(rockfall(&["compare", &a, &b, "--out", &out]).status.success());
    check_page(Path::new(&out), "compare.html", "de");
    // drawn again from the files alone it is the same page: the summary knows the language
    let out = dir.path().join("road_it");
    let before = fs::read(out.join("report.html")).unwrap();
    assert!(rockfall(&["draw", out.to_str().unwrap()]).status.success());
    assert_eq!(fs::read(out.join("report.html")).unwrap(), before);
}

/// Objects of a scene without frequency have a warning, in the language of the page as all others.
#[test]
fn objects_without_a_year_are_warned_of_in_the_language_of_the_page() {
    let dir = site::Folder::new();
    dir.slope();
    // and a line below the release
    let line = "[[lines]]\nname = \"edge\"\npoints_m = [[2600010.5, 1200090.25], [2600050.5, 1200090.25]]\n";
    let road = "[[objects]]\nname = \"road\"\nwidth_m = 4.0\npoints_m = [[2600010.0, 1200030.5], [2600040.0, 1200030.5]]\n";
    for (language, said, stands) in [
        ("de", "ohne [frequency]", "auf der Linie „edge“"),
        ("fr", "sans [frequency]", "se trouvent sur la ligne «\u{a0}edge\u{a0}»"),
        ("it", "senza [frequency]", "si trovano sulla linea “edge”"),
    ] {
        let more = format!("{road}{line}[report]\nlanguage = \"{language}\"\n");
        let out = dir.run(language, &site::scene("file = \"dem.tif\"", &more));
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains(said) && !page.contains("without [frequency]"), "{language}");
        assert!(page.contains(stands) && !page.contains("before they move"), "{language}");
    }
}
