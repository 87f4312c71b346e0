//! The exact cases over every scheme, and the studies as commands.
#![allow(clippy::unwrap_used, reason = "a test without its files has failed")]

use crate::report::boxes;
use rockfall::simulation::Scratch;
use rockfall::solver::Scheme;
use rockfall::study::cases::CASES;
use std::fs;
use std::process::Command;

/// Every case with every scheme at a usual setting, within the tolerance that the case itself gives a reason for.
#[test]
fn every_scheme_reaches_every_exact_case() {
    for case in CASES {
        let terrain = case.terrain();
        // where no closed form is, a fine computation stands in: seconds, and one for all schemes with springs
        let of = |scheme| case.is_for(scheme).then(|| case.measures(&terrain, scheme));
        let [sprung, rigid] = [Scheme::Reference, Scheme::Rigid].map(of);
        for (scheme, fineness) in [
            (Scheme::Adaptive, 1e-2),
            (Scheme::Adaptive, 1e-4),
            (Scheme::Reference, 1e-8),
            (Scheme::Rigid, 1e-2),
            (Scheme::Dda, 1e-5),
        ] {
            if !case.is_for(scheme) {
                continue;
            }
            let step = case.settings(scheme, fineness);
            let journey = case.follow(&terrain, &step, &mut Scratch::default());
            let exact = if scheme.has_springs() { &sprung } else { &rigid };
            let error = case.error(exact.as_ref().unwrap(), &journey);
            let (allowed, why) = case.allowed(&step);
            println!("{:13} {:10} {error:.1e} of {allowed:.1e}", case.name, scheme.name());
            assert!(
                error <= allowed,
                "{} {}: {error:e} > {allowed:e} ({why})",
                case.name,
                scheme.name()
            );
        }
    }
}

/// The stiff and extreme cases: every scheme keeps every bound, each of which has its reason where it is set.
#[test]
fn stiff_and_extreme_cases_keep_their_bounds() {
    let outcomes = rockfall::study::stability::study(|_| ());
    let broken: Vec<_> = outcomes.iter().filter(|outcome| !outcome.holds()).collect();
    assert!(broken.is_empty(), "{broken:#?}");
    // every case with every scheme left something behind
    assert!(outcomes.len() > 500);
}

/// A run that goes on until an interval is narrow asks for the same releases whatever the number of threads, writes the
/// bytes of a run that was asked for them at once, and has nothing left to do when resumed.
#[test]
fn a_run_until_an_interval_is_narrow_is_the_same_everywhere() {
    let dir = tempfile::tempdir().unwrap();
    let run = |out: &str, more: &[&str]| {
        let out = dir.path().join(out);
        let done = Command::new(env!("CARGO_BIN_EXE_rockfall"))
            .args(["run", "examples/quick.toml", "--quiet", "--out"])
            .arg(&out)
            .args(more)
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        fs::read_to_string(out.join("releases.csv")).unwrap()
    };
    let until = ["--releases", "60", "--until", "speed.p50 < 0.3 m/s"];
    let alone = run("one", &[&until[..], &["--threads", "1"]].concat());
    let rows = alone.lines().count() - 1;
    assert!(rows > 60, "the aim was reached with the first releases: the test tests nothing");
    assert_eq!(alone, run("two", &[&until[..], &["--threads", "2"]].concat()));
    assert_eq!(alone, run("once", &["--releases", &rows.to_string()]));
    assert_eq!(alone, run("one", &[&until[..], &["--resume"]].concat()));
}

/// At fixed steps every scheme has the order that its theory says, within a twentieth.
#[test]
fn every_scheme_has_its_order_at_fixed_steps() {
    for ladder in rockfall::study::order::study() {
        let order = ladder.order();
        println!("{} order {order:.2} {:?}", ladder.scheme.name(), ladder.errors);
        assert!(
            (order - ladder.theory).abs() <= 0.05 * ladder.theory,
            "{} {order}",
            ladder.scheme.name()
        );
    }
}

/// The table of the README: the fourth-order scheme is exact to a few digits more than it shows, the default's error
/// falls with its tolerance, and a row says what it measures.
#[test]
fn exact_values_are_in_their_units() {
    let values = rockfall::study::exact_values::values();
    assert!(values.len() > 15);
    for value in &values {
        let off = value.found.map(|found| (found - value.exact).abs());
        assert!(off[0] < 3e-6 && off[0] <= off[1] + 1e-7, "{value:?}");
        assert!(off[1] < 2e-3 && off[2] < 0.2, "{value:?}");
        assert!(value.what.contains('('), "{value:?} has no unit");
    }
    let table = rockfall::study::exact_values::table(&values);
    assert_eq!(table.lines().count(), values.len() + 2);
}

