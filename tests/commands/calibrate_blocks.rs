//! Blocks of a release table have their own shapes, and their ground is fitted as that of spheres is.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program::{message, rockfall};
use rockfall::body::ShapeKind;
use rockfall::output::read_calibration;
use rockfall::release::Releases;
use rockfall::rock::Vec3;
use rockfall::scene::Scene;
use rockfall::terrain::stl::write_ascii;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

const SHAPES: &str = r#"
[[rocks.shapes]]
block = "cube"
kind = "box"
axes = [1.0, 1.0, 1.0]
corner_radius = 0.2
[[rocks.shapes]]
block = "slab"
kind = "box"
axes = [1.0, 1.0, 0.3]
corner_radius = 0.2
"#;

fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// Blocks thrown along a level of soil, each from its own place.
fn scene(dir: &Path, name: &str, shapes: &str, calibrate: &str) -> PathBuf {
    let p = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let corners = [p(-40.0, -40.0), p(40.0, -40.0), p(40.0, 40.0), p(-40.0, 40.0)];
    let facets = [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]];
    write_ascii(&dir.join("plate.stl"), "plate", &facets).unwrap();
    let mut table = "block,x_m,y_m,radius_m\n".to_owned();
    for row in 0..12 {
        let block = ["cube", "slab"][row % 2];
        writeln!(table, "{block},-30,{row},0.2").unwrap();
    }
    fs::write(dir.join("blocks.csv"), table).unwrap();
    let text = format!(
        r#"title = "{name}"
seed = 4
[[terrain]]
mesh = "plate.stl"
ground = "meadow"
[grounds.meadow]
normal_stiffness_n_m = 1e7
shear_stiffness_n_m = 2.5e6
friction_angle_deg = 30.0
restitution = 0.3
slip_friction = {{ max = 1.0, kappa_per_m = 1.0, beta_per_s = 20.0 }}
scar = {{ strength_kn_m2 = 15000.0, drag = 2.5, soil_density_kg_m3 = 1700.0 }}  # of a meadow
[rocks]
density_kg_m3 = 2700.0
radius_m = 0.2
{shapes}
[release]
count = 24
height_m = 0.0
velocity_m_s = [{{ uniform = [6.0, 8.0] }}, 0.0, 0.0]
spin_rad_s = [0.0, 0.0, 0.0]
table = "blocks.csv"
[solver]
scheme = "rigid"
{calibrate}
"#
    );
    let file = dir.join(format!("{name}.toml"));
    fs::write(&file, text).unwrap();
    file
}

/// How many ends are measured: of a dozen of a kind the mean is a matter of luck.
const MEASURED: &str = "96";

/// Runs a scene and writes its ends as if they were measured.
fn measure(scene: &Path) {
    let out = scene.with_extension("out");
    let done = rockfall(&[
        "run",
        word(scene),
        "--quiet",
        "--seed",
        "9",
        "--releases",
        MEASURED,
        "--out",
        word(&out),
    ]);
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let mut text = "release_x_m,release_y_m,x_m,y_m,block\n".to_owned();
    let rows = fs::read_to_string(out.join("releases.csv")).unwrap();
    for (row, line) in rows.lines().skip(1).enumerate() {
        let cells: Vec<&str> = line.split(',').collect();
        let [from_x, from_y, x, y] = [5, 6, 8, 9].map(|at| cells[at]);
        writeln!(text, "{from_x},{from_y},{x},{y},{}", ["cube", "slab"][row % 2]).unwrap();
    }
    fs::write(scene.with_extension("csv"), text).unwrap();
}

/// Puts other words into a file.
fn edit(file: &Path, [from, to]: [&str; 2]) {
    let text = fs::read_to_string(file).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(file, text.replace(from, to)).unwrap();
}

fn vary(keys: &[(&str, [f64; 3])]) -> String {
    let entry = |(key, [from, to, before]): &(&str, [f64; 3])| {
        format!(
            "{{ ground = \"meadow\", key = \"{key}\", from = {from:?}, to = {to:?}, before = {before:?} }},"
        )
    };
    let entries: String = keys.iter().map(entry).collect();
    format!("[calibrate]\ndeposits = \"true.csv\"\nheld_out = 0.0\nvary = [{entries}]")
}

