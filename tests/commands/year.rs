//! Frequencies a year through the whole program: from the scene to maps, tables and page.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::program;

use program::{results, rockfall, same_results};
use rockfall::plan::Plan;
use rockfall::scene::Scene;
use rockfall::simulation::{Scratch, simulate_release};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn example(name: &str) -> String {
    fs::read_to_string(format!("examples/{name}.toml")).unwrap()
}

/// Writes a scene where its meshes can be found from, and runs it.
fn run(dir: &Path, name: &str, scene: &str, more: &[&str]) -> PathBuf {
    let terrain = format!("{}/terrain/", env!("CARGO_MANIFEST_DIR"));
    let file = dir.join(format!("{name}.toml"));
    fs::write(&file, scene.replace("../terrain/", &terrain)).unwrap();
    let out = dir.join(name);
    let order = ["run", file.to_str().unwrap(), "--quiet", "--out", out.to_str().unwrap()];
    let done = rockfall(&[&order, more].concat());
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    out
}

fn summary(out: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap()
}

/// Events a year of the scene's own rocks weigh all alike: every file that was there is there to the byte, and the
/// passage frequency of a cell is its reach probability times the events a year.
#[test]
fn equal_weights_change_no_file() {
    let dir = tempfile::tempdir().unwrap();
    let scene = example("quick");
    let before = results(&run(dir.path(), "before", &scene, &["--releases", "60"]));
    let with_year = format!("{scene}\n[frequency]\nper_year = 0.05\n");
    let folder = run(dir.path(), "after", &with_year, &["--releases", "60"]);
    let after = results(&folder);
    for (name, bytes) in &before {
        // the summary names the scene's hash and its sources; the plan stands in it
        // the lists of the figures and of the checksums name those of a year too
        let is_there = match name.as_str() {
            "figures/.drawn" | "results.sfv" => {
                let [before, after] =
                    [bytes, &after[name]].map(|text| String::from_utf8_lossy(text));
                before.lines().all(|figure| after.lines().any(|other| other == figure))
            }
            "summary.json" => true,
            _ => after[name] == *bytes,
        };
        assert!(is_there, "{name}");
    }
    let cells = |name: &str| -> Vec<f64> {
        let text = fs::read_to_string(folder.join("maps").join(name)).unwrap();
        let body = text.lines().skip(6).flat_map(str::split_whitespace);
        body.map(|number| number.parse().unwrap()).collect()
    };
    let (reach, year) = (cells("reach_probability.asc"), cells("frequency_per_year.asc"));
    assert!(reach.iter().any(|share| *share > 0.1));
    for (reach, year) in reach.iter().zip(&year).filter(|(_, year)| **year >= 0.0) {
        assert!((year - 0.05 * reach).abs() < 1e-7, "{year} {reach}");
    }
}

/// Three sources with weights of their own, objects, a net and maps, in shards and at once: the same bytes.
#[test]
fn shards_merge_with_weights() {
    let dir = tempfile::tempdir().unwrap();
    let scene = example("road");
    let whole = run(dir.path(), "whole", &scene, &["--releases", "90"]);
    let file = dir.path().join("whole.toml");
    let mut merge = vec!["merge".to_owned(), "--out".to_owned()];
    merge.push(dir.path().join("merged").to_str().unwrap().to_owned());
    for shard in ["2/3", "1/3", "3/3"] {
        let out = dir.path().join(shard.replace('/', "_"));
        let out = out.to_str().unwrap();
        let order = ["run", file.to_str().unwrap(), "--quiet", "--releases", "90"];
        let done =
            rockfall(&[&order[..], &["--shard", shard, "--out", out, "--threads", "1"]].concat());
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        // a part of a run tells nothing a year
        assert!(summary(Path::new(out))["annual"].is_null());
        merge.push(out.to_owned());
    }
    let merge: Vec<&str> = merge.iter().map(String::as_str).collect();
    let done = rockfall(&merge);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    same_results(&whole, &dir.path().join("merged"));
    let names = results(&whole);
    for name in ["frequency.csv", "maps/energy_T100_j.tif", "maps/frequency_per_year_low_95.tif"] {
        assert!(names.contains_key(name), "{name}");
    }
    // drawn again from the files alone: the same figures, on the page the same words
    let page = fs::read_to_string(whole.join("report.html")).unwrap();
    let drawn = rockfall(&["draw", whole.to_str().unwrap()]);
    assert!(drawn.status.success());
    assert_eq!(page, fs::read_to_string(whole.join("report.html")).unwrap());
    for said in [
        "How often a year: object “road”",
        "Kept away by “net”",
        "Risk a year: object “house”",
        "A year on the map",
        "Return period of 300 kJ or more",
        "Change of ln(frequency) with exponent",
    ] {
        assert!(page.contains(said), "{said}");
    }
    the_first_page_says_how_often(&page, &summary(&whole));
    // maps are results, not figures: what has lost them is run again
    fs::remove_dir_all(whole.join("maps")).unwrap();
    let drawn = rockfall(&["draw", whole.to_str().unwrap()]);
    let message = String::from_utf8_lossy(&drawn.stderr).into_owned();
    assert!(drawn.status.code() == Some(2) && message.contains("run again"), "{message}");
}