fn rockfall(arguments: &[&str], out: &std::path::Path) -> (Option<i32>, String, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_rockfall"))
        .args(arguments)
        .arg("--out")
        .arg(out)
        .output()
        .unwrap();
    let page = fs::read_to_string(out.join("README.md")).unwrap_or_default();
    (done.status.code(), String::from_utf8_lossy(&done.stdout).into_owned(), page)
}

/// Two hundred of the releases on the real slope keep every bound of conservation; the fixed step at a
/// millisecond dissipates what no contact took, and says so with exit status 1.
#[test]
fn conservation_is_held_and_can_be_broken() {
    let dir = tempfile::tempdir().unwrap();
    let study = |scene: &str, out: &str| {
        rockfall(&["study", "stability", scene, "--releases", "200"], &dir.path().join(out))
    };
    let (code, said, page) = study("examples/tyrol.toml", "good");
    assert_eq!(code, Some(0), "{said}");
    assert!(page.contains("200 of 200 releases") && !page.contains("**no**"), "{page}");
    let scene = fs::read_to_string("examples/tyrol.toml").unwrap();
    let mesh = fs::canonicalize("terrain/tyrol.stl").unwrap();
    let coarse = scene.replace("../terrain/tyrol.stl", mesh.to_str().unwrap())
        + "\n[solver]\nscheme = \"dda\"\nstep_s = 1e-3\n";
    let file = dir.path().join("coarse.toml");
    fs::write(&file, coarse).unwrap();
    let (code, said, page) = study(file.to_str().unwrap(), "bad");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("NOT KEPT") && page.contains("**no**"), "{page}");
}

/// Blocks are held to the same bounds.
#[test]
fn blocks_conserve_too() {
    let dir = tempfile::tempdir().unwrap();
    let asked = ["study", "stability", "examples/blocks.toml", "--releases", "12"];
    let (code, said, page) = rockfall(&asked, &dir.path().join("blocks"));
    assert_eq!(code, Some(0), "{said}");
    assert!(page.contains("12 of 12 releases") && !page.contains("**no**"), "{page}");
}