/// Each row of the table has the shape of its block.
#[test]
fn blocks_have_their_own_shapes() {
    let dir = tempfile::tempdir().unwrap();
    let file = scene(dir.path(), "true", SHAPES, "");
    let read = Scene::read(&file).unwrap();
    let (terrain, _) = read.read_terrain().unwrap();
    let releases = Releases::compile(&read, &terrain).unwrap();
    for index in 0..24 {
        let rock = releases.release(&terrain, index).unwrap().rock;
        let drawn = releases.block(index, &rock).unwrap();
        assert_eq!(drawn.kind, ShapeKind::Box);
        assert!(
            (drawn.sides[1] - [1.0, 0.3][index % 2]).abs() < 1e-12,
            "{index} {:?}",
            drawn.sides
        );
    }
    // what is left to all: a sphere for the slab
    let others = SHAPES.replace(
        "block = \"slab\"\nkind = \"box\"\naxes = [1.0, 1.0, 0.3]\ncorner_radius = 0.2",
        "kind = \"sphere\"",
    );
    let file = scene(dir.path(), "others", &others, "");
    let read = Scene::read(&file).unwrap();
    let releases = Releases::compile(&read, &terrain).unwrap();
    for index in 0..24 {
        let rock = releases.release(&terrain, index).unwrap().rock;
        assert_eq!(releases.block(index, &rock).is_some(), index % 2 == 0);
    }
    for (from, to, says) in [
        ("block = \"slab\"", "block = \"slob\"", "found no block \"slob\" in the release table"),
        ("block = \"slab\"", "block = \"cube\"", "found no shape of the block \"slab\""),
    ] {
        let file = scene(dir.path(), "wrong", &SHAPES.replace(from, to), "");
        let said = message(Scene::read(&file));
        assert!(said.contains("[[rocks.shapes]]") && said.contains(says), "{said}");
    }
}

/// Two values of the soil are found again, the fitted scene has them inside of their tables, and the result says the shapes
/// and how the blocks differ.
#[test]
fn a_ground_is_fitted_to_blocks() {
    let dir = tempfile::tempdir().unwrap();
    measure(&scene(dir.path(), "true", SHAPES, ""));
    let asked = vary(&[("scar.drag", [0.0, 10.0, 0.0]), ("slip_friction.max", [0.6, 1.4, 1.4])]);
    let fit = scene(dir.path(), "fit", SHAPES, &asked);
    // the scene to be fitted does not know what is true
    edit(&fit, ["drag = 2.5", "drag = 7.5"]);
    let out = dir.path().join("out");
    let done = rockfall(&["calibrate", word(&fit), "--releases", "24", "--out", word(&out)]);
    let said = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    let found = read_calibration(&out).unwrap().unwrap();
    assert_eq!(found.names, ["meadow.scar.drag", "meadow.slip_friction.max"]);
    assert!(found.whole.all.ks < found.before.all.ks && found.whole.all.ks < 0.35, "{said}");
    assert_eq!(found.shapes.len(), 2);
    assert!(said.contains("shape: box (block slab), weight 1"), "{said}");
    let apart = "mean runout of block slab less that of block cube (m)";
    let apart = found.measures.iter().find(|one| one.what == apart).unwrap();
    // the ground is one, and fitted: the shapes make the difference; the interval is that of the measured ends alone
    let [low, high] = [apart.low_95, apart.high_95].map(Option::unwrap);
    assert!(low <= 1.0 && -1.0 <= high, "{apart:?}");
    assert!(apart.measured.abs() > 0.1, "the shapes differ: {apart:?}");
    let text = fs::read_to_string(out.join("fit_fitted.toml")).unwrap();
    assert!(text.contains("# of a meadow") && !text.contains("drag = 7.5"), "{text}");
    let fitted = Scene::read(&out.join("fit_fitted.toml")).unwrap();
    let (scar, slip) =
        (fitted.grounds["meadow"].scar.unwrap(), fitted.grounds["meadow"].slip_friction.unwrap());
    assert!((scar.drag - found.whole.values[0]).abs() < 1e-6);
    assert!((slip.most - found.whole.values[1]).abs() < 1e-6);
    assert_eq!((scar.strength_kn_m2, slip.kappa_per_m), (15e3, 1.0));
    assert!(rockfall(&["plan", word(&out.join("fit_fitted.toml"))]).status.success());
}

