//! Nothing runs without end, takes without measure, or leaves anything behind when it is refused.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a test that cannot run the program has failed"
)]
#![cfg(target_os = "linux")]

use crate::{asked, drawn, program};

use asked::{
    Asked, IN_THE_BOX, USUAL, closed_box, p, plate, quad, scene, stops, stops_and_words, word,
};
use program::rockfall;
use rockfall::terrain::stl::{Facet, write_ascii};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

/// A refusal takes at most so long …
const PROMPT: Duration = Duration::from_secs(2);
/// … and so much memory (kB).
const FRUGAL_KB: u64 = 300_000;

/// Rocks that never lose anything: between walls, and between two plates that leave them the width of an atom.
#[test]
fn rocks_that_never_rest_end_by_time_or_budget() {
    let dir = tempfile::tempdir().unwrap();
    let begun = Instant::now();
    for scheme in ["\"adaptive\"", "\"rigid\"", "\"reference\"", "\"dda\"\nstep_s = 1e-4"] {
        let more = format!("[solver]\nlongest_s = 20.0\nscheme = {scheme}");
        let asked = Asked { more: &more, ..IN_THE_BOX };
        let ends = stops(&scene(dir.path(), &closed_box(), &asked), &[]);
        assert!(["time_up", "over_budget"].contains(&ends[0].as_str()), "{scheme}: {ends:?}");
    }
    let (radius, gap) = (0.2, 1e-9);
    let plates = [plate(5.0, 0.0), plate(5.0, 2.0 * radius + gap)].concat();
    let asked = Asked {
        restitution: 1.0,
        place: "count = 1\npoints_m = [[0.0, 0.0, 0.2000000005]]",
        velocity: [0.0, 0.0, 3.0],
        more: "[solver]\nscheme = \"rigid\"",
    };
    let scene = scene(dir.path(), &plates, &asked);
    let (ends, said) = stops_and_words(&scene, &[]);
    assert_eq!(ends, ["over_budget"]);
    let summary = fs::read_to_string(dir.path().join("out/summary.json")).unwrap();
    assert!(
        summary.contains("\"over_budget\": 1") && summary.contains("over budget after 5000000")
    );
    assert!(said.contains("warning: 1 of 1 rocks were still moving when their budget"), "{said}");
    // minutes, before there was a budget
    assert!(begun.elapsed() < Duration::from_secs(120), "{:?}", begun.elapsed());
}