/// A scene's study with coarser meshes says all three errors apart, which dominates, and what it would take.
#[test]
fn errors_of_a_scene_are_told_apart() {
    let dir = tempfile::tempdir().unwrap();
    let scene = ["study", "error", "examples/quick.toml", "--releases", "150", "--meshes"];
    let (code, said, page) = rockfall(&scene, dir.path());
    assert_eq!(code, Some(0), "{said}");
    for words in
        ["sampling error", "error of the steps", "error of the mesh", "dominates", "cheapest"]
    {
        assert!(
            said.contains(words) || words == "cheapest" && said.contains("finer"),
            "{words}: {said}"
        );
    }
    assert!(page.contains("(the scene's own)") && page.contains(", own |"), "{page}");
    let rows = |file: &str| fs::read_to_string(dir.path().join(file)).unwrap().lines().count() - 1;
    // three quantities, three percentiles (two with too few rocks), four tolerances, three meshes
    assert_eq!((rows("error.csv") % 4, rows("mesh.csv") % 3), (0, 0));
    assert_eq!(rows("error.csv") / 4, rows("mesh.csv") / 3);
    let drawn = fs::read_to_string(dir.path().join("error.svg")).unwrap();
    // every axis says that it is an error, every text has its own room
    assert!(drawn.contains("mesh") && drawn.matches(">Error of P95 ").count() == 3);
    let faults = boxes::faults(&drawn, "error.svg");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Where rocks that would have gone on leave a percentile no interval, its panel says so instead of showing no line of sampling.
#[test]
fn a_panel_without_sampling_says_why() {
    let dir = tempfile::tempdir().unwrap();
    let mesh = fs::canonicalize("terrain/quick_slope.stl").unwrap();
    let scene = fs::read_to_string("examples/quick.toml").unwrap();
    let trees = fs::canonicalize("terrain/quick_trees.stl").unwrap();
    let scene = scene
        .replace("../terrain/quick_slope.stl", mesh.to_str().unwrap())
        .replace("../terrain/quick_trees.stl", trees.to_str().unwrap())
        + "\n[solver]\n";
    let study = |releases: &str, out: &str, time: &str| {
        let file = dir.path().join(out.to_owned() + ".toml");
        fs::write(&file, scene.clone() + time).unwrap();
        let out = dir.path().join(out);
        let asked = ["study", "error", file.to_str().unwrap(), "--releases", releases];
        let (code, said, _) = rockfall(&asked, &out);
        assert_eq!(code, Some(0), "{said}");
        fs::read_to_string(out.join("error.svg")).unwrap()
    };
    let drawn = study("100", "bound", "longest_s = 1.0\n");
    assert!(drawn.contains("only a bound, 100 of 100 rocks would have gone on"), "{drawn}");
    let faults = boxes::faults(&drawn, "error.svg");
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    assert!(study("40", "few", "").contains("too few rocks for an interval"));
    // as in a report, no P95 of fewer than 59
    let page = fs::read_to_string(dir.path().join("few/README.md")).unwrap();
    let few = "**P95 runout**: too few rocks, 19 more are needed; 72 in all for an interval.";
    assert!(page.contains(few), "{page}");
    // 59 rocks bound a P95 on one side, an interval of it takes 72
    assert!(study("65", "nearly", "").contains("too few rocks for an interval"));
    let page = fs::read_to_string(dir.path().join("nearly/README.md")).unwrap();
    assert!(page.contains("72 or more are needed") && !page.contains("59 or more"), "{page}");
}

/// Energies and heights at a line are those of the rocks that cross it in a run, blocks with their own inertia: each percentile of the table is the
/// value of one of them. With that of a sphere it was that of none.
#[test]
fn energies_of_blocks_at_a_line_are_those_of_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let terrain = fs::canonicalize("terrain").unwrap();
    let scene = fs::read_to_string("examples/blocks.toml").unwrap()
        + "\n[[lines]]\nname = \"here\"\npoints_m = [[0.0, 12.0], [40.0, 14.0]]\n";
    let file = dir.path().join("blocks.toml");
    fs::write(&file, scene.replace("../terrain", terrain.to_str().unwrap())).unwrap();
    let (asked, out) = (file.to_str().unwrap(), dir.path().join("out"));
    for command in
        [&["run", asked, "--releases", "40"][..], &["study", "error", asked, "--releases", "40"]]
    {
        let (code, said, _) = rockfall(command, &out.join(command[0]));
        assert_eq!(code, Some(0), "{said}");
    }
    let table = |file: &str| csv::Reader::from_path(out.join(file)).unwrap();
    let number = |row: &csv::StringRecord, k: usize| row[k].parse::<f64>().unwrap();
    let mut crossings = table("run/crossings.csv");
    let crossings: Vec<csv::StringRecord> = crossings.records().map(Result::unwrap).collect();
    let energies = crossings.iter().map(|row| number(row, 6) + number(row, 7)).collect();
    // vertical, though the slope is steep
    let heights = crossings.iter().map(|row| number(row, 4)).collect();
    let mut studied = table("study/error.csv");
    let studied: Vec<csv::StringRecord> = studied.records().map(Result::unwrap).collect();
    for (column, all) in [("energy_at_line_1", energies), ("height_at_line_1", heights)] {
        let all: Vec<f64> = all;
        // under the scene's own setting
        let own = studied.iter().filter(|row| &row[0] == column && &row[16] == "0.3");
        let values: Vec<f64> = own.map(|row| number(row, 11)).collect();
        assert!(all.len() > 20 && !values.is_empty());
        for value in values {
            let nearest = all.iter().map(|one| (one / value - 1.0).abs()).fold(1.0, f64::min);
            assert!(nearest < 1e-12, "{column}: {value} is nobody's: {nearest:e}");
        }
    }
}

/// What follows every rock alone refuses a world: its rocks would fall through each other.
#[test]
fn a_world_is_not_followed_rock_by_rock() {
    let dir = tempfile::tempdir().unwrap();
    let terrain = fs::canonicalize("terrain").unwrap();
    let scene = fs::read_to_string("examples/quick.toml").unwrap();
    let world = scene.replace("../terrain", terrain.to_str().unwrap()).replace(
        "[release]",
        "[rocks.contact]\nnormal_stiffness_n_m = 1e8\nshear_stiffness_n_m = 0.25e8\nfriction_angle_deg = 30.0\nrestitution = 0.4\n\
         tensile_strength_pa = 0.0\ncohesion_pa = 0.0\n\n[release]\ntogether = true",
    ) + "\n[calibrate]\ndeposits = \"ends.csv\"\n[[calibrate.vary]]\nground = \"rock\"\nkey = \"friction_angle_deg\"\nfrom = 20.0\nto = 40.0\nbefore = 30.0\n";
    let file = dir.path().join("world.toml");
    fs::write(&file, world).unwrap();
    fs::write(
        dir.path().join("ends.csv"),
        "release_x_m,release_y_m,x_m,y_m\n5.0,4.0,6.0,30.0\n5.0,4.0,7.0,31.0\n",
    )
    .unwrap();
    let asked = file.to_str().unwrap();
    for command in
        [&["study", "error", asked][..], &["study", "stability", asked], &["calibrate", asked]]
    {
        let done = Command::new(env!("CARGO_BIN_EXE_rockfall"))
            .args(command)
            .args(["--releases", "8", "--out"])
            .arg(dir.path().join("out"))
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(2), "{command:?}: {said}");
        assert!(
            said.contains("world.toml: [release] together: found true; leave it out"),
            "{said}"
        );
        assert!(!dir.path().join("out").exists(), "{command:?} left something behind");
    }
}