/// Corners of all shapes are fitted together, by ends in plan view: the fit is the nearest of all trials, nearer than the corners
/// before, and stands in every shape of the fitted scene.
#[test]
fn corners_are_fitted_to_ends_in_plan_view() {
    let dir = tempfile::tempdir().unwrap();
    // four times as many ends as elsewhere: a corner shows less than a soil
    let many = ["count = 24", "count = 96"];
    let truth = scene(dir.path(), "true", SHAPES, "");
    edit(&truth, many);
    measure(&truth);
    let corners = "score = \"ends\"\nvary = [{ key = \"corner_radius\", from = 0.1, to = 0.3, before = 0.3 },";
    let asked = vary(&[("scar.drag", [0.0, 10.0, 0.0])]).replace("vary = [", corners);
    let fit = scene(dir.path(), "fit", SHAPES, &asked);
    edit(&fit, many);
    let out = dir.path().join("out");
    let done = rockfall(&["calibrate", word(&fit), "--releases", "96", "--out", word(&out)]);
    let said = String::from_utf8(done.stdout).unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(said.contains(", energy distance "), "{said}");
    let found = read_calibration(&out).unwrap().unwrap();
    assert_eq!(found.names, ["rocks.shapes.corner_radius", "meadow.scar.drag"]);
    let trials = fs::read_to_string(out.join("calibration.csv")).unwrap();
    assert!(trials.lines().next().unwrap().contains(",fit_ends_m,apart_ends_m,"), "{trials}");
    let ends_m = |line: &str| -> f64 { line.rsplit(',').nth(3).unwrap().parse().unwrap() };
    // the nearest of the finalists; what is said of it is said by other rocks
    let finalists = trials.lines().filter(|line| line.contains(",selection,"));
    let nearest = finalists.min_by(|one, other| ends_m(one).total_cmp(&ends_m(other))).unwrap();
    let [fitted_m, before_m] =
        [&found.whole, &found.before].map(|trial| trial.fitted.ends_m.unwrap());
    let values: Vec<String> = found.whole.values.iter().map(f64::to_string).collect();
    assert!(nearest.starts_with(&format!("none,{},", values.join(","))), "{nearest}: {said}");
    // the ends beside those of other random numbers: a third of the distance before
    assert!(fitted_m < 0.5 * before_m, "{said}");
    let corner_radius = (found.whole.values[0] * 1e6).round() / 1e6;
    let text = fs::read_to_string(out.join("fit_fitted.toml")).unwrap();
    let written = format!("corner_radius = {corner_radius:?}\n");
    assert_eq!(text.matches(&written).count(), 2, "{written}{text}");
    let scene = Scene::read(&out.join("fit_fitted.toml")).unwrap();
    assert_eq!(scene.rocks.shapes[1].corner_radius, Some(corner_radius));
}

/// What blocks or this ground do not have cannot be varied.
#[test]
fn values_that_play_no_part_are_not_varied() {
    let dir = tempfile::tempdir().unwrap();
    let drag = vary(&[("scar.drag", [0.1, 0.5, 0.3])]);
    let file = scene(dir.path(), "hard", SHAPES, &drag);
    let text = fs::read_to_string(&file).unwrap();
    let hard: String =
        text.lines().filter(|line| !line.starts_with("scar")).flat_map(|l| [l, "\n"]).collect();
    fs::write(&file, hard).unwrap();
    let said = message(Scene::read(&file));
    assert!(said.contains("write scar = { ... } in [grounds.meadow]"), "{said}");
    // corners are a value of the shapes, and of no ground
    let of_ground = vary(&[("corner_radius", [0.1, 0.4, 0.3])]);
    let said = message(Scene::read(&scene(dir.path(), "corners", SHAPES, &of_ground)));
    assert!(said.contains("remove it: corner_radius is a value of [[rocks.shapes]]"), "{said}");
    let of_shapes = of_ground.replace("ground = \"meadow\", ", "");
    let said = message(Scene::read(&scene(dir.path(), "round", "", &of_shapes)));
    assert!(said.contains("spheres have no corners"), "{said}");
    let lost = drag.replace("ground = \"meadow\", ", "");
    let said = message(Scene::read(&scene(dir.path(), "lost", SHAPES, &lost)));
    assert!(said.contains("a name from [grounds] whose scar.drag is varied"), "{said}");
    // blocks before spheres: the first says what is varied
    measure(&scene(dir.path(), "true", SHAPES, ""));
    // beside a shape rolling friction is what soft ground takes
    let rolling = vary(&[("rolling_friction", [0.0, 0.5, 0.1])]);
    Scene::read(&scene(dir.path(), "rolls", SHAPES, &rolling)).unwrap();
    let first = scene(dir.path(), "blocks", SHAPES, &of_shapes);
    let second = scene(dir.path(), "spheres", "", "[calibrate]\ndeposits = \"true.csv\"");
    let said = rockfall(&["calibrate", word(&first), word(&second)]);
    let said = String::from_utf8(said.stderr).unwrap();
    assert!(said.contains("spheres.toml") && said.contains("spheres have no corners"), "{said}");
    // the end of the range is wrong, not the shape that the scene has
    let said = rockfall(&["calibrate", word(&first)]);
    let said = String::from_utf8(said.stderr).unwrap();
    assert!(
        said.contains("blocks.toml: [calibrate] vary #1 to: found 0.4, a corner_radius"),
        "{said}"
    );
    // names of blocks stand in a table
    let text = fs::read_to_string(scene(dir.path(), "points", SHAPES, "")).unwrap();
    let text = text.replace("table = \"blocks.csv\"", "points_m = [[0.0, 0.0]]");
    let said = message(Scene::parse(&text, Path::new("points.toml")));
    assert!(said.contains("block") && said.contains("write [release] table"), "{said}");
}
