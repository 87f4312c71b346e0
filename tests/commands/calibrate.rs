//! A calibration finds values that are known, says how far it knows them, and writes the scene that has them.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program;

use program::rockfall;
use rockfall::calibrate::Calibration;
use rockfall::hazard::ObservedPath;
use rockfall::output::read_calibration;
use rockfall::release::Releases;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::terrain::stl::write_ascii;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

pub(super) fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// A level square of 80 m.
pub(super) fn plate(dir: &Path) {
    let p = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let corners = [p(-40.0, -40.0), p(40.0, -40.0), p(40.0, 40.0), p(-40.0, 40.0)];
    let facets = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    write_ascii(&dir.join("plate.stl"), "plate", &facets).unwrap();
}

/// Rocks thrown along a level: how far they roll tells their rolling friction, and next to nothing of restitution.
pub(super) fn thrown(dir: &Path, name: &str, speed: [f64; 2], more: &str) -> PathBuf {
    plate(dir);
    let text = format!(
        r#"title = "{name}"
seed = 4
[[terrain]]
mesh = "plate.stl"
ground = "meadow"
[grounds.meadow]
normal_stiffness_n_m = 1e7
shear_stiffness_n_m = 2.5e6
friction_angle_deg = 35.0
restitution = 0.3   # a remark that stays
rolling_friction = 0.45
[rocks]
density_kg_m3 = 2700.0
radius_m = {{ uniform = [0.15, 0.25] }}
[release]
count = 40
height_m = 0.0
velocity_m_s = [{{ uniform = {speed:?} }}, {{ uniform = [-0.5, 0.5] }}, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
points_m = [[-30.0, 0.0], [-30.0, 2.0]]
{more}
"#
    );
    let file = dir.join(format!("{name}.toml"));
    fs::write(&file, text).unwrap();
    file
}

/// Runs a scene and writes its ends as if they were measured; each block thrown twice.
fn measure(scene: &Path, seed: &str) -> PathBuf {
    let out = scene.with_extension("out");
    let done = rockfall(&["run", word(scene), "--quiet", "--seed", seed, "--out", word(&out)]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut text = "release_x_m,release_y_m,x_m,y_m,block\n".to_owned();
    for (number, row) in
        fs::read_to_string(out.join("releases.csv")).unwrap().lines().skip(1).enumerate()
    {
        let cells: Vec<&str> = row.split(',').collect();
        let [from_x, from_y, x, y] = [5, 6, 8, 9].map(|at| cells[at]);
        writeln!(text, "{from_x},{from_y},{x},{y},{}", number / 2).unwrap();
    }
    let ends = scene.with_extension("csv");
    fs::write(&ends, text).unwrap();
    ends
}

/// Two scenes whose true rolling friction is known are fitted together.
#[test]
fn a_known_value_is_found_and_an_idle_one_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let names = [("slow", [3.0, 5.0], "11"), ("fast", [5.0, 7.0], "12")];
    let scenes = names.map(|(name, speed, seed)| {
        let scene = thrown(dir.path(), name, speed, "");
        let ends = measure(&scene, seed);
        let vary = r#"vary = [
    { ground = "meadow", key = "rolling_friction", from = 0.2, to = 0.8, before = 0.7 },
    { ground = "meadow", key = "restitution", from = 0.1, to = 0.5, before = 0.3 },
]"#;
        let more = format!("[calibrate]\ndeposits = {:?}\n{vary}", ends.file_name().unwrap());
        thrown(dir.path(), name, speed, &more)
    });
    let out = dir.path().join("fit");
    let args =
        ["calibrate", word(&scenes[0]), word(&scenes[1]), "--releases", "40", "--out", word(&out)];
    let done = rockfall(&args);
    let said = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found = read_calibration(&out).unwrap().unwrap();
    let [rolling, restitution] = &found.told[..] else { panic!("{:?}", found.told) };
    let [low, high] = [rolling.low_95, rolling.high_95].map(Option::unwrap);
    assert!(low <= 0.45 && 0.45 <= high && rolling.is_told && high - low < 0.25, "{said}");
    assert!(!restitution.is_told, "{said}");
    assert!(said.contains("meadow.restitution") && said.contains("hardly tell it"), "{said}");
    let whole = &found.whole;
    assert!(whole.all.ks < whole.all.ks_limit && found.before.all.ks > 1.3 * whole.all.ks);
    assert_eq!(found.ends.0, 80);
    let parts: Vec<_> =
        found.held_out.iter().map(|one| (one.fitted.measured, one.kept_apart.measured)).collect();
    assert_eq!(parts, [(40, 40), (40, 40)], "two halves of twenty blocks thrown twice, twice");
    assert!(said.contains("held-out ends") && said.contains("fit without part 2 of 2"), "{said}");
    assert!(found.measures.iter().any(|m| m.what.starts_with("share past") && m.scene == "fast"));
    // the scene that has the values, with everything else as it was
    for name in ["slow", "fast"] {
        let fitted = out.join(format!("{name}_fitted.toml"));
        let text = fs::read_to_string(&fitted).unwrap();
        assert!(text.contains("# a remark that stays"), "{text}");
        let scene = Scene::read(&fitted).unwrap();
        let rolling = scene.grounds["meadow"].rolling_friction.as_ref().unwrap();
        assert!((rolling.as_fixed().unwrap() - whole.values[0]).abs() < 1e-6);
        assert!(rockfall(&["plan", word(&fitted)]).status.success());
    }
    let page = rockfall(&["run", word(&scenes[0]), "--quiet", "--overwrite", "--out", word(&out)]);
    assert!(page.status.success());
    let page = fs::read_to_string(out.join("report.html")).unwrap_or_default();
    assert!(page.contains("What the measured ends tell"), "the report tells of the fit beside it");
}

