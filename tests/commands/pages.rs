//! The pages in a browser, what stands beside them, and what of a plan they say in each language.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stderr, reason = "what was not tried must be said")]

use crate::program::rockfall;
use crate::site::{Folder, scene};
use rockfall::plan::Plan;
use rockfall::report::words::Words;
use rockfall::scene::{Language, Scene};
use std::fs;
use std::path::Path;
use std::process::Command;

fn run(words: &[&str]) {
    let said = rockfall(words);
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
}

/// A browser without a window, on one file; none where no Chromium is installed.
fn browser(profile: &Path, file: &Path, words: &[&str]) -> Option<Vec<u8>> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let said = names.iter().find_map(|name| {
        Command::new(name)
            .args(["--headless", "--no-sandbox", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update"])
            .args(["--disable-sync", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
            .arg("--virtual-time-budget=20000")
            .arg(format!("--user-data-dir={}", profile.display()))
            .args(words)
            .arg(format!("file://{}", file.display()))
            .output()
            .ok()
    })?;
    assert!(said.status.success(), "{}", String::from_utf8_lossy(&said.stderr));
    Some(said.stdout)
}

/// The view is drawn with WebGL without an error, in its language; the report prints to pages that are numbered.
#[test]
fn the_pages_open_in_a_browser() {
    let dir = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string("examples/quick.toml").unwrap();
    let terrain = fs::canonicalize("terrain").unwrap();
    let scene = scene.replace("../terrain", terrain.to_str().unwrap());
    let path = dir.path().join("scene.toml");
    fs::write(&path, format!("{scene}\n[report]\nlanguage = \"de\"\n")).unwrap();
    let out = dir.path().join("out");
    let words = [path.to_str().unwrap(), "--out", out.to_str().unwrap()];
    run(&[&["run", "--quiet", "--releases", "60"], &words[..]].concat());
    let profile = dir.path().join("profile");
    let Some(dom) = browser(&profile, &out.join("view.html"), &["--dump-dom"]) else {
        eprintln!("no Chromium is installed: the pages were not opened in a browser");
        return;
    };
    let dom = String::from_utf8(dom).unwrap();
    assert!(dom.contains("data-state=\"drawn\""), "{}", &dom[..dom.len().min(400)]);
    for word in ["Was gezeigt wird", "Gesamtenergie unterwegs", "Höhenlinien alle", "Bahnen"] {
        assert!(dom.contains(word), "{word}");
    }
    let pdf = dir.path().join("report.pdf");
    let print = format!("--print-to-pdf={}", pdf.display());
    let _ = browser(&profile, &out.join("report.html"), &[&print, "--no-pdf-header-footer"]);
    let printed = fs::read(&pdf).unwrap();
    // "/Pages" are the nodes above them
    let pages = printed.windows(12).filter(|at| at.starts_with(b"/Type /Page") && at[11] != b's');
    let pages = pages.count();
    // more of them would be half empty ones
    assert!(printed.starts_with(b"%PDF") && (9..=16).contains(&pages), "{pages} pages");
}

/// The figure of a study of this very scene stands on its page: from the folder of the results, or from beside it.
#[test]
fn a_study_of_this_scene_stands_on_its_page() {
    let dir = tempfile::tempdir().unwrap();
    let path = |name: &str| dir.path().join(name).to_str().unwrap().to_owned();
    let (out, beside, inside) =
        (path("reports/quick"), path("reports/error/quick"), path("reports/quick/error"));
    let of_run = ["run", "examples/quick.toml", "--quiet", "--releases", "60", "--out", &out];
    let shows = || {
        let page = fs::read_to_string(Path::new(&out).join("report.html")).unwrap();
        page.contains("Error against run time") && page.contains("with 80 releases under each")
    };
    let study =
        |to: &str| run(&["study", "error", "examples/quick.toml", "--releases", "80", "--out", to]);
    run(&of_run);
    assert!(!shows());
    study(&beside);
    run(&["draw", &out]);
    assert!(shows());
    // of another seed it says nothing
    run(&[&of_run[..], &["--overwrite", "--seed", "5"]].concat());
    assert!(!shows());
    fs::rename(&beside, &inside).unwrap();
    // the next run finds it by itself, and leaves it where it is
    run(&[&of_run[..], &["--overwrite"]].concat());
    assert!(shows() && Path::new(&inside).join("README.md").exists());
}

/// Parts that some language calls as English does.
const SAME: [&str; 5] = ["version", "file", "impacts", "orientation", "terrain"];
/// Parts whose text is a name, a number or the user's own.
const NAMES: [&str; 6] = ["scene", "file", "version", "gravity", "grounds", "catalogue"];

/// The plans of the example of blocks with springs, with all kernels and with none.
fn blocks_on_springs() -> [Plan; 2] {
    let terrain = Path::new(env!("CARGO_MANIFEST_DIR")).join("terrain");
    let text = fs::read_to_string("examples/blocks.toml").unwrap();
    let text = text.replace("../terrain", terrain.to_str().unwrap()).replace("e8", "e10");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("blocks.toml");
    fs::write(&file, text.replace("\"rigid\"", "\"adaptive\"")).unwrap();
    let plan = || Plan::of_scene(&Scene::read(&file).unwrap()).unwrap();
    [plan(), plan().without_kernels()]
}

/// The figure of retention shows what one barrier lets through to the next, which meets fewer rocks than cross its line; of a
/// single barrier there is nothing to tell apart, and the caption speaks of one colour.
#[test]
fn retention_shows_what_arrives_at_a_barrier_behind_another() {
    let dir = Folder::new();
    dir.slope();
    let barrier = |name: &str, north_m: f64| {
        format!(
            "[[barriers]]\nname = \"{name}\"\npoints_m = [[2600002.0, {north_m:?}], [2600058.0, {north_m:?}]]\n\
             height_m = 1.5\ncapacity_j = 1e6\n"
        )
    };
    let upper = barrier("upper", 1_200_070.5);
    let line =
        "[[lines]]\nname = \"edge\"\npoints_m = [[2600002.0, 1200080.5], [2600058.0, 1200080.5]]\n";
    for (name, more, is_two) in [
        ("one", line.to_owned() + &upper, false),
        ("two", upper.clone() + &barrier("lower", 1_200_050.5), true),
    ] {
        let out = dir.run(name, &scene("file = \"dem.tif\"", &more));
        let figure = fs::read_to_string(out.join("figures/retention.svg")).unwrap();
        assert_eq!(figure.contains("with barriers"), is_two, "{name}");
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert_eq!(page.contains("Light: without barriers"), is_two, "{name}");
        // which rocks a percentile is of stands in its name
        let nets = fs::read_to_string(out.join("maps/barriers.geojson")).unwrap();
        for column in ["total_p95_j", "arriving_total_p95_j", "arriving_top_p95_m"] {
            assert!(nets.contains(&format!("\"{column}\":")), "{column}: {nets}");
        }
    }
}

/// What the plan of every example says is said in every language, part and text.
#[test]
fn every_plan_is_said_in_every_language() {
    let mut missing = Vec::new();
    let folders = ["examples", "examples/paper"].map(|dir| fs::read_dir(dir).unwrap());
    let mut scenes: Vec<_> = folders.into_iter().flatten().map(|one| one.unwrap().path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|kind| kind == "toml"));
    scenes.sort();
    assert!(scenes.len() > 15, "{}", scenes.len());
    let plans = scenes.iter().map(|path| Plan::of_scene(&Scene::read(path).unwrap()).unwrap());
    for plan in plans.chain(blocks_on_springs()) {
        for language in [Language::De, Language::Fr, Language::It] {
            let words = Words::of(language);
            for entry in plan.entries_for(plan.count) {
                let is_said =
                    NAMES.contains(&entry.name.as_str()) || words.knows(&entry.said).is_some();
                let same = SAME.contains(&entry.name.as_str());
                if !is_said || !same && words.part(&entry.name) == entry.name {
                    missing.push(format!("{language:?}: {}: {}", entry.name, entry.said));
                }
            }
        }
    }
    missing.sort();
    missing.dedup();
    assert!(missing.is_empty(), "{}", missing.join("\n"));
}

/// Where ground values come from, weights in vain and ends that do not agree are said in every language.
#[test]
fn sources_and_first_warnings_are_said_in_every_language() {
    let recorded = [
        "written in the scene; [report] ground_source names no source",
        "written in the scene; measured ends ([calibrate]) stand beside it and are not fitted",
        "calibrated on measured ends ([calibrate] fitted of the scene)",
        "the computed ends are not distributed like the measured ones: KS distance 0.957, 5 % limit 0.184. The ground values do not hold for this slope",
        "whether the computed ends are distributed like the measured ones cannot be told: 590 of 600 computed rocks had not ended, and the KS distance is anything from 0.012 to 1.000, 5 % limit 0.133. Give a longer [solver] longest_s or terrain that reaches farther",
        "400 of 1000 releases tried out lie over the object “road” before they move: they hit it at once, with the energy of the release. Draw the object or the release elsewhere",
        "the weights of zones.geojson are not used: every class of size and source gets the same number of rocks, and each rock stands for its part of the frequency of its zone",
    ];
    for language in [Language::De, Language::Fr, Language::It] {
        for text in recorded {
            assert!(Words::of(language).knows(text).is_some(), "{language:?}: {text}");
        }
    }
}

/// What plan and run warn of, one of each that no other test makes: said whole in every language.
const WARNED: [&str; 41] = [
    "rocks differ up to 1000 times in mass and contacts up to 100000 times in stiffness: where the product is more than 2e6 blows through several contacts are taken one by one, and a boulder on a light stone comes off too slowly; write stiffnesses that are nearer to each other, or scheme = \"adaptive\"",
    "[grounds.r] lies under no mesh",
    "[grounds.r] has breaks_above_j, but no tree: only trees give way",
    "[grounds.r] like rstone/debris: its source has no rolling friction, and without any nothing stops a sphere that rolls; write rolling_friction",
    "[grounds.r] rolling_friction acts on blocks beside their shape, which already holds them back as they roll: keep only what soft ground takes; a value that was fitted to spheres counts the shape twice",
    "capture_speed_m_s = 0.001 is below half the tolerance of 0.05 m/s: slow rocks may flutter and never come to rest; write 0.025 or more",
    "[grounds.r] omega * step_s = 2.300 for a rock of 0.150 m, which is thrown back within one step, the livelier the longer the step: write a step_s below 1.3e-5",
    "[grounds.r] omega * step_s = 0.400 for a rock of 0.150 m, which does not resolve its impacts: write a step_s below 1.3e-5",
    "[rocks.contact] normal_stiffness_n_m = 1e8 lets a rock of 0.500 m sink in by more than 0.1 of its radius in impacts above 24.3 m/s; 2.7e8 would hold it up to 40 m/s",
    "step_s = 1e-6 lets a rock fall for 10.000 s at most before its budget of 10000000 steps is spent; write a longer step, or a longest_s below that",
    "stems.stl: 1500 of 1500 stems do not stand on the slope: 1400 with their foot more than 0.5 m above it, 60 with their top under it, 40 beside it; rocks meet them in the wrong place or not at all. Export the file in the coordinates and heights of the terrain, or look at its scale and up",
    "trees: none of 300 rocks touched one; do they stand where the rocks come?",
    "s.stl: its map coordinates are written in steps of 1, 140 % of the median edge 0.707, and 3 of its 6962 facets have no area: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
    "s.stl: its map coordinates are written in steps of 1, 40 % of the median edge 2.500: where they were rounded, slopes are wrong; export it with three decimals or more, or with a map origin subtracted and origin_m in the scene",
    "6286 of 6962 triangles have no area and are left out: what is left is hardly the terrain; does the file have too few digits?",
    "zones.geojson: properties that are not used: frequency, Weights; zones have name, weight, volume_m3",
    "[[barriers]] \"net\" height_m = 500 is higher than any net; is it in cm? write 5",
    "[[barriers]] \"net\" height_m = 15 is higher than any net; the tallest in use have about 10 m",
    "95.0 % of the places drawn for 1000 releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain; 30.1 % on ground so steep that no height is clear of it): such a place is drawn again",
    "95.0 % of the places drawn for 1000 releases have no ground or no room for the rock (a hole, a tree, the edge of the terrain): such a place is drawn again",
    "62 of 1000 releases tried out find no place to start from: each has a row with the stop reason not_released and counts in no statistic",
    "60 releases over 20 classes of size and source: with fewer than 30 each the intervals a year may be too narrow; write count = 600 or more",
    "3 of 100 rocks failed: they count as far as they came; `--only 7` shows one again",
    "78 of 1200 rocks were not released, in the ground or a tree: they are counted, but in no statistic; the first is release 4",
    "78 of 1200 rocks were not released, no ground below: they are counted, but in no statistic; the first is release 4",
    "3 of 100 rocks were still moving when their budget of work was spent: they count as far as they came; `--only 7` shows one again",
    "12 of 4000 contact steps did not settle: their contact forces do not agree with their motion; take a smaller tolerance_m_s, step_s or corner_way, whichever the scheme has",
    "the computation itself lost 3.1 % of the energy released, beside friction and damping; take a smaller tolerance or step, or scheme \"reference\"",
    "release 7: its mechanical energy rose by 3.10e2 J in one contact; take a smaller tolerance or step",
    "rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share, as how long a heap moves: run several seeds and compare",
    "A, B: the rocks of one world meet each other, but all intervals take them for independent and are too narrow for what they share: a change that is clear here may be chance. Run several seeds of each scene and compare.",
    "g.rolling_friction: the values that fit best reach the lower end of the range tried, 0.25, and better ones may lie below it; write a smaller from in vary",
    "g.restitution: the values that fit best reach the upper end of the range tried, 0.3, and better ones may lie above it; write a larger to in vary",
    "in the fit on all 136 of 800 computed rocks (17.0 %) had not ended, 46 had left the terrain, 90 were still moving: mean runouts and shares are at least what is said, KS distances and intervals hold however these rocks would have ended; write a longer longest_s and a larger terrain",
    "g.rolling_friction: rocks that had not ended leave open which values fit best, as far as to the lower end of the range tried, 0.25; write a longer longest_s or a larger terrain before a smaller from in vary",
    "g.restitution: rocks that had not ended leave open which values fit best, as far as to the upper end of the range tried, 0.3; write a longer longest_s or a larger terrain before a larger to in vary",
    "the values tried do not explain the measured ends: KS distance 0.812 of the fit on all, 5 % limit 0.188; write wider ranges in vary, vary other values, or look at terrain, rocks and releases",
    "The design energy 1250 kJ is that of the design block of 2.00 m³ (5400 kg without factors) at P95 of speed, 19.0 m/s without factors.",
    "The design energy is P95 of total energy with the squares of the factors on speed; the standard has that of its design block at P95 of speed, which block_volume_m3 asks for.",
    "The capacity must be 1.2 times that, 1500 kJ.",
    "The standard's factor on the energy of the barrier is not applied: its value is yours, capacity_factor takes it.",
];

/// Words that no other language has.
const ENGLISH_ALONE: [&str; 8] =
    [" the ", " of ", " is ", " and ", " rocks ", " or ", "no ground", " write "];

#[test]
fn warnings_are_said_whole_in_every_language() {
    for language in [Language::De, Language::Fr, Language::It] {
        for text in WARNED {
            let said = Words::of(language).knows(text);
            let is_whole = |said: &String| ENGLISH_ALONE.iter().all(|word| !said.contains(word));
            assert!(said.as_ref().is_some_and(is_whole), "{language:?}: {text}: {said:?}");
        }
    }
}

fn plan_of(path: &Path, text: &str) -> Plan {
    Plan::of_scene(&Scene::parse(text, path).unwrap()).unwrap()
}

/// Whatever looks like another unit is said in every language.
#[test]
fn slips_are_said_in_every_language() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples");
    // stiff enough for what is too large
    let quick = fs::read_to_string(examples.join("quick.toml")).unwrap().replace("e8", "e12");
    let spruce = "restitution = 0.2\nbreaks_above_j = 50.0\n";
    let slip = "friction_angle_deg = 32.0\nslip_friction = { max = 0.2, kappa_per_m = 0.7, beta_per_s = 20.0 }\n";
    let weak = "\n[[barriers]]\nname = \"net\"\npoints_m = [[2.0, 40.0], [38.0, 40.0]]\nheight_m = 3.0\ncapacity_j = 100.0\n";
    let tall = weak.replace("3.0", "500.0").replace("100.0", "1e6");
    let sizes = "radius_m = { lognormal = { median = 0.3, sigma = 0.3, min = 0.1, max = 0.8 } }\n";
    let litres =
        "\n[frequency]\nper_year_at_1m3 = 0.01\nexponent = 0.7\nvolume_m3 = [10.0, 50000.0]\n";
    let half = "\n[[lines]]\nname = \"path\"\npoints_m = [[20.0, 45.0], [60.0, 45.0]]\n";
    let low = tall.replace("500.0", "0.02");
    let design = tall.replace("500.0", "4.0")
        + "[barriers.design]\nrule = \"onr-24810\"\npercentile = 95.0\nfree_height_m = 50.0\nelongation_m = 400.0\n";
    let road = "\n[[objects]]\nname = \"road\"\npoints_m = [[2.0, 40.0], [38.0, 40.0]]\nwidth_m = 3.0\nvehicles = { per_day = 50000.0, speed_km_h = 60.0, length_m = 4.5 }\n";
    for (written, slipped, hint) in [
        ("density_kg_m3 = 2700.0", "density_kg_m3 = 2.7", "t/m³"),
        ("density_kg_m3 = 2700.0", "density_kg_m3 = 27000.0", "rock has about"),
        ("friction_angle_deg = 32.0", "friction_angle_deg = 0.56", "radians"),
        ("friction_angle_deg = 32.0\n", slip, "slip_friction.max"),
        ("restitution = 0.2\n", spruce, "breaks_above_j"),
        ("seed = 1\n", "seed = 1\nepsg = 99999\n", "no code of EPSG"),
        ("seed = 1\n", "seed = 1\nepsg = 4326\n", "geographic"),
        ("seed = 1\n", "seed = 1\nepsg = 3857\n", "Web Mercator"),
        ("max = 0.8 }", "max = 80.0 }", "in cm or mm"),
        (sizes, litres, "in litres"),
        ("\n[maps]", &format!("{weak}\n[maps]"), "capacity_j"),
        ("\n[maps]", &format!("{tall}\n[maps]"), "is it in cm? write 5"),
        ("restitution = 0.35\n", "restitution = 0.35\nbreaks_above_j = 5e4\n", "but no tree"),
        ("\n[maps]", &format!("{half}\n[maps]"), "“path”: 20 of its 40 m have no ground below"),
        ("gravity_m_s2 = 9.81", "gravity_m_s2 = 98.1", "on Earth it is"),
        (
            "{ uniform = [0.0, 1.0] }, 0.0]",
            "{ uniform = [0.0, 150.0] }, 0.0]",
            "is it in km/h? write 41.7",
        ),
        ("\n[maps]", &format!("{low}\n[maps]"), "lower than any net or dam"),
        (
            "\n[maps]",
            &format!("{design}\n[maps]"),
            "free_height_m = 50 is more than half of any block; is it in cm? write 0.5",
        ),
        (
            "\n[maps]",
            &format!("{design}\n[maps]"),
            "elongation_m = 400 is more than any net stretches; is it in cm? write 4",
        ),
        ("\n[maps]", &format!("{road}\n[maps]"), "vehicles.per_day = 50000"),
    ] {
        assert!(quick.contains(written), "{written}");
        let plan = plan_of(&examples.join("slips.toml"), &quick.replacen(written, slipped, 1));
        assert!(
            plan.warnings.iter().any(|said| said.contains(hint)),
            "{hint}: {:?}",
            plan.warnings
        );
        for language in [Language::De, Language::Fr, Language::It] {
            let unknown =
                plan.warnings.iter().find(|said| Words::of(language).knows(said).is_none());
            assert_eq!(unknown, None, "{language:?}");
        }
    }
}