/// A run of rocks that never rest hears the wish to end.
#[test]
fn rocks_that_never_rest_end_when_they_are_told_to() {
    let dir = tempfile::tempdir().unwrap();
    let asked = Asked {
        place: "count = 4000\npoints_m = [[1.0, 1.0, 1.0]]",
        // all of them take minutes, those that are begun when the wish comes less than a second
        more: "[solver]\nlongest_s = 200.0",
        ..IN_THE_BOX
    };
    let scene = scene(dir.path(), &closed_box(), &asked);
    let out = dir.path().join("out");
    let mut run = program::command(&["run", word(&scene), "--quiet", "--out", word(&out)]);
    let run = run.stderr(std::process::Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !out.join("progress.json").exists() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    // in the midst of the first rocks
    std::thread::sleep(Duration::from_millis(100));
    let told = Command::new("kill").args(["-TERM", &run.id().to_string()]).status().unwrap();
    assert!(told.success());
    let begun = Instant::now();
    let ended = run.wait_with_output().unwrap();
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    assert!(said.contains("go on with: rockfall run"), "{said}");
    assert!(begun.elapsed() < Duration::from_secs(60), "{:?}", begun.elapsed());
}

/// A plate of 10 x 10 cells of 1 m around the origin without some of them.
fn without(holes: &[(i32, i32)]) -> Vec<Facet> {
    let cells = (-5..5).flat_map(|i| (-5..5).map(move |j| (i, j)));
    let square = |(i, j): (i32, i32)| {
        let (x, y) = (f64::from(i), f64::from(j));
        quad([p(x, y, 0.0), p(x + 1.0, y, 0.0), p(x + 1.0, y + 1.0, 0.0), p(x, y + 1.0, 0.0)])
    };
    cells.filter(|cell| !holes.contains(cell)).flat_map(square).collect()
}

/// A hole in the release area: places in it are drawn again, the plan says what share of the area that is, and the
/// releases are uniform over what is left.
#[test]
fn a_hole_in_the_release_area_is_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let place = "count = 400\nheight_m = 0.5\npolygon_m = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]";
    let asked = Asked { place, more: "[record]\npaths = 0", ..USUAL };
    let scene = scene(dir.path(), &without(&[(0, 0), (1, 0)]), &asked);
    let ends = stops(&scene, &[]);
    assert_eq!(ends.len(), 400);
    assert!(ends.iter().all(|stop| stop != "not_released"), "{ends:?}");
    let rows = fs::read_to_string(dir.path().join("out/releases.csv")).unwrap();
    let inside = rows.lines().skip(1).filter(|row| {
        let at: Vec<f64> = row.split(',').skip(5).take(2).map(|x| x.parse().unwrap()).collect();
        (0.0..2.0).contains(&at[0]) && (0.0..1.0).contains(&at[1])
    });
    assert_eq!(inside.count(), 0, "released over the hole");
    // two of sixteen cells: 12.5 %, and the sampling error of 1000 draws is 1 %
    let said = String::from_utf8(rockfall(&["plan", word(&scene)]).stdout).unwrap();
    let mut warnings = said.lines().filter_map(|line| line.strip_prefix("warning            "));
    assert!(warnings.next().unwrap().starts_with("holes in the slope: 1, the largest of 2.0 m²"));
    let share = warnings.next().unwrap();
    let share: f64 = share.split(' ').next().unwrap().parse().unwrap();
    assert!((share - 12.5).abs() < 4.0, "{said}");
}

/// An area over stems that leave next to no room: a release that finds none is a row with its own stop reason.
#[test]
fn a_release_without_room_is_a_row() {
    let dir = tempfile::tempdir().unwrap();
    // a rock of 0.4 m fits between two of the walls only, with 0.04 m to spare: one place in a hundred
    let walls =
        (-8..=0).map(|k| 0.35 * f64::from(k)).chain((0..8).map(|k| 0.44 + 0.35 * f64::from(k)));
    let wide: Vec<Facet> = walls
        .flat_map(|x| quad([p(x, -5.0, 0.0), p(x, 5.0, 0.0), p(x, 5.0, 2.0), p(x, -5.0, 2.0)]))
        .collect();
    write_ascii(&dir.path().join("walls.stl"), "walls", &wide).unwrap();
    let place = "count = 300\nheight_m = 0.1\npolygon_m = [[-2.0, -2.0], [2.4, -2.0], [2.4, 2.0], [-2.0, 2.0]]";
    let more = "[grounds.wood]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = 0.2\n[[trees]]\nmesh = \"walls.stl\"\nground = \"wood\"\n[record]\npaths = 3\n[maps]\ncell_m = 1.0";
    let asked = Asked { place, more, ..USUAL };
    let scene = scene(dir.path(), &plate(5.0, 0.0), &asked);
    let ends = stops(&scene, &[]);
    let lost = ends.iter().filter(|stop| *stop == "not_released").count();
    println!("{lost} of {} without room", ends.len());
    assert!(ends.len() == 300 && lost > 0 && lost < 300, "{lost}");
    let summary = fs::read_to_string(dir.path().join("out/summary.json")).unwrap();
    assert!(summary.contains(&format!("\"not_released\": {lost}")), "counted");
    let page = fs::read_to_string(dir.path().join("out/report.html")).unwrap();
    assert!(page.contains("not released"));
    // figures are of the rocks that were released: they say how many, and none of the others has failed
    let released = ends.len() - lost;
    for caption in [
        format!("of {released} releases; colour"),
        format!("share of the {released} releases that run out farther"),
        format!("over all {released} rocks"),
        format!("release ({released})"),
    ] {
        assert!(page.contains(&caption), "{caption}");
    }
    assert!(!page.contains("failed ("));
    let said = String::from_utf8(rockfall(&["plan", word(&scene)]).stdout).unwrap();
    assert!(said.contains("of 1000 releases tried out find no place to start from"), "{said}");
    assert!(said.contains("% of the places drawn"), "{said}");
    // and the same alone
    let one = ends.iter().position(|stop| stop == "not_released").unwrap().to_string();
    assert_eq!(stops(&scene, &["--only", &one]), ["not_released"]);
}