/// In a range far wider than what the ends leave open the search goes on until its steps are finer than that: the interval
/// is of the ends and not of the grid. Of a figure that cannot be below 0 it is said what chance comes to.
#[test]
fn the_interval_is_that_of_the_ends() {
    let dir = tempfile::tempdir().unwrap();
    let scene = thrown(dir.path(), "wide", [3.0, 5.0], "");
    let ends = measure(&scene, "21");
    let text = fs::read_to_string(&ends).unwrap().replace(",block", ",number");
    fs::write(&ends, text).unwrap();
    let vary = "vary = [{ ground = \"meadow\", key = \"rolling_friction\", from = 0.05, to = 3.0, before = 0.7 }]";
    let more = format!("[calibrate]\ndeposits = {ends:?}\nheld_out = 0.0\n{vary}");
    let scene = thrown(dir.path(), "wide", [3.0, 5.0], &more);
    let out = dir.path().join("fit");
    let done = rockfall(&["calibrate", word(&scene), "--releases", "80", "--out", word(&out)]);
    let said = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found = read_calibration(&out).unwrap().unwrap();
    let told = &found.told[0];
    let [low, high] = [told.low_95, told.high_95].map(Option::unwrap);
    assert!(low <= 0.45 && 0.45 <= high && high - low < 0.35, "{said}");
    let trials = fs::read_to_string(out.join("calibration.csv")).unwrap();
    let tried = trials.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse().unwrap());
    let inside = tried.filter(|value: &f64| low <= *value && *value <= high).count();
    assert!(inside >= 4, "{inside} values tried in the interval: {said}");
    let one_sided = ["offset of the centroid, by chance", "share past the farthest measured, by"];
    for what in one_sided {
        let row = found.measures.iter().find(|one| one.what.starts_with(what)).unwrap();
        assert!(row.low_95.is_none() && row.high_95.is_none(), "{row:?}");
    }
    assert!(!said.contains("-0.00"), "{said}");
}

