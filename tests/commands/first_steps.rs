//! The first steps with the program: a scene for a terrain, what a run says last, help, completions, manual.
#![allow(clippy::unwrap_used, reason = "a test that cannot run the program has failed")]

use crate::program;
use program::rockfall;
use std::fs;
use std::path::Path;

fn said(args: &[&str]) -> (Option<i32>, String, String) {
    let output = rockfall(args);
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code(), text(&output.stdout), text(&output.stderr))
}

fn word(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// The ground of a sketched scene, filled in as its comments propose.
fn filled_in(scene: &str) -> String {
    scene
        .lines()
        .map(|line| {
            let keys = ["normal_st", "shear_st", "friction_a", "restitution =", "rolling_f"];
            let is_ground = keys.iter().any(|key| line.starts_with(&format!("# {key}")));
            if is_ground { line[2..].to_owned() } else { line.to_owned() }
        })
        .collect::<Vec<_>>()
        .join("\n")
}

/// A sketched scene asks for its ground, and runs when that is filled in: from a mesh and from an elevation model.
#[test]
fn a_sketched_scene_asks_for_its_ground_and_then_runs() {
    let dir = tempfile::tempdir().unwrap();
    for terrain in ["terrain/quick_slope.stl", "terrain/tyrol_dem.tif"] {
        let file = dir.path().join("first.toml");
        let (code, _, stderr) = said(&["init", terrain, word(&file), "--overwrite"]);
        assert_eq!(code, Some(0), "{stderr}");
        let (code, _, stderr) = said(&["init", terrain, word(&file)]);
        assert!(code == Some(2) && stderr.contains("--overwrite"), "{stderr}");
        let (code, _, stderr) = said(&["plan", word(&file)]);
        assert_eq!(code, Some(2), "{stderr}");
        assert!(stderr.contains("[grounds.slope]") && stderr.contains("first.toml"), "{stderr}");
        let scene = fs::read_to_string(&file).unwrap();
        assert!(scene.contains("line_m = [["), "{scene}");
        fs::write(&file, filled_in(&scene)).unwrap();
        let out = dir.path().join("out");
        let (code, stdout, stderr) =
            said(&["run", word(&file), "--releases", "30", "--overwrite", "--out", word(&out)]);
        assert_eq!(code, Some(0), "{stderr}");
        assert!(stdout.lines().last().unwrap().contains("report.html"), "{stdout}");
    }
}

/// The terrain is named as seen from the scene, also in another folder: both can be moved together. A mesh says nothing of a map, and
/// what to write of it stands there.
#[test]
fn a_sketched_scene_finds_its_terrain_from_another_folder() {
    let dir = tempfile::tempdir().unwrap();
    let (meshes, scenes) = (dir.path().join("daten/gelände"), dir.path().join("scenes"));
    fs::create_dir_all(&meshes).unwrap();
    fs::create_dir(&scenes).unwrap();
    let (mesh, file) = (meshes.join("slope.stl"), scenes.join("first.toml"));
    fs::copy("terrain/quick_slope.stl", &mesh).unwrap();
    let (code, _, stderr) = said(&["init", word(&mesh), word(&file)]);
    assert_eq!(code, Some(0), "{stderr}");
    let scene = fs::read_to_string(&file).unwrap();
    assert!(scene.contains("mesh = \"../daten/gelände/slope.stl\""), "{scene}");
    assert!(scene.contains("# origin_m = [") && scene.contains("# epsg = "), "{scene}");
    fs::write(&file, filled_in(&scene)).unwrap();
    let (code, _, stderr) = said(&["plan", word(&file)]);
    assert_eq!(code, Some(0), "{stderr}");
}

/// The examples at the end of a sketched scene lie on its terrain, in map coordinates: without their # they are a line, a
/// barrier and maps.
#[test]
fn examples_of_a_sketched_scene_lie_on_its_terrain() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("first.toml");
    let (code, _, stderr) = said(&["init", "terrain/tyrol_dem.tif", word(&file)]);
    assert_eq!(code, Some(0), "{stderr}");
    let scene = filled_in(&fs::read_to_string(&file).unwrap());
    let (before, examples) = scene.split_once("path_step_s").unwrap();
    let is_key = |line: &str| line.starts_with("# [") || line.contains(" = ");
    let written = |line: &str| line.strip_prefix("# ").filter(|_| is_key(line)).map(str::to_owned);
    let examples: Vec<String> =
        examples.lines().map(|line| written(line).unwrap_or_else(|| line.to_owned())).collect();
    fs::write(&file, format!("{before}path_step_s{}", examples.join("\n"))).unwrap();
    let (code, plan, stderr) = said(&["plan", word(&file)]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(plan.contains("road (") && plan.contains("net (4 m") && plan.contains("cells of 2 m"));
}

#[test]
fn level_ground_cannot_be_sketched() {
    let dir = tempfile::tempdir().unwrap();
    let grid = dir.path().join("level.asc");
    fs::write(
        &grid,
        "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 5\n1 1 1\n1 1 1\n1 1 1\n",
    )
    .unwrap();
    let file = dir.path().join("level.toml");
    let (code, _, stderr) = said(&["init", word(&grid), word(&file)]);
    assert!(code == Some(2) && stderr.contains("level ground"), "{stderr}");
    assert!(!file.exists());
}

/// An elevation model of cells of a size, rows from the north.
fn grid(cell_m: f64, rows: &[Vec<f64>]) -> String {
    let heights = |row: &Vec<f64>| row.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    let rows_said: Vec<String> = rows.iter().map(heights).collect();
    let (columns, count) = (rows[0].len(), rows.len());
    format!(
        "ncols {columns}\nnrows {count}\nxllcorner 0\nyllcorner 0\ncellsize {cell_m}\n{}\n",
        rows_said.join("\n")
    )
}

/// A strip of two columns that falls along itself or across, a wall of 83° below a plateau and a slope of 85° all over: the
/// sketched scene places its rocks where there is room, and all of them fall.
#[test]
fn strips_and_walls_are_sketched_too() {
    let dir = tempfile::tempdir().unwrap();
    let strip: Vec<Vec<f64>> = (0..40).map(|k| vec![100.0 - 3.0 * f64::from(k); 2]).collect();
    let wall_m = |k: i32| match k {
        ..20 => 100.0,
        20..32 => 100.0 - 8.5 * f64::from(k - 20),
        _ => -0.3 * f64::from(k - 32),
    };
    let wall: Vec<Vec<f64>> = (0..60).map(|k| vec![wall_m(k); 40]).collect();
    let steep: Vec<Vec<f64>> = (0..30).map(|k| vec![400.0 - 11.5 * f64::from(k); 30]).collect();
    let across = vec![vec![100.0, 60.0]; 40];
    let cases =
        [(5.0, strip, "line_m"), (5.0, across.clone(), "points_m"), (1.0, wall, "points_m")];
    for (cell_m, rows, place) in cases.into_iter().chain([(1.0, steep, "points_m")]) {
        let (model, file) = (dir.path().join("made.asc"), dir.path().join("made.toml"));
        fs::write(&model, grid(cell_m, &rows)).unwrap();
        let (code, _, stderr) = said(&["init", word(&model), word(&file), "--overwrite"]);
        assert_eq!(code, Some(0), "{place}: {stderr}");
        let scene = filled_in(&fs::read_to_string(&file).unwrap());
        assert!(scene.contains(&format!("\n{place} = [[")), "{scene}");
        // cells of 5 m that fall to the east from column to column: rocks come over a line from south to north
        if rows == across {
            assert!(scene.contains("# points_m = [[5.0, 51.2], [5.0, 148.8]]"), "{scene}");
        }
        fs::write(&file, scene).unwrap();
        let (code, plan, stderr) = said(&["plan", word(&file)]);
        assert_eq!(code, Some(0), "{stderr}");
        assert!(!plan.contains("find no place to start from"), "{plan}");
    }
}

/// A rock without a gap below it on a slope of 60° is lifted by its own radius before it is clear of it: the plan says of
/// how many, and by how much; on gentle ground it says nothing.
#[test]
fn the_plan_says_how_many_releases_are_lifted() {
    let dir = tempfile::tempdir().unwrap();
    let (model, file) = (dir.path().join("made.asc"), dir.path().join("made.toml"));
    for (fall_m, lifted) in [(3.0_f64.sqrt(), true), (0.2, false)] {
        let rows: Vec<Vec<f64>> = (0..40).map(|k| vec![99.0 - fall_m * f64::from(k); 40]).collect();
        fs::write(&model, grid(1.0, &rows)).unwrap();
        said(&["init", word(&model), word(&file), "--overwrite"]);
        let scene = filled_in(&fs::read_to_string(&file).unwrap());
        let sizes = scene.lines().find(|line| line.starts_with("radius_m")).unwrap();
        let scene =
            scene.replace(sizes, "radius_m = 0.5").replace("height_m = 0.5 ", "height_m = 0.0 ");
        fs::write(&file, scene).unwrap();
        let (code, plan, stderr) = said(&["plan", word(&file)]);
        assert_eq!(code, Some(0), "{stderr}");
        let line = plan.lines().find(|line| line.starts_with("lifted"));
        assert_eq!(line.is_some(), lifted, "{plan}");
        let expected = "1000 of 1000 releases tried out, over steep ground, by more than a tenth of their radius and up to 0.50 m";
        assert!(line.is_none_or(|line| line.contains(expected)), "{line:?}");
    }
}

/// The last lines of a run: an answer a line and a barrier, the time, the folder and the report; no colour for a file.
#[test]
fn a_run_ends_with_its_answers_and_its_report() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let scene = fs::read_to_string("examples/quick.toml").unwrap();
    let net = "[[barriers]]\nname = \"net\"\npoints_m = [[0.0, 40.0], [40.0, 40.0]]\nheight_m = 3.0\ncapacity_j = 5e4\n";
    let far = "[[lines]]\nname = \"far\"\npoints_m = [[0.0, 59.9], [0.1, 59.9]]\n";
    let file = dir.path().join("scene.toml");
    let home = format!("{}/terrain", env!("CARGO_MANIFEST_DIR"));
    fs::write(&file, format!("{}\n{far}\n{net}", scene.replace("../terrain", &home))).unwrap();
    let (code, stdout, stderr) =
        said(&["run", word(&file), "--releases", "200", "--out", word(&out)]);
    assert_eq!(code, Some(0), "{stderr}");
    let last: Vec<&str> = stdout.lines().rev().take(7).collect();
    assert_eq!(last[0], format!("report: {}", out.join("report.html").display()));
    assert_eq!(last[1], format!("results in {}", out.display()));
    assert!(last[2].starts_with("200 releases in ") && last[2].ends_with(" a second)"), "{stdout}");
    assert!(last[3].starts_with("barrier \"net\": ") && last[3].contains("it stops"), "{stdout}");
    // rocks that have left the terrain may still come to it
    let far = "line \"far\": no rock crosses it, some may still come (0";
    assert!(last[4].starts_with(far), "{stdout}");
    assert!(last[5].starts_with("line \"meadow\": "), "{stdout}");
    assert!(
        last[6].starts_with("line \"foot of the face\": ") && last[6].contains("P95 of energy")
    );
    assert!(!stdout.contains('\u{1b}'), "colour where no terminal reads: {stdout}");
    // drawn again, it says where the page is, as a run does
    let (code, stdout, stderr) = said(&["draw", word(&out)]);
    assert_eq!(code, Some(0), "{stderr}");
    assert_eq!(stdout, format!("report: {}\n", out.join("report.html").display()));
    // the share that is said is the one of the summary
    let summary: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let share = summary["lines"][0]["reach"]["share"].as_f64().unwrap();
    assert!(last[6].contains(&format!("{:.0}", 100.0 * share)), "{share} in {}", last[6]);
}