/// How often a year a block above 300 kJ reaches the road, with and without the net, stands on the first page, before what
/// arrives at lines: with interval, return period and derivatives.
fn the_first_page_says_how_often(page: &str, summary: &Value) {
    let (_, answer) = page.split_once("id=\"answer\"").unwrap();
    let (answer, _) = answer.split_once("</section>").unwrap();
    let (year, _) = answer.split_once("What arrives").unwrap_or((answer, ""));
    let places = summary["annual"]["places"].as_array().unwrap();
    let road = places.iter().find(|place| place["name"] == "road").unwrap();
    for (which, figures) in [("without", "without_barriers"), ("with", "with_barriers")] {
        let row = format!("object “road”: 300 kJ or more, {which} barriers");
        let (_, row) = year.split_once(&row).unwrap_or_else(|| panic!("{row} in {year}"));
        let (row, _) = row.split_once("</tr>").unwrap();
        assert_eq!(row.matches("<td").count(), 4, "{row}");
        let rate = &road[figures]["above"][2]["rate"];
        let found = rate["per_year"].as_f64().unwrap();
        // its first digit at least, whatever the number of digits that the interval leaves
        let digit = format!("{found:e}").chars().next().unwrap();
        assert!(row.contains(digit), "{rate}: {row}");
    }
}

/// The closed case through the program: without gravity every rock keeps its 20 m/s, and a line before a fifth of the
/// release line is crossed by a fifth of them. λ = 0.0248328157 a year above 300 kJ lies in its interval, and so does
/// 300 kJ in that of the energy of T = 40.2692957 years.
#[test]
fn the_closed_case_through_the_program() {
    const RATE: f64 = 0.024_832_815_7;
    let dir = tempfile::tempdir().unwrap();
    let scene = example("road");
    let (physics, _) = scene.split_once("[rocks]").unwrap();
    let physics = physics.replace("gravity_m_s2 = 9.81", "gravity_m_s2 = 0.0");
    let scene = format!(
        "{physics}\n[rocks]\ndensity_kg_m3 = 2700.0\n[release]\ncount = 3000\nheight_m = 1.0\n\
         velocity_m_s = [0.0, 20.0, 0.0]\nspin_rad_s = [0.0, 0.0, 0.0]\nline_m = [[10.0, 8.0], [30.0, 8.0]]\n\
         [solver]\nscheme = \"rigid\"\nlongest_s = 1.0\n\
         [frequency]\nper_year_at_1m3 = 0.1\nexponent = 0.5\nvolume_m3 = [0.1, 100.0]\n\
         return_periods_years = [40.2692957]\n\
         [[lines]]\nname = \"fifth\"\npoints_m = [[10.0, 9.0], [14.0, 9.0]]\n"
    );
    let found = summary(&run(dir.path(), "closed", &scene, &[]));
    let place = &found["annual"]["places"][0]["without_barriers"];
    let above = &place["above"][1];
    assert_eq!(above["energy_j"], 300e3);
    let number = |value: &Value| value.as_f64().unwrap();
    let rate = &above["rate"];
    println!("{rate}\n{}", place["returns"][0]);
    assert!(number(&rate["low_95"]) <= RATE && RATE <= number(&rate["high_95"]), "{rate}");
    // a fifth of a binomial of 3000 in strata: 5 % wide
    assert!((number(&rate["per_year"]) / RATE - 1.0).abs() < 0.12, "{rate}");
    let energy = &place["returns"][0];
    assert!(number(&energy["low_95"]) <= 300e3 && 300e3 <= number(&energy["high_95"]), "{energy}");
    // weighted back, the median rock is that of the law: V = (½ (0.1^−½ + 100^−½))^−2 = 0.3765 m³, all at 20 m/s
    let median = &found["statistics"]["max_total_j"]["percentiles"]["p50"];
    let exact = 540e3 * (0.5 * (0.1_f64.powf(-0.5) + 0.1)).powi(-2);
    assert!(number(&median["low_95"]) < exact, "{median}");
    assert!((number(&median["value"]) / exact - 1.0).abs() < 0.05, "{median}");
    // the time of all is up: for all that the run knows they might have become faster
    assert!(median["high_95"].is_null() && median["censored"] == true, "{median}");
}