/// Measured: twenty ends from where rocks stop soon and five from where they roll down a step. Beside the rocks from their
/// own places they lie where these lie; beside all rocks, which are released from both places evenly, much too near.
#[test]
fn ends_are_compared_from_their_own_places() {
    let dir = tempfile::tempdir().unwrap();
    let vary = "vary = [{ ground = \"meadow\", key = \"rolling_friction\", from = 0.4, to = 0.5, before = 0.45 }]";
    let calibrate =
        |ends: &str| format!("[calibrate]\ndeposits = {ends:?}\nheld_out = 0.25\n{vary}");
    let scene = thrown(dir.path(), "places", [3.0, 5.0], "");
    step(dir.path());
    let ends = fs::read_to_string(measure(&scene, "31")).unwrap();
    let (mut kept, mut moved, mut far) = (Vec::new(), Vec::new(), 0);
    for line in ends.lines() {
        let cells: Vec<&str> = line.split(',').collect();
        far += usize::from(cells[1].parse() == Ok(2.0));
        // half a metre beside the places nothing is in common
        let shifted = cells[0].parse().map_or(cells[0].to_owned(), |x: f64| (x - 0.5).to_string());
        if cells[1].parse() != Ok(2.0) || far <= 5 {
            kept.push(line.to_owned());
            moved.push([&[shifted.as_str()], &cells[1..]].concat().join(","));
        }
    }
    assert_eq!((kept.len(), far), (26, 20), "a head, twenty ends and five of twenty");
    fs::write(dir.path().join("kept.csv"), kept.join("\n")).unwrap();
    let fit = |ends: &str, name: &str| {
        let scene = thrown(dir.path(), name, [3.0, 5.0], &calibrate(ends));
        step(dir.path());
        let out = dir.path().join(name);
        let args = ["calibrate", word(&scene), "--releases", "80", "--out", word(&out)];
        let done = rockfall(&args);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        read_calibration(&out).unwrap().unwrap()
    };
    let own = fit("kept.csv", "own");
    assert_eq!(own.held_out.len(), 4, "a quarter held out, in turn");
    let rank = own.measures.iter().find(|one| one.what.starts_with("mean rank")).unwrap();
    let [low, high] = [rank.low_95, rank.high_95].map(Option::unwrap);
    assert!(low <= 0.0 && 0.0 <= high && (rank.measured - 0.5).abs() < 0.2, "{rank:?}");
    // the same ends beside the places: all releases stand against them
    fs::write(dir.path().join("moved.csv"), moved.join("\n")).unwrap();
    let heap = fit("moved.csv", "heap");
    assert!(heap.measures.iter().all(|one| !one.what.starts_with("mean rank")));
    // as many near as far: of the mean runout, half a fall too much
    let too_far_m =
        |found: &Calibration| found.before.all.computed_mean_m - found.before.all.measured_mean_m;
    let [own, heap] = [&own, &heap].map(too_far_m);
    assert!(own.abs() < 1.0 && heap > 2.0, "own places {own} m, all together {heap} m");
}

/// Measured: the ends of rocks that ran a metre or more. Those that stay are left out of what is computed, too, and that is said; a list with
/// a shorter way is refused.
#[test]
fn rocks_that_stay_where_they_are_set_down_are_not_compared() {
    let dir = tempfile::tempdir().unwrap();
    let scene = thrown(dir.path(), "throws", [0.5, 5.0], "");
    let ends = fs::read_to_string(measure(&scene, "17")).unwrap();
    let ran = |line: &&str| {
        let at: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (at[2] - at[0]).hypot(at[3] - at[1]) >= 1.0
    };
    let (head, all) = ends.split_once('\n').unwrap();
    let kept: Vec<&str> = all.lines().filter(ran).collect();
    assert!((8..32).contains(&kept.len()), "{}", kept.len());
    fs::write(dir.path().join("ran.csv"), format!("{head}\n{}\n", kept.join("\n"))).unwrap();
    let vary = "vary = [{ ground = \"meadow\", key = \"rolling_friction\", from = 0.4, to = 0.5, before = 0.45 }]";
    let with = |name: &str, least: &str| {
        let table = format!("[calibrate]\ndeposits = \"ran.csv\"\nheld_out = 0.0\n{least}\n{vary}");
        thrown(dir.path(), name, [0.5, 5.0], &table)
    };
    let fit = |name: &str, least: &str| {
        let (scene, out) = (with(name, least), dir.path().join(name));
        let done = rockfall(&["calibrate", word(&scene), "--releases", "80", "--out", word(&out)]);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        read_calibration(&out).unwrap().unwrap().before.all
    };
    let (throws, all) = (fit("least", "least_runout_m = 1.0"), fit("all", ""));
    assert_eq!((throws.computed + throws.stayed, all.computed, all.stayed), (320, 320, 0));
    assert!(throws.stayed > 10 && throws.ks < throws.ks_limit, "{throws:?}");
    assert!(all.computed_mean_m < all.measured_mean_m - 0.3 && all.ks > all.ks_limit, "{all:?}");
    // the run of the scene says the same, and its plan before it
    let (scene, out) = (with("run", "least_runout_m = 1.0"), dir.path().join("page"));
    let plan = rockfall(&["plan", word(&scene)]);
    let plan = String::from_utf8(plan.stdout).unwrap();
    assert!(plan.contains("without computed rocks whose runout is less than 1 m"), "{plan}");
    assert!(rockfall(&["run", word(&scene), "--quiet", "--out", word(&out)]).status.success());
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("computed rocks are not compared: their runout is less"), "{page}");
    let refused = rockfall(&["plan", word(&with("refused", "least_runout_m = 9.0"))]);
    let refused = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(refused.contains("ran.csv: line 2: found an end"), "{refused}");
    assert!(refused.contains("write a smaller least_runout_m"), "{refused}");
}