/// Where no release can be made at all there is nothing to run.
#[test]
fn an_area_without_any_room_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let place = "count = 10\nheight_m = 0.1\nline_m = [[-4.0, 0.0], [4.0, 0.0]]";
    let roof = [plate(5.0, 0.0), plate(5.0, -0.3)].concat();
    let more = "[grounds.wood]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = 0.2\n[[trees]]\nmesh = \"wall.stl\"\nground = \"wood\"";
    let wall = quad([p(-5.0, 0.0, 0.0), p(5.0, 0.0, 0.0), p(5.0, 0.0, 3.0), p(-5.0, 0.0, 3.0)]);
    write_ascii(&dir.path().join("wall.stl"), "wall", &wall).unwrap();
    let scene = scene(dir.path(), &roof, &Asked { place, more, ..USUAL });
    let said = refused(&["run", word(&scene), "--out", word(&dir.path().join("out"))]);
    assert!(
        said.contains("release 0 at") && said.contains("deep in the ground or a tree"),
        "{said}"
    );
    assert!(!dir.path().join("out").exists());
}

/// A centre given with its height may hang over the edge as long as the rock touches the edge.
#[test]
fn a_rock_may_hang_over_the_edge() {
    let dir = tempfile::tempdir().unwrap();
    // 45° outwards from the edge x = 5, y = 0, z = 0: it touches the edge from above and falls off
    let reach = 0.2 / 2.0_f64.sqrt();
    let place = format!("count = 1\npoints_m = [[{}, 0.0, {reach}]]", 5.0 + reach);
    let more = "[solver]\nlongest_s = 5.0";
    let asked = Asked { place: &place, more, ..USUAL };
    assert_eq!(stops(&scene(dir.path(), &plate(5.0, 0.0), &asked), &[]), ["left_terrain"]);
    let place = format!("count = 1\npoints_m = [[{}, 0.0, {reach}]]", 5.2 + reach);
    let scene = scene(dir.path(), &plate(5.0, 0.0), &Asked { place: &place, more, ..USUAL });
    let said = refused(&["plan", word(&scene)]);
    assert!(said.contains("points_m, entry 1: found no terrain"), "{said}");
}

/// The one line of a refusal; it must come soon.
fn refused(args: &[&str]) -> String {
    let begun = Instant::now();
    let done = rockfall(args);
    let took = begun.elapsed();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
    assert!(said.starts_with("error: ") && said.lines().count() == 1, "{args:?}: {said}");
    assert!(took < PROMPT, "{args:?} took {took:?}");
    said
}

/// The same under a limit of address space: what would take more ends with a panic or a signal, not with words.
fn refused_in_little_memory(args: &[&str]) -> String {
    let begun = Instant::now();
    let script = format!("ulimit -v {}; exec \"$@\"", FRUGAL_KB + 200_000);
    let done = Command::new("sh")
        .args(["-c", &script, "sh", env!("CARGO_BIN_EXE_rockfall")])
        .args(args)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env("RAYON_NUM_THREADS", "2")
        .output()
        .unwrap();
    let said = String::from_utf8(done.stderr).unwrap();
    assert_eq!(done.status.code(), Some(2), "{args:?}: {said}");
    assert!(said.starts_with("error: ") && said.lines().count() == 1, "{args:?}: {said}");
    assert!(begun.elapsed() < PROMPT, "{args:?} took {:?}", begun.elapsed());
    said
}