#[test]
fn help_says_what_there_is() {
    let (code, help, _) = said(&["--help"]);
    assert_eq!(code, Some(0));
    for command in ["init", "run", "plan", "study", "completions", "man"] {
        assert!(help.contains(&format!("\n  {command} ")), "{command}: {help}");
    }
    let (_, studies, _) = said(&["study", "--help"]);
    assert!(!studies.contains("speed") && !studies.contains("scaling"), "{studies}");
    let (_, make, _) = said(&["mesh", "make", "--help"]);
    assert!(make.contains("quick_slope") && make.contains("paper_containers"), "{make}");
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("made.stl");
    let (code, _, stderr) = said(&["mesh", "make", "quick_slop", word(&out)]);
    assert!(code == Some(2) && stderr.contains("quick_slope"), "{stderr}");
    let (code, ..) = said(&["mesh", "make", "quick_slope", word(&out)]);
    assert_eq!(code, Some(0));
    assert_eq!(fs::read(&out).unwrap(), fs::read("terrain/quick_slope.stl").unwrap());
}

#[test]
fn shells_and_readers_of_manuals_get_theirs() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let (code, script, _) = said(&["completions", shell]);
        assert_eq!(code, Some(0));
        assert!(script.contains("rockfall") && script.contains("from-grid"), "{shell}: {script}");
    }
    let (code, page, _) = said(&["man"]);
    assert!(code == Some(0) && page.contains(".TH rockfall 1"), "{page}");
    let (code, page, _) = said(&["man", "mesh", "check"]);
    assert!(code == Some(0) && page.contains("STL files"), "{page}");
    let (code, _, stderr) = said(&["man", "runn"]);
    assert!(code == Some(2) && stderr.contains("write one of"), "{stderr}");
}