/// The level with its part y > 1 set 6 m lower but for a ledge: most rocks from the second place roll down and run further.
fn step(dir: &Path) {
    let p = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
    let quad = |a, b, c, d| [[a, b, c], [a, c, d]];
    let facets = [
        quad(p(-40.0, -40.0, 0.0), p(40.0, -40.0, 0.0), p(40.0, 1.0, 0.0), p(-40.0, 1.0, 0.0)),
        quad(p(-40.0, 1.0, 0.0), p(-29.0, 1.0, 0.0), p(-29.0, 40.0, 0.0), p(-40.0, 40.0, 0.0)),
        quad(p(-29.0, 1.0, 0.0), p(-20.0, 1.0, -6.0), p(-20.0, 40.0, -6.0), p(-29.0, 40.0, 0.0)),
        quad(p(-20.0, 1.0, -6.0), p(40.0, 1.0, -6.0), p(40.0, 40.0, -6.0), p(-20.0, 40.0, -6.0)),
    ];
    write_ascii(&dir.join("plate.stl"), "step", facets.as_flattened()).unwrap();
}

/// A value of the tangential answer is fitted, and stands in the fitted scene in the place of the shear spring.
#[test]
fn the_tangential_ratio_is_fitted() {
    let dir = tempfile::tempdir().unwrap();
    let scene = thrown(dir.path(), "ratio", [3.0, 5.0], "");
    let ends = measure(&scene, "7");
    let vary = "vary = [{ ground = \"meadow\", key = \"tangential_ratio\", from = 0.05, to = 1.0, before = 0.25 }]";
    let more = format!("[calibrate]\ndeposits = {ends:?}\nheld_out = 0.0\n{vary}");
    let scene = thrown(dir.path(), "ratio", [3.0, 5.0], &more);
    let out = dir.path().join("fit");
    let done = rockfall(&["calibrate", word(&scene), "--releases", "20", "--out", word(&out)]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found = read_calibration(&out).unwrap().unwrap();
    assert!(found.held_out.is_empty() && found.names == ["meadow.tangential_ratio"]);
    let fitted = out.join("ratio_fitted.toml");
    let text = fs::read_to_string(&fitted).unwrap();
    assert!(text.contains("\ntangential_ratio = ") && !text.contains("shear_stiffness"), "{text}");
    let ratio = Scene::read(&fitted).unwrap().grounds["meadow"].tangential_ratio.clone().unwrap();
    assert!((ratio.as_fixed().unwrap() - found.whole.values[0]).abs() < 1e-6);
}

/// A slope without what is varied is refused.
#[test]
fn scenes_that_do_not_fit_together_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let one = thrown(dir.path(), "one", [3.0, 5.0], "");
    let ends = measure(&one, "1");
    let vary = r#"vary = [{ ground = "meadow", key = "rolling_friction", from = 0.2, to = 0.8, before = 0.7 }]"#;
    let one =
        thrown(dir.path(), "one", [3.0, 5.0], &format!("[calibrate]\ndeposits = {ends:?}\n{vary}"));
    let other = thrown(dir.path(), "other", [3.0, 5.0], "");
    let said = rockfall(&["calibrate", word(&one), word(&other)]);
    let said = String::from_utf8(said.stderr).unwrap();
    assert!(said.contains("other.toml: [calibrate]: found nothing; write deposits"), "{said}");
}