/// Objects against brute force: along a path stored every 2 ms no rock is over an object before its hit, and at the hit
/// its rim touches it; one that never hits stays away all along.
#[test]
fn hits_are_where_paths_say() {
    let scene = example("road").replace("paths = 200", "paths = 60\npath_step_s = 0.002");
    let scene = Scene::parse(&scene, Path::new("examples/road.toml")).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    let plan = Plan::compile(&scene, terrain).unwrap();
    let mut scratch = Scratch::default();
    let (mut hits, mut misses) = (0, 0);
    for index in 0..60 {
        let fall = simulate_release(&plan, index, None, &mut scratch).unwrap();
        for (line, evaluation_line) in plan.recorders().lines.iter().enumerate() {
            let Some(footprint) = evaluation_line.footprint else { continue };
            let free_m =
                |x: f64, y: f64| evaluation_line.gap_m(footprint, [x, y]).0 - fall.rock.radius_m;
            let hit = fall.crossings.iter().find(|crossing| crossing.line == line);
            let until_s = hit.map_or(f64::INFINITY, |hit| hit.motion.time_s);
            for point in fall.path.iter().filter(|point| point.motion.time_s < until_s) {
                let at = point.motion.position_m;
                let free_m = free_m(at.x, at.y);
                assert!(
                    free_m > -1e-5,
                    "rock {index} {}: {free_m} at {} before {until_s}",
                    evaluation_line.name,
                    point.motion.time_s
                );
            }
            let Some(hit) = hit else {
                misses += 1;
                continue;
            };
            hits += 1;
            let at = hit.motion.position_m;
            let free_m_at = free_m(at.x, at.y);
            assert!(free_m_at.abs() < 1e-5, "rock {index} {}: {free_m_at}", evaluation_line.name);
            let below = fall.path.iter().find(|point| point.motion.time_s > until_s + 0.01);
            if let Some(later) = below {
                let at = later.motion.position_m;
                assert!(
                    free_m(at.x, at.y) < 0.05,
                    "rock {index} turns back at {}",
                    evaluation_line.name
                );
            }
        }
    }
    assert!(hits > 50 && misses > 10, "{hits} hits, {misses} misses");
}