/// Every scene and mesh that is kept to be refused: in less than the memory and the time of a refusal.
#[test]
fn refusals_are_prompt_and_frugal() {
    let files = |folder: &str, ends: &str| {
        let folder = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).unwrap();
        let files = folder.map(|entry| entry.unwrap().path());
        files.filter(|file| word(file).ends_with(ends)).collect::<Vec<_>>()
    };
    let scenes = files("tests/bad", ".toml");
    for scene in &scenes {
        refused_in_little_memory(&["plan", word(scene)]);
    }
    let meshes = files("tests/bad_meshes", ".stl");
    let mut refused = 0;
    for mesh in &meshes {
        // those that are only warned of have tests of their own
        if !rockfall(&["mesh", "check", word(mesh)]).status.success() {
            refused_in_little_memory(&["mesh", "check", word(mesh)]);
            refused += 1;
        }
    }
    println!("{} scenes and {refused} of {} meshes refused", scenes.len(), meshes.len());
    assert!(scenes.len() > 150 && refused > 30);
}

/// Maps of a millimetre, paths of a microsecond, a billion rocks: asked for first, and nothing is written.
#[test]
fn what_takes_too_much_is_asked_for() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let together = "count = 1000000000\ntogether = true\nheight_m = 1.0\npoints_m = [[0.0, 0.0]]";
    let contact = "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 1e7\nfriction_angle_deg = 30.0\nrestitution = 0.3\ntensile_strength_pa = 0.0\ncohesion_pa = 0.0";
    for asked in [
        Asked { more: "[maps]\ncell_m = 1e-3", ..USUAL },
        Asked { more: "[record]\npath_step_s = 1e-6", ..USUAL },
        Asked { place: together, more: contact, ..USUAL },
        Asked { place: "count = 1000000000\nheight_m = 1.0\npoints_m = [[0.0, 0.0]]", ..USUAL },
    ] {
        let scene = scene(dir.path(), &plate(5.0, 0.0), &asked);
        let said = refused_in_little_memory(&["run", word(&scene), "--out", word(&out)]);
        assert!(said.contains("found a run that may take") && said.contains("--yes"), "{said}");
        assert!(!out.exists());
        let plan = rockfall(&["plan", word(&scene)]);
        let plan = String::from_utf8(plan.stdout).unwrap();
        assert!(plan.contains("runs with --yes only"), "{plan}");
    }
    // --yes is taken at its word
    let asked =
        Asked { more: "[record]\npath_step_s = 1e-5\n[solver]\nlongest_s = 100.0", ..USUAL };
    let scene = scene(dir.path(), &plate(5.0, 0.0), &asked);
    let said = refused(&["run", word(&scene), "--releases", "64", "--out", word(&out)]);
    assert!(said.contains("points of paths"), "{said}");
    assert_eq!(stops(&scene, &["--yes", "--releases", "1"]), ["at_rest"]);
}

/// Devices, pipes and files without end, wherever a file is named.
#[test]
fn files_without_end_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let pipe = dir.path().join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let long = dir.path().join("long");
    fs::File::create(&long).unwrap().set_len(1 << 40).unwrap(); // a terabyte of nothing
    let out = dir.path().join("out.stl");
    let slope = "terrain/quick_slope.stl";
    for file in ["/dev/zero", word(&pipe), word(&long)] {
        let mesh = scene(dir.path(), &plate(5.0, 0.0), &USUAL);
        let text = fs::read_to_string(&mesh).unwrap().replace("mesh.stl", file);
        fs::write(&mesh, text).unwrap();
        for args in [
            vec!["run", file],
            vec!["plan", file],
            vec!["plan", word(&mesh)],
            vec!["mesh", "check", file],
            vec!["mesh", "from-grid", file, word(&out)],
            vec!["mesh", "stems", file, slope, word(&out)],
            vec!["calibrate", file],
            vec!["study", "error", file],
        ] {
            let said = refused_in_little_memory(&args);
            assert!(said.contains("which has no end") || said.contains("GB or more"), "{said}");
        }
    }
}