/// Blocks one by one: place and size of the row, in turn; masses become radii.
#[test]
fn measured_blocks_are_replayed_one_by_one() {
    let dir = tempfile::tempdir().unwrap();
    let scene = thrown(dir.path(), "table", [3.0, 5.0], "");
    let text = fs::read_to_string(&scene).unwrap();
    let text = text.replace("points_m = [[-30.0, 0.0], [-30.0, 2.0]]", "table = \"blocks.csv\"");
    fs::write(&scene, text).unwrap();
    let table = dir.path().join("blocks.csv");
    // 2700 4/3 π 0.2³ = 90.478 kg
    fs::write(
        &table,
        "block,x_m,y_m,mass_kg\na,-30,1,90.47786842338604\nb,-20,2.5,11.309733552923255\n",
    )
    .unwrap();
    let out = dir.path().join("out");
    let done = rockfall(&["run", word(&scene), "--quiet", "--releases", "4", "--out", word(&out)]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let rows = fs::read_to_string(out.join("releases.csv")).unwrap();
    let wanted = [(0.2, -30.0, 1.0), (0.1, -20.0, 2.5)];
    for (row, (radius, x, y)) in rows.lines().skip(1).zip(wanted.into_iter().cycle()) {
        let number = |at: usize| row.split(',').nth(at).unwrap().parse::<f64>().unwrap();
        assert!((number(3) - radius).abs() < 1e-12, "{row}");
        assert!((number(5) - x).abs() < 1e-9 && (number(6) - y).abs() < 1e-9, "{row}");
    }
    let hash = |text: &str| {
        fs::write(&table, text).unwrap();
        Scene::read(&scene).map(|scene| scene.hash)
    };
    let first = hash("x_m,y_m,radius_m\n-30,1,0.2\n").unwrap();
    assert_ne!(first, hash("x_m,y_m,radius_m\n-30,1,0.3\n").unwrap());
    for (text, says) in [
        ("x_m,radius_m\n1,1\n", "line 1: found the columns x_m, radius_m"),
        ("x_m,y_m,radius_m\n", "rows: found no block"),
        ("x_m,y_m,radius_m\n1,north,1\n", "line 2: found `north`"),
        ("x_m,y_m,mass_kg\n\n1,1,-5\n", "line 3: found -5"),
        (
            "x_m,y_m,radius_m\n1,1,1e-9\n",
            "radius_m or mass_kg: found blocks with a radius of 1e-9 to 1e-9 m; write a value in",
        ),
    ] {
        let said = hash(text).unwrap_err().to_string();
        assert!(said.contains("blocks.csv") && said.contains(says), "{said}");
    }
}

/// A block that rolls badly on one ground rolls badly on the other: the same quantile on both.
#[test]
fn a_block_keeps_its_character_on_all_grounds() {
    let dir = tempfile::tempdir().unwrap();
    let more = "[grounds.scree]\nnormal_stiffness_n_m = 1e7\nshear_stiffness_n_m = 2.5e6\nfriction_angle_deg = 35.0\nrestitution = 0.3\nrolling_friction = { uniform = [0.2, 0.6] }";
    let scene = thrown(dir.path(), "two", [3.0, 5.0], more);
    let text = fs::read_to_string(&scene).unwrap();
    fs::write(
        &scene,
        text.replace("rolling_friction = 0.45", "rolling_friction = { uniform = [0.1, 0.3] }"),
    )
    .unwrap();
    let scene = Scene::read(&scene).unwrap();
    let (terrain, _) = scene.read_terrain().unwrap();
    let releases = Releases::compile(&scene, &terrain).unwrap();
    let mut seen = Vec::new();
    for index in 0..50 {
        let grounds = releases.release(&terrain, index).unwrap().grounds;
        let [meadow, scree] = [0, 1].map(|at| grounds[at].rolling_friction);
        assert!((scree - 2.0 * meadow).abs() < 1e-12, "{meadow} {scree}");
        seen.push(meadow);
    }
    let (least, most) = seen.iter().fold((1.0_f64, 0.0_f64), |(a, b), x| (a.min(*x), b.max(*x)));
    assert!(most - least > 0.15, "they are drawn rock by rock");
}

/// Listed values print their true quantiles, however they are written.
#[test]
fn unsorted_lists_have_true_quantiles() {
    let text = fs::read_to_string("tests/bad/tolerance_zero.toml").unwrap();
    let text = text
        .replace("tolerance_m_s = 0.0", "")
        .replace("radius_m = 0.15", "radius_m = { values = [0.3, 0.1, 0.2], weights = [1, 1, 2] }");
    let scene = Scene::parse(&text, Path::new("scene.toml")).unwrap();
    let found = [0.1, 0.3, 0.6, 0.9].map(|p| scene.rocks.radius_m().quantile(p).to_string());
    assert_eq!(found, ["0.1", "0.2", "0.2", "0.3"]);
}

/// Which throws are of one block is read where the file tells it.
#[test]
fn blocks_of_measured_ends_are_read() {
    let blocks =
        ObservedPath::read_blocks(Path::new("terrain/tschamut/observed_deposition.csv")).unwrap();
    assert_eq!(blocks.len(), 80);
    assert_eq!(blocks.iter().filter(|block| *block == "1").count(), 29);
}