/// Norway's classes by hand: a cell is of level 3, 2 or 1 where rocks pass more often than once in 100, 1000, 5000 years. The table's
/// numbers are those of the regulation.
#[test]
fn a_national_table_is_the_one_that_was_read() {
    let dir = tempfile::tempdir().unwrap();
    let [known] = rockfall::scene::MATRICES;
    assert_eq!(known.return_periods_years, [100.0, 1000.0, 5000.0]);
    let scene = example("quick")
        + "\n[frequency]\nper_year = 0.079\n[frequency.matrix]\ntable = \"tek17-7-3\"\n";
    let out = run(dir.path(), "tek", &scene, &["--releases", "80"]);
    let cells = |name: &str| -> Vec<f64> {
        let text = fs::read_to_string(out.join("maps").join(name)).unwrap();
        let body = text.lines().skip(6).flat_map(str::split_whitespace);
        body.map(|number| number.parse().unwrap()).collect()
    };
    let (levels, rates) = (cells("hazard_level.asc"), cells("frequency_per_year.asc"));
    let mut seen = [0; 4];
    for (level, rate) in levels.iter().zip(&rates).filter(|(_, rate)| **rate > 0.0) {
        let by_hand = [1.0 / 5000.0, 1.0 / 1000.0, 1.0 / 100.0];
        let expected = by_hand.iter().filter(|limit| *rate >= **limit).count();
        assert!((level - expected as f64).abs() < 1e-9, "{level} at {rate} a year");
        seen[expected] += 1;
    }
    // one rock of 80 stands for 0.00099 a year, eleven for more than 0.01: no cell is below the lowest limit
    assert!(seen[0] == 0 && seen[1..].iter().all(|cells| *cells > 0), "{seen:?}");
    let plan = summary(&out)["plan"].to_string();
    assert!(plan.contains("Byggteknisk forskrift (TEK17) § 7-3"), "{plan}");
    // the head of the map has no room for its name, the caption says what each level means
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("“TEK17 § 7-3: more often than the safety classes S3 (1), S2 (2), S1 (3) permit”; its source"));
}

/// What the plan says of the year, and what it says when nothing is asked.
#[test]
fn the_plan_says_what_the_year_needs() {
    let plan = rockfall(&["plan", "examples/road.toml"]);
    let said = String::from_utf8(plan.stdout).unwrap();
    for words in
        ["rocks are as precise as ", "west wall: 0.0", "hit when the rim", "sampled by importance"]
    {
        assert!(said.contains(words), "{words}");
    }
    let said = String::from_utf8(rockfall(&["plan", "examples/quick.toml"]).stdout).unwrap();
    assert!(said.contains("frequency          left out: the scene has no [frequency]"), "{said}");
}

/// A house under the release is hit before a rock has moved; the plan says so, and of one below the slope nothing.
#[test]
fn an_object_over_the_release_is_told() {
    let dir = crate::site::Folder::new();
    dir.slope();
    let house = |south: f64| {
        let [low, high] = [south, south + 6.0].map(|y| 1_200_000.0 + y);
        let corners = [[5.5, low], [55.5, low], [55.5, high], [5.5, high]];
        let corners = corners.map(|[x, y]| format!("[{}, {y}]", 2_600_000.0 + x)).join(", ");
        format!("[[objects]]\nname = \"house\"\npolygon_m = [{corners}]\n")
    };
    let told = "1000 of 1000 releases tried out lie over the object “house” before they move";
    let plan = |south: f64| dir.plan(&crate::site::scene("file = \"dem.tif\"", &house(south)));
    let [over, below] = [plan(87.25), plan(40.25)];
    assert!(over.contains(told) && !below.contains("before they move"), "{over}\n{below}");
}

/// A line that crosses itself is told, with the corners where its pieces begin; a ring and a line with a bend are not.
#[test]
fn a_line_that_crosses_itself_is_told() {
    let dir = crate::site::Folder::new();
    dir.slope();
    let plan = |offsets: &[[f64; 2]]| {
        let corner = |[x, y]: &[f64; 2]| format!("[{}, {}]", 2_600_010.25 + x, 1_200_040.25 + y);
        let corners = offsets.iter().map(corner).collect::<Vec<_>>().join(", ");
        let line = format!("[[lines]]\nname = \"road\"\npoints_m = [{corners}]\n");
        dir.plan(&crate::site::scene("file = \"dem.tif\"", &line))
    };
    let told = "line “road”: its pieces from corner 1 and corner 3 cross";
    let eight = plan(&[[0.0, 0.0], [20.0, 20.0], [20.0, 0.0], [0.0, 20.0]]);
    assert!(eight.contains(told), "{eight}");
    let ring = plan(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0], [0.0, 0.0]]);
    let bend = plan(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0]]);
    assert!(!ring.contains("cross;") && !bend.contains("cross;"), "{ring}{bend}");
}