/// A file that stands for another is told as such, whatever it stands for: scene, mesh, grid, drawing, table or list.
#[test]
fn a_pointer_of_git_lfs_is_told_as_such() {
    let dir = tempfile::tempdir().unwrap();
    let pointer = dir.path().join("pointer");
    fs::write(&pointer, "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n")
        .unwrap();
    let told = |args: &[&str]| {
        let said = refused(args);
        let words = said.contains("a pointer of Git LFS") && said.contains("git lfs pull");
        assert!(words && said.contains("pointer: start"), "{args:?}: {said}");
    };
    let (file, slope, out) =
        (word(&pointer), "terrain/quick_slope.stl", dir.path().join("out.stl"));
    told(&["plan", file]);
    told(&["calibrate", file]);
    told(&["init", file, word(&dir.path().join("new.toml"))]);
    told(&["mesh", "check", file]);
    told(&["mesh", "from-grid", file, word(&out)]);
    told(&["mesh", "stems", file, slope, word(&out)]);
    let list = dir.path().join("trees.csv");
    fs::write(&list, "x,y,dbh_m,height_m\n20,20,0.4,10\n").unwrap();
    told(&["mesh", "stems", word(&list), file, word(&out)]);
    // what a scene names
    let drawn = "[[lines]]\nfile = \"pointer\"";
    let barrier = "[[barriers]]\nfile = \"pointer\"\nheight_m = 4.0\ncapacity_j = 1e6";
    let ends = "[calibrate]\ndeposits = \"pointer\"\nvary = [{ ground = \"rock\", key = \"restitution\", from = 0.1, to = 0.5, before = 0.3 }]";
    let shape = "[[rocks.shapes]]\nkind = \"mesh\"\ncorner_radius = 0.1\nmesh = \"pointer\"\n[solver]\nscheme = \"rigid\"";
    let trees = |key: &str| format!("[[trees]]\n{key} = \"pointer\"\nground = \"rock\"");
    let zones = "[[ground_zones]]\nfile = \"pointer\"\nground = \"rock\"";
    for more in [drawn, barrier, ends, shape, zones, &trees("mesh"), &trees("file")] {
        let scene = scene(dir.path(), &plate(5.0, 0.0), &Asked { more, ..USUAL });
        told(&["plan", word(&scene)]);
    }
    let place = |key: &str| format!("count = 1\nheight_m = 1.0\n{key} = \"pointer\"");
    for key in ["zones", "table"] {
        let asked = Asked { place: &place(key), ..USUAL };
        told(&["plan", word(&scene(dir.path(), &plate(5.0, 0.0), &asked))]);
    }
    for key in ["mesh", "file"] {
        let scene = scene(dir.path(), &plate(5.0, 0.0), &USUAL);
        let text = fs::read_to_string(&scene).unwrap();
        let named = format!("{key} = \"pointer\"");
        fs::write(&scene, text.replace("mesh = \"mesh.stl\"", &named)).unwrap();
        told(&["plan", word(&scene)]);
    }
}

/// The table beside a Shapefile may be the pointer while the shapes are there.
#[test]
fn a_pointer_beside_a_shapefile_is_told() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("zones.shp"), drawn::shapefile(&drawn::rings())).unwrap();
    let pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n";
    fs::write(dir.path().join("zones.dbf"), pointer).unwrap();
    let place = "count = 1\nheight_m = 1.0\nzones = \"zones.shp\"";
    let scene = scene(dir.path(), &plate(5.0, 0.0), &Asked { place, ..USUAL });
    let said = refused(&["plan", word(&scene)]);
    assert!(said.contains("zones.dbf: start: found a pointer of Git LFS"), "{said}");
}

/// An aim that no number of releases reaches is refused at once or given up with words.
#[test]
fn an_aim_out_of_reach_is_given_up() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let run = |aim: &str| {
        let args = ["run", "examples/quick.toml", "--quiet", "--releases", "200", "--until", aim];
        let done = rockfall(&[&args[..], &["--out", word(&out)]].concat());
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let (code, said) = run("runout.p95 < 1e-300 m");
    assert!(code == Some(2) && said.contains("1e-3 m or more"), "{said}");
    assert!(!out.exists());
    let (code, said) = run("speed.p50 < 0.001 m/s");
    assert!(code == Some(2) && said.contains("releases are written, and about"), "{said}");
}
